// SPDX-License-Identifier: BSD-3-Clause
// A chain of parallelograms, which loses rank where all its links lie on one line (IFToMM's benchmark A02).
#pragma once

#include <cmath>
#include <string>

#include "livens/multibody/joints.h"
#include "livens/multibody/model.h"

namespace livens::tests {

/// n + 1 links of 1 m and 1 kg that turn about (i, 0, 0), clockwise by `angle` from the upright at `rate`,
/// and n bars of 1 kg that join their tips. The first link may be heavier: then the bars bear force.
struct Parallelograms {
    int n = 1;
    double angle = 0, rate = 1, gravity = 9.81, first_mass = 1;

    /// I angle'' = G sin(angle) on the branch on which all links stay parallel.
    double inertia() const { return (n + first_mass) / 3 + n; }
    double moment() const { return gravity * ((n + first_mass) / 2 + n); }
    Model model() const
    {
        const auto uniform = [](double mass) {
            const double J = mass / 12;
            return MassProperties{mass, {0.5, 0, 0}, {J / 1000, 0, 0, 0, J, 0, 0, 0, J}};
        };
        const Vector3 along{std::sin(angle), std::cos(angle), 0}, across{-along[1], along[0], 0};
        Matrix3 turned = identity<3>();
        turned.set_column(0, along);
        turned.set_column(1, across);
        Model model({0, -gravity, 0});
        for (int i = 0; i <= n; ++i)
            model.add_body(rigid_body("link" + std::to_string(i), uniform(i == 0 ? first_mass : 1),
                                      {{1.0 * i, 0, 0}, turned, {}, {0, 0, -rate}}));
        for (int i = 0; i < n; ++i)
            model.add_body(rigid_body("bar" + std::to_string(i), uniform(1),
                                      {along + Vector3{1.0 * i, 0, 0}, identity<3>(), -rate * across, {}}));
        const auto join = [&](const std::string& name, int first, int second, double at, double there) {
            JointFrame frame;
            frame.point_first = {at, 0, 0};
            frame.point_second = {there, 0, 0};
            model.add_joint(revolute(name + std::to_string(second), first, second, frame));
        };
        for (int i = 0; i <= n; ++i) join("pivot", world, i, i, 0);
        for (int i = 0; i < n; ++i) join("left", i, n + 1 + i, 1, 0);
        for (int i = 0; i < n; ++i) join("right", i + 1, n + 1 + i, 1, 1);
        return model;
    }
};

}   // namespace livens::tests
