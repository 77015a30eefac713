// SPDX-License-Identifier: BSD-3-Clause
// The error of an element's quadrature of a law: verified integrals less the element's own.
#pragma once

#include <vector>

#include "livens/spacetime/elements/rule.h"

namespace livens::inline spacetime_internal {

class LawOnPath;
class LooksInLanes;

/// Points of Gauss, and weights by which these, the middle one left out, and both ends tell whether their
/// integral can be trusted: [end, points.., end].
struct CheckedRule {
    Quadrature gauss;
    std::vector<double> check;
};

/// The moments D_kn = integral of P_n f_k over the element less their quadrature, with Legendre's polynomials
/// P_0, P_1, P_2 (docs/theory.md, "Looks at laws"). Intervals are divided where interval bounds allow steeper
/// slopes than those between samples, so that a narrow pulse costs a number of samples that grows as the
/// logarithm of its width.
class MissedMoments {
public:
    static constexpr std::size_t n_moments = 3;

    explicit MissedMoments(const ElementRule& rule);

    /// Of factor k with the polynomial n at [n * n_factors + k]. `looks`: they know the law at shares() and
    /// at load points; null: it is asked there.
    std::vector<double> of(LawOnPath& path, const LooksInLanes* looks) const;
    /// Where all of the way is looked at first.
    std::vector<double> shares() const;

private:
    const ElementRule& rule_;
    int n_fine_;   // points on the whole way
};

}   // namespace livens::inline spacetime_internal
