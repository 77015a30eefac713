// SPDX-License-Identifier: BSD-3-Clause
// For --exact: state and reactions between element ends.
#pragma once

#include "livens/diagnostics/accelerations.h"
#include "livens/io/results.h"
#include "livens/io/scenario.h"
#include "livens/spacetime/solve.h"

namespace livens::program {

/// Of one shortened element; ends the program where it cannot be had.
ExactSample exact_sample(const Run& run, const Scenario& scenario, double t);

/// Accelerations of all bodies, of the motion or of an exact_sample().
AcceleratedState accelerated_at(const Run& run, const Scenario& scenario, double t, bool is_exact);
/// An instant as typed; at an element end, that.
double instant_inside(const std::string& text, const Motion& motion);

}   // namespace livens::program
