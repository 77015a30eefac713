// SPDX-License-Identifier: BSD-3-Clause
// Element lengths found while marching, such that every element loses as much as it may.
#pragma once

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "livens/time/basis.h"
#include "livens/time/time_mesh.h"

namespace livens::inline spacetime_internal {

/// The velocity jump of an element that loses `error`: local_error() the other way round.
double velocity_jump_of(Points points, int degree, double error);

/// What accepted elements told.
struct AcceptedElementsTold {
    double sum_of_scales = 0;   // of log(h J^(-1 / (p + 1))): lengths at which elements see nothing
    int n_accepted = 0;
    bool tells_length = false;   // by some jump above rounding; else a sum of lower bounds
    double jump = 0;             // the largest, since it was asked for
};

/// Says where the next element ends, and hears how the last one went.
class StepSizeController {
public:
    /// `stops` ascend and become element ends: start, output times, jumps of loads, end. Elements aim at a
    /// local error of `tolerance` and are refused far above it.
    StepSizeController(Points points, int degree, double tolerance, double first_length,
                       std::vector<double> stops);

    /// End of the next element, which begins at t.
    double next_end(double t) const;
    /// Beyond, an element is refused: because it loses too much, or because it has not seen the motion.
    double largest_jump() const { return largest_jump_; }
    /// Of an element between two instants: less where a stop that was left lies inside, for a state is wanted
    /// there that is as accurate as those at element ends.
    double largest_jump(double start, double end) const;
    /// Stops where a state is wanted and nothing else, ascending, and the error that it may have: elements
    /// may end elsewhere.
    void sample_at(std::vector<double> stops, double error);
    /// Not start and end.
    bool may_leave(double stop) const;
    /// No element end must be at this stop any more, if it may be left.
    void leave(double stop);
    const std::vector<double>& left() const { return left_; }
    /// `steps`: of the iteration; `has_factor`: one that serves the next element if that is as long.
    void accepted(double length, double jump, int steps, bool has_factor = false);
    /// How many times as long the next element might be if the last one had taken fewer steps.
    double held_back() const { return held_back_; }
    /// The largest jump of elements that were accepted since it was last taken.
    double take_jump() { return std::exchange(seen_.jump, 0); }
    /// What such an element took costs more than shorter ones do: these go on for a while.
    void too_dear(double length);
    /// The next element is as long as this, if no stop is nearer.
    void shorten(double length) { length_ = length; }
    /// Else the next element would end where it begins.
    bool ascends() const;
    bool is_stop(double t) const;
    /// Whether shorter elements may help; if not they vanish.
    /// `most`: the jump it might have had; 0: largest_jump().
    bool rejected(double length, double jump, double most = 0);

    double end() const { return stops_.back(); }
    /// Length that the motion would have allowed up to here without any stops, and that of elements of
    /// another degree and tolerance (geometric means); 0: nothing was accepted yet.
    double mean_length() const { return mean_length(degree_, tolerance_); }
    double mean_length(int degree, double tolerance) const;
    /// By some jump above rounding, not lower bounds alone.
    bool tells_length() const { return seen_.tells_length; }
    /// Of the time between stops.
    double mean_stop() const;
    /// What elements of this mesh, which it made, have lost as a rule, in tolerances, where something else
    /// kept them much shorter, as the iteration does in fast vibrations; 1: nothing did, or stops.
    double lost(const TimeMesh& mesh) const;

private:
    double suggestion(double length, double jump) const;
    double trend_to(double scale);

    Points points_;
    int degree_;
    double tolerance_, length_, largest_jump_;
    double held_back_ = 1;
    std::pair<double, double> blind_{std::numeric_limits<double>::infinity(), 1};   // length, what it regains
    std::vector<double> stops_, left_;                                              // ascending
    std::pair<std::vector<double>, double> sampled_;   // stops that may be left, error
    // Of the last element that was refused: what is not solved yet, and how long elements may be in it.
    std::pair<double, double> last_refused_{0, 0};
    // h J^(-1 / (p + 1)) of the last two elements, at which they would see nothing; infinite: none.
    double scales_[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    AcceptedElementsTold seen_;
};

}   // namespace livens::inline spacetime_internal
