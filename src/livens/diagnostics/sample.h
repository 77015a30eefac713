// SPDX-License-Identifier: BSD-3-Clause
// A motion at single instants: poses, velocities, momenta and reactions as users want them.
#pragma once

#include <memory>
#include <vector>

#include "livens/dynamics/instant/reactions.h"
#include "livens/multibody/motion.h"

namespace [[gnu::visibility("default")]] livens {

struct Body;

/// One body at one instant. A point mass has no orientation: its directors, quaternion and angular velocities
/// are nan.
///
/// At element ends everything is of the method's full order, between them of the motion's dense orders; there
/// position is the polynomial, orientation its polar projection and velocity the derivative.
struct BodySample {
    Vector3 position{};                ///< of the reference point, m, inertial axes
    Vector3 center_of_mass{};          ///< m, inertial axes
    Matrix3 directors{};               ///< columns d1, d2, d3, as stated: a triad turned as the body is
    Matrix3 directors_raw{};           ///< of the motion, with its violation of rigidity
    Vector4 quaternion{};              ///< (w, x, y, z), body to world, w >= 0; of the nearest orthonormal
                                       ///< triad, where directors are skew
    Vector3 velocity{};                ///< of the reference point, m/s, inertial axes
    Vector3 angular_velocity{};        ///< rad/s, inertial axes
    Vector3 angular_velocity_body{};   ///< rad/s, components along the directors
    Vector3 linear_momentum{};         ///< N s, inertial axes
    Vector3 angular_momentum{};        ///< N m s about the world's origin, inertial axes
};

/// What a joint exerts on its second body, from both sides of an instant (they differ where a load jumps).
struct JointSample {
    Reaction left;
    Reaction right;
    bool is_acceleration_level =
        false;               ///< by the equations of motion at the instant; else between nodes' multipliers
    bool is_unique = true;   ///< false: other joints of a closed loop could carry part of it; then it is the
                             ///< least, see least_reactions()
    SharedComponents shared{};   ///< then: in which components
    bool is_bounded = true;      ///< false: the joints lose rank there; forces and torques are not numbers
};

/// `t`, or the element end that differs from it by no more than the rounding of decimal text and sums of
/// steps. Throws InputError (`time-outside`) if t is not finite or outside the motion.
double snap_to_element_end(const TimeMesh& mesh, double t);

/// The element end at exactly t, or -1.
int element_end_at(const TimeMesh& mesh, double t);

/// X and V of all bodies at t, after snap_to_element_end(); also for a motion that has only its start.
State sample_state(const Motion& motion, double t);

/// From state and momentum P = X' m of the body.
BodySample sample_body(const Body& body, const Matrix34& X, const Matrix34& V, const Matrix34& P);

/// All bodies at t, after snap_to_element_end(); or in a state that sample_state() gave.
std::vector<BodySample> sample_bodies(const Model& model, const Motion& motion, double t);
std::vector<BodySample> sample_bodies(const Model& model, const Motion& motion, const State& state);

/// q and -q are one orientation: the one nearer to the last, as only these can be interpolated.
inline Vector4 continued(const Vector4& last, const Vector4& q) { return dot(last, q) < 0 ? -1.0 * q : q; }

/// Times of a field's coefficients; with degree 0 the middles of the elements.
std::vector<double> node_times(const Field& field, const TimeMesh& mesh);

/// All joints at t, after snap_to_element_end(). Without any multipliers in the motion the list is empty.
std::vector<JointSample> sample_joints(const Model& model, const Motion& motion, double t);

class Accelerations;

/// sample_joints() at many instants: what follows from the model alone is made once. Copies share it.
class JointSampler {
public:
    JointSampler(const Model& model, const Motion& motion);
    /// Shares what these have found.
    JointSampler(const Model& model, const Motion& motion, const Accelerations& accelerations);

    /// In a state that sample_state() gave.
    std::vector<JointSample> at(const State& state) const;
    /// The same forces and torques at an element end (-1: between them) for less, without what is_unique and
    /// shared say of them.
    void forces_at(int end, const State& state, std::vector<JointSample>& samples) const;
    /// Where joints are redundant: the least reactions at an element end, of the multipliers on both sides,
    /// found once for those who ask one after the other. Null: there are none, or not for both sides.
    const UniqueReactions* least_at(const State& state, int end) const;

private:
    struct Parts;

    bool find_forces(int end, const State& given, std::vector<JointSample>& samples) const;

    const Model& model_;
    const Motion& motion_;
    std::shared_ptr<Parts> parts_;
};

}   // namespace livens
