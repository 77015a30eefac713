// SPDX-License-Identifier: BSD-3-Clause
// All that a motion can tell of an instant, by name: what tables, peaks and plots are made of.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "livens/diagnostics/accelerations.h"
#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/sample.h"

namespace [[gnu::visibility("default")]] livens {

/// Whose quantities: of the whole model (energies), of bodies, ...
enum class QuantityOf { model, body, point, coordinate, reaction, drive, load, sensor };

/// A number, a vector (x, y, z) or a quaternion (w, x, y, z) that a motion has at every instant.
struct NamedQuantity {
    QuantityOf of;
    int index = 0;              ///< of the body, point, joint, load or sensor
    std::string part;           ///< its name; empty: the whole model
    std::string what;           ///< "force", "angle_rate"
    std::string unit;           ///< "m/s^2"
    int size = 1;               ///< how many numbers
    int first = 0;              ///< the place of its first one among those of all
    bool is_repeated = false;   ///< of a sensor that reads a load of its own name
    /// Told where it is named, and no part of tables of everything: it says anew what others say.
    bool is_on_request = false;
    int axes = world;   ///< of a reaction: the body in whose axes it is

    std::string name() const { return part.empty() ? what : part + "." + what; }
};

/// "x", ..; empty where there is but one.
std::string component_of(const NamedQuantity& quantity, int i);

/// An instant, and from which side it is seen: where loads jump, elements end, and reactions have two values.
struct SeenInstant {
    double t;
    Side side = Side::right;
};

/// Instants that show a motion as it is: every element at equal distances, by one more than the polynomial
/// has degrees and by 600 over all elements at the least, its ends among them; where accelerations or
/// reactions jump by more than 1e-9 of themselves, both sides of the instant.
std::vector<SeenInstant> dense_instants(const Motion& motion);
/// Ends of elements alone, each once.
std::vector<SeenInstant> end_instants(const Motion& motion);

/// The quantities of a model, some of which can be asked for together. Copies share what they have found.
class Quantities {
public:
    Quantities(const Model& model, const Motion& motion, const std::vector<std::string>& body_names);

    /// In the order of the model: energies, bodies, points, coordinates of joints, reactions, drives, loads,
    /// sensors.
    const std::vector<NamedQuantity>& all() const { return all_; }
    /// Numbers of all quantities together.
    int n_numbers() const { return n_numbers_; }
    /// Whether the motion knows reactions.
    bool has_reactions() const { return has_reactions_; }

    /// The numbers of `wanted` in a state at an instant of the motion, at their places among all; what else
    /// is in `numbers` stays as it is. Between element ends, where forces are among them, all are those of
    /// the nearest state that joints and drives allow, see Accelerations::on_joints(). nan: what a point mass
    /// has not, and where joints lose rank. `joints` are those of sample_exactly(), empty: the motion is
    /// asked.
    void at(const State& given, Side side, std::span<const NamedQuantity> wanted, std::span<double> numbers,
            std::span<const JointSample> joints = {}) const;

private:
    struct Sources;

    void add(QuantityOf of, int index, const std::string& part, const std::string& what,
             const std::string& unit, int size = 1);
    void add_points();
    void add_reactions(int joint);
    void add_parts();
    void put_bodies(const State& state, const AcceleratedState& accelerated,
                    std::span<const NamedQuantity> wanted, std::span<double> numbers) const;
    void put_points(const State& state, const AcceleratedState& accelerated,
                    std::span<const NamedQuantity> wanted, std::span<double> numbers) const;
    void put_joints(const State& state, Side side, std::span<const NamedQuantity> wanted,
                    std::span<const JointSample> joints, std::span<double> numbers) const;
    void put_loads(const State& state, Side side, std::span<const NamedQuantity> wanted,
                   std::span<double> numbers) const;

    const Model& model_;
    const Motion& motion_;
    std::shared_ptr<const Sources> sources_;
    std::vector<NamedQuantity> all_;
    int n_numbers_ = 0;
    bool has_reactions_;
};

/// What a drive along a coordinate of a joint does.
struct DriveEffort {
    JointCoordinate coordinate;   ///< of the driven joint

    /// The force (N) or torque (N m) along the coordinate that the reaction on the second body is.
    double of(const Joint& drive, std::span<const Matrix34> X, const Reaction& reaction) const;
};
/// Empty: the joint is no such drive.
std::optional<DriveEffort> drive_effort(const Joint& joint);
/// N: how much a rope pulls, of which the reaction on its second body is told; nan where its spans there pull
/// against each other alone.
double rope_tension(const Joint& rope, std::span<const Matrix34> X, const Reaction& reaction);
/// W: what a joint does on both of its bodies.
double joint_power(const Joint& joint, std::span<const Matrix34> X, std::span<const Matrix34> V,
                   const Reaction& reaction);

}   // namespace gnu::visibility("default")]]livens
