// SPDX-License-Identifier: BSD-3-Clause
// Configurations that are searched for a rest: their forces and stiffness, and the ways between them.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/projection.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/body.h"
#include "livens/multibody/joint_coordinates.h"
#include "livens/solvers/spectral.h"
#include "livens/statics/statics.h"

namespace livens::inline statics_internal {

using Values = std::vector<double>;

inline constexpr double largest_step = 0.5;   // lengths of the model, rad

enum class Outcome { balanced, no_numbers, unrestored, stuck, limit, cancelled };

/// One configuration at rest. Of those that are searched from also the principal stiffnesses.
struct RestPoint {
    std::vector<Matrix34> X;
    Values held{};   // velocities of bodies that hold states, by twists; empty: there are none
    std::vector<double> maps;
    std::unique_ptr<const Statics> statics;
    DenseMatrix directions;   // scaled twists by the coordinates of principal stiffness
    Values stiffness;         // principal ones, ascending
    DenseMatrix skew;         // of the tangent, in these coordinates; empty where it has none
    Values forces;            // along them
    double scale = 0;         // Statics::largest_stiffness

    double residual() const { return statics->residual; }
};

class RestSearch {
public:
    RestSearch(const Model& model, const ConsistentStart& closed)
        : model_(model), tables_(model, closed.independent), instant_(tables_), rows_(all_rows(model)),
          t_(closed.start.t)
    {
        state_.resize(tables_);
        state_.angles = tables_.loads.turns.begin(closed.start);
        const std::vector<Matrix34> stated = model.start().X;
        for (const Joint& joint : model.joints())
            for (const NamedCoordinate& q : joint.coordinates) {
                const double value = coordinate_value(q.coordinate, stated);
                counted_.push_back({&q, value, value});
            }
    }

    const ModelTables& tables() const { return tables_; }

    /// Forces in this configuration; false if they are no numbers or a free motion has no inertia.
    bool look(std::vector<Matrix34> X, RestPoint& point)
    {
        point.X = std::move(X);
        state_.t = t_;
        std::copy_n(point.X.data()->data(), state_.X.size(), state_.X.begin());
        std::fill(state_.velocity.begin(), state_.velocity.end(), 0.0);
        std::ranges::copy(point.held, state_.velocity.begin());
        tables_.loads.turns.follow(point.X, state_.angles);
        follow_joints(point.X);
        if (!instant_.prepare(state_, tables_.independent)) return false;
        instant_.accelerate(state_, Side::right);
        acceleration_ = state_.acceleration[1];
        instant_.add_basis(state_);
        point.maps = state_.maps;
        point.statics = std::make_unique<const Statics>(tables_, state_, Side::right);
        return std::isfinite(point.residual());
    }

    /// Coordinates of each joint where it looked last, with the turns on the way there.
    std::vector<std::vector<double>> coordinates() const
    {
        std::vector<std::vector<double>> all(model_.joints().size());
        auto next = counted_.begin();
        for (std::size_t j = 0; j < all.size(); ++j)
            for (const NamedCoordinate& q : model_.joints()[j].coordinates)
                all[j].push_back(q.at_stated + next->value - next->stated), ++next;
        return all;
    }

    /// Principal stiffnesses, at the configuration that was looked at last.
    void add_stiffness(RestPoint& point) const
    {
        const Statics& statics = *point.statics;
        if (statics.free.n == 0) return;
        const DenseMatrix K = statics.free.reduced(tables_, statics.stiffness);
        const SymmetricSpectrum principal = symmetric_spectrum(symmetric_part(K));
        point.scale = statics.largest_stiffness;
        point.stiffness = principal.values;
        point.directions = product(statics.free.Z, principal.vectors);
        point.forces = transposed_product(point.directions, statics.rows);
        const DenseMatrix skew = skew_part(K);
        point.skew = {};
        if (largest_size(skew.a) > 1e-13 * point.scale)
            point.skew = product(transposed_product(principal.vectors, skew), principal.vectors);
    }

    /// Largest displacement of a body, in lengths of the model, or turn.
    double size_of(const RestPoint& point, const Values& step) const
    {
        const Values y = product(point.directions, step);
        Values xi(static_cast<std::size_t>(tables_.n_twists));
        tables_.bodies.to_twist(point.maps.data(), y.data(), xi.data());
        return largest_displacement(tables_, xi.data());
    }

    /// Where a step leads to, joints closed. False if they do not close.
    bool move(const RestPoint& from, const Values& step, std::vector<Matrix34>& X) const
    {
        const Values y = product(from.directions, step);
        Values xi(static_cast<std::size_t>(tables_.n_twists));
        tables_.bodies.to_twist(from.maps.data(), y.data(), xi.data());
        return move_by(from, xi, X);
    }

