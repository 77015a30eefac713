// SPDX-License-Identifier: BSD-3-Clause
// What flows into a mechanism through loads and joints.
#pragma once

#include <span>
#include <vector>

#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/detail/motion_points.h"
#include "livens/dynamics/lanes/load_lanes.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/model.h"

namespace livens::inline diagnostics_internal {

/// Rates at an instant, or their integrals.
struct Supply {
    double work = 0;   ///< of loads without potential, and of drives
    Vector3 linear{};
    Vector3 angular{};         ///< about the world's origin
    double gross = 0;          ///< sum of |F|, what rounding in `linear` is relative to
    double gross_moment = 0;   ///< sum of |F| (|x| + length), likewise in `angular` and in energies

    void add_force(const Matrix34& X, const Matrix34& F, double length);
    void add_size(const Matrix34& X, const Matrix34& F, double length);
    void add(double weight, const Supply& other);
};

/// What loads that are recorded supply, at the points of an element side by side.
class SupplyInLanes {
public:
    /// The tables must outlive it.
    explicit SupplyInLanes(const ModelTables& tables);

    /// Loads that are not recorded.
    const std::vector<int>& others() const;
    /// At all points of the element that the set is at; `turns`: those at its start.
    void find(const MotionPoints& set, const std::vector<double>& turns, std::vector<Supply>& points);

private:
    void put(const MotionPoints& set, int k, int lane);
    Supply taken(int lane) const;

    const ModelTables& tables_;
    LoadLanes lanes_;
    std::vector<int> bodies_;
    AlignedDoubles X_, V_;
    std::vector<double> turns_;
};

/// What loads supply, at the points where the method takes them.
class LoadSupply {
public:
    /// Both must outlive it.
    LoadSupply(const ModelTables& tables, const Motion& motion);

    bool empty() const { return model_.loads().empty(); }
    const LoadTurns& turns() const { return turns_; }

    /// Looks at all points of the element that the set is at.
    void go_to(const MotionPoints& set, int element);
    /// Rates at a point of it.
    const Supply& at(int k) const { return points_[static_cast<std::size_t>(k)]; }
    /// What loads make of positions off by their size, and of velocities off by that in h: as rounding is
    /// relative to the size, stiff loads amplify it. At the first point of the element. A scale is all that
    /// is asked for: it is what it was some elements before as long as elements and loads are about as large.
    const Supply& stiffness() const { return known_.stiffness; }

private:
    void add_load(int load, Instant at, Supply& now) const;
    void take_point(const MotionPoints& set, int k);
    void find_stiffness(const MotionPoints& set, int element);
    Supply all_stiffness(Instant at, double h) const;
    LoadArguments arguments(int load, Instant at) const
    {
        return load_arguments(model_.loads()[load], at, X_, V_, turns_.turns().of(load, angles_));
    }

    const Model& model_;
    const Motion& motion_;
    const LoadTurns turns_;
    SupplyInLanes recorded_;
    std::vector<Matrix34> X_, V_;   // of all bodies, at a point that is asked alone
    std::vector<double> angles_;    // there
    std::vector<Supply> points_;
    /// The last stiffness that was asked of loads, and how things were there.
    struct {
        Supply stiffness;
        double h = 0, gross = 0;
        int elements = 0;   // since then
    } known_;
};

}   // namespace livens::inline diagnostics_internal
