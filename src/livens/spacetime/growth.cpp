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
#include "livens/spacetime/solve.h"

namespace livens {

namespace {

/// Of lengths of the model and rad: far above rounding, far below what bends.
constexpr double small = 1e-5;
/// Elements after which neighbours are brought near again.
constexpr int piece = 16;
/// Start of the numbers that make a neighbour. One of them may happen to lie beside the direction that grows.
constexpr std::uint64_t seeds[] = {0x9e3779b97f4a7c15u, 0xbf58476d1ce4e5b9u};

/// Numbers between -1 and 1 that are the same on every machine.
class Noise {
public:
    explicit Noise(std::uint64_t seed) : state_(seed) {}
    double operator()()
    {
        state_ ^= state_ << 13, state_ ^= state_ >> 7, state_ ^= state_ << 17;
        return 2 * static_cast<double>(state_ >> 11) / 9007199254740992.0 - 1;
    }

private:
    std::uint64_t state_;
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
};

/// A state beside this one, off by about `small` in all that can move.
State neighbour_of(const Model& model, const State& state, double rate, Noise noise)
{
    const double length = model.length();
    const auto any = [&](double size) {
        const double x = noise(), y = noise(), z = noise();
        return size * Vector3{x, y, z};
    };
    State s = state;
    for (int b = 0; b < model.n_bodies(); ++b) {
        const Vector3 step = any(small * length), turn = any(small);
        const Vector3 push = any(small * length * rate), spin = any(small * rate);
        if (model.bodies()[b].is_point) {
            s.X[b] = configuration(state.X[b].column(0) + step, Matrix3{});
            s.V[b] = configuration(state.V[b].column(0) + push, Matrix3{});
            continue;
        }
        s.X[b] = twist::moved(state.X[b], step, turn);
        const Vector3 w = angular_velocity(state.X[b], state.V[b]) + spin;
        s.V[b] = configuration(state.V[b].column(0) + push, cross_matrix(w) * directors(s.X[b]));
    }
    return s;
}

/// At element ends, as far as the neighbours' motions can be solved. One on either side: what bends in their
/// difference is of third order, and does not grow into directions that are not there.
std::vector<double> growth_beside(const State& neighbour, double rate, const Model& model,
                                  const Method& method, const SolveOptions& quiet, const Motion& motion)
{
    std::vector<double> grown;
    const State start = motion.at_end(0);
    State sides[2] = {neighbour, Difference(start, neighbour).beside(start, 2)};
    double so_far = 1;   // of what was made smaller on the way
    double begin = 0;
    for (int first = 0, n = motion.n_elements(); first < n; first += piece) {
        const int last = std::min(first + piece, n);
        TimeMesh mesh{{motion.mesh.ends.begin() + first, motion.mesh.ends.begin() + last + 1}};
        mesh.required = mesh.ends;
        Solution beside[2];
        for (int k = 0; k < 2; ++k) {
            try {
                beside[k] = solve(model, {{sides[k]}, {}, &motion}, mesh, method, quiet);
            } catch (const InputError&) {   // the motion has come to a singular position
                return grown;
            }
            if (!beside[k].report.converged()) return grown;
        }
        const auto apart_at = [&](double t) {
            return Difference(beside[0].motion.at(t), beside[1].motion.at(t));
        };
        if (first == 0) begin = size_of(model, apart_at(mesh.start()).X);
        if (!(begin > 1e-3 * small)) return {};   // nothing can move but what is driven
        for (int e = first == 0 ? 0 : first + 1; e <= last; ++e)
            grown.push_back(so_far * size_of(model, apart_at(motion.mesh.ends[e]).X) / begin);
        // Near in positions alone is not near: where neighbours cross, their velocities differ most.
        const Difference apart = apart_at(mesh.end());
        const double share = small / std::max(size_of(model, apart.X), size_of(model, apart.V) / rate);
        if (!std::isfinite(share)) return grown;
        so_far /= share;
        for (int k = 0; k < 2; ++k) {
            sides[k] = apart.beside(motion.at_end(last), k == 0 ? share : -share);
            sides[k].t = mesh.end();
        }
    }
    return grown;
}

}   // namespace

std::vector<double> growth(const Model& model, const Problem& problem, const Method& method,
                           const SolveOptions& options, const Motion& motion)
{
    std::vector<double> grown;
    if (problem.conditions.at_start != Known::state || motion.n_elements() == 0) return grown;
    SolveOptions quiet = options;
    quiet.condition = quiet.judge = quiet.end_at_bends = quiet.look_at_laws = false;
    quiet.meeting = std::numeric_limits<double>::infinity();   // neighbours are beside it
    quiet.initial = StartPolicy::project;
    const State start = motion.at_end(0);
    const double at_start = fastest_rate(model, start.V), ever = fastest_rate(model, motion.velocities);
    const double rate = ever > 0 ? ever : 1;
    for (const std::uint64_t seed : seeds) {
        const State neighbour = neighbour_of(model, start, at_start, Noise(seed));
        const std::vector<double> one = growth_beside(neighbour, rate, model, method, quiet, motion);
        grown.resize(std::max(grown.size(), one.size()), 0.0);
        for (std::size_t e = 0; e < one.size(); ++e) raise_to(grown[e], one[e]);
    }
    return grown;
}

}   // namespace livens
