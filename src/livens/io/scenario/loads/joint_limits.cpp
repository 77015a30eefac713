// SPDX-License-Identifier: BSD-3-Clause
// `limits` of a joint and the springs behind them. What nobody states follows from the bodies: a contact is
// as short as it may be without being what elements are made for (docs/joints.md, Along coordinates).
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "livens/io/scenario/loads/load_makers.h"
#include "livens/multibody/body.h"

namespace livens::inline io_internal {

namespace {

constexpr double share_of_contact = 0.03;      // of T below
constexpr double time_without_gravity = 0.3;   // s: that of 0.9 m on earth

/// Whether bodies hang on each other by it: not by drives, nor by what couples coordinates of others.
bool holds(const Joint& joint)
{
    return joint.type != "drive" && joint.type != "gear" && joint.type != "rack_and_pinion";
}

/// The bodies that hang on one without a joint; it alone where they lead to `end` or to the world.
std::vector<int> hanging_on(const Model& model, int body, const Joint& without, int end)
{
    std::vector<int> found{body};
    for (std::size_t i = 0; i < found.size(); ++i)
        for (const Joint& joint : model.joints()) {
            if (!holds(joint) || joint.name == without.name ||
                (joint.first != found[i] && joint.second != found[i]))
                continue;
            const int next = joint.first == found[i] ? joint.second : joint.first;
            if (next == world || next == end) return {body};
            if (std::ranges::find(found, next) == found.end()) found.push_back(next);
        }
    return found;
}

/// kg m^2 or kg: what a body and all that hangs on it move with at unit rate of the coordinate.
double inertia_along(const Model& model, const Joint& joint, const NamedCoordinate& coordinate,
                     bool of_second)
{
    const std::vector<Matrix34> X = model.start().X;
    const Matrix34& of = X[static_cast<std::size_t>(joint.second)];
    const Vector3 place = of * point(joint.point_second);
    const bool is_angle = coordinate.coordinate.is_angle();
    Vector3 gradient{};   // of the coordinate, by turning or moving the second body
    for (int k = 0; k < 3; ++k) {
        Vector3 unit{};
        unit[k] = 1;
        std::vector<Matrix34> V(X.size());
        V[static_cast<std::size_t>(joint.second)] =
            is_angle ? rate(of, cross(unit, of.column(0) - place), unit) : rate(of, unit, {});
        gradient[k] = coordinate_rate(coordinate.coordinate, X, V);
    }
    const Vector3 axis = (1 / dot(gradient, gradient)) * gradient;
    const auto [body, other] =
        of_second ? std::pair(joint.second, joint.first) : std::pair(joint.first, joint.second);
    double sum = 0;
    for (const int b : hanging_on(model, body, joint, other)) {
        const Matrix34& place_of = X[static_cast<std::size_t>(b)];
        const Matrix34 V = is_angle ? rate(place_of, cross(axis, place_of.column(0) - place), axis)
                                    : rate(place_of, axis, {});
        sum += dot(V * model.bodies()[static_cast<std::size_t>(b)].mass, V);
    }
    return sum;
}

/// Of both sides, which part from each other.
double inertia_of(const Model& model, const Joint& joint, const NamedCoordinate& coordinate)
{
    const double second = inertia_along(model, joint, coordinate, true);
    if (joint.first == world) return second;
    const double first = inertia_along(model, joint, coordinate, false);
    return first + second > 0 ? first * second / (first + second) : 0;
}

}   // namespace

JointLimits read_limits(const Builder& builder, const Section& keys, const Joint& joint,
                        const NamedCoordinate& coordinate, const std::string& path)
{
    const std::vector<double>& given = keys.find("limits")->numbers;
    JointLimits limits{given[0], given[1], keys.number("limit_stiffness"), keys.number("limit_damping")};
    const double gravity = norm(builder.model().gravity()), length = builder.model().length();
    const double time = gravity > 0 ? std::sqrt(length / gravity) : time_without_gravity;
    if (!keys.has("limit_damping")) limits.damping = coordinate.coordinate.is_angle() ? time : time / length;
    if (keys.has("limit_stiffness")) return limits;
    const double frequency = std::numbers::pi / (share_of_contact * time);   // of half a period's contact
    limits.stiffness = inertia_of(builder.model(), joint, coordinate) * frequency * frequency;
    if (!(limits.stiffness > 0))
        throw InputError({"joint-limits", path + ".limits",
                          "nothing that joint '" + joint.name +
                              "' moves has inertia, so that its limits have no "
                              "stiffness by default",
                          "", "", "", "give 'limit_stiffness'"});
    return limits;
}

}   // namespace livens::inline io_internal
