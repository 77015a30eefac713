// SPDX-License-Identifier: BSD-3-Clause
// Element lengths found while marching, such that every element loses as much as it may.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "livens/time/basis.h"

namespace livens {

/// The velocity jump of an element that loses `error`: local_error() the other way round.
double velocity_jump_of(Points points, int degree, double error);

/// Says where the next element ends, and hears how the last one went.
class Pace {
public:
    /// `stops` ascend and become element ends: start, output times, jumps of loads, end. Elements aim at a
    /// local error of `tolerance` and are refused far above it.
    Pace(Points points, int degree, double tolerance, double first_length, std::vector<double> stops);

    /// End of the next element, which begins at t.
    double next_end(double t) const;
    /// Beyond, an element is refused: because it loses too much, or because it has not seen the motion.
    double largest_jump() const { return largest_jump_; }
    /// `is_slow`: Newton's iteration took many steps, so that nothing is gained by longer elements.
    void accepted(double length, double jump, bool is_slow);
    /// The next element is as long as this, if no stop is nearer.
    void shorten(double length) { length_ = length; }
    bool is_stop(double t) const;
    /// Whether shorter elements may help; if not they vanish.
    bool refused(double length, double jump);

    double end() const { return stops_.back(); }
    /// Length that the motion would have allowed up to here without any stops, and that of elements of
    /// another degree and tolerance (geometric means); 0: nothing was accepted yet.
    double mean_length() const { return mean_length(degree_, tolerance_); }
    double mean_length(int degree, double tolerance) const;
    /// Of the time between stops.
    double mean_stop() const;

private:
    double suggestion(double length, double jump) const;

    Points points_;
    int degree_;
    double tolerance_, length_, largest_jump_;
    double blind_length_ = std::numeric_limits<double>::infinity(), regained_ = 1;
    std::vector<double> stops_;
    double sum_of_scales_ = 0;   // of log(h J^(-1 / (p + 1))): lengths at which elements see nothing
    int n_accepted_ = 0;
    bool tells_length_ = false;   // by some jump above rounding; else a sum of lower bounds
};

}   // namespace livens
