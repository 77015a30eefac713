// SPDX-License-Identifier: BSD-3-Clause
// The mechanism: bodies, joints, loads and gravity.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "livens/base/linear.h"
#include "livens/multibody/body.h"
#include "livens/multibody/displacement.h"
#include "livens/multibody/events.h"
#include "livens/multibody/joints.h"
#include "livens/multibody/loads.h"
#include "livens/multibody/sensors.h"
#include "livens/multibody/state.h"

namespace [[gnu::visibility("default")]] livens {

/// A place of a body, or of the world, by its name.
struct NamedPoint {
    std::string name;
    int body = world;
    Vector3 position{};   ///< m, in coordinates of the body
};

/// Indices of the first body, joint, .. of another model in the one to which it was added; the others follow
/// in their order.
struct AddedParts {
    int body = 0, joint = 0, load = 0, sensor = 0, point = 0;
};

/// Model::length(), 0 where nobody has asked: threads that do so at once find the same.
struct KnownLength {
    KnownLength() = default;
    KnownLength(const KnownLength& other) : value(other.value.load(std::memory_order_relaxed)) {}
    KnownLength& operator=(const KnownLength& other)
    {
        value.store(other.value.load(std::memory_order_relaxed), std::memory_order_relaxed);
        return *this;
    }
    mutable std::atomic<double> value{0};
};

/// When joints and loads act, as events have decided: those of no entry act as stated.
struct DecidedTimes {
    std::vector<std::vector<TimeSpan>> joints, loads;
};

/// What a model has of things that not every engine takes.
struct ModelParts {
    bool drives = false, events = false, pieces = false, rotors = false;
};

/// A mechanism is built by the add_ functions and constant from then on; all others take it const. Functions
/// in it (laws of loads, drives, rows) depend on their arguments alone: what was found with them is kept.
class Model {
public:
    explicit Model(const Vector3& gravity = {0, 0, 0});

    /// Each returns the index of what was added. They throw InputError: a name given twice, empty or "world";
    /// an index of a body that does not exist; a body that no MassProperties describe; a joint without rows
    /// or with rows that break the rules of ConstraintRow, or with drives that jump or kink; a load without
    /// forces; what needs directors on a point mass; numbers that are not finite.
    int add_body(Body body);
    int add_joint(Joint joint);
    int add_load(Load load);
    int add_sensor(Sensor sensor);
    /// Also throws for the name of a body, and for a place of a point mass other than its own.
    int add_point(NamedPoint point);
    /// Also throws for an action on what is not there, or is not stated to be decided by events.
    int add_event(Event event);
    /// Also throws for a period that is not positive, and states that no body holds.
    int add_sampling(Sampling sampling);

    const Vector3& gravity() const { return gravity_; }   ///< m/s^2
    const std::vector<Body>& bodies() const { return bodies_; }
    const std::vector<Joint>& joints() const { return joints_; }
    const std::vector<Load>& loads() const { return loads_; }
    const std::vector<Sensor>& sensors() const { return sensors_; }
    const std::vector<NamedPoint>& points() const { return points_; }
    const std::vector<Event>& events() const { return events_; }
    const std::vector<Sampling>& samplings() const { return samplings_; }

    /// Brings in all of another model, displaced, with a prefix before its names. What it says of the world's
    /// axes and places turns and moves along: points and axes there, forces in world axes, paths of drives,
    /// and the axes of its sensors and of what loads tell of themselves, so that laws that read them stay
    /// what they were. Gravity is that of this model and does not turn. Throws InputError, and nothing is
    /// added: `name-duplicate`, naming the part; `gravity-differs` if it has another gravity that is not
    /// zero; `directors-not-orthonormal` and the like of the rotation.
    AddedParts add(const Model& other, const std::string& prefix, const Displacement& by = {});

