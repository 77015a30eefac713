// SPDX-License-Identifier: BSD-3-Clause
#include "unit/spacetime/kernel_comparison.h"

#include <cmath>
#include <string>

#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/joints.h"
#include "livens/spacetime/nodal/kernel/march_kernel.h"
#include "livens/spacetime/nodal/system.h"

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

/// Of what is handed on, if the kernel has the momentum p at the end.
double difference_of_momenta(const ModelTables& tables, const WindowLayout& stretch,
                             const InstantState& start, NodalSystem& system, const std::vector<double>& p)
{
    const auto tangent = [&](const std::vector<double>& momentum) {
        return tangent_part(tables, stretch.times[1], system.nodes().X(stretch.degree), momentum);
    };
    return difference(tangent(p), tangent(end_momentum(tables, stretch, system, start)));
}

/// Of slopes, where the element that was solved last is solved once more.
int factors_of_another(MarchKernel& kernel, const WindowLayout& stretch, const InstantState& start)
{
    NewtonReport report;
    return kernel.solve(stretch, start, {1e-14, 30, {}}, false, report) ? report.slope_factors : 1;
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

}   // namespace

double difference(const std::vector<double>& a, const std::vector<double>& b)
{
    double size = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (!(std::abs(a[i] - b[i]) <= size)) size = std::abs(a[i] - b[i]);
    return size;
}

Comparison compare(const Model& model, int degree, double h, double fault, const Model* kernels,
                   Points points)
{
    const ConsistentStart closed = consistent_start(model, model.start(), StartPolicy::project);
    const ModelTables tables(model, closed.independent);
    const ElementRule rule = element_rule(points, degree);
    ElementRule kernels_rule = rule;
    kernels_rule.k[static_cast<std::size_t>(rule.size() + 1)] += fault;
    const InstantState start = instant_state(tables, closed.start);
    WindowLayout stretch;
    stretch.times = {start.t, start.t + h};
    stretch.degree = degree;
    stretch.points = points;
    stretch.angles = tables.loads.turns.begin();

    NodalSystem system(tables, rule);
    Series series(tables, rule);
    system.open(stretch, &start, nullptr);
    series.place(system, start);
    EXPECT_TRUE(system.settle());
    if (Newton newton; newton.run(system, {1e-14, 30, {}}).status != SolveStatus::converged) return {};

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
        p(static_cast<std::size_t>(tables.n_twists));
    const auto wrench_of = [&](const double* of_rows, int A) { return taken_by(tables, system, of_rows, A); };
    for (int A = 0; A <= degree; ++A) {
        const double *dX = nodes.dX(0, A), *other = system.nodes().dX(0, A);
        found.X =
            std::max(found.X, difference({dX, dX + n}, {other, other + n}) / std::max(1.0, tables.length));
        if (!stretch.is_active(A)) continue;
        // multipliers of rows that nearly depend on each other are those of no one; what they do is
        kernel.impulses(A, impulses.data());
        const std::vector<double> ours = wrench_of(impulses.data(), A);
        found.wrench = std::max(found.wrench, difference(ours, wrench_of(system.balances().impulses(A), A)));
    }
    kernel.momentum(stretch, start, p.data());
    const double size = std::max({size_of(start.p), size_of(p), 1.0});   // masses and speeds are of size 1
    double pivot = 1;
    for (int A = 0; A <= degree; ++A) pivot = std::min(pivot, kernel.pivot(A));
    // rows are sums of such terms, and multipliers the worse known the more the rows depend on each other
    found.wrench *= pivot / (size * size_of(rule.k));
    if (points == Points::lobatto)
        found.momentum = difference_of_momenta(tables, stretch, start, system, p) / size;
    found.took_slopes = report.took_slopes;
    found.factors_again = factors_of_another(kernel, stretch, start);
    return found;
}

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

std::vector<double> differences(int n, double fault, int& unsolved, Points points)
{
    Random random(7);
    std::vector<double> found;
    while (std::ssize(found) + unsolved < n) {
        const Model model = any_mechanism(random);
        const int most = points == Points::lobatto ? 5 : 4;
        const int degree = 1 + static_cast<int>(most * (1 + random.number()));
        const double h = 0.02 + 0.015 * random.number();
        try {
            const double length = random.number() > -0.7 ? h : -h;
            const Comparison comparison = compare(model, degree, length, fault, nullptr, points);
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

}   // namespace livens
