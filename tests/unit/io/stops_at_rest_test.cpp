// SPDX-License-Identifier: BSD-3-Clause
// Rest at stops: what is closed, and how it pushes, against closed forms and the complementarity problem.
#include <array>
#include <cmath>
#include <optional>
#include <random>

#include "livens/io/known_state.h"
#include "livens/statics/equilibrium.h"
#include "sanitized.h"
#include "unit/io/swinging_rod.h"

namespace livens::stops_at_rest_test {

namespace {

using test::read;
using test::shown;

Scenario resting(const std::string& text)
{
    ScenarioResult result = read(text);
    EXPECT_TRUE(result.scenario.has_value()) << text << shown(result);
    return result.scenario ? as_it_rests(std::move(*result.scenario)) : Scenario();
}

Equilibrium rest_of(const Scenario& scenario)
{
    return find_equilibrium(scenario.model, known_state(scenario).state);
}

std::string code_of(const std::string& text)
{
    const Scenario scenario = resting(text);
    try {
        const Equilibrium at = rest_of(scenario);
        return at.is_found ? "found" : "not found";
    } catch (const InputError& error) {
        return error.complaint().code + " " + error.complaint().path;
    }
}

/// Of a joint by name, on its second body.
Reaction reaction(const Scenario& scenario, const Equilibrium& at, const std::string& name)
{
    return joint_reaction(frozen(scenario.model, {at.state.t}), scenario.model.find_joint(name), at.state.X,
                          at.multipliers);
}

std::string rod(double start, const std::string& limits, const std::string& more = "")
{
    return test::SwingingRod{start, "limits = " + limits + "\n"}.text("end = 1\nelements = 4", more);
}

TEST(StopsAtRest, APendulumLeansOnItsStop)
{
    for (const double limit : {-0.3, -1.2, -2.5}) {
        const Scenario s = resting(rod(-2.9, "[\"-inf\", " + std::to_string(limit) + "]"));
        const Equilibrium at = rest_of(s);
        ASSERT_TRUE(at.is_found) << at.message;
        EXPECT_NEAR(at.coordinates[0][0], limit, 1e-14);
        ASSERT_EQ(at.closed_stops, std::vector{s.model.find_joint("pin.high")});
        // m g l sin, against where it would go
        EXPECT_NEAR(reaction(s, at, "pin.high").torque[1], 2 * 9.81 * 0.5 * std::sin(limit), 1e-12);
        EXPECT_EQ(at.degrees_of_freedom, 0);
        EXPECT_EQ(linearise(s.model, at.state).n, 0);
    }
}

TEST(StopsAtRest, WhatIsNotReachedIsOpen)
{
    const Scenario s = resting(rod(-2, "[-2.5, 0.1]"));
    const Equilibrium at = rest_of(s);
    ASSERT_TRUE(at.is_found) << at.message;
    EXPECT_NEAR(at.coordinates[0][0], 0, 1e-12);
    EXPECT_TRUE(at.closed_stops.empty());
    EXPECT_EQ(norm(reaction(s, at, "pin.high").torque), 0);
    // as without a stop
    const Linearisation linear = linearise(s.model, at.state);
    ASSERT_EQ(linear.n, 1);
    EXPECT_NEAR(linear.K[0], std::pow(test::SwingingRod::frequency(), 2), 1e-10);
}

/// A spring turns it to the one or the other of two stops.
TEST(StopsAtRest, ARodBetweenTwoStopsLeansOnTheOneItIsPushedTo)
{
    for (const double torque : {-20., 20.}) {
        const Scenario s =
            resting(rod(0.02, "[-0.2, 0.3]",
                        "[[load]]\ntype = \"actuator\"\njoint = \"pin\"\nvalue = " + std::to_string(torque)));
        const Equilibrium at = rest_of(s);
        ASSERT_TRUE(at.is_found) << at.message;
        const double angle = torque > 0 ? 0.3 : -0.2;
        EXPECT_NEAR(at.coordinates[0][0], angle, 1e-14);
        const std::string name = torque > 0 ? "pin.high" : "pin.low";
        EXPECT_NEAR(reaction(s, at, name).torque[1], 2 * 9.81 * 0.5 * std::sin(angle) - torque, 1e-11);
        EXPECT_EQ(at.closed_stops, std::vector{s.model.find_joint(name)});
    }
}

/// It hangs on it, and is nothing where the weight is carried before it is taut.
TEST(StopsAtRest, ARopeOnlyPulls)
{
    const auto text = [](const std::string& more) {
        return R"(format = 1
gravity = [0, 0, -9.81]
body = [{ name = "ball", shape = { point = true }, mass = 3, position = [0.2, 0, 0.1] }]
[[stop]]
name = "rope"
between = ["world", "ball"]
limits = [0, 1]
)" + more + "[time]\nend = 1\nelements = 4\n";
    };
    const Scenario taut = resting(text(""));
    const Equilibrium at = rest_of(taut);
    ASSERT_TRUE(at.is_found) << at.message;
    EXPECT_NEAR(at.state.X[0](2, 0), -1, 1e-13);
    EXPECT_NEAR(reaction(taut, at, "rope").force[2], 3 * 9.81, 1e-10);
    const Linearisation swings = linearise(taut.model, at.state);
    ASSERT_EQ(swings.n, 2);
    for (const VibrationMode& mode : vibration_modes(swings))
        EXPECT_NEAR(mode.frequency(), std::sqrt(9.81), 1e-9);

