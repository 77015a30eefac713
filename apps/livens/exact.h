// SPDX-License-Identifier: BSD-3-Clause
// For --exact: state and reactions between element ends.
#pragma once

#include "livens/io/results.h"
#include "livens/io/scenario.h"
#include "livens/spacetime/solve.h"

namespace livens::program {

/// Of one shortened element; ends the program where it cannot be had.
ExactSample exact_sample(const Run& run, const Scenario& scenario, double t);

}   // namespace livens::program
