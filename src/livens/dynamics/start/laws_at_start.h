// SPDX-License-Identifier: BSD-3-Clause
// Laws that have no value where the bodies stand: nothing can be closed there.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "livens/dynamics/start/start_coordinates.h"

namespace livens::inline dynamics_internal {

/// Why a start cannot be closed there: `coupling-range` beyond the end of a law, `coupling-law` where it has
/// no value; empty where all have one.
std::optional<Complaint> why_without_law(const Model& model, std::span<const Matrix34> X);

/// Where the other joints lead the wanted values: laws that have no value where the bodies are placed cannot
/// lead there. Empty where all have one, or nothing is wanted.
std::optional<State> led_to_laws(const Model& model, const std::vector<StartCoordinate>& wanted,
                                 StartPolicy policy, double t);

/// As move_start(), of a model all of whose laws have values. `is_led`: the bodies have been led to the
/// wanted values, and joints that could not lead there hold from now on.
MovedStart move_start_with_laws(const Model& model, const std::vector<StartCoordinate>& wanted,
                                StartPolicy policy, double t, const std::vector<StatedVelocity>& stated,
                                bool is_led);

}   // namespace livens::inline dynamics_internal
