// SPDX-License-Identifier: BSD-3-Clause
// How perturbations of the start grow: neighbouring motions, carried along.  (docs/theory.md, "The horizon")
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "livens/base/error.h"
#include "livens/diagnostics/largest.h"
#include "livens/multibody/body.h"
#include "livens/multibody/twist.h"
#include "livens/spacetime/solve.h"

namespace livens {

namespace {

/// Of lengths of the model and rad: far above rounding, far below what bends.
constexpr double small = 1e-6;
/// Elements after which a neighbour is brought near again.
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

double distance(const Model& model, const State& a, const State& b)
{
    double largest = 0;
    for (int i = 0; i < model.n_bodies(); ++i) {
        const Matrix34 d = a.X[i] - b.X[i];
        largest = std::max(
            {largest, norm(d.column(0)) / model.length(), norm(directors(d)) / std::sqrt(2.0)});
    }
    return largest;
}

/// The state at t, a share of the way to the neighbour.
State between(const State& state, const State& neighbour, double share)
{
    State s = state;
    for (std::size_t b = 0; b < s.X.size(); ++b) {
        s.X[b] += share * (neighbour.X[b] - state.X[b]);
        s.V[b] += share * (neighbour.V[b] - state.V[b]);
    }
    return s;
}

/// A state beside this one, off by about `small` in all that can move.
State neighbour_of(const Model& model, const State& state, Noise noise)
{
    const double length = model.length();
    double rate = std::sqrt(norm(model.gravity()) / length);
    for (const Matrix34& V : state.V)
        rate = std::max({rate, norm(V.column(0)) / length, norm(directors(V)) / std::sqrt(2.0)});
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

/// At element ends, as far as the neighbour's motion can be solved.
std::vector<double> growth_beside(State neighbour, const Model& model, const Method& method,
                                  const SolveOptions& quiet, const Motion& motion)
{
    std::vector<double> grown;
    double so_far = 1;   // growth at the near end of the piece
    for (int first = 0, n = motion.n_elements(); first < n; first += piece) {
        const int last = std::min(first + piece, n);
        TimeMesh mesh{{motion.mesh.ends.begin() + first, motion.mesh.ends.begin() + last + 1}};
        mesh.required = mesh.ends;
        Solution beside;
        try {
            beside = solve(model, {{neighbour}}, mesh, method, quiet);
        } catch (const InputError& error) {   // the motion has come to a singular position
            if (error.complaint().code != "start-singular") throw;
            return grown;
        }
        if (!beside.report.converged()) return grown;
        const double begin = distance(model, motion.at_end(first), beside.motion.at_end(0));
        if (!(begin > 0)) return {};   // nothing can move
        double end = 0;
        for (int e = first == 0 ? 0 : first + 1; e <= last; ++e) {
            end = distance(model, motion.at_end(e), beside.motion.at(motion.mesh.ends[e]));
            grown.push_back(so_far * end / begin);
        }
        so_far *= end / begin;
        neighbour = between(motion.at_end(last), beside.motion.at(mesh.end()), end > 0 ? small / end : 0);
        neighbour.t = mesh.end();
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
    quiet.condition = quiet.judge = false;
    quiet.initial = StartPolicy::project;
    for (const std::uint64_t seed : seeds) {
        const State neighbour = neighbour_of(model, motion.at_end(0), Noise(seed));
        const std::vector<double> one = growth_beside(neighbour, model, method, quiet, motion);
        grown.resize(std::max(grown.size(), one.size()), 0.0);
        for (std::size_t e = 0; e < one.size(); ++e) raise_to(grown[e], one[e]);
    }
    return grown;
}

}   // namespace livens
