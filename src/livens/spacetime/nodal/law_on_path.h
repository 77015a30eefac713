// SPDX-License-Identifier: BSD-3-Clause
// One law along the polynomials of an element: its factors at any share, and bounds of their slopes.
#pragma once

#include <span>
#include <vector>

#include "livens/spacetime/nodal/element_path.h"
#include "livens/spacetime/nodal/inspected_law.h"

namespace livens {

/// The numbers q(s) of a law are taken at p + 3 points, and are the polynomial through them.
class LawOnPath {
public:
    /// References must outlive it.
    LawOnPath(const Tables& tables, const ElementRule& rule);

    /// Takes the numbers of a law along the path. `angles`: at the first node, see Turns.
    void follow(const InspectedLaw& law, ElementPath& path, const std::vector<double>& angles);
    const InspectedLaw& law() const { return *law_; }
    std::size_t n_factors() const { return law_->inside.n_factors; }
    double h() const { return h_; }

    void factors_at(double share, double* factors);
    /// Bounds of |df_k/ds| between two shares; only of a law that knows them.
    void bound_slopes(double first, double last, std::span<double> bounds);

private:
    EnclosedValue range(std::size_t number, double width) const;

    const Tables& tables_;
    LagrangeBasis basis_;
    const InspectedLaw* law_ = nullptr;
    double start_ = 0, h_ = 0;
    // At the nodes of basis_, and bounds of derivatives.
    std::vector<double> numbers_, slopes_, second_, third_;
    std::vector<double> values_, at_;
};

}   // namespace livens
