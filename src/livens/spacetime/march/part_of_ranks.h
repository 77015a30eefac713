// SPDX-License-Identifier: BSD-3-Clause
// Windows of which each of several ranks solves a part.
#pragma once

#include <string>
#include <vector>

#include "livens/multibody/model.h"
#include "livens/solvers/ranks.h"
#include "livens/spacetime/method.h"
#include "livens/time/time_mesh.h"

namespace livens::inline spacetime_internal {

/// First elements of the parts of ranks, and the end of the last. No part begins where a load breaks.
std::vector<int> parts_of_ranks(const Model& model, const TimeMesh& mesh, int n_ranks, const Method& method);

/// Of those that have something to say the first rank's words, on all.
std::string said_by_first(const std::string& own, Ranks& ranks);

/// What one rank has, and what it has done; see RankWork.
struct FiguresOfPart {
    int first = 0, last = 0;   ///< its elements are first..last - 1
    int n_formed = 0;          ///< elements that it evaluates in a residual
    int n_left = 0;            ///< rows that it has left of its own
    int n_in_chain = 0;        ///< rows of these in the chain
    int n_chain = 0;           ///< unknowns of the chain
    long long flops = 0;       ///< of a factorisation of its own rows
    int n_unknowns = 0;        ///< that no rank before it has
    long long factor_entries = 0;
};

/// What a window says of itself as one of several ranks.
class PartOfRanks {
public:
    virtual ~PartOfRanks() = default;
    virtual FiguresOfPart figures() const = 0;
    /// What quantities of conditions by component are in the solution at hand, angles with their turns.
    virtual std::vector<double> values_of_conditions() const = 0;
};

}   // namespace livens::inline spacetime_internal
