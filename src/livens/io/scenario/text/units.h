// SPDX-License-Identifier: BSD-3-Clause
// Quantities in strings: "30 deg", "5 mm", "7850 kg/m^3".
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace livens::inline io_internal {

/// Exponents of the base quantities. Angles count, so that an angle cannot stand for a number or a spin for a
/// frequency.
using Dimension = std::array<int, 4>;   // length, mass, time, angle

/// A unit is numerator / denominator * 10^power SI units. The power is kept apart so that "5 mm" is 5 / 1000,
/// the double nearest to 0.005, and not 5 * 0.001.
struct Unit {
    double numerator = 1;
    double denominator = 1;
    int power_of_ten = 0;
    Dimension dimension{};
};

/// Reads products, quotients and powers of units with SI prefixes: "kN/m", "kg m^2", "N s/m", "kg/(m s)",
/// "1/s". What stands behind a slash is one factor or in parentheses: "J/kg m" is ambiguous and refused.
/// Empty for what is no unit; `reason` then says why.
std::optional<Unit> parse_unit(std::string_view text, std::string& reason);

/// "N m^-1" for "N m" and a raised "-1". Other bytes stay, and are refused where they stand.
std::string in_ascii(std::string_view text);

/// So many of a unit, in SI units.
double in_si(double number, const Unit& unit);

struct Quantity {
    double value = 0;    ///< SI, finite
    std::string error;   ///< empty if it could be read
    std::string help;
};

/// A number and a unit of the dimension of `si_unit`.
Quantity parse_quantity(std::string_view text, std::string_view si_unit);

}   // namespace livens::inline io_internal
