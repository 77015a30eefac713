// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/loads/load_laws.h"
#include "livens/multibody/model.h"

#include <gtest/gtest.h>

#include <limits>

#include "unit/multibody/random_states.h"

namespace livens::model_test {
namespace {

const double nan = std::numeric_limits<double>::quiet_NaN();

Body brick(const std::string& name, const Vector3& position = {})
{
    return rigid_body(name, box(1, {1, 2, 3}), {.position = position});
}

/// Two bricks and a ball: bodies 0, 1, 2.
Model small_model()
{
    Model model({0, 0, -9.81});
    model.add_body(brick("a"));
    model.add_body(brick("b", {5, 0, 0}));
    model.add_body(point_mass("ball", 2, {0, 0, 1}));
    return model;
}

Load plain_load(const std::string& name)
{
    return point_force(name, 0, {}, {1.0, 2.0, 3.0}, Frame::inertial);
}

TEST(Model, FindsWhatWasAdded)
{
    Model model = small_model();
    EXPECT_EQ(model.add_joint(spherical("j", world, 0, {})), 0);
    EXPECT_EQ(model.add_joint(revolute("k", 0, 1, {})), 1);
    EXPECT_EQ(model.find_body("b"), 1);
    EXPECT_EQ(model.find_body("world"), world);
    EXPECT_EQ(model.find_body("c"), -2);
    EXPECT_EQ(model.find_joint("k"), 1);
    EXPECT_EQ(model.find_joint("b"), -2);
    EXPECT_EQ(model.body_name(world), "world");
    EXPECT_EQ(model.body_name(2), "ball");
}

TEST(Model, NumbersRowsInTheOrderOfItsJoints)
{
    Model model = small_model();
    model.add_joint(spherical("j", world, 0, {}));
    model.add_joint(revolute("k", 0, 1, {}));
    model.add_joint(rod("r", 1, 2, {}, 1));
    ASSERT_EQ(model.n_rows(), 9);
    EXPECT_EQ(model.first_row(1), 3);
    EXPECT_EQ(model.first_row(2), 8);
    EXPECT_EQ(model.row_joint(7), 1);
    EXPECT_EQ(model.row_in_joint(7), 4);
    EXPECT_EQ(model.row(7).label, "axis 2");
    EXPECT_EQ(model.row(8).label, "distance");
}

TEST(Model, StartIsWhatTheBodiesSay)
{
    const Model model = small_model();
    const State state = model.start();
    ASSERT_EQ(state.X.size(), 3u);
    EXPECT_EQ(state.X[1], model.bodies()[1].X);
    EXPECT_EQ(state.V[2], model.bodies()[2].V);
    EXPECT_EQ(state.t, 0);
}

TEST(Model, CollectsBreaksOfAllLoads)
{
    Model model = small_model();
    model.add_load(point_force("f", 0, {}, window({1.0, 0.0, 0.0}, 0.5, 2), Frame::inertial));
    model.add_load(torque("t", 1, window({1.0, 0.0, 0.0}, 0.25, 0.5), Frame::inertial));
    EXPECT_EQ(model.load_breaks(), (std::vector<double>{0.25, 0.5, 2}));
}

TEST(Model, NamesAreGivenOnceAndNotEmpty)
{
    Model model = small_model();
    expect_complaint([&] { model.add_body(brick("a")); }, "name-duplicate", "body[a]");
    expect_complaint([&] { model.add_body(brick("")); }, "name-empty");
    expect_complaint([&] { model.add_body(brick("world")); }, "name-reserved");
    model.add_joint(spherical("j", world, 0, {}));
    expect_complaint([&] { model.add_joint(spherical("j", 0, 1, {})); }, "name-duplicate", "joint[j]");
    model.add_load(plain_load("f"));
    expect_complaint([&] { model.add_load(plain_load("f")); }, "name-duplicate", "load[f]");
    EXPECT_NO_THROW(model.add_joint(spherical("a", world, 0, {})))
        << "bodies and joints have names of their own";
    EXPECT_EQ(model.n_bodies(), 3) << "what was refused is not there";
    EXPECT_EQ(model.joints().size(), 2u);
}

TEST(Model, RefusesBodiesThatNothingDescribes)
{
    Model model;
    const auto refuses = [&](auto change, const std::string& code) {
        Body body = brick("x");
        change(body);
        expect_complaint([&] { model.add_body(body); }, code);
    };
    refuses([](Body& b) { b.X(1, 0) = nan; }, "not-finite");
    refuses([](Body& b) { b.V(1, 3) = nan; }, "not-finite");
    refuses([](Body& b) { b.mass(0, 0) = 0; }, "mass-not-positive");
    refuses([](Body& b) { b.mass(1, 1) = -1; }, "inertia-triangle");
    refuses([](Body& b) { b.mass(1, 2) = 0.1; }, "inertia-not-symmetric");
    refuses([](Body& b) { b.X(0, 1) = 1.001; }, "directors-not-orthonormal");
    refuses([](Body& b) { b.X(0, 1) = -1; }, "directors-left-handed");
    refuses([](Body& b) { b.is_point = true; }, "point-with-directors");
    EXPECT_EQ(model.n_bodies(), 0);
}

TEST(Model, TakesLaminaeAboutAFarReferencePoint)
{
    Random random(1);
    for (int n = 0; n < 50; ++n) {
        const Matrix3 R = random.rotation();
        const MassProperties lamina{1, 1e4 * random.unit(),
                                    R * Matrix3{1, 0, 0, 0, 2, 0, 0, 0, 3} * transpose(R)};
        Model model;
        EXPECT_NO_THROW(model.add_body(rigid_body("plate", lamina)));
    }
}

TEST(Model, RefusesGravityThatIsNoNumber)
{
    Model model({0, nan, 0});
    expect_complaint([&] { model.add_body(brick("a")); }, "not-finite", "gravity");
}

TEST(Model, RefusesJointsThatBreakTheRulesOfRows)
{
    Model model = small_model();
    const auto refuses = [&](auto change, const std::string& code) {
        Joint joint = revolute("k", 0, 1, {});
        change(joint);
        expect_complaint([&] { model.add_joint(joint); }, code);
    };
    refuses([](Joint& j) { j.second = 3; }, "body-unknown");
    refuses([](Joint& j) { j.first = -2; }, "body-unknown");
    refuses([](Joint& j) { j.first = 1; }, "joint-self");
    refuses([](Joint& j) { j.second = world; }, "joint-second");
    refuses([](Joint& j) { j.rows.clear(); }, "joint-empty");
    refuses([](Joint& j) { j.point_first[1] = nan; }, "not-finite");
    refuses([](Joint& j) { j.rows[3].c_ij(1, 1) = nan; }, "not-finite");
    refuses([](Joint& j) { j.rows[3].c = nan; }, "not-finite");
    refuses([](Joint& j) { j.rows[0].scale = 0; }, "joint-scale");
    refuses([](Joint& j) { j.rows[0].body_i = 2; }, "joint-row");
    refuses([](Joint& j) { j.rows[0].body_j = world; }, "joint-row");
    refuses([](Joint& j) { j.rows[0].body_i = 1; }, "joint-self");
    refuses([](Joint& j) { j.rows[0].c_jj(1, 2) = 1; }, "joint-row");
    refuses([](Joint& j) { j.rows[3].body_i = world; }, "joint-row");
    EXPECT_EQ(model.n_rows(), 0);
    EXPECT_NO_THROW(model.add_joint(revolute("k", 0, 1, {})));
}

TEST(Model, RefusesOrientationOfPointMassesWhicheverWayRound)
{
    Model model = small_model();
    const Matrix34 X = world_configuration, point_X = model.bodies()[2].X;
    for (const int other : {world, 0}) {
        expect_complaint([&] { model.add_joint(revolute("j", other, 2, {})); }, "joint-needs-directors",
                         "joint[j]");
        expect_complaint([&] { model.add_joint(universal("j", other, 2, {})); }, "joint-needs-directors");
        expect_complaint([&] { model.add_joint(weld("j", other, 2, {}, X, point_X)); },
                         "joint-needs-directors");
        expect_complaint([&] { model.add_joint(weld("j", 2, other, {}, point_X, X)); },
                         "joint-needs-directors");
        expect_complaint(
            [&] {
                model.add_joint(spherical("j", other, 2, {{}, {0, 0, 1}}));
            },
            "joint-needs-directors");
        for (const Vector3& off : {Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}}) {
            const JointFrame here{off, {}}, there{{}, off};
            expect_complaint([&] { model.add_joint(rod("j", 2, other, here, 1)); }, "joint-needs-directors");
            expect_complaint([&] { model.add_joint(rod("j", other, 2, there, 1)); }, "joint-needs-directors");
        }
    }
    EXPECT_NO_THROW(model.add_joint(spherical("ball joint", 0, 2, {{1, 2, 3}, {}})));
    EXPECT_NO_THROW(model.add_joint(rod("rod", 2, world, {{}, {1, 2, 3}}, 1)));
    const JointFrame frame = joint_frame(world_configuration, point_X, {0, 0, 1});
    EXPECT_NO_THROW(model.add_joint(spherical("placed", world, 2, frame)));
}

TEST(Model, RefusesLoadsItCannotEvaluate)
{
    Model model = small_model();
    const auto refuses = [&](auto change, const std::string& code) {
        Load load = spring_damper("s", 0, {}, 1, {}, {1, 1, 1});
        change(load);
        expect_complaint([&] { model.add_load(load); }, code, "load[s]");
    };
    refuses([](Load& l) { l.bodies[1] = 3; }, "body-unknown");
    refuses([](Load& l) { l.bodies[1] = 0; }, "load-self");
    refuses([](Load& l) { l.forces = nullptr; }, "load-empty");
    refuses([](Load& l) { l.tangent = nullptr; }, "load-without-tangent");
    refuses([](Load& l) { l.breaks = {nan}; }, "not-finite");
}

TEST(Model, RefusesLoadsOnTheOrientationOfAPointMass)
{
    Model model = small_model();
    const TimeVector value{1.0, 0.0, 0.0};
    const std::string code = "load-needs-directors";
    expect_complaint([&] { model.add_load(torque("l", 2, value, Frame::inertial)); }, code, "load[l]");
    expect_complaint([&] { model.add_load(point_force("l", 2, {}, value, Frame::body_fixed)); }, code);
    expect_complaint([&] { model.add_load(point_force("l", 2, {1, 0, 0}, value, Frame::inertial)); }, code);
    expect_complaint([&] { model.add_load(spring_damper("l", 0, {}, 2, {0, 1, 0}, {1, 0, 0})); }, code);
    EXPECT_NO_THROW(model.add_load(point_force("f", 2, {}, value, Frame::inertial)));
    EXPECT_NO_THROW(model.add_load(spring_damper("s", 0, {1, 0, 0}, 2, {}, {1, 0, 0})));
}

TEST(Model, LengthIsPositiveAndMovesWithTheModel)
{
    EXPECT_EQ(Model().length(), 1);
    Model alone;
    alone.add_body(point_mass("p", 1, {3, 4, 5}));
    EXPECT_EQ(alone.length(), 1) << "nothing to measure";

    Model pendulum;
    pendulum.add_body(point_mass("p", 1, {0, 0, 1e-3}));
    pendulum.add_joint(rod("r", world, 0, {}, 1e-3));
    EXPECT_DOUBLE_EQ(pendulum.length(), 1e-3);

    Model cube;
    cube.add_body(rigid_body("c", box(1, {6, 6, 6})));
    EXPECT_DOUBLE_EQ(cube.length(), 3) << "radius of gyration about the centre: three times 36 / 12, rooted";

    // Arms and centres of mass that are rounding: a bead that a joint holds where it is.
    for (const double mass : {0.9, 0.3, 1.3, 1.0000001}) {
        Model bead;
        bead.add_body(point_mass("bead", mass, {0.5, 0.1, -0.3}));
        JointFrame frame;
        frame.point_first = {0.5, 0.1, -0.3};
        bead.add_joint(spherical("held", world, 0, frame, 1));
        EXPECT_EQ(bead.length(), 1) << mass;
    }

    Model orbit;
    orbit.add_body(point_mass("moon", 0.7, {3e-6, 0, 4e-6}));
    orbit.add_load(attraction("pull", 0, orbit.bodies()[0], {{}, 1e-12}, Configurations(orbit.start().X)));
    EXPECT_NEAR(orbit.length(), 5e-6, 1e-20);
    // Two on a tether in an orbit: what they do to each other is not measured by what attracts both.
    Model tethered;
    for (const double x : {7e6, 7e6 + 12}) {
        const int one = tethered.add_body(point_mass("one " + std::to_string(x), 1, {x, 0, 0}));
        tethered.add_load(attraction("pull " + std::to_string(one), one, tethered.bodies()[one], {{}, 4e14},
                                     Configurations(tethered.start().X)));
    }
    EXPECT_NEAR(tethered.length(), 12, 1e-8);

    Random random(2);
    const Matrix3 R = random.rotation();
    const Vector3 shift = 100.0 * random.vector();
    Model here, there;
    for (int b = 0; b < 3; ++b) {
        const Matrix34 X = random.rigid();
        const MassProperties properties = with_center(box(1, {1, 2, 3}), random.vector());
        const std::string name = std::to_string(b);
        here.add_body(rigid_body(name, properties, {.position = X.column(0), .directors = directors(X)}));
        there.add_body(rigid_body(name, properties,
                                  {.position = R * X.column(0) + shift, .directors = R * directors(X)}));
    }
    EXPECT_NEAR(there.length(), here.length(), 1e-12);
}

TEST(Model, WeightPullsAtTheCentreOfMass)
{
    Random random(3);
    const Vector3 g = random.vector(), c = random.vector();
    const Body body = rigid_body("b", with_center(box(2, {1, 1, 1}), c), {.directors = random.rotation()});
    const Matrix34 V = random.matrix<3, 4>();
    EXPECT_NEAR(dot(weight(body, g), V), 2 * dot(g, V * point(c)), 1e-14);
}

}   // namespace
}   // namespace livens::model_test