    const Scenario slack = resting(
        text("[[load]]\ntype = \"spring\"\nbetween = [\"world\", \"ball\"]\npoints = [[0, 0, 1], [0, 0, 0]]\n"
             "stiffness = 300\nfree_length = 1\n"));
    const Equilibrium held = rest_of(slack);
    ASSERT_TRUE(held.is_found) << held.message;
    EXPECT_NEAR(held.state.X[0](2, 0), -3 * 9.81 / 300, 1e-12);
    EXPECT_TRUE(held.closed_stops.empty());
}

/// Three masses on guides, springs k between them and c to the ground, each with a floor.
struct Stack {
    std::array<double, 3> m{}, c{}, rest{}, floor{};
    std::array<double, 2> k{};

    std::string text() const
    {
        std::string all = "format = 1\ngravity = [0, 0, -9.81]\n";
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string n = std::to_string(i), x = std::to_string(2 * i);
            all += "[[body]]\nname = \"b" + n +
                   "\"\nshape = { sphere = 0.1 }\nmass = " + std::to_string(m[i]) + "\nposition = [" + x +
                   ", 0, 4]\n[[joint]]\nname = \"g" + n +
                   "\"\ntype = \"prismatic\"\nbetween = [\"world\", \"b" + n + "\"]\nat = [" + x +
                   ", 0, 0]\naxis = [0, 0, 1]\ncoordinate = 4\nstiffness = " + std::to_string(c[i]) +
                   "\nrest = " + std::to_string(rest[i]) + "\nlimits = [" + std::to_string(floor[i]) +
                   ", inf]\n";
        }
        for (std::size_t i = 0; i < 2; ++i)   // of the difference of coordinates
            all += "[[load]]\nname = \"k" + std::to_string(i) + "\"\ntype = \"actuator\"\njoint = \"g" +
                   std::to_string(i) + "\"\nexpression = \"" + std::to_string(k[i]) + "*(g" +
                   std::to_string(i + 1) + ".displacement - g" + std::to_string(i) +
                   ".displacement)\"\n[[load]]\nname = \"r" + std::to_string(i) +
                   "\"\ntype = \"actuator\"\njoint = \"g" + std::to_string(i + 1) + "\"\nexpression = \"" +
                   std::to_string(k[i]) + "*(g" + std::to_string(i) + ".displacement - g" +
                   std::to_string(i + 1) + ".displacement)\"\n";
        return all + "[time]\nend = 1\nelements = 4\n";
    }
    double stiffness(std::size_t i, std::size_t j) const
    {
        if (i != j) return i + 1 == j || j + 1 == i ? -k[std::min(i, j)] : 0;
        return c[i] + (i > 0 ? k[i - 1] : 0) + (i < 2 ? k[i] : 0);
    }
    double force(std::size_t i) const { return c[i] * rest[i] - m[i] * 9.81; }

    /// By trying all sets of closed floors, of which one fits: places and pushes.
    std::optional<std::array<std::array<double, 3>, 2>> truth(unsigned& set) const
    {
        for (set = 0; set < 8; ++set) {
            std::array<double, 3> z = floor, push{};
            for (int sweep = 0; sweep < 4000; ++sweep)   // Gauss and Seidel
                for (std::size_t i = 0; i < 3; ++i) {
                    if ((set >> i & 1u) != 0) continue;
                    double sum = force(i);
                    for (std::size_t j = 0; j < 3; ++j)
                        if (j != i) sum -= stiffness(i, j) * z[j];
                    z[i] = sum / stiffness(i, i);
                }
            bool fits = true;
            for (std::size_t i = 0; i < 3; ++i) {
                push[i] = -force(i);
                for (std::size_t j = 0; j < 3; ++j) push[i] += stiffness(i, j) * z[j];
                const bool is_closed = (set >> i & 1u) != 0;
                fits = fits && (is_closed ? push[i] > 0 : z[i] > floor[i]);
            }
            if (fits) return std::array{z, push};
        }
        return {};
    }
};

