// SPDX-License-Identifier: BSD-3-Clause
// What is measured and said of windows: of those that failed, and after all were solved.
#pragma once

#include <span>
#include <string>

#include "livens/solvers/newton.h"
#include "livens/solvers/report.h"
#include "livens/spacetime/march/window.h"
#include "livens/time/time_mesh.h"

namespace livens::inline spacetime_internal {

/// Largest distance of points, by the length, and of directors.
double distance_between(std::span<const Matrix34> X, std::span<const Matrix34> others, double length);

/// What the report itself does not hold.
struct WindowCounts {
    double tolerance = 0;
    int rounded = 0;         ///< windows that ended by rounding, short of the tolerance
    int splits = 0;          ///< windows that were solved in halves
    int bends = 0;           ///< element ends where a law of a load bends
    bool has_state = true;   ///< at one end of time: guesses are marches from there
};
void add_notes(SolveReport& report, const WindowCounts& counts);

/// "element 3 (t = 1 to 2 s)", "the window of elements 3 to 5 (t = 1 to 4 s)" (last is behind it).
std::string window_at(const TimeMesh& mesh, int first, int last);

/// Why Newton's iteration did not solve a window, and what to try: `advice`, or what fits the status.
std::string of_failure(const NewtonReport& outcome, int max_iterations, const std::string& window,
                       const WorstResidual& worst, std::string advice);

/// Of a window that says nothing of the motion although its equations are met.
std::string of_spurious_root(const std::string& window);

/// As the caller asked, after a window that ends at t.
std::string of_stop(double t);

/// Why a march at a pace ends at t: elements vanish (for the law of this load); or one must end where the
/// joints lose rank.
std::string of_vanishing(double t, const std::string& load);
std::string of_singular_end(double t);

/// See WindowOptions::locking.
std::string of_locking(const Model& model, const State& first, const State& last);
/// Where the motion stays at a jump of this load.
std::string of_sticking(const std::string& load, double t);
/// Elements of that length, for long.
std::string of_crawling(const std::string& load, double t, double length);

/// Of a motion that ends as it began after `period`, and one later is off by that, most at t.
std::string of_another_period(double period, double off, double t);

/// "1 element", "2 elements".
std::string count(int n, const char* what);

}   // namespace livens::inline spacetime_internal
