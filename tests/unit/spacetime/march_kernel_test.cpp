// SPDX-License-Identifier: BSD-3-Clause
// The kernel of a march against Newton's iteration with the real tangent, element by element.
#include "livens/spacetime/nodal/kernel/march_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/joints.h"
#include "livens/spacetime/instructions.h"
#include "livens/spacetime/nodal/system.h"
#include "livens/spacetime/solve.h"
#include "unit/multibody/random_states.h"
#include "unit/spacetime/mechanisms.h"

namespace livens {
namespace {

/// The state from which a march begins.
InstantState instant_state(const ModelTables& tables, const State& start)
{
    InstantState state;
    state.resize(tables);
    state.t = start.t;
    for (int b = 0; b < tables.n_bodies(); ++b) {
        std::copy_n(start.X[b].a, 12, state.X.begin() + 12 * b);
        const BodyTable& body = tables.bodies[b];
        const Vector3 v = start.V[b].column(0);
        const Vector3 w = body.dofs == 6 ? angular_velocity(start.X[b], start.V[b]) : Vector3{};
        for (int i = 0; i < body.dofs; ++i) state.velocity[body.first + i] = i < 3 ? v[i] : w[i - 3];
    }
    InstantSystem instant(tables, JointFactor::serves(tables));
    EXPECT_TRUE(instant.prepare(state, tables.independent));
    instant.add_basis(state);
    instant.from_velocity(state);
    std::vector<double> lambda(tables.rows.size());
    const std::vector<double> p = state.p;
    instant.from_momentum(state, p.data(), 1, lambda.data());
    instant.accelerate(state, Side::right);
    state.acceleration[0] = state.acceleration[1];
    return state;
}

struct Comparison {
    bool is_solved = false, has_reference = false;
    double X = 0, wrench = 0, momentum = 0;   // largest differences, see below
    double worst() const { return std::max({X, wrench, momentum}); }
};

double difference(const std::vector<double>& a, const std::vector<double>& b)
{
    double size = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (!(std::abs(a[i] - b[i]) <= size)) size = std::abs(a[i] - b[i]);
    return size;
}

double size_of(const std::vector<double>& a) { return difference(a, std::vector<double>(a.size(), 0.0)); }

/// From the balance of all rows, as Newton's iteration left them.
std::vector<double> end_momentum(const ModelTables& tables, const WindowLayout& stretch, NodalSystem& system,
                                 const InstantState& start)
{
    std::vector<double> p = start.p, wrench(p.size()), raw(12 * tables.bodies.size());
    for (const auto& body : tables.bodies)
        for (int i = 0; i < 3; ++i) p[body.first + i] += stretch.h(0) * body.weight[i];
    for (int A = 0; A <= stretch.degree; ++A) {
        std::fill(raw.begin(), raw.end(), 0.0);
        if (!tables.model->loads().empty())
            std::copy_n(system.balances().loads().forces(0, A), raw.size(), raw.begin());
        if (A < stretch.degree)
            system.balances().subtract(system.nodes().basis(A), system.balances().impulses(A), raw.data());
        tables.bodies.twist_rows(system.nodes().X(A), system.nodes().maps(A), raw.data(), wrench.data());
        for (std::size_t i = 0; i < p.size(); ++i) p[i] += wrench[i];
    }
    return p;
}

/// Twist rows of G^T impulses at node A, with the opposite sign.
std::vector<double> taken_by(const ModelTables& tables, NodalSystem& system, const double* impulses, int A)
{
    std::vector<double> raw(12 * tables.bodies.size(), 0.0),
        wrench(static_cast<std::size_t>(tables.n_twists));
    system.balances().subtract(system.nodes().basis(A), impulses, raw.data());
    tables.bodies.twist_rows(system.nodes().X(A), system.nodes().maps(A), raw.data(), wrench.data());
    return wrench;
}

/// What constraints at X allow of a momentum, which is what is handed on; scaled rows.
std::vector<double> tangent_part(const ModelTables& tables, double t, const double* X,
                                 const std::vector<double>& momentum)
{
    InstantSystem instant(tables);
    InstantState state;
    state.resize(tables);
    state.t = t;
    std::copy_n(X, state.X.size(), state.X.begin());
    EXPECT_TRUE(instant.prepare(state, tables.independent));
    std::vector<double> lambda(tables.rows.size());
    instant.from_momentum(state, momentum.data(), 1, lambda.data());
    return state.momentum;
}

/// One element of length h by both; `fault` is added to one entry k_AB of the kernel's rule. `kernels`: the
/// model as the kernel sees it, if that is another one.
Comparison compare(const Model& model, int degree, double h, double fault = 0, const Model* kernels = nullptr)
{
    const ConsistentStart closed = consistent_start(model, model.start(), StartPolicy::project);
    const ModelTables tables(model, closed.independent);
    const ElementRule rule = lobatto_rule(degree);
    ElementRule kernels_rule = rule;
    kernels_rule.k[static_cast<std::size_t>(rule.size() + 1)] += fault;
    const InstantState start = instant_state(tables, closed.start);
    WindowLayout stretch;
    stretch.times = {start.t, start.t + h};
    stretch.degree = degree;
    stretch.angles = tables.loads.turns.begin();

    NodalSystem system(tables, rule);
    Series series(tables, rule);
    system.open(stretch, &start, nullptr);
    series.place(system, start);
    EXPECT_TRUE(system.settle());
    Newton newton;
    if (newton.run(system, {1e-14, 30, {}}).status != SolveStatus::converged) return {};

    const ModelTables kernels_tables(kernels != nullptr ? *kernels : model, closed.independent);
    MarchKernel kernel(kernels_tables, kernels_rule);
    EXPECT_TRUE(kernel.serves());
    NewtonReport report;
    Comparison found;
    found.has_reference = true;
    found.is_solved = kernel.solve(stretch, start, {1e-14, 30, {}}, false, report);
    if (!found.is_solved) return found;
    Nodes nodes(tables, kernels_rule);
    nodes.open(stretch);
    nodes.fix(0, start);
    nodes.place_solved(kernel.increments(), kernel.width());
    const std::size_t n = 12 * tables.bodies.size();
    std::vector<double> impulses(static_cast<std::size_t>(tables.rank)),
        p(static_cast<std::size_t>(tables.n_twists)), p_newton = p;
    const auto wrench_of = [&](const double* of_rows, int A) { return taken_by(tables, system, of_rows, A); };
    for (int A = 0; A <= degree; ++A) {
        const double *dX = nodes.dX(0, A), *other = system.nodes().dX(0, A);
        found.X =
            std::max(found.X, difference({dX, dX + n}, {other, other + n}) / std::max(1.0, tables.length));
        if (A == degree) break;
        // multipliers of rows that nearly depend on each other are those of no one; what they do is
        kernel.impulses(A, impulses.data());
        const std::vector<double> ours = wrench_of(impulses.data(), A);
        found.wrench = std::max(found.wrench, difference(ours, wrench_of(system.balances().impulses(A), A)));
    }
    kernel.momentum(stretch, start, p.data());
    const auto tangent = [&](const std::vector<double>& momentum) {
        return tangent_part(tables, start.t + h, system.nodes().X(degree), momentum);
    };
    p_newton = end_momentum(tables, stretch, system, start);
    const double size = std::max({size_of(start.p), size_of(p), 1.0});   // masses and speeds are of size 1
    double pivot = 1;
    for (int A = 0; A <= degree; ++A) pivot = std::min(pivot, kernel.pivot(A));
    // rows are sums of such terms, and multipliers the worse known the more the rows depend on each other
    found.wrench *= pivot / (size * *std::max_element(rule.k.begin(), rule.k.end()));
    found.momentum = difference(tangent(p), tangent(p_newton)) / size;
    return found;
}

MassProperties any_mass(Random& random)
{
    MassProperties properties = with_mass(
        box(1, {1 + 0.5 * random.number(), 0.6 + 0.3 * random.number(), 0.4 + 0.2 * random.number()}),
        1 + 0.5 * random.number());
    if (random.number() > 0) {
        const Matrix3 R = random.rotation();
        properties.inertia = R * properties.inertia * transpose(R);
        properties.inertia = 0.5 * (properties.inertia + transpose(properties.inertia));
    }
    if (random.number() > 0) properties = with_center(properties, 0.3 * random.vector());
    return properties;
}

Joint any_joint(Random& random, const Model& model, int first, int second, const std::string& name)
{
    const auto X = [&](int b) { return b == world ? world_configuration : model.bodies()[b].X; };
    const bool has_point =
        (first != world && model.bodies()[first].is_point) || model.bodies()[second].is_point;
    const int kind = has_point ? 4 : static_cast<int>(6.5 * (1 + random.number()));
    const Vector3 at = 0.5 * (X(first).column(0) + X(second).column(0)) + 0.3 * random.vector();
    const Vector3 axis = random.unit();
    JointFrame frame = joint_frame(X(first), X(second), at, axis);
    if (kind == 0) return weld(name, first, second, frame, X(first), X(second));
    if (kind == 1) return revolute(name, first, second, frame);
    if (kind == 3) return spherical(name, first, second, frame);
    if (kind == 5) return prismatic(name, first, second, frame, X(first), X(second));
    if (kind == 6) return cylindrical(name, first, second, frame);
    if (kind == 7) return planar(name, first, second, frame);
    if (kind == 8) return constant_velocity(name, first, second, frame, X(first), X(second));
    if (kind == 9) return point_on_line(name, first, second, frame);
    if (kind == 10) return point_in_plane(name, first, second, frame);
    if (kind == 11) return parallel_axes(name, first, second, frame);
    if (kind == 12) {
        frame.axis_second = joint_frame(X(first), X(second), at, random.unit()).axis_second;
        return constant_angle(
            name, first, second, frame,
            std::acos(dot(X(first) * direction(frame.axis_first), X(second) * direction(frame.axis_second))));
    }
    if (kind == 2) {
        Vector3 across = cross(axis, random.unit());
        frame.axis_second = joint_frame(X(first), X(second), at, 1 / norm(across) * across).axis_second;
        return universal(name, first, second, frame);
    }
    frame = {};
    if (first != world && !model.bodies()[first].is_point) frame.point_first = 0.4 * random.vector();
    if (!model.bodies()[second].is_point) frame.point_second = 0.4 * random.vector();
    return rod(name, first, second, frame,
               norm(X(second) * point(frame.point_second) - X(first) * point(frame.point_first)));
}

/// A tree with perhaps loops, rows stated twice, point masses, springs, dampers and torques.
Model any_mechanism(Random& random)
{
    Model model({0, 0, -9.81});
    const int n = 2 + static_cast<int>(2.5 * (1 + random.number()));
    const auto any_of = [&](int count) { return static_cast<int>(0.5 * count * (1 + random.number())); };
    for (int b = 0; b < n; ++b) {
        const std::string name = "body " + std::to_string(b);
        const Vector3 place = 2.0 * random.vector();
        if (b > 0 && random.number() > 0.6)
            model.add_body(point_mass(name, 1 + 0.5 * random.number(), place, random.vector()));
        else
            model.add_body(rigid_body(name, any_mass(random),
                                      {place, random.rotation(), random.vector(), random.vector()}));
        if (b > 0 || random.number() > -0.5)
            model.add_joint(any_joint(random, model, b == 0 ? world : any_of(b + 1) - 1, b, "joint " + name));
    }
    if (n > 2 && random.number() > 0) {   // a loop
        const int first = any_of(n - 1);
        model.add_joint(any_joint(random, model, first, n - 1, "closing"));
    }
    if (random.number() > 0.3 && !model.joints().empty()) {   // said again: redundant
        Joint again = model.joints()[any_of(static_cast<int>(model.joints().size()))];
        again.name = "again";
        model.add_joint(again);
    }
    if (random.number() > 0)
        model.add_load(spring_damper("spring", world, random.vector(), n - 1, {}, {20, 1, 0.3}));
    if (random.number() > 0)
        model.add_load(torque("torque", 0, {random.number(), 2.0, random.number()},
                              random.number() > 0 ? Frame::body_fixed : Frame::inertial));
    if (random.number() > 0)
        model.add_load(
            point_force("force", 0, random.vector(), {random.number(), 2.0, 1.0}, Frame::body_fixed));
    return model;
}

/// Of many random mechanisms, those that have a start and that both solve.
std::vector<double> differences(int n, double fault, int& unsolved)
{
    Random random(7);
    std::vector<double> found;
    while (std::ssize(found) + unsolved < n) {
        const Model model = any_mechanism(random);
        const int degree = 1 + static_cast<int>(5 * (1 + random.number()));
        const double h = 0.02 + 0.015 * random.number();
        try {
            const Comparison comparison = compare(model, degree, random.number() > -0.7 ? h : -h, fault);
            if (comparison.is_solved)
                found.push_back(comparison.worst());
            else
                ++unsolved;
        } catch (const InputError&) {   // overdetermined: no start
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

/// Springs so stiff that steps of free bodies do not shrink: at coordinates of joints, between any two bodies
/// and to the world, where they are at rest.
void add_stiff_loads(Random& random, Model& model, bool have_slopes)
{
    const auto add = [&](Load load) {
        if (!have_slopes)
            load.tangent = [](const LoadArguments&, LoadTangent&) {};
        model.add_load(load);
    };
    const std::vector<Matrix34> X = model.start().X;
    for (std::size_t j = 0; j < model.joints().size(); ++j)
        for (const NamedCoordinate& q : model.joints()[j].coordinates)
            if (random.number() > -0.5)
                add(joint_spring("at " + q.name + std::to_string(j), q, {3e4, 2, q.at_stated, 0.1}, X));
    const int n = static_cast<int>(model.bodies().size());
    for (const int other : {world, 0}) {
        if (other == n - 1) continue;
        const Vector3 from = 3.0 * random.unit();
        const Vector3 way = X[static_cast<std::size_t>(n - 1)].column(0) -
                            (other == world ? world_configuration : X[0]) * point(from);
        add(spring_damper("from " + std::to_string(other), other,
                          other != world && model.bodies()[0].is_point ? Vector3{} : from, n - 1, {},
                          {5e4, 1, norm(way)}));
    }
}

/// How many elements with stiff loads are solved, of n that Newton solves; `found`: their differences.
int solved_with_stiff_loads(int n, bool have_slopes, std::vector<double>& found)
{
    Random random(11);
    for (int tried = 0; tried < n;) {
        Model model = any_mechanism(random);
        const int degree = 2 + static_cast<int>(3.5 * (1 + random.number()));
        const double h = (random.number() > -0.7 ? 1 : -1) * (0.02 + 0.015 * random.number());
        try {
            Model blunt = model;
            Random same = random;
            add_stiff_loads(same, blunt, false);
            add_stiff_loads(random, model, true);
            const Comparison comparison = compare(model, degree, h, 0, have_slopes ? nullptr : &blunt);
            tried += comparison.has_reference ? 1 : 0;
            if (comparison.is_solved) found.push_back(comparison.worst());
        } catch (const InputError&) {   // overdetermined: no start
        }
    }
    std::sort(found.begin(), found.end());
    return static_cast<int>(found.size());
}

/// With each set of instructions that the processor has.
template <class Act>
void with_all_instructions(const Act& act)
{
    const Instructions before = instructions();
    for (const Instructions set : {Instructions::sse2, Instructions::avx2, Instructions::avx512}) {
        if (!use_instructions(set)) continue;
        SCOPED_TRACE(to_string(set));
        act();
    }
    use_instructions(before);
}

TEST(MarchKernel, AgreesWithNewtonOnRandomMechanisms)
{
    with_all_instructions([] {
        int unsolved = 0;
        const std::vector<double> found = differences(300, 0, unsolved);
        EXPECT_LT(unsolved, 30);
        ASSERT_GT(found.size(), 250U);
        EXPECT_LT(found[found.size() / 2], 1e-14);
        EXPECT_LT(found.back(), 1e-13);
    });
}

TEST(MarchKernel, StiffLoadsAreSolvedWithTheirSlopes)
{
    with_all_instructions([] {
        std::vector<double> found, without;
        EXPECT_GT(solved_with_stiff_loads(150, true, found), 125);
        EXPECT_LT(found[found.size() / 2], 5e-13);   // forces of 5e4 N a metre, of which digits are left
        EXPECT_LT(found.back(), 1e-11);
        EXPECT_LT(solved_with_stiff_loads(150, false, without), 75) << "negative control";
    });
}

TEST(MarchKernel, AFaultInOneLaneShows)
{
    with_all_instructions([] {
        int unsolved = 0;
        const std::vector<double> found = differences(100, 1e-9, unsolved);
        ASSERT_GT(found.size(), 50U);
        EXPECT_GT(found[found.size() / 2], 1e-13);
    });
}

// What is solved at an instant by elimination along the joints is what orthogonal bases say.
TEST(JointFactor, AgreesWithOrthogonalBases)
{
    const Model model = testing_models::everything();
    const ConsistentStart closed = consistent_start(model, model.start(), StartPolicy::project);
    const ModelTables tables(model, closed.independent);
    InstantState states[2];
    std::vector<double> lambda[2];
    for (const bool sparse : {false, true}) {
        InstantSystem instant(tables, sparse);
        InstantState& state = states[sparse ? 1 : 0];
        state.resize(tables);
        for (int b = 0; b < tables.n_bodies(); ++b)
            std::copy_n(closed.start.X[b].a, 12, state.X.begin() + 12 * b);
        for (std::size_t i = 0; i < state.velocity.size(); ++i)
            state.velocity[i] = std::sin(1.0 + static_cast<double>(i));
        ASSERT_TRUE(instant.prepare(state, tables.independent));
        EXPECT_EQ(state.held.by_joints, sparse);
        EXPECT_EQ(state.held.has_basis, !sparse);
        instant.from_velocity(state);
        const std::vector<double> p = state.p;
        lambda[sparse ? 1 : 0].resize(tables.rows.size());
        instant.from_momentum(state, p.data(), 0.01, lambda[sparse ? 1 : 0].data());
        instant.accelerate(state, Side::right);
    }
    EXPECT_LT(difference(states[0].velocity, states[1].velocity), 1e-14);
    EXPECT_LT(difference(states[0].p, states[1].p), 1e-14);
    EXPECT_LT(difference(lambda[0], lambda[1]), 1e-12);
    EXPECT_LT(difference(states[0].acceleration[1], states[1].acceleration[1]),
              1e-14 * size_of(states[0].acceleration[1]));
    EXPECT_LT(difference(states[0].multipliers[1], states[1].multipliers[1]), 1e-12);
    EXPECT_GT(size_of(lambda[0]), 0.1);
}

// What is left cannot fall below a tolerance below rounding: steps that have shrunk, and stop, are done.
TEST(MarchKernel, StepsThatMeetTheirRoundingAreDone)
{
    SolveOptions options;
    options.judge = false;
    options.tolerance = 1e-15;
    Model pendulum({0, 0, -9.81});
    pendulum.add_body(rigid_body("bar", with_center(box(50, {1, 0.2, 0.1}), {0.5, 0, 0})));
    pendulum.add_joint(spherical("ball", world, 0, {}));
    const Solution s = solve(pendulum, {pendulum.start()}, make_time_mesh(0, 5, 100), Lobatto{6}, options);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_EQ(s.report.factorisations, 0);
}

/// P16 with axes in its bodies that are turned by R from those of their edges; steps of 80 elements to 2 s.
int steps_of_bricks(const Matrix3& R, int degree)
{
    Model model({0, 0, -9.81});
    const Model bricks = testing_models::two_bricks();
    for (int b = 0; b < 2; ++b) {
        const Body& body = bricks.bodies()[b];
        const MassProperties own = mass_properties(body.mass);
        const MassProperties turned{own.mass, transpose(R) * own.center_of_mass,
                                    transpose(R) * own.inertia * R};
        Placement placement;
        placement.position = body.X.column(0);
        placement.directors = directors(body.X) * R;
        model.add_body(rigid_body(body.name, turned, placement));
    }
    const Vector3 tip = transpose(R) * Vector3{1, 0, 0};
    model.add_joint(spherical("root", world, 0, {}));
    model.add_joint(spherical("elbow", 0, 1, {.point_first = tip, .point_second = {}}));
    SolveOptions options;
    options.judge = false;
    const Solution s = solve(model, {model.start()}, make_time_mesh(0, 2, 80), Lobatto{degree}, options);
    EXPECT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_EQ(s.report.factorisations, 0);
    return std::accumulate(s.report.iterations.begin(), s.report.iterations.end(), 0);
}

// Turns in still axes, where inertia has no gyroscopic term.
// In those of the bodies it takes 458 and 392 steps.
TEST(MarchKernel, GyroscopicTermsCostNoSteps)
{
    const int six = steps_of_bricks(identity<3>(), 6), eight = steps_of_bricks(identity<3>(), 8);
    EXPECT_LE(six, 340);
    EXPECT_LE(eight, 295);
    // whatever axes a body is described in
    const Matrix3 R = directors_from_rotation_vector({0.4, -0.7, 1.1});
    EXPECT_NEAR(steps_of_bricks(R, 6), six, 8);
    EXPECT_NEAR(steps_of_bricks(R, 8), eight, 8);
}

// Where nothing is compared, the iteration of an element ends at the tolerance that was asked for.
TEST(MarchKernel, EndsAtTheToleranceUnlessMotionsAreCompared)
{
    const Model model = testing_models::two_bricks();
    SolveOptions options;
    options.judge = false;
    const auto run = [&](double tolerance, SolveOptions::Estimate estimate) {
        options.tolerance = tolerance;
        options.estimate = estimate;
        return solve(model, {model.start()}, make_time_mesh(0, 1, 20), Lobatto{8}, options);
    };
    const auto off = [](const Solution& a, const Solution& b) {
        double far = 0;
        for (int body = 0; body < 2; ++body)
            far = std::max(far, norm(a.motion.at_end(20).X[body] - b.motion.at_end(20).X[body]));
        return far;
    };
    using enum SolveOptions::Estimate;
    const Solution best = run(1e-14, none), ten = run(1e-10, second);
    for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-8}) {
        const Solution loose = run(tolerance, none);
        EXPECT_LT(10 * loose.report.evaluations, 9 * best.report.evaluations);
        EXPECT_LT(off(loose, best), 30 * tolerance) << tolerance;   // of 20 elements, grown
        EXPECT_GT(off(loose, best), 1e-4 * tolerance) << tolerance;
        EXPECT_EQ(off(run(tolerance, second), ten), 0) << "an estimate would compare it";
        EXPECT_EQ(off(run(tolerance, local), ten), 0);
    }
}

// Elements so long that steps grow: those of many bodies are combined, and say what Newton's iteration says.
TEST(MarchKernel, ManyBodiesOnLongElementsNeedNoTangent)
{
    Model chain({0, 0, -9.81});
    for (int b = 0; b < 25; ++b) {
        Placement placement;
        placement.position = {static_cast<double>(b), 0, 0};
        chain.add_body(
            rigid_body(std::to_string(b), with_center(box(50, {1, 0.2, 0.1}), {0.5, 0, 0}), placement));
        JointFrame frame;
        frame.point_first = {b > 0 ? 1.0 : 0.0, 0, 0};
        chain.add_joint(spherical(std::to_string(b), b - 1, b, frame));
    }
    SolveOptions options;
    options.judge = false;
    State ends[2];
    for (const bool by_newton : {false, true}) {
        options.by_newton = by_newton;
        const Solution s = solve(chain, {chain.start()}, make_time_mesh(0, 1, 8), Lobatto{4}, options);
        ASSERT_TRUE(s.report.converged()) << s.report.message;
        EXPECT_EQ(s.report.factorisations > 0, by_newton);
        EXPECT_EQ(s.motion.n_elements(), 8);
        // beyond what single steps may take
        EXPECT_GT(s.report.most_iterations, by_newton ? 1 : 10);
        ends[by_newton ? 1 : 0] = s.motion.at_end(8);
    }
    for (int b = 0; b < chain.n_bodies(); ++b) {
        EXPECT_LT(norm(ends[0].X[b] - ends[1].X[b]), 1e-11) << b;
        EXPECT_LT(norm(ends[0].V[b] - ends[1].V[b]), 1e-9) << b;
    }
}

/// A tangent of sixty bodies costs hundreds of elements without one: elements are shortened instead, of the
/// motion and of the second solution on its elements.
TEST(MarchKernel, LongChainsToAnAccuracyNeedNoTangent)
{
    const int n = 60;
    Model model({0, 0, -9.81});
    Vector3 x{};
    for (int b = 0; b < n; ++b) {   // in a zigzag
        Placement placement;
        placement.position = x;
        if (b % 2 == 1) placement.directors = Matrix3{0, 1, 0, -1, 0, 0, 0, 0, 1};
        model.add_body(
            rigid_body(std::to_string(b), with_center(box(50, {1, 0.2, 0.1}), {0.5, 0, 0}), placement));
        model.add_joint(spherical(std::to_string(b), b - 1, b, {.point_first = {b > 0 ? 1.0 : 0.0, 0, 0}}));
        x = x + (b % 2 == 1 ? Vector3{0, 1, 0} : Vector3{1, 0, 0});
    }
    SolveOptions options;
    options.judge = false;
    const Solution s =
        solve(model, {model.start()}, Span{.start = 0, .end = 1, .accuracy = 1e-4}, Lobatto{}, options);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_EQ(s.report.factorisations, 0);
    EXPECT_LT(s.report.evaluations, 4000) << "some twenty elements of eight nodes and twenty steps";
    TimeMesh mesh = s.motion.mesh;
    mesh.required.clear();
    const Solution second = solve(model, {model.start()}, mesh, Lobatto{9}, options);
    ASSERT_TRUE(second.report.converged()) << second.report.message;
    EXPECT_EQ(second.report.factorisations, 0);
}

// Room and work grow with the bodies: dense bases of 300 would take gigabytes at the nodes alone.
TEST(MarchKernel, SolvesLongChains)
{
    const int n = 300;
    Model model({0, 0, -9.81});
    const MassProperties brick = with_center(box(50, {1, 0.2, 0.1}), {0.5, 0, 0});
    for (int b = 0; b < n; ++b) {
        Placement placement;
        placement.position = {static_cast<double>(b), 0, 0};
        model.add_body(rigid_body("body " + std::to_string(b), brick, placement));
        JointFrame frame;
        frame.point_first = {b > 0 ? 1.0 : 0.0, 0, 0};
        model.add_joint(spherical("joint " + std::to_string(b), b - 1, b, frame));
    }
    SolveOptions options;
    options.judge = false;
    const Solution s = solve(model, {model.start()}, make_time_mesh(0, 0.02, 2), Lobatto{4}, options);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_EQ(s.report.factorisations, 0);
    for (int b = 1; b < n; ++b) {
        const State end = s.motion.at_end(2);
        EXPECT_LT(norm(end.X[b - 1] * point({1, 0, 0}) - end.X[b].column(0)), 1e-12 * n);
    }
}

}   // namespace
}   // namespace livens
