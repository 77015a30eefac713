// SPDX-License-Identifier: BSD-3-Clause
// Conditions by component, periodic motions and unknown numbers by several ranks: the states and numbers of
// one, which is held against closed forms and lobatto elsewhere; nobody forms elements of others; what is
// sent is as long as it is said to be.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "livens/base/error.h"
#include "livens/io/parts.h"
#include "livens/io/solve_scenario.h"
#include "livens/spacetime/on_ranks.h"
#include "unit/io/scenario_text.h"

namespace livens {

namespace {

using test::read;
using test::replaced;
using test::shown;

Scenario scenario_of(const std::string& text)
{
    ScenarioResult result = read("format = 1\n" + text);
    if (!result.scenario) throw std::logic_error(shown(result));
    return std::move(*result.scenario);
}

Problem problem_of(const Scenario& scenario)
{
    Problem problem{scenario.conditions};
    problem.unknowns = scenario.unknowns;
    return problem;
}

Solution alone(const std::string& text)
{
    const Scenario s = scenario_of(text);
    return solve(s.model, problem_of(s), s.time, s.method, s.options);
}

struct Part {
    Solution solution;
    RankWork work;
};

std::vector<Part> by_ranks(const std::string& text, int n_ranks)
{
    std::vector<Part> parts(static_cast<std::size_t>(n_ranks));
    const Scenario s = scenario_of(text);
    run_as_ranks(n_ranks, [&](Ranks& ranks) {
        Part& part = parts[static_cast<std::size_t>(ranks.rank())];
        part.solution = solve_on_ranks(s.model, problem_of(s), s.time, s.method, s.options, ranks, part.work);
    });
    return parts;
}

std::string body(const std::string& name, const std::string& place)
{
    return "[[body]]\nname = \"" + name + "\"\nmass = 2\ninertia = [0.1, 0.2, 0.25]\nposition = " + place +
           "\n";
}
std::string joint(const std::string& type, const std::string& name, const std::string& bodies,
                  const std::string& at, const std::string& axis)
{
    return "[[joint]]\ntype = \"" + type + "\"\nname = \"" + name + "\"\nbetween = " + bodies +
           "\nat = " + at + (axis.empty() ? "" : "\naxis = " + axis) + "\n";
}
std::string time_of(const std::string& time, int degree)
{
    return "[time]\n" + time +
           "\n[method]\nestimate = \"none\"\nfamily = \"mixed\"\ndegree = " + std::to_string(degree) + "\n";
}

const std::string weight = "gravity = [0, 0, -9.81]\n";
/// Two bodies on hinges whose axes are not parallel, with a damper.
const std::string chain =
    weight + body("upper", "[0.5, 0, 0]") + body("lower", "[1.5, 0, 0]") +
    joint("revolute", "j1", "[\"world\", \"upper\"]", "[0, 0, 0]", "[0, 1, 0.2]") +
    joint("revolute", "j2", "[\"upper\", \"lower\"]", "[1, 0, 0]", "[0.3, 1, 0]") +
    "[[load]]\ntype = \"spring\"\nname = \"s\"\njoint = \"j2\"\nstiffness = 3\ndamping = 0.4\n";
const std::string cart = body("cart", "[0, 0, 0]") +
                         joint("prismatic", "rail", "[\"world\", \"cart\"]", "[0, 0, 0]", "[1, 0, 0]") +
                         "[[load]]\ntype = \"spring\"\nname = \"s\"\njoint = \"rail\"\nstiffness = 8\n"
                         "damping = 1\n[[load]]\ntype = \"actuator\"\nname = \"f\"\njoint = \"rail\"\n";
const std::string pendulum = weight + body("bob", "[0, 0, -1]") +
                             joint("revolute", "pivot", "[\"world\", \"bob\"]", "[0, 0, 0]", "[0, 1, 0]");

struct Case {
    const char* what;
    std::string text;
};

const Case by_component[] = {
    {"angles at both ends, and a rate",
     chain +
         "[start]\nknown = { \"j1.angle\" = 0.1, \"j2.angle\" = -0.2, \"j2.angle_rate\" = 0.5 }\n"
         "[end]\nknown = { \"j1.angle\" = 0.9 }\n" +
         time_of("end = 0.5\nelements = 41", 2)},
    {"a place of the tip at the end",
     chain +
         "[[sensor]]\ntype = \"point\"\nname = \"tip\"\nbody = \"lower\"\npoint = [0.5, 0, 0]\n"
         "[start]\nknown = { \"j1.angle\" = 0, \"j2.angle\" = 0 }\n"
         "[end]\nknown = { \"tip.z\" = -0.9, \"tip.x\" = 1.6 }\n" +
         time_of("end = 0.6\nelements = 66", 1)},
    {"nothing but the end", chain +
                                "[end]\nknown = { \"j1.angle\" = 0.9, \"j2.angle\" = 0.2, \"j1.angle_rate\" "
                                "= 1, \"j2.angle_rate\" = -1 }\n" +
                                time_of("end = 0.4\nelements = 40", 2)},
    {"lower multipliers",
     replaced(chain +
                  "[start]\nknown = { \"j1.angle\" = 0.1, \"j2.angle\" = -0.2, \"j2.angle_rate\" = 0.5, "
                  "\"j1.angle_rate\" = 0 }\n" +
                  time_of("end = 0.4\nelements = 40", 2),
              "degree = 2", "degree = 2\nmultipliers = \"lower\"")},
    {"angles that turn more than once",
     pendulum +
         "rate = 9\n[start]\nknown = { \"pivot.angle\" = 0 }\n[end]\nknown = { \"pivot.angle\" = 14 "
         "}\n" +
         time_of("end = 1.5\nelements = 90", 2)},
    {"a ball joint and a free body",
     weight + body("top", "[0.3, 0.2, 0.5]") + body("free", "[2, 0, 0]") +
         joint("spherical", "ball", "[\"world\", \"top\"]", "[0, 0, 0]", "") +
         "[start]\nknown = { \"top.x\" = 0.3, \"top.y\" = 0.2, \"ball.rotation_vector_z\" = 0.1, \"free.x\" "
         "= 2, \"free.y\" = 0, \"free.z\" = 0, \"free.rotation_x\" = 0, \"free.rotation_y\" = 0, "
         "\"free.rotation_z\" = 0 }\n[end]\nknown = { \"top.x\" = 0.4, \"top.y\" = 0.3, "
         "\"ball.rotation_vector_z\" = 0.4, \"free.x\" = 3, \"free.y\" = 1, \"free.z\" = 0.5, "
         "\"free.rotation_x\" = 0.3, \"free.rotation_y\" = 0.4, \"free.rotation_z\" = -0.2 }\n" +
         time_of("end = 0.4\nelements = 40", 2)},
};

const Case periodic[] = {
    {"driven, damped",
     cart + "expression = \"3*cos(pi*t)\"\n" + time_of("end = 2\nelements = 40\nperiodic = true", 2)},
};

const Case with_numbers[] = {
    {"a damper, of a rate at the end",
     replaced(chain, "damping = 0.4", "damping = { unknown = 0.3, low = 0 }") +
         "[start]\nknown = { \"j1.angle\" = 0.1, \"j2.angle\" = -0.2, \"j2.angle_rate\" = 0.5, "
         "\"j1.angle_rate\" = 0 }\n[end]\nknown = { \"j2.angle\" = -0.24 }\n" +
         time_of("end = 0.4\nelements = 40", 2)},
    {"how long it takes", pendulum +
                              "[start]\nknown = { \"pivot.angle\" = 0, \"pivot.angle_rate\" = 2 }\n"
                              "[end]\nknown = { \"pivot.angle\" = 0.5 }\n" +
                              time_of("end = { unknown = 0.3, low = 0.05, high = 0.8 }\nelements = 40", 2)},
    {"the period of a swing, which keeps its energy",
     pendulum + "[start]\nknown = { \"pivot.angle\" = 1, \"pivot.angle_rate\" = 0 }\n" +
         time_of("end = { unknown = 2.3 }\nelements = 60\nperiodic = true", 2)},
};

/// Largest difference of places, rates and momenta at element ends, by the largest number of the kind.
double distance(const Motion& whole, const Motion& part, int first)
{
    double off = 0, sizes[3] = {1, 1, 1};
    const auto n = static_cast<std::size_t>(part.n_bodies);
    const auto compare = [&](int kind, const Matrix34& a, const Matrix34& b) {
        for (int c = 0; c < 12; ++c) {
            sizes[kind] = std::max(sizes[kind], std::abs(a.a[c]));
            off = std::max(off, std::abs(a.a[c] - b.a[c]) / sizes[kind]);
        }
    };
    for (int e = 0; e <= part.n_elements(); ++e) {
        const State a = whole.at_end(first + e), b = part.at_end(e);
        const auto at = static_cast<std::size_t>(first + e) * n, here = static_cast<std::size_t>(e) * n;
        off = std::max(off, std::abs(whole.mesh.ends[first + e] - part.mesh.ends[e]));
        for (std::size_t i = 0; i < n; ++i) {
            compare(0, a.X[i], b.X[i]);
            compare(1, a.V[i], b.V[i]);
            compare(2, whole.momenta[at + i], part.momenta[here + i]);
        }
    }
    return off;
}

void expect_the_same(const Case& one, const std::vector<int>& of_ranks)
{
    SCOPED_TRACE(one.what);
    const Solution serial = alone(one.text);
    ASSERT_TRUE(serial.report.converged()) << serial.report.message;
    for (const int n : of_ranks) {
        SCOPED_TRACE(n);
        int next = 0;
        for (const Part& part : by_ranks(one.text, n)) {
            const Solution& s = part.solution;
            ASSERT_TRUE(s.report.converged()) << s.report.message;
            EXPECT_EQ(part.work.first, next);
            EXPECT_EQ(part.work.n_formed, part.work.last - part.work.first);
            EXPECT_EQ(s.motion.n_elements(), part.work.n_formed);
            EXPECT_LT(distance(serial.motion, s.motion, next), 1e-12);
            EXPECT_EQ(s.report.unknowns, serial.report.unknowns);
            // the last steps are at rounding, of which each order of sums has its own
            EXPECT_LE(std::abs(s.report.newton_iterations - serial.report.newton_iterations), 2);
            ASSERT_EQ(s.numbers.values.size(), serial.numbers.values.size());
            for (std::size_t i = 0; i < s.numbers.values.size(); ++i)
                EXPECT_NEAR(s.numbers.values[i], serial.numbers.values[i], 1e-12);
            next = part.work.last;
        }
        EXPECT_EQ(next, serial.motion.n_elements());
    }
}

TEST(RanksBorder, ConditionsByComponentAreThoseOfTheSerialRun)
{
    for (const Case& one : by_component) expect_the_same(one, {1, 2, 4, 7});
}

TEST(RanksBorder, PeriodicMotionsAreThoseOfTheSerialRun)
{
    for (const Case& one : periodic) expect_the_same(one, {1, 2, 3, 4, 7});
}

TEST(RanksBorder, UnknownNumbersAreThoseOfTheSerialRun)
{
    for (const Case& one : with_numbers) expect_the_same(one, {1, 3, 4});
}

/// 4 K(sin(1/2)) / w by the mean of arithmetic and geometric means: closed forms, and their controls.
TEST(RanksBorder, NumbersAreRight)
{
    const double w = std::sqrt(2 * 9.81 / (2 + 0.2));
    double a = 1, b = std::cos(0.5);
    for (int i = 0; i < 8; ++i) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    const double period = 2 * 3.141592653589793 / (w * a);
    const auto off = [&](int elements, int degree) {
        const std::string text =
            pendulum + "[start]\nknown = { \"pivot.angle\" = 1, \"pivot.angle_rate\" = 0 }\n" +
            time_of("end = { unknown = 2.3 }\nelements = " + std::to_string(elements) + "\nperiodic = true",
                    degree);
        const std::vector<Part> parts = by_ranks(text, 4);
        EXPECT_TRUE(parts[0].solution.report.converged()) << parts[0].solution.report.message;
        for (const Part& part : parts)
            EXPECT_EQ(part.solution.numbers.values, parts[0].solution.numbers.values);
        return parts[0].solution.numbers.values.at(0) - period;
    };
    const double coarse = off(40, 2), fine = off(80, 2);
    EXPECT_LT(std::abs(fine), 1e-6);
    EXPECT_NEAR(std::log2(coarse / fine), 4, 0.25) << coarse << " " << fine;
    EXPECT_GT(std::abs(fine), 1e-12) << "the bound sees what a mesh is off by";
}

/// One period later a motion that another period drives is elsewhere.
TEST(RanksBorder, AMotionThatDoesNotRepeatItselfIsSuspect)
{
    const auto status = [](const std::string& force) {
        const std::string text =
            cart + "expression = \"" + force + "\"\n" + time_of("end = 2\nelements = 40\nperiodic = true", 2);
        EXPECT_EQ(alone(text).report.status, by_ranks(text, 3)[1].solution.report.status) << force;
        return by_ranks(text, 3)[0].solution.report.status;
    };
    EXPECT_EQ(status("3*cos(pi*t)"), SolveStatus::converged);
    EXPECT_EQ(status("3*cos(0.9*pi*t)"), SolveStatus::suspect);
}

std::string between_angles(int elements)
{
    return pendulum +
           "[start]\nknown = { \"pivot.angle\" = 0.1 }\n[end]\nknown = { \"pivot.angle\" = 0.9 }\n" +
           time_of("end = 0.5\nelements = " + std::to_string(elements), 1);
}

/// Stretches of few elements, and of so many that they hand on free motions alone.
TEST(RanksBorder, ManyRanksComeToTheSame)
{
    expect_the_same({"few elements", between_angles(256)}, {16, 64});
    expect_the_same({"more elements", between_angles(700)}, {20});
}

/// By a tree and along borders of ranks, and of a border of conditions two places and two momenta more a
/// point or step: messages grow as the logarithm of the number of ranks, bytes hardly.
TEST(RanksBorder, WhatIsSentGrowsAsIsSaid)
{
    const std::string text = between_angles(2048);
    const int at_border = 2 * 12 + 5 + 6;   // numbers of X, P, a hinge and rigidity
    std::vector<long long> bytes, messages;
    for (int n = 4; n <= 64; n *= 2) {
        const std::vector<Part> parts = by_ranks(text, n);
        Traffic most;
        long long flops = 0;
        for (std::size_t r = 1; r < parts.size(); ++r) {
            most.bytes = std::max(most.bytes, parts[r].work.of_solution.bytes);
            most.messages = std::max(most.messages, parts[r].work.of_solution.messages);
            flops = std::max(flops, parts[r].work.flops);
        }
        bytes.push_back(most.bytes);
        messages.push_back(most.messages);
        EXPECT_EQ(parts[0].work.n_chain, 4 * (n - 2));   // one free motion; both ends of time hold half
        EXPECT_EQ(parts[1].work.n_left, 2 * at_border);
        EXPECT_EQ(parts[1].work.n_in_chain, 4);
        std::printf("%2d ranks: %lld messages, %lld bytes, %lld flops; of the first %lld, %lld\n", n,
                    most.messages, most.bytes, flops, parts[0].work.of_solution.messages,
                    parts[0].work.of_solution.bytes);
    }
    for (std::size_t i = 2; i < messages.size(); ++i) {   // of four ranks the inner ones see outer ones
        EXPECT_EQ(messages[i] - messages[i - 1], messages[1] - messages[0]);
        EXPECT_EQ(bytes[i] - bytes[i - 1], bytes[2] - bytes[1]);
    }
    EXPECT_LT(8 * bytes.back(), 9 * bytes[2]);
}

TEST(RanksBorder, WhatIsNotLookedForIsRefused)
{
    const auto code = [](const std::string& text, int roots) {
        const Scenario s = scenario_of(text);
        SolveOptions options = s.options;
        options.roots = roots;
        try {
            check_ranks(s.model, problem_of(s), s.time, s.method, options, 2);
        } catch (const InputError& why) {
            return std::string(why.complaint().code);
        }
        return std::string();
    };
    EXPECT_EQ(code(between_angles(20), 3), "ranks-conditions");
    EXPECT_EQ(code(between_angles(20), 1), "") << "negative control";
    EXPECT_EQ(code(replaced(between_angles(20), "family = \"mixed\"", "family = \"lobatto\""), 1),
              "ranks-method");
}

/// A periodic motion with a number joins both ends of time: as many unknowns of the chain more as there are
/// conditions of both ends, and numbers.
TEST(RanksBorder, TheChainHasTheBorderBesideIt)
{
    const std::string text = replaced(replaced(with_numbers[2].text, "elements = 60", "elements = 640"),
                                      "degree = 2", "degree = 1");
    for (const int n : {1, 2, 4, 7})
        for (const Part& part : by_ranks(text, n)) {
            // two conditions of both ends, the period and what unfolds; a border has 4 f, and two more for
            // the period, which all elements see; those of the outer ranks have two less
            EXPECT_EQ(part.work.n_chain, 2 + 2 + (n > 1 ? 6 * (n - 1) - 4 : 0)) << n;
            EXPECT_EQ(part.work.n_formed, part.work.last - part.work.first);
        }
}

}   // namespace

}   // namespace livens