    int n_bodies() const { return static_cast<int>(bodies_.size()); }
    int n_rows() const { return static_cast<int>(rows_.size()); }   ///< of all joints, in their order
    /// Row r of the model belongs to joint `row_joint(r)` and is its row number `row_in_joint(r)`.
    const ConstraintRow& row(int r) const { return joints_[rows_[r].joint].rows[rows_[r].row]; }
    int row_joint(int r) const { return rows_[r].joint; }
    int row_in_joint(int r) const { return rows_[r].row; }
    int first_row(int joint) const { return first_rows_[joint]; }
    /// "joint 'elbow' (row 'x')"
    std::string row_name(int r) const
    {
        return "joint '" + joints_[row_joint(r)].name + "' (row '" + row(r).label + "')";
    }

    /// Index by name; -2 if there is none. `find_body("world")` is the world.
    int find_body(const std::string& name) const;
    int find_joint(const std::string& name) const;
    int find_point(const std::string& name) const;
    std::string body_name(int body) const { return body == world ? "world" : bodies_[body].name; }

    /// X and V of all bodies as they were given.
    State start() const;
    /// Whether rows depend on time.
    bool has_drives() const { return has_.drives; }
    /// Whether the law of a load or row bends or jumps where the motion decides; see Load::guards.
    bool has_pieces() const { return has_.pieces; }
    /// Whether joints act for a part of the time, controllers are asked at instants, or the motion decides
    /// something; these are what solve() divides time by, see acting_at().
    bool has_events() const { return has_.events; }
    /// Whether coordinates of joints have inertias, see rotors.h.
    bool has_rotors() const { return has_.rotors; }
    /// When joints begin or end to act, and loads as events have it, ascending, without repetition.
    std::vector<double> event_times() const;
    /// All instants where a load jumps or bends, a drive bends, or a joint begins or ends to act, ascending,
    /// without repetition.
    std::vector<double> load_breaks() const;
    /// A length typical of the model (m), at the start: the largest of the bodies' radii of gyration, twice
    /// the distances of their centres of mass from the mean of these, the arms from centres of mass to joint
    /// points, the lengths between the two points of a joint; if there are no distances, those from what
    /// attracts. Always positive: 1 if there is nothing to measure but rounding. Tolerances are relative to
    /// it. Moving and turning the model changes it by rounding only.
    double length() const;
    /// The same for copies, and another after each change, so that what was found of a model is known to be
    /// of it.
    std::uint64_t version() const { return version_; }

private:
    struct RowPlace {
        int joint;
        int row;
    };
    Vector3 gravity_;
    std::vector<Body> bodies_;
    std::vector<Joint> joints_;
    std::vector<Load> loads_;
    std::vector<Sensor> sensors_;
    std::vector<NamedPoint> points_;
    std::vector<Event> events_;
    std::vector<Sampling> samplings_;
    std::vector<RowPlace> rows_;
    std::vector<int> first_rows_;
    ModelParts has_;
    std::uint64_t version_ = 0;
    KnownLength length_;

    void changed();
    friend Model frozen(const Model& model, Instant at);
    friend Model as_decided(const Model& model, const DecidedTimes& times);
    friend void bind_reaction_laws(Model& model);
};

/// The model with all rows as they are at an instant, without drives: for what is asked of positions alone.
Model frozen(const Model& model, Instant at);

/// The model of a motion whose events have come out so. Empty times: as it was stated.
Model as_decided(const Model& model, const DecidedTimes& times);

/// A model with the joints alone that act at an instant, and where they and their rows are in the whole one.
struct ActingModel {
    Model model;
    std::vector<int> joints, rows;
};
ActingModel acting_at(const Model& model, double t);

/// Load::type of what changes states of controllers, or tells them.
inline constexpr std::string_view controller_type = "controller";
/// Whether it does no more than change states of controllers.
bool acts_on_states(const Model& model, const Load& load);

/// Weight of a body: F = g (m e_0)^T; of what is no matter none.
Matrix34 weight(const Body& body, const Vector3& gravity);

}   // namespace livens
