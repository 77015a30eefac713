// SPDX-License-Identifier: BSD-3-Clause
// docs/theory.md, "The horizon": where perturbations begin, and Differences, made small as a whole.
#include "livens/spacetime/accuracy/perturbations.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/diagnostics/largest.h"
#include "livens/dynamics/rows/projection.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/body.h"

namespace livens::inline spacetime_internal {

namespace {

/// Two perpendicular unit vectors at random. Together they miss one direction; it is as far from what turns a
/// body as from what is across it, since either may be what grows, and each of them has as much along the
/// spin as the other one.
struct Across {
    Vector3 e[n_perturbations];

    explicit Across(Noise& noise, const Vector3& spin = {})
    {
        const auto any = [&] {
            for (;;) {
                const double x = noise(), y = noise(), z = noise();
                const Vector3 v{x, y, z};
                if (norm(v) > 0.1) return v;
            }
        };
        const auto across = [&](const Vector3& n) {
            for (;;) {
                const Vector3 v = cross(n, any());
                if (norm(v) > 0.1 * norm(n)) return (1 / norm(v)) * v;
            }
        };
        Vector3 missed = any();
        if (norm(spin) > 0) missed = (1 / norm(spin)) * spin + std::sqrt(2.0) * across(spin);
        missed *= 1 / norm(missed);
        const Vector3 along = spin - dot(spin, missed) * missed;
        if (norm(along) > 0) {
            const Vector3 beside = cross(missed, along);
            e[0] = (std::sqrt(0.5) / norm(along)) * (along + beside);
        } else {
            e[0] = across(missed);
        }
        e[1] = cross(e[0], missed);
    }
};

/// Which of the twelve numbers of each body are zero all along.
std::vector<std::array<bool, 12>> zeros_of(const Motion& motion, std::size_t n_bodies)
{
    std::vector<std::array<bool, 12>> zeros(n_bodies);
    const auto n = static_cast<std::size_t>(motion.X.n_values);
    if (n != 12 * n_bodies) return zeros;
    for (auto& of_body : zeros) of_body.fill(true);
    for (std::size_t i = 0; i < motion.X.values.size(); ++i)
        if (motion.X.values[i] != 0) zeros[i % n / 12][i % 12] = false;
    return zeros;
}

/// Components of moves, and of turns about axes of the world, that change no such number.
struct Reached {
    std::array<bool, 3> along, about;

