// SPDX-License-Identifier: BSD-3-Clause
// What one pass tells of a motion is, point by point, what the definitions say: for mechanisms and motions
// that are random.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/sample.h"
#include "livens/time/time_laws.h"
#include "unit/diagnostics/hand_made.h"
#include "unit/multibody/random_states.h"

namespace livens::pass_test {
namespace {

/// A few bodies with a joint of another kind between each two: rows that are quadratic forms, others, and
/// rows that depend on time.
Model random_model(Random& random, unsigned kind)
{
    Model model(random.vector());
    for (int b = 0; b < 4; ++b) {
        Placement place;
        place.position = random.vector();
        place.directors = random.rotation();
        if (b == 2 && kind % 3 == 0)
            model.add_body(point_mass("p", 1.5, place.position));
        else
            model.add_body(rigid_body("b" + std::to_string(b), hand_made::skew_properties(), place));
    }
    const auto frame = [&](int first, int second) {
        const Matrix34 X = first == world ? world_configuration : model.bodies()[first].X;
        return joint_frame(X, model.bodies()[second].X, random.vector(), random.unit());
    };
    const auto X = [&](int b) { return model.bodies()[b].X; };
    model.add_joint(revolute("hinge", world, 0, frame(world, 0), 0.7));
    if (kind % 2 == 0) model.add_joint(screw("screw", 0, 1, frame(0, 1), X(0), X(1), 0.3));
    if (kind % 2 == 1) model.add_joint(prismatic("slide", 0, 1, frame(0, 1), X(0), X(1), 2));
    Joint ball = spherical("ball", 1, 2, frame(1, 2));
    if (kind % 5 == 4) ball.from = 0.9, ball.until = 1.4;   // not all of the time
    model.add_joint(ball);
    model.add_joint(rod("rod", world, 3, frame(world, 3), 0.8));
    Joint driven;
    driven.name = "driven";
    driven.type = "rod";
    driven.first = 0, driven.second = 3;
    driven.rows = {
        driven_distance_row(0, point({}), 3, point({0.1, 0, 0.2}), shifted(harmonic(0.1, 0.5, 0.3), 1), 1)};
    model.add_joint(driven);
    if (kind % 4 == 3 || kind % 12 == 8 || kind % 24 == 14) return model;
    model.add_load(spring_damper("spring", 0, random.vector(), 3, random.vector(), {30, 2, 0.1}));
    model.add_load(torque("torque", 1, {1.0, -2.0, 0.5}, Frame::body_fixed));
    return model;
}

Motion random_motion(Random& random, const Model& model, unsigned kind)
{
    Motion m;
    m.n_bodies = model.n_bodies();
    m.n_rows = model.n_rows();
    m.mesh.ends = {0.5};
    for (unsigned e = 0; e < 3 + 11 * (kind % 4); ++e)
        m.mesh.ends.push_back(m.mesh.ends.back() + 0.3 + 0.2 * random.number());
    const int n = m.n_elements(), p = 1 + static_cast<int>(kind % 7);
    const auto numbers = [&](std::size_t size) {
        std::vector<double> all(size);
        for (double& x : all) x = random.number();
        return all;
    };
    const auto bodies = static_cast<std::size_t>(m.n_bodies), rows = static_cast<std::size_t>(m.n_rows);
    m.X = {12 * m.n_bodies, p, kind % 5 != 0, {}, {}, kind % 3 == 1 ? Points::radau : Points::lobatto};
    m.X.values = numbers(12 * bodies * static_cast<std::size_t>(m.X.index(n - 1, p) + 1));
    m.multipliers = {m.n_rows, p,         false, numbers(rows * static_cast<std::size_t>(n * (p + 1))),
                     {},       m.X.points};
    m.constraints_hold = ConstraintsHold::at_nodes;
    m.order_at_ends = 2 * p;
    if (kind % 6 == 2) {
        m.gauss_points = kind % 12 == 2 ? p + 1 : std::max(1, p - 1);
        m.constraints_hold = kind % 4 == 0 ? ConstraintsHold::weakly : ConstraintsHold::at_nodes;
    }
    for (std::size_t i = 0; i < bodies * m.mesh.ends.size(); ++i) {
        m.velocities.push_back(random.matrix<3, 4>());
        m.momenta.push_back(random.matrix<3, 4>());
    }
    return m;
}

std::vector<Matrix34> bodies_of(const std::vector<double>& numbers, double factor = 1)
{
    std::vector<Matrix34> all(numbers.size() / 12);
    for (std::size_t i = 0; i < numbers.size(); ++i) all[i / 12].a[i % 12] = factor * numbers[i];
    return all;
}

/// Fields at any place by Field alone.
struct At {
    std::vector<Matrix34> X, V;
    std::vector<double> lambda;
    Instant instant;

