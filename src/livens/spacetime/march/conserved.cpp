// SPDX-License-Identifier: BSD-3-Clause
// theory.md, "Conditions by component": Periodic motions, Relative periodic motions.
#include "livens/spacetime/march/conserved.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "livens/multibody/model.h"
#include "livens/solvers/dense.h"
#include "livens/spacetime/march/components.h"
#include "livens/spacetime/march/condition_rows.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr double unchanged = 1e-8;   // of what would change it

using Bodies = std::span<const Matrix34>;

std::vector<Matrix34> stated_in(const Model& model)
{
    std::vector<Matrix34> all;
    for (const Body& body : model.bodies()) all.push_back(body.X);
    return all;
}

/// Along this axis, or about it.
/// Of P = V m the first column is the linear momentum; the angular one is (phi - at) x P_0 + sum d_a x P_a.
StateQuantity momentum(const Model& model, const std::string& name, const Vector3& axis, const Vector3& at,
                       bool is_angular)
{
    const auto bodies = std::make_shared<const std::vector<Body>>(model.bodies());
    StateQuantity one{name, is_angular ? "kg m2 s-1" : "kg m s-1"};
    one.function = [=](Bodies X, Bodies V) {
        Vector3 sum{};
        for (std::size_t b = 0; b < X.size(); ++b) {
            const Matrix34 P = V[b] * (*bodies)[b].mass;
            if (!is_angular) sum += P.column(0);
            for (int k = 0; is_angular && k < 4; ++k)
                sum += cross(k == 0 ? X[b].column(0) - at : X[b].column(k), P.column(k));
        }
        return dot(axis, sum);
    };
    return one;
}

/// With what loads store, whose angles are within half a turn of where they are stated.
StateQuantity energy(const ModelTables& tables)
{
    StateQuantity one{"energy", "J"};
    one.function = [&tables](Bodies X, Bodies V) {
        const Model& model = *tables.model;
        State state;
        state.X.assign(X.begin(), X.end());
        state.V.assign(V.begin(), V.end());
        const std::vector<double> turns = tables.loads.turns.begin(state);
        double sum = 0;
        for (std::size_t b = 0; b < X.size(); ++b) {
            const Body& body = model.bodies()[b];
            sum += 0.5 * dot(V[b], V[b] * body.mass) - dot(weight(body, model.gravity()), X[b]);
        }
        for (std::size_t l = 0; l < model.loads().size(); ++l) {
            const Load& load = model.loads()[l];
            const std::span<const double> angles = tables.loads.turns.of(static_cast<int>(l), turns);
            if (load.potential) sum += load.potential(load_arguments(load, {0}, X, V, angles));
        }
        return sum;
    };
    return one;
}

std::vector<StateQuantity> candidates(const ModelTables& tables, const std::optional<AxisTurn>& turn)
{
    const Model& model = *tables.model;
    std::vector<StateQuantity> all{energy(tables)};
    const std::array<const char*, 3> names{"x", "y", "z"};
    if (turn) {
        const Vector3 axis = (1 / norm(turn->axis)) * turn->axis;
        all.push_back(momentum(model, "angular momentum about the axis of the turn", axis, turn->at, true));
        all.push_back(momentum(model, "momentum along the axis of the turn", axis, {}, false));
        return all;
    }
    for (const bool is_angular : {false, true})
        for (int k = 0; k < 3; ++k)
            all.push_back(momentum(model,
                                   std::string(is_angular ? "angular momentum " : "momentum ") + names[k],
                                   identity<3>().column(k), {}, is_angular));
    return all;
}

/// d(quantity)/dt where places change with V, and rates with A, apart.
struct Change {
    double by_rates = 0, by_accelerations = 0;
};

/// Four-point differences along V with rates held, and along A = X'' with places held. Their sum is the rate
/// of the quantity; what each comes to by itself tells how large a sum would be that is not zero.
Change change_of(const StateQuantity& quantity, Bodies stated, const EndPoint& at, double step)
{
    constexpr std::array<std::array<double, 2>, 4> rule{
        {{-2, 1.0 / 12}, {-1, -8.0 / 12}, {1, 8.0 / 12}, {2, -1.0 / 12}}};
    const State state = at.state();
    const std::vector<Matrix34> A = at.accelerations();
    Change change;
    for (const auto& [k, weight] : rule) {
        std::vector<Matrix34> X = state.X, V = state.V;
        for (std::size_t b = 0; b < X.size(); ++b) {
            X[b] += k * step * state.V[b];
            V[b] += k * step * A[b];
        }
        change.by_rates += weight / step * value_of(quantity, stated, X, state.V);
        change.by_accelerations += weight / step * value_of(quantity, stated, state.X, V);
    }
    return change;
}

State turned_state(const AxisTurn& turn, State state)
{
    for (Matrix34& X : state.X) X = turned(turn, X);
    for (Matrix34& V : state.V) V = turned_rate(turn, V);
    return state;
}

}   // namespace

