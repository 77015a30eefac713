// SPDX-License-Identifier: BSD-3-Clause
// Joints that depend on time: order 2p at element ends, and motions that drives alone determine.
#include <numbers>

#include "convergence/studies.h"
#include "livens/base/error.h"
#include "livens/diagnostics/sample.h"
#include "newton_euler.h"

namespace livens::tests::drives_test {
namespace {

/// mean + amplitude sin(rate t).
TimeFunction wave(double mean, double amplitude, double rate)
{
    return {[=](Instant at) {
                return TimeValue{mean + amplitude * std::sin(rate * at.t),
                                 amplitude * rate * std::cos(rate * at.t),
                                 -amplitude * rate * rate * std::sin(rate * at.t)};
            },
            {}};
}

using Path = std::array<TimeFunction, 3>;

Vector3 at(const Path& path, double t, double TimeValue::*part)
{
    return {path[0]({t}).*part, path[1]({t}).*part, path[2]({t}).*part};
}

Joint bare(const std::string& name, int first, int second, const Vector3& point_first,
           const Vector3& point_second, std::vector<ConstraintRow> rows)
{
    Joint joint;
    joint.name = name;
    joint.type = "driven";
    joint.first = first;
    joint.second = second;
    joint.point_first = point_first;
    joint.point_second = point_second;
    joint.rows = std::move(rows);
    return joint;
}

/// Rates of X and V over the last two of five meshes; the errors stand above the witness' own.
void expect_order_2p(const Model& model, double end, const State& witness, double floor)
{
    for (const auto& [degree, n] : {std::pair{1, std::vector{150, 180, 216, 260, 312}},
                                    {2, {48, 58, 70, 84, 101}},
                                    {3, {26, 31, 37, 44, 53}}}) {
        const Study s = lobatto_study(model, end, {witness, {}}, degree, n);
        EXPECT_GE(s.error.back().V, 10 * floor) << "p = " << degree;
        EXPECT_NEAR(last_rate(s, &Distance::X, 0), 2 * degree, 0.15) << "p = " << degree;
        EXPECT_NEAR(last_rate(s, &Distance::V, 0), 2 * degree, 0.15) << "p = " << degree;
    }
}

void expect_fine(const Solution& fine, const State& witness)
{
    EXPECT_LE(distance(last(fine), witness).X, 1e-12);
    EXPECT_LE(distance(last(fine), witness).V, 1e-11);
}

// --- a pendulum whose pivot is led along a path

const Path path{wave(0, 0.3, 5), wave(0, 0.1, 3), wave(0, 0.2, 7)};
const Vector3 eye{0.1, -0.2, 0.6};   // of the brick

Model brick_at_origin(const Vector3& velocity_of_eye)
{
    const Vector3 w{0.6, 1.1, -0.7};
    Placement placement;
    placement.directors = directors_from_rotation_vector({0.3, -0.4, 0.8});
    placement.position = -(placement.directors * eye);
    placement.angular_velocity = w;
    placement.velocity = velocity_of_eye - cross(w, placement.directors * eye);
    Model model({0, 0, -9.81});
    model.add_body(
        rigid_body("brick", with_center(with_mass(box(1, {1, 0.6, 0.4}), 2), {0.3, 0.1, -0.05}), placement));
    return model;
}

Model led_pendulum()
{
    Model model = brick_at_origin(at(path, 0, &TimeValue::first));
    model.add_joint(
        bare("pivot", world, 0, {}, eye, driven_point_rows(world, point({}), 0, point(eye), path, 1)));
    return model;
}

/// In the frame of the pivot, which does not turn, there is one force more.
State led_witness(double end, int n)
{
    const Model at_rest = brick_at_origin({});
    const NewtonEuler witness(
        at_rest,
        [](double t, Movers& bodies) { bodies[0].force -= bodies[0].mass * at(path, t, &TimeValue::second); },
        {{world, {}, 0, eye}});
    State state = witness.run(0, end, n);
    state.X[0].set_column(0, state.X[0].column(0) + at(path, end, &TimeValue::value));
    state.V[0].set_column(0, state.V[0].column(0) + at(path, end, &TimeValue::first));
    return state;
}

TEST(Drives, APendulumOnADrivenPivotHasOrder2p)
{
    const State witness = led_witness(1, 60);
    const double floor = distance(led_witness(1, 40), witness).V;
    EXPECT_LE(floor, 1e-11);
    expect_order_2p(led_pendulum(), 1, witness, floor);
    expect_fine(solve_evenly(led_pendulum(), 1, 20, 8), witness);
}

TEST(Drives, AreFollowedByRadauWithOrder2pLess1)
{
    const State witness = led_witness(1, 60);
    for (const auto& [degree, n] :
         {std::pair{2, std::vector{48, 58, 70, 84, 101}}, {3, {26, 31, 37, 44, 53}}}) {
        const Study s = radau_study(led_pendulum(), 1, witness, degree, n);
        EXPECT_NEAR(last_rate(s, &Distance::X, 0), 2 * degree - 1, 0.15) << "p = " << degree;
        EXPECT_NEAR(last_rate(s, &Distance::V, 0), 2 * degree - 1, 0.15) << "p = " << degree;
    }
}

TEST(Drives, TheirPowerIsInTheBalance)
{
    const Model model = led_pendulum();
    const Solution coarse = solve_evenly(model, 1, 20, 4), fine = solve_evenly(model, 1, 20, 8);
    EXPECT_GT(std::abs(balance(model, fine.motion).work.back()), 1);
    EXPECT_LE(coarse.verdict.energy_drift, 1e-6);
    EXPECT_LE(fine.verdict.energy_drift, 1e-11);
    EXPECT_LE(fine.verdict.linear_momentum_drift, 1e-12);
    EXPECT_LE(fine.verdict.angular_momentum_drift, 1e-12);
    EXPECT_LE(fine.verdict.violations.joints_at_nodes, 1e-14);
    EXPECT_LE(fine.verdict.violations.velocity_level, 1e-12);
}

TEST(Drives, AMotionRunsBackward)
{
    const Model model = led_pendulum();
    const State end = last(solve_evenly(model, 1, 40, 6));
    SolveOptions options;
    options.tolerance = 1e-14;
    Conditions conditions;
    conditions.at_start = Known::nothing;
    conditions.at_end = Known::state;
    conditions.end = end;
    const Solution back = solve(model, {conditions}, make_time_mesh(0, 1, 40), Lobatto{6}, options);
    ASSERT_TRUE(back.report.converged()) << back.report.message;
    const Distance d = distance(back.motion.at_end(0), model.start());
    EXPECT_LE(d.X, 1e-11);
    EXPECT_LE(d.V, 1e-10);
}

TEST(Drives, PositionsAtBothEndsFindTheMotion)
{
    const Model model = led_pendulum();
    const Solution march = solve_evenly(model, 0.5, 10, 4);
    SolveOptions options;
    options.tolerance = 1e-13;
    Conditions conditions;
    conditions.at_start = conditions.at_end = Known::positions;
    conditions.start = model.start();
    conditions.end = last(march);
    conditions.start.V[0] = conditions.end.V[0] = {};
    const Solution both = solve(model, {conditions}, make_time_mesh(0, 0.5, 10), Lobatto{4}, options);
    ASSERT_TRUE(both.report.converged()) << both.report.message;
    const Distance d = distance(both.motion.at_end(0), model.start());
    EXPECT_LE(d.V, 1e-9);
}

// --- a mass on a rod whose length is driven

const TimeFunction length = wave(1, 0.25, 4);

Model mass_on_a_rod()
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("mass", 1.5, {0.6, 0, -0.8}, {0.6, 0.9, -0.8}));   // l' = 1 along the rod
    model.add_joint(
        bare("rod", world, 0, {}, {}, {driven_distance_row(world, point({}), 0, point({}), length, 1)}));
    return model;
}

