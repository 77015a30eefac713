// SPDX-License-Identifier: BSD-3-Clause
// Laws of one coordinate, for couplings: from tables and from formulas.
#pragma once

#include <vector>

#include "livens/multibody/joint_coordinates.h"
#include "livens/time/expression.h"

namespace [[gnu::visibility("default")]] livens {

/// A cubic spline through values at coordinates that ascend, not-a-knot at its ends; or one that is periodic,
/// whose last row is its first again: from there on it repeats, higher by what the last value is more than
/// the first. Throws InputError (`table-size`, `table-order`, `table-slope`, `not-finite`) as spline_table()
/// does; a periodic one has four rows or more.
CoordinateLaw tabulated_law(const std::vector<double>& coordinates, const std::vector<double>& values,
                            bool is_periodic);
/// A formula of one symbol. Of an angle it has a turn as its period if it begins again after one, higher by
/// some number. Throws InputError (`coupling-law`) for one of time, of nothing, or with a kink.
CoordinateLaw formula_law(const Expression& expression, bool is_angle);

}   // namespace gnu::visibility("default")]]livens
