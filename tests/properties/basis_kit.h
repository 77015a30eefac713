// SPDX-License-Identifier: BSD-3-Clause
// What every space of functions of time must fulfil; a new family gets it by a line in
// basis_kit_registry.cpp.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "livens/time/time_space.h"
#include "properties/kit.h"

namespace livens {

/// A space, and what is known of it without looking at it.
struct BasisCase {
    std::string family;   ///< the function of TimeSpace that makes it; "lower" for what lower() makes
    std::string what;     ///< for messages
    TimeSpace space;
    int exactness = 0;             ///< highest degree of the polynomials that the space contains
    std::vector<int> smoothness;   ///< at each inner element end: continuous derivatives; -1 for a jump

    // Of the space; controls replace them by wrong ones.
    std::function<void(int element, double s, std::span<double>, std::span<double>)> evaluate;
    std::optional<TimeSpace> lower;   ///< none where lower() is not asked for
    std::vector<double> points;       ///< interpolation points, if the space is continuous
};

BasisCase basis_case(std::string family, std::string what, TimeSpace space, int exactness,
                     std::vector<int> smoothness);

/// Every family of the library in every degree, on even and uneven elements; and what lower() makes of them.
const std::vector<BasisCase>& basis_cases();

/// Functions are numbered without gaps, add up to one, their derivatives to zero; splines are not negative;
/// at the start only the first one, at the end only the last one is not zero (continuous spaces).
Failures check_basis_unity(const BasisCase& basis);
/// Polynomials up to the exactness are in the space, those of the next degree are not.
Failures check_basis_exactness(const BasisCase& basis);
/// Derivatives equal one-sided differences of order 8, which are exact for polynomials (quotients are
/// multiplied by denominator() first), at ends too.
Failures check_basis_derivatives(const BasisCase& basis);
/// As many derivatives are continuous at element ends as stated, and no more.
Failures check_basis_smoothness(const BasisCase& basis);
/// One point a function, ascending, from end to end to the bit; the matrix of values there is regular.
Failures check_basis_interpolation(const BasisCase& basis);
/// One function and one degree fewer on the same elements, adding up to one; derivatives of functions without
/// weights are in that space.
Failures check_basis_lower(const BasisCase& basis);

Failures check_basis(const BasisCase& basis);   ///< all of them

}   // namespace livens
