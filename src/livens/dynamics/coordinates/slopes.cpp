// SPDX-License-Identifier: BSD-3-Clause
// Small changes about a state: theory.md, "States in coordinates". Loads enter by their tangents, so that a
// law that bends nearby does no harm; all else is smooth, and differences of sixth order take some 1e-11 of
// it.
#include <algorithm>
#include <array>
#include <cmath>

#include "livens/base/error.h"
#include "livens/dynamics/coordinates/state_parts.h"
#include "livens/solvers/factors.h"

namespace livens {

namespace {

using Of = GeneralisedCoordinate::Of;

constexpr double slope_step = 0.01;   // rad, lengths of the model, or these a second
// f' = sum of c_i (f(i h) - f(-i h)) / h, i = 1, 2, 3
constexpr std::array<double, 3> sixth_order = {3.0 / 4, -3.0 / 20, 1.0 / 60};

/// Slope of numbers by what moves them: of(step) for steps to both sides.
template <class Of_step>
std::vector<double> difference(double h, const Of_step& of)
{
    std::vector<double> slope;
    for (int i = 0; i < 3; ++i)
        for (const double side : {1.0, -1.0}) {
            const std::vector<double> value = of(side * (i + 1) * h);
            slope.resize(value.size(), 0.0);
            add_scaled(slope, side * sixth_order[static_cast<std::size_t>(i)] / h, value);
        }
    return slope;
}

/// Inverse dynamics with loads that are held, and the velocities X' of all bodies behind them.
std::vector<double> balance_of(const StateParts& parts, std::span<const double> accelerations,
                               std::span<const Matrix34> loads)
{
    std::vector<double> all = parts.less_loads(accelerations, loads);
    for (const Matrix34& V : parts.state.V) all.insert(all.end(), V.a, V.a + 12);
    return all;
}

StateParts parts_beside(const StateParts& from, int rate, double by)
{
    const Mechanism& m = *from.mechanism;
    std::vector<double> way(from.rates.size(), 0.0);
    way[static_cast<std::size_t>(rate)] = 1;
    const std::vector<double> numbers = m.gone(from.placed.numbers, way, by);
    return {from.mechanism, lead(m, from.placed, numbers), from.rates};
}

/// What loads change by where bodies and their velocities change.
std::vector<Matrix34> change_of_loads(const StateParts& parts, std::span<const Matrix34> dX,
                                      std::span<const Matrix34> dV)
{
    const Mechanism& m = *parts.mechanism;
    std::vector<Matrix34> change(dX.size());
    for (const int l : m.loads.with_tangent) {
        const Load& load = m.model.loads()[l];
        const LoadArguments arguments =
            m.loads.arguments(l, {m.placed.t}, parts.state.X[0].a, parts.state.V[0].a, parts.placed.angles);
        LoadTangent tangent(load.bodies.size(), load.n_acted);
        load.tangent(arguments, tangent);
        for (std::size_t on = 0; on < load.n_acted; ++on) {
            if (load.bodies[on] == world) continue;
            Matrix34& F = change[static_cast<std::size_t>(load.bodies[on])];
            for (std::size_t by = 0; by < load.bodies.size(); ++by) {
                if (load.bodies[by] == world) continue;
                const auto b = static_cast<std::size_t>(load.bodies[by]);
                for (int j = 0; j < 12; ++j)
                    for (int i = 0; i < 12; ++i)
                        F.a[i] += tangent.X[on][by](i, j) * dX[b].a[j] + tangent.V[on][by](i, j) * dV[b].a[j];
            }
        }
    }
    return change;
}

/// The velocities behind what balance_of() returns.
std::vector<Matrix34> velocities_behind(std::span<const double> balance, std::size_t n, std::size_t n_bodies)
{
    std::vector<Matrix34> V(n_bodies);
    for (std::size_t b = 0; b < n_bodies; ++b)
        std::copy_n(balance.begin() + static_cast<std::ptrdiff_t>(n + 12 * b), 12, V[b].a);
    return V;
}

}   // namespace

/// M dq'' = what loads change by, less the change of M q'' + h - J^T N^T F at fixed q'' and F.
StateSlopes GeneralisedState::slopes() const
{
    const Mechanism& m = *parts_->mechanism;
    const auto n = static_cast<std::size_t>(m.n_rates), n_bodies = parts_->placed.X.size();
    StateSlopes slopes{m.n_rates, std::vector<double>(4 * n * n, 0.0), std::vector<double>(2 * n * n, 0.0),
                       accelerations()};
    const std::vector<Matrix34> loads = parts_->load_forces();
    const DenseMatrix factor = parts_->mass_factor();
    const auto put = [&](std::size_t column, std::vector<double> forces, std::span<const Matrix34> dX,
                         std::span<const Matrix34> dV) {
        const std::vector<double> of_loads = parts_->along(change_of_loads(*parts_, dX, dV));
        forces.resize(n);
        for (std::size_t i = 0; i < n; ++i) forces[i] = of_loads[i] - forces[i];
        const std::vector<double> solved = cholesky_solution(factor, forces);
        for (std::size_t i = 0; i < n; ++i) slopes.A[(n + i) * 2 * n + column] = solved[i];
    };
    std::size_t k = 0;
    for (int c = 0; c < static_cast<int>(m.coordinates.size()); ++c) {
        const bool is_turn = m.coordinates[c].of == Of::turn;
        const std::size_t first = k;
        for (int i = 0; i < m.coordinates[c].n_rates(); ++i, ++k) {
            const double h = slope_step * m.unit_of(c);
            const std::vector<Matrix34> dX =
                parts_->rates_of_bodies(parts_->placed.by_rates.column(static_cast<int>(k)));
            const std::vector<double> by_place = difference(h, [&](double by) {
                return balance_of(parts_beside(*parts_, static_cast<int>(k), by), slopes.accelerations,
                                  loads);
            });
            put(k, by_place, dX, velocities_behind(by_place, n, n_bodies));
            const std::vector<double> by_rate = difference(h, [&](double by) {
                std::vector<double> rates = parts_->rates;
                rates[k] += by;
                return balance_of(StateParts(parts_->mechanism, parts_->placed, rates), slopes.accelerations,
                                  loads);
            });
            put(n + k, by_rate, std::vector<Matrix34>(n_bodies), dX);
            slopes.A[k * 2 * n + n + k] = 1;
            std::vector<double> unit(n, 0.0);
            unit[k] = 1;
            const std::vector<double> moved = cholesky_solution(factor, unit);
            for (std::size_t r = 0; r < n; ++r) slopes.B[(n + r) * n + k] = moved[r];
        }
        if (!is_turn) continue;
        // A small turn in world axes goes round with the body: theta' = dw + w x theta.
        const Matrix3 spin =
            cross_matrix({parts_->rates[first], parts_->rates[first + 1], parts_->rates[first + 2]});
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) slopes.A[(first + i) * 2 * n + first + j] = spin(i, j);
    }
    return slopes;
}

}   // namespace livens
