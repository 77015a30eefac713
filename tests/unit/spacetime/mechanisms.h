// SPDX-License-Identifier: BSD-3-Clause
// Mechanisms that several tests solve.
#pragma once

#include "livens/multibody/model.h"

namespace livens::testing_models {

/// P16: two bricks on ball joints, released at rest.
inline Model two_bricks()
{
    Model model({0, 0, -9.81});
    const MassProperties brick = with_center(with_mass(box(1, {1, 0.2, 0.1}), 1.0), {0.5, 0, 0});
    Placement second;
    second.position = {1, 0, 0};
    second.directors = Matrix3{0, 1, 0, -1, 0, 0, 0, 0, 1};
    model.add_body(rigid_body("one", brick));
    model.add_body(rigid_body("two", brick, second));
    JointFrame hinge;
    model.add_joint(spherical("root", world, 0, hinge));
    hinge.point_first = {1, 0, 0};
    model.add_joint(spherical("elbow", 0, 1, hinge));
    return model;
}

/// Every term of the tangent at once: ball joints, a rod between bodies, spring and damper, loads in both
/// frames.
inline Model everything()
{
    Model model = two_bricks();
    Placement third;
    third.position = {1, 1, 0.5};
    model.add_body(rigid_body("three", with_mass(box(1, {0.5, 0.2, 0.3}), 2.0), third));
    model.add_body(point_mass("four", 0.4, {0.3, 1.2, 0.9}));
    JointFrame ends;
    ends.point_first = {0.9, 0.1, 0};
    const Vector3 a = model.bodies()[1].X * point(ends.point_first);
    model.add_joint(rod("link", 1, 2, ends, norm(model.bodies()[2].X.column(0) - a)));
    JointFrame string;
    model.add_joint(
        rod("string", 2, 3, string, norm(model.bodies()[3].X.column(0) - model.bodies()[2].X.column(0))));
    model.add_load(spring_damper("spring", 0, {0.5, 0.1, 0}, 2, {0.2, 0, 0}, {100, 5, 0.3}));
    model.add_load(spring_damper("tether", world, {0, 1, 1}, 3, {0, 0, 0}, {30, 2, 0.1}));
    model.add_load(torque("twist in the body", 1, {1.0, 2.0, 3.0}, Frame::body_fixed));
    model.add_load(torque("twist in space", 0, {1.0, 2.0, 3.0}, Frame::inertial));
    model.add_load(point_force("thrust", 0, {0.3, 0.2, 0.1}, {1.0, 2.0, 3.0}, Frame::body_fixed));
    return model;
}

}   // namespace livens::testing_models
