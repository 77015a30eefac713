// SPDX-License-Identifier: BSD-3-Clause
// Many motions, several at a time.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "livens/spacetime/solve.h"

namespace [[gnu::visibility("default")]] livens {

/// What solve() takes. The model may be shared; what it calls (loads, drives), and options.progress, is
/// called from several threads at once then.
struct Variation {
    const Model* model = nullptr;
    Problem problem;
    Time time;
    Method method = Lobatto{};
    SolveOptions options{};
};

/// solve() of each, in its order. No bit of them depends on `n_threads`, nor on what else is solved; 0: as
/// many as the machine has processors. What the first of them throws, by its place, is thrown when those that
/// had begun have ended.
std::vector<Solution> solve_all(std::span<const Variation> variations, int n_threads = 0);

/// work(i) for all i < n on that many threads, each begun in its turn, and done(i) on the calling thread, in
/// order, each as soon as work(i) has ended. With one thread the calling one does everything, in turns. What
/// work(i) throws is thrown in place of done(i); then nothing more is begun.
void run_in_order(int n, int n_threads, const std::function<void(int)>& work,
                  const std::function<void(int)>& done);

/// n_threads, or what 0 stands for.
int threads_for(int n_threads);

}   // namespace gnu::visibility("default")]]livens
