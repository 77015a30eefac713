// SPDX-License-Identifier: BSD-3-Clause
#include "livens/diagnostics/coordinates.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "livens/base/elementary.h"
#include "livens/diagnostics/sample.h"

namespace livens {

namespace {

double value_of(const PairForm& form, std::span<const Matrix34> X)
{
    return form_value(form, form.body_i, form.body_j, X);
}

double rate_of(const PairForm& form, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    ConstraintRow row;
    static_cast<PairForm&>(row) = form;
    const RowGradient gradient = constraint_gradient(row, X);
    double rate = 0;
    for (int side = 0; side < gradient.bodies.size; ++side)
        rate += dot(gradient.by[side], V[gradient.bodies.bodies[side]]);
    return rate;
}

/// The shorter way from one configuration to another.
double change_of(const JointCoordinate& q, std::span<const Matrix34> from, std::span<const Matrix34> to)
{
    if (!q.is_angle()) return value_of(q.forms[0], to) - value_of(q.forms[0], from);
    const double c0 = value_of(q.forms[0], from), s0 = value_of(q.forms[1], from);
    const double c = value_of(q.forms[0], to), s = value_of(q.forms[1], to);
    return arc_tangent(c0 * s - s0 * c, c0 * c + s0 * s);
}

std::vector<Matrix34> configurations(const Motion& motion, int element, int node)
{
    const std::span<const double> X = motion.X.coefficient(element, node);
    std::vector<Matrix34> all(static_cast<std::size_t>(motion.n_bodies));
    for (std::size_t b = 0; b < all.size(); ++b) std::copy_n(X.begin() + 12 * b, 12, all[b].data());
    return all;
}

}   // namespace

double coordinate_value(const JointCoordinate& q, std::span<const Matrix34> X)
{
    return q.is_angle() ? arc_tangent(value_of(q.forms[1], X), value_of(q.forms[0], X))
                        : value_of(q.forms[0], X);
}

double coordinate_rate(const JointCoordinate& q, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    if (!q.is_angle()) return rate_of(q.forms[0], X, V);
    const double c = value_of(q.forms[0], X), s = value_of(q.forms[1], X);
    return (c * rate_of(q.forms[1], X, V) - s * rate_of(q.forms[0], X, V)) / (c * c + s * s);
}

JointCoordinates::JointCoordinates(const Model& model, const Motion& motion) : model_(model), motion_(motion)
{
    for (int j = 0; j < static_cast<int>(model.joints().size()); ++j)
        for (int k = 0; k < static_cast<int>(model.joints()[j].coordinates.size()); ++k)
            places_.push_back({j, k});
    if (places_.empty()) return;
    for (const Body& body : model.bodies()) stated_.push_back(body.X);
    std::vector<double> now =
        turned(sample_state(motion, motion.start()).X, std::vector<double>(places_.size(), 0.0));
    at_ends_ = now;
    for (int e = 0; e < motion.n_elements(); ++e) {
        for (int node = 1; node <= motion.X.degree; ++node)
            now = turned(configurations(motion, e, node), now);
        at_ends_.insert(at_ends_.end(), now.begin(), now.end());
    }
}

/// Coordinates less those of the bodies as stated: turns are whole, so that rounding does not gather.
std::vector<double> JointCoordinates::turned(std::span<const Matrix34> X, std::span<const double> near) const
{
    constexpr double turn = 2 * std::numbers::pi;
    std::vector<double> all;
    for (int i = 0; i < static_cast<int>(places_.size()); ++i) {
        const JointCoordinate& q = coordinate(i).coordinate;
        const double value = change_of(q, stated_, X);
        all.push_back(q.is_angle() ? value + turn * std::round((near[i] - value) / turn) : value);
    }
    return all;
}

std::vector<CoordinateValue> JointCoordinates::at(double t) const
{
    std::vector<CoordinateValue> all(places_.size());
    if (places_.empty()) return all;
    const State state = sample_state(motion_, t);
    const int end = element_end_at(motion_.mesh, state.t);
    const std::size_t n = places_.size();
    std::span<const double> ends(at_ends_);
    std::vector<double> values;
    if (end >= 0) {
        const std::span<const double> here = ends.subspan(static_cast<std::size_t>(end) * n, n);
        values.assign(here.begin(), here.end());
    } else {
        const int element = motion_.mesh.element_at(state.t);
        const std::vector<double> nodes = motion_.X.basis().nodes();
        const double s = (state.t - motion_.mesh.ends[element]) / motion_.mesh.length(element);
        const std::span<const double> begin = ends.subspan(static_cast<std::size_t>(element) * n, n);
        values.assign(begin.begin(), begin.end());
        for (int node = 1; node <= motion_.X.degree && nodes[node] <= s; ++node)
            values = turned(configurations(motion_, element, node), values);
        values = turned(state.X, values);
    }
    for (int i = 0; i < static_cast<int>(n); ++i)
        all[i] = {coordinate(i).at_stated + values[i],
                  coordinate_rate(coordinate(i).coordinate, state.X, state.V)};
    return all;
}

LostTurn find_lost_turn(const Model& model, const Motion& motion)
{
    LostTurn found;
    for (int l = 0; l < static_cast<int>(model.loads().size()); ++l) {
        const JointCoordinate& q = model.loads()[l].bounded_angle;
        if (q.forms.empty()) continue;
        std::vector<Matrix34> X = sample_state(motion, motion.start()).X;
        double turned = coordinate_value(q, X);
        const std::vector<double> nodes = motion.X.basis().nodes();
        for (int e = 0; e < motion.n_elements() && (found.load < 0 || motion.mesh.ends[e] < found.t); ++e)
            for (int node = 1; node <= motion.X.degree; ++node) {
                const std::vector<Matrix34> next = configurations(motion, e, node);
                turned += change_of(q, X, next);
                X = next;
                if (std::abs(turned) < std::numbers::pi) continue;
                const double t = motion.mesh.ends[e] + nodes[node] * motion.mesh.length(e);
                if (found.load < 0 || t < found.t) found = {l, t};
                break;
            }
    }
    return found;
}

}   // namespace livens
