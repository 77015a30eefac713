// SPDX-License-Identifier: BSD-3-Clause
// docs/theory.md, "Accelerations".
#include "livens/dynamics/instant/settled_instant.h"

#include <algorithm>
#include <span>
#include <utility>

#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/multibody/body.h"

namespace livens::inline dynamics_internal {

SettledInstant::SettledInstant(const Model& model, std::vector<int> independent)
    : tables_(model, std::move(independent)), system_(tables_)
{
    solved_.resize(tables_);
}

/// Directors, then places, then rates, which are those of the rows where these are closed.
bool SettledInstant::settle(const State& state)
{
    if (settled_.t == state.t && settled_.X == state.X && settled_.V == state.V) return is_held_;
    settled_ = state;
    accelerated_.reset();
    is_held_ = false;
    solved_.t = state.t;
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const auto& body = tables_.bodies[b];
        Matrix34 X = state.X[b];
        if (body.dofs == 6) X = configuration(X.column(0), project_directors(directors(X)));
        std::copy_n(X.a, 12, solved_.X.begin() + 12 * static_cast<std::ptrdiff_t>(b));
        const Vector3 w = body.dofs == 6 ? angular_velocity(X, state.V[b]) : Vector3{};
        for (int i = 0; i < body.dofs; ++i)
            solved_.velocity[body.first + i] = i < 3 ? state.V[b](i, 0) : w[i - 3];
    }
    if (!system_.prepare(solved_, std::vector<int>(solved_.held.rows))) return false;
    constexpr double lost = 1e-4;   // docs/theory.md, "Singular positions"
    const auto is_lost = [&] { return tables_.rank > 0 && solved_.held.smallest_pivot < lost; };
    if (is_lost()) return false;
    // If rows do not close the place stays as it is; whether joints hold, the pivots alone decide.
    system_.close(solved_);
    if (is_lost()) return false;
    system_.from_velocity(solved_);
    // With a copy of p, as from_momentum() writes the state's own.
    std::vector<double> unused(static_cast<std::size_t>(tables_.n_rows()));
    system_.from_momentum(solved_, std::vector<double>(solved_.p).data(), 1, unused.data());
    return is_held_ = true;
}

bool SettledInstant::accelerate(const State& state, const std::vector<double>& angles, Side side)
{
    if (!settle(state)) return false;
    if (accelerated_ == side && solved_.angles == angles) return true;
    solved_.angles = angles;
    system_.accelerate(solved_, side);
    accelerated_ = side;
    return true;
}

std::vector<double> SettledInstant::response_to(const std::vector<double>& raw)
{
    std::vector<double> twists(solved_.velocity.size());
    system_.respond(solved_, raw.data(), twists.data());
    return twists;
}

std::vector<int> most_rows(const Model& model, std::span<const State> places)
{
    std::vector<int> most;
    for (const State& state : places) {
        RowRank rank = row_rank(frozen(model, {state.t}), state.X, all_rows(model));
        if (rank.independent.size() > most.size()) most = std::move(rank.independent);
    }
    return most;
}

}   // namespace livens::inline dynamics_internal
