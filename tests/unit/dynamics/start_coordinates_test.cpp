// SPDX-License-Identifier: BSD-3-Clause
#include "livens/dynamics/start/start_coordinates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "livens/base/error.h"
#include "unit/dynamics/linkages.h"
#include "unit/multibody/random_states.h"

namespace livens::start_coordinates_test {
namespace {

constexpr double a = 0.42, b = 0.9, c = 1, d = 1;   // crank, coupler, rocker, ground
const Vector3 normal{0, 1, 0};

/// A link of the plane y = 0 from one place to another.
int add_link(Model& model, const std::string& name, const Vector3& from, const Vector3& to)
{
    const Vector3 along = (1 / norm(to - from)) * (to - from);
    Matrix3 D{};
    D.set_column(0, along);
    D.set_column(1, normal);
    D.set_column(2, cross(along, normal));
    const double l = norm(to - from);
    Placement placement;
    placement.position = from;
    placement.directors = D;
    return model.add_body(
        rigid_body(name, {2, {0.5 * l, 0, 0}, Matrix3{0.01, 0, 0, 0, 0.2, 0, 0, 0, 0.2}}, placement));
}

Joint hinge_at(const Model& model, const std::string& name, int first, int second, const Vector3& at)
{
    const auto X = [&](int body) { return body == world ? world_configuration : model.bodies()[body].X; };
    return revolute(name, first, second, joint_frame(X(first), X(second), at, normal));
}

/// Where the rocker's pin is: circles about the crank pin and the rocker's shaft, the upper point.
Vector3 rocker_pin(double crank)
{
    const double x = a * std::cos(crank), z = -a * std::sin(crank);   // turns about y take x to -z
    const double dx = d - x, dz = -z, r = std::hypot(dx, dz);
    const double along = (b * b - c * c + r * r) / (2 * r), across = std::sqrt(b * b - along * along);
    return {x + (along * dx - across * dz) / r, 0, z + (along * dz + across * dx) / r};
}

struct FourBar {
    Model model;
    static constexpr double stated = -1.2;   // angle of the crank from x about y

