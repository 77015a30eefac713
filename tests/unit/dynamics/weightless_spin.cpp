// SPDX-License-Identifier: BSD-3-Clause
// Whether a spin carries inertia is judged by the digits that mass matrices and joints hold.
#include <gtest/gtest.h>

#include "linkages.h"
#include "livens/dynamics/start/consistent_start.h"

namespace livens::weightless_spin_test {
namespace {

std::string verdict(const Model& model)
{
    try {
        return std::to_string(consistent_start(model, model.start(), StartPolicy::check).degrees_of_freedom);
    } catch (const InputError& error) {
        return error.complaint().code;
    }
}

/// A body with the moments a, b, c about its centre, which is at the given place; its axes turned at random.
Body body_with(Random& random, const Vector3& moments, const Vector3& at, double reference)
{
    Placement placement;
    placement.directors = random.rotation();
    const Vector3 center = reference * random.unit();
    placement.position = at - placement.directors * center;
    Matrix3 J{};
    for (int i = 0; i < 3; ++i) J(i, i) = moments[i];
    return rigid_body("body", {1, center, J}, placement);
}

const Vector3 box_moments{0.16, 0.17, 0.18}, needle_moments{0, 1.0 / 12, 1.0 / 12};

/// The body on a joint at a point along its axis d1 from its centre.
enum class Hold { none, ball, across, along };
Model held(Random& random, const Vector3& moments, double reference, Hold hold)
{
    Model model;
    const Vector3 at = random.vector();
    model.add_body(body_with(random, moments, at, reference));
    const Matrix34& X = model.bodies()[0].X;
    const Vector3 end = at + 0.5 * X.column(1);
    if (hold == Hold::ball)
        model.add_joint(spherical("j", world, 0, joint_frame(world_configuration, X, end)));
    if (hold == Hold::across || hold == Hold::along)
        model.add_joint(revolute(
            "j", world, 0, joint_frame(world_configuration, X, end, X.column(hold == Hold::across ? 2 : 1))));
    return model;
}

TEST(WeightlessSpin, BodiesWithInertiaHaveNoneHoweverRemoteTheirReferencePoint)
{
    Random random(5);
    for (const double reference : {0.0, 1.0, 1e3, 1e6}) {
        for (int i = 0; i < 50; ++i) {
            EXPECT_EQ(verdict(held(random, box_moments, reference, Hold::none)), "6") << reference;
            EXPECT_EQ(verdict(held(random, box_moments, reference, Hold::ball)), "3") << reference;
            EXPECT_EQ(verdict(held(random, needle_moments, reference, Hold::across)), "1") << reference;
        }
    }
}

TEST(WeightlessSpin, FreeNeedlesAreFoundHoweverRemoteTheirReferencePoint)
{
    Random random(6);
    for (const double reference : {0.0, 1.0, 1e3, 1e6}) {
        for (const Hold hold : {Hold::none, Hold::ball, Hold::along}) {
            for (int i = 0; i < 50; ++i)
                EXPECT_EQ(verdict(held(random, needle_moments, reference, hold)), "spin-without-inertia")
                    << reference << ' ' << static_cast<int>(hold);
        }
    }
}

TEST(WeightlessSpin, SaysWhereTheMassMatrixHoldsNoDigitOfTheInertia)
{
    Random random(7);
    try {
        const Model model = held(random, box_moments, 1e9, Hold::none);
        consistent_start(model, model.start(), StartPolicy::check);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.complaint().code, "spin-without-inertia");
        EXPECT_NE(error.complaint().help.find("reference point near the body"), std::string::npos);
    }
}

TEST(WeightlessSpin, RodsOfAnyLengthMakeNone)
{
    // A box whose corners hang on rods: what they leave free has inertia. A needle on such a rod is free.
    for (const double length : {1.0, 1e6, 1e11}) {
        Random random(8);
        for (int i = 0; i < 20; ++i) {
            Model model;
            model.add_body(body_with(random, box_moments, {0, 0, 0}, 0.3));
            Model needle;
            needle.add_body(body_with(random, needle_moments, {0, 0, 0}, 0));
            const auto hang = [&](Model& m, const std::string& name, const Vector3& from) {
                const Vector3 to = from + length * random.unit();
                JointFrame f = joint_frame(world_configuration, m.bodies()[0].X, from);
                f.point_first = to;
                m.add_joint(rod(name, world, 0, f, norm(m.bodies()[0].X * point(f.point_second) - to)));
            };
            for (int k = 0; k < 3; ++k) hang(model, "r" + std::to_string(k), 0.5 * random.vector());
            hang(needle, "r", 0.4 * needle.bodies()[0].X.column(1));
            EXPECT_EQ(verdict(model), "3") << length;
            EXPECT_EQ(verdict(needle), "spin-without-inertia") << length;
            hang(needle, "off the axis", 0.2 * random.unit());
            EXPECT_EQ(verdict(needle), "4") << length;
        }
    }
}

TEST(WeightlessSpin, CoaxialNeedlesSpinTogether)
{
    Model model;
    for (const char* name : {"one", "two"}) {
        Placement placement;
        placement.position = {name[0] == 'o' ? 0.0 : 1.0, 0, 0};
        model.add_body(rigid_body(name, {1, {0.5, 0, 0}, {0, 0, 0, 0, 0.1, 0, 0, 0, 0.1}}, placement));
    }
    const auto frame = [&](const Vector3& at) {
        return joint_frame(model.bodies()[0].X, model.bodies()[1].X, at);
    };
    model.add_joint(weld("weld", 0, 1, frame({1, 0, 0}), model.bodies()[0].X, model.bodies()[1].X));
    EXPECT_EQ(verdict(model), "spin-without-inertia");
    // One of them is stopped, and with it the other.
    const Matrix34& X = model.bodies()[0].X;
    model.add_joint(revolute("hinge", world, 0, joint_frame(world_configuration, X, {}, {0, 1, 0})));
    EXPECT_EQ(verdict(model), "1");
}

TEST(WeightlessSpin, InertiaCountsDownToTheDigitsOfTheMassMatrix)
{
    // Wires: the moment about the axis is 6e-14 of the others; below 16 eps tr E it is none.
    Random random(9);
    EXPECT_EQ(verdict(held(random, {5e-15, 1.0 / 12, 1.0 / 12}, 0, Hold::ball)), "3");
    EXPECT_EQ(verdict(held(random, {1e-17, 1.0 / 12, 1.0 / 12}, 0, Hold::ball)), "spin-without-inertia");
}

TEST(WeightlessSpin, DoesNotDependOnMassesOfOthers)
{
    for (unsigned seed = 0; seed < 40; ++seed) {
        Linkage l(seed, {.largest_power = 15});
        for (int b = 0; b < 3; ++b) l.add_link(l.random.vector());
        for (int b = 0; b < 3; ++b) l.ball(b - 1, b, l.random.vector());
        EXPECT_EQ(verdict(l.model), "9");
        l.model.add_body(body_with(l.random, needle_moments, l.random.vector(), 1));
        l.ball(2, 3, l.X(3) * point(mass_properties(l.model.bodies()[3].mass).center_of_mass));
        EXPECT_EQ(verdict(l.model), "spin-without-inertia");
    }
}

}   // namespace
}   // namespace livens::weightless_spin_test
