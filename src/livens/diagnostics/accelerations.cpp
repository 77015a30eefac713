// SPDX-License-Identifier: BSD-3-Clause
// Accelerations by the equations of motion at an instant: docs/theory.md, "Accelerations".
#include "livens/diagnostics/accelerations.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "livens/diagnostics/sample.h"
#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/multibody/body.h"

namespace livens {

/// The joints that act together, and what solves at an instant with them.
struct Accelerations::Phase {
    Phase(const Model& all, double t, const std::vector<Matrix34>& X)
        : model(acting_at(all, t).model),
          tables(model, row_rank(frozen(model, {t}), X, all_rows(model)).independent), instant(tables)
    {
        state.resize(tables);
    }

    void take(const State& given, std::vector<double> angles);
    AcceleratedState accelerated(const State& given, std::vector<double> angles, Side side);

    Model model;
    ModelTables tables;
    InstantSystem instant;
    InstantState state;
};

/// Between nodes directors are rigid, and rates rigid motions, to the order of the interpolation only.
void Accelerations::Phase::take(const State& given, std::vector<double> angles)
{
    state.t = given.t;
    state.angles = std::move(angles);
    for (int b = 0; b < tables.n_bodies(); ++b) {
        const auto& body = tables.bodies[static_cast<std::size_t>(b)];
        Matrix34 X = given.X[b];
        if (body.dofs == 6) X = configuration(X.column(0), project_directors(directors(X)));
        std::copy_n(X.a, 12, state.X.begin() + 12 * static_cast<std::ptrdiff_t>(b));
        const Vector3 w = body.dofs == 6 ? angular_velocity(X, given.V[b]) : Vector3{};
        for (int i = 0; i < body.dofs; ++i)
            state.velocity[body.first + i] = i < 3 ? given.V[b](i, 0) : w[i - 3];
    }
}

AcceleratedState Accelerations::Phase::accelerated(const State& given, std::vector<double> angles, Side side)
{
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    AcceleratedState all{given.X, given.V, given.X};
    for (Matrix34& A : all.A) std::fill_n(A.a, 12, nan);
    take(given, std::move(angles));
    if (!instant.prepare(state, std::vector<int>(state.held.rows))) return all;
    constexpr double lost = 1e-4;   // docs/theory.md, "Singular positions"
    if (tables.rank > 0 && state.held.smallest_pivot < lost) return all;
    instant.from_velocity(state);
    std::vector<double> unused(static_cast<std::size_t>(tables.n_rows()));
    instant.from_momentum(state, std::vector<double>(state.p).data(), 1, unused.data());
    instant.accelerate(state, side);
    const std::vector<double>& twists = state.acceleration[side == Side::left ? 0 : 1];
    std::vector<double> A(state.X.size());
    tables.bodies.rates_of(state.X.data(), twists.data(), A.data());
    for (std::size_t b = 0; b < all.X.size(); ++b)
        for (std::size_t i = 0; i < 12; ++i) {
            all.X[b].a[i] = state.X[12 * b + i];
            all.V[b].a[i] = instant.rates()[12 * b + i];
            all.A[b].a[i] = A[12 * b + i] + instant.centripetal()[12 * b + i];
        }
    return all;
}

Accelerations::Accelerations(const Model& model, const Motion& motion)
    : model_(model), motion_(motion), turns_(model, motion), events_(model.events()),
      phases_(std::make_shared<std::vector<std::shared_ptr<Phase>>>(events_.size() + 1))
{}

Accelerations::Phase& Accelerations::phase_at(double t) const
{
    const auto after = std::ranges::upper_bound(events_, t);
    std::shared_ptr<Phase>& phase = (*phases_)[static_cast<std::size_t>(after - events_.begin())];
    if (phase == nullptr) phase = std::make_shared<Phase>(model_, t, sample_state(motion_, t).X);
    return *phase;
}

AcceleratedState Accelerations::at(const State& state, Side side) const
{
    const std::size_t n = static_cast<std::size_t>(motion_.n_bodies);
    const int end = element_end_at(motion_.mesh, state.t);
    if (end >= 0 && !motion_.accelerations.empty()) {
        const std::size_t place = 2 * static_cast<std::size_t>(end) + (side == Side::left ? 0 : 1);
        const auto first = motion_.accelerations.begin() + static_cast<std::ptrdiff_t>(place * n);
        return {state.X, state.V, {first, first + static_cast<std::ptrdiff_t>(n)}};
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const bool is_before = side == Side::left && state.t > motion_.start();
    const double t = is_before ? std::nextafter(state.t, -infinity) : state.t;
    return phase_at(t).accelerated(state, turns_.at(state), side);
}

Vector3 angular_acceleration(const Matrix34& X, const Matrix34& A)
{
    Vector3 sum{};
    for (int i = 1; i < 4; ++i) sum += cross(X.column(i), A.column(i));
    return 0.5 * sum;
}

}   // namespace livens