    FourBar()
    {
        const Vector3 A{0, 0, 0}, P{a * std::cos(stated), 0, -a * std::sin(stated)}, Q = rocker_pin(stated),
                                                                                     D{d, 0, 0};
        const int crank = add_link(model, "crank", A, P), coupler = add_link(model, "coupler", P, Q),
                  rocker = add_link(model, "rocker", D, Q);
        model.add_joint(hinge_at(model, "shaft", world, crank, A));
        model.add_joint(hinge_at(model, "pin", crank, coupler, P));
        model.add_joint(hinge_at(model, "rocker pin", coupler, rocker, Q));
        model.add_joint(hinge_at(model, "rocker shaft", world, rocker, D));
    }
};

TEST(StartCoordinates, LeadAFourBarAlongItsBranch)
{
    const FourBar four;
    for (const double turn : {0.3, -0.9, 2.0, 4.0, -5.5, 50.0, -161.0}) {
        SCOPED_TRACE(turn);
        const MovedStart moved = move_start(four.model, {{0, 0, turn, 7.0}}, StartPolicy::check);
        const double crank = FourBar::stated + turn;
        const Body& rocker = moved.model.bodies()[2];
        EXPECT_LT(norm(rocker.X * point({c, 0, 0}) - rocker_pin(crank)), 2e-14);
        // the pin's velocity by central differences of the closed form
        const double h = 1e-5;
        const Vector3 v = (7 / (2 * h)) * (rocker_pin(crank + h) - rocker_pin(crank - h));
        EXPECT_LT(norm(rocker.V * point({c, 0, 0}) - v), 1e-8 * norm(v));
        EXPECT_EQ(moved.model.joints()[0].coordinates[0].at_stated, turn) << "turns are counted";
        EXPECT_TRUE(moved.kept.empty());
        EXPECT_EQ(moved.left_free, 0);
        const ConsistentStart closed = consistent_start(moved.model, moved.model.start(), StartPolicy::check);
        EXPECT_EQ(closed.degrees_of_freedom, 1);
    }
}

/// The coupler turns against the crank as often as the crank turns: also what nobody stated is counted.
TEST(StartCoordinates, CountTurnsOfWhatFollows)
{
    const FourBar four;
    const MovedStart once = move_start(four.model, {{0, 0, 2 * std::numbers::pi, {}}}, StartPolicy::check);
    EXPECT_NEAR(once.model.joints()[1].coordinates[0].at_stated, -2 * std::numbers::pi, 1e-13);
    EXPECT_NEAR(once.model.joints()[3].coordinates[0].at_stated, 0, 1e-13);
    for (int body = 0; body < 3; ++body)
        EXPECT_LT(norm(once.model.bodies()[body].X - four.model.bodies()[body].X), 2e-14);
}

TEST(StartCoordinates, StopWhereTheMechanismStops)
{
    const FourBar four;
    const double reach = std::acos((c * c + d * d - (a + b) * (a + b)) / (2 * c * d));
    const Vector3 Q = rocker_pin(FourBar::stated);
    const double stated = std::atan2(Q[2], d - Q[0]), farther = reach - stated;
    EXPECT_NO_THROW(move_start(four.model, {{3, 0, farther - 1e-3, {}}}, StartPolicy::check));
    try {
        move_start(four.model, {{3, 0, farther + 0.5, {}}}, StartPolicy::check);
        FAIL() << "beyond the stretched position";
    } catch (const InputError& error) {
        EXPECT_EQ(error.complaint().code, "start-coordinate");
        const std::string& text = error.complaint().message;
        const std::string stops = "stops at ";
        const std::size_t at = text.find(stops);
        ASSERT_NE(at, std::string::npos) << text;
        EXPECT_NEAR(std::stod(text.substr(at + stops.size())), farther, 1e-3) << text;
        EXPECT_NE(text.find("would open"), std::string::npos) << text;
    }
}

/// In a tree every coordinate is independent: the others keep values and rates, whatever the masses.
TEST(StartCoordinates, LeaveOtherCoordinatesOfATree)
{
    for (unsigned seed = 0; seed < 10; ++seed) {
        Linkage chain(seed, {1, 0, 0.3, 2});
        int before = world;
        for (int i = 0; i < 5; ++i) {
            const int link = chain.add_link({1.0 * i, 0, 0});
            chain.hinge(before, link, {i - 0.5, 0.1 * i, 0}, chain.random.unit());
            before = link;
        }
        const MovedStart moving =
            move_start(chain.model, {{1, 0, {}, 2.0}, {4, 0, {}, -3.0}}, StartPolicy::check);
        EXPECT_EQ(moving.kept.size(), 3U);
        const MovedStart moved = move_start(moving.model, {{2, 0, 1.5, 0.5}}, StartPolicy::check);
        const double values[] = {0, 0, 1.5, 0, 0}, rates[] = {0, 2, 0.5, 0, -3};
        const State state = moved.model.start();
        for (int j = 0; j < 5; ++j) {
            SCOPED_TRACE(j);
            const NamedCoordinate& q = moved.model.joints()[j].coordinates[0];
            EXPECT_NEAR(q.at_stated, values[j], 1e-12);
            EXPECT_NEAR(coordinate_change(q.coordinate, chain.model.start().X, state.X), values[j], 1e-12);
            EXPECT_NEAR(coordinate_rate(q.coordinate, state.X, state.V), rates[j], 1e-11);
        }
    }
}

/// What no coordinate tells moves by the least in the metric of the masses: a free pair turns so that its
/// momenta stay zero.
TEST(StartCoordinates, MoveFreeBodiesByTheLeast)
{
    Linkage pair(3, {1, 0, 0.2, 1});
    const int one = pair.add_link({0, 0, 0}), other = pair.add_link({1, 0, 0});
    pair.hinge(one, other, {0.5, 0, 0}, {0, 0, 1});
    const MovedStart moved = move_start(pair.model, {{0, 0, {}, 4.0}}, StartPolicy::check);
    EXPECT_EQ(moved.left_free, 6);
    Vector3 momentum{}, spin{};
    for (const Body& body : moved.model.bodies()) {
        const Matrix34 P = body.V * body.mass;
        momentum += P.column(0);
        for (int i = 0; i < 4; ++i) spin += cross(body.X.column(i), P.column(i));
    }
    EXPECT_LT(norm(momentum), 1e-13);
    EXPECT_LT(norm(spin), 1e-13);
}

/// A base that is stated, at rest or not, stays as it is, and the rest follows; if not all that is stated
/// fits, all of it moves by the least, and is told.
TEST(StartCoordinates, KeepVelocitiesThatAreStated)
{
    Linkage pair(3, {1, 0, 0.2, 1});
    const int base = pair.add_link({0, 0, 0}), leg = pair.add_link({1, 0, 0});
    pair.hinge(base, leg, {0.5, 0, 0}, {0, 0, 1});
    const std::vector<StartCoordinate> wanted{{0, 0, {}, 4.0}};
    const MovedStart moved = move_start(pair.model, wanted, StartPolicy::check, 0, {{base}});
    EXPECT_TRUE(moved.changed.empty());
    EXPECT_LT(norm(moved.model.bodies()[base].V), 1e-15);
    const Vector3 w = angular_velocity(moved.model.bodies()[leg].X, moved.model.bodies()[leg].V);
    EXPECT_LT(norm(w - Vector3{0, 0, 4}), 1e-13);
    // Negative control: nobody stated it.
    EXPECT_GT(norm(move_start(pair.model, wanted, StartPolicy::check).model.bodies()[base].V), 0.1);
    // Its place alone: it turns so that it has no spin about its reference point.
    const MovedStart turned = move_start(pair.model, wanted, StartPolicy::check, 0, {{base, true, false}});
    EXPECT_LT(norm(turned.model.bodies()[base].V.column(0)), 1e-14);
    EXPECT_GT(norm(turned.model.bodies()[base].V), 0.1);
    const MovedStart both = move_start(pair.model, wanted, StartPolicy::check, 0, {{base}, {leg}});
    EXPECT_EQ(both.changed.size(), 2u) << "both at rest, and a hinge that turns: neither can stay";
}

TEST(StartCoordinates, RefuseWhatCannotBeStated)
{
    const FourBar four;
    const auto code = [&](const std::vector<StartCoordinate>& wanted) -> std::string {
        try {
            move_start(four.model, wanted, StartPolicy::check);
        } catch (const InputError& error) {
            return error.complaint().code + ": " + error.complaint().message;
        }
        return "";
    };
    EXPECT_EQ(code({{0, 0, 0.1, {}}}), "");
    EXPECT_NE(code({{0, 0, 0.1, {}}, {3, 0, 0.1, {}}}).find("'rocker shaft.angle' cannot be given"),
              std::string::npos);
    EXPECT_NE(code({{0, 0, 0.1, {}}, {0, 0, {}, 1.0}}).find("twice"), std::string::npos);
    EXPECT_NE(code({{0, 0, 1e4, {}}}).find("too far"), std::string::npos);
    EXPECT_NE(code({{0, 1, 0.1, {}}}).find("no such"), std::string::npos);
    EXPECT_NE(code({{9, 0, 0.1, {}}}).find("no such"), std::string::npos);
    EXPECT_NE(code({{0, 0, std::nan(""), {}}}).find("not finite"), std::string::npos);
}

TEST(StartCoordinates, TellsWhichAreIndependent)
{
    const FourBar four;
    const IndependentCoordinates found = independent_coordinates(four.model, four.model.start());
    EXPECT_EQ(found.names, std::vector<std::string>{"shaft.angle"});
    EXPECT_EQ(found.left_free, 0);

    Linkage pair(3, {});
    const int one = pair.add_link({0, 0, 0}), other = pair.add_link({1, 0, 0});
    pair.hinge(one, other, {0.5, 0, 0}, {0, 0, 1});
    EXPECT_EQ(independent_coordinates(pair.model, pair.model.start()).left_free, 6);
}

}   // namespace
}   // namespace livens::start_coordinates_test
