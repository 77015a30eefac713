// SPDX-License-Identifier: BSD-3-Clause
// Highest frequencies against closed forms.
#include "livens/statics/frequencies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace livens::frequencies_test {
namespace {

HighestFrequencies of(const Model& model) { return highest_frequencies(model, model.start()); }

TEST(Frequencies, OfAMassOnASpringWithADamper)
{
    Model model;
    model.add_body(point_mass("slow", 8, {0, 0, 1}));
    model.add_body(point_mass("fast", 2, {1, 0, 0}));
    model.add_load(spring_damper("soft", world, {0, 0, 0}, 0, {}, {50, 0.1, 1}));
    model.add_load(spring_damper("stiff", world, {0, 0, 0}, 1, {}, {5000, 30, 1}));
    const HighestFrequencies f = of(model);
    EXPECT_NEAR(f.springs.rate, 50, 1e-12);   // sqrt(5000 / 2)
    EXPECT_EQ(f.springs.body, 1);
    EXPECT_EQ(f.springs.where(model), "body 'fast', load 'stiff'");
    EXPECT_NEAR(f.dampers.rate, 15, 1e-12);   // 30 / 2
    EXPECT_EQ(f.dampers.where(model), "body 'fast', load 'stiff'");
    EXPECT_EQ(f.constraints.rate, 0);
    EXPECT_EQ(f.constraints.where(model), "");
}

/// Two masses on one spring vibrate against each other; neither frequency alone is right.
TEST(Frequencies, OfTwoMassesOnOneSpring)
{
    Model model;
    model.add_body(point_mass("light", 1, {0, 0, 0}));
    model.add_body(point_mass("heavy", 3, {1, 0, 0}));
    model.add_load(spring_damper("spring", 0, {}, 1, {}, {300, 0, 1}));
    const HighestFrequencies f = of(model);
    EXPECT_NEAR(f.springs.rate, 20, 1e-12);   // k (1 / 1 + 1 / 3) = 400
    EXPECT_EQ(f.springs.where(model), "body 'light', load 'spring'");
}

/// A brick turning about its hinge on a spring at the arm a: omega^2 = k a^2 / J, whatever holds the rest.
TEST(Frequencies, AreThoseOfTheMotionsThatJointsLeaveFree)
{
    Model model;
    const int body = model.add_body(rigid_body("brick", box(3, {1, 0.2, 0.4}), {{0.5, 0, 0}}));
    const Matrix34 X = model.bodies()[body].X;
    model.add_joint(
        revolute("hinge", world, body, joint_frame(world_configuration, X, {0, 0, 0}, {0, 1, 0})));
    model.add_load(spring_damper("spring", world, {1, 0, 2}, body, {0.5, 0, 0}, {7, 0, 2}));
    const double mass = 3 * 1 * 0.2 * 0.4, J = mass * (1 + 0.16) / 12 + mass * 0.25;
    EXPECT_NEAR(of(model).springs.rate, std::sqrt(7 / J), 1e-12);
}

/// A hook between two rods under a heavy load: omega^2 = T (1 / l_1 + 1 / l_2) / m for a fixed load, whose
/// own part is of the order of the ratio of the masses.
TEST(Frequencies, OfALightHookUnderAHeavyLoad)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("hook", 1, {0, 0, -0.5}));
    model.add_body(point_mass("load", 1e4, {0, 0, -1.3}));
    model.add_joint(rod("upper", world, 0, {}, 0.5));
    model.add_joint(rod("lower", 0, 1, {}, 0.8));
    const HighestFrequencies f = of(model);
    const double upper = 10001 * 9.81, lower = 1e4 * 9.81;
    EXPECT_NEAR(f.constraints.rate, std::sqrt(upper / 0.5 + lower / 0.8), 0.05);
    EXPECT_EQ(f.constraints.where(model), "body 'hook', joint 'upper'");
    EXPECT_EQ(f.springs.rate, 0);
}

