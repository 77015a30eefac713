// SPDX-License-Identifier: BSD-3-Clause
// The mechanism: bodies, joints, loads and gravity.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "livens/base/linear.h"
#include "livens/multibody/body.h"
#include "livens/multibody/joints.h"
#include "livens/multibody/loads.h"
#include "livens/multibody/sensors.h"

namespace [[gnu::visibility("default")]] livens {

/// Configurations X and their rates V = dX/dt of all bodies at one time.
struct State {
    double t = 0;
    std::vector<Matrix34> X;
    std::vector<Matrix34> V;
    std::vector<double> angles{};   ///< of loads, with full turns; empty: no full turns
};

/// A mechanism. Build it with the add_ functions; afterwards it is constant. Functions in it (laws of loads,
/// drives, rows) must depend on their arguments alone, since their results are cached.
class Model {
public:
    explicit Model(const Vector3& gravity = {0, 0, 0});

    /// Each returns the index of the added part. Throw InputError for: a name that is empty, "world" or a
    /// duplicate; an invalid body index; a body with impossible mass properties; a joint without rows, with
    /// rows that violate the rules of ConstraintRow, or with drives that jump or have kinks; a load without
    /// forces; a part that needs directors on a point mass; numbers that are not finite.
    int add_body(Body body);
    int add_joint(Joint joint);
    int add_load(Load load);
    int add_sensor(Sensor sensor);

    const Vector3& gravity() const { return gravity_; }   ///< m/s^2
    const std::vector<Body>& bodies() const { return bodies_; }
    const std::vector<Joint>& joints() const { return joints_; }
    const std::vector<Load>& loads() const { return loads_; }
    const std::vector<Sensor>& sensors() const { return sensors_; }

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
    std::string body_name(int body) const { return body == world ? "world" : bodies_[body].name; }

    /// X and V of all bodies in the configuration of the model.
    State start() const;
    /// Whether any constraint depends on time.
    bool has_drives() const { return has_drives_; }
    /// Whether a load or row has kinks or jumps that depend on the motion; see Load::guards.
    bool has_pieces() const { return has_pieces_; }
    /// Whether joints act for part of the time only; solve() divides the motion there, see acting_at().
    bool has_events() const { return has_events_; }
    /// Times at which joints engage or are released, ascending, without duplicates.
    std::vector<double> events() const;
    /// Times at which a load has a jump or kink, a drive has a kink, or a joint engages or is released;
    /// ascending, without duplicates.
    std::vector<double> load_breaks() const;
    /// The model length (m), to which tolerances and errors are relative: in the configuration of the model,
    /// the largest of the radii of gyration, twice the distances of centres of mass from their mean, the
    /// distances between centres of mass and joint points, and those between the two points of a joint. If
    /// all distances are zero: the distance to an attracting point, or else 1. Always positive. Rigid motions
    /// of the model change it by rounding errors only.
    double length() const;
    /// Equal for copies, and different after each change, so that cached results can be matched to their
    /// model.
    std::uint64_t version() const { return version_; }

private:
    struct RowPlace {
        int joint;
        int row;
    };
    /// Cache of length(), 0 before the first call; concurrent calls compute the same value.
    struct Length {
        Length() = default;
        Length(const Length& other) : value(other.value.load(std::memory_order_relaxed)) {}
        Length& operator=(const Length& other)
        {
            value.store(other.value.load(std::memory_order_relaxed), std::memory_order_relaxed);
            return *this;
        }
        mutable std::atomic<double> value{0};
    };

    Vector3 gravity_;
    std::vector<Body> bodies_;
    std::vector<Joint> joints_;
    std::vector<Load> loads_;
    std::vector<Sensor> sensors_;
    std::vector<RowPlace> rows_;
    std::vector<int> first_rows_;
    bool has_drives_ = false;
    bool has_events_ = false, has_pieces_ = false;
    std::uint64_t version_ = 0;
    Length length_;

    void changed();
    friend Model frozen(const Model& model, Instant at);
};

/// The model with all constraints frozen at a time, without drives, for questions on positions alone.
Model frozen(const Model& model, Instant at);

/// A model with only the joints that act at a time; indices of these and their rows in the full model.
struct ActingModel {
    Model model;
    std::vector<int> joints, rows;
};
ActingModel acting_at(const Model& model, double t);

/// Weight of a body: F = g (m e_0)^T.
Matrix34 weight(const Body& body, const Vector3& gravity);

}   // namespace gnu::visibility("default")]]livens
