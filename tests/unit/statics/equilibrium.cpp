// SPDX-License-Identifier: BSD-3-Clause
// Where mechanisms rest, and what is told of those that do not.
#include "livens/statics/equilibrium.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "livens/base/error.h"
#include "livens/multibody/joints/drives.h"
#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"
#include "livens/time/time_laws.h"

namespace livens::equilibrium_test {
namespace {

constexpr double pi = std::numbers::pi;

/// A rod of 1 m hinged at its end, `angle` from hanging.
Model pendulum(double angle)
{
    const Matrix3 turned = directors_from_rotation_vector({0, angle, 0});
    Model model({0, 0, -9.81});
    const MassProperties rod = with_center(box(800, {0.1, 0.1, 1}), {0, 0, -0.5});
    const int body = model.add_body(rigid_body("rod", rod, {{}, turned}));
    model.add_joint(revolute("pivot", world, body,
                             joint_frame(world_configuration, model.bodies()[body].X, {}, {0, 1, 0})));
    return model;
}

Equilibrium of(const Model& model) { return find_equilibrium(model, model.start()); }

TEST(Equilibrium, OfAPendulumIsTheHangingOneFromAnywhere)
{
    for (const double angle : {0.0, 0.3, 0.5 * pi, 2.0, pi - 1e-6, -pi + 1e-3}) {
        const Equilibrium e = of(pendulum(angle));
        ASSERT_TRUE(e.is_found) << e.message;
        EXPECT_NEAR((e.state.X[0] * point({0, 0, -1}))[2], -1, 1e-15) << angle;
        EXPECT_NEAR((e.state.X[0] * point({0, 0, -1}))[0], 0, 1e-12) << angle;
        EXPECT_EQ(e.stability.stability, Stability::stable) << angle;
        EXPECT_LT(e.residual, 1e-14) << angle;
        EXPECT_LT(e.iterations, 20) << angle;
    }
}

TEST(Equilibrium, UprightIsToldUnstable)
{
    const Equilibrium e = of(pendulum(pi));
    ASSERT_TRUE(e.is_found) << e.message;
    EXPECT_NEAR((e.state.X[0] * point({0, 0, -1}))[2], 1, 1e-15);
    EXPECT_EQ(e.stability.stability, Stability::unstable);
    EXPECT_EQ(e.stability.n_unstable, 1);
    EXPECT_EQ(e.stability.n_neutral, 0);
}

TEST(Equilibrium, BearsTheWeightByItsReactions)
{
    const Model model = pendulum(1);
    const Equilibrium e = of(model);
    const Reaction reaction = joint_reaction(model, 0, e.state.X, e.multipliers);
    EXPECT_NEAR(reaction.force[2], 8 * 9.81, 1e-12);
    EXPECT_NEAR(norm(reaction.torque), 0, 1e-12);
}

TEST(Equilibrium, OfAFreeFallIsNotThereAndNamesTheBody)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("held", 1, {1, 0, 0}));
    model.add_body(point_mass("stone", 1, {5, 0, 0}));
    model.add_joint(rod("rod", world, 0, {}, 1));
    const Equilibrium e = of(model);
    EXPECT_FALSE(e.is_found);
    EXPECT_EQ(e.worst_body, 1);
    EXPECT_NEAR(e.acceleration, 9.81, 1e-12);
    EXPECT_EQ(e.message,
              "body 'stone' still accelerates by 9.81 m/s^2, and nothing restores it: hold it by a "
              "joint or a spring");
    EXPECT_LT(e.iterations, 60);
}

TEST(Equilibrium, OfAWheelUnderAConstantTorqueIsNotThere)
{
    Model model;
    const int wheel = model.add_body(rigid_body("wheel", {2, {}, 3.0 * identity<3>()}));
    model.add_joint(revolute("axle", world, wheel, {}));
    model.add_load(torque("motor", wheel, {0, 0, 6}, Frame::inertial));
    const Equilibrium e = of(model);
    EXPECT_FALSE(e.is_found);
    EXPECT_NEAR(e.angular_acceleration, 2, 1e-12);
    EXPECT_NE(e.message.find("body 'wheel' still accelerates by 2 rad/s^2"), std::string::npos) << e.message;
}