    explicit Reached(const std::array<bool, 12>& zeros)
    {
        for (int i = 0; i < 3; ++i) {
            along[i] = !zeros[i];
            about[i] = true;
            for (int d = 3; d < 12; d += 3)
                if (zeros[d + (i + 1) % 3] != zeros[d + (i + 2) % 3]) about[i] = false;
        }
    }
};

/// Perpendicular unit vectors at random that have these components alone; in one of them two that are alike.
std::array<Vector3, n_perturbations> within(const std::array<bool, 3>& allowed, Noise& noise)
{
    const auto any = [&] {
        Vector3 v;
        for (int i = 0; i < 3; ++i) {
            const double x = noise();
            v[i] = allowed[i] ? std::copysign(0.1 + std::abs(x), x) : 0;
        }
        return norm(v) > 0 ? (1 / norm(v)) * v : v;
    };
    std::array<Vector3, n_perturbations> e{any(), any()};
    const Vector3 across = e[1] - dot(e[0], e[1]) * e[0];
    if (norm(across) > 0.01) e[1] = (1 / norm(across)) * across;
    return e;
}

/// The joints of a model between bodies of one mass.
Model with_masses_alike(const Model& model)
{
    Model alike(model.gravity());
    for (Body body : model.bodies()) {
        const double mass = body.mass(0, 0);
        if (mass > 0) body.mass *= 1 / mass;
        alike.add_body(std::move(body));
    }
    for (const Joint& joint : model.joints()) alike.add_joint(joint);
    return alike;
}

/// In lengths and rad; of bodies that are matter.
double widest(const Model& model, std::span<const Matrix34> difference)
{
    double farthest = 0, turned = 0;
    for (std::size_t b = 0; b < difference.size(); ++b) {
        if (model.bodies()[b].holds_states()) continue;
        const Matrix34& d = difference[b];
        farthest = std::max(farthest, norm(d.column(0)));
        turned = std::max(turned, norm(directors(d)) / std::sqrt(2.0));
    }
    return std::max(farthest / model.length(), turned);
}

}   // namespace

double fastest_rate(const Model& model, std::span<const Matrix34> velocities)
{
    const double length = model.length();
    double rate = std::sqrt(norm(model.gravity()) / length);
    for (std::size_t i = 0; i < velocities.size(); ++i) {
        if (model.bodies()[i % model.bodies().size()].holds_states()) continue;
        const Matrix34& V = velocities[i];
        rate = std::max({rate, norm(V.column(0)) / length, norm(directors(V)) / std::sqrt(2.0)});
    }
    return rate;
}

std::vector<Kicks> kicks_everywhere(const Model& model, const State& state, double rate)
{
    const double length = model.length();
    std::vector<Kicks> all(n_perturbations, Kicks(model.bodies().size()));
    Noise noise;
    for (int b = 0; b < model.n_bodies(); ++b) {
        const bool is_point = model.bodies()[b].is_point;
        const Vector3 turning = is_point ? Vector3{} : angular_velocity(state.X[b], state.V[b]);
        const Across step(noise), turn(noise), push(noise), spin(noise, turning);
        for (int k = 0; k < n_perturbations; ++k)
            all[k][b] = {length * step.e[k], turn.e[k], length * rate * push.e[k], rate * spin.e[k]};
        const double speed = model.bodies()[b].state_speed;
        for (int k = 0; speed > 0 && k < n_perturbations; ++k) all[k][b] = {{}, {}, speed * push.e[k], {}};
    }
    return all;
}

Roundings::Roundings(const Model& model, const Motion& motion, double rate)
    : length_(model.length()), rate_(rate)
{
    const std::size_t n = model.bodies().size();
    const std::vector<std::array<bool, 12>> zeros = zeros_of(motion, n);
    for (std::size_t b = 0; b < n; ++b) {
        bool rests = true;
        for (std::size_t i = b; i < motion.velocities.size(); i += n)
            rests = rests && norm(motion.velocities[i]) == 0;
        const Reached reached(rests ? std::array<bool, 12>{} : zeros[b]);
        bodies_.push_back({rests, reached.along, reached.about});
    }
}

std::vector<Kicks> Roundings::of(const State& state)
{
    std::vector<Kicks> all(n_perturbations, Kicks(bodies_.size()));
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const OfBody& body = bodies_[b];
        const double far = body.rests ? length_ : norm(state.X[b].column(0)),
                     fast = body.rests ? length_ * rate_ : norm(state.V[b].column(0)),
                     spin = body.rests ? rate_ : norm(directors(state.V[b])) / std::sqrt(2.0);
        const auto step = within(body.along, noise_), turn = within(body.about, noise_),
                   push = within(body.along, noise_), twist = within(body.about, noise_);
        for (int k = 0; k < n_perturbations; ++k)
            all[k][b] = {far * step[k], turn[k], fast * push[k], spin * twist[k]};
    }
    return all;
}

double size_of(const Model& model, const Kicks& kicks, double rate)
{
    const double in_time = rate > 0 ? 1 / rate : 0;
    double size = 0;
    for (const Kick& kick : kicks)
        size = std::max({size, norm(kick.shift) / model.length(), norm(kick.turn),
                         norm(kick.push) / model.length() * in_time, norm(kick.spin) * in_time});
    return size;
}

/// What rows allow of moves.
std::vector<Matrix34> KickedStates::allowed(const State& at, const std::vector<Matrix34>& moves,
                                            bool are_roundings)
{
    if (model_.has_drives()) {
        const Model still = frozen(model_, {at.t});
        return nearest_rates(are_roundings ? with_masses_alike(still) : still, at.X, moves, rows_);
    }
    if (!are_roundings) return (own_ ? *own_ : own_.emplace(model_, rows_)).at(at.t, at.X, moves);
    if (!alike_) {
        alike_model_ = with_masses_alike(model_);
        alike_.emplace(*alike_model_, rows_);
    }
    return alike_->at(at.t, at.X, moves);
}

