// SPDX-License-Identifier: BSD-3-Clause
#include "livens/dynamics/coordinates/generalised_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "livens/base/error.h"
#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/joints/drives.h"
#include "livens/time/time_laws.h"
#include "unit/dynamics/linkages.h"

namespace livens::generalised_state_test {
namespace {

using Numbers = std::vector<double>;

/// Five links at random places, each on a hinge, a slider or a screw of the one before it or of any other;
/// with weight, springs, dampers and a force that turns with its body. `floats`: nothing holds the first.
Linkage random_tree(unsigned seed, bool floats)
{
    Linkage tree(seed, {1, 0, 0.3, 0});
    tree.model = Model({0.3, -0.2, -9.81});
    for (int i = 0; i < 5; ++i) tree.add_link(tree.random.vector());
    for (int b = floats ? 1 : 0; b < 5; ++b) {
        const int first = b == 0 ? world : static_cast<int>(std::floor(0.5 * (tree.random.number() + 1) * b));
        const JointFrame frame = tree.frame(first, b, tree.random.vector(), tree.random.unit());
        const std::string name = "j" + std::to_string(b);
        const Matrix34 X_first = tree.X(first), X_second = tree.X(b);
        if (b == 2)
            tree.model.add_joint(prismatic(name, first, b, frame, X_first, X_second));
        else if (b == 4)
            tree.model.add_joint(screw(name, first, b, frame, X_first, X_second, 0.7));
        else
            tree.model.add_joint(revolute(name, first, b, frame));
    }
    const std::vector<Matrix34> start = tree.model.start().X;
    const Configurations X(start);
    for (const Joint& joint : std::vector<Joint>(tree.model.joints()))
        tree.model.add_load(
            joint_spring("on " + joint.name, joint.coordinates[0], {3, 0.4, 0.1, 0.2, {}}, X));
    tree.model.add_load(spring_damper("strut", 1, {0.1, 0.2, 0}, 3, {0, 0.1, 0.3}, {5, 0.3, 0.2, 0, {}}));
    tree.model.add_load(point_force("jet", 2, {0.2, 0, 0.1}, {1, 2, 3}, Frame::body_fixed));
    return tree;
}

GeneralisedCoordinates coordinates_of(const Model& model, const std::vector<std::string>& wanted = {})
{
    return {model, model.start(), StartPolicy::check, wanted};
}

/// Anywhere within two radians (metres), of quaternions any.
Numbers random_numbers(Random& random, const GeneralisedCoordinates& coordinates)
{
    Numbers q;
    for (const GeneralisedCoordinate& c : coordinates.list())
        for (int i = 0; i < c.n_numbers(); ++i)
            q.push_back(c.n_numbers() == 4 ? random.number() : 2 * random.number());
    return q;
}

Numbers random_rates(Random& random, const GeneralisedCoordinates& coordinates)
{
    Numbers v;
    for (int i = 0; i < coordinates.n_rates(); ++i) v.push_back(random.number());
    return v;
}

double product(const Numbers& x, const Numbers& y)
{
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
    return sum;
}

/// Of a matrix that is stored row by row.
Numbers times(const Numbers& A, const Numbers& x)
{
    const std::size_t n = x.size();
    Numbers y(A.size() / n, 0.0);
    for (std::size_t i = 0; i < y.size(); ++i)
        for (std::size_t k = 0; k < n; ++k) y[i] += A[i * n + k] * x[k];
    return y;
}

double farthest(const Numbers& x, const Numbers& y)
{
    EXPECT_EQ(x.size(), y.size());
    double largest = 0;
    for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::abs(x[i] - y[i]));
    return largest;
}

/// q moved along rates for a time.
Numbers moved(const GeneralisedCoordinates& coordinates, Numbers q, const Numbers& v, double h)
{
    std::size_t k = 0, r = 0;
    for (const GeneralisedCoordinate& c : coordinates.list()) {
        if (c.n_numbers() == 4) {
            const Matrix3 turned = directors_from_rotation_vector({h * v[r], h * v[r + 1], h * v[r + 2]}) *
                                   directors_from_quaternion({q[k], q[k + 1], q[k + 2], q[k + 3]});
            const Vector4 there = quaternion_from_directors(turned);
            std::copy_n(there.a, 4, q.begin() + static_cast<std::ptrdiff_t>(k));
        } else {
            q[k] += h * v[r];
        }
        k += static_cast<std::size_t>(c.n_numbers());
        r += static_cast<std::size_t>(c.n_rates());
    }
    return q;
}

struct Case {
    Linkage tree;
    GeneralisedCoordinates coordinates;
    Numbers q, v;
    GeneralisedState state;

