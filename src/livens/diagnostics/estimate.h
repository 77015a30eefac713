// SPDX-License-Identifier: BSD-3-Clause
// How far a motion is from the true one: by another solution of higher order.
#pragma once

#include <limits>
#include <vector>

#include "livens/diagnostics/sample.h"
#include "livens/multibody/motion.h"

namespace [[gnu::visibility("default")]] livens {

/// How far two states of one body are apart.
struct BodyGap {
    /// Between the centres of mass, in lengths of the model; of a body that holds states between these, by
    /// their size.
    double position = 0;
    double orientation = 0;   ///< rad; 0 for point masses
    double velocity = 0;      ///< m/s, of the centre of mass
    double rate = 0;          ///< rad/s, of the directors
};
BodyGap gap_between(const State& a, const State& b, const Body& body, int index, double length);

/// Between two reactions of a joint, or of all of one: forces, and torques by the length of the model, N.
double gap_between(const JointSample& a, const JointSample& b, double length);
double size_of(const JointSample& joint, double length);

/// What the laws of loads did inside of an element that its load points did not see: both solutions may miss
/// it alike (docs/theory.md, "Looks at laws").
struct Unseen {
    double t = 0;          ///< element end, s
    double duration = 0;   ///< of the element, s
    double error = 0;      ///< how far bodies may be off at the end: in lengths of the model, or rad
    int load = -1;         ///< that does most; -1: all was seen
    /// What each body is kicked by: lengths of the model by s, and rad/s.
    std::vector<double> shift{}, turn{};
};

/// The largest error, and who has it.
struct LargestError {
    double largest = std::numeric_limits<double>::quiet_NaN();   ///< of all positions and orientations
    double time = 0;                                             ///< of that, s
    int body = -1;                                               ///< likewise
    /// Of `largest`, what the laws of loads did unseen inside of elements; and the load that did most of it,
    /// and where.
    double unseen = 0;
    int unseen_load = -1;
    double unseen_time = 0;
};

/// Estimated errors at the element ends of a motion; empty where there is none.
///
/// They are global: what was lost in one element is carried on, and grows, as in the motion itself.
struct ErrorEstimate : LargestError {
    int n_bodies = 0;
    int n_joints = 0;
    // Entry end * n_bodies + body.
    std::vector<double> position;      ///< of the centre of mass, in lengths of the model
    std::vector<double> orientation;   ///< rad; 0 for point masses
    std::vector<double> velocity;      ///< m/s, of the centre of mass
    /// Of a joint's force, or torque by the length of the model, relative to the largest of the run; entry
    /// end * n_joints + joint. Empty where the motion has no reactions at element ends.
    std::vector<double> reaction;
    double length = std::numeric_limits<double>::quiet_NaN();             ///< of the model, m
    double largest_reaction = std::numeric_limits<double>::quiet_NaN();   ///< of all joints and ends, N

    bool empty() const { return position.empty(); }
    /// The largest of all bodies' positions and orientations at an element end.
    double error(int end) const;
    /// Digits that all positions and orientations have: -log10 of the largest, 0 to 16.
    double digits() const;
    /// Of all that can be said as "n digits until t" what says most: n (t - start) is largest. Whole digits.
    struct Good {
        double digits = 0;
        double until = 0;   ///< an element end, s
    };
    Good good(const TimeMesh& mesh) const;

    /// At t the error of one of `n` bodies or joints: at an element end its own, between two ends the larger,
    /// which is that of the elements alone, not of the polynomial between them. nan where there is none.
    static double at(const std::vector<double>& errors, int n, int index, const TimeMesh& mesh, double t);
    /// Sets largest, time and body.
    void find_largest(const TimeMesh& mesh);
};

/// The distance of a motion from a finer one, which may come piece by piece. In a closed loop with redundant
/// rows reactions are the least.
class ErrorMeter {
public:
    /// References must outlive the meter.
    ErrorMeter(const Model& model, const Motion& motion);

    /// The place at this element end is given, so that two solutions have the same one there. It counts where
    /// their velocities at it would be apart by, after the element beside it.
    void has_given_place(int end) { given_places_.push_back(end); }

    /// At the element ends first..last of the motion, of which `finer` has these two. Where it has one of its
    /// own instead, since a law bends there, the larger error of the two beside it stands.
    void compare(const Motion& finer, int first, int last);
    /// Adds what the laws of loads did unseen in the finer motion between these element ends of this one.
    void add(const std::vector<Unseen>& unseen, int first, int last);
    /// The largest error so far, when, and of which body.
    const ErrorEstimate& so_far() const { return estimate_; }
    /// Up to an element end of the motion. What was not compared is not a number.
    ErrorEstimate take(int last);

private:
    void reach(int end);
    void compare_states(int end, const State& a, const State& b);
    void compare_reactions(int end, std::vector<JointSample>& a, std::vector<JointSample>& b, Side side);
    void fill(int end);

    const Model& model_;
    const Motion& motion_;
    ErrorEstimate estimate_;
    // Kicks so far, and their sums with the instants from which they count.
    struct Kicks {
        double rate = 0, moment = 0;
    };
    std::vector<Kicks> shifts_, turns_;
    double largest_kick_ = 0;
    std::vector<int> given_places_;   // element ends
};

}   // namespace livens
