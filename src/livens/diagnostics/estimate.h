// SPDX-License-Identifier: BSD-3-Clause
// How far a motion is from the true one: by another solution of higher order.
#pragma once

#include <limits>
#include <vector>

#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"

namespace livens {

/// Estimated errors at the element ends of a motion; empty where there is none.
///
/// They are global: what was lost in one element is carried on, and grows, as in the motion itself.
struct ErrorEstimate {
    int n_bodies = 0;
    int n_joints = 0;
    // Entry end * n_bodies + body.
    std::vector<double> position;      ///< of the centre of mass, in lengths of the model
    std::vector<double> orientation;   ///< rad; 0 for point masses
    std::vector<double> velocity;      ///< m/s, of the centre of mass
    /// Of a joint's force, or torque by the length of the model, relative to the largest of the run; entry
    /// end * n_joints + joint. Empty where the motion has no reactions at element ends.
    std::vector<double> reaction;
    double largest = std::numeric_limits<double>::quiet_NaN();   ///< of all positions and orientations
    double time = 0;                                             ///< of that, s
    int body = -1;                                               ///< likewise

    bool empty() const { return position.empty(); }
    /// Digits that all positions and orientations have up to an element end: -log10 of the largest.
    double digits(int end) const;
};

/// The distance of a motion from a finer one, which may come piece by piece. In a closed loop with redundant
/// rows reactions are the least.
class ErrorMeter {
public:
    /// `factor`: 1 where the error of the finer one is smaller by an order of magnitude, 1 / (1 - 2^-p) for a
    /// method of order p with half the steps. References must outlive the meter.
    ErrorMeter(const Model& model, const Motion& motion, double factor = 1);

    /// At the element ends first..last of the motion, all of which `finer` has.
    void compare(const Motion& finer, int first, int last);
    /// What was not compared is not a number.
    ErrorEstimate take();

private:
    void compare_states(int end, const State& a, const State& b);
    void compare_reactions(int end, const Motion& finer);

    const Model& model_;
    const Motion& motion_;
    double factor_, length_;
    double largest_load_ = 0;
    ErrorEstimate estimate_;
};

}   // namespace livens
