// SPDX-License-Identifier: BSD-3-Clause
#include "livens/io/report/lines_of_action.h"

#include <algorithm>
#include <cmath>

#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/sample.h"

namespace livens {

namespace {

constexpr int n_looks = 16;           // instants at which loads are looked at
constexpr double same = 1e-6;         // of the largest arm: points that are one
constexpr double negligible = 1e-6;   // of a load's largest force: there its point is not asked for

LoadForces forces_of(const Load& load, const State& state, std::span<const double> angles,
                     Side side = Side::right)
{
    LoadForces F{};
    load.forces(load_arguments(load, {state.t, side}, state.X, state.V, angles), F);
    return F;
}

/// The point theta of F = f (1, theta)^T, none if F is not of that form.
std::optional<Vector3> point_of(const Matrix34& F, double length)
{
    const Vector3 f = F.column(0);
    Vector3 theta{};
    for (int i = 0; i < 3; ++i) {
        theta[i] = dot(f, F.column(i + 1)) / dot(f, f);
        const Vector3 rest = F.column(i + 1) - theta[i] * f;
        if (!(norm(rest) <= same * norm(f) * (length + std::abs(theta[i])))) return {};
    }
    return theta;
}

/// Keeps a point as long as every look finds the same.
class Finding {
public:
    void look(const Matrix34& F, double length)
    {
        if (has_failed_) return;
        const std::optional<Vector3> point = point_of(F, length);
        has_failed_ = !point || (point_ && norm(*point - *point_) > same * (length + norm(*point)));
        if (!point_) point_ = point;
    }
    std::optional<Vector3> point() const { return has_failed_ ? std::nullopt : point_; }

private:
    std::optional<Vector3> point_;
    bool has_failed_ = false;
};

}   // namespace

std::vector<LineOfAction> lines_of_action(const Model& model, const Motion& motion)
{
    std::vector<LineOfAction> lines(model.loads().size());
    if (lines.empty()) return lines;
    const LoadTurns turns(model, motion);
    std::vector<State> states;
    std::vector<std::vector<double>> angles;
    for (int k = 0; k < n_looks; ++k) {
        const double share = (k + 0.5) / n_looks;   // not at the start, where springs are often relaxed
        states.push_back(sample_state(motion, motion.start() + share * (motion.end() - motion.start())));
        angles.push_back(turns.at(states.back()));
    }
    const double length = model.length();
    for (std::size_t l = 0; l < lines.size(); ++l) {
        const Load& load = model.loads()[l];
        std::vector<LoadForces> looks;
        double largest = 0;
        for (std::size_t k = 0; k < states.size(); ++k) {
            looks.push_back(forces_of(load, states[k], turns.turns().of(static_cast<int>(l), angles[k])));
            for (const Matrix34& F : looks.back()) largest = std::max(largest, norm(F.column(0)));
        }
        for (const std::size_t side : {0u, 1u}) {
            Finding finding;
            for (const LoadForces& F : looks)
                if (norm(F[side].column(0)) > negligible * largest) finding.look(F[side], length);
            lines[l].points[side] = finding.point();
        }
    }
    return lines;
}

std::vector<Vector3> load_forces(const Model& model, const State& state, std::span<const double> angles,
                                 Side side)
{
    const Turns turns(model);
    std::vector<Vector3> forces;
    for (std::size_t l = 0; l < model.loads().size(); ++l)
        forces.push_back(
            forces_of(model.loads()[l], state, turns.of(static_cast<int>(l), angles), side)[0].column(0));
    return forces;
}

}   // namespace livens
