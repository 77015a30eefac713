// SPDX-License-Identifier: BSD-3-Clause
// What a projection of velocities has changed, in words of joints and bodies, the largest changes first.
// Users state rates of coordinates, so these are told and not twists.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <string_view>
#include <vector>

#include "livens/base/text.h"
#include "livens/dynamics/start/rate_changes.h"
#include "livens/multibody/joint_coordinates.h"

namespace livens::inline dynamics_internal {

namespace {

struct Change {
    std::string text;
    double speed;   // m/s, or what it is at the model's length
};

Vector3 spin_of(const Model& model, int body, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    if (body == world || model.bodies()[body].is_point) return {};
    return angular_velocity(X[body], V[body]);
}

/// Three digits a component; rounding of the others is zero.
std::string told(const Vector3& v)
{
    std::string text;
    for (int k = 0; k < 3; ++k)
        text += (k == 0 ? "(" : ", ") + to_text(std::abs(v[k]) < 1e-9 * norm(v) ? 0.0 : v[k], 3);
    return text + ")";
}

/// Joints that hold points together have no coordinate for how their bodies turn. Couplings hold none.
bool turns_unnamed(const Model& model, const Joint& joint)
{
    const auto is_point = [&](int body) { return body != world && model.bodies()[body].is_point; };
    constexpr std::string_view others[] = {"drive", "rod", "coupling", "gear", "rack_and_pinion"};
    return joint.coordinates.empty() && std::ranges::find(others, joint.type) == std::end(others) &&
           !is_point(joint.first) && !is_point(joint.second);
}

}   // namespace

std::string rate_changes(const Model& model, std::span<const Matrix34> X, std::span<const Matrix34> before,
                         std::span<const Matrix34> after)
{
    constexpr double least = 1e-6;   // of the fastest change
    constexpr std::size_t most = 3;
    std::vector<Change> changes;
    for (const Joint& joint : model.joints()) {
        for (const NamedCoordinate& one : joint.coordinates) {
            const double from = coordinate_rate(one.coordinate, X, before),
                         to = coordinate_rate(one.coordinate, X, after);
            const bool is_angle = one.coordinate.is_angle();
            changes.push_back({joint.name + "." + one.name + " " + to_text(from, 3) + " -> " +
                                   to_text(to, 3) + (is_angle ? " rad/s" : " m/s"),
                               std::abs(to - from) * (is_angle ? model.length() : 1)});
        }
        if (!turns_unnamed(model, joint)) continue;
        const auto turning = [&](std::span<const Matrix34> V) {
            return spin_of(model, joint.second, X, V) - spin_of(model, joint.first, X, V);
        };
        const Vector3 from = turning(before), to = turning(after);
        changes.push_back({"turning at '" + joint.name + "' " + to_text(norm(from), 3) + " -> " +
                               to_text(norm(to), 3) + " rad/s",
                           norm(to - from) * model.length()});
    }
    for (int b = 0; b < model.n_bodies(); ++b) {   // what was stated of a body, and is not kept
        const Vector3 from = spin_of(model, b, X, before), to = spin_of(model, b, X, after);
        if (norm(from) == 0) continue;
        changes.push_back(
            {"angular velocity of '" + model.body_name(b) + "' " + told(from) + " -> " + told(to) + " rad/s",
             norm(to - from) * model.length()});
    }
    // Turns count at the model's length, so that turns and slides are compared by speed.
    std::ranges::stable_sort(changes, std::greater(), &Change::speed);
    std::string text;
    for (std::size_t i = 0; i < std::min(most, changes.size()); ++i) {
        if (!(changes[i].speed > least * changes[0].speed)) break;
        text += (text.empty() ? "" : ", ") + changes[i].text;
    }
    return text;
}

std::string velocity_change(const Body& body, const Matrix34& X, const Matrix34& before,
                            const Matrix34& after)
{
    const double speed = norm(after.column(0) - before.column(0));
    if (body.is_point) return to_text(speed, 2) + " m/s";
    const double spin = norm(angular_velocity(X, after) - angular_velocity(X, before));
    return to_text(speed, 2) + " m/s and " + to_text(spin, 2) + " rad/s";
}

}   // namespace livens::inline dynamics_internal