State KickedStates::beside(const State& state, const Kicks& kicks, double factor, bool are_roundings)
{
    std::vector<Matrix34> moves;
    for (std::size_t b = 0; b < kicks.size(); ++b)
        moves.push_back(model_.bodies()[b].is_point ? configuration(kicks[b].shift, Matrix3{})
                                                    : rate(state.X[b], kicks[b].shift, kicks[b].turn));
    if (!rows_.empty()) moves = allowed(state, moves, are_roundings);
    State s = state;
    for (std::size_t b = 0; b < kicks.size(); ++b) {
        const Vector3 step = factor * moves[b].column(0), faster = factor * kicks[b].push;
        if (model_.bodies()[b].is_point) {
            s.X[b] = configuration(state.X[b].column(0) + step, Matrix3{});
            s.V[b] = configuration(state.V[b].column(0) + faster, Matrix3{});
            continue;
        }
        // turned with its spin, so that of a free body the turn is none and does not hide what spins do
        s.X[b] = twist::moved(state.X[b], step, factor * angular_velocity(state.X[b], moves[b]));
        const Vector3 spin = angular_velocity(state.X[b], state.V[b]);
        const Vector3 turned = directors(s.X[b]) * (transpose(directors(state.X[b])) * spin);
        s.V[b] = rate(s.X[b], state.V[b].column(0) + faster, turned + factor * kicks[b].spin);
    }
    if (rows_.empty()) return s;
    s.V = model_.has_drives()
              ? nearest_rates(frozen(model_, {state.t}), s.X, s.V, rows_, drive_rates(model_, {state.t}, s.X))
              : allowed(s, s.V, false);
    return s;
}

void Difference::set(const State& a, const State& b, double share)
{
    X.resize(a.X.size());
    V.resize(a.X.size());
    for (std::size_t i = 0; i < a.X.size(); ++i) {
        X[i] = share * (a.X[i] - b.X[i]);
        V[i] = share * (a.V[i] - b.V[i]);
    }
}

Difference& Difference::operator+=(const Difference& other)
{
    for (std::size_t i = 0; i < X.size(); ++i) {
        X[i] += other.X[i];
        V[i] += other.V[i];
    }
    return *this;
}

State Difference::beside(State s, double factor) const
{
    for (std::size_t i = 0; i < X.size(); ++i) {
        s.X[i] += factor * X[i];
        s.V[i] += factor * V[i];
    }
    return s;
}

double Difference::size_of_places(const Model& model) const { return widest(model, X); }

double Difference::size(const Model& model, double rate, double of_places) const
{
    double size = of_places;
    if (rate > 0) raise_to(size, widest(model, V) / rate);
    for (std::size_t b = 0; b < V.size(); ++b)   // states are velocities, by their size
        if (const double speed = model.bodies()[b].state_speed; speed > 0)
            raise_to(size, norm(V[b].column(0)) / speed);
    return size;
}

Growing Difference::most(const Model& model, std::span<const Matrix34> places) const
{
    Growing most;
    double size = 0;
    for (std::size_t b = 0; b < X.size(); ++b) {
        const Matrix34& d = X[b];
        if (model.bodies()[b].holds_states()) continue;
        const bool has_moved = raise_to(size, norm(d.column(0)) / model.length()),
                   has_turned = raise_to(size, norm(directors(d)) / std::sqrt(2.0));
        if (!has_moved && !has_turned) continue;
        Vector3 along = d.column(0);
        if (has_turned) along = {};
        for (int i = 1; has_turned && i <= 3; ++i) along += cross(places[b].column(i), d.column(i));
        const double sign = *std::ranges::max_element(along.a, {}, [](double x) { return std::abs(x); });
        most = {static_cast<int>(b), has_turned, std::copysign(1 / norm(along), sign) * along};
    }
    return most;
}

double Difference::of_bodies(const Model& model, const State& one, const State& other, double rate)
{
    const double in_time = rate > 0 ? 1 / rate : 0;
    double size = 0;
    for (std::size_t b = 0; b < one.X.size(); ++b) {
        const Matrix34 dX = one.X[b] - other.X[b], dV = one.V[b] - other.V[b];
        if (const double speed = model.bodies()[b].state_speed; speed > 0) {
            raise_to(size, norm(dV.column(0)) / speed);
            continue;
        }
        raise_to(size, norm(dX.column(0)) / model.length());
        raise_to(size, norm(dV.column(0)) / model.length() * in_time);
        if (model.bodies()[b].is_point) continue;
        raise_to(size, norm(directors(dX)) / std::sqrt(2.0));
        const auto spin = [b](const State& s) {   // in axes of the body
            return transpose(directors(s.X[b])) * angular_velocity(s.X[b], s.V[b]);
        };
        raise_to(size, norm(spin(one) - spin(other)) * in_time);
    }
    return size;
}

}   // namespace livens::inline spacetime_internal
