// SPDX-License-Identifier: BSD-3-Clause
// Accelerations by the equations of motion at an instant: docs/theory.md, "Accelerations".
#include "livens/diagnostics/accelerations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "livens/diagnostics/sample.h"
#include "livens/dynamics/instant/settled_instant.h"
#include "livens/multibody/body.h"
#include "livens/multibody/rotors.h"

namespace livens {

namespace {

std::optional<WithRotors> rotors_of_acting(const Model& model)
{
    return model.has_rotors() ? std::optional<WithRotors>(model) : std::nullopt;
}

}   // namespace

/// The joints that act together, and what solves at an instant with them.
struct Accelerations::Phase {
    Phase(const Model& all, double t, std::span<const State> places)
        : acting(acting_at(all, t)), rotors(rotors_of_acting(acting.model)),
          instant(whole(), most_rows(whole(), with_rotors(places)))
    {}

    bool settle(const State& state) { return instant.settle(with_rotors(state)); }
    bool accelerate(const State& state, const std::vector<double>& angles, Side side)
    {
        return instant.accelerate(with_rotors(state), angles, side);
    }

    /// Rotors stand behind bodies and rows of the model.
    const Model& whole() const { return rotors ? rotors->model() : acting.model; }
    State with_rotors(const State& state) const
    {
        const bool lacks_them = rotors && state.X.size() == static_cast<std::size_t>(rotors->n_bodies());
        return lacks_them ? rotors->with(state) : state;
    }
    std::vector<State> with_rotors(std::span<const State> places) const
    {
        std::vector<State> all;
        for (const State& place : places) all.push_back(with_rotors(place));
        return all;
    }

    ActingModel acting;
    std::optional<WithRotors> rotors;
    SettledInstant instant;
};

Accelerations::Accelerations(const Model& model, const Motion& motion)
    : model_(model), motion_(motion), turns_(model, motion), events_(model.event_times()),
      phases_(std::make_shared<std::vector<std::shared_ptr<Phase>>>(events_.size() + 1))
{}

/// Made at the first question between two events. Its rows are those that are independent at t, at the start
/// of the element or inside of it, where most are: one of these places may be singular.
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

/// At element ends the motion has them, two an end: on the left and on the right. From the left an instant
/// belongs to the phase before it; X and V are those that the equations were solved with.
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
    const std::vector<double>& twists = phase.instant.solved().acceleration[side == Side::left ? 0 : 1];
    std::vector<double> A(phase.instant.solved().X.size());
    phase.instant.tables().bodies.rates_of(phase.instant.solved().X.data(), twists.data(), A.data());
    for (std::size_t b = 0; b < all.X.size(); ++b)
        for (std::size_t i = 0; i < 12; ++i) {
            all.X[b].a[i] = phase.instant.solved().X[12 * b + i];
            all.V[b].a[i] = phase.instant.system().rates()[12 * b + i];
            all.A[b].a[i] = A[12 * b + i] + phase.instant.system().centripetal()[12 * b + i];
        }
    return all;
}

State Accelerations::on_joints(const State& state) const
{
    if (is_at_end(state)) return state;
    Phase& phase = phase_at(state.t);
    if (!phase.settle(state)) return state;
    State held = state;
    std::vector<double> V(phase.instant.solved().X.size());
    phase.instant.tables().bodies.rates_of(phase.instant.solved().X.data(),
                                           phase.instant.solved().velocity.data(), V.data());
    for (std::size_t b = 0; b < held.X.size(); ++b)
        for (std::size_t i = 0; i < 12; ++i) {
            held.X[b].a[i] = phase.instant.solved().X[12 * b + i];
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
        all[static_cast<std::size_t>(phase.acting.rows[i])] = phase.instant.multipliers(Side::right)[i];
    return all;
}

/// d_i'' = alpha x d_i + w x (w x d_i). Of an orthonormal triad sum d_i x (alpha x d_i) = 2 alpha, and the
/// second terms add up to w x w = 0.
Vector3 angular_acceleration(const Matrix34& X, const Matrix34& A)
{
    Vector3 sum{};
    for (int i = 1; i < 4; ++i) sum += cross(X.column(i), A.column(i));
    return 0.5 * sum;
}

}   // namespace livens
