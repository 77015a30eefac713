// SPDX-License-Identifier: BSD-3-Clause
// How perturbations of the start grow: neighbouring motions, carried along.  (docs/theory.md, "The horizon")
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "livens/base/error.h"
#include "livens/diagnostics/largest.h"
#include "livens/multibody/body.h"
#include "livens/multibody/twist.h"
#include "livens/spacetime/detail/neighbour.h"
#include "livens/spacetime/second.h"

namespace livens {

namespace {

/// Of lengths of the model and rad, where neighbours are brought near again: far above rounding.
constexpr double small = 1e-5;
/// How far they may part until then, as foreseen and at the most: far below what bends.
constexpr double wide = 3e-5, too_wide = 1e-4;
/// Elements that neighbours are solved for together, at first and at the most.
constexpr int first_piece = 16, most_in_piece = 128;
/// Neighbours on either side of the motion.
constexpr int n_pairs = 2;

/// Numbers between -1 and 1 that are the same on every machine.
class Noise {
public:
    double operator()()
    {
        state_ ^= state_ << 13, state_ ^= state_ >> 7, state_ ^= state_ << 17;
        return 2 * static_cast<double>(state_ >> 11) / 9007199254740992.0 - 1;
    }

private:
    std::uint64_t state_ = 0x9e3779b97f4a7c15u;
};

/// The fastest rate that gravity and velocities make, 1/s: how velocities compare with positions.
double fastest_rate(const Model& model, std::span<const Matrix34> velocities)
{
    const double length = model.length();
    double rate = std::sqrt(norm(model.gravity()) / length);
    for (const Matrix34& V : velocities)
        rate = std::max({rate, norm(V.column(0)) / length, norm(directors(V)) / std::sqrt(2.0)});
    return rate;
}

/// In lengths and rad.
double size_of(const Model& model, std::span<const Matrix34> difference)
{
    double farthest = 0, widest = 0;
    for (const Matrix34& d : difference) {
        farthest = std::max(farthest, norm(d.column(0)));
        widest = std::max(widest, norm(directors(d)) / std::sqrt(2.0));
    }
    return std::max(farthest / model.length(), widest);
}

/// Half the difference of two states.
struct Difference {
    std::vector<Matrix34> X, V;

