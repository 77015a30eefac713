// SPDX-License-Identifier: BSD-3-Clause
// One motion solved by several processes.
#pragma once

#include "livens/solvers/ranks.h"
#include "livens/spacetime/solve.h"

namespace [[gnu::visibility("default")]] livens {

/// What one rank has done for a motion.
struct RankWork {
    int first = 0, last = 0;   ///< its elements are first..last - 1
    int n_formed = 0;          ///< elements that it evaluates in a residual
    int n_left = 0;            ///< rows that it has left of its own
    int n_in_chain = 0;        ///< rows of these in the chain
    int n_chain = 0;           ///< unknowns of the chain
    long long flops = 0;       ///< of a factorisation of its own rows
    Traffic of_solution;       ///< that it sent while the motion was solved
    TimeMesh mesh{};           ///< of all ranks, as unknown numbers make it
};

/// Throws InputError `ranks-method`, `ranks-conditions` or `ranks-elements` for what is not solved on ranks:
/// the elements of the family mixed on Lagrange's basis are, all at once, under any conditions, and those of
/// lobatto, all at once, where no number is unknown behind a start that is known as a whole, and no law bends
/// on the way from a state.
void check_ranks(const Model& model, const Problem& problem, const Time& time, const Method& method,
                 const SolveOptions& options, int n_ranks);

/// solve() by all ranks, each with its part of the elements; called by all of them with the same arguments.
/// Returns this rank's part of the motion; report and verdict are those of the whole, but for the series,
/// which go on from those of the ranks before. No second solution tells an error. An unknown number that no
/// condition depends on is told as Solution::cannot_begin, by all ranks.
Solution solve_on_ranks(const Model& model, const Problem& problem, const Time& time, const Method& method,
                        const SolveOptions& options, Ranks& ranks, RankWork& work);

}   // namespace gnu::visibility("default")]]livens
