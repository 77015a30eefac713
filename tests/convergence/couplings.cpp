// SPDX-License-Identifier: BSD-3-Clause
// Screws, gears and slots: order 2p at element ends through many turns, and what is conserved.
#include <numbers>

#include "convergence/studies.h"
#include "livens/base/error.h"
#include "livens/diagnostics/sample.h"
#include "livens/multibody/joint_coordinates.h"
#include "newton_euler.h"

namespace livens::tests::couplings_test {
namespace {

using std::numbers::pi;
const Vector4 x_axis = direction({1, 0, 0}), y_axis = direction({0, 1, 0}), z_axis = direction({0, 0, 1});

/// A body that turned by an angle about the third axis and stands at a height.
State turned_state(double t, const std::vector<std::array<double, 4>>& angle_rate_height_speed,
                   const std::vector<Vector3>& places)
{
    State state{t, {}, {}};
    for (std::size_t b = 0; b < places.size(); ++b) {
        const auto& [angle, angle_rate, height, speed] = angle_rate_height_speed[b];
        state.X.push_back(
            configuration(places[b] + Vector3{0, 0, height}, directors_from_rotation_vector({0, 0, angle})));
        state.V.push_back(rate(state.X.back(), {0, 0, speed}, {0, 0, angle_rate}));
    }
    return state;
}

void expect_order_2p(const Model& model, double end, const State& witness, double floor,
                     const std::vector<std::pair<int, std::vector<int>>>& meshes)
{
    for (const auto& [degree, n] : meshes) {
        const Study s = lobatto_study(model, end, {witness, {}}, degree, n);
        EXPECT_GE(s.error.back().V, 10 * floor) << "p = " << degree;
        EXPECT_NEAR(last_rate(s, &Distance::X, 0), 2 * degree, 0.15) << "p = " << degree;
        EXPECT_NEAR(last_rate(s, &Distance::V, 0), 2 * degree, 0.15) << "p = " << degree;
    }
}

const std::vector<std::pair<int, std::vector<int>>> usual{
    {1, {150, 180, 216, 260, 312}}, {2, {48, 58, 70, 84, 101}}, {3, {26, 31, 37, 44, 53}}};

// --- a nut that sinks along a screw

constexpr double lead = 0.2;   // m a radian

Model nut()
{
    Model model({0, 0, -9.81});
    model.add_body(rigid_body("nut", with_mass(box(1, {0.3, 0.4, 0.2}), 2), {}));
    Joint joint = revolute("screw", world, 0, {});
    joint.rows.erase(joint.rows.begin() + 2);   // z
    joint.rows.push_back(coupling_row({{1, displacement_along(world, z_axis, point({}), 0, point({}))},
                                       {-lead, angle_between(world, x_axis, y_axis, 0, x_axis)}},
                                      0, 1, "screw"));
    model.add_joint(joint);
    return model;
}

/// Uniform acceleration: the weight works on what turns and sinks.
State nut_at(double t)
{
    const Model model = nut();
    const MassProperties known = mass_properties(model.bodies()[0].mass);
    const double a =
        -known.mass * 9.81 * lead / (known.inertia(2, 2) + known.mass * lead * lead);   // rad/s^2
    const double angle = 0.5 * a * t * t;
    return turned_state(t, {{angle, a * t, lead * angle, lead * a * t}}, {{}});
}

TEST(Couplings, AScrewHasOrder2pAndManyTurns)
{
    expect_order_2p(nut(), 1, nut_at(1), 1e-13, usual);
    const Solution far = solve_evenly(nut(), 8, 1000, 8);
    EXPECT_LE(distance(last(far), nut_at(8)).X, 1e-9);
    EXPECT_LE(last(far).X[0](2, 0), -100 * 2 * pi * lead) << "a hundred turns";
    EXPECT_LE(far.verdict.energy_drift, 1e-11);
    EXPECT_LE(far.verdict.violations.joints_at_nodes, 1e-12);
    EXPECT_LE(far.verdict.violations.velocity_level, 1e-10);
}

TEST(Couplings, AScrewIsFollowedByRadau)
{
    for (const auto& [degree, n] : {std::pair{2, std::vector{84, 101, 121}}, {3, {345, 414, 496}}}) {
        const Study s = radau_study(nut(), 1, nut_at(1), degree, n);
        EXPECT_NEAR(last_rate(s, &Distance::X, 0), 2 * degree - 1, 0.15) << "p = " << degree;
        EXPECT_NEAR(last_rate(s, &Distance::V, 0), 2 * degree - 1, 0.15) << "p = " << degree;
    }
}

TEST(Couplings, AnElementMayTurnByMoreThanAHalf)
{
    // at the end by two turns, of which its nodes make 16 steps
    const Solution coarse = solve_evenly(nut(), 4, 40, 16);
    ASSERT_TRUE(coarse.report.reached_end());
    EXPECT_LE(distance(last(coarse), nut_at(4)).X, 1e-8);
}

// --- two wheels, one of them out of balance

constexpr double teeth[2] = {20, 35};
const Vector3 hub{2, 0, 0};

Model wheels()
{
    Model model({0, -9.81, 0});
    model.add_body(rigid_body("one", with_center(with_mass(box(1, {0.5, 0.5, 0.1}), 3), {0.2, 0, 0}),
                              {.angular_velocity = {0, 0, 9}}));
    model.add_body(rigid_body("two", with_mass(box(1, {0.8, 0.8, 0.1}), 2),
                              {.position = hub, .angular_velocity = {0, 0, -9 * teeth[0] / teeth[1]}}));
    model.add_joint(revolute("first", world, 0, {}));
    model.add_joint(revolute("second", world, 1, {.point_first = hub}));
    Joint gear = revolute("gear", 0, 1, {});
    gear.type = "gear";
    gear.axis_first = gear.axis_second = {};
    gear.rows = {coupling_row({{teeth[0], angle_between(world, x_axis, y_axis, 0, x_axis)},
                               {teeth[1], angle_between(world, x_axis, y_axis, 1, x_axis)}},
                              0, 1, "teeth")};
    model.add_joint(gear);
    return model;
}

State wheels_at(double end, int n)
{
    const Model model = wheels();
    const MassProperties one = mass_properties(model.bodies()[0].mass),
                         two = mass_properties(model.bodies()[1].mass);
    const double k = teeth[0] / teeth[1], arm = 0.2;
    const double J = one.inertia(2, 2) + one.mass * arm * arm + k * k * two.inertia(2, 2);
    const auto slopes = [&](double, const Numbers& y) {
        return Numbers{y[1], -one.mass * 9.81 * arm * std::cos(y[0]) / J};
    };
    const Numbers y = extrapolated(slopes, {0, 9}, 0, end, n);
    return turned_state(end, {{y[0], y[1], 0, 0}, {-k * y[0], -k * y[1], 0, 0}}, {{}, hub});
}

TEST(Couplings, AGearPairHasOrder2pAndManyTurns)
{
    const double floor = distance(wheels_at(2, 60), wheels_at(2, 40)).V;
    EXPECT_LE(floor, 1e-11);
    expect_order_2p(
        wheels(), 2, wheels_at(2, 60), floor,
        {{1, {400, 480, 576, 691, 829}}, {2, {120, 144, 173, 207, 248}}, {3, {70, 84, 101, 121}}});
    const Solution far = solve_evenly(wheels(), 20, 500, 6);
    EXPECT_LE(distance(last(far), wheels_at(20, 600)).X, 1e-7) << "tens of turns";
    EXPECT_LE(far.verdict.energy_drift, 1e-9);
    EXPECT_LE(far.verdict.violations.joints_at_nodes, 1e-12);
}

TEST(Couplings, AStartOffTheTeethIsSeen)
{
    const Model model = wheels();
    State state = model.start();
    state.X[1] = configuration(hub, directors_from_rotation_vector({0, 0, 0.01}));
    try {
        consistent_start(model, state, StartPolicy::check);
        ADD_FAILURE() << "the wheels do not fit";
    } catch (const InputError& error) {
        EXPECT_EQ(error.complaint().code, "start-position");
    }
    const ConsistentStart closed = consistent_start(model, state, StartPolicy::project);
    EXPECT_LE(std::abs(constraint_value(model.row(10), closed.start.X)), 1e-13);
}

// --- a bead in a slot

/// An ellipse in the plane of x and z, lowest at s = -pi / 2.
CurvePoint ellipse(double s)
{
    const double c = std::cos(s), d = std::sin(s);
    CurvePoint at{{1.5 * c, 0, d}, {-1.5 * d, 0, c}, {-1.5 * c, 0, -d}, {}};
    at.normals = {(1 / norm(at.first)) * Vector3{at.first[2], 0, -at.first[0]}, Vector3{0, 1, 0}};
    return at;
}

Joint slot(int first, int second)
{
    Joint joint = spherical("slot", first, second, {});
    joint.type = "slot";
    joint.rows = curve_rows({ellipse, 0, 2 * pi, true}, first, second, point({}), 1);
    return joint;
}

constexpr double fast = 7;   // s' at the start: the bead goes round and round

Model bead()
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bead", 1.5, ellipse(0).x, fast * ellipse(0).first));
    model.add_joint(slot(world, 0));
    return model;
}

State bead_at(double end, int n)
{
    const auto slopes = [](double, const Numbers& y) {
        const CurvePoint at = ellipse(y[0]);
        return Numbers{y[1], -(dot(at.first, at.second) * y[1] * y[1] + 9.81 * at.first[2]) /
                                 dot(at.first, at.first)};
    };
    const Numbers y = extrapolated(slopes, {0, fast}, 0, end, n);
    const CurvePoint at = ellipse(y[0]);
    State state{end, {Matrix34{}}, {Matrix34{}}};
    state.X[0].set_column(0, at.x);
    state.V[0].set_column(0, y[1] * at.first);
    return state;
}

TEST(Couplings, ABeadOnAnEllipseHasOrder2p)
{
    const double floor = distance(bead_at(2, 100), bead_at(2, 70)).V;
    EXPECT_LE(floor, 1e-10);
    expect_order_2p(bead(), 2, bead_at(2, 100), floor,
                    {{1, {700, 840, 1008, 1210}}, {2, {250, 300, 360, 432}}, {3, {160, 192, 230, 276}}});
}

TEST(Couplings, ABeadInAFloatingPlateKeepsEnergyAndMomentum)
{
    Model model;
    model.add_body(
        rigid_body("plate", with_mass(box(1, {4, 0.1, 3}), 5), {.angular_velocity = {0.3, 1, -0.2}}));
    const CurvePoint at = ellipse(0.5);
    const Vector3 carried = cross(Vector3{0.3, 1, -0.2}, at.x);
    model.add_body(point_mass("bead", 2, at.x, carried + 3 * at.first));
    model.add_joint(slot(0, 1));
    const Solution run = solve_evenly(model, 4, 200, 6);
    EXPECT_LE(run.verdict.energy_drift, 1e-9);
    EXPECT_LE(run.verdict.linear_momentum_drift, 1e-13);
    EXPECT_LE(run.verdict.angular_momentum_drift, 1e-12);
    EXPECT_LE(run.verdict.violations.joints_at_nodes, 1e-13);
    EXPECT_LE(distance(last(run), last(solve_evenly(model, 4, 150, 8))).X, 1e-8);
    const Reaction held = sample_joints(model, run.motion, 2).front().right;
    EXPECT_GT(norm(held.force), 1);
    EXPECT_LE(norm(held.torque), 1e-12) << "a slot holds a point";
}

/// Rows that are no quadratic forms hold in all families.
TEST(Couplings, OtherMethodsTakeASlot)
{
    const State exact = bead_at(0.5, 100);
    Mixed linear;
    linear.degree = 1;
    const auto error = [&](const Method& method, int n) {
        SolveOptions options;
        options.estimate = SolveOptions::Estimate::none;
        const Solution run = solve(bead(), {bead().start()}, make_time_mesh(0, 0.5, n), method, options);
        EXPECT_TRUE(run.report.converged()) << name_of(method) << ": " << run.report.message;
        return distance(run.motion.at_end(n), exact).X;
    };
    for (const auto& [method, order] :
         {std::pair{Method{linear}, 2.0}, {Midpoint{}, 2.0}, {Endpoint{}, 1.0}}) {
        const double coarse = error(method, 160), fine = error(method, 320);
        EXPECT_NEAR(std::log2(coarse / fine), order, 0.2) << name_of(method);
    }
}

/// Turns are counted from node to node, which elements of the paper do not do.
TEST(Couplings, MixedRefusesWhatCountsTurns)
{
    Model model;
    for (const char* name : {"one", "other"}) {
        const int wheel = model.add_body(rigid_body(name, box(1, {0.1, 0.2, 0.3})));
        model.add_joint(revolute(name, world, wheel, {}));
    }
    const Joint one = model.joints()[0], other = model.joints()[1];
    model.add_joint(gear("teeth", one, other, 2, model.start().X));
    EXPECT_TRUE(solve(model, {model.start()}, make_time_mesh(0, 1, 10), Midpoint{}).report.converged());
    try {
        solve(model, {model.start()}, make_time_mesh(0, 1, 10), Mixed{});
        ADD_FAILURE() << "mixed took it";
    } catch (const InputError& error) {
        EXPECT_EQ(error.complaint().code, "joint-method");
    }
}

}   // namespace
}   // namespace livens::tests::couplings_test