    At(const Motion& m, int e, double s) : lambda(static_cast<std::size_t>(m.n_rows))
    {
        std::vector<double> x(static_cast<std::size_t>(m.X.n_values)), v(x);
        m.X.evaluate(e, s, 0, x);
        m.X.evaluate(e, s, 1, v);
        X = bodies_of(x);
        V = bodies_of(v, 1 / m.mesh.length(e));
        m.multipliers.evaluate(e, s, 0, lambda);
        instant = {m.mesh.ends[e] + s * m.mesh.length(e), s == 0   ? Side::right
                                                          : s == 1 ? Side::left
                                                                   : Side::middle};
    }
};

Quadrature rule_of(const Motion& m, bool of_joints)
{
    const bool is_nodal =
        m.gauss_points == 0 || (of_joints && m.constraints_hold == ConstraintsHold::at_nodes);
    if (!is_nodal) return gauss(m.gauss_points);
    return m.X.points == Points::radau ? radau(m.X.degree) : gauss_lobatto(m.X.degree + 1);
}

struct Impulse {
    double work = 0, gross_work = 0, gross = 0, largest_moment = 0;
    Vector3 linear{}, angular{};

    void add(double weight, const Matrix34& X, const Matrix34& F)
    {
        linear += weight * F.column(0);
        for (int c = 0; c < 4; ++c) angular += weight * cross(X.column(c), F.column(c));
        gross += weight * norm(F.column(0));
    }
    void add_work(double done)
    {
        work += done;
        gross_work += std::abs(done);
    }
};

/// All that is supplied up to an element end, without what stiffness adds to the gross.
Impulse impulse_of(const Model& model, const Motion& m, int end)
{
    Impulse sum;
    for (int e = 0; e < end; ++e)
        for (const bool of_joints : {false, true}) {
            const Quadrature rule = rule_of(m, of_joints);
            for (std::size_t k = 0; k < rule.points.size(); ++k) {
                const At at(m, e, rule.points[k]);
                const double weight = m.mesh.length(e) * rule.weights[k];
                for (int b = 0; !of_joints && b < model.n_bodies(); ++b)
                    sum.add(weight, at.X[b], livens::weight(model.bodies()[b], model.gravity()));
                for (std::size_t l = 0; !of_joints && l < model.loads().size(); ++l) {
                    const Load& load = model.loads()[l];
                    const LoadArguments now = load_arguments(load, at.instant, at.X, at.V);
                    LoadForces F{};
                    load.forces(now, F);
                    for (int b = 0; b < 2; ++b)
                        if (load.bodies[b] != world) sum.add(weight, now.X[b], F[b]);
                    sum.add_work(weight * power_without_potential(load, now));
                }
                for (int r = 0; of_joints && r < model.n_rows(); ++r) {
                    const RowGradient g = constraint_gradient(model.row(r), at.instant, at.X);
                    for (const int body : g.bodies) sum.add(weight, at.X[body], -at.lambda[r] * g.of(body));
                    sum.add_work(weight * at.lambda[r] * constraint_rate(model.row(r), at.instant, at.X));
                }
            }
        }
    return sum;
}

TEST(Pass, SuppliesWhatLoadsAndRowsDo)
{
    Random random(1);
    for (unsigned kind = 0; kind < 42; ++kind) {
        SCOPED_TRACE(kind);
        const Model model = random_model(random, kind);
        const Motion m = random_motion(random, model, kind);
        const Balance found = balance(model, m);
        const Impulse exact = impulse_of(model, m, m.n_elements());
        const double size = exact.gross + 1;
        for (int end = 0; end <= m.n_elements(); end += 1 + end / 8) {
            const Impulse so_far = impulse_of(model, m, end);
            EXPECT_LT(norm(found.linear_impulse[end] - so_far.linear), 1e-13 * size) << end;
            EXPECT_LT(norm(found.angular_impulse[end] - so_far.angular), 1e-12 * size) << end;
            EXPECT_NEAR(found.work[end], so_far.work, 1e-12 * (size + so_far.gross_work)) << end;
        }
        EXPECT_GE(found.reference_impulse, exact.gross * (1 - 1e-12));
        if (model.loads().empty()) {
            EXPECT_NEAR(found.reference_impulse, exact.gross, 1e-12 * size);
        }
        Motion other = m;
        const std::size_t n_rows = static_cast<std::size_t>(m.n_rows);
        for (std::size_t i = n_rows - 1; i < other.multipliers.values.size(); i += n_rows)
            other.multipliers.values[i] *= 1.1;
        EXPECT_GT(std::abs(balance(model, other).reference_impulse - found.reference_impulse), 1e-9 * size);
    }
}

/// Also at the ends of its time.
bool is_held(const Model& model, int row, double t)
{
    const Joint& joint = model.joints()[model.row_joint(row)];
    return joint.from <= t && t <= joint.until;
}

/// By the definitions, at one node.
double worst_row(const Model& model, double t, const std::vector<Matrix34>& X, int& row)
{
    double most = 0;
    for (int r = 0; r < model.n_rows(); ++r) {
        const double phi = std::abs(constraint_value(model.row(r), {t}, X)) / model.row(r).scale;
        if (is_held(model, r, t) && phi > most) most = phi, row = r;
    }
    return most;
}

double worst_rigidity(const Model& model, const std::vector<Matrix34>& X)
{
    double most = 0;
    for (int b = 0; b < model.n_bodies(); ++b) {
        const Matrix3 gap = transpose(directors(X[b])) * directors(X[b]) - identity<3>();
        if (!model.bodies()[b].is_point) most = std::max(most, 0.5 * largest(gap));
    }
    return most;
}

TEST(Pass, FindsViolationsOfEveryNode)
{
    Random random(2);
    for (unsigned kind = 0; kind < 42; ++kind) {
        SCOPED_TRACE(kind);
        const Model model = random_model(random, kind);
        const Motion m = random_motion(random, model, kind);
        const NodeViolations found = node_violations(model, m);
        const ViolationReport report = violations(model, m, 0, false);
        const std::vector<double> times = node_times(m.X, m.mesh);
        ASSERT_EQ(found.joints.size(), times.size());
        double joints = 0, rigidity = 0, when = 0;
        int worst = -1;
        for (std::size_t i = 0; i < times.size(); ++i) {
            const auto first = m.X.values.begin() + static_cast<std::ptrdiff_t>(i) * m.X.n_values;
            const std::vector<Matrix34> X = bodies_of({first, first + m.X.n_values});
            int row = -1;
            const double here = worst_row(model, times[i], X, row);
            EXPECT_NEAR(found.joints[i], here, 1e-14 * (1 + here));
            EXPECT_NEAR(found.rigidity[i], worst_rigidity(model, X), 1e-14);
            if (here > joints) joints = here, worst = row, when = times[i];
            rigidity = std::max(rigidity, found.rigidity[i]);
        }
        EXPECT_NEAR(report.joints_at_nodes, joints, 1e-14 * joints);
        EXPECT_EQ(report.rigidity_at_nodes, rigidity);
        EXPECT_EQ(report.worst_row, worst);
        EXPECT_EQ(report.worst_time, when);
        double rate = 0;
        for (int end = 0; end <= m.n_elements(); ++end) {
            const State at = m.at_end(end);
            for (int r = 0; r < model.n_rows(); ++r) {
                const RowGradient g = constraint_gradient(model.row(r), {at.t}, at.X);
                double of_row = constraint_rate(model.row(r), {at.t}, at.X);
                for (const int body : g.bodies) of_row += dot(g.of(body), at.V[body]);
                if (is_held(model, r, at.t)) rate = std::max(rate, std::abs(of_row) / model.row(r).scale);
            }
        }
        EXPECT_NEAR(report.velocity_level, rate, 1e-13 * rate);
    }
}

TEST(Pass, ShowsANumberThatIsNoneInAnyLane)
{
    Random random(3);
    const Model model = random_model(random, 1);
    const Motion good = random_motion(random, model, 3);
    const std::size_t n = static_cast<std::size_t>(good.X.n_values), n_nodes = good.X.values.size() / n;
    const auto base = node_violations(model, good);
    for (std::size_t node = 0; node < n_nodes; ++node) {
        Motion m = good;
        m.X.values[node * n + 3] = NAN;   // of a director of the first body
        const NodeViolations found = node_violations(model, m);
        for (std::size_t i = 0; i < n_nodes; ++i) {
            EXPECT_EQ(std::isnan(found.joints[i]), i == node);
            EXPECT_EQ(std::isnan(found.rigidity[i]), i == node);
            if (i != node) {
                EXPECT_EQ(found.joints[i], base.joints[i]);
            }
        }
        EXPECT_TRUE(std::isnan(violations(model, m, 0, false).rigidity_at_nodes));
        EXPECT_TRUE(std::isnan(balance(model, m).reference_moment));
        m.X.values[node * n + 3] = INFINITY;
        EXPECT_FALSE(std::isfinite(node_violations(model, m).rigidity[node]));
    }
}

TEST(Pass, IntegratesAsGaussRulesDo)
{
    Random random(4);
    for (unsigned kind = 0; kind < 42; ++kind) {
        SCOPED_TRACE(kind);
        const Model model = random_model(random, kind);
        const Motion m = random_motion(random, model, kind);
        const ActionSeries found = action(model, m);
        for (const int first : {0, 2, m.n_elements() - 1}) {   // of some, to the bit
            const int last = std::min(first + 3, m.n_elements());
            const ActionSeries some = action(model, m, first, last);
            ASSERT_EQ(some.hamiltonian.size(), static_cast<std::size_t>(last - first));
            for (int e = first; e < last; ++e) {
                EXPECT_EQ(some.lagrangian[e - first], found.lagrangian[e]);
                EXPECT_EQ(some.hamiltonian[e - first], found.hamiltonian[e]);
                EXPECT_EQ(some.angular_momentum[e - first], found.angular_momentum[e]);
            }
        }
        const Quadrature rule = gauss(m.X.degree + 2);
        for (int e = 0; e < m.n_elements(); ++e) {
            double lagrangian = 0, hamiltonian = 0, size = 0;
            Vector3 moment{};
            for (std::size_t k = 0; k < rule.points.size(); ++k) {
                const At at(m, e, rule.points[k]);
                const double weight = m.mesh.length(e) * rule.weights[k];
                const double T = kinetic_energy(model, at.X, at.V),
                             V = potential_energy(model, at.instant, at.X, at.V);
                lagrangian += weight * (T - V);
                hamiltonian += weight * (T + V);
                size += weight * (std::abs(T) + std::abs(V));
                std::vector<Matrix34> P;
                for (int b = 0; b < model.n_bodies(); ++b) P.push_back(at.V[b] * model.bodies()[b].mass);
                moment += weight * angular_momentum(at.X, P);
            }
            EXPECT_NEAR(found.lagrangian[e], lagrangian, 1e-12 * size);
            EXPECT_NEAR(found.hamiltonian[e], hamiltonian, 1e-12 * size);
            EXPECT_LT(norm(found.angular_momentum[e] - moment), 1e-11 * (size + 1));
        }
    }
}

/// 2 T of the centre of mass, and of what turns about it.
std::array<double, 2> squares(const Model& model, const std::vector<Matrix34>& g)
{
    std::array<double, 2> parts{};
    for (int b = 0; b < model.n_bodies(); ++b) {
        const Matrix4& m = model.bodies()[b].mass;
        const Vector3 v = g[b] * ((1 / m(0, 0)) * m.column(0));
        parts[0] += m(0, 0) * dot(v, v);
        parts[1] += dot(g[b] * m, g[b]) - m(0, 0) * dot(v, v);
    }
    return parts;
}

TEST(Pass, AlternatesAsItsIncrementsDo)
{
    Random random(6);
    for (unsigned kind = 0; kind < 42; ++kind) {
        SCOPED_TRACE(kind);
        const Model model = random_model(random, kind);
        Motion m = random_motion(random, model, kind);
        const int p = m.X.degree, window = 8;
        if (kind % 4 == 1 && p > 1)   // quotients of polynomials
            for (std::size_t i = 0; i < m.X.values.size() / static_cast<std::size_t>(m.X.n_values); ++i)
                m.X.denominators.push_back(1.5 + random.number());
        std::vector<std::vector<Matrix34>> g;
        std::vector<std::array<double, 2>> of_g;
        double means[2] = {}, time = 0;
        for (int e = 0; e < m.n_elements(); ++e)
            for (int k = 0; k < p; ++k) {
                const double step = m.mesh.length(e) / p;
                std::vector<Matrix34> mean = At(m, e, static_cast<double>(k + 1) / p).X;
                const At before(m, e, static_cast<double>(k) / p);
                for (std::size_t b = 0; b < mean.size(); ++b) mean[b] = (1 / step) * (mean[b] - before.X[b]);
                g.push_back(mean);
                of_g.push_back(squares(model, mean));
                for (int i = 0; i < 2; ++i) means[i] += step * of_g.back()[i];
                time += step;
            }
        double worst = 0;
        const int n = std::min(window, static_cast<int>(g.size()));
        for (int first = 0; n >= 6 && first + n <= static_cast<int>(g.size()); ++first)
            for (int i = 0; i < 2; ++i) {
                double sum = 0, second = 0;
                for (int k = first; k < first + n; ++k) sum += of_g[k][i] / n;
                for (int k = first + 1; k + 1 < first + n; ++k) {
                    std::vector<Matrix34> d = g[k - 1];
                    for (std::size_t b = 0; b < d.size(); ++b) d[b] += g[k + 1][b] - 2.0 * g[k][b];
                    second += squares(model, d)[i] / (16 * (n - 2));
                }
                worst = std::max(worst, std::min(1.0, std::sqrt(second / std::max(sum, means[i] / time))));
            }
        EXPECT_NEAR(zigzag(model, m, window).positions, worst, 1e-9);
        EXPECT_TRUE(n < 6 || worst > 0.2);
    }
}

}   // namespace
}   // namespace livens::pass_test