    Difference(const State& a, const State& b)
    {
        for (std::size_t i = 0; i < a.X.size(); ++i) {
            X.push_back(0.5 * (a.X[i] - b.X[i]));
            V.push_back(0.5 * (a.V[i] - b.V[i]));
        }
    }
    State beside(State s, double factor) const
    {
        for (std::size_t i = 0; i < X.size(); ++i) {
            s.X[i] += factor * X[i];
            s.V[i] += factor * V[i];
        }
        return s;
    }
    /// In lengths and rad, velocities as they would be after a time of 1 / rate.
    double size(const Model& model, double rate) const
    {
        const double of_positions = size_of(model, X);
        return rate > 0 ? std::max(of_positions, size_of(model, V) / rate) : of_positions;
    }
};

/// The body that such a difference moves or turns most, and along or about what.
Growing most_of(const Model& model, std::span<const Matrix34> difference, std::span<const Matrix34> X)
{
    Growing most;
    double size = 0;
    for (std::size_t b = 0; b < difference.size(); ++b) {
        const Matrix34& d = difference[b];
        const bool has_moved = raise_to(size, norm(d.column(0)) / model.length()),
                   has_turned = raise_to(size, norm(directors(d)) / std::sqrt(2.0));
        if (!has_moved && !has_turned) continue;
        Vector3 along = d.column(0);
        if (has_turned) along = {};
        for (int i = 1; has_turned && i <= 3; ++i) along += cross(X[b].column(i), d.column(i));
        const double sign = *std::ranges::max_element(along.a, {}, [](double x) { return std::abs(x); });
        most = {static_cast<int>(b), has_turned, std::copysign(1 / norm(along), sign) * along};
    }
    return most;
}

/// Half of what two states are apart, each by its size: shifts and turns, pushes and spins at this rate.
double perturbation(const Model& model, const State& one, const State& other, double rate)
{
    const double in_time = rate > 0 ? 1 / rate : 0;
    double size = 0;
    for (std::size_t b = 0; b < one.X.size(); ++b) {
        const Matrix34 dX = one.X[b] - other.X[b], dV = one.V[b] - other.V[b];
        raise_to(size, norm(dX.column(0)) / model.length());
        raise_to(size, norm(dV.column(0)) / model.length() * in_time);
        if (model.bodies()[b].is_point) continue;
        raise_to(size, norm(directors(dX)) / std::sqrt(2.0));
        const auto spin = [b](const State& s) {   // in axes of the body
            return transpose(directors(s.X[b])) * angular_velocity(s.X[b], s.V[b]);
        };
        raise_to(size, norm(spin(one) - spin(other)) * in_time);
    }
    return 0.5 * size;
}

/// Two perpendicular unit vectors at random. Together they miss one direction; it is as far from what turns a
/// body as from what is across it, since either may be what grows.
struct Across {
    Vector3 e[n_pairs];

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
        e[0] = across(missed);
        e[1] = cross(missed, e[0]);
    }
};

/// States beside this one, off by `small` in all that can move.
std::vector<State> neighbours_of(const Model& model, const State& state, double rate)
{
    const double length = model.length();
    std::vector<State> all(n_pairs, state);
    Noise noise;
    for (int b = 0; b < model.n_bodies(); ++b) {
        const bool is_point = model.bodies()[b].is_point;
        const Vector3 turning = is_point ? Vector3{} : angular_velocity(state.X[b], state.V[b]);
        const Across step(noise), turn(noise), push(noise), spin(noise, turning);
        for (int k = 0; k < n_pairs; ++k) {
            State& s = all[k];
            const Vector3 shift = small * length * step.e[k], faster = small * length * rate * push.e[k];
            if (is_point) {
                s.X[b] = configuration(state.X[b].column(0) + shift, Matrix3{});
                s.V[b] = configuration(state.V[b].column(0) + faster, Matrix3{});
                continue;
            }
            // turned with its spin, so that of a free body the turn is none and does not hide what spins do
            s.X[b] = twist::moved(state.X[b], shift, small * turn.e[k]);
            const Vector3 turned = directors(s.X[b]) * (transpose(directors(state.X[b])) * turning);
            const Vector3 w = turned + small * rate * spin.e[k];
            s.V[b] = configuration(state.V[b].column(0) + faster, cross_matrix(w) * directors(s.X[b]));
        }
    }
    return all;
}

/// What lies on the other side of the motion as this piece of a neighbour, from an element on: its guess, off
/// by what bends. Without elements where the two have different ones.
Motion mirrored(const Motion& motion, int first, const Motion& beside)
{
    Motion other;
    const Field &X = motion.X, &Y = beside.X;
    const auto begin = motion.mesh.ends.begin() + first;
    const bool is_alike = X.continuous && X.degree == Y.degree && X.points == Y.points &&
                          X.denominators.empty() &&
                          std::equal(beside.mesh.ends.begin(), beside.mesh.ends.end(), begin);
    if (!is_alike) return other;
    other.mesh = beside.mesh;
    other.X = Y;
    const double* x = X.coefficient(first, 0).data();
    for (double& y : other.X.values) y = 2 * *x++ - y;
    return other;
}

/// Motions on either side: what bends in half their difference is of third order, and does not grow into
/// directions that are not there.
struct Pair {
    Neighbour sides[2];
    State starts[2]{};
    double so_far = 1;   // by the difference at hand: what was made smaller on the way
    bool is_lost = false;

    Difference apart_at(double t) const { return {sides[0].motion().at(t), sides[1].motion().at(t)}; }
};

/// All pairs, piece by piece; between pieces they are brought near again.
class Neighbours {
public:
    Neighbours(const Model& model, const Method& method, const SolveOptions& quiet, const Motion& motion,
               double rate)
        : model_(model), method_(method), quiet_(quiet), motion_(motion), rate_(rate)
    {}

    /// At element ends, as far as any pair can be solved.
    Growth grown_from(std::vector<State> neighbours, double rate)
    {
        const State start = motion_.at_end(0);
        for (State& one : neighbours) {
            State other = Difference(start, one).beside(start, 2);
            pairs_.push_back(
                {{Neighbour(model_, method_, quiet_, motion_), Neighbour(model_, method_, quiet_, motion_)},
                 {std::move(one), std::move(other)}});
        }
        for (int at = 0; at < motion_.n_elements();) {
            const int last = solve_from(at);
            if (at == 0) begin(rate);
            if (are_lost()) break;
            const int end = record(at, last);
            bring_near(at, end);
            at = end;
        }
        return std::move(grown_);
    }

private:
    bool are_lost() const
    {
        return std::ranges::all_of(pairs_, [](const Pair& pair) { return pair.is_lost; });
    }

