// SPDX-License-Identifier: BSD-3-Clause
// Units that people wish to see instead of SI units.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace [[gnu::visibility("default")]] livens {

/// What numbers are multiplied with, and their unit then.
struct ShownUnit {
    double factor = 1;
    std::string unit;
};

/// An SI unit in the first of the wished ones that fits: of the same dimension, or of angles and lengths
/// themselves where `unit` is a rate of theirs ("deg" turns rad/s^2 into deg/s^2). As it is where none fits.
ShownUnit shown_unit(const std::string& unit, std::span<const std::string> wished);

/// Throws InputError (`unit`) if one of the wished ones is no unit, or one of nothing that is shown, which is
/// in `units`.
void check_shown_units(std::span<const std::string> wished, const std::vector<std::string>& units);

}   // namespace gnu::visibility("default")]]livens
