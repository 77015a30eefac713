// SPDX-License-Identifier: BSD-3-Clause
// Inertia along coordinates of joints: 1/2 a (dq/dt)^2 each. What solves a mechanism sees it as a mechanism
// beside it, whose points are bound to the coordinates; nobody else does. (docs/theory.md, "Inertia along
// coordinates")
#pragma once

#include <span>
#include <vector>

#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"

namespace livens::inline multibody_internal {

/// One coordinate with an inertia.
struct Rotor {
    int joint = 0;   ///< of the model
    JointCoordinate coordinate{};
    double inertia = 0;   ///< kg m^2, kg of displacements
};

/// In the order of joints and their coordinates.
std::vector<Rotor> rotors_of(const Model& model);

/// 1/2 sum a (dq/dt)^2.
double rotor_energy(std::span<const Rotor> rotors, std::span<const Matrix34> X, std::span<const Matrix34> V);

/// What the rotors of joints to the world have of momentum by their rates, linear and about the world's
/// origin: the world supplies its change.
struct RotorMomentum {
    Vector3 linear{}, angular{};
};
RotorMomentum rotor_momentum(const Model& model, std::span<const Rotor> rotors, std::span<const Matrix34> X,
                             std::span<const Matrix34> V);

/// By how much that about the origin changes a second although no rate does, since the axis of a second or
/// third angle turns: the world does not supply this part. Zero for joints with one coordinate.
Vector3 rotor_turning(const Model& model, std::span<const Rotor> rotors, std::span<const Matrix34> X,
                      std::span<const Matrix34> V);
/// Whether it may differ from zero.
bool turn_their_axes(const Model& model, std::span<const Rotor> rotors);

/// A model in which each rotor is a coordinate of a point mass (Body::is_rotor), x_k = rho q, and a joint
/// holds both together: its bodies, joints and rows come first and in their order. Multipliers, positions and
/// velocities of these are those of the model; the points have no weight and are no length of it.
class WithRotors {
public:
    explicit WithRotors(const Model& model);

    const Model& model() const { return whole_; }
    int n_bodies() const { return n_bodies_; }   ///< without rotors
    int n_joints() const { return n_joints_; }
    int n_rows() const { return n_rows_; }
    /// The body that stands for one in what is told: of a point that of its joint.
    int told_body(int body) const { return body < n_bodies_ ? body : second_[body - n_bodies_]; }

    /// Points where the coordinates are, with their rates.
    State with(const State& state) const;
    std::vector<Matrix34> without(std::span<const Matrix34> all) const;
    void take_off(State& state) const;
    /// Its points and their rows.
    void take_off(Motion& motion) const;

private:
    struct Place {
        Rotor rotor;
        int body, axis;
        double length;   ///< rho
    };

    Model whole_;
    int n_bodies_, n_joints_, n_rows_;
    std::vector<Place> places_;
    std::vector<int> second_;   // of each point, a body of the model
};

}   // namespace livens::inline multibody_internal