TEST(StopsAtRest, AreTheComplementarityProblemsSolution)
{
    std::mt19937 random(7);
    const auto in = [&](double low, double high) {
        return std::round(1e4 * (low + (high - low) * static_cast<double>(random()) / 4294967296.0)) / 1e4;
    };
    std::array<int, 8> seen{};
    constexpr int n_stacks = is_sanitized ? 12 : 60;
    for (int n = 0; n < n_stacks; ++n) {
        Stack stack;
        for (std::size_t i = 0; i < 3; ++i)
            stack.m[i] = in(0.5, 5), stack.c[i] = in(5, 60), stack.rest[i] = in(-1, 3),
            stack.floor[i] = in(-2, 2);
        for (double& k : stack.k) k = in(5, 60);
        unsigned set = 0;
        const auto truth = stack.truth(set);
        ASSERT_TRUE(truth);
        ++seen[set];
        const Scenario s = resting(stack.text());
        const Equilibrium at = rest_of(s);
        ASSERT_TRUE(at.is_found) << at.message << stack.text();
        double trace = 0;
        int n_free = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string stop = "g" + std::to_string(i) + ".low";
            EXPECT_NEAR(at.coordinates[i][0], (*truth)[0][i], 1e-10) << n << " " << i;
            EXPECT_NEAR(reaction(s, at, stop).force[2], (set >> i & 1u) != 0 ? (*truth)[1][i] : 0, 1e-8)
                << n << " " << i;
            if ((set >> i & 1u) == 0) trace += stack.stiffness(i, i) / stack.m[i], ++n_free;
        }
        const Linearisation linear = linearise(s.model, at.state);
        ASSERT_EQ(linear.n, n_free);
        for (int i = 0; i < linear.n; ++i) trace -= linear.K[static_cast<std::size_t>(i * (linear.n + 1))];
        EXPECT_NEAR(trace, 0, 1e-9);
    }
    int n_sets = 0;
    for (const int times : seen) n_sets += times > 0 ? 1 : 0;
    EXPECT_GE(n_sets, is_sanitized ? 3 : 6);
}

/// The same floor twice: one of both holds.
TEST(StopsAtRest, ThatAreDoubledHoldOnce)
{
    const Scenario s = resting(rod(
        -2, "[\"-inf\", -0.5]", "[[stop]]\nname = \"more\"\njoint = \"pin\"\nlimits = [\"-inf\", -0.5]\n"));
    const Equilibrium at = rest_of(s);
    ASSERT_TRUE(at.is_found) << at.message;
    EXPECT_EQ(at.closed_stops.size(), 1u);
    EXPECT_NEAR(at.coordinates[0][0], -0.5, 1e-14);
    const double torque = reaction(s, at, "pin.high").torque[1] + reaction(s, at, "more").torque[1];
    EXPECT_NEAR(torque, 2 * 9.81 * 0.5 * std::sin(-0.5), 1e-12);
}

TEST(StopsAtRest, AreRefusedWhereNobodyKnows)
{
    // it hangs and touches it
    EXPECT_EQ(code_of(rod(-1, "[\"-inf\", 0]")), "event-method joint[pin.high]");
    // what is pushed away from its only stop flies
    const std::string up =
        "format = 1\ngravity = [0, 0, 9.81]\nbody = [{ name = \"a\", shape = { sphere = 0.1 "
        "}, mass = 1 }]\n[[joint]]\nname = \"g\"\ntype = \"prismatic\"\nbetween = [\"world\", "
        "\"a\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\nlimits = [0, inf]\n[time]\nend = 1\n"
        "elements = 4\n";
    EXPECT_EQ(code_of(up), "not found");
    // the same weight downwards is held where it is
    EXPECT_EQ(code_of(test::replaced(up, "9.81", "-9.81")), "found");
}

/// Small motions are those of a rest alone, and no rest is beyond a stop or pulled at it.
TEST(StopsAtRest, SmallMotionsAskForARest)
{
    const auto code = [](double place) {
        const Scenario s = resting(rod(-0.5, "[\"-inf\", -0.3]"));
        State there = s.model.start();
        const Matrix3 turned = directors_from_rotation_vector({0, place, 0});
        there.X[0] = configuration(turned * Vector3{0, 0, -0.5}, turned);
        for (Matrix34& V : there.V) V = {};
        try {
            linearise(s.model, there);
            return std::string("none");
        } catch (const InputError& error) {
            return error.complaint().code;
        }
    };
    EXPECT_EQ(code(0), "stop-violated");
    EXPECT_EQ(code(-0.5), "not-in-equilibrium");
    EXPECT_EQ(code(-0.3), "none");
}

}   // namespace

}   // namespace livens::stops_at_rest_test
