// SPDX-License-Identifier: BSD-3-Clause
// A motion as accurate as is asked for.  (docs/theory.md, "To an accuracy")
#pragma once

#include <functional>
#include <vector>

#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/solve.h"

namespace livens::inline spacetime_internal {

/// A march on its way.
struct MarchStatus {
    const Motion& motion;   ///< so far
    double mean_length;     ///< of its elements, s
    long long evaluations;
};
/// True: the march ends there, with SolveStatus::cancelled.
using StopPredicate = std::function<bool(const MarchStatus&)>;

/// Times the time of the motion: a vibration so fast may be one that nobody asked for.
inline constexpr double fast_vibration = 50;

/// In which velocities or weights move or turn something by half a length of the model or half a radian.
double time_of_motion(const Model& model, const State& state);

/// Marches with elements as long as their local errors allow, with a second solution beside, and again with
/// shorter ones until the global estimate is within the accuracy: six times at most, and once more where that
/// may be chance. What comes back is not judged. The method is nodal, the state given at the start; degree 0
/// is chosen.
/// `ends`: closed.
Solution solve_to_accuracy(const Model& model, const Problem& problem, const Ends& ends, const Span& span,
                           const Method& method, const SolveOptions& options,
                           const StopPredicate& stops = {});

/// Instants that become element ends: start, end, output times, jumps of loads and drives.
std::vector<double> stops_of(const Model& model, const Span& span);

/// With conditions at both ends: elements of lobatto are solved all together, and again with others that lose
/// alike, until the second solution is within the accuracy, ten times at most.
Solution solve_between_ends(const Model& model, const Problem& problem, const Ends& ends, const Span& span,
                            const Method& method, const SolveOptions& options);

/// Of a motion between both ends what its arrival is to its start, in the report. It may be stopped.
void find_arrival(const Model& model, const Problem& problem, const SolveOptions& options,
                  Solution& solution);

/// The same by lobatto or radau; a note says why radau was taken, and of which body, spring or joint.
Solution solve_to_accuracy(const Model& model, const Problem& problem, const Ends& ends, const Span& span,
                           const AutomaticFamily& automatic, const SolveOptions& options);

}   // namespace livens::inline spacetime_internal