    Case(unsigned seed, bool floats)
        : tree(random_tree(seed, floats)), coordinates(coordinates_of(tree.model)),
          q(random_numbers(tree.random, coordinates)), v(random_rates(tree.random, coordinates)),
          state(coordinates.at(q, v))
    {}
};

void for_random_trees(const std::function<void(Case&)>& check)
{
    for (unsigned seed = 1; seed <= 8; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Case one(seed, seed % 2 == 0);
        check(one);
    }
}

TEST(GeneralisedState, HasTheNumbersThatWereAskedFor)
{
    for_random_trees([](Case& one) {
        EXPECT_EQ(one.coordinates.n_rates(),
                  one.tree.model.n_bodies() + (one.coordinates.n_numbers() > 5 ? 5 : 0));
        for (const double phi : joint_values(one.tree.model, one.state.state().X)) EXPECT_NEAR(phi, 0, 1e-14);
        for (const double rate : joint_rates(one.tree.model, one.state.state().X, one.state.state().V))
            EXPECT_NEAR(rate, 0, 1e-13);
        std::size_t k = 0, r = 0;
        for (const GeneralisedCoordinate& c : one.coordinates.list()) {
            if (c.of == GeneralisedCoordinate::Of::joint) {
                const NamedCoordinate& q = one.tree.model.joints()[c.part].coordinates[c.index];
                const double moved =
                    coordinate_change(q.coordinate, one.tree.model.start().X, one.state.state().X);
                EXPECT_NEAR(std::remainder(moved - one.q[k], 2 * std::numbers::pi), 0, 1e-14);
                EXPECT_NEAR(coordinate_rate(q.coordinate, one.state.state().X, one.state.state().V), one.v[r],
                            1e-13);
            }
            k += static_cast<std::size_t>(c.n_numbers());
            r += static_cast<std::size_t>(c.n_rates());
        }
    });
}

TEST(GeneralisedState, MassMatrixHoldsTheKineticEnergy)
{
    for_random_trees([](Case& one) {
        const Numbers M = one.state.mass_matrix();
        const auto n = static_cast<std::size_t>(one.coordinates.n_rates());
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = 0; k < n; ++k) EXPECT_EQ(M[i * n + k], M[k * n + i]);
        for (int i = 0; i < 5; ++i) {
            const Numbers v = random_rates(one.tree.random, one.coordinates);
            const double energy = one.coordinates.at(one.q, v).kinetic_energy();
            EXPECT_GT(energy, 0);
            EXPECT_NEAR(0.5 * product(v, times(M, v)), energy, 1e-13 * energy);
        }
    });
}

TEST(GeneralisedState, ForcesAreSlopesOfThePotential)
{
    for_random_trees([](Case& one) {
        one.tree.model = [&] {   // without what has no potential
            Model model(one.tree.model.gravity());
            for (const Body& body : one.tree.model.bodies()) model.add_body(body);
            for (const Joint& joint : one.tree.model.joints()) model.add_joint(joint);
            for (const Load& load : one.tree.model.loads())
                if (load.name != "jet") model.add_load(load);
            return model;
        }();
        const GeneralisedCoordinates coordinates = coordinates_of(one.tree.model);
        const GeneralisedState rest = coordinates.at(one.q);
        Numbers held = rest.gravity_forces(), slope(held.size());
        const Numbers loads = rest.load_forces();
        for (std::size_t i = 0; i < held.size(); ++i) held[i] -= loads[i];
        for (std::size_t i = 0; i < held.size(); ++i) {
            constexpr double h = 1e-4;
            Numbers along(held.size(), 0.0);
            along[i] = 1;
            const auto energy = [&](double by) {
                return coordinates.at(moved(coordinates, one.q, along, by)).potential_energy();
            };
            slope[i] = (8 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12 * h);
        }
        EXPECT_LT(farthest(held, slope), 1e-9);
        EXPECT_LT(farthest(rest.bias_forces(), rest.gravity_forces()), 1e-12) << "at rest";
    });
}

