// SPDX-License-Identifier: BSD-3-Clause
// Inertia along coordinates of joints: against closed forms, against bodies that have it, and what refuses
// it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "livens/diagnostics/accelerations.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/dynamics/coordinates/generalised_state.h"
#include "livens/dynamics/instant/inertia_along.h"
#include "livens/io/solve_scenario.h"
#include "livens/multibody/rotors.h"
#include "livens/statics/frequencies.h"
#include "livens/statics/linearisation.h"
#include "unit/io/scenario_text.h"

namespace livens::rotor_inertia_test {

namespace {

using test::read;
using test::shown;

struct Solved {
    Scenario scenario;
    Solution solution;

    /// Of joint j, its coordinate k, counted from the start.
    double moved(int j, int k = 0) const
    {
        const Motion& m = solution.motion;
        double sum = 0;
        for (int e = 0; e < m.n_elements(); ++e)
            sum += coordinate_change(coordinate(j, k), m.at_end(e).X, m.at_end(e + 1).X);
        return sum;
    }
    double rate(int j, int k = 0) const
    {
        const State last = solution.motion.at_end(solution.motion.n_elements());
        return coordinate_rate(coordinate(j, k), last.X, last.V);
    }

private:
    const JointCoordinate& coordinate(int j, int k) const
    {
        return scenario.model.joints()[static_cast<std::size_t>(j)]
            .coordinates[static_cast<std::size_t>(k)]
            .coordinate;
    }
};

Scenario scenario_of(const std::string& text)
{
    ScenarioResult result = read("format = 1\n" + text);
    if (!result.scenario) throw std::logic_error(shown(result));
    return std::move(*result.scenario);
}

Solved solved(const std::string& text)
{
    Solved all{scenario_of(text), {}};
    const Scenario& s = all.scenario;
    all.solution = solve(s.model, {s.conditions}, s.time, s.method, s.options);
    EXPECT_TRUE(all.solution.report.converged()) << all.solution.report.message;
    return all;
}

std::string in_time(double end, int elements, const std::string& method)
{
    return "\n[time]\nend = " + std::to_string(end) + "\nelements = " + std::to_string(elements) +
           "\n[method]\n" + method + "\n";
}

std::string body(const std::string& name, const std::string& place, const std::string& inertia,
                 const std::string& more = "")
{
    return "[[body]]\nname = \"" + name + "\"\nmass = 2\ninertia = " + inertia + "\nposition = " + place +
           "\n" + more + "\n";
}

std::string joint(const std::string& type, const std::string& name, const std::string& bodies,
                  const std::string& at, const std::string& axis, const std::string& keys)
{
    return "[[joint]]\ntype = \"" + type + "\"\nname = \"" + name + "\"\nbetween = " + bodies +
           "\nat = " + at + "\naxis = " + axis + "\n" + keys + "\n";
}

std::string number(double x)
{
    char text[64];
    std::snprintf(text, sizeof text, "%.17g", x);
    return text;
}

std::string rotor(double inertia) { return "rotor_inertia = " + number(inertia); }

/// On a hinge across gravity, with the inertia about it as given, and turned off from rest.
std::string pendulum(const std::string& inertia, const std::string& keys)
{
    return "gravity = [0, 0, -9.81]\n" + body("rod", "[0.5, 0, 0]", inertia) +
           joint("revolute", "pin", "[\"world\", \"rod\"]", "[0, 0, 0]", "[0, 1, 0]", keys);
}

const std::string fine = "family = \"lobatto\"\ndegree = 6";

TEST(RotorInertia, ATorqueTurnsAFlywheelByTheSumOfInertias)
{
    for (const double a : {1e-9, 0.3, 1e6}) {
        const double torque = 3 * (0.5 + a);
        const Solved s = solved(
            body("wheel", "[0, 0, 0]", "[0.3, 0.4, 0.5]") +
            joint("revolute", "axle", "[\"world\", \"wheel\"]", "[0, 0, 0]", "[0, 0, 1]", rotor(a)) +
            "[[load]]\nname = \"motor\"\ntype = \"actuator\"\njoint = \"axle\"\nvalue = " + number(torque) +
            in_time(2, 40, fine));
        EXPECT_NEAR(s.moved(0), 6, 1e-11) << a;
        EXPECT_NEAR(s.rate(0), 6, 1e-11) << a;
        EXPECT_TRUE(s.solution.verdict.reasons.empty()) << s.solution.verdict.reasons.front();
        EXPECT_LT(s.solution.verdict.energy_drift, 1e-10);
    }
}

TEST(RotorInertia, OfAPendulumIsInertiaAboutItsAxis)
{
    for (const char* method :
         {"family = \"lobatto\"\ndegree = 4", "family = \"lobatto\"\ndegree = 6",
          "family = \"radau\"\ndegree = 5", "family = \"lobatto\"\ndegree = 5\nwindow = 2"}) {
        SCOPED_TRACE(method);
        const Solved with = solved(pendulum("[0.1, 0.2, 0.2]", rotor(0.35)) + in_time(1.5, 60, method)),
                     heavier = solved(pendulum("[0.4, 0.55, 0.55]", "") + in_time(1.5, 60, method)),
                     without = solved(pendulum("[0.1, 0.2, 0.2]", "") + in_time(1.5, 60, method));
        EXPECT_NEAR(with.moved(0), heavier.moved(0), 1e-11);
        EXPECT_NEAR(with.rate(0), heavier.rate(0), 1e-11);
        EXPECT_GT(std::abs(with.moved(0) - without.moved(0)), 1e-2) << "negative control";
        EXPECT_TRUE(with.solution.verdict.reasons.empty()) << with.solution.verdict.reasons.front();
    }
}

TEST(RotorInertia, OfASlideIsMassWithoutWeight)
{
    // Four, so that points of rotors are full.
    std::string text = "gravity = [0, 0, -9.81]\n";
    for (int k = 0; k < 4; ++k) {
        const std::string n = std::to_string(k), place = "[" + n + ", 0, 0]";
        text += body("lift " + n, place, "[1, 1, 1]") +
                joint("prismatic", "guide " + n, "[\"world\", \"lift " + n + "\"]", place, "[0, 0, 1]",
                      k == 3 ? "rotor_inertia = 0.02" : "rotor_inertia = \"500 g\"");
    }
    const Solved s = solved(text + in_time(1, 5, fine));
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(s.moved(k), -0.5 * 9.81 * 2 / (k == 3 ? 2.02 : 2.5), 1e-12) << k;
    EXPECT_TRUE(s.solution.verdict.reasons.empty()) << s.solution.verdict.reasons.front();
}

TEST(RotorInertia, IsStatedForEachOfTwoCoordinates)
{
    const Solved s = solved(
        "gravity = [0, 0, -9.81]\n" +
        body("nut", "[0, 0, 0]", "[0.3, 0.4, 0.5]", "angular_velocity = [0, 0, 2]") +
        joint("cylindrical", "rod", "[\"world\", \"nut\"]", "[0, 0, 0]", "[0, 0, 1]",
              "angle = { rotor_inertia = 0.25, stiffness = 3 }\ndisplacement = { rotor_inertia = 2 }") +
        in_time(1, 20, fine));
    EXPECT_NEAR(s.moved(0, 1), -0.25 * 9.81, 1e-12);
    EXPECT_NEAR(s.moved(0, 0), std::sin(2.0), 1e-11);   // 2 rad/s by the root of 3 / 0.75
}

/// Three links in a row and one back to the world: a loop; on joints of it inertia as it is stated.
std::string linkage(const std::string& first, const std::string& second, const std::string& third,
                    const std::string& more)
{
    return "gravity = [1, 2, -9.81]\n" + body("a", "[0, 0, 0.5]", "[0.2, 0.3, 0.2]") +
           body("b", "[1, 0.1, 1.2]", "[0.3, 0.2, 0.25]") + body("c", "[2, 0, 0.6]", "[0.2, 0.2, 0.3]") +
           body("d", "[1, 1, 1.2]", "[0.1, 0.12, 0.15]") +
           joint("revolute", "j1", "[\"world\", \"a\"]", "[0, 0, 0]", "[0, 1, 0]", first) +
           joint("revolute", "j2", "[\"a\", \"b\"]", "[0, 0, 1]", "[0, 1, 0]", second) +
           "[[joint]]\ntype = \"spherical\"\nname = \"j3\"\nbetween = [\"b\", \"c\"]\nat = [2, 0, 1.4]\n" +
           "[[joint]]\ntype = \"universal\"\nname = \"j4\"\nbetween = [\"world\", \"c\"]\nat = [2, 0, 0]\n"
           "axes = [[1, 0, 0], [0, 1, 0]]\n" +
           joint("cylindrical", "j5", "[\"b\", \"d\"]", "[1, 0.5, 1.2]", "[0, 0.6, 0.8]", third) + more +
           "[[load]]\ntype = \"spring\"\nname = \"s\"\njoint = \"j2\"\nstiffness = 20\ndamping = 0.3\n"
           "[[load]]\ntype = \"spring\"\nname = \"t\"\njoint = \"j5\"\ncoordinate = \"displacement\"\n"
           "stiffness = 300\n";
}

/// A point on a line of the world, bound by a rack of radius 1.
std::string bound(const std::string& joint, double inertia, int axis)
{
    const char* axes[] = {"[0.981, 0, 0.1]", "[0, 0.981, 0.2]", "[0.981, 0, 0.1]"};
    return "[[body]]\nname = \"p " + joint + "\"\nmass = " + number(inertia) +
           "\nshape = { point = true }\nposition = [0, 0, 0]\n[[joint]]\nname = \"l " + joint +
           "\"\ntype = \"point_on_line\"\nbetween = [\"world\", \"p " + joint +
           "\"]\nat = [0, 0, 0]\naxis = " + axes[axis] +
           "\n[[joint]]\ntype = \"rack_and_pinion\"\nname = \"r " + joint + "\"\njoints = [\"" + joint +
           "\", \"l " + joint + "\"]\nradius = 1\n";
}

TEST(RotorInertia, OfALoopMovesItAsBodiesBoundByRacksDo)
{
    const std::string time = in_time(0.6, 40, "family = \"lobatto\"\ndegree = 5");
    const Solved rotors = solved(linkage("rotor_inertia = 0.7", "rotor_inertia = 0.02", "", time)),
                 bodies = solved(linkage("", "", "", bound("j1", 0.7, 0) + bound("j2", 0.02, 2) + time)),
                 none = solved(linkage("", "", "", time));
    const State a = rotors.solution.motion.at(0.6), b = bodies.solution.motion.at(0.6),
                c = none.solution.motion.at(0.6);
    double gap = 0, without = 0;
    for (std::size_t i = 0; i < a.X.size(); ++i) {
        gap = std::max({gap, norm(a.X[i] - b.X[i]), norm(a.V[i] - b.V[i])});
        without = std::max(without, norm(a.X[i] - c.X[i]));
    }
    EXPECT_LT(gap, 1e-11);
    EXPECT_GT(without, 1e-3) << "negative control";
    EXPECT_EQ(rotors.solution.motion.n_bodies, 4);
    EXPECT_EQ(rotors.solution.motion.n_rows, rotors.scenario.model.n_rows());
    // Reactions, which leave out what the rotor does.
    const Motion &m = rotors.solution.motion, &n = bodies.solution.motion;
    const auto rows = static_cast<std::size_t>(m.n_rows);
    for (std::size_t r = 0; r < rows; ++r)
        EXPECT_NEAR(m.end_multipliers[m.end_multipliers.size() - rows + r],
                    n.end_multipliers[n.end_multipliers.size() - static_cast<std::size_t>(n.n_rows) + r],
                    1e-7);
}

/// A ball or a universal joint with rotors along its angles, or the hinges that its angles are: of crosses
/// with next to no mass between.
std::string about_axes(const std::vector<std::string>& axes, const std::vector<double>& rotors,
                       const std::string& joint_keys)
{
    std::string text = "gravity = [1, 2, -9.81]\n" + body("top", "[0.3, 0.2, -0.4]", "[0.3, 0.4, 0.5]");
    const double rates[] = {0.7, 0.4, -0.3};
    const auto started = [&](std::size_t k, const std::string& of) {
        return "\n[[start.coordinates]]\n" + of + "\nvalue = 0.1\nrate = " + number(rates[k]) + "\n";
    };
    if (!joint_keys.empty()) {
        text += "[[joint]]\nname = \"ball\"\nbetween = [\"world\", \"top\"]\nat = [0, 0, 0]\n" + joint_keys;
        for (std::size_t k = 0; k < rotors.size(); ++k)
            text += "\nangle_" + std::to_string(k + 1) + " = { rotor_inertia = " + number(rotors[k]) + " }";
        for (std::size_t k = 0; k < axes.size(); ++k)
            text += started(k, "joint = \"ball\"\ncoordinate = \"angle_" + std::to_string(k + 1) + "\"");
        return text;
    }
    std::string before = "world";
    for (std::size_t k = 0; k < axes.size(); ++k) {
        const std::string after = k + 1 < axes.size() ? "cross " + std::to_string(k) : "top";
        if (after != "top")
            text += "[[body]]\nname = \"" + after +
                    "\"\nmass = 1e-9\ninertia = [1e-10, 1e-10, 1e-10]\nposition = [0, 0, 0]\n";
        text += joint("revolute", "h" + std::to_string(k), "[\"" + before + "\", \"" + after + "\"]",
                      "[0, 0, 0]", axes[k], rotor(rotors[k]));
        before = after;
    }
    for (std::size_t k = 0; k < axes.size(); ++k)
        text += started(k, "joint = \"h" + std::to_string(k) + "\"");
    return text;
}

TEST(RotorInertia, OfUniversalAndBallJointsIsThatOfTheirHinges)
{
    const std::string x = "[1, 0, 0]", y = "[0, 1, 0]", z = "[0, 0, 1]",
                      time = in_time(1.2, 60, "family = \"lobatto\"\ndegree = 5");
    const struct {
        std::vector<std::string> axes;
        std::vector<double> rotors;
        std::string keys;
    } cases[] = {{{x, y}, {0.4, 0.25}, "type = \"universal\"\naxes = [[1, 0, 0], [0, 1, 0]]\n"},
                 {{x, y, z}, {0.4, 0.25, 0.6}, "type = \"spherical\"\nangles = \"xyz\"\n"},
                 {{z, y, x}, {0.4, 0.25, 0.6}, "type = \"spherical\"\nangles = \"zyx\"\n"}};
    for (const auto& [axes, rotors, keys] : cases) {
        SCOPED_TRACE(keys);
        const Solved one = solved(about_axes(axes, rotors, keys) + time),
                     hinges = solved(about_axes(axes, rotors, "") + time),
                     bare = solved(about_axes(axes, {}, keys) + time);
        const State a = one.solution.motion.at(1.2), b = hinges.solution.motion.at(1.2),
                    c = bare.solution.motion.at(1.2);
        EXPECT_LT(std::max(norm(a.X[0] - b.X[0]), norm(a.V[0] - b.V[0])), 1e-7);
        EXPECT_GT(norm(a.X[0] - c.X[0]), 1e-2) << "negative control";
        EXPECT_TRUE(one.solution.verdict.reasons.empty()) << one.solution.verdict.reasons.front();
        const Balance of = balance(one.scenario.model, one.solution.motion);
        EXPECT_LT(of.relative_energy_drift(), 1e-10);
        EXPECT_LT(of.relative_angular_momentum_drift(), 1e-10);
        const GeneralisedCoordinates with(one.scenario.model, one.scenario.model.start(),
                                          StartPolicy::project),
            without(bare.scenario.model, bare.scenario.model.start(), StartPolicy::project);
        const std::size_t n = axes.size();
        std::vector<double> q(n, 0.4), v(n, 0.7);
        const std::vector<double> M = with.at(q, v).mass_matrix(), M0 = without.at(q, v).mass_matrix();
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j)
                EXPECT_NEAR(M[n * i + j] - M0[n * i + j], i == j ? rotors[i] : 0, 1e-13);
    }
}

TEST(RotorInertia, KeepsEnergyAndBalances)
{
    const Solved s =
        solved("gravity = [0, 0, -9.81]\n" + body("a", "[0.5, 0, 0]", "[0.1, 0.2, 0.2]") +
               body("b", "[1.5, 0, 0]", "[0.1, 0.2, 0.2]") +
               joint("revolute", "j1", "[\"world\", \"a\"]", "[0, 0, 0]", "[0, 1, 0]", rotor(0.4)) +
               joint("revolute", "j2", "[\"a\", \"b\"]", "[1, 0, 0]", "[0.3, 1, 0]", rotor(0.1)) +
               in_time(2, 200, fine));
    const Balance balance_of = balance(s.scenario.model, s.solution.motion);
    EXPECT_LT(balance_of.relative_energy_drift(), 1e-11);
    EXPECT_LT(balance_of.relative_linear_momentum_drift(), 1e-11);
    EXPECT_LT(balance_of.relative_angular_momentum_drift(), 1e-11);
    const Model bare =
        scenario_of("gravity = [0, 0, -9.81]\n" + body("a", "[0.5, 0, 0]", "[0.1, 0.2, 0.2]") +
                    body("b", "[1.5, 0, 0]", "[0.1, 0.2, 0.2]") +
                    joint("revolute", "j1", "[\"world\", \"a\"]", "[0, 0, 0]", "[0, 1, 0]", "") +
                    joint("revolute", "j2", "[\"a\", \"b\"]", "[1, 0, 0]", "[0.3, 1, 0]", "") +
                    in_time(2, 200, fine))
            .model;
    EXPECT_GT(balance(bare, s.solution.motion).relative_energy_drift(), 1e-3) << "negative control";
    EXPECT_GT(balance(bare, s.solution.motion).relative_angular_momentum_drift(), 1e-4) << "negative control";
    EXPECT_TRUE(s.solution.verdict.reasons.empty()) << s.solution.verdict.reasons.front();
}

TEST(RotorInertia, ConvergesWithOrder2P)
{
    const auto at = [](int elements) {
        return solved(pendulum("[0.1, 0.2, 0.2]", rotor(0.35)) +
                      "[[load]]\ntype = \"spring\"\nname = \"s\"\n"
                      "joint = \"pin\"\nstiffness = 4\n" +
                      in_time(1.6, elements, "family = \"lobatto\"\ndegree = 2\nestimate = \"none\""))
            .moved(0);
    };
    const double truth = at(640), coarse = at(20) - truth, fine_one = at(40) - truth;
    EXPECT_NEAR(std::log2(std::abs(coarse / fine_one)), 4, 0.15);
}

TEST(RotorInertia, IsOneDiagonalTermOfTheMassMatrix)
{
    const auto text = [](double a, double b) {
        const auto keys = [](double x) { return x > 0 ? rotor(x) : std::string(); };
        return "gravity = [0, 0, -9.81]\n" + body("a", "[0.5, 0, 0]", "[0.1, 0.2, 0.2]") +
               body("b", "[1.5, 0, 0]", "[0.1, 0.2, 0.2]") +
               joint("revolute", "j1", "[\"world\", \"a\"]", "[0, 0, 0]", "[0, 1, 0]", keys(a)) +
               joint("revolute", "j2", "[\"a\", \"b\"]", "[1, 0, 0]", "[0.3, 1, 0]", keys(b)) +
               in_time(1, 10, fine);
    };
    const Model with = scenario_of(text(0.4, 0.15)).model, bare = scenario_of(text(0, 0)).model;
    const std::vector<double> q{0.3, -0.8}, v{1.1, 0.4}, a{0.7, -2};
    const GeneralisedCoordinates all(with, with.start(), StartPolicy::check),
        less(bare, bare.start(), StartPolicy::check);
    const GeneralisedState at = all.at(q, v), before = less.at(q, v);
    const std::vector<double> M = at.mass_matrix(), M0 = before.mass_matrix();
    EXPECT_NEAR(M[0] - M0[0], 0.4, 1e-14);
    EXPECT_NEAR(M[3] - M0[3], 0.15, 1e-14);
    EXPECT_NEAR(M[1], M0[1], 1e-14);
    const std::vector<double> f = at.inverse_dynamics(a), f0 = before.inverse_dynamics(a);
    EXPECT_NEAR(f[0] - f0[0], 0.4 * 0.7, 1e-13);
    EXPECT_NEAR(f[1] - f0[1], 0.15 * -2, 1e-13);
    EXPECT_NEAR(at.kinetic_energy() - before.kinetic_energy(), 0.5 * (0.4 * 1.21 + 0.15 * 0.16), 1e-14);
    EXPECT_NEAR(kinetic_energy(with, at.state().X, at.state().V), at.kinetic_energy(), 1e-14);
    // Accelerations of a motion's instant are those of the state in coordinates.
    const Solved s = solved(text(0.4, 0.15));
    const double t = 0.537;
    const State state = sample_state(s.solution.motion, t);
    const AcceleratedState moving = Accelerations(s.scenario.model, s.solution.motion).at(state);
    const std::vector<Joint>& joints = s.scenario.model.joints();
    std::vector<double> numbers, rates, second;
    for (const Joint& j : joints) {
        numbers.push_back(coordinate_value(j.coordinates[0].coordinate, moving.X));
        rates.push_back(coordinate_rate(j.coordinates[0].coordinate, moving.X, moving.V));
        const ConstraintRow row = coupling_row({{1, j.coordinates[0].coordinate}}, 0, 1, "q");
        second.push_back(coordinate_rate(j.coordinates[0].coordinate, moving.X, moving.A) +
                         constraint_curvature(row, {t}, moving.X, moving.V));
    }
    const std::vector<double> told = all.at(numbers, rates).accelerations();
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(second[k], told[k], 1e-9 * (1 + std::abs(told[k])));
}

TEST(RotorInertia, SlowsVibrationsAndAddsToWhatAForceMoves)
{
    const std::string hanging =
        "gravity = [0, 0, -9.81]\n" + body("rod", "[0, 0, -0.5]", "[0.2, 0.2, 0.1]") +
        joint("revolute", "pin", "[\"world\", \"rod\"]", "[0, 0, 0]", "[0, 1, 0]", rotor(0.3)) +
        "[[load]]\ntype = \"spring\"\nname = \"s\"\njoint = \"pin\"\nstiffness = 50\n" + in_time(1, 10, fine);
    const Model model = scenario_of(hanging).model;
    const double inertia = 0.2 + 2 * 0.25 + 0.3, stiffness = 50 + 2 * 9.81 * 0.5;
    const Linearisation linear = linearise(model, model.start());
    ASSERT_EQ(linear.n, 1);
    EXPECT_NEAR(linear.K[0] / linear.M[0], stiffness / inertia, 1e-10);
    EXPECT_NEAR(highest_frequencies(model, model.start()).springs.rate, std::sqrt(50 / inertia), 1e-9);
    const JointCoordinate angle = model.joints()[0].coordinates[0].coordinate;
    EXPECT_NEAR(inertias_along(model, std::vector{angle})[0], inertia, 1e-13);
}

TEST(RotorInertia, IsKnownBetweenNodes)
{
    const std::string text =
        pendulum("[0.1, 0.2, 0.2]", rotor(0.35)) + in_time(1.5, 30, "family = \"lobatto\"\ndegree = 4");
    const Solved s = solved(text),
                 finer = solved(pendulum("[0.1, 0.2, 0.2]", rotor(0.35)) + in_time(0.77, 30, fine));
    const ExactSample exact = sample_exactly(s.scenario.model, s.solution.motion, s.scenario.method, 0.77);
    const State last = finer.solution.motion.at_end(30);
    ASSERT_EQ(exact.state.X.size(), 1u);
    EXPECT_LT(norm(exact.state.X[0] - last.X[0]), 1e-9);
    EXPECT_LT(norm(exact.state.V[0] - last.V[0]), 1e-8);
}

TEST(RotorInertia, ComesToItsAccuracy)
{
    const std::string keys = pendulum("[0.1, 0.2, 0.2]", rotor(0.35)),
                      heavier = pendulum("[0.4, 0.55, 0.55]", "");
    const std::string time = "[time]\nend = 3\naccuracy = 1e-9\n";
    const Solved a = solved(keys + time), b = solved(heavier + time);
    EXPECT_NEAR(a.moved(0), b.moved(0), 2e-9);
    EXPECT_LT(a.solution.estimate.largest, 1e-9);
    EXPECT_EQ(a.solution.estimate.n_bodies, 1);
    EXPECT_TRUE(a.solution.verdict.reasons.empty()) << a.solution.verdict.reasons.front();
    // As the program does it: the estimate comes after.
    const Scenario scenario = scenario_of(keys + in_time(1.5, 30, "family = \"lobatto\"\ndegree = 4"));
    const SolvedScenario later = solve_scenario(scenario, scenario.options, nullptr);
    EXPECT_EQ(later.solution.estimate.n_bodies, 1);
    EXPECT_EQ(later.solution.estimate.position.size(), 31u);
    EXPECT_GT(later.solution.estimate.largest, 0);
}

TEST(RotorInertia, ThatCannotBeIsRefused)
{
    const auto wrong = [](const std::string& keys, const char* code, const std::string& type = "revolute",
                          const std::string& more = in_time(1, 10, fine)) {
        const std::string axis = type == "spherical" ? "" : "axis = [0, 1, 0]\n";
        const ScenarioResult result =
            read("format = 1\ngravity = [0, 0, -9.81]\n" + body("rod", "[0.5, 0, 0]", "[1, 1, 1]") +
                 "[[joint]]\nname = \"pin\"\ntype = \"" + type +
                 "\"\nbetween = [\"world\", \"rod\"]\nat = [0, 0, 0]\n" + axis + keys + "\n" + more);
        EXPECT_FALSE(result.scenario.has_value()) << keys;
        EXPECT_EQ(std::ranges::count(result.diagnostics, Severity::error, &Diagnostic::severity), 1)
            << shown(result);
        EXPECT_NE(test::find(result, code), nullptr) << code << shown(result);
    };
    wrong("rotor_inertia = -1", "out-of-range");
    wrong("rotor_inertia = 0", "out-of-range");
    wrong("rotor_inertia = nan", "not-finite");
    wrong("rotor_inertia = inf", "not-finite");
    wrong("rotor_inertia = \"1 kg\"", "unit");
    wrong("rotor_inertia = 1", "misplaced-key", "spherical");
    wrong("angle_1 = { rotor_inertia = 1 }", "joint-loads", "spherical");   // which has no 'angles'
    wrong("angles = \"xyz\"\nangle_2 = { rotor_inertia = -1 }", "out-of-range", "spherical");
    wrong("rotor_inertia = 1", "misplaced-key", "cylindrical");
    wrong("rotor_inertia = 1\nuntil = 0.5", "rotor-inertia");
    wrong("rotor_inertia = 1", "rotor-method", "revolute",
          "[time]\nend = 1\nelements = 10\n[method]\nfamily = \"mixed\"");
    wrong("rotor_inertia = 1", "rotor-method", "revolute",
          "[time]\nend = 1\nelements = 10\n[method]\nfamily = \"midpoint\"");
}

}   // namespace

}   // namespace livens::rotor_inertia_test
