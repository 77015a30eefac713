// SPDX-License-Identifier: BSD-3-Clause
// Where the bodies of a model are, and how they move.
#pragma once

#include <vector>

#include "livens/base/linear.h"

namespace [[gnu::visibility("default")]] livens {

class Model;

/// Positions and their rates of all bodies at one instant.
struct State {
    double t = 0;
    std::vector<Matrix34> X;
    std::vector<Matrix34> V;
    std::vector<double> angles{};   ///< of loads, see Turns; empty: no turns since the bodies were stated
    /// Of a motion: controllers that are asked at t were asked.
    bool is_of_motion = false;
};

}   // namespace livens