/// Only joints: omega^2 = g / l at rest. A pendulum that turns over has the tension of its speed as well.
TEST(Frequencies, OfAPendulum)
{
    for (const double v : {0.0, 3.0}) {
        Model model({0, 0, -9.81});
        model.add_body(point_mass("bob", 2, {0, 0, -0.7}, {v, 0, 0}));
        model.add_joint(rod("rod", world, 0, {}, 0.7));
        EXPECT_NEAR(of(model).constraints.rate, std::sqrt(9.81 / 0.7 + v * v / 0.49), 1e-12) << v;
    }
}

/// Springs without free length at +-1 m pull at the ends of a bar of 1 m: k / 2 of the stiffness k in turns
/// is theirs, the other half is that of the bar, which bears their pull.
TEST(Frequencies, OfAPreloadThatABodyBears)
{
    Model model;
    const int bar = model.add_body(rigid_body("bar", {1, {}, {0.8, 0, 0, 0, 2, 0, 0, 0, 2}}));
    for (const double side : {-1.0, 1.0})
        model.add_load(spring_damper(side < 0 ? "left" : "right", world, {side, 0, 0}, bar,
                                     {0.5 * side, 0, 0}, {100, 0, 0}));
    const HighestFrequencies f = of(model);
    EXPECT_NEAR(f.constraints.rate, std::sqrt(0.5 * 100 / 2), 1e-12);
    EXPECT_EQ(f.constraints.where(model), "body 'bar', which bears a preload");
    EXPECT_NEAR(f.springs.rate, std::sqrt(200.0), 1e-12);   // the bar as a whole: 2 k / m
}

/// No unit of mass or length, and no other place or direction, makes another frequency.
TEST(Frequencies, KnowNoUnitsOfLengthOrMass)
{
    const auto hook = [](double metre, double kilogram) {
        Model model({0, 0, -9.81 * metre});
        model.add_body(point_mass("hook", kilogram, {0.3 * metre, 0, -0.4 * metre}));
        model.add_body(rigid_body(
            "load", box(3e4 * kilogram / (metre * metre * metre), {0.2 * metre, 0.3 * metre, 0.1 * metre}),
            {{0.3 * metre, 0, -1.4 * metre}}));
        model.add_joint(rod("upper", world, 0, {}, 0.5 * metre));
        model.add_joint(rod("lower", 0, 1, {}, metre));
        model.add_load(spring_damper("spring", world, {metre, 0, 0}, 1, {0.1 * metre, 0, 0},
                                     {1e4 * kilogram, 5 * kilogram, 0.5 * metre}));
        return of(model);
    };
    const HighestFrequencies a = hook(1, 1), b = hook(1e-3, 1e3);
    EXPECT_NEAR(a.springs.rate / b.springs.rate, 1, 1e-10);
    EXPECT_NEAR(a.dampers.rate / b.dampers.rate, 1, 1e-10);
    EXPECT_NEAR(a.constraints.rate / b.constraints.rate, 1, 1e-10);
    EXPECT_GT(a.constraints.rate, 0);
}

TEST(Frequencies, OfAMechanismThatCannotMoveAreNone)
{
    Model model({0, 0, -9.81});
    const int body = model.add_body(rigid_body("brick", box(3, {1, 0.2, 0.4})));
    model.add_joint(weld("seat", world, body, {}, world_configuration, model.bodies()[body].X));
    EXPECT_EQ(of(model).constraints.rate, 0);
    EXPECT_EQ(of(model).springs.rate, 0);
}

/// Bricks on ball joints, each a little heavier than the one before and with a spring to the world.
Model chain(int n, double gravity, double stiffness)
{
    Model model({0, 0, -gravity});
    for (int i = 0; i < n; ++i) {
        const Matrix34 X = configuration({i + 0.5, 0, 0}, identity<3>());
        const Matrix34 before = i == 0 ? world_configuration : model.bodies()[i - 1].X;
        const int body = model.add_body(
            rigid_body("brick" + std::to_string(i), box(1 + 0.1 * i, {1, 0.2, 0.4}), {X.column(0)}));
        model.add_joint(spherical("ball" + std::to_string(i), body - 1, body,
                                  joint_frame(before, X, {1.0 * i, 0, 0}, {0, 1, 0})));
        model.add_load(spring_damper("spring" + std::to_string(i), world, {i + 0.5, 0, 3}, body, {},
                                     {stiffness * (1 + i % 7), i == 3 ? 2.0 : 0.0, 3}));
    }
    return model;
}

