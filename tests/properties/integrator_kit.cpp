// SPDX-License-Identifier: BSD-3-Clause
#include "properties/integrator_kit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mechanisms.h"
#include "newton_euler.h"

namespace livens {

namespace {

using tests::Distance;

/// The last state, or a failure.
std::optional<Solution> solved(const IntegratorCase& c, const Model& model, const TimeMesh& mesh,
                               Failures& failures)
{
    Solution solution = c.run(model, model.start(), mesh);
    if (solution.report.converged()) return solution;
    failures.push_back("does not converge: " + solution.report.message);
    return {};
}

// Orders.

struct Problem {
    std::string name;
    Model model;
    double end;
    State reference;
    double floor;   ///< gap of two runs of the witness
};

/// Of X and V (m, 1, m/s, 1/s) together: X alone may be right by chance where it crosses the true one.
double error_of(const State& state, const State& reference)
{
    const Distance d = tests::distance(state, reference);
    return d.X + d.V;
}

Problem problem(const std::string& name, const Model& model, double end,
                const std::function<State(int n)>& witness, int n)
{
    const State reference = witness(n + n / 2);
    return {name, model, end, reference, std::max(2e-14, error_of(witness(n), reference))};
}

Problem box_problem(double end)
{
    const double mu = 2 / std::sqrt(3.0);
    const Model model = tests::free_box();
    const tests::NewtonEuler witness(
        model, [=](double, tests::Movers& bodies) { bodies[0].torque += Vector3{mu, mu, mu}; });
    return problem("free box", model, end, [&](int n) { return witness.run(0, end, n); }, 30);
}

Problem bricks_problem()
{
    const Model model = tests::two_bricks();
    const tests::NewtonEuler witness(model, [](double, tests::Movers&) {},
                                     {{world, {0, 0, 0}, 0, {0, 0, 0}}, {0, {1, 0, 0}, 1, {0, 0, 0}}});
    return problem("two bricks", model, 0.5, [&](int n) { return witness.run(0, 0.5, n); }, 20);
}

Problem pendulum_problem()
{
    Model model({0, -9.81, 0});
    const int body = model.add_body(rigid_body("bar", tests::brick({})));
    model.add_joint(revolute("hinge", world, body, {}));
    const SpringDamper law{30, 1.5, 0.6};
    const Vector3 post{0.5, 0.8, 0};
    model.add_load(spring_damper("strut", world, post, body, {1, 0, 0}, law));
    const double inertia = tests::brick({}).inertia(2, 2) + 0.25;   // about the hinge, of 1 kg
    const tests::Derivative swing = [=](double, const tests::Numbers& y) {
        const Vector3 tip{std::cos(y[0]), std::sin(y[0]), 0}, v{-y[1] * tip[1], y[1] * tip[0], 0};
        const Vector3 pull =
            tests::spring_pull(tip, v, post, {}, law.stiffness, law.damping, law.free_length);
        return tests::Numbers{y[1], (cross(tip, pull)[2] - 9.81 * 0.5 * tip[0]) / inertia};
    };
    auto witness = [&](int n) {
        const tests::Numbers y = tests::extrapolated(swing, {0, 0}, 0, 1, n);
        const Matrix3 D = directors_from_rotation_vector({0, 0, y[0]});
        return State{
            1, {configuration({}, D)}, {configuration({}, cross_matrix({0, 0, y[1]}) * D)}};
    };
    return problem("hinged brick with a spring", model, 1, witness, 20);
}

const std::array<Problem, n_problems>& problems()
{
    static const std::array<Problem, n_problems> all{box_problem(1), bricks_problem(), pendulum_problem()};
    return all;
}

/// Longer, for high orders to be seen above rounding.
const Problem& long_box()
{
    static const Problem box = box_problem(2);
    return box;
}

/// Numbers of elements, each about 1.2 times the one before; even ones up to order 5, since the paper's
/// elements have other errors on odd ones.
std::vector<int> meshes(double order)
{
    if (order < 1.5) return {160, 192, 230, 276, 332};
    if (order < 2.5) return {32, 38, 46, 56, 68};
    if (order < 3.5) return {18, 22, 26, 32, 38};
    if (order < 5) return {16, 20, 24, 28, 34};
    if (order < 7) return {16, 19, 23, 28, 34, 41};
    if (order < 9) return {8, 9, 10, 12, 14, 17, 20};
    return {4, 5, 6, 7, 8, 9};
}

void check_order_on(const Problem& on, const StatedOrder& stated, const IntegratorCase& c, Failures& failures)
{
    std::vector<int> n;
    std::vector<double> error;
    for (const int elements : meshes(stated.order)) {
        const auto solution = solved(c, on.model, make_time_mesh(0, on.end, elements), failures);
        if (!solution) return;
        const double e = error_of(tests::last(*solution), on.reference);
        if (e < 50 * on.floor) break;
        n.push_back(elements);
        error.push_back(e);
    }
    const std::size_t k = n.size();
    if (k < 5) {
        failures.push_back(on.name + ": only " + std::to_string(k) + " errors above the floor");
        return;
    }
    const double rate = std::log(error[k - 2] / error[k - 1]) / std::log(1.0 * n[k - 1] / n[k - 2]);
    if (!(std::abs(rate - stated.order) <= stated.tolerance))
        failures.push_back(on.name + ": the rate is " + number(rate) + ", not " + number(stated.order) +
                           "; last error " + number(error.back()) + " with " + std::to_string(n.back()));
}

// Reversal.

/// F(T - t, X, -V): what makes a motion run backwards.
Load reversed(const Load& load, double T)
{
    auto turned = [T](LoadArguments at) {
        at.at = {T - at.at.t, static_cast<Side>(-static_cast<int>(at.at.side))};
        for (Matrix34& V : at.V) V *= -1;
        return at;
    };
    Load result = load;
    result.forces = [=](const LoadArguments& at, LoadForces& F) { load.forces(turned(at), F); };
    if (load.tangent)
        result.tangent = [=](const LoadArguments& at, LoadTangent& tangent) {
            load.tangent(turned(at), tangent);
            for (auto& row : tangent.V)
                for (auto& block : row) block *= -1;
        };
    for (double& t : result.breaks) t = T - t;
    std::ranges::reverse(result.breaks);
    return result;
}

TimeFunction sine(double amplitude, double rate)
{
    return {[=](Instant at) {
                return TimeValue{amplitude * std::sin(rate * at.t), amplitude * rate * std::cos(rate * at.t),
                                 -amplitude * rate * rate * std::sin(rate * at.t)};
            },
            {}};
}

/// Loads that change in time and with the velocity.
std::vector<Load> loads_on_bricks()
{
    return {spring_damper("strut", world, {0.3, -0.4, 0.9}, 1, {1, 0, 0}, {20, 0.8, 0.5}),
            torque("motor", 0, {0.01, sine(2, 3), 0.3}, Frame::body_fixed)};
}

Model two_points()
{
    Model model({0, 0, -3});
    model.add_body(point_mass("first", 0.7, {1.2, 0.1, 0}, {0, 0.5, 0}));
    model.add_body(point_mass("second", 1.7, {0, 0, 0.2}, {1, 0, 0}));
    return model;
}
std::vector<Load> loads_on_points()
{
    return {spring_damper("spring", 0, {}, 1, {}, {20, 0.3, 0.8}),
            point_force("push", 1, {}, {sine(3, 4), 0, 1}, Frame::inertial)};
}

Model with_loads(Model model, const std::vector<Load>& loads)
{
    for (const Load& load : loads) model.add_load(load);
    return model;
}

/// The largest distance from the start after the way forth and back; none if a way fails.
std::optional<Distance> way_back(const IntegratorCase& c, const Model& bare, const std::vector<Load>& loads,
                                 Failures& failures)
{
    const double T = 0.5;
    const TimeMesh mesh = make_time_mesh(0, T, 10);
    const auto forth = solved(c, with_loads(bare, loads), mesh, failures);
    if (!forth) return {};
    State turning = tests::last(*forth);
    turning.t = 0;
    for (Matrix34& V : turning.V) V *= -1;
    std::vector<Load> backwards;
    for (const Load& load : loads) backwards.push_back(reversed(load, T));
    const Solution back = c.run(with_loads(bare, backwards), turning, mesh);
    if (!back.report.converged()) {
        failures.push_back("the way back does not converge: " + back.report.message);
        return {};
    }
    State home = tests::last(back);
    for (Matrix34& V : home.V) V *= -1;
    return tests::distance(home, bare.start());
}

Failures check_reversal_of(const IntegratorCase& c, const std::string& name, const Model& bare,
                           const std::vector<Load>& loads, bool is_stated)
{
    Failures failures;
    const std::optional<Distance> off = way_back(c, bare, loads, failures);
    if (!off) return is_stated ? failures : Failures{};
    if (is_stated && !(off->X <= 1e-10 && off->V <= 1e-9))
        return {name + ": the way back misses the start by " + number(off->X) + ", " + number(off->V)};
    if (!is_stated && !(std::max(off->X, off->V) > c.seen))
        return {name + ": is retraced to " + number(std::max(off->X, off->V)) + ", which is not stated"};
    return {};
}

// Momenta and constraints.

Model floating_chain()
{
    Model model;
    Placement spinning;
    spinning.angular_velocity = {0.4, 1, 3};
    const int first = model.add_body(rigid_body("first", tests::brick({}), spinning));
    Placement next;
    next.position = {1, 0, 0};
    next.velocity = cross(spinning.angular_velocity, {1, 0, 0});
    next.angular_velocity = {2, -1, 0.5};
    const int second = model.add_body(rigid_body("second", tests::brick({}), next));
    JointFrame elbow;
    elbow.point_first = {1, 0, 0};
    model.add_joint(spherical("elbow", first, second, elbow));
    model.add_load(spring_damper("strut", first, {0, 0, 0}, second, {1, 0, 0}, {5, 0.3, 1}));
    return model;
}

struct Momenta {
    Vector3 linear{}, angular{};
};
Momenta momenta_at(const Motion& motion, int end)
{
    Momenta sum;
    const State state = motion.at_end(end);
    for (int b = 0; b < motion.n_bodies; ++b) {
        const Matrix34& P = motion.momenta[end * motion.n_bodies + b];
        sum.linear += P.column(0);
        for (int i = 0; i < 4; ++i) sum.angular += cross(state.X[b].column(i), P.column(i));
    }
    return sum;
}

void compare_momentum(const std::string& name, const Vector3& first, const Vector3& last, bool is_kept,
                      double seen, Failures& failures)
{
    const double drift = norm(last - first) / norm(first);
    if (is_kept && !(drift <= 1e-11)) failures.push_back(name + " momentum drifts by " + number(drift));
    if (!is_kept && !(drift > seen))
        failures.push_back(name + " momentum is kept to " + number(drift) + ", which is not stated");
}

/// The chain's directors and joint at all nodes.
void check_nodes(const Motion& motion, Holds stated, Failures& failures)
{
    double gap = 0, strain = 0;
    for (int e = 0; e < motion.n_elements(); ++e)
        for (int a = 0; a <= motion.X.degree; ++a) {
            Matrix34 body[2];
            for (int b = 0; b < 2; ++b) {
                std::copy_n(motion.X.coefficient(e, a).begin() + 12 * b, 12, body[b].a);
                const Matrix3 D = directors(body[b]);
                strain = std::max(strain, norm(transpose(D) * D - identity<3>()));
            }
            gap = std::max(gap, norm(body[0] * point({1, 0, 0}) - body[1].column(0)));
        }
    if (stated == Holds::nodes && !(strain <= 1e-12))
        failures.push_back("directors are strained by " + number(strain) + " at a node");
    if (stated == Holds::nodes && !(gap <= 1e-12))
        failures.push_back("the joint gapes by " + number(gap) + " at a node");
    if (stated == Holds::weakly && !(strain > 1e-8))
        failures.push_back("directors are rigid to " + number(strain) + " at nodes, which is not stated");
}

// Stability.

/// x and v of an oscillator after the time 1; none if it is not solved.
using Oscillator = std::function<std::optional<std::array<double, 2>>(double x, double v)>;

std::optional<PlaneMap> map_of(double x, double v, const Oscillator& run)
{
    const auto from_x = run(x, 0), from_v = run(0, v);
    if (!from_x || !from_v) return {};
    return PlaneMap{(*from_x)[0] / x, (*from_v)[0] / x, (*from_x)[1] / v, (*from_v)[1] / v};
}

/// A point that a spring without free length draws to the origin, along a line: x'' = -omega^2 x - 2 zeta
/// omega x'.
Oscillator mass_on_spring(const IntegratorCase& c, double h_omega, double zeta)
{
    const double omega = h_omega * c.n_smallest;
    const TimeMesh mesh = make_time_mesh(0, 1, c.n_smallest);
    return [=](double x, double v) -> std::optional<std::array<double, 2>> {
        Model model;
        model.add_body(point_mass("mass", 1, {x, 0, 0}, {v, 0, 0}));
        model.add_load(spring_damper("spring", world, {}, 0, {}, {omega * omega, 2 * zeta * omega, 0}));
        const Solution s = c.run(model, model.start(), mesh);
        if (!s.report.converged()) return {};
        const State end = tests::last(s);
        return std::array{end.X[0](0, 0), end.V[0](0, 0)};
    };
}

/// A body turned by x and turning by v about its third axis, with an inertia of 1 kg m^2 there.
Model turned_body(double x, double v)
{
    Placement turned;
    turned.directors = directors_from_rotation_vector({0, 0, x});
    turned.angular_velocity = {0, 0, v};
    Model model;
    model.add_body(rigid_body("body", {1, {}, {0.8, 0, 0, 0, 0.7, 0, 0, 0, 1}}, turned));
    return model;
}

using Loads = std::function<void(Model& model, double omega, double zeta)>;

Oscillator turning_body(const IntegratorCase& c, const Loads& add_loads, double h_omega, double zeta)
{
    const double omega = h_omega * c.n_smallest;
    const TimeMesh mesh = make_time_mesh(0, 1, c.n_smallest);
    return [=](double x, double v) -> std::optional<std::array<double, 2>> {
        Model model = turned_body(x, v);
        add_loads(model, omega, zeta);
        const Solution s = c.run(model, model.start(), mesh);
        if (!s.report.converged()) return {};
        const State end = tests::last(s);
        return std::array{end.X[0](1, 1), angular_velocity(end.X[0], end.V[0])[2]};
    };
}

/// Springs and dampers from world points (+-1, +-1/2, 0) m to the body's points (0, +-1/2, 0), across and as
/// long as they are when free: no force acts at rest.
void add_springs_across(Model& model, double omega, double zeta)
{
    for (const double side : {-1.0, 1.0})
        model.add_load(spring_damper(side < 0 ? "left" : "right", world, {side, 0.5 * side, 0}, 0,
                                     {0, 0.5 * side, 0}, {2 * omega * omega, 4 * zeta * omega, 1}));
}

/// Springs without free length from world points +-d1 (m) to the body's points +-d1 / 2: the torque is
/// -k sin(angle). The dampers are those above.
void add_springs_along(Model& model, double omega, double zeta)
{
    for (const double side : {-1.0, 1.0}) {
        const std::string name = side < 0 ? "left" : "right";
        model.add_load(
            spring_damper(name, world, {side, 0, 0}, 0, {0.5 * side, 0, 0}, {omega * omega, 0, 0}));
        model.add_load(spring_damper(name + " damper", world, {side, 0.5 * side, 0}, 0,
                                     {0, 0.5 * side, 0}, {0, 4 * zeta * omega, 1}));
    }
}

struct Grid {
    double last;   ///< of h omega, from 0.1 on
    int a_decade;
    double (*amplitude)(double omega);   ///< of x; that of v is omega times as large
    double allowed;   ///< above a radius of 1
    bool is_stated;
};

Failures check_radius(const IntegratorCase& c, const Grid& grid,
                      const std::function<Oscillator(double, double)>& oscillator)
{
    Failures failures;
    double worst = 0, worst_h = 0, worst_zeta = 0;
    const int n = static_cast<int>(std::lround(std::log10(grid.last / 0.1) * grid.a_decade));
    for (int i = 0; i <= n; ++i)
        for (const double zeta : {0.0, 0.1, 1.0, 100.0}) {
            const double h_omega = 0.1 * std::pow(10, 1.0 * i / grid.a_decade);
            const double omega = h_omega * c.n_smallest, x = grid.amplitude(omega);
            const auto map = map_of(x, x * omega, oscillator(h_omega, zeta));
            if (!map && !grid.is_stated) continue;
            if (!map)
                return {"does not converge at h omega = " + number(h_omega) + ", zeta = " + number(zeta)};
            const double radius = spectral_radius(*map);
            if (!grid.is_stated && radius > 1 + 1e-4) return {};
            if (radius > worst || std::isnan(radius))
                worst = radius, worst_h = h_omega, worst_zeta = zeta;
        }
    if (grid.is_stated && !(worst <= 1 + grid.allowed))
        failures.push_back("the spectral radius is 1 + " + number(worst - 1) + " at h omega = " +
                           number(worst_h) + ", zeta = " + number(worst_zeta));
    if (!grid.is_stated)
        failures.push_back("is stable to 1 + " + number(worst - 1) + ", which is not stated");
    return failures;
}

}   // namespace

IntegratorCase integrator_case(const Method& method, const std::string& more)
{
    IntegratorCase c;
    c.what = name_of(method) + (more.empty() ? "" : ", " + more);
    c.method = method;
    c.run = [method](const Model& model, const State& start, const TimeMesh& mesh) {
        SolveOptions options;
        options.tolerance = std::holds_alternative<Mixed>(method) ? 1e-12 : 1e-14;
        options.initial = StartPolicy::project;   // directors that are rigid only weakly are no start
        options.judge = options.divide = false;                    // long elements and short motions are what is asked about
        Method at = method;
        if (auto* mixed = std::get_if<Mixed>(&at); mixed && mixed->basis == Mixed::Basis::nurbs)
            mixed->weights.assign(static_cast<std::size_t>(mesh.n_elements() + mixed->degree), 0.7);
        return solve(model, {start}, mesh, at, options);
    };
    return c;
}

Failures check_integrator_order(const IntegratorCase& c)
{
    Failures failures;
    for (std::size_t i = 0; i < c.orders.size(); ++i)
        if (c.orders[i].order > 0)
            check_order_on(i == 0 && c.orders[i].order > 7 ? long_box() : problems()[i], c.orders[i], c,
                           failures);
    return failures;
}

Failures check_integrator_reversal(const IntegratorCase& c)
{
    Failures failures = check_reversal_of(c, "two points", two_points(), loads_on_points(),
                                          c.reversal != Reversal::never);
    for (const std::string& failure : check_reversal_of(c, "two bricks", tests::two_bricks(),
                                                        loads_on_bricks(), c.reversal == Reversal::always))
        failures.push_back(failure);
    return failures;
}

Failures check_integrator_invariants(const IntegratorCase& c)
{
    Failures failures;
    const TimeMesh mesh = make_time_mesh(0, 0.5, 16);
    const auto solution = solved(c, floating_chain(), mesh, failures);
    if (!solution) return failures;
    const Momenta first = momenta_at(solution->motion, 0);
    const Momenta last = momenta_at(solution->motion, mesh.n_elements());
    compare_momentum("linear", first.linear, last.linear, c.keeps_linear_momentum, c.seen, failures);
    compare_momentum("angular", first.angular, last.angular, c.keeps_angular_momentum, c.seen, failures);
    check_nodes(solution->motion, c.holds, failures);
    return failures;
}

Failures check_integrator_stability(const IntegratorCase& c)
{
    return check_radius(c, {1e5, 3, [](double omega) { return 1 / omega; }, 1e-12, c.is_stable},
                        [&](double h_omega, double zeta) { return mass_on_spring(c, h_omega, zeta); });
}

Failures check_integrator_stability_of_turns(const IntegratorCase& c)
{
    return check_radius(c, {1e3, 2, [](double) { return 1e-5; }, 1e-8, c.is_stable},
                        [&](double h_omega, double zeta) {
                            return turning_body(c, add_springs_across, h_omega, zeta);
                        });
}

Failures check_integrator_stability_with_preload(const IntegratorCase& c)
{
    return check_radius(c, {1e3, 2, [](double) { return 1e-5; }, 1e-8, c.is_stable_with_preload},
                        [&](double h_omega, double zeta) {
                            return turning_body(c, add_springs_along, h_omega, zeta);
                        });
}

Failures check_integrator(const IntegratorCase& c)
{
    Failures all;
    for (const auto check :
         {check_integrator_order, check_integrator_reversal, check_integrator_invariants,
          check_integrator_stability, check_integrator_stability_of_turns,
          check_integrator_stability_with_preload})
        for (const std::string& failure : check(c)) all.push_back(c.what + ": " + failure);
    return all;
}

double spectral_radius(const PlaneMap& m)
{
    const double half = 0.5 * (m.a11 + m.a22), difference = 0.5 * (m.a11 - m.a22);
    const double square = difference * difference + m.a12 * m.a21;   // half the gap of the eigenvalues
    if (square < 0) return std::sqrt(m.a11 * m.a22 - m.a12 * m.a21);
    return std::abs(half) + std::sqrt(square);
}

}   // namespace livens