TEST(Equilibrium, OfABalancedWheelIsNeutral)
{
    Model model({0, 0, -9.81});
    const int wheel = model.add_body(rigid_body("wheel", {2, {}, 3.0 * identity<3>()}));
    model.add_joint(
        revolute("axle", world, wheel, joint_frame(world_configuration, world_configuration, {}, {0, 1, 0})));
    const Equilibrium e = of(model);
    ASSERT_TRUE(e.is_found);
    EXPECT_EQ(e.iterations, 0);
    EXPECT_EQ(e.stability.stability, Stability::neutral);
    EXPECT_EQ(e.stability.n_neutral, 1);
    EXPECT_EQ(e.stability.n_unstable, 0);
}

TEST(Equilibrium, OfAMassOnASpringFromTheSide)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bob", 2, {1.5, 0.2, 0.3}));
    model.add_load(spring_damper("spring", world, {0, 0, 0}, 0, {}, {400, 0, 1}));
    const Equilibrium e = of(model);
    ASSERT_TRUE(e.is_found) << e.message;
    EXPECT_NEAR(e.state.X[0][2], -1 - 2 * 9.81 / 400, 1e-14);
    EXPECT_NEAR(e.state.X[0][0], 0, 1e-13);
    EXPECT_EQ(e.stability.stability, Stability::stable);
}

/// Springs at their free length: no force anywhere, and rounding is none either.
TEST(Equilibrium, WithoutAnyForceIsWhereTheStartIs)
{
    Model model;
    model.add_body(point_mass("bob", 2, {0.3, 0.4, 0}));
    for (const Vector3& at : {Vector3{1, 0, 0}, {0, 2, 0}, {-1, -1, 3}}) {
        const double length = norm(at - Vector3{0.3, 0.4, 0});
        model.add_load(
            spring_damper("s" + std::to_string(model.loads().size()), world, at, 0, {}, {1e6, 0, length}));
    }
    const Equilibrium e = of(model);
    ASSERT_TRUE(e.is_found) << e.message << e.residual;
    EXPECT_NEAR(norm(e.state.X[0].column(0) - Vector3{0.3, 0.4, 0}), 0, 1e-15);
    EXPECT_EQ(e.stability.stability, Stability::stable);
}

TEST(Equilibrium, OfWhatIsHeldIsTheStart)
{
    Model model({0, 0, -9.81});
    const int body = model.add_body(rigid_body("block", box(1, {1, 1, 1})));
    model.add_joint(weld("base", world, body, {}, world_configuration, model.bodies()[body].X));
    const Equilibrium e = of(model);
    ASSERT_TRUE(e.is_found);
    EXPECT_EQ(e.degrees_of_freedom, 0);
    EXPECT_EQ(e.iterations, 0);
    EXPECT_EQ(e.stability.stability, Stability::stable);
    EXPECT_NEAR(joint_reaction(model, 0, e.state.X, e.multipliers).force[2], 9.81, 1e-14);
}

TEST(Equilibrium, OfNothingIsThere) { EXPECT_TRUE(of(Model()).is_found); }

/// Two hinges share the weight of a door: reactions of least size.
TEST(Equilibrium, WithRedundantJointsHasTheLeastReactions)
{
    Model model({0, 0, -10});
    const int door = model.add_body(rigid_body("door", with_mass(box(1, {1, 0.1, 2}), 20), {{0.5, 0, 0}}));
    const Matrix34 X = model.bodies()[door].X;
    for (const double z : {-0.8, 0.8})
        model.add_joint(revolute(z < 0 ? "lower" : "upper", world, door,
                                 joint_frame(world_configuration, X, {0, 0, z}, {0, 0, 1})));
    const Equilibrium e = of(model);
    ASSERT_TRUE(e.is_found) << e.message;
    EXPECT_EQ(e.stability.n_neutral, 1);   // a door stands wherever it is
    Vector3 sum{};
    for (const int j : {0, 1}) {
        EXPECT_FALSE(e.joint_is_unique[j]);
        sum += joint_reaction(model, j, e.state.X, e.multipliers).force;
    }
    EXPECT_NEAR(sum[2], 200, 1e-10);
}

/// A crank that is driven is held where it is at the start, and what hangs on it hangs.
TEST(Equilibrium, HoldsDrivesAtTheirValues)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bob", 1, {1.5, 0, 0}));
    const auto path = [] {
        return std::array<TimeFunction, 3>{ramp(0, 1, 0), TimeFunction(0), TimeFunction(0)};
    };
    model.add_body(point_mass("hand", 1, {0.5, 0, 0}));
    model.add_joint(rod("string", 1, 0, {}, 1));
    model.add_joint(driven_point("hand", 1, {}, path(), model.start().X));
    const Equilibrium e = of(model);
    ASSERT_TRUE(e.is_found) << e.message;
    EXPECT_NEAR(e.state.X[0][0], 0.5, 1e-12);
    EXPECT_NEAR(e.state.X[0][2], -1, 1e-14);
    EXPECT_THROW(linearise(model, model.start()), InputError);   // the hand moves
}

