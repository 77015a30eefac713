// SPDX-License-Identifier: BSD-3-Clause
// From a scenario to a run that can be written: what programs that read scenarios do between both.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "livens/io/results.h"
#include "livens/io/scenario.h"
#include "livens/spacetime/solve.h"

namespace [[gnu::visibility("default")]] livens {

/// A motion that is not judged yet.
struct SolvedScenario {
    Solution solution;
    Problem problem;
    /// Of a scenario with unknown numbers: the one that begins with what was found. Null: there is none.
    std::shared_ptr<const Scenario> found{};
    double solve_seconds = 0;   ///< without what the estimate of the error took
};

/// solve() and estimate() of a scenario, with its options or others (whose `judge` does not count). Throws
/// what solve() throws. `guess`: see Problem.
SolvedScenario solve_scenario(const Scenario& scenario, SolveOptions options,
                              const std::shared_ptr<Prepared>& prepared,
                              std::function<State(double t)> guess = {});

/// judge(), and the run with all that the scenario says of it. `goes_on`: see judge().
Run judged_run(const Scenario& scenario, SolvedScenario&& solved, const std::function<bool()>& goes_on);

/// Notes of unknown numbers, with what was found as their guesses: "found: length = 1.113745597915 m, within
/// 3e-12"; or what the last iterate had.
void tell_found(const UnknownNumbers& found, Solution& solution);
/// Errors that are not known are nan.
RunNumbers numbers_of(const UnknownNumbers& found, std::vector<double> errors);

/// The scenario that was read from a run's file, with joints and loads as its motion decided. Throws IoError.
void take_events(const Run& run, Scenario& scenario);

/// The other motions that were found, see Solution::roots, which they leave.
std::vector<Run> judged_roots(const Scenario& scenario, SolvedScenario& solved,
                              const std::function<bool()>& goes_on);

}   // namespace gnu::visibility("default")]]livens
