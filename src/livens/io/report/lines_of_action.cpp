// SPDX-License-Identifier: BSD-3-Clause
// Where forces act: a load states forces on X, not a point. F = f (1, theta)^T tells its point, if it is the
// same at several instants; else a place is fitted by which the torques become least.
#include "livens/io/report/lines_of_action.h"

#include <algorithm>
#include <cmath>

#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/sample.h"
#include "livens/multibody/body.h"

namespace livens::inline io_internal {

namespace {

constexpr int n_looks = 16;           // instants at which loads are looked at
constexpr double same = 1e-6;         // of the largest arm: points that are one
constexpr double negligible = 1e-6;   // of a load's largest force: there its point is not asked for

LoadForces forces_of(const Load& load, const State& state, std::span<const double> angles,
                     Side side = Side::right)
{
    LoadForces F(load.n_acted);
    load.forces(load_arguments(load, {state.t, side}, state.X, state.V, angles), F);
    return F;
}

/// The point theta of F = f (1, theta)^T, none if F is not of that form.
std::optional<Vector3> point_of(const Matrix34& F, double length)
{
    const Vector3 f = F.column(0);
    Vector3 theta{};
    for (int i = 0; i < 3; ++i) {
        // The least-squares multiple of f in each column; what is left must be nothing for F to be a force at
        // a point.
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

/// sum_i d_i x F_i: about the reference point.
Vector3 torque_of(const Matrix34& F, const Matrix34& X)
{
    Vector3 torque{};
    for (int i = 1; i < 4; ++i) torque = torque + cross(X.column(i), F.column(i));
    return torque;
}

/// What a place is when torques do not tell: a joint of the two bodies, else the centre of mass.
Vector3 usual_place(const Model& model, const Load& load)
{
    const int first = load.bodies[0], second = load.bodies[1];
    for (const Joint& joint : model.joints()) {
        if (joint.first == first && joint.second == second) return joint.point_first;
        if (joint.second == first && joint.first == second) return joint.point_second;
    }
    if (first == world) return {};
    const Body& body = model.bodies()[static_cast<std::size_t>(first)];
    return body.is_point ? Vector3{} : mass_properties(body.mass).center_of_mass;
}

/// The p with the least sum of |torque - p x force|^2, both in axes of the body; a little is added for its
/// distance from where it is usual.
/// Normal equations (sum f^T f + weak) shift = -sum f^T torque, with f = [force]x and torques about the usual
/// place.
Vector3 best_place(const Vector3& usual, const std::vector<LoadForces>& looks, const std::vector<Matrix34>& X)
{
    Matrix3 A{};
    Vector3 b{};
    double scale = 0;
    for (std::size_t k = 0; k < looks.size(); ++k) {
        const Matrix3 R = transpose(directors(X[k]));
        const Matrix3 f = cross_matrix(R * looks[k][0].column(0));
        const Vector3 torque = R * torque_of(looks[k][0], X[k]) + f * usual;   // about the usual place
        A = A + transpose(f) * f;
        b = b - transpose(f) * torque;
        scale = std::max({scale, A(0, 0), A(1, 1), A(2, 2)});
    }
    if (!(scale > 0)) return usual;
    constexpr double weak = 1e-4;
    // Torques say nothing along the force: the small term takes the place nearest to the usual one.
    const Vector3 shift = inverse(A + weak * scale * identity<3>()) * b;
    return std::isfinite(norm(shift)) ? usual + shift : usual;
}

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
        const auto exerts = [](const LoadForces& F) {
            double size = 0;
            for (int i = 0; i < 12; ++i) size = std::max(size, std::abs(F[0].a[i]));
            return size > 0;
        };
        if (lines[l].points[0] || !std::ranges::any_of(looks, exerts)) continue;
        std::vector<Matrix34> X;
        for (const State& state : states)
            X.push_back(load.bodies[0] == world ? world_configuration
                                                : state.X[static_cast<std::size_t>(load.bodies[0])]);
        lines[l].place = best_place(usual_place(model, load), looks, X);
    }
    return lines;
}

std::vector<Reaction> load_reactions(const Model& model, const std::vector<LineOfAction>& lines,
                                     const State& state, std::span<const double> angles, Side side)
{
    const UnwrappedAngles turns(model);
    std::vector<Reaction> all;
    for (std::size_t l = 0; l < model.loads().size(); ++l) {
        const Load& load = model.loads()[l];
        const Matrix34 F = forces_of(load, state, turns.of(static_cast<int>(l), angles), side)[0];
        Reaction& given = all.emplace_back(Reaction{F.column(0), {}});
        if (!lines[l].place) continue;
        const Matrix34 X =
            load.bodies[0] == world ? world_configuration : state.X[static_cast<std::size_t>(load.bodies[0])];
        given.torque = torque_of(F, X) - cross(directors(X) * *lines[l].place, given.force);
    }
    return all;
}

}   // namespace livens::inline io_internal