    /// The first motion tells how far it is to go before it is too far from the one between them.
    int solve_from(int first)
    {
        int last = std::min(first + length_, motion_.n_elements());
        bool is_first = true;
        for (Pair& pair : pairs_) {
            if (pair.is_lost) continue;
            pair.is_lost = !pair.sides[0].solve(pair.starts[0], motion_, first, last);
            if (pair.is_lost) continue;
            const Motion& one = pair.sides[0].motion();
            for (int end = first + 1; is_first && end < last; ++end)
                if (2 * Difference(one.at(motion_.mesh.ends[end + 1]), motion_.at_end(end + 1))
                            .size(model_, rate_) >
                    too_wide)
                    last = end;
            is_first = false;
            const Motion other = mirrored(motion_, first, one);
            pair.is_lost =
                !pair.sides[1].solve(pair.starts[1], other.X.empty() ? motion_ : other, first, last);
        }
        return last;
    }

    /// Perturbations are judged as they are where all constraints hold.
    void begin(double rate)
    {
        const double t = motion_.start();
        for (Pair& pair : pairs_) {
            if (pair.is_lost) continue;
            const State one = pair.sides[0].motion().at(t), other = pair.sides[1].motion().at(t);
            const double size = perturbation(model_, one, other, rate);
            pair.is_lost = !(size > 1e-3 * small);   // nothing can move but what is driven
            pair.so_far = 1 / size;
        }
        if (!are_lost()) grown_.factors.push_back(1);
    }

    /// Up to where a pair is too wide, or to the end of what was solved.
    int record(int first, int last)
    {
        int end = first;
        for (; end < last; ++end) {
            double size = 0, grown = 0;
            Growing part;
            for (const Pair& pair : pairs_) {
                if (pair.is_lost) continue;
                const Difference apart = pair.apart_at(motion_.mesh.ends[end + 1]);
                raise_to(size, apart.size(model_, rate_));
                const double of_pair = pair.so_far * size_of(model_, apart.X);
                if (of_pair > grown && of_pair > largest_)
                    part = most_of(model_, apart.X, motion_.at_end(end + 1).X);
                raise_to(grown, of_pair);
            }
            if (size > too_wide && end > first) break;
            if (grown > largest_ && largest_ < growth_at_horizon) grown_.part = part;
            raise_to(largest_, grown);
            grown_.factors.push_back(grown);
        }
        return end;
    }

    void bring_near(int first, int end)
    {
        double widest = small;
        for (Pair& pair : pairs_) {
            if (pair.is_lost) continue;
            // Near in positions alone is not near: where neighbours cross, their velocities differ most.
            const Difference apart = pair.apart_at(motion_.mesh.ends[end]);
            const double size = apart.size(model_, rate_), share = small / size;
            raise_to(widest, size);
            pair.is_lost = !std::isfinite(share);
            pair.so_far /= share;
            for (int k = 0; k < 2; ++k) {
                pair.starts[k] = apart.beside(motion_.at_end(end), k == 0 ? share : -share);
                pair.starts[k].t = motion_.mesh.ends[end];
            }
        }
        const int n = end - first;
        const double by_element = std::log(widest / small) / n, fitting = std::log(wide / small) / by_element;
        length_ = static_cast<int>(std::clamp(fitting, 1.0, std::min(2.0 * n, 1.0 * most_in_piece)));
    }

    const Model& model_;
    const Method& method_;
    const SolveOptions& quiet_;
    const Motion& motion_;
    double rate_;   // the fastest there ever is
    int length_ = first_piece;
    std::vector<Pair> pairs_;
    double largest_ = 1;
    Growth grown_;
};

}   // namespace

Growth growth(const Model& model, const Problem& problem, const Method& method, const SolveOptions& options,
              const Motion& motion)
{
    if (problem.conditions.at_start != Known::state || motion.n_elements() == 0) return {};
    SolveOptions quiet = options;
    quiet.condition = quiet.judge = quiet.end_at_bends = quiet.look_at_laws = false;
    quiet.meeting = std::numeric_limits<double>::infinity();   // neighbours are beside it
    quiet.initial = StartPolicy::project;
    const State start = motion.at_end(0);
    const double at_start = fastest_rate(model, start.V), ever = fastest_rate(model, motion.velocities);
    return Neighbours(model, method, quiet, motion, ever > 0 ? ever : 1)
        .grown_from(neighbours_of(model, start, at_start), at_start);
}

}   // namespace livens
