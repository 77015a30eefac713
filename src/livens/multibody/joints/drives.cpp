// SPDX-License-Identifier: BSD-3-Clause
// Joints that follow functions of time: coordinates, distances, points and whole bodies. theory.md, "Drives",
// has the rows, their derivatives and why the row of an angle is regular at every angle.
#include "livens/multibody/joints/drives.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/base/error.h"
#include "livens/multibody/joints/joint_frame.h"
#include "livens/multibody/wording.h"
#include "livens/time/time_laws.h"

namespace livens {

namespace {

/// A number while the angle is within a quarter turn, where nothing but its sine is held.
TimeFunction sine_of(const TimeFunction& angle)
{
    const auto sine = [angle](Instant at) {
        const TimeValue f = angle(at);
        if (!(std::abs(f.value) < 0.5 * std::numbers::pi))
            return TimeValue{std::numeric_limits<double>::quiet_NaN(), 0, 0};
        const auto [s, c] = sine_cosine(f.value);
        return TimeValue{s, c * f.first, c * f.second - s * f.first * f.first};
    };
    return {sine, angle.breaks()};
}

}   // namespace

namespace {

QuadraticForm less_one()
{
    QuadraticForm one;
    one.c = -1;
    return one;
}

/// r_k(q) - law = 0, up to 175 degrees; the law counts from where the bodies stand.
ConstraintRow driven_rotation(const std::string& name, const Joint& joint, const NamedCoordinate& component,
                              const TimeFunction& law)
{
    ConstraintRow row = coupling_row({{1, component.coordinate}}, 0, 1, "driven " + component.name);
    row.drives = {{law, less_one()}};
    row.edges.front().what = "drive '" + name + "' and what else turns '" + joint.name +
                             "' bring its rotation vector to 175 degrees, where it ends,";
    return row;
}

}   // namespace

/// An angle q = atan2(s, c) follows f by cos(f) s - sin(f) c = 0, which also admits half a turn more; one
/// that is an arc sine by its sine.
Joint driven_coordinate(const std::string& name, const Joint& joint, const NamedCoordinate& coordinate,
                        const TimeFunction& law, const Configurations& X)
{
    const std::vector<PairForm>& forms = coordinate.coordinate.forms;
    Joint driven;
    driven.name = name;
    driven.type = "drive";
    driven.first = joint.first;
    driven.second = joint.second;
    driven.point_first = joint.point_first;
    driven.point_second = joint.point_second;
    ConstraintRow row;
    row.body_i = forms[0].body_i;
    row.body_j = forms[0].body_j;
    row.label = "driven " + coordinate.name;
    const double now = coordinate_value(coordinate.coordinate, X);
    if (coordinate.coordinate.kind == CoordinateKind::arc_sine) {
        static_cast<PairForm&>(row) = forms[0];
        row.drives.push_back({sine_of(shifted(law, now - coordinate.at_stated)), less_one()});
        driven.rows = {row};
        return driven;
    }
    if (coordinate.coordinate.kind == CoordinateKind::rotation_component) {
        driven.rows = {driven_rotation(name, joint, coordinate, shifted(law, now - coordinate.at_stated))};
        return driven;
    }
    if (!coordinate.coordinate.is_angle()) {
        // The law counts from the stated value of the coordinate; its form counts from where the bodies
        // stand.
        const TimeFunction raw = shifted(law, now - coordinate.at_stated);
        static_cast<PairForm&>(row) = forms[0];
        row.drives.push_back({raw, less_one()});
        driven.rows = {row};
        return driven;
    }
    const TimeFunction angle = shifted(law, now - coordinate.at_stated);
    const auto sine = [=](Instant at) {
        const TimeValue f = angle(at);
        const auto [s, c] = sine_cosine(f.value);
        return TimeValue{s, c * f.first, c * f.second - s * f.first * f.first};
    };
    const auto cosine = [=](Instant at) {
        const TimeValue f = angle(at);
        const auto [s, c] = sine_cosine(f.value);
        return TimeValue{c, -s * f.first, -s * f.second - c * f.first * f.first};
    };
    const auto negative = [=](Instant at) {
        const TimeValue f = sine(at);
        return TimeValue{-f.value, -f.first, -f.second};
    };
    ConstraintRow branch = row;
    row.drives = {{{cosine, law.breaks()}, forms[1]}, {{negative, law.breaks()}, forms[0]}};
    branch.drives = {{{cosine, law.breaks()}, forms[0]}, {{sine, law.breaks()}, forms[1]}};
    driven.rows = {row};
    // The row is zero half a turn on as well. The branch, cos of the difference, must be positive: it tells
    // them apart.
    driven.branches = {branch};
    return driven;
}

Joint driven_distance(const std::string& name, int first, const Vector3& point_first, int second,
                      const Vector3& point_second, const TimeFunction& length, const Configurations& X)
{
    JointFrame frame{point_first, point_second};
    const double now = norm(X[second] * point(point_second) - X[first] * point(point_first));
    Joint joint = start_joint(name, "drive", first, second, frame, 1);
    if (!(now > 0))
        throw InputError({"drive-distance", "drive[" + name + "]", "the points of a driven distance coincide",
                          to_text(now), "> 0", "they have no direction to be held along",
                          "drive a point, or a joint's displacement"});
    const auto positive = [length](Instant at) {   // a row of squares would take the other sign as well
        const TimeValue l = length(at);
        return l.value > 0 ? l : TimeValue{std::numeric_limits<double>::quiet_NaN(), 0, 0};
    };
    joint.rows = {driven_distance_row(joint.first, point(joint.point_first), joint.second,
                                      point(joint.point_second), {positive, length.breaks()}, now)};
    return joint;
}

Joint driven_point(const std::string& name, int body, const Vector3& at,
                   const std::array<TimeFunction, 3>& path, const Configurations& X, double scale)
{
    const Vector3 now = X[body] * point(at);
    JointFrame frame{now, at};
    Joint joint = start_joint(name, "drive", world, body, frame, scale);
    joint.rows = driven_point_rows(world, point(now), body, point(at), path, scale);
    return joint;
}

Joint driven_body(const std::string& name, int body, const Vector3& at,
                  const std::array<TimeFunction, 3>& path, const Configurations& X, double scale)
{
    Joint joint = driven_point(name, body, at, path, X, scale);
    const Joint held = weld(name, world, body, {joint.point_first, at}, world_configuration, X[body], scale);
    // The first three rows of a weld hold its point, which the path holds already.
    joint.rows.insert(joint.rows.end(), held.rows.begin() + 3, held.rows.end());
    joint.branches = held.branches;
    return joint;
}

}   // namespace livens
