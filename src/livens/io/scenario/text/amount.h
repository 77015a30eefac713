// SPDX-License-Identifier: BSD-3-Clause
// Numbers that are computed, with their dimensions: "2*L", "L/2 + 30 mm".
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "livens/io/scenario/text/units.h"
#include "livens/time/expression.h"

namespace livens::inline io_internal {

/// A number and what it measures. Angles are counted, too, but bind loosely: see misfit().
struct Amount {
    double value = 0;                 ///< SI
    std::array<double, 4> powers{};   ///< of length, mass, time, angle; a root halves them
    bool has_unit = false;            ///< a unit is in it; without one it may stand for anything, in SI units
    bool is_zero = false;             ///< it was written 0, which may be added to anything
    bool has_hertz = false;           ///< frequencies are no angular velocities ...
    bool has_pi = false;              ///< ... unless 2 pi is between them

    /// Neither length nor mass nor time.
    bool is_pure() const { return powers[0] == 0 && powers[1] == 0 && powers[2] == 0; }
};

/// "a length (m)", "a plain number", "a quantity in kg m/s".
std::string described(const Amount& amount);

/// In SI: "kg m/s^2"; empty for a plain number.
std::string si_unit_of(const Amount& amount);

/// Of a number and its unit.
Amount amount_of(double number, const Unit& unit);

/// What two amounts become, operation by operation; the value alone is left to the caller. `second` of an
/// operation of one is not looked at, but for an exponent's value. Empty, or what does not go together.
std::string combine(Expression::Operation operation, const Amount& first, const Amount& second,
                    Amount& result);

/// Empty where the amount may stand for what is measured in `si_unit` (empty: a plain number); else why not.
///
/// Length, mass and time must be those of the unit. A number without any unit may stand for everything, as
/// plain numbers do. Angles, which are quotients of lengths, are held to where nothing else is measured: an
/// angle is no ratio and a frequency no angular velocity, but `v/R` is one.
std::string misfit(const Amount& amount, std::string_view si_unit);

}   // namespace livens::inline io_internal
