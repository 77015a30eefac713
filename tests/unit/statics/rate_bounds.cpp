// SPDX-License-Identifier: BSD-3-Clause
// Bounds of what loads make of the motions of bodies, against the rates themselves.
#include "livens/statics/rate_bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "livens/multibody/joints.h"
#include "livens/statics/frequencies.h"

namespace livens::rate_bounds_test {
namespace {

TEST(RateBounds, OfOneMassAreItsRates)
{
    Model model;
    model.add_body(point_mass("mass", 2, {1, 0, 0}));
    model.add_load(spring_damper("spring", world, {0, 0, 0}, 0, {}, {5000, 30, 1}));
    RateBounds bounds(model);
    EXPECT_NEAR(bounds.springs(model.start()), 50, 1e-12);
    EXPECT_NEAR(bounds.dampers(model.start()), 15, 1e-12);
}

/// Bricks on hinges, each with a spring and a damper, and a spring from the first to the last.
Model any_chain(std::minstd_rand& random)
{
    std::uniform_real_distribution<double> any(-1, 1);
    Model model({0, 0, -9.81});
    const int n = 2 + static_cast<int>(2 * (1 + any(random)));
    for (int b = 0; b < n; ++b) {
        const std::string number = std::to_string(b);
        Placement placed;
        placed.position = {b + 0.5, 0, 0};
        placed.angular_velocity = {0, any(random), 0};
        model.add_body(rigid_body("b" + number, box(1.5 + any(random), {0.9, 0.1, 0.2}), placed));
        const JointFrame frame{{b == 0 ? 0 : 0.5, 0, 0}, {-0.5, 0, 0}, {0, 1, 0}, {0, 1, 0}};
        const Joint hinge = revolute("h" + number, b == 0 ? world : b - 1, b, frame);
        model.add_joint(hinge);
        model.add_load(joint_spring("s" + number, hinge.coordinates[0],
                                    {300 * (1.1 + any(random)), 2 + any(random)}, model.start().X));
    }
    const auto point = [&] { return Vector3{0.4 * any(random), 0.1, 0.1 * any(random)}; };
    model.add_load(spring_damper("across", 0, point(), n - 1, point(), {4000, 20, 0.3}));
    return model;
}

TEST(RateBounds, AreAboveWhatJointsLeaveOfRandomChains)
{
    std::minstd_rand random(5);
    double nearest = 1e9;
    for (int k = 0; k < 100; ++k) {
        const Model model = any_chain(random);
        const State state = model.start();
        const HighestFrequencies found = highest_frequencies(model, state);
        RateBounds bounds(model);
        EXPECT_GE(bounds.springs(state), found.springs.rate) << k;
        EXPECT_GE(bounds.dampers(state), found.dampers.rate) << k;
        ASSERT_GT(found.springs.rate, 0) << k;
        nearest = std::min(nearest, bounds.springs(state) / found.springs.rate);
    }
    EXPECT_LT(nearest, 10) << "a bound that says nothing";
}

}   // namespace
}   // namespace livens::rate_bounds_test
