// SPDX-License-Identifier: BSD-3-Clause
// The one driver: windows in their order, guesses, progress, messages, and what to do about a window that
// fails.
#pragma once

#include <functional>
#include <string>

#include "livens/spacetime/march/partition.h"
#include "livens/spacetime/march/step_size_controller.h"
#include "livens/spacetime/march/window.h"
#include "livens/spacetime/options.h"
#include "livens/time/time_mesh.h"

namespace livens::inline spacetime_internal {

struct WindowOptions : DivisionOptions {
    SolveOptions solve;           ///< the caller's; what is below stands above them
    bool ends_at_bends = false;   ///< elements end where laws of loads bend, if forwards and alone
    bool has_state = true;        ///< at one end of time
    /// A window that fails leaves what its last iteration came to in the window's motion, to be looked at and
    /// as a guess; nothing of it counts as solved.
    bool keeps_iterate = false;
    double length_of_model = 1;   ///< m, what distances are relative to
    std::string advice{};         ///< what may help a window that failed; empty: what helps a march
    /// Guesses for the open window of elements first..last - 1, one attempt after the other from 0, where the
    /// window has none of its own or that one failed. Empty: no more. `is_march`: it is a motion from the
    /// same state, by a method of its own, with which the solution can be compared.
    struct Proposal {
        Guess guess;
        bool is_march = false;
    };
    std::function<Proposal(int first, int last, int attempt)> propose{};
    /// Why a motion that went from the first of these states to the second goes no further, if the joints are
    /// to blame; else empty.
    std::function<std::string(const State& first, const State& last)> locking{};
    /// Set: the mesh begins with the start alone and grows, one element a window, as the pace has it.
    StepSizeController* controller = nullptr;
    /// Called with a march forwards, and where it ends, after an element that took a tangent, or slopes of
    /// loads: why it should go no further; else empty.
    std::function<std::string(const Motion& so_far, double until)> watch{};
    /// Called when elements were closed; false ends the march there, which is no failure.
    std::function<bool()> goes_on{};
    /// See Problem; the report has what it says.
    std::function<std::vector<int>(const Motion& so_far)> fired{};
};

/// Solves all windows of the mesh, or as many as go. What happened is in the report, what was solved in the
/// window's motion. The mesh, which the window reads too, gets an end more for every element that is divided.
void solve_windows(Window& window, TimeMesh& mesh, const WindowOptions& options, SolveReport& report);

}   // namespace livens::inline spacetime_internal