/// Forces are compared to the bit: what does not see the time computes the same numbers at every instant.
bool depends_on_time(const ModelTables& tables, const std::deque<EndPoint>& places, double start,
                     double duration)
{
    constexpr int n_instants = 16;
    if (tables.model->has_drives()) return true;
    for (const EndPoint& point : places) {
        const State state = point.state();
        std::vector<double> X, V;
        for (const Matrix34& x : state.X) X.insert(X.end(), std::begin(x.a), std::end(x.a));
        for (const Matrix34& v : state.V) V.insert(V.end(), std::begin(v.a), std::end(v.a));
        std::vector<double> first;
        for (int i = 0; i < n_instants; ++i) {   // at shares of the time that no period divides
            const double share = std::fmod(0.0137 + i * 0.6180339887498949, 1.0);
            std::vector<double> F(X.size(), 0.0);
            tables.loads.add({start + share * duration}, X.data(), V.data(), 1, F.data(),
                             tables.loads.turns.begin());
            if (first.empty()) first = F;
            if (F != first) return true;
        }
    }
    return false;
}

/// Kept is what all places keep. What is kept besides is independent of those before where one place says so:
/// gradients may be parallel at a single place by chance.
std::vector<StateQuantity> conserved_quantities(const ModelTables& tables, const std::deque<EndPoint>& places,
                                                double duration, const std::optional<AxisTurn>& turn)
{
    const std::vector<Matrix34> stated = stated_in(*tables.model);
    std::vector<StateQuantity> kept;
    for (const StateQuantity& quantity : candidates(tables, turn)) {
        const auto is_kept = [&](const EndPoint& at) {
            const Change change = change_of(quantity, stated, at, 1e-3 * duration);
            const double sum = change.by_rates + change.by_accelerations,
                         size = std::abs(change.by_rates) + std::abs(change.by_accelerations);
            const double held = std::abs(at.value(quantity)) / duration;
            return std::abs(sum) <= unchanged * (size + held);
        };
        if (!std::ranges::all_of(places, is_kept)) continue;
        kept.push_back(quantity);
        std::vector<Condition> rows;
        for (const StateQuantity& one : kept) rows.push_back({one});
        const auto is_new = [&](const EndPoint& at) {
            const Remainder last =
                remainders(rows_at({&tables, &tables}, rows, {&at, &at}, duration, {})).back();
            return last.norm > dependent * std::max(last.of, 1e-3);
        };
        if (!std::ranges::any_of(places, is_new)) kept.pop_back();
    }
    return kept;
}

/// By 1 rad, whose multiples come near every turn: what is alike after that is alike after any.
bool is_symmetric_about(const ModelTables& tables, const std::deque<EndPoint>& places, const AxisTurn& turn)
{
    AxisTurn some = turn;
    some.angle = 1;
    for (const EndPoint& at : places) {
        EndPoint there(tables);
        const State expected = turned_state(some, at.state());
        if (!there.place(expected)) return false;
        const State found = there.state();
        const std::vector<Matrix34> before = at.accelerations(), after = there.accelerations();
        double off = 0, size = tables.length, bent = 0, most = 0;
        for (std::size_t b = 0; b < before.size(); ++b) {
            off = std::max({off, norm(found.X[b] - expected.X[b])});
            size = std::max(size, norm(expected.X[b]));
            bent = std::max(bent, norm(after[b] - turned_rate(some, before[b])));
            most = std::max(most, norm(before[b]));
        }
        if (!(off <= unchanged * size) || !(bent <= unchanged * most)) return false;
    }
    return true;
}

/// With the gradients of the n quantities as rows of D, and e that of what is conserved, both by free motions
/// and momenta at the start, D^T w = e. Only the first n = 2 f columns of the rows are of the start.
std::vector<std::vector<double>> unfolding(const ModelTables& tables, const EndPoint& start,
                                           const std::vector<Condition>& alike,
                                           const std::vector<StateQuantity>& conserved, double duration)
{
    const int n = 2 * tables.freedoms();
    if (static_cast<int>(alike.size()) != n) return {};
    std::vector<Condition> rows;
    for (const Condition& one : alike) rows.push_back({one.quantity});
    for (const StateQuantity& one : conserved) rows.push_back({one});
    const DenseMatrix D = rows_at({&tables, &tables}, rows, {&start, &start}, duration, {});
    DenseLU lu;
    lu.resize(n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) lu.row(i)[j] = D(j, i);
    if (!all_finite(D.a) || !lu.factorise()) return {};
    std::vector<std::vector<double>> all;
    for (int c = 0; c < static_cast<int>(conserved.size()); ++c) {
        std::vector<double> w(static_cast<std::size_t>(n));
        for (int j = 0; j < n; ++j) w[j] = D(n + c, j);
        lu.solve(w.data());
        const double size = norm(w);
        if (!(size > 0)) return {};
        for (int i = 0; i < n; ++i) w[i] *= unit_of(alike[i].quantity, tables.length, duration) / size;
        all.push_back(std::move(w));
    }
    return all;
}

}   // namespace livens::inline spacetime_internal
