// SPDX-License-Identifier: BSD-3-Clause
// Stops of a mechanism at rest: which hold bodies, with which forces, and how far those are from the others.
#pragma once

#include <span>
#include <vector>

#include "livens/dynamics/rows/load_tables.h"
#include "livens/multibody/events.h"
#include "livens/multibody/model.h"

namespace livens::inline statics_internal {

/// Of the stops that hold bodies: how they push, and whether others could do so instead.
struct Pushes {
    std::vector<double> push;   ///< of each; negative: it would have to pull
    std::vector<bool> is_unique;
    double noise = 0;   ///< smaller ones are none
};

/// Joints with ImpactLaw::open_side that an event closes, in the order of the joints. Numbers of stops are
/// places in this list.
class RestingStops {
public:
    RestingStops(const Model& whole, double t);

    int size() const { return static_cast<int>(joints_.size()); }
    const Joint& joint(int stop) const { return whole_.joints()[joint_index(stop)]; }
    std::size_t joint_index(int stop) const { return static_cast<std::size_t>(joints_[stop]); }

    /// The whole with the joints that act at the instant, and of stops those that are chosen.
    ActingModel holding(const std::vector<int>& closed) const;
    /// The same, which behind its loads has what depths() asks.
    ActingModel watching(const std::vector<int>& closed) const;
    /// How far bodies are beyond each stop, of the scale of its row; of a model of watching().
    std::vector<double> depths(const Model& watching, const LoadTables& loads, std::span<const Matrix34> X,
                               std::span<const double> angles) const;
    /// The same where angles are those within half a turn of the stated ones.
    std::vector<double> depths_near(std::span<const Matrix34> X) const;

    /// `multipliers`: of all rows of the model of holding() or watching(). `given`: weight and loads, 12 a
    /// body.
    Pushes pushes(const ActingModel& held, const std::vector<int>& closed, std::span<const Matrix34> X,
                  std::span<const double> multipliers, std::span<const int> independent,
                  std::span<const double> given) const;
    /// The one to let go: of those that others could replace the one that pushes least, else one that pulls;
    /// -1: none.
    static int to_release(const Pushes& pushes);

private:
    const Model& whole_;
    double t_;
    std::vector<int> joints_;
    std::vector<const Event*> closings_;
};

/// Stops at which a state of rest is, without those that others replace. Throws InputError: `event-method`
/// for one without a force, at which a small motion to one side is another than that to the other;
/// `stop-violated` beyond one; `not-in-equilibrium` for one that would have to pull.
std::vector<int> stops_of_rest(const RestingStops& stops, const State& state, Side side);

/// Beyond a stop by more than rounding. Throws InputError `stop-violated`.
void refuse_beyond_stops(const RestingStops& stops, std::span<const double> depths);

}   // namespace livens::inline statics_internal