/// Lanczos' iteration, which many bodies are given to, against a dense solver: with gravity alone the fastest
/// vibration is that of the constraints, without it and at rest that of the springs.
TEST(Frequencies, OfManyBodiesAreThoseOfADenseSolver)
{
    for (const int n : {18, 30, 60}) {   // 54 freedoms are given to a dense solver anyway
        const Model hanging = chain(n, 9.81, 0), sprung = chain(n, 0, 40);
        const HighestFrequencies of_weight = of(hanging), of_springs = of(sprung);
        const double weight = vibrations(hanging, hanging.start()).back().rate;
        EXPECT_NEAR(of_weight.constraints.rate, weight, 1e-9 * weight) << n;
        EXPECT_EQ(of_weight.springs.rate, 0);
        const double spring = vibrations(sprung, sprung.start()).back().rate;
        EXPECT_NEAR(of_springs.springs.rate, spring, 1e-9 * spring) << n;
        EXPECT_NEAR(of_springs.constraints.rate, 0, 1e-6);
        EXPECT_GT(of_springs.dampers.rate, 0.1);
        EXPECT_EQ(of_springs.dampers.name, "load 'spring3'");
    }
}

/// Those from a rate on are the fastest of all, and the bound that spares the rest hides none of them: of two
/// masses on one spring it is the rate itself.
TEST(Frequencies, FromARateOnAreTheFastestOfAll)
{
    Model two;
    two.add_body(point_mass("one", 2, {0, 0, 0}));
    two.add_body(point_mass("other", 2, {1, 0, 0}));
    two.add_load(spring_damper("spring", 0, {}, 1, {}, {100, 0, 1}));   // 10 rad/s, and its bound, too
    std::vector<Model> models{two};
    for (const int n : {1, 3, 18, 30}) {
        models.push_back(chain(n, 9.81, 40));
        models.push_back(chain(n, 0, 4e4));
        models.push_back(chain(n, 9.81, 0));
    }
    int n_hidden = 0;
    for (const Model& model : models) {
        const std::vector<Vibration> all = vibrations(model, model.start());
        ASSERT_FALSE(all.empty());
        for (const double share : {0.1, 0.9, 1 - 1e-9, 1 + 1e-9, 1.5, 10.0}) {
            const double slowest = share * all.back().rate;
            const auto found = vibrations(model, model.start(), Side::right, slowest);
            const auto n = std::ranges::count_if(all, [&](const auto& v) { return v.rate >= slowest; });
            ASSERT_EQ(static_cast<long>(found.size()), n) << share;
            for (std::size_t i = 0; i < found.size(); ++i)
                EXPECT_EQ(found[i].rate, all[all.size() - found.size() + i].rate) << share;
            n_hidden += found.empty();
        }
    }
    EXPECT_GE(n_hidden, 3 * static_cast<int>(models.size()));
}

/// A torque about an axis of the world does no work on a symmetric motion: what its tangent leaves is
/// rounding of entries as large as the torque. A spring beside it is seen none the less.
TEST(Frequencies, AreNotMadeOfTheRoundingOfLargeLoads)
{
    for (const double stiffness : {0.0, 9.0}) {
        Model model;
        Placement askew;
        askew.directors = directors_from_rotation_vector({0.3, -1.1, 0.7});
        model.add_body(rigid_body("body", {1, {}, {1, 0, 0, 0, 2, 0, 0, 0, 2.5}}, askew));
        model.add_load(torque("large", 0, {7e11, -3e11, 5e11}, Frame::inertial));
        if (stiffness > 0) model.add_load(spring_damper("spring", world, {}, 0, {}, {stiffness, 0, 0}));
        const HighestFrequencies f = of(model);
        EXPECT_NEAR(f.springs.rate, std::sqrt(stiffness), 1e-9);
        EXPECT_EQ(f.springs.name, stiffness > 0 ? "load 'spring'" : "");
    }
}

}   // namespace
}   // namespace livens::frequencies_test
