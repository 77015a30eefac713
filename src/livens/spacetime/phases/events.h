// SPDX-License-Identifier: BSD-3-Clause
// Joints that act for a part of the time divide it into phases: where these end, what must meet there, and
// how the motions of phases become one.
#pragma once

#include <string>
#include <vector>

#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"
#include "livens/solvers/report.h"
#include "livens/spacetime/options.h"
#include "livens/spacetime/solve.h"

namespace livens::inline spacetime_internal {

/// Instants inside of a time, not at its ends, where joints begin or end to act.
std::vector<double> events_inside(const Model& model, double start, double end);
/// Start, end, and what is between them where joints begin or end to act; of a mesh its element ends.
std::vector<double> phase_ends(const Model& model, const Time& time);

/// The motion of a phase with the multipliers of the whole model's rows.
void widen(Motion& motion, const Model& model, const ActingModel& acting);
/// One motion after the other, which begins where it ended. Where they meet the state is that of the first,
/// and each has its side of what has two.
/// `jumps`: there is an impact between them.
void join(Motion& whole, Motion&& next, bool jumps);

/// From an instant on, until another that it may have as an end; elements like those before.
Time part_of(const Time& time, double first, double last, double accuracy, double first_length);

/// Velocities become others where the motion ends, as at an impact.
void jump_at_end(Motion& motion, const Model& model, const std::vector<Matrix34>& V);

/// The motion up to its last element but one.
void drop_last(Motion& motion);

/// How far the joints that begin at an element end find the bodies from where they will hold them: what
/// closing moves, in lengths and rad, and changes of velocities, by the model's length. Infinite: it fails.
struct ActivationMismatch {
    double shift = 0, turn = 0, speed = 0, spin = 0;
};
ActivationMismatch activation_mismatch(const Model& model, const Motion& motion, int end);

/// A joint that begins where bodies are elsewhere, or move otherwise, would be an impact: false, and the
/// report says so, where what begins at an element end is off by more than the tolerance. `duration`: of all.
bool is_met(const Model& model, const Motion& motion, int end, double duration, double tolerance,
            SolveReport& report);

/// "'latch' begins to act at 0.5 s": joints that begin between two instants, for a motion that was not found;
/// empty: none does.
std::string begin_in_words(const Model& model, double start, double end);

/// Notes of a phase that begins at t, but for those that are known: when it was.
void date_notes(const std::vector<std::string>& known, double t, std::vector<std::string>& notes);
/// Why a motion ends where events follow each other without an end: n until t.
std::string of_storm(const Model& model, const std::vector<SolvedEvent>& events, std::size_t n, double t);

/// Notes on what joints did when they let go.
void tell_releases(const Model& model, const Motion& motion, const std::vector<double>& phase_ends,
                   SolveReport& report);

}   // namespace livens::inline spacetime_internal
