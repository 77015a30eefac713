// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "livens/base/text.h"
#include "livens/multibody/detail/rate_changes.h"
#include "livens/multibody/joint_coordinates.h"

namespace livens {

namespace {

struct Change {
    std::string name;
    double before, after;
    bool is_angle;
    double speed;   // m/s, or what it is at the model's length
};

Vector3 spin_of(const Model& model, int body, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    if (body == world || model.bodies()[body].is_point) return {};
    return angular_velocity(X[body], V[body]);
}

}   // namespace

std::string rate_changes(const Model& model, std::span<const Matrix34> X, std::span<const Matrix34> before,
                         std::span<const Matrix34> after)
{
    constexpr double least = 1e-6;   // of the fastest change
    constexpr std::size_t most = 3;
    std::vector<Change> changes;
    const auto add = [&](const std::string& name, double from, double to, bool is_angle) {
        changes.push_back({name, from, to, is_angle, std::abs(to - from) * (is_angle ? model.length() : 1)});
    };
    for (const Joint& joint : model.joints()) {
        for (const NamedCoordinate& one : joint.coordinates)
            add(joint.name + "." + one.name, coordinate_rate(one.coordinate, X, before),
                coordinate_rate(one.coordinate, X, after), one.coordinate.is_angle());
        if (!joint.coordinates.empty() || joint.type == "drive") continue;
        const auto turning = [&](std::span<const Matrix34> V) {
            return norm(spin_of(model, joint.second, X, V) - spin_of(model, joint.first, X, V));
        };
        add("turning at '" + joint.name + "'", turning(before), turning(after), true);
    }
    std::ranges::stable_sort(changes, std::greater(), &Change::speed);
    std::string text;
    for (std::size_t i = 0; i < std::min(most, changes.size()); ++i) {
        const Change& one = changes[i];
        if (!(one.speed > least * changes[0].speed)) break;
        text += (text.empty() ? "" : ", ") + one.name + " " + to_text(one.before, 3) + " -> " +
                to_text(one.after, 3) + (one.is_angle ? " rad/s" : " m/s");
    }
    return text;
}

}   // namespace livens
