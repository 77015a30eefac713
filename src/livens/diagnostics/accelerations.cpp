// SPDX-License-Identifier: BSD-3-Clause
// Accelerations by the equations of motion at an instant: docs/theory.md, "Accelerations".
#include "livens/diagnostics/accelerations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "livens/diagnostics/sample.h"
#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/multibody/body.h"
#include "livens/multibody/rotors.h"

namespace livens {

namespace {

/// Independent rows where most are: where joints lose rank nothing tells which are independent elsewhere.
std::vector<int> most_rows(const Model& acting, std::span<const State> places)
{
    std::vector<int> most;
    for (const State& state : places) {
        RowRank rank = row_rank(frozen(acting, {state.t}), state.X, all_rows(acting));
        if (rank.independent.size() > most.size()) most = std::move(rank.independent);
    }
    return most;
}

std::optional<WithRotors> rotors_of_acting(const Model& model)
{
    return model.has_rotors() ? std::optional<WithRotors>(model) : std::nullopt;
}

}   // namespace

/// The joints that act together, and what solves at an instant with them.
struct Accelerations::Phase {
    Phase(const Model& all, double t, std::span<const State> places)
        : acting(acting_at(all, t)), rotors(rotors_of_acting(acting.model)),
          tables(whole(), most_rows(whole(), with_rotors(places))), instant(tables)
    {
        solved.resize(tables);
    }

    [[gnu::visibility("hidden")]] bool settle(const State& state);
    [[gnu::visibility("hidden")]] bool accelerate(const State& state, const std::vector<double>& angles,
                                                  Side side);

    /// Rotors stand behind bodies and rows of the model.
    const Model& whole() const { return rotors ? rotors->model() : acting.model; }
    std::vector<State> with_rotors(std::span<const State> places) const
    {
        std::vector<State> all(places.begin(), places.end());
        for (State& place : all)
            if (rotors) place = rotors->with(place);
        return all;
    }

    ActingModel acting;
    std::optional<WithRotors> rotors;
    ModelTables tables;
    InstantSystem instant;
    InstantState solved;