TEST(GeneralisedState, InverseDynamicsInvertTheAccelerations)
{
    for_random_trees([](Case& one) {
        const Numbers forces = random_rates(one.tree.random, one.coordinates);
        const Numbers back = one.state.inverse_dynamics(one.state.accelerations(forces));
        EXPECT_LT(farthest(back, forces), 1e-11);
        Numbers other = forces;
        other[0] += 1e-6;
        EXPECT_GT(farthest(back, other), 1e-7);
    });
}

/// The engine's own accelerations of the bodies in the same state.
TEST(GeneralisedState, AcceleratesBodiesAsTheEngineDoes)
{
    for_random_trees([](Case& one) {
        const Model& model = one.tree.model;
        const State& at = one.state.state();
        const ModelTables tables(model, row_rank(model, at.X, all_rows(model)).independent);
        InstantSystem instant(tables);
        InstantState state;
        state.resize(tables);
        state.angles = at.angles;
        for (int b = 0; b < model.n_bodies(); ++b) {
            std::copy_n(at.X[b].a, 12, state.X.begin() + 12 * b);
            const Vector3 w = angular_velocity(at.X[b], at.V[b]);
            for (int i = 0; i < 6; ++i) state.velocity[6 * b + i] = i < 3 ? at.V[b](i, 0) : w[i - 3];
        }
        ASSERT_TRUE(instant.prepare(state, std::vector<int>(tables.independent)));
        instant.accelerate(state, Side::right);
        const Numbers a = one.state.accelerations();
        for (int b = 0; b < model.n_bodies(); ++b) {
            Numbers of_body = times(one.state.jacobian(b), a), drift = one.state.drift(b);
            for (int i = 0; i < 6; ++i)
                EXPECT_NEAR(of_body[i] + drift[i], state.acceleration[1][6 * b + i], 1e-10) << b << ", " << i;
        }
    });
}

TEST(GeneralisedState, JacobianAndDriftAreThoseOfAPointThatMoves)
{
    for_random_trees([](Case& one) {
        const Vector3 theta{0.3, -0.2, 0.5};
        constexpr double h = 1e-4;
        const auto velocity = [&](double by) {
            const GeneralisedState there =
                one.coordinates.at(moved(one.coordinates, one.q, one.v, by), one.v);
            return times(there.jacobian(3, theta), one.v);
        };
        const State& at = one.state.state();
        const Vector3 v = at.V[3] * point(theta), w = angular_velocity(at.X[3], at.V[3]);
        EXPECT_LT(farthest(velocity(0), {v[0], v[1], v[2], w[0], w[1], w[2]}), 1e-13);
        Numbers slope(6);
        const Numbers before = velocity(-h), after = velocity(h), far_before = velocity(-2 * h),
                      far_after = velocity(2 * h);
        for (std::size_t i = 0; i < 6; ++i)
            slope[i] = (8 * (after[i] - before[i]) - (far_after[i] - far_before[i])) / (12 * h);
        EXPECT_LT(farthest(slope, one.state.drift(3, theta)), 1e-9);
    });
}

TEST(GeneralisedState, SlopesAreThoseOfTheAccelerations)
{
    for_random_trees([](Case& one) {
        const StateSlopes slopes = one.state.slopes();
        const auto n = static_cast<std::size_t>(slopes.n);
        constexpr double h = 1e-3;
        for (std::size_t k = 0; k < n; ++k) {
            Numbers along(n, 0.0);
            along[k] = 1;
            const auto by_place = [&](double by) {
                return one.coordinates.at(moved(one.coordinates, one.q, along, by), one.v).accelerations();
            };
            const auto by_rate = [&](double by) {
                Numbers v = one.v;
                v[k] += by;
                return one.coordinates.at(one.q, v).accelerations();
            };
            for (const bool is_rate : {false, true}) {
                const auto of = [&](double by) { return is_rate ? by_rate(by) : by_place(by); };
                const Numbers p = of(h), m = of(-h), pp = of(2 * h), mm = of(-2 * h);
                for (std::size_t i = 0; i < n; ++i)
                    EXPECT_NEAR(slopes.A[(n + i) * 2 * n + (is_rate ? n : 0) + k],
                                (8 * (p[i] - m[i]) - (pp[i] - mm[i])) / (12 * h), 2e-7)
                        << i << " by " << k << (is_rate ? ", rate" : "");
            }
        }
    });
}

