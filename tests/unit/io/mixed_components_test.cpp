// SPDX-License-Identifier: BSD-3-Clause
// Conditions by component with elements of the paper: against lobatto to the same conditions, by order, and
// what does not determine a motion.
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "livens/diagnostics/sample.h"
#include "livens/io/solve_scenario.h"
#include "sanitized.h"
#include "unit/io/scenario_text.h"

namespace livens::mixed_components_test {

namespace {

using test::read;
using test::shown;

Scenario scenario_of(const std::string& text)
{
    ScenarioResult result = read("format = 1\n" + text);
    if (!result.scenario) throw std::logic_error(shown(result));
    return std::move(*result.scenario);
}

Solution solution_of(const std::string& text)
{
    const Scenario s = scenario_of(text);
    Problem problem{s.conditions};
    problem.unknowns = s.unknowns;
    return solve(s.model, problem, s.time, s.method, s.options);
}

const std::string mixed2 = "family = \"mixed\"\nbasis = \"lagrange\"\ndegree = 2",
                  mixed3 = "family = \"mixed\"\nbasis = \"lagrange\"\ndegree = 3",
                  fine = "family = \"lobatto\"\ndegree = 8";

std::string number(double x)
{
    char text[64];
    std::snprintf(text, sizeof text, "%.17g", x);
    return text;
}

std::string in_time(double end, int elements, const std::string& method)
{
    return "\n[time]\nend = " + number(end) + "\nelements = " + std::to_string(elements) +
           "\n[method]\nestimate = \"none\"\n" + method + "\n";
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

/// Two bodies on hinges whose axes are not parallel, with a damper.
const std::string chain =
    "gravity = [0, 0, -9.81]\n" + body("upper", "[0.5, 0, 0]") + body("lower", "[1.5, 0, 0]") +
    joint("revolute", "j1", "[\"world\", \"upper\"]", "[0, 0, 0]", "[0, 1, 0.2]") +
    joint("revolute", "j2", "[\"upper\", \"lower\"]", "[1, 0, 0]", "[0.3, 1, 0]") +
    "[[load]]\ntype = \"spring\"\nname = \"s\"\njoint = \"j2\"\nstiffness = 3\ndamping = 0.4\n";

/// The largest distance of both motions at some instants.
double gap(const Motion& a, const Motion& b)
{
    double largest = 0;
    for (int k = 0; k <= 8; ++k) {
        const double t = a.start() + (a.end() - a.start()) * k / 8;
        const State x = sample_state(a, t), y = sample_state(b, t);
        for (std::size_t i = 0; i < x.X.size(); ++i) largest = std::max(largest, norm(x.X[i] - y.X[i]));
    }
    return largest;
}

struct Case {
    const char* what;
    std::string text;
    double end;
};

const Case cases[] = {
    {"an angle at the start and one at the end, a rate and an angle",
     chain + "[start]\nknown = { \"j1.angle\" = 0.1, \"j2.angle\" = -0.2, \"j2.angle_rate\" = 0.5 }\n"
             "[end]\nknown = { \"j1.angle\" = 0.9 }\n",
     0.5},
    {"a place of the tip at the end",
     chain + "[[sensor]]\ntype = \"point\"\nname = \"tip\"\nbody = \"lower\"\npoint = [0.5, 0, 0]\n"
             "[start]\nknown = { \"j1.angle\" = 0, \"j2.angle\" = 0 }\n"
             "[end]\nknown = { \"tip.z\" = -0.9, \"tip.x\" = 1.6 }\n",
     0.6},
    {"nothing but the end",
     chain + "[end]\nknown = { \"j1.angle\" = 0.9, \"j2.angle\" = 0.2, \"j1.angle_rate\" "
             "= 1, \"j2.angle_rate\" = -1 }\n",
     0.4},
    {"a ball joint and a free body",
     "gravity = [0, 0, -9.81]\n" + body("top", "[0.3, 0.2, 0.5]") + body("free", "[2, 0, 0]") +
         joint("spherical", "ball", "[\"world\", \"top\"]", "[0, 0, 0]", "") +
         "[start]\nknown = { \"top.x\" = 0.3, \"top.y\" = 0.2, \"ball.rotation_vector_z\" = 0.1, \"free.x\" "
         "= 2, "
         "\"free.y\" = 0, \"free.z\" = 0, \"free.rotation_x\" = 0, \"free.rotation_y\" = 0, "
         "\"free.rotation_z\" = 0 }\n"
         "[end]\nknown = { \"top.x\" = 0.4, \"top.y\" = 0.3, \"ball.rotation_vector_z\" = 0.4, \"free.x\" = "
         "3, "
         "\"free.y\" = 1, \"free.z\" = 0.5, \"free.rotation_x\" = 0.3, \"free.rotation_y\" = 0.4, "
         "\"free.rotation_z\" = -0.2 }\n",
     0.4}};

TEST(MixedComponents, ConvergeToTheMotionThatTheConditionsHave)
{
    if (is_sanitized) GTEST_SKIP() << study;
    for (const Case& one : cases) {
        SCOPED_TRACE(one.what);
        const Solution truth = solution_of(one.text + in_time(one.end, 20, fine));
        ASSERT_TRUE(truth.report.converged()) << truth.report.message;
        for (const auto& [method, order] : {std::pair{mixed2, 1.9}, {mixed3, 3.7}}) {
            const Solution coarse = solution_of(one.text + in_time(one.end, 16, method)),
                           finer = solution_of(one.text + in_time(one.end, 32, method));
            ASSERT_TRUE(coarse.report.converged()) << coarse.report.message;
            ASSERT_TRUE(finer.report.converged()) << finer.report.message;
            const double off = gap(finer.motion, truth.motion), before = gap(coarse.motion, truth.motion);
            EXPECT_LT(off, 3e-4);
            // inside of elements polynomials of degree p are of order p + 1
            EXPECT_GT(std::log2(before / off), order) << before << " " << off;
            EXPECT_LT(finer.report.most_iterations, 16);
        }
    }
}

std::string pendulum(const std::string& given, double end, const std::string& method)
{
    return "gravity = [0, 0, -9.81]\n" + body("rod", "[0.2, 0, -1]") + given +
           joint("revolute", "pin", "[\"world\", \"rod\"]", "[0, 0, 0]", "[0, 1, 0]") +
           in_time(end, 40, method);
}

/// A mass on a spring, 0.1 m from where that rests.
std::string spring(const std::string& given, bool ends, double end, const std::string& method)
{
    return "[[body]]\nname = \"cart\"\nmass = 2\ninertia = [1, 1, 1]\nposition = [0.1, 0, 0]\n" +
           std::string(ends ? "[body.end]\nposition = [-0.1, 0, 0]\n" : "") +
           joint("prismatic", "rail", "[\"world\", \"cart\"]", "[0, 0, 0]", "[1, 0, 0]") +
           "[[load]]\ntype = \"spring\"\nname = \"s\"\njoint = \"rail\"\nstiffness = 8\nrest = -0.1\n" +
           given + in_time(end, 40, method);
}

TEST(MixedComponents, WhatLeavesAMotionFreeIsRefused)
{
    const std::string by_component = "[start]\nknown = { \"rail.displacement\" = 0 }\n"
                                     "[end]\nknown = { \"rail.displacement\" = -0.2 }\n",
                      places = "[start]\ngiven = \"positions\"\n[end]\ngiven = \"positions\"\n";
    const auto methods = is_sanitized ? std::vector{mixed2} : std::vector{mixed2, mixed3, fine};
    for (const std::string& method : methods)
        for (const double share : {1.0, 0.6})
            for (const std::string& given : {by_component, places}) {
                SCOPED_TRACE(method + given);
                // Half a period of 2 rad/s: places at both ends leave the size of the swing open.
                const double half_period = 3.141592653589793 / 2;
                const Solution s = solution_of(spring(given, given == places, share * half_period, method));
                EXPECT_EQ(s.report.converged(), share != 1) << share << s.report.message;
                EXPECT_TRUE(share != 1 || s.report.status == SolveStatus::not_converged ||
                            s.report.message.find("do not determine the motion") != std::string::npos)
                    << s.report.message;
            }
}

/// Driven by a force, damped, from any guess: the steady vibration.
TEST(MixedComponents, PeriodicMotionsOfForces)
{
    const std::string text =
        "[[body]]\nname = \"cart\"\nmass = 2\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\n" +
        joint("prismatic", "rail", "[\"world\", \"cart\"]", "[0, 0, 0]", "[1, 0, 0]") +
        "[[load]]\ntype = \"spring\"\nname = \"s\"\njoint = \"rail\"\nstiffness = 8\ndamping = 1\n"
        "[[load]]\ntype = \"actuator\"\nname = \"f\"\njoint = \"rail\"\nexpression = \"3*cos(pi*t)\"\n";
    const auto at = [&](int elements) {
        return solution_of(text + "[time]\nend = 2\nperiodic = true\nelements = " + std::to_string(elements) +
                           "\n[method]\nestimate = \"none\"\n" + mixed3 + "\n");
    };
    const Solution s = at(20), finer = at(40);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    // k - m w^2 + i c w
    const double w = 3.141592653589793, real = 8 - 2 * w * w, size = 3 / std::hypot(real, w);
    const double x = size * real / std::hypot(real, w);
    EXPECT_NEAR(sample_state(s.motion, 0).X[0](0, 0), x, 1e-5);
    EXPECT_NEAR(sample_state(s.motion, 2).X[0](0, 0), x, 1e-5);
    EXPECT_NEAR(sample_state(finer.motion, 0).X[0](0, 0), x, 1e-6);
}

/// A damper, and how long it takes, by conditions that lobatto meets, too.
TEST(MixedComponents, UnknownNumbersConvergeToThoseOfLobatto)
{
    if (is_sanitized) GTEST_SKIP() << study;
    const std::string
        start = "[start]\nknown = { \"j1.angle\" = 0.1, \"j2.angle\" = -0.2, \"j2.angle_rate\" = 0.5, "
                "\"j1.angle_rate\" = 0 }\n",
        damper = test::replaced(chain, "damping = 0.4", "damping = { unknown = 0.3, low = 0 }");
    const auto timed = [](std::string text) {
        return test::replaced(std::move(text), "end = 0.5", "end = { unknown = 0.5, low = 0.1, high = 1 }");
    };
    const auto number_of = [&](bool is_duration, int elements, const std::string& method) {
        const std::string of_damper = damper + start + "[end]\nknown = { \"j2.angle\" = -0.24 }\n" +
                                      in_time(0.4, elements, method),
                          of_time = timed(chain + start + "[end]\nknown = { \"j1.angle\" = 0.5 }\n" +
                                          in_time(0.5, elements, method));
        const Solution s = solution_of(is_duration ? of_time : of_damper);
        EXPECT_TRUE(s.report.converged()) << s.report.message;
        return s.numbers.values.empty() ? std::nan("") : s.numbers.values[0];
    };
    for (const bool is_duration : {false, true}) {
        const double truth = number_of(is_duration, 20, fine);
        for (const auto& [method, order] : {std::pair{mixed2, 2.8}, {mixed3, 3.5}}) {
            const double before = number_of(is_duration, 16, method) - truth,
                         off = number_of(is_duration, 32, method) - truth;
            EXPECT_LT(std::abs(off), 1e-4) << method;
            // of degree p they are of order p + 1, as places inside of elements are
            EXPECT_GT(std::log2(std::abs(before / off)), order) << before << " " << off;
        }
    }
}

TEST(MixedComponents, WhatTheyCannotIsRefused)
{
    const auto code_of = [](const std::string& text) {
        try {
            solution_of(text);
        } catch (const InputError& why) {
            return std::string(why.complaint().code);
        } catch (const std::logic_error& told) {
            return std::string(told.what());
        }
        return std::string();
    };
    const std::string known =
        "[start]\nknown = { \"pin.angle\" = 0 }\n[end]\nknown = { \"pin.angle\" = 0.2 }\n";
    EXPECT_NE(code_of(pendulum(known, 0.5, mixed2 + "\nmomentum = \"strong\"")).find("conditions-method"),
              std::string::npos);
    EXPECT_NE(code_of(pendulum(known, 0.5, mixed2 + "\nwindow = 4")).find("mixed-block"), std::string::npos);
    EXPECT_NE(code_of(pendulum(known, 0.5, "family = \"radau\"\ndegree = 3")).find("conditions-method"),
              std::string::npos);
    const std::string momenta = "[start]\ngiven = \"momenta\"\n[end]\nknown = { \"pin.angle\" = 0.2 }\n";
    EXPECT_NE(code_of(pendulum(momenta, 0.5, mixed2)).find("conditions-method"), std::string::npos);
    EXPECT_EQ(code_of(pendulum(momenta, 0.5, fine)), "") << "negative control";
    const std::string from_state =
        "[end]\nknown = { \"pin.angle\" = 0.2 }\n[[load]]\ntype = \"spring\"\nname = "
        "\"s\"\njoint = \"pin\"\nstiffness = { unknown = 3 }\n";
    EXPECT_NE(code_of(pendulum(from_state, 0.5, mixed2)).find("conditions"), std::string::npos)
        << code_of(pendulum(from_state, 0.5, mixed2));
    EXPECT_EQ(code_of(pendulum(known, 0.5, mixed2)), "") << "negative control";
}

}   // namespace

}   // namespace livens::mixed_components_test
