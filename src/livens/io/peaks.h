// SPDX-License-Identifier: BSD-3-Clause
// Least and largest values of a run, for program and Python alike.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "livens/diagnostics/extremes.h"
#include "livens/io/results.h"
#include "livens/io/scenario.h"

namespace [[gnu::visibility("default")]] livens {

/// By name: "pivot.force" (of a vector the magnitude), "rod.position.z", "energy". Throws InputError
/// (`quantity-unknown`) with what there is; for a quaternion without its component, and where parts of
/// several kinds have the name.
QuantitySeries find_series(const Quantities& quantities, const std::string& name);

/// Of the numbers named, or else of all coordinates of joints, reactions, drives, loads, sensors and
/// energies. They are refined in states of the full order of `method`, the one that was taken; in the family
/// mixed, which has none between its element ends, on the polynomials. Throws InputError
/// (`quantity-unknown`).
std::vector<Extremes> find_peaks(const Run& run, const Scenario& scenario, const Method& method,
                                 std::span<const std::string> names);

}   // namespace gnu::visibility("default")]]livens