TEST(Equilibrium, NamesALoadThatIsNoNumber)
{
    Model model;
    model.add_body(point_mass("bob", 1, {1, 0, 0}));
    Load bad;
    bad.name = "bad";
    bad.type = "force";
    bad.bodies = {0, world};
    bad.forces = [](const LoadArguments&, LoadForces& F) { F[0].a[0] = std::nan(""); };
    model.add_load(bad);
    const Equilibrium e = of(model);
    EXPECT_FALSE(e.is_found);
    EXPECT_NE(e.message.find("'bad'"), std::string::npos) << e.message;
}

TEST(Equilibrium, CanBeCancelled)
{
    const Model model = pendulum(1);
    EquilibriumOptions options;
    options.goes_on = [] { return false; };
    const Equilibrium e = find_equilibrium(model, model.start(), options);
    EXPECT_FALSE(e.is_found);
    EXPECT_EQ(e.message, "cancelled");
}

/// n links of mass w / g, each l long, held at one end and pulled by H at the other: tan of the slope of a
/// link grows by w / H from link to link, and half of that at the free end.
void expect_catenary(int n, double H)
{
    const double l = 1.0 / n, w = 3;
    Model model({0, 0, -w / 1.0});
    for (int i = 0; i < n; ++i) {
        const MassProperties link = with_center(with_mass(box(1, {l, 0.1 * l, 0.1 * l}), 1), {0.5 * l, 0, 0});
        model.add_body(rigid_body("link " + std::to_string(i), link, {{l * i, 0, 0}}));
        const Matrix34 before = i == 0 ? world_configuration : model.bodies()[i - 1].X;
        model.add_joint(revolute("hinge " + std::to_string(i), i - 1, i,
                                 joint_frame(before, model.bodies()[i].X, {l * i, 0, 0}, {0, 1, 0})));
    }
    model.add_load(point_force("pull", n - 1, {l, 0, 0}, {H, 0, 0}, Frame::inertial));
    const Equilibrium e = of(model);
    ASSERT_TRUE(e.is_found) << e.message;
    Vector3 at{};
    double worst = 0;
    for (int i = 0; i < n; ++i) {
        worst = std::max(worst, norm(e.state.X[i].column(0) - at));
        const double slope = std::atan(w * (n - i - 0.5) / H);
        at += Vector3{l * std::cos(slope), 0, -l * std::sin(slope)};
    }
    EXPECT_LT(worst, 1e-12) << n;
    EXPECT_EQ(e.stability.stability, Stability::stable);
}

TEST(Equilibrium, OfAHorizontalChainThatIsPulledIsTheCatenaryOfItsLinks)
{
    expect_catenary(50, 20);
    expect_catenary(50, 2);
    expect_catenary(1, 2);
}

/// A parallelogram that hangs stretched out: two motions meet there, and no linearisation tells them apart.
TEST(Equilibrium, InASingularPositionIsRefused)
{
    Model model({0, 0, -9.81});
    const auto link = [&](const char* name, double mass, double inertia, const Vector3& at) {
        Placement place;
        place.position = at;
        return model.add_body(
            rigid_body(name, {mass, {}, {1e-3, 0, 0, 0, inertia, 0, 0, 0, inertia}}, place));
    };
    const int l = link("l", 1, 1.0 / 12, {0.5, 0, 0}), r = link("r", 1, 1.0 / 12, {0.5, 0, -0.5});
    const int c = link("c", 2, 1.0 / 24, {1, 0, -0.25});
    const auto hinge = [&](const char* name, int first, int second, const Vector3& at) {
        const Matrix34& X_first = first == world ? world_configuration : model.bodies()[first].X;
        model.add_joint(
            revolute(name, first, second, joint_frame(X_first, model.bodies()[second].X, at, {0, 1, 0})));
    };
    hinge("a", world, l, {0, 0, 0});
    hinge("b", world, r, {0, 0, -0.5});
    hinge("lc", l, c, {1, 0, 0});
    hinge("rc", r, c, {1, 0, -0.5});
    try {
        find_equilibrium(model, model.start());
        ADD_FAILURE() << "it was not refused";
    } catch (const InputError& error) {
        EXPECT_EQ(error.complaint().code, "start-singular");
    }
}

}   // namespace
}   // namespace livens::equilibrium_test
