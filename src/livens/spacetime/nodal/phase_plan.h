// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "livens/multibody/state.h"

namespace livens::inline spacetime_internal {

/// What phases are alike for all values of unknown numbers.
struct PhasePlan {
    struct Phase {
        int first = 0, last = 0;        ///< element ends
        std::vector<int> joints;        ///< that act
        std::vector<int> independent;   ///< rows of these
        State start;                    ///< a guess, with angles of loads
    };
    std::vector<Phase> phases;
};

}   // namespace livens::inline spacetime_internal
