// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/loads/load_laws.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "livens/base/error.h"
#include "unit/multibody/random_states.h"

namespace livens::loads_test {
namespace {

constexpr int states = 1000;

LoadArguments random_arguments(Random& random)
{
    LoadArguments arguments;
    arguments.at.t = random.number();
    for (int b = 0; b < 2; ++b) {
        arguments.X[b] = random.skew();
        arguments.V[b] = random.matrix<3, 4>();
    }
    return arguments;
}

LoadForces forces(const Load& load, const LoadArguments& arguments)
{
    LoadForces F{};
    load.forces(arguments, F);
    return F;
}

/// Moment of a generalised force about the reference point.
Vector3 moment(const Matrix34& X, const Matrix34& F)
{
    Vector3 sum{};
    for (int i = 1; i < 4; ++i) sum += cross(X.column(i), F.column(i));
    return sum;
}

TimeVector constant(const Vector3& v) { return {v[0], v[1], v[2]}; }

TEST(PointForce, DoesTheWorkOfItsPoint)
{
    Random random(1);
    for (int n = 0; n < states; ++n) {
        const Vector3 f = random.vector(), theta = random.vector();
        const LoadArguments at = random_arguments(random);
        const Vector3 velocity = at.V[0] * point(theta);
        const Load inertial = point_force("f", 0, theta, constant(f), Frame::inertial);
        EXPECT_NEAR(load_power(inertial, at), dot(f, velocity), 1e-14);
        const Load follower = point_force("f", 0, theta, constant(f), Frame::body_fixed);
        EXPECT_NEAR(load_power(follower, at), dot(directors(at.X[0]) * f, velocity), 1e-14);
    }
}

TEST(PointForce, InWorldAxesDependsOnNothing)
{
    const Load load = point_force("f", 0, {1, 2, 3}, constant({1, 0, 0}), Frame::inertial);
    EXPECT_FALSE(load.depends_on_X);
    EXPECT_FALSE(load.depends_on_V);
    EXPECT_EQ(forces(load, LoadArguments())[0], (Matrix34{1, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0}));
    EXPECT_EQ(forces(load, LoadArguments())[1], Matrix34{});
}

TEST(Torque, HasItsMomentForEveryTriadThatIsNotFlat)
{
    Random random(2);
    for (int n = 0; n < states; ++n) {
        const Vector3 mu = random.vector();
        LoadArguments at;
        do at.X[0] = random.matrix<3, 4>();   // any directors, left-handed ones too
        while (std::abs(determinant(directors(at.X[0]))) < 0.05);
        const Matrix34 inertial = forces(torque("t", 0, constant(mu), Frame::inertial), at)[0];
        EXPECT_LT(largest(moment(at.X[0], inertial) - mu), 2e-13);
        EXPECT_EQ(inertial.column(0), Vector3{});
        const Matrix34 follower = forces(torque("t", 0, constant(mu), Frame::body_fixed), at)[0];
        EXPECT_LT(largest(moment(at.X[0], follower) - directors(at.X[0]) * mu), 2e-13);
    }
}

TEST(Torque, DoesTheWorkOfItsSpinOnRigidStates)
{
    Random random(3);
    for (int n = 0; n < states; ++n) {
        const Vector3 mu = random.vector(), w = random.vector();
        LoadArguments at;
        at.X[0] = random.rigid();
        at.V[0] = rate(at.X[0], random.vector(), w);
        EXPECT_NEAR(load_power(torque("t", 0, constant(mu), Frame::inertial), at), dot(mu, w), 2e-15);
        // On a triad d^i = d_i, so F_i is half the cross product of (P21).
        const Matrix34 F = forces(torque("t", 0, constant(mu), Frame::inertial), at)[0];
        EXPECT_LT(largest(F.column(2) - 0.5 * cross(mu, at.X[0].column(2))), 2e-15);
    }
}

TEST(Torque, OfACoupleIsTakenFromTheOtherBody)
{
    Random random(5);
    for (int n = 0; n < states; ++n) {
        const Vector3 mu = random.vector(), w[2] = {random.vector(), random.vector()};
        LoadArguments at;
        for (int b = 0; b < 2; ++b) {
            at.X[b] = random.rigid();
            at.V[b] = rate(at.X[b], random.vector(), w[b]);
        }
        for (const Frame frame : {Frame::inertial, Frame::body_fixed}) {
            const Load couple = torque("t", 0, constant(mu), frame, 1);
            const LoadForces F = forces(couple, at);
            const Vector3 turned = frame == Frame::body_fixed ? directors(at.X[0]) * mu : mu;
            EXPECT_LT(largest(moment(at.X[0], F[0]) - turned), 1e-14);
            EXPECT_LT(largest(moment(at.X[1], F[1]) + turned), 1e-14);
            EXPECT_NEAR(load_power(couple, at), dot(turned, w[0] - w[1]), 1e-14);
        }
    }
}

TEST(SpringDamper, PullsAlongTheLineByItsLaw)
{
    const Load load = spring_damper("s", 0, {0.5, 0, 0}, 1, {-0.5, 0, 0}, {100, 7, 1.5});
    LoadArguments at;
    at.X[1].set_column(0, {4, 0, 0});   // 3 m between the points, 1.5 too long
    at.V[1].set_column(0, {2, 5, 0});   // parting at 2 m/s
    const LoadForces F = forces(load, at);
    EXPECT_DOUBLE_EQ(F[0](0, 0), 100 * 1.5 + 7 * 2);
    EXPECT_DOUBLE_EQ(F[1](0, 0), -(100 * 1.5 + 7 * 2));
    EXPECT_DOUBLE_EQ(F[0](0, 1), 0.5 * F[0](0, 0));
    EXPECT_EQ(F[0](1, 0), 0);
    EXPECT_DOUBLE_EQ(load.potential(at), 0.5 * 100 * 1.5 * 1.5);
    EXPECT_DOUBLE_EQ(load.power(at), -7 * 2 * 2);
    EXPECT_DOUBLE_EQ(power_without_potential(load, at), -28);
}

TEST(SpringDamper, ForcesAndMomentsOfTwoBodiesCancel)
{
    Random random(4);
    for (int n = 0; n < states; ++n) {
        const Load load = spring_damper("s", 0, random.vector(), 1, random.vector(), {30, 2, 0.4});
        const LoadArguments at = random_arguments(random);
        const LoadForces F = forces(load, at);
        Vector3 about_origin{};
        for (int b = 0; b < 2; ++b)
            for (int c = 0; c < 4; ++c) about_origin += cross(at.X[b].column(c), F[b].column(c));
        EXPECT_EQ(F[0].column(0), -F[1].column(0));
        EXPECT_LT(largest(about_origin), 1e-12);
    }
}

TEST(SpringDamper, IsDefinedWherePointsCoincide)
{
    LoadArguments at;
    at.V[0] = Matrix34{1, 2, 3};
    const Load slack = spring_damper("s", 0, {}, 1, {}, {100, 7, 0.5});
    const Load straight = spring_damper("s", 0, {}, 1, {}, {100, 7, 0});
    for (const Load* load : {&slack, &straight}) {
        EXPECT_EQ(forces(*load, at)[0], Matrix34{});
        EXPECT_EQ(forces(*load, at)[1], Matrix34{});
        LoadTangent tangent;
        load->tangent(at, tangent);
        for (int b = 0; b < 2; ++b)
            for (int c = 0; c < 2; ++c)
                EXPECT_TRUE(std::isfinite(largest(tangent.X[b][c])) &&
                            std::isfinite(largest(tangent.V[b][c])));
        EXPECT_EQ(load->power(at), 0);
    }
    LoadTangent tangent;
    straight.tangent(at, tangent);
    EXPECT_EQ(tangent.X[0][0](0, 0), -100) << "without free length the spring is linear, here too";
    EXPECT_DOUBLE_EQ(slack.potential(at), 0.5 * 100 * 0.25);
}

TEST(SpringDamper, IsDefinedForPointsThatNearlyCoincide)
{
    LoadArguments at;
    at.X[1](0, 0) = 1e-200;   // the square would vanish
    const Load load = spring_damper("s", 0, {}, 1, {}, {100, 0, 0.5});
    EXPECT_DOUBLE_EQ(forces(load, at)[0](0, 0), -50);
}

TEST(SpringDamper, PutsTheBodyBeforeTheWorld)
{
    const Load load = spring_damper("s", world, {1, 0, 0}, 2, {0, 0.5, 0}, {10, 1, 0});
    EXPECT_EQ(load.bodies, (std::vector<int>{2, world}));
    LoadArguments at;
    const LoadForces F = forces(load, at);
    EXPECT_DOUBLE_EQ(F[0](0, 0), 10);
    EXPECT_DOUBLE_EQ(F[0](1, 0), -5);
    EXPECT_TRUE(load.needs_directors[0]);
    EXPECT_FALSE(load.needs_directors[1]);
}

TEST(Load, BreaksAreThoseOfItsComponents)
{
    const TimeVector value = window({linear_table({0, 0.5, 2}, {0, 1, 0}), 1.0, 2.0}, -1, 0.5);
    EXPECT_EQ(torque("t", 0, value, Frame::inertial).breaks, (std::vector<double>{-1, 0, 0.5}));
    EXPECT_TRUE(torque("t", 0, constant({1, 2, 3}), Frame::inertial).breaks.empty());
}

TEST(Load, HasTwoSidesAtAJump)
{
    const Load load = point_force("f", 0, {}, window(constant({1, 2, 3}), 0.5, 1), Frame::inertial);
    LoadArguments at;
    at.at = {0.5, Side::left};
    EXPECT_EQ(forces(load, at)[0].column(0), Vector3{});
    at.at = {0.5, Side::right};
    EXPECT_EQ(forces(load, at)[0].column(0), (Vector3{1, 2, 3}));
    at.at = {1, Side::left};
    EXPECT_EQ(forces(load, at)[0].column(0), (Vector3{1, 2, 3}));
    at.at = {1, Side::right};
    EXPECT_EQ(forces(load, at)[0].column(0), Vector3{});
}

TEST(Load, WrongInputIsRefused)
{
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    expect_complaint([=] { point_force("f", 0, {}, constant({nan, 0, 0}), Frame::inertial); }, "not-finite");
    const TimeVector bad{TimeFunction([=](Instant) { return TimeValue{nan, 0, 0}; }, {}), 0.0, 0.0};
    expect_complaint([=] { torque("t", 0, bad, Frame::inertial); }, "not-finite", "load[t].value");
    expect_complaint(
        [=] {
            point_force("f", 0, {inf, 0, 0}, constant({}), Frame::inertial);
        },
        "not-finite", "load[f]");
    expect_complaint([] { torque("t", world, constant({}), Frame::inertial); }, "load-self", "load[t]");
    const Vector3 o{};
    expect_complaint(
        [=] {
            spring_damper("s", 0, o, 1, o, {-1, 0, 0});
        },
        "load-negative", "load[s].stiffness");
    expect_complaint([=] { spring_damper("s", 0, o, 1, o, {0, -1, 0}); }, "load-negative", "load[s].damping");
    expect_complaint(
        [=] {
            spring_damper("s", 0, o, 1, o, {0, 0, -1});
        },
        "load-negative", "load[s].free_length");
    expect_complaint(
        [=] {
            spring_damper("s", 0, o, 1, o, {nan, 0, 0});
        },
        "load-negative", "load[s].stiffness");
    expect_complaint([=] { spring_damper("s", 1, o, 1, o, {1, 0, 0}); }, "load-self", "load[s]");
    expect_complaint([=] { spring_damper("s", 0, {nan, 0, 0}, 1, o, {1, 0, 0}); }, "not-finite", "load[s]");
}

TEST(Load, PowerWithoutPotentialFollowsTheRule)
{
    Random random(5);
    const LoadArguments at = random_arguments(random);
    Load load = point_force("f", 0, {}, constant({1, 2, 3}), Frame::inertial);
    EXPECT_EQ(power_without_potential(load, at), load_power(load, at)) << "no potential: all of it";
    load.potential = [](const LoadArguments&) { return 0.0; };
    EXPECT_EQ(power_without_potential(load, at), 0) << "a potential and nothing else";
    load.power = [](const LoadArguments&) { return 5.0; };
    EXPECT_EQ(power_without_potential(load, at), 5);
}

TEST(Load, PowerLeavesOutTheWorld)
{
    const Load load = spring_damper("s", 0, {}, world, {1, 0, 0}, {10, 0, 0});
    LoadArguments at;
    at.V[0](0, 0) = 3;
    EXPECT_DOUBLE_EQ(load_power(load, at), 30);
}

/// Three pairs of point masses about a centre: to second order of their distances, here a hundredth of that
/// of the attracting point, what each of them feels adds up to the load.
TEST(Attraction, WithItsGradientIsThatOfABodysParts)
{
    Random random(6);
    for (int n = 0; n < 100; ++n) {
        const double mu = 2 + random.number(), a = 0.02;
        const Vector3 centre = random.vector(), there = random.vector() + 4 * random.unit();
        const Matrix3 axes = random.rotation();
        const Matrix34 X = random.rigid();
        MassProperties all{0, centre, {}};
        Vector3 force{}, couple{};
        double pull = 0;
        const Vector3 middle = X * point(centre);
        for (int k = 0; k < 6; ++k) {
            const double m = std::array{1.0, 2.0, 4.0}[static_cast<std::size_t>(k / 2)];
            const Vector3 arm = (k % 2 == 0 ? a : -a) * axes.column(k / 2), at = X * point(centre + arm);
            const double r = norm(there - at);
            const Vector3 f = mu * m / (r * r * r) * (there - at);
            all.mass += m;
            all.inertia += m * (dot(arm, arm) * identity<3>() - outer(arm, arm));
            force += f;
            couple += cross(at - middle, f);
            pull += norm(f);
        }
        const Body body = rigid_body("b", all);
        const std::vector<Matrix34> start{X};
        LoadArguments at;
        at.X[0] = X;
        const double r = norm(there - middle), small = pull * a * a / (r * r);   // of the second term
        for (const bool has_gradient : {true, false}) {
            const Load load = attraction("l", 0, body, {there, mu, has_gradient}, start);
            const Matrix34 F = forces(load, at)[0];
            const Vector3 pulls = F.column(0), turns = moment(X, F) - cross(middle - X.column(0), pulls);
            EXPECT_EQ(norm(pulls - force) < 0.01 * small, has_gradient) << norm(pulls - force) / small;
            EXPECT_EQ(norm(turns - couple) < 0.01 * small * r, has_gradient)
                << norm(turns - couple) / small / r;
            for (int k = 0; k < 3; ++k) EXPECT_EQ(load.readings[k].value(at), pulls[k]);
        }
    }
}

/// Seven million metres away mu m / r is 1e10 times the couple, whose digits would be lost against it.
TEST(Attraction, PullsAtTheDirectorsByItsGradientAlone)
{
    Random random(7);
    const double mu = 4e14, r = 7e6;
    for (int n = 0; n < 100; ++n) {
        const Body body = rigid_body("b", {500, {}, {100, 0, 0, 0, 1250, 0, 0, 0, 1300}});
        const std::vector<Matrix34> start{configuration(r * random.unit(), random.rotation())};
        LoadArguments at;
        at.X[0] = start[0];
        const Matrix34 F = forces(attraction("l", 0, body, {{}, mu, true}, start), at)[0];
        const Vector3 away = (1 / r) * start[0].column(0), y = transpose(directors(start[0])) * away;
        const Vector3 couple = directors(start[0]) * cross(y, {100 * y[0], 1250 * y[1], 1300 * y[2]});
        EXPECT_LT(norm(moment(start[0], F) - 3 * mu / (r * r * r) * couple), 1e-15);
        for (int k = 1; k < 4; ++k) EXPECT_LT(norm(F.column(k)), 1e4 * mu / (r * r * r));
    }
}

/// Of any turn, about several axes and by more than half a one.
TEST(RotationalDamper, TurnsAgainstTheRelativeAngularVelocity)
{
    Random random(8);
    const std::vector<Matrix34> start{world_configuration, world_configuration};
    for (int n = 0; n < states; ++n) {
        LoadArguments at;
        std::array<Vector3, 2> w{random.vector(), random.vector()};
        for (int b = 0; b < 2; ++b) {
            at.X[b] = random.rigid();
            at.V[b] = rate(at.X[b], random.vector(), w[static_cast<std::size_t>(b)]);
        }
        const Load load =
            rotational_damper("l", 1, 0, 0.7, start);   // of body 0, which stands first, against 1
        ASSERT_EQ(load.bodies, (std::vector<int>{0, 1}));
        const LoadForces F = forces(load, at);
        const Vector3 couple = -0.7 * (w[0] - w[1]);
        EXPECT_LT(norm(moment(at.X[0], F[0]) - couple), 1e-13);
        EXPECT_LT(norm(moment(at.X[1], F[1]) + couple), 1e-13);
        for (const Matrix34& of_body : F) EXPECT_EQ(norm(of_body.column(0)), 0);
        EXPECT_NEAR(load_power(load, at), -dot(couple, couple) / 0.7, 1e-13);
        EXPECT_NEAR(power_without_potential(load, at), -dot(couple, couple) / 0.7, 1e-13);
        const Vector3 told{load.readings[0].value(at), load.readings[1].value(at),
                           load.readings[2].value(at)};
        EXPECT_LT(norm(directors(at.X[1]) * told - couple), 1e-13) << "in axes of the first one named";
    }
    EXPECT_THROW(rotational_damper("l", 0, 1, -1, start), InputError);
    EXPECT_THROW(rotational_damper("l", 0, 0, 1, start), InputError);
}

/// A bushing's frames turned by 2.5 rad, where its rotation vector's rate is not the angular velocity.
TEST(Bushing, IsDampedByTheRateOfItsVectorOrByTheAngularVelocity)
{
    Random random(9);
    const std::vector<Matrix34> start{world_configuration, world_configuration};
    Bushing law;
    for (int k = 3; k < 6; ++k) law.damping(k, k) = 0.7;
    for (int n = 0; n < 100; ++n) {
        LoadArguments at;
        const Vector3 w = random.vector(), turn = 2.5 * random.unit();
        at.X[1] = configuration({}, directors_from_rotation_vector(turn));
        at.V[1] = rate(at.X[1], {}, w);
        for (const bool by_spin : {true, false}) {
            law.by_angular_velocity = by_spin;
            const Load load = bushing("l", 0, {}, 1, {}, law, start);
            const std::size_t second = load.bodies[0] == 1 ? 0 : 1;
            LoadArguments seen = at;
            seen.X[0] = load.bodies[0] == 1 ? at.X[1] : at.X[0];
            seen.X[1] = load.bodies[0] == 1 ? at.X[0] : at.X[1];
            seen.V[0] = load.bodies[0] == 1 ? at.V[1] : at.V[0];
            seen.V[1] = load.bodies[0] == 1 ? at.V[0] : at.V[1];
            const Vector3 gap =
                moment(seen.X[static_cast<int>(second)], forces(load, seen)[second]) + 0.7 * w;
            EXPECT_EQ(norm(gap) < 1e-13, by_spin) << norm(gap);
        }
    }
}

/// What it tells is the couple that acts, which is -K r along K's own axes and for small turns only.
TEST(Bushing, TellsTheCoupleThatActs)
{
    Random random(11);
    const std::vector<Matrix34> start{world_configuration, world_configuration};
    for (const double angle : {1e-9, 1e-3, 0.05, 0.19, 0.21, 1.4, 3.0})
        for (const bool by_spin : {true, false}) {
            Bushing law;
            law.by_angular_velocity = by_spin;
            for (int k = 0; k < 6; ++k) law.stiffness(k, k) = 1 + k, law.damping(k, k) = 0.3 * (6 - k);
            law.stiffness(1, 4) = law.stiffness(4, 1) = 0.5;
            law.preload[5] = 0.7;
            const Load load = bushing("l", 0, {}, 1, {}, law, start);
            const std::size_t first = load.bodies[0] == 0 ? 0 : 1, second = 1 - first;
            LoadArguments at;
            const Vector3 r = angle * random.unit();
            Matrix34& X = at.X[second];
            X = configuration(random.vector(), directors_from_rotation_vector(r));
            at.V[second] = rate(X, random.vector(), random.vector());
            std::map<std::string, double> told;
            const auto couple = [&] {
                for (const LoadReading& reading : load.readings) told[reading.name] = reading.value(at);
                return Vector3{told["torque_x"], told["torque_y"], told["torque_z"]};
            };
            const LoadForces F = forces(load, at);
            EXPECT_LT(norm(moment(X, F[second]) - couple()), 1e-12) << angle << by_spin;
            EXPECT_LT(norm(F[second].column(0) - Vector3{told["force_x"], told["force_y"], told["force_z"]}),
                      1e-13);
            // What the law has along the rotation vector is something else once the turn is large.
            const Vector3 along{-4 * r[0], -5 * r[1] - 0.5 * X(1, 0), -6 * r[2] - 0.7};
            at.V[second] = Matrix34{};
            EXPECT_EQ(norm(couple() - along) < 1e-6, angle < 1e-6) << angle;
        }
}

}   // namespace
}   // namespace livens::loads_test
