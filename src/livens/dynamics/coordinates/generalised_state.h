// SPDX-License-Identifier: BSD-3-Clause
// States of a mechanism in its own coordinates, and what is asked of one: mass matrix, forces, Jacobians,
// accelerations, small changes. (docs/theory.md, "States in coordinates")
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/model.h"

namespace [[gnu::visibility("default")]] livens {

inline namespace dynamics_internal {
struct [[gnu::visibility("hidden")]] Mechanism;
struct [[gnu::visibility("hidden")]] Placed;
struct [[gnu::visibility("hidden")]] StateParts;
}   // namespace dynamics_internal

/// What tells where a mechanism is: a coordinate of a joint, a coordinate of a body's reference point in the
/// world, or the orientation of a body.
struct GeneralisedCoordinate {
    enum class Of { joint, place, turn };
    Of of = Of::joint;
    int part = 0;       ///< joint or body, in the model that was given
    int index = 0;      ///< Joint::coordinate() of the joint, or which axis
    std::string name;   ///< "elbow.angle", "base.x", "base.quaternion"

    /// A turn is told by four numbers (w, x, y, z) and moves by three, its angular velocity in world axes.
    int n_numbers() const { return of == Of::turn ? 4 : 1; }
    int n_rates() const { return of == Of::turn ? 3 : 1; }
};

class GeneralisedState;

/// Independent coordinates of a model, which tell where all its bodies are as long as they are reached from
/// where these are placed.
///
/// Drives are released: whoever states the coordinates drives them. Joints that do not act at the instant are
/// left out. Chosen are the wanted ones, which may be components of the rotation vector of a ball joint; then
/// coordinates of joints, in the order of the model, numbered ones (angle_1) last; then what these leave
/// free, by positions and orientations of bodies: of a free body all six. In the list bodies stand before
/// joints.
///
/// Throws InputError: `coordinate-unknown`, `coordinate-twice`; `coordinates-dependent` for a wanted one that
/// joints or the wanted ones before it determine; `coordinates-missing` where something can still move, such
/// as the turns that a joint of constant velocity leaves; `coordinates-singular`; and what consistent_start()
/// throws.
class GeneralisedCoordinates {
public:
    GeneralisedCoordinates(const Model& model, const State& placed, StartPolicy policy,
                           const std::vector<std::string>& wanted = {});

    const std::vector<GeneralisedCoordinate>& list() const;
    int n_numbers() const;
    int n_rates() const;
    /// "elbow.angle"; of a turn "base.qw" to "base.qz".
    std::vector<std::string> names_of_numbers() const;
    /// "elbow.angle_rate", "base.x_rate"; of a turn "base.wx" to "base.wz".
    std::vector<std::string> names_of_rates() const;
    /// Numbers where bodies are placed: as joints count them.
    const std::vector<double>& placed() const;

    /// The state with these numbers, and these rates (empty: at rest). Bodies are led there from where they
    /// are placed: at once where joints form trees, else in small steps, so that the mechanism stays on its
    /// branch.
    ///
    /// Throws InputError: `coordinate-value` for what is not finite, or not as many as there are;
    /// `loop-open` where the joints do not close, with the one that stays open and by how much;
    /// `coordinates-singular` where the joints hold less, or the coordinates do not tell how the mechanism
    /// moves on, as at a dead centre.
    GeneralisedState at(std::span<const double> numbers, std::span<const double> rates = {}) const;

private:
    std::shared_ptr<const Mechanism> mechanism_;
    std::shared_ptr<const Placed> start_;
};

/// x' = A x + B u about a state: x are small changes of coordinates and rates (of a turn a rotation vector in
/// world axes), u generalised forces along the coordinates.
struct StateSlopes {
    int n = 0;                  ///< rates
    std::vector<double> A, B;   ///< 2 n x 2 n and 2 n x n, row by row
    std::vector<double>
        accelerations;   ///< q'' at the state itself, by the loads: it need not be in equilibrium
};

/// Where a point of a body is to be.
struct StateTarget {
    int body = 0;
    Vector3 point{};                      ///< in coordinates of the body
    Vector3 position{};                   ///< m, world
    std::optional<Matrix3> directors{};   ///< of the body, orthonormal; none: however it is turned
};

/// A state, and what follows from it. n are the rates; forces and rows of matrices are in their order,
/// matrices row by row; N along displacements, N m along angles.
class GeneralisedState {
public:
    explicit GeneralisedState(std::shared_ptr<const StateParts> parts);

    const State& state() const;                   ///< bodies of the model: X, V, time, turns of loads
    const std::vector<double>& numbers() const;   ///< angles with their turns
    const std::vector<double>& rates() const;
    /// Of each joint of model() all coordinates, as it counts them: turns included.
    std::vector<std::vector<double>> coordinates() const;
    const Model& model() const;   ///< of the joints that act, without drives

    /// M, n x n: symmetric, positive definite.
    std::vector<double> mass_matrix() const;
    /// h of M q'' + h = forces + loads: velocities and weight.
    std::vector<double> bias_forces() const;
    /// The part of h that is there at rest: what holds the mechanism against its weight.
    std::vector<double> gravity_forces() const;
    /// What the loads of the model do along the coordinates.
    std::vector<double> load_forces() const;
    /// M q'' + h - loads: forces that give these accelerations.
    std::vector<double> inverse_dynamics(std::span<const double> accelerations) const;
    /// q'' of the loads and of forces beside them; empty: none. Throws InputError `coordinates-singular`
    /// where M is not positive definite.
    std::vector<double> accelerations(std::span<const double> forces = {}) const;
    /// Velocity (rows 1 to 3) of a point of a body (its coordinates) and angular velocity (4 to 6), world
    /// axes, by the rates: 6 x n. The last three of a point mass are zero. Throws InputError `body-unknown`.
    std::vector<double> jacobian(int body, const Vector3& point = {}) const;
    /// Linear and angular acceleration of the same that is there without q'': J' q', 6 numbers.
    std::vector<double> drift(int body, const Vector3& point = {}) const;
    double kinetic_energy() const;
    double potential_energy() const;   ///< of weight, zero at the world's origin, and of loads

    /// Slopes of the accelerations. Loads by their tangents; what the mechanism adds by differences of sixth
    /// order, to some 1e-11 of it.
    StateSlopes slopes() const;

    /// The state at rest where a point of a body is at a target: led there in small steps along the straight
    /// way, each the least change of the coordinates. Throws InputError `pose-unreachable` with what is left,
    /// `coordinate-value`, `body-unknown`.
    GeneralisedState reaching(const StateTarget& target) const;

private:
    std::shared_ptr<const StateParts> parts_;
};

}   // namespace gnu::visibility("default")]]livens