/// Crank, coupler and rocker in the plane y = 0, the crank upright; a spherical joint and a revolute one
/// close it.
struct Loop : Linkage {
    Loop() : Linkage(3, {})
    {
        model = Model({0, 0, -9.81});
        const Vector3 places[] = {{0, 0, 0.15}, {0.5, 0, 0.45}, {1, 0, 0.3}};
        for (const Vector3& place : places) add_link(place);
        hinge_named("A", world, 0, {0, 0, 0});
        hinge_named("B", 0, 1, {0, 0, 0.3});
        hinge_named("C", 1, 2, {1, 0, 0.6});
        hinge_named("D", world, 2, {1, 0, 0});
    }
    void hinge_named(const std::string& joint, int first, int second, const Vector3& at)
    {
        model.add_joint(revolute(joint, first, second, frame(first, second, at, {0, 1, 0})));
    }
};

/// A loop in space that nothing holds goes where its first body goes, however far, and then along its joints.
TEST(GeneralisedState, LoopsThatFloatAreTakenAlong)
{
    Loop loop;
    loop.hinge_named("E", 2, loop.add_link({1, 0, -0.3}), {1, 0, 0});
    Model floating(loop.model.gravity());
    for (const Body& body : loop.model.bodies()) floating.add_body(body);
    for (const Joint& joint : loop.model.joints())
        if (joint.first != world) floating.add_joint(joint);
    floating.add_joint(revolute("F", 3, 0, joint_frame(loop.X(3), loop.X(0), {0, 0, 0}, {0, 1, 0})));
    const GeneralisedCoordinates coordinates = coordinates_of(floating);
    ASSERT_EQ(coordinates.n_rates(), 7);
    Numbers q = coordinates.placed();
    q[0] += 1e4;
    q[7] -= 0.4;
    std::swap(q[3], q[4]);
    const GeneralisedState state = coordinates.at(q, Numbers{1, 2, 3, 4, 5, 6, 7});
    for (const double phi : joint_values(floating, state.state().X)) EXPECT_NEAR(phi, 0, 1e-9);
    EXPECT_NEAR(state.state().X[0](0, 0), q[0], 1e-9);
    EXPECT_NEAR(0.5 * product(state.rates(), times(state.mass_matrix(), state.rates())) /
                    state.kinetic_energy(),
                1, 1e-9);
}

std::string code_of(const std::function<void()>& act)
{
    try {
        act();
    } catch (const InputError& error) {
        return error.complaint().code + " " + error.complaint().path;
    }
    return "none";
}

TEST(GeneralisedState, LoopsAreLedAlongTheirBranch)
{
    const Loop loop;
    const GeneralisedCoordinates coordinates = coordinates_of(loop.model);
    ASSERT_EQ(coordinates.names_of_numbers(), std::vector<std::string>{"A.angle"});
    for (const double angle : {0.3, -2.0, 3.0, 14.0}) {
        const GeneralisedState state = coordinates.at(Numbers{angle}, Numbers{0.7});
        for (const double phi : joint_values(loop.model, state.state().X)) EXPECT_NEAR(phi, 0, 1e-13);
        const GeneralisedState other = coordinates.at(Numbers{angle + 2 * std::numbers::pi});
        EXPECT_NEAR(norm(other.state().X[1] - state.state().X[1]), 0, 1e-11) << "a turn later";
        EXPECT_NEAR(0.5 * 0.49 * state.mass_matrix()[0], state.kinetic_energy(), 1e-13);
    }
}

