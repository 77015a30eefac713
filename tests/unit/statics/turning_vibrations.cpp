// SPDX-License-Identifier: BSD-3-Clause
// How fast the forms of stiff vibrations turn, against closed forms.
#include "livens/statics/turning_vibrations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace livens::turning_vibrations_test {
namespace {

constexpr double spin = 3;

/// 1 and 3 kg on a spring along x that is stretched by `stretch`, turning about z, and drawn apart.
Model dumbbell(double drawing, double stretch)
{
    Model model;
    model.add_body(point_mass("light", 1, {-0.75, 0, 0}, {-drawing, -0.75 * spin, 0}));
    model.add_body(point_mass("heavy", 3, {0.25, 0, 0}, {drawing, 0.25 * spin, 0}));
    model.add_load(spring_damper("spring", 0, {}, 1, {}, {3e6, 0, 1 - stretch}));
    return model;
}

TEST(TurningVibrations, OfTwoMassesTurnAsTheyDo)
{
    const Model model = dumbbell(0, 0);
    const auto found = turning_vibrations(model, model.start(), 10);
    ASSERT_EQ(found.size(), 1);
    EXPECT_NEAR(found[0].spring.rate, 2000, 1e-9);   // k (1 / 1 + 1 / 3) = 4e6
    EXPECT_EQ(found[0].spring.where(model), "body 'light', load 'spring'");
    EXPECT_NEAR(found[0].turn, spin, 1e-5 * spin);
}

/// A stretched spring holds across as well. What vibrates along it changes that, and turns nothing.
TEST(TurningVibrations, LeaveOutVelocitiesThatVibrate)
{
    const Model model = dumbbell(20, 0.01);
    const auto found = turning_vibrations(model, model.start(), 500);   // across it is 200 rad/s
    ASSERT_EQ(found.size(), 1);
    EXPECT_NEAR(found[0].turn, spin, 1e-5 * spin);
    const auto all = turning_vibrations(model, model.start(), 10);   // nothing is slower
    for (const TurningVibration& one : all) EXPECT_LT(one.turn, 1e-5 * spin) << one.spring.rate;
}

/// A form that turns into a stiffer one is carried there by the stiffer one, which turns as well.
TEST(TurningVibrations, CountsSofterFormsAlone)
{
    Model model = dumbbell(0, 0);
    model.add_body(point_mass("far", 1, {-0.75, 1, 0}, {spin, -0.75 * spin, 0}));
    model.add_load(spring_damper("side", 0, {}, 2, {}, {3e4, 0, 1}));
    const auto found = turning_vibrations(model, model.start(), 10);
    ASSERT_EQ(found.size(), 2);
    for (const TurningVibration& one : found) EXPECT_LT(one.turn, 1.1 * spin) << one.spring.rate;
}

/// Held alike in all directions across the axis a vibration has no direction to leave.
TEST(TurningVibrations, StayAmongFormsThatAreAsStiff)
{
    Model model;
    Placement turning;
    turning.angular_velocity = {0, 0, spin};
    model.add_body(rigid_body("disc", {2, {}, {1, 0, 0, 0, 1, 0, 0, 0, 1.5}}, turning));
    model.add_body(point_mass("mass", 1, {0, 0, 0}));
    for (int side = 0; side < 4; ++side) {
        const double x = std::cos(side * std::acos(0.0)), y = std::sin(side * std::acos(0.0));
        model.add_load(spring_damper("spoke" + std::to_string(side), 0, {x, y, 0}, 1, {}, {1e6, 0, 1}));
    }
    const auto found = turning_vibrations(model, model.start(), 10);
    ASSERT_GE(found.size(), 2);
    for (const TurningVibration& one : found) EXPECT_LT(one.turn, 1e-3 * spin) << one.spring.rate;
}

TEST(TurningVibrations, DoNotTurnAtRestOrAboutTheirSpring)
{
    Model model;
    model.add_body(point_mass("mass", 1, {1, 0, 0}));
    model.add_load(spring_damper("spring", world, {}, 0, {}, {1e6, 0, 1}));
    EXPECT_TRUE(turning_vibrations(model, model.start(), 10).empty());   // nothing moves
    State start = model.start();
    start.V[0](0, 0) = 1;
    EXPECT_TRUE(turning_vibrations(model, start, 10).empty());   // nothing but the vibration
}

}   // namespace
}   // namespace livens::turning_vibrations_test
