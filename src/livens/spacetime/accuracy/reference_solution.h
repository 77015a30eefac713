// SPDX-License-Identifier: BSD-3-Clause
// A second, finer solution that follows the first one and tells its error.
#pragma once

#include <optional>

#include "livens/spacetime/solve.h"

namespace livens::inline spacetime_internal {

/// The same problem with one or two degrees more (two: lobatto from degree 4, under loads or in elements
/// that hardly resolve the motion; mixed and the classical rules: by witness_of() them) on the same elements,
/// of which it may divide some. It goes on from its own end states, so what it finds are global errors.
/// Nothing of it is kept but these.
class ReferenceSolution {
public:
    /// References must outlive it; the motion may grow. `method` is that of the first solution.
    ReferenceSolution(const Model& model, const Problem& problem, const Method& method,
                      const SolveOptions& options, const Motion& first);

    /// Events of the first motion that it has to have as well, at instants of its own. Where it has others,
    /// differs_from() tells since when.
    void expect(const std::vector<SolvedEvent>& events) { events_ = events; }
    const std::vector<SolvedEvent>& events() const { return events_; }   ///< with their errors
    double differs_from() const { return differs_from_; }                ///< s; nan: it does not

    /// From where it is to an element end of the first motion; `jump`: the largest velocity jump of these
    /// elements, where it is known. False: it failed, see report().
    bool advance(int end, std::optional<double> jump = {});
    int reached() const { return at_; }   ///< element end
    const ErrorEstimate& so_far() const { return meter_.so_far(); }
    const SolveReport& report() const { return report_; }   ///< of what was solved last
    long long evaluations() const { return evaluations_; }
    double seconds() const { return seconds_; }
    /// What is known of unknown numbers by those that it has found itself.
    void tell_numbers(FoundNumbers& first) const;
    /// Up to an element end of the first motion.
    ErrorEstimate take(int last) { return meter_.take(last); }

private:
    TimeMesh mesh_between(int first, int last) const;
    bool ends_by_event(int end) const;
    void compare_events(Solution& second, double start, double end);

    const Model& model_;
    Problem problem_;   // of what is to come
    Method method_;
    SolveOptions options_;
    const Motion& first_;
    ErrorMeter meter_;
    bool is_backwards_, is_lobatto_;
    int at_;
    SolveReport report_;
    long long evaluations_ = 0;
    double seconds_ = 0;
    std::vector<double> numbers_;   // that it found
    std::vector<SolvedEvent> events_;
    double differs_from_ = std::numeric_limits<double>::quiet_NaN();
};

/// Bounces that were left out where stops close (SolveOptions::lowest_hop): both solutions leave them out.
void add_rests(const Model& model, const std::vector<SolvedEvent>& events, const Motion& motion,
               double lowest_hop, ErrorEstimate& found);

/// Of what rounding may move a motion between both ends by, if all of it went the worst way: what it does
/// move it by.
inline constexpr double rounding_share = 0.5;

/// Vibrations that radau's elements do not resolve are taken by any degree alike, so that the second solution
/// does not tell: the energy that was lost bounds how far they went. Nothing where dampers are faster, and
/// for lobatto.  (docs/theory.md, "What radau takes")
void add_lost_vibrations(const Model& model, const Motion& motion, ErrorEstimate& found);

/// States that are wanted inside of elements, since the joints lose rank there, are those of polynomials:
/// their elements' velocity jumps bound how far these are off.
void add_inside(const Model& model, const Motion& motion, const std::vector<double>& instants,
                ErrorEstimate& found);

/// What events add to errors, and no second solution tells: how far joints that begin miss the motion, which
/// both solutions are moved by; and vibrations that elements do not resolve, whose phase, where a joint lets
/// go, becomes a velocity that goes on. Of lobatto, its speed is at most the velocity jump of such elements;
/// of radau, that of the energy that was taken.
void add_events(const Model& model, const Motion& motion, ErrorEstimate& found);

/// Where it is more the motion is beyond its horizon, which the verdict tells.
constexpr double growth_at_horizon = 1e11;
/// What an element is off by in units of the motion in it, for each of what rounding reaches: some spacings
/// of numbers, and what an iteration to this tolerance leaves as a rule.
double rounded_by(double tolerance);
/// Whether this leaves open if rounding is below what is told, so that it has to be measured by itself.
bool is_rounding_open(const Growth& grown, double told, double tolerance);
/// What was measured by itself, times that: as Solution::rounding has it.
std::vector<double> told_of_rounding(const Growth& grown, double tolerance);
/// What rounding has grown to at element ends, up to the horizon, in lengths of the model and rad: as was
/// measured, or by the growth of the start; see growth().
std::vector<double> grown_rounding(std::span<const double> growth, std::span<const double> measured);
/// What an estimate leaves open, for growth(): where rounding may be more it counts.
double told_without_rounding(const ErrorEstimate& found);
/// Both solutions begin with the same rounded numbers, so that their distance does not tell what that costs:
/// no estimate is below what rounding has grown to by then.
void count_rounding(const Model& model, std::span<const double> rounding, const TimeMesh& mesh,
                    ErrorEstimate& found);

}   // namespace livens::inline spacetime_internal
