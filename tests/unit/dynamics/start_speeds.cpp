// SPDX-License-Identifier: BSD-3-Clause
// Velocities that are zero but for rounding break no joint, whatever moves the mechanism.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "livens/base/error.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/joints/drives.h"
#include "livens/multibody/loads/load_laws.h"
#include "livens/multibody/model.h"
#include "livens/time/time_laws.h"

namespace livens::start_speeds_test {
namespace {

/// A ball on a ball joint at its centre that moves away with this speed.
Model ball(double speed)
{
    Model model;
    model.add_body(rigid_body("ball", {1, {}, {0.004, 0, 0, 0, 0.004, 0, 0, 0, 0.004}},
                              {{}, identity<3>(), {0, 0, speed}, {}}));
    model.add_joint(spherical("pivot", world, 0, {}));
    return model;
}

bool is_taken(const Model& model)
{
    try {
        const ConsistentStart closed = consistent_start(model, model.start(), StartPolicy::check);
        EXPECT_LT(norm(closed.start.V[0].column(0)), model.has_drives() ? 1e-12 : 1e-30) << "taken off";
        EXPECT_TRUE(closed.notes.empty());
        return true;
    } catch (const InputError& error) {
        EXPECT_EQ(error.complaint().code, "start-velocity");
        return false;
    }
}

TEST(StartSpeeds, OfRoundingAreRest)
{
    EXPECT_TRUE(is_taken(ball(1e-17)));
    EXPECT_FALSE(is_taken(ball(1e-13))) << "nothing here is so fast that this could be its rounding";
    for (const bool is_at_a_point : {true, false}) {
        Model model = ball(1e-13);
        if (is_at_a_point)
            model.add_load(point_force("push", 0, {0, 0.1, 0}, {0.0, 0.0, 3.0}, Frame::inertial));
        else
            model.add_load(torque("twist", 0, {3.0, 0.0, 0.0}, Frame::inertial));
        EXPECT_TRUE(is_taken(model)) << is_at_a_point;
    }
    Model model = ball(1e-9);
    model.add_load(torque("twist", 0, {3.0, 0.0, 0.0}, Frame::inertial));
    EXPECT_FALSE(is_taken(model));
}

/// A drive that begins at its turning point, whose rate there is the cosine of a rounded quarter of a turn.
TEST(StartSpeeds, OfDrivesMayBeRounding)
{
    const auto driven = [](double phase) {
        Model model;
        model.add_body(rigid_body("cart", {1, {}, {1, 0, 0, 0, 1, 0, 0, 0, 1}}));
        JointFrame frame;
        frame.axis_first = frame.axis_second = {1, 0, 0};
        frame.across_first = frame.across_second = {0, 1, 0};
        const std::vector<Matrix34> X{model.bodies()[0].X};
        Joint rail = prismatic("rail", world, 0, frame, world_configuration, X[0]);
        const TimeFunction wave = harmonic(3, 500, phase);
        rail.coordinates[0].at_stated = wave({0}).value;
        const Joint motor = driven_coordinate("motor", rail, rail.coordinates[0], wave, X);
        model.add_joint(rail);
        model.add_joint(motor);
        return model;
    };
    EXPECT_NE(harmonic(3, 500, std::numbers::pi / 2)({0}).first, 0);
    EXPECT_TRUE(is_taken(driven(std::numbers::pi / 2)));
    EXPECT_FALSE(is_taken(driven(std::numbers::pi / 2 + 1e-8)));
}

}   // namespace
}   // namespace livens::start_speeds_test
