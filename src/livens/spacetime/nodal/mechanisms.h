// SPDX-License-Identifier: BSD-3-Clause
// Which bodies and rows of a model form a mechanism that may come to a position in which it loses rank.
#pragma once

#include <vector>

#include "livens/dynamics/rows/tables.h"

namespace livens {

/// Bodies that joints tie together into loops, or that drives move, and the rows that are theirs.
struct Mechanism {
    std::vector<int> bodies, rows;
};

/// Mechanisms that no joint ties to each other. Trees are not among them.
std::vector<Mechanism> closed_mechanisms(const Tables& tables);

}   // namespace livens