TEST(GeneralisedState, RefusesWhatIsNoState)
{
    const Loop loop;
    const GeneralisedCoordinates crank = coordinates_of(loop.model),
                                 rocker = coordinates_of(loop.model, {"D.angle"});
    EXPECT_EQ(code_of([&] { crank.at(Numbers{1, 2}); }), "coordinate-value q");
    EXPECT_EQ(code_of([&] { crank.at(Numbers{std::nan("")}); }), "coordinate-value q[A.angle]");
    EXPECT_EQ(code_of([&] { crank.at(Numbers{1}, Numbers{1, 2}); }), "coordinate-value v");
    EXPECT_EQ(code_of([&] { crank.at(Numbers{1}).accelerations(Numbers{1, 2}); }), "coordinate-value forces");
    EXPECT_EQ(code_of([&] {
                  coordinates_of(loop.model, {"A.angle", "D.angle"});
              }),
              "coordinates-dependent q[D.angle]");
    EXPECT_EQ(code_of([&] {
                  coordinates_of(loop.model, {"A.angle", "A.angle"});
              }),
              "coordinate-twice q[A.angle]");
    EXPECT_EQ(code_of([&] { coordinates_of(loop.model, {"A.angel"}); }), "coordinate-unknown q[A.angel]");
    EXPECT_EQ(code_of([&] { crank.at(Numbers{1}).jacobian(world); }), "body-unknown ");
    EXPECT_EQ(code_of([&] { crank.at(Numbers{1}).drift(3); }), "body-unknown ");
    EXPECT_EQ(code_of([&] {
                  crank.at(Numbers{1}).reaching({0, {}, {0, std::nan(""), 0}});
              }),
              "coordinate-value pose");
    EXPECT_EQ(code_of([&] { rocker.at(Numbers{2}); }).substr(0, 9), "loop-open");
    for (const double far : {1e300, -1e300, 1e5})
        EXPECT_EQ(code_of([&] { crank.at(Numbers{far}); }), "coordinate-value q[A.angle]");
    Case tree(1, false);
    tree.q[1] = 1e300;
    EXPECT_EQ(code_of([&] { tree.coordinates.at(tree.q); }), "coordinate-value q[j1.angle]");
    tree.q[1] = 5000;
    EXPECT_NEAR(tree.coordinates.at(tree.q).coordinates()[1][0], 5000, 1e-9) << "turns are counted";
    EXPECT_EQ(code_of([&] { rocker.at(Numbers{0.1}); }), "none");
}

