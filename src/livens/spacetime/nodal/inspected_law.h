// SPDX-License-Identifier: BSD-3-Clause
// Laws of loads that need not be smooth inside of an element.
#pragma once

#include <vector>

#include "livens/dynamics/rows/tables.h"

namespace livens {

/// F = sum_k f_k(t, q) F_k with numbers q of the motion.
struct InspectedLaw {
    int load = 0;
    std::vector<int> bodies;   ///< that it looks at or acts on
    LawInside inside;
    std::vector<double> mobility;   ///< of each unit F_k: what it accelerates, in lengths or rad
};

/// Of all loads that are not smooth.
std::vector<InspectedLaw> laws_to_inspect(const Tables& tables);

}   // namespace livens