    // What is there already, as most who ask for one thing of a state ask for another.
    State settled;
    bool is_held = false;
    std::optional<Side> accelerated;
};

/// The state put onto the joints. Between nodes directors are rigid, joints closed, and rates rigid motions
/// that joints allow, to the order of the interpolation only. False: joints lose rank.
bool Accelerations::Phase::settle(const State& state)
{
    if (rotors && state.X.size() == static_cast<std::size_t>(rotors->n_bodies()))
        return settle(rotors->with(state));
    if (settled.t == state.t && settled.X == state.X && settled.V == state.V) return is_held;
    settled = state;
    accelerated.reset();
    is_held = false;
    solved.t = state.t;
    for (int b = 0; b < tables.n_bodies(); ++b) {
        const auto& body = tables.bodies[b];
        Matrix34 X = state.X[b];
        if (body.dofs == 6) X = configuration(X.column(0), project_directors(directors(X)));
        std::copy_n(X.a, 12, solved.X.begin() + 12 * static_cast<std::ptrdiff_t>(b));
        const Vector3 w = body.dofs == 6 ? angular_velocity(X, state.V[b]) : Vector3{};
        for (int i = 0; i < body.dofs; ++i)
            solved.velocity[body.first + i] = i < 3 ? state.V[b](i, 0) : w[i - 3];
    }
    if (!instant.prepare(solved, std::vector<int>(solved.held.rows))) return false;
    constexpr double lost = 1e-4;   // docs/theory.md, "Singular positions"
    const auto is_lost = [&] { return tables.rank > 0 && solved.held.smallest_pivot < lost; };
    if (is_lost()) return false;
    instant.close(solved);
    if (is_lost()) return false;
    instant.from_velocity(solved);
    std::vector<double> unused(static_cast<std::size_t>(tables.n_rows()));
    instant.from_momentum(solved, std::vector<double>(solved.p).data(), 1, unused.data());
    return is_held = true;
}

bool Accelerations::Phase::accelerate(const State& state, const std::vector<double>& angles, Side side)
{
    if (!settle(state)) return false;
    if (accelerated == side && solved.angles == angles) return true;
    solved.angles = angles;
    instant.accelerate(solved, side);
    accelerated = side;
    return true;
}

Accelerations::Accelerations(const Model& model, const Motion& motion)
    : model_(model), motion_(motion), turns_(model, motion), events_(model.events()),
      phases_(std::make_shared<std::vector<std::shared_ptr<Phase>>>(events_.size() + 1))
{}

Accelerations::Phase& Accelerations::phase_at(double t) const
{
    const auto after = std::ranges::upper_bound(events_, t);
    std::shared_ptr<Phase>& phase = (*phases_)[static_cast<std::size_t>(after - events_.begin())];
    if (phase != nullptr) return *phase;
    std::vector<State> places{sample_state(motion_, t)};
    if (motion_.n_elements() > 0) {
        const int element = motion_.mesh.element_at(t);
        for (const double s : {0.0, 0.381966})
            places.push_back(
                sample_state(motion_, motion_.mesh.ends[element] + s * motion_.mesh.length(element)));
    }
    phase = std::make_shared<Phase>(model_, t, places);
    return *phase;
}

bool Accelerations::is_at_end(const State& state) const
{
    return element_end_at(motion_.mesh, state.t) >= 0 && !motion_.accelerations.empty();
}

AcceleratedState Accelerations::at(const State& state, Side side) const
{
    if (is_at_end(state)) {
        const std::size_t n = static_cast<std::size_t>(motion_.n_bodies),
                          end = static_cast<std::size_t>(element_end_at(motion_.mesh, state.t)),
                          place = 2 * end + (side == Side::left ? 0 : 1);
        const auto first = motion_.accelerations.begin() + static_cast<std::ptrdiff_t>(place * n);
        return {state.X, state.V, {first, first + static_cast<std::ptrdiff_t>(n)}};
    }
    constexpr double infinity = std::numeric_limits<double>::infinity(),
                     nan = std::numeric_limits<double>::quiet_NaN();
    const bool is_before = side == Side::left && state.t > motion_.start();
    Phase& phase = phase_at(is_before ? std::nextafter(state.t, -infinity) : state.t);
    AcceleratedState all{state.X, state.V, state.X};   // of the model's bodies, which come first
    if (!phase.accelerate(state, turns_.at(state), side)) {
        for (Matrix34& A : all.A) std::fill_n(A.a, 12, nan);
        return all;
    }
    const std::vector<double>& twists = phase.solved.acceleration[side == Side::left ? 0 : 1];
    std::vector<double> A(phase.solved.X.size());
    phase.tables.bodies.rates_of(phase.solved.X.data(), twists.data(), A.data());
    for (std::size_t b = 0; b < all.X.size(); ++b)
        for (std::size_t i = 0; i < 12; ++i) {
            all.X[b].a[i] = phase.solved.X[12 * b + i];
            all.V[b].a[i] = phase.instant.rates()[12 * b + i];
            all.A[b].a[i] = A[12 * b + i] + phase.instant.centripetal()[12 * b + i];
        }
    return all;
}

State Accelerations::on_joints(const State& state) const
{
    if (is_at_end(state)) return state;
    Phase& phase = phase_at(state.t);
    if (!phase.settle(state)) return state;
    State held = state;
    std::vector<double> V(phase.solved.X.size());
    phase.tables.bodies.rates_of(phase.solved.X.data(), phase.solved.velocity.data(), V.data());
    for (std::size_t b = 0; b < held.X.size(); ++b)
        for (std::size_t i = 0; i < 12; ++i) {
            held.X[b].a[i] = phase.solved.X[12 * b + i];
            held.V[b].a[i] = V[12 * b + i];
        }
    return held;
}

std::vector<double> Accelerations::multipliers_at(const State& state) const
{
    Phase& phase = phase_at(state.t);
    if (!phase.accelerate(state, turns_.at(state), Side::right)) return {};
    std::vector<double> all(static_cast<std::size_t>(model_.n_rows()), 0.0);
    for (std::size_t i = 0; i < phase.acting.rows.size(); ++i)
        all[static_cast<std::size_t>(phase.acting.rows[i])] = phase.solved.multipliers[1][i];
    return all;
}

Vector3 angular_acceleration(const Matrix34& X, const Matrix34& A)
{
    Vector3 sum{};
    for (int i = 1; i < 4; ++i) sum += cross(X.column(i), A.column(i));
    return 0.5 * sum;
}

}   // namespace livens