    /// The same by twists.
    bool move_by(const RestPoint& from, const Values& xi, std::vector<Matrix34>& X) const
    {
        X = from.X;
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            if (holds_states(b)) continue;
            const double* v = xi.data() + tables_.bodies[b].first;
            const Vector3 shift{v[0], v[1], v[2]};
            if (tables_.bodies[b].dofs == 3) {
                X[b].set_column(0, X[b].column(0) + shift);
                continue;
            }
            X[b] = twist::moved(X[b], shift, {v[3], v[4], v[5]});
            const Matrix3 D = directors(X[b]);   // rounding does not gather
            X[b] = configuration(X[b].column(0), 0.5 * (D * (3.0 * identity<3>() - transpose(D) * D)));
        }
        Closing closing = close_rows(model_, X, rows_, false);
        X = std::move(closing.X);
        return closing.closed;
    }

    /// Work of weight and loads on the straight way between two configurations, by the trapezoidal rule:
    /// exact for weight and for forces that are constant or linear in X. What is small is the difference of
    /// large numbers there, and taken from what joints leave free.
    double work(const RestPoint& from, const RestPoint& to, const Values& step, double size) const
    {
        if (size < 1e-3) {
            Values both = from.statics->rows;
            add_scaled(both, 1, to.statics->rows);
            return 0.5 * dot(product(from.directions, step), both);
        }
        double sum = 0;
        for (std::size_t b = 0; b < from.X.size(); ++b)
            for (int i = 0; i < 12; ++i)
                sum += 0.5 * (from.statics->given[12 * b + i] + to.statics->given[12 * b + i]) *
                       (to.X[b].a[i] - from.X[b].a[i]);
        return sum;
    }

    /// As plain twists, of a step in coordinates of free motions.
    Values twists(const RestPoint& at, const Values& free) const
    {
        const Values y = product(at.statics->free.Z, free);
        Values xi(static_cast<std::size_t>(tables_.n_twists));
        tables_.bodies.to_twist(at.maps.data(), y.data(), xi.data());
        return xi;
    }
    Values held_at(const State& state) const
    {
        Values held(static_cast<std::size_t>(tables_.n_twists));
        for (int b = 0; b < tables_.n_bodies(); ++b)
            for (int k = 0; holds_states(b) && k < 3; ++k)
                held[static_cast<std::size_t>(tables_.bodies[b].first + k)] = state.V[static_cast<std::size_t>(b)](k, 0);
        return held;
    }
    std::vector<Matrix34> velocities_of(const Values& held) const
    {
        std::vector<Matrix34> V(static_cast<std::size_t>(tables_.n_bodies()));
        for (int b = 0; b < tables_.n_bodies(); ++b)
            for (int k = 0; holds_states(b) && k < 3; ++k)
                V[static_cast<std::size_t>(b)](k, 0) = held[static_cast<std::size_t>(tables_.bodies[b].first + k)];
        return V;
    }
    /// Of velocities of bodies that hold states, in sizes of these.
    double size_of_states(const Values& xi) const
    {
        double size = 0;
        for (int b = 0; b < tables_.n_bodies(); ++b)
            if (const Body& body = model_.bodies()[static_cast<std::size_t>(b)]; body.holds_states())
                for (int k = 0; k < 3; ++k)
                    size = std::max(size, std::abs(xi[static_cast<std::size_t>(tables_.bodies[b].first + k)]) /
                                              body.state_speed);
        return size;
    }
    bool holds_states(int body) const { return model_.bodies()[static_cast<std::size_t>(body)].holds_states(); }

    /// The state that was looked at last.
    const InstantState& state() const { return state_; }
    const std::vector<double>& acceleration() const { return acceleration_; }
    int bad_load(const std::vector<Matrix34>& X) const
    {
        const std::vector<double> V(12 * X.size(), 0.0);
        return tables_.loads.bad({t_, Side::right}, X.data()->data(), V.data(), state_.angles);
    }

private:
    struct Counted {
        const NamedCoordinate* q;
        double stated, value;
    };
    /// Each angle the shorter way.
    void follow_joints(std::span<const Matrix34> X)
    {
        for (Counted& one : counted_) {
            const double x = coordinate_value(one.q->coordinate, X);
            one.value = one.q->coordinate.counts_turns() ? turned_to(x, one.value) : x;
        }
    }

    const Model& model_;
    ModelTables tables_;
    InstantSystem instant_;
    InstantState state_;
    std::vector<int> rows_;
    std::vector<double> acceleration_;
    std::vector<Counted> counted_;   // of all joints
    double t_;
};

}   // namespace livens::inline statics_internal
