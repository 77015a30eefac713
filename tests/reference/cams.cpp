// SPDX-License-Identifier: BSD-3-Clause
// Couplings by a law: cams and what else follows another coordinate, against one equation of motion for the
// coordinate that leads, in small steps of Runge and Kutta.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "livens/base/text.h"
#include "reference/shipped.h"
#include "reference/solved.h"

namespace livens::tests::cams_test {
namespace {

using std::numbers::pi;

/// A law and its two derivatives.
struct Law {
    std::function<double(double)> f, first, second;
};

constexpr double inertia = 0.3, mass = 2, pull = 5;   // of the cam, of the follower, N on it

/// (J + m f'^2) q'' + m f' f'' q'^2 = F f', from q = from with a rate.
std::array<double, 2> turned(const Law& law, double from, double rate, double t, int n = 40000)
{
    const auto slope = [&](double q, double v) {
        const double f1 = law.first(q), f2 = law.second(q);
        return (pull * f1 - mass * f1 * f2 * v * v) / (inertia + mass * f1 * f1);
    };
    const double h = t / n;
    double q = from, v = rate;
    for (int i = 0; i < n; ++i) {
        const double v1 = v, a1 = slope(q, v), v2 = v + h / 2 * a1, a2 = slope(q + h / 2 * v1, v2),
                     v3 = v + h / 2 * a2, a3 = slope(q + h / 2 * v2, v3), v4 = v + h * a3,
                     a4 = slope(q + h * v3, v4);
        q += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
        v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    return {q, v};
}

/// A cam that turns about z (or a slide that leads along z) and a follower along x, pulled by a constant
/// force.
std::string machine(const std::string& law, double from, double rate, double follower, bool slides = false)
{
    const std::string lead = slides ? "lead.displacement" : "lead.angle";
    return "[[body]]\nname = \"cam\"\nmass = 0.3\ninertia = [0.3, 0.3, 0.3]\n" +
           std::string(slides ? "velocity" : "angular_velocity") + " = [0, 0, " + to_text(rate) + "]\n" +
           "[[body]]\nname = \"follower\"\nmass = 2\ninertia = [1, 1, 1]\nposition = [3, 0, 0]\n"
           "[[joint]]\nname = \"lead\"\ntype = \"" +
           (slides ? "prismatic" : "revolute") +
           "\"\nbetween = [\"world\", \"cam\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\ncoordinate = " +
           to_text(from) +
           "\n[[joint]]\nname = \"slide\"\ntype = \"prismatic\"\nbetween = [\"world\", \"follower\"]\n"
           "at = [3, 0, 0]\naxis = [1, 0, 0]\ncoordinate = " +
           to_text(follower) + "\n[[load]]\ntype = \"force\"\nbody = \"follower\"\nvalue = [5, 0, 0]\n" +
           "[[joint]]\nname = \"law\"\ntype = \"coupling\"\nterms = { \"slide.displacement\" = 1 }\n" +
           "law = { of = \"" + lead + "\", " + law + " }\n[start]\ninitial = \"project\"\n";
}

/// Projected: the momentum J w of the cam alone is shared with the follower.
double shared(const Law& law, double from, double rate)
{
    const double f1 = law.first(from);
    return inertia * rate / (inertia + mass * f1 * f1);
}

std::string time(double end, const std::string& method = "family = \"lobatto\"", double accuracy = 1e-11)
{
    return "[time]\nend = " + to_text(end) + "\naccuracy = " + to_text(accuracy) +
           "\noutput = " + to_text(end) + "\n[method]\n" + method + "\n";
}

std::string table(const std::function<double(double)>& f, double from, double until, int n, bool is_periodic)
{
    std::string at = "coordinates = [", values = "], values = [";
    for (int k = 0; k <= n; ++k) {
        const double q = from + (until - from) * k / n;
        const std::string comma = k == 0 ? "" : ", ";
        at += comma + to_text(q);
        values += comma + to_text(k == n && is_periodic ? f(from) : f(q));
    }
    return at + values + "]" + (is_periodic ? ", periodic = true" : "");
}

const Law sine{[](double q) { return 0.4 * (1 - std::cos(q)); }, [](double q) { return 0.4 * std::sin(q); },
               [](double q) { return 0.4 * std::cos(q); }};

TEST(Cams, ASineLawThroughManyTurns)
{
    constexpr double from = 0.3, end = 6;
    const double rate = shared(sine, from, 14);
    const auto [q, v] = turned(sine, from, rate, end);
    EXPECT_GT(q, 8 * pi);
    EXPECT_NEAR(q, turned(sine, from, rate, end, 20000)[0], 1e-9) << "its own error";
    for (const char* method : {"family = \"lobatto\"", "family = \"radau\""}) {
        const Solved run = solved(machine("expression = \"0.4*(1 - cos(angle))\"", from, 14, sine.f(from)) +
                                  time(end, method));
        EXPECT_NEAR(run.coordinate("lead", "angle", end).value, q, 1e-9) << method;
        EXPECT_NEAR(run.coordinate("lead", "angle", end).rate, v, 1e-8) << method;
        EXPECT_NEAR(run.coordinate("slide", "displacement", end).value, sine.f(q), 1e-10) << method;
        EXPECT_LT(run.solution.verdict.energy_drift, 1e-11) << method;
        // the follower: m x'' = F + reaction
        const double f1 = sine.first(q), f2 = sine.second(q);
        const double a = (pull * f1 - mass * f1 * f2 * v * v) / (inertia + mass * f1 * f1);
        EXPECT_NEAR(run.reaction("law", end).force[0], mass * (f1 * a + f2 * v * v) - pull, 1e-7) << method;
    }
}

TEST(Cams, ASplineThroughManyRowsIsTheSine)
{
    constexpr double from = 0.3, end = 3;
    const double rate = shared(sine, from, 14);
    const double q = turned(sine, from, rate, end)[0];
    double before = 0;
    for (const int n : {12, 24, 48}) {
        const Solved run = solved(machine(table(sine.f, 0, 2 * pi, n, true), from, 14, sine.f(from)) +
                                  time(end, "family = \"lobatto\"", 1e-9));
        const double error = std::abs(run.coordinate("lead", "angle", end).value - q);
        EXPECT_LT(error, 0.1 * std::pow(12.0 / n, 4)) << n;
        EXPECT_LT(run.solution.verdict.energy_drift, 1e-8);
        EXPECT_GT(before / error, before > 0 ? 4 : -1) << n;
        before = error;
    }
}

/// Cubics are splines: a polynomial law tells exactly what knots do.
TEST(Cams, ATableOfACubicIsTheCubic)
{
    const Law cubic{[](double q) { return 0.2 * q * q * q - 0.5 * q; },
                    [](double q) { return 0.6 * q * q - 0.5; }, [](double q) { return 1.2 * q; }};
    for (const bool slides : {true, false}) {
        constexpr double from = -0.8, end = 0.5;
        const double rate = shared(cubic, from, 3), q = turned(cubic, from, rate, end)[0];
        EXPECT_GT(q, from + 0.5);
        EXPECT_LT(q, 1.4);
        for (const std::string& law :
             {table(cubic.f, -1.5, 1.5, 6, false),
              std::string(slides ? "expression = \"0.2*displacement^3 - 0.5*displacement\""
                                 : "expression = \"0.2*angle^3 - 0.5*angle\"")}) {
            const Solved run = solved(machine(law, from, 3, cubic.f(from), slides) + time(end));
            EXPECT_NEAR(run.coordinate("lead", slides ? "displacement" : "angle", end).value, q, 1e-9) << law;
        }
    }
}

/// Three lobes a turn, and a start a turn on.
TEST(Cams, APeriodMayBeAPartOfATurn)
{
    const Law lobes{[](double q) { return 0.1 * std::sin(3 * q); },
                    [](double q) { return 0.3 * std::cos(3 * q); },
                    [](double q) { return -0.9 * std::sin(3 * q); }};
    const double from = 0.2 + 4 * pi, end = 2;
    const double rate = shared(lobes, from, 9), q = turned(lobes, from, rate, end)[0];
    const Solved run = solved(machine(table(lobes.f, 0, 2 * pi / 3, 40, true), from, 9, lobes.f(from)) +
                              time(end, "family = \"lobatto\"", 1e-9));
    EXPECT_NEAR(run.coordinate("lead", "angle", end).value, q, 1e-4);
    EXPECT_GT(q - from, 2 * pi);
}

/// An indexing table: it turns by a quarter with each turn of its driver, and stands still in between.
TEST(Cams, ALawOfAnAngleMayRiseWithEachTurn)
{
    const std::string text =
        "[[body]]\nname = \"driver\"\nmass = 1\ninertia = [1, 1, 1]\nangular_velocity = [0, 0, 7]\n"
        "[[body]]\nname = \"plate\"\nmass = 1\ninertia = [0.2, 0.2, 0.2]\nposition = [2, 0, 0]\n"
        "[[joint]]\nname = \"driver\"\ntype = \"revolute\"\nbetween = [\"world\", \"driver\"]\nat = [0, 0, "
        "0]\naxis = "
        "[0, 0, 1]\n[[joint]]\nname = \"plate\"\ntype = \"revolute\"\nbetween = [\"world\", \"plate\"]\nat = "
        "[2, 0, "
        "0]\naxis = [0, 0, 1]\n"
        "[[joint]]\nname = \"index\"\ntype = \"coupling\"\nterms = { \"plate.angle\" = 1 }\nlaw = { of = "
        "\"driver.angle\", expression = \"0.25*(angle - sin(angle))\" }\n";
    const Solved run = solved(text + time(4));
    const double a = run.coordinate("driver", "angle", 4).value;
    EXPECT_GT(a, 3 * 2 * pi);
    EXPECT_NEAR(run.coordinate("plate", "angle", 4).value, 0.25 * (a - std::sin(a)), 1e-10);
    // (1 + 0.2 f'^2) a'^2 is kept: at the start f' = 0
    const double f1 = 0.25 * (1 - std::cos(a)), w = run.coordinate("driver", "angle", 4).rate;
    EXPECT_NEAR((1 + 0.2 * f1 * f1) * w * w, 49, 1e-8);
}

TEST(Cams, ALawThatEndsIsToldByName)
{
    const ScenarioResult read = parse_scenario(
        "format = 1\n" + machine("coordinates = [-1, 0, 1], values = [0, 0.1, 0]", 0.2, 3, 0.096) +
            "[time]\nend = 2\naccuracy = 1e-8\n",
        "test.toml");
    ASSERT_TRUE(read.scenario);
    const Scenario& s = *read.scenario;
    const Solution solution = solve(s.model, {s.model.start()}, s.time, s.method, s.options);
    EXPECT_FALSE(solution.report.converged());
    EXPECT_NE(
        solution.report.message.find("'lead.angle' leaves the law of 'law', which is known from -1 to 1 rad"),
        std::string::npos)
        << solution.report.message;
}

TEST(Cams, WhatNoLawIsGetsOneErrorEach)
{
    const auto begins = [](const std::string& law, const std::string& code, double from = 0.0) {
        const ScenarioResult read =
            parse_scenario("format = 1\n" + machine(law, from, 1, 0) + "[time]\nend = 1\n", "test.toml");
        ASSERT_EQ(read.diagnostics.size(), 1u) << law << " " << code;
        EXPECT_EQ(read.diagnostics[0].code, code) << read.diagnostics[0].message;
        EXPECT_GT(read.diagnostics[0].line, 20) << read.diagnostics[0].message;
    };
    begins("coordinates = [0, 1, 1], values = [0, 1, 2]", "table-order");
    begins("coordinates = [0, 2, 1], values = [0, 1, 2]", "table-order");
    begins("coordinates = [0, 1], values = [0, 1, 2]", "table-size");
    begins("coordinates = [0], values = [0]", "table-size");
    begins("coordinates = [0, 1, nan], values = [0, 1, 2]", "not-finite");
    begins("coordinates = [0, 1, 2], values = [0, inf, 2]", "not-finite");
    begins("coordinates = [0, 1]", "coupling-law");
    begins("periodic = true", "coupling-law");
    begins("expression = \"angle\", coordinates = [0, 1], values = [0, 1]", "coupling-law");
    begins("expression = \"abs(angle)\"", "coupling-law");
    begins("expression = \"max(angle, 0)\"", "coupling-law");
    begins("expression = \"angle*t\"", "coupling-law");
    begins("expression = \"2\"", "input-unused");
    begins("expression = \"sin(phi)\"", "expression-name");
    begins("expression = \"slide.displacement\"", "coupling-law");
    begins("expression = \"log(angle)\"", "coupling-law");
    begins("coordinates = [1, 2], values = [0, 1]", "coupling-range");
    begins("coordinates = [0, 2, 4, 7], values = [0, 1, 2, 3]", "coupling-law");
    begins("coordinates = [0, 1, 2, 3], values = [0, 1, 2, 0], periodic = true", "coupling-law");
    begins("coordinates = [0, 2, 4, 6.283185307179586], values = [0, 1, 2, 1], periodic = true",
           "coupling-law");
    begins("coordinates = [0, 2, 6.283185307179586], values = [0, 1, 0], periodic = true", "table-size");
    begins("coordinates = [\"0 m\", \"1 m\"], values = [0, 1]", "unit");
    begins("coordinates = [0, 1], values = [\"0 deg\", \"1 deg\"]", "unit");
}

/// Not where the bodies are placed, if coordinates lead them to another start.
TEST(Cams, ALawIsJudgedWhereTheMotionBegins)
{
    const auto started = [](const std::string& law, double value, const std::string& more = "") {
        return parse_scenario("format = 1\n" + machine(law, 0, 0, 0) +
                                  "[[start.coordinates]]\njoint = \"lead\"\nvalue = " + to_text(value) +
                                  "\n" + more + "[time]\nend = 0.1\n",
                              "test.toml");
    };
    const std::string rises = "coordinates = [1, 2, 3, 4], values = [0, 0.1, 0.2, 0.1]",
                      grows = "expression = \"log(angle)\"";
    for (const auto& [law, value, follower] :
         {std::tuple(rises, 2.0, 0.1), {rises, 1.0, 0.0}, {rises, 4.0, 0.1}, {grows, 2.0, std::log(2.0)}}) {
        const ScenarioResult read = started(law, value, "rate = 0.5\n");
        ASSERT_TRUE(read.scenario) << law << read.diagnostics.at(0).message;
        const State start = read.scenario->model.start();
        EXPECT_NEAR(start.X[0](1, 1), std::sin(value), 1e-12) << "the value that was wanted";
        EXPECT_NEAR(start.X[1](0, 0), 3 + follower, 1e-9) << law;
        EXPECT_NEAR(angular_velocity(start.X[0], start.V[0])[2], 0.5, 1e-12);
    }
    for (const double value : {0.5, 5.0}) {
        const ScenarioResult outside = started(rises, value);
        ASSERT_EQ(outside.diagnostics.size(), 1u);
        EXPECT_EQ(outside.diagnostics[0].code, "coupling-range") << outside.diagnostics[0].message;
        EXPECT_NE(outside.diagnostics[0].message.find(value < 1 ? "by 0.5 rad" : "by 1 rad"),
                  std::string::npos)
            << outside.diagnostics[0].message;
    }
    EXPECT_EQ(started(grows, -0.5).diagnostics.at(0).code, "coupling-law");
}

TEST(Cams, OneCoordinateIsNotOnBothSides)
{
    for (const auto& [of, code] : {std::pair{"slide.displacement", "coupling-terms"},
                                   {"nothing.angle", "joint-unknown"},
                                   {"lead", "joint-coordinate"},
                                   {"lead.displacement", "joint-coordinate"}}) {
        std::string text = machine("expression = \"3*displacement\"", 0, 0, 0);
        const std::size_t at = text.find("\"lead.angle\"");
        text.replace(at, std::string("\"lead.angle\"").size(), "\"" + std::string(of) + "\"");
        const ScenarioResult read = parse_scenario("format = 1\n" + text + "[time]\nend = 1\n", "test.toml");
        ASSERT_EQ(read.diagnostics.size(), 1u) << of;
        EXPECT_EQ(read.diagnostics[0].code, code) << read.diagnostics[0].message;
    }
}

/// Lift and force are those of an eccentric disc that is driven by 60 t^2.
TEST(Cams, TheExampleOfATappet)
{
    const Shipped cam = solve_example("cam");
    constexpr double e = 0.01, m = 0.5, k = 2000;
    const Motion& motion = cam.solution.motion;
    for (const double t : {0.2, 0.5, 0.77, 0.971, 0.995}) {
        const double q = 60 * t * t, w = 120 * t;
        EXPECT_NEAR(sample_state(motion, t).X[1](2, 0), 0.05 + e * (1 - std::cos(q)), 1e-9) << t;
        const double force =
            m * (9.81 + e * (std::cos(q) * w * w + std::sin(q) * 120)) + k * e * (2 - std::cos(q));
        EXPECT_NEAR(sample_joints(cam.model, motion, t)[2].right.force[2], force, 1e-6) << t;
        EXPECT_EQ(force<0, t> 0.99) << "where the tappet would leave the disc";
    }
}

/// Elements with knots at their ends keep their order, 2p.
TEST(Cams, OrderIs2p)
{
    constexpr double end = 0.5;
    const double rate = shared(sine, 0.3, 14), q = turned(sine, 0.3, rate, end)[0];
    const auto error = [&](int degree, int n) {
        const Solved run =
            solved(machine("expression = \"0.4*(1 - cos(angle))\"", 0.3, 14, sine.f(0.3)) +
                   "[time]\nend = 0.5\nelements = " + std::to_string(n) +
                   "\n[method]\nestimate = \"none\"\ndegree = " + std::to_string(degree) + "\n");
        return std::abs(run.coordinate("lead", "angle", end).value - q);
    };
    for (const auto& [degree, n] : {std::pair{1, 80}, {2, 40}, {3, 24}})
        EXPECT_NEAR(std::log2(error(degree, n) / error(degree, 2 * n)), 2 * degree, 0.25) << degree;
}

}   // namespace
}   // namespace livens::tests::cams_test
