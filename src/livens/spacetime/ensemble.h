// SPDX-License-Identifier: BSD-3-Clause
// Many motions, several at a time.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "livens/spacetime/solve.h"

namespace [[gnu::visibility("default")]] livens {

/// Arguments of one solve(). Models may be shared; their functions (loads, drives) and options.progress are
/// then called from several threads at once.
struct Variation {
    const Model* model = nullptr;
    Problem problem;
    Time time;
    Method method = Lobatto{};
    SolveOptions options{};
};

/// Solves each variation; results are in the same order. Their bits depend neither on `n_threads` nor on the
/// other variations; 0: one thread per processor. If any throw, the exception of the first in order is
/// rethrown when those in progress have ended.
std::vector<Solution> solve_all(std::span<const Variation> variations, int n_threads = 0);

/// Calls work(i) for all i < n on so many threads, started in order, and done(i) on the calling thread, in
/// order, as soon as work(i) has ended. With one thread, the calling thread alternates between both. An
/// exception of work(i) is rethrown instead of done(i); no further work is then started.
void run_in_order(int n, int n_threads, const std::function<void(int)>& work,
                  const std::function<void(int)>& done);

/// n_threads, or the number of processors for 0.
int threads_for(int n_threads);

}   // namespace livens