/// Where crank and coupler are in line the rocker turns back.
TEST(GeneralisedState, NamesADeadCentre)
{
    const Loop loop;
    const GeneralisedCoordinates crank = coordinates_of(loop.model),
                                 rocker = coordinates_of(loop.model, {"D.angle"});
    const NamedCoordinate& angle = loop.model.joints()[3].coordinates[0];
    const std::vector<Matrix34> start = loop.model.start().X;
    double low = 0, high = 3;   // of the crank: its rocker's rate changes sign in between
    const auto rate = [&](double a) {
        const State there = crank.at(Numbers{a}, Numbers{1}).state();
        return coordinate_rate(angle.coordinate, there.X, there.V);
    };
    ASSERT_GT(rate(low), 0);
    ASSERT_LT(rate(high), 0);
    for (int i = 0; i < 60; ++i) (rate(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
    const double most = coordinate_change(angle.coordinate, start, crank.at(Numbers{low}).state().X);
    EXPECT_EQ(code_of([&] { rocker.at(Numbers{most}); }), "coordinates-singular q[D.angle]");
    EXPECT_EQ(code_of([&] { rocker.at(Numbers{most - 1e-3}); }), "none");
    EXPECT_EQ(code_of([&] { rocker.at(Numbers{most + 1e-3}); }).substr(0, 9), "loop-open");
}

/// Bars of a parallelogram in one line hold less: no coordinate is to blame. It is passed on its branch.
TEST(GeneralisedState, NamesWhereJointsHoldLessAndPassesIt)
{
    Linkage bars(7, {});
    bars.model = Model({0, 0, -9.81});
    for (const Vector3& at : {Vector3{0, 0, 0.5}, {1, 0, 0.5}, {0.5, 0, 1}}) bars.add_link(at);
    const auto hinge = [&](const std::string& joint, int first, int second, const Vector3& at) {
        bars.model.add_joint(revolute(joint, first, second, bars.frame(first, second, at, {0, 1, 0})));
    };
    hinge("A", world, 0, {0, 0, 0});
    hinge("B", world, 1, {1, 0, 0});
    hinge("C", 0, 2, {0, 0, 1});
    hinge("D", 1, 2, {1, 0, 1});
    const GeneralisedCoordinates coordinates = coordinates_of(bars.model);
    EXPECT_EQ(code_of([&] { coordinates.at(Numbers{0.5 * std::numbers::pi}); }), "coordinates-singular q");
    for (const double angle : {1.5, 1.7, 4.6, 4.8}) {
        const GeneralisedState state = coordinates.at(Numbers{angle});
        EXPECT_NEAR(state.coordinates()[1][0], angle, 1e-12) << "the other crank turns likewise";
    }
}

TEST(GeneralisedState, DrivesAreReleasedAndOtherFreedomsAreNamed)
{
    Loop loop;
    const Joint& crank = loop.model.joints()[0];
    loop.model.add_joint(driven_coordinate("motor", crank, crank.coordinates[0], ramp(0, 1, 0),
                                           Configurations(loop.model.start().X)));
    EXPECT_EQ(coordinates_of(loop.model).n_rates(), 1);
    Linkage free(1, {});
    free.add_link({0, 0, 1});
    free.ball(world, 0, {0, 0, 0});
    EXPECT_EQ(coordinates_of(free.model).names_of_numbers(),
              (std::vector<std::string>{"b0.qw", "b0.qx", "b0.qy", "b0.qz"}));
}

TEST(GeneralisedState, ReachesAPoseNearby)
{
    for_random_trees([](Case& one) {
        const GeneralisedState there = one.coordinates.at(one.q);
        const Vector3 theta{0.2, 0.1, 0};
        const Numbers by = random_rates(one.tree.random, one.coordinates);
        const GeneralisedState goal = one.coordinates.at(moved(one.coordinates, one.q, by, 0.4));
        const Matrix34& X = goal.state().X[4];
        const Matrix3 D = directors(X);
        for (const std::optional<Matrix3>& turned : {std::optional<Matrix3>(), std::optional(D)}) {
            const GeneralisedState reached = there.reaching({4, theta, X * point(theta), turned});
            const Matrix34& Y = reached.state().X[4];
            EXPECT_LT(norm((Y - X) * point(theta)), 1e-11);
            if (turned) {
                EXPECT_LT(norm(directors(Y) - D), 1e-11);
            }
            for (const double phi : joint_values(one.tree.model, reached.state().X))
                EXPECT_NEAR(phi, 0, 1e-13);
        }
    });
}

/// Two links of 1 m on hinges about y.
TEST(GeneralisedState, TellsHowFarAPoseIsOutOfReach)
{
    Linkage arm(5, {});
    arm.add_link({0.5, 0, 0});
    arm.add_link({1, 0, 0.5});
    arm.hinge(world, 0, {0, 0, 0}, {0, 1, 0});
    arm.hinge(0, 1, {1, 0, 0}, {0, 1, 0});
    const GeneralisedState start = coordinates_of(arm.model).at(coordinates_of(arm.model).placed());
    const Vector3 end = transpose(directors(arm.X(1))) * (Vector3{1, 0, 1} - arm.X(1).column(0));
    const GeneralisedState reached = start.reaching({1, end, {0.5, 0, 1.2}});
    EXPECT_LT(norm(reached.state().X[1] * point(end) - Vector3{0.5, 0, 1.2}), 1e-12);
    const double elbow = start.numbers()[1] - reached.numbers()[1];
    EXPECT_LT(std::abs(elbow), 1) << "the elbow stays bent to its side";
    for (const auto& [target, left] :
         {std::pair{Vector3{3, 0, 0}, "1 m"}, {Vector3{0.5, 0.25, 1}, "0.25 m"}}) {
        try {
            start.reaching({1, end, target});
            FAIL() << "nothing was said";
        } catch (const InputError& error) {
            EXPECT_EQ(error.complaint().code, "pose-unreachable");
            EXPECT_NE(error.complaint().message.find(std::string("within ") + left), std::string::npos)
                << error.complaint().message;
        }
    }
}

}   // namespace
}   // namespace livens::generalised_state_test