/// lambda of (1/2 |x|^2 - 1/2 l^2) over the mass, from its second derivative.
double tension(double t, const Vector3& x, const Vector3& v)
{
    const TimeValue l = length({t});
    const Vector3 g{0, 0, -9.81};
    return (dot(x, g) + dot(v, v) - l.first * l.first - l.value * l.second) / (l.value * l.value);
}

State rod_witness(double end, int n)
{
    const auto slopes = [](double t, const Numbers& y) {
        const Vector3 x{y[0], y[1], y[2]}, v{y[3], y[4], y[5]};
        const Vector3 a = Vector3{0, 0, -9.81} - tension(t, x, v) * x;
        return Numbers{v[0], v[1], v[2], a[0], a[1], a[2]};
    };
    const Numbers y = extrapolated(slopes, {0.6, 0, -0.8, 0.6, 0.9, -0.8}, 0, end, n);
    State state{end, {Matrix34{}}, {Matrix34{}}};
    state.X[0].set_column(0, {y[0], y[1], y[2]});
    state.V[0].set_column(0, {y[3], y[4], y[5]});
    return state;
}

TEST(Drives, ARodOfDrivenLengthHasOrder2p)
{
    const State witness = rod_witness(1, 40);
    const double floor = distance(rod_witness(1, 60), witness).V;
    EXPECT_LE(floor, 1e-12);
    expect_order_2p(mass_on_a_rod(), 1, witness, floor);
    const Solution fine = solve_evenly(mass_on_a_rod(), 1, 20, 8);
    expect_fine(fine, witness);
    EXPECT_NEAR(fine.motion.end_multipliers.back(),
                1.5 * tension(1, witness.X[0].column(0), witness.V[0].column(0)), 1e-9);
}

