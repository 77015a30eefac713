// SPDX-License-Identifier: BSD-3-Clause
// Where rows and unknowns of a window stand in a matrix of blocks.
#pragma once

#include "livens/solvers/blocks.h"
#include "livens/spacetime/elements/window_layout.h"

namespace livens::inline spacetime_internal {

/// Rows of radau(p) are numbered with the node before their own, as a march has them.
inline int place_of_row(const WindowLayout& layout, int A)
{
    return layout.points == Points::radau ? A - 1 : A;
}

/// What is free at every node, or, every `degree` nodes, at the ends of elements.
BlockStructure structure_of(const WindowLayout& layout, int freedoms, int every = 1);

}   // namespace livens::inline spacetime_internal
