// SPDX-License-Identifier: BSD-3-Clause
// Configurations that the search for an equilibrium looks at.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/solvers/dense_matrix.h"
#include "livens/statics/resting_stops.h"
#include "livens/statics/statics.h"

namespace livens::inline statics_internal {

inline constexpr double largest_step = 0.5;   // lengths of the model, rad

enum class SearchOutcome { balanced, met_stop, no_numbers, unrestored, stuck, limit, cancelled };

/// One configuration at rest. Of those that are searched from also the principal stiffnesses.
struct RestPoint {
    std::vector<Matrix34> X;
    std::vector<double> states{};   // twists of bodies that hold states; empty: there are none
    std::vector<double> maps;
    std::unique_ptr<const Statics> statics;
    DenseMatrix directions;          // scaled twists by the coordinates of principal stiffness
    std::vector<double> stiffness;   // principal ones, ascending
    DenseMatrix skew;                // of the tangent, in these coordinates; empty where it has none
    std::vector<double> forces;      // along them
    double scale = 0;                // Statics::largest_stiffness

    double residual() const { return statics->residual; }
};

/// A model whose bodies are to rest, and what of it holds them: all joints, or those without stops and the
/// closed ones.
struct HeldAtRest {
    const Model* whole;
    const RestingStops* stops;
    std::vector<int> closed;   ///< stops
    ActingModel part;          ///< where there are stops with what tells how far bodies are from them

    HeldAtRest(const Model& model, const RestingStops& all, std::vector<int> which);
};

class Search {
public:
    Search(const HeldAtRest& held, const ConsistentStart& closed);

    /// Turns go on from there.
    void goes_on_from(const Search& before)
    {
        state_.angles = before.state_.angles;
        counted_ = before.counted_;
    }
    const Model& model() const { return held_.part.model; }
    const ModelTables& tables() const { return tables_; }

    /// Forces in this configuration; false if they are no numbers or a free motion has no inertia.
    bool look(std::vector<Matrix34> X, RestPoint& point);
    /// The open stop beyond which bodies were farthest where it looked last, and how far, of the scale of its
    /// row; -1: there is none.
    struct Depth {
        int stop = -1;
        double depth = 0;
    };
    Depth deepest() const;
    std::vector<double> depths() const;
    /// Coordinates of each joint where it looked last, with the turns on the way there.
    std::vector<std::vector<double>> coordinates() const;
    /// Principal stiffnesses, at the configuration that was looked at last.
    void add_stiffness(RestPoint& point) const;
    /// Largest displacement of a body, in lengths of the model, or turn.
    double size_of(const RestPoint& point, const std::vector<double>& step) const;
    /// Where a step leads to, joints closed. False if they do not close.
    bool move(const RestPoint& from, const std::vector<double>& step, std::vector<Matrix34>& X) const;
    /// The same by plain twists; what holds states stays.
    bool move_by(const RestPoint& from, const std::vector<double>& twists, std::vector<Matrix34>& X) const;
    /// As plain twists, of a step in coordinates of free motions.
    std::vector<double> twists(const RestPoint& at, const std::vector<double>& free) const;
    bool holds_states(int body) const
    {
        return model().bodies()[static_cast<std::size_t>(body)].holds_states();
    }
    /// Velocities of what holds states, as RestPoint has them; and back.
    std::vector<double> states_of(const State& state) const;
    std::vector<Matrix34> velocities_of(const std::vector<double>& states) const;
    /// Of such velocities, in sizes of the states.
    double size_of_states(const std::vector<double>& twists) const;
    /// Work of weight and loads on the straight way between two configurations, by the trapezoidal rule:
    /// exact for weight and for forces that are constant or linear in X. What is small is the difference of
    /// large numbers there, and taken from what joints leave free.
    static double work(const RestPoint& from, const RestPoint& to, const std::vector<double>& step,
                       double size);

    /// The state that was looked at last.
    const InstantState& state() const { return state_; }
    const std::vector<double>& acceleration() const { return acceleration_; }
    int bad_load(const std::vector<Matrix34>& X) const;

private:
    struct Counted {
        const NamedCoordinate* q;
        double stated, value;
    };
    /// Each angle the shorter way.
    void follow_joints(std::span<const Matrix34> X);

    const HeldAtRest& held_;
    ModelTables tables_;
    InstantSystem instant_;
    InstantState state_;
    std::vector<int> rows_;
    std::vector<double> acceleration_;
    std::vector<Counted> counted_;   // of all joints of the whole
    double t_;
};

}   // namespace livens::inline statics_internal