// --- a link whose angle is driven: nothing is free

const TimeFunction angle = wave(0.4, 2, 3);
const Vector3 centre{0.5, 0, 0};

Placement of_the_link(double t)
{
    const TimeValue a = angle({t});
    Placement placement;
    placement.directors = directors_from_rotation_vector({0, 0, a.value});
    placement.angular_velocity = {0, 0, a.first};
    return placement;
}

Model driven_link(const Vector3& gravity)
{
    Model model(gravity);
    model.add_body(
        rigid_body("link", with_center(with_mass(box(1, {1, 0.2, 0.1}), 3), centre), of_the_link(0)));
    Joint joint = revolute("motor", world, 0, {});
    const Vector4 x = direction({1, 0, 0}), y = direction({0, 1, 0});
    joint.rows.push_back(driven_angle_row(0, x, world, x, y, angle));
    joint.branches.push_back(driven_angle_branch(0, x, world, x, y, angle));
    model.add_joint(joint);
    return model;
}

TEST(Drives, ALinkOfDrivenAngleMovesAsDriven)
{
    for (const double g : {0.0, 9.81}) {
        const Model model = driven_link({0, -g, 0});
        const Solution solution = solve_evenly(model, 2, 20, 3);
        EXPECT_EQ(solution.report.unknowns, 0);
        const MassProperties mass = mass_properties(model.bodies()[0].mass);
        const double J = mass.inertia(2, 2) + mass.mass * dot(centre, centre);
        for (const double t : solution.motion.mesh.ends) {
            const State state = solution.motion.at(t);
            const Placement exact = of_the_link(t);
            EXPECT_LE(norm(directors(state.X[0]) - exact.directors), 1e-14) << t;
            EXPECT_LE(norm(state.V[0] - rate(state.X[0], {}, exact.angular_velocity)), 2e-13) << t;
            const Reaction motor = sample_joints(model, solution.motion, t).front().right;
            const double weight = mass.mass * g * centre[0] * std::cos(angle({t}).value);
            EXPECT_NEAR(motor.torque[2], J * angle({t}).second + weight, 1e-11) << t;
        }
    }
}

// --- starts and refusals

TEST(Drives, AStartMustMoveAsDriven)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("mass", 1.5, {0.6, 0, -0.8}));
    model.add_joint(
        bare("rod", world, 0, {}, {}, {driven_distance_row(world, point({}), 0, point({}), length, 1)}));
    try {
        consistent_start(model, model.start(), StartPolicy::check);
        ADD_FAILURE() << "a start at rest was taken";
    } catch (const InputError& error) {
        EXPECT_EQ(error.complaint().code, "start-velocity");
    }
    const ConsistentStart closed = consistent_start(model, model.start(), StartPolicy::project);
    EXPECT_LE(norm(closed.start.V[0].column(0) - Vector3{0.6, 0, -0.8}), 1e-15);
    State later = model.start();
    later.t = 0.2;
    const ConsistentStart moved = consistent_start(model, later, StartPolicy::project);
    EXPECT_NEAR(norm(moved.start.X[0].column(0)), length({0.2}).value, 1e-15);
    EXPECT_NEAR(norm(moved.start.V[0].column(0)), std::abs(length({0.2}).first), 1e-14);
}

TEST(Drives, TheOtherBranchOfAnAngleIsRefused)
{
    const Model model = driven_link({});
    State turned = model.start();
    turned.X[0] = configuration({}, directors_from_rotation_vector({0, 0, 0.4 + std::numbers::pi}));
    turned.V[0] = rate(turned.X[0], {}, {0, 0, 6});
    try {
        consistent_start(model, turned, StartPolicy::check);
        ADD_FAILURE() << "half a turn was not seen";
    } catch (const InputError& error) {
        EXPECT_EQ(error.complaint().code, "joint-branch");
    }
}

TEST(Drives, OtherMethodsRefuseThem)
{
    const Model model = driven_link({});
    for (const Method& method : {Method{Mixed{}}, Method{Midpoint{}}, Method{Endpoint{}}}) {
        try {
            solve(model, {model.start()}, make_time_mesh(0, 1, 10), method);
            ADD_FAILURE() << name_of(method) << " took it";
        } catch (const InputError& error) {
            EXPECT_EQ(error.complaint().code, "drives-method");
        }
    }
}

}   // namespace
}   // namespace livens::tests::drives_test
