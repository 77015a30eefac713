// SPDX-License-Identifier: BSD-3-Clause
// Flights behind events, springs that stop, and what conditions and stops are refused with.
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

#include "livens/spacetime/solve.h"
#include "unit/io/swinging_rod.h"

namespace livens::events_truth_test {

namespace {

using test::find;
using test::read;
using test::shown;
using test::solved;

constexpr double g = 9.81;

/// Integral by Gauss's rule of five points on 400 parts.
template <class F>
double integral(const F& f, double low, double high)
{
    const long double a = std::sqrt(5 - 2 * std::sqrt(10.0L / 7)) / 3,
                      b = std::sqrt(5 + 2 * std::sqrt(10.0L / 7)) / 3,
                      wa = (322 + 13 * std::sqrt(70.0L)) / 900, wb = (322 - 13 * std::sqrt(70.0L)) / 900,
                      w0 = 128.0L / 225;
    constexpr int parts = 400;
    long double sum = 0;
    for (int k = 0; k < parts; ++k) {
        const long double h = (static_cast<long double>(high) - low) / parts, m = low + (k + 0.5L) * h,
                          s = h / 2;
        sum += s * (w0 * f(m) + wa * (f(m - a * s) + f(m + a * s)) + wb * (f(m - b * s) + f(m + b * s)));
    }
    return static_cast<double>(sum);
}

/// From the top of a sphere of 1 m with v, off it at cos = 2/3 + v^2/(3 g), down to a plane.
TEST(EventsTruth, AMassLeavesASphereAndLands)
{
    for (const double v : {0.5, 1.0, 2.0}) {
        std::ostringstream text;
        text.precision(17);
        text << "format = 1\ngravity = [0, 0, -9.81]\nbody = [{ name = \"ball\", shape = { point = true }, "
                "mass "
                "= 3, position = [0, 0, 1], velocity = ["
             << v << R"(, 0, 0] }]
[[stop]]
name = "sphere"
between = ["world", "ball"]
limits = [1, inf]
[[sensor]]
name = "place"
type = "point"
body = "ball"
[[event]]
name = "lands"
when = "place.z < -1.5"
action = "stop"
[time]
end = 3
accuracy = 1e-11
)";
        const SolvedScenario s = solved(text.str());
        const Solution& solution = s.solution;
        ASSERT_TRUE(solution.report.converged()) << solution.report.message;
        ASSERT_EQ(solution.events.size(), 3u);   // closed at the start, opens, lands
        const double cosine = 2.0 / 3 + v * v / (3 * g), sine = std::sqrt(1 - cosine * cosine),
                     speed = std::sqrt(v * v + 2 * g * (1 - cosine));
        const double leaves = integral(
            [&](long double a) {
                const long double h = std::sin(a / 2);
                return 1 /
                       std::sqrt(static_cast<long double>(v) * v + 4 * static_cast<long double>(g) * h * h);
            },
            0, std::acos(cosine));
        EXPECT_NEAR(solution.events[1].t, leaves, 1e-12) << v;
        const double down = speed * sine,
                     falls = (std::sqrt(down * down + 2 * g * (cosine + 1.5)) - down) / g;
        EXPECT_NEAR(solution.events[2].t, leaves + falls, 1e-12) << v;
        const State end = solution.motion.at_end(solution.motion.n_elements());
        EXPECT_NEAR(end.X[0](0, 0), sine + speed * cosine * falls, 1e-11) << v;
    }
}

std::string trebuchet(const std::string& until)
{
    return R"(format = 1
gravity = [0, 0, -9.81]
body = [
    { name = "arm", shape = { box = [1, 0.04, 0.04] }, mass = 2, position = [0.5, 0, 0] },
    { name = "stone", shape = { sphere = 0.05 }, mass = 0.5, position = [1.05, 0, 0] }
]
[[joint]]
name = "axle"
type = "revolute"
between = ["world", "arm"]
at = [0, 0, 0]
axis = [0, 1, 0]
[[joint]]
name = "hand"
type = "weld"
between = ["arm", "stone"]
at = [1, 0, 0]
until = )" +
           until +
           R"(
[[load]]
type = "actuator"
joint = "axle"
value = -40
[[sensor]]
name = "flight"
type = "point"
body = "stone"
[time]
end = 5
accuracy = 1e-11
until = "flight.z < 0"
)";
}

/// By the energy of arm and stone, and a parabola; and let go at the instant as a number.
TEST(EventsTruth, AStoneIsThrownAsFarAsItsEnergySays)
{
    const SolvedScenario by_angle = solved(trebuchet("\"axle.angle < -60 deg\""));
    ASSERT_TRUE(by_angle.solution.report.converged()) << by_angle.solution.report.message;
    const auto lands = [](const SolvedScenario& s) {
        return s.solution.motion.at_end(s.solution.motion.n_elements()).X[1](0, 0);
    };
    const double angle = std::numbers::pi / 3, l = 1.05,
                 J = 2 * ((1 + 0.0016) / 12 + 0.25) + 0.5 * (0.4 * 0.0025 + l * l),
                 work = 40 * angle - (2 * 0.5 + 0.5 * l) * g * std::sin(angle),
                 rate = std::sqrt(2 * work / J);
    const double up = rate * l * std::cos(angle), along = -rate * l * std::sin(angle),
                 falls = (up + std::sqrt(up * up + 2 * g * l * std::sin(angle))) / g;
    EXPECT_NEAR(lands(by_angle), l * std::cos(angle) + along * falls, 1e-10);
    ASSERT_EQ(by_angle.solution.events.size(), 2u);
    std::ostringstream instant;
    instant.precision(17);
    instant << by_angle.solution.events[0].t;
    const SolvedScenario by_instant = solved(trebuchet(instant.str()));
    EXPECT_NEAR(lands(by_instant), lands(by_angle), 1e-11);
    const SolvedScenario later = solved(trebuchet("\"axle.angle < -61 deg\""));
    EXPECT_GT(std::abs(lands(later) - lands(by_angle)), 1e-3) << "negative control";
}

/// Half a sine on a spring, however stiff: m v at the spring, -m v behind it.
TEST(EventsTruth, SpringsThatStopAreLeftAsTheyWereMet)
{
    for (int digits = 2; digits <= 9; ++digits) {
        const double k = std::pow(10, digits), contact = std::numbers::pi * std::sqrt(2 / k);
        std::ostringstream text;
        text.precision(17);
        text << "format = 1\nbody = [{ name = \"cart\", shape = { sphere = 0.1 }, mass = 2, velocity = [1.3, "
                "0, 0] "
                "}]\n[[joint]]\nname = \"way\"\ntype = \"prismatic\"\nbetween = [\"world\", \"cart\"]\nat = "
                "[0, 0, "
                "0]\naxis = [1, 0, 0]\nlimits = [-inf, 0.5]\nlimit_law = \"penalty\"\nlimit_damping = "
                "0\nlimit_stiffness = "
             << k << "\n[time]\nend = 1.5\naccuracy = 1e-9\n";
        const SolvedScenario s = solved(text.str());
        ASSERT_TRUE(s.solution.report.converged()) << k << s.solution.report.message;
        const State end = s.solution.motion.at_end(s.solution.motion.n_elements());
        // the spring begins by 1e-12 lengths behind the limit
        const double truth = 0.5 - 1.3 * (1.5 - 0.5 / 1.3 - contact),
                     error = std::abs(end.X[0](0, 0) - truth);
        EXPECT_LT(error, 1e-9) << k;
        EXPECT_GE(s.solution.estimate.largest + 1e-11, error) << k;
        EXPECT_NEAR(end.V[0](0, 0), -1.3, 1e-8) << k;
    }
}

std::string rod(const std::string& time, const std::string& more = "")
{
    return test::SwingingRod{-0.5}.text("end = 2\naccuracy = 1e-8\n" + time, more);
}

/// Where formulas are no numbers nothing is said to be false.
TEST(EventsTruth, ConditionsThatAreNoNumbersAreRefused)
{
    for (const char* formula : {"log(pin.angle) > 3", "1/(pin.angle + 0.5) > 3", "sqrt(pin.angle) > 2"}) {
        const ScenarioResult result = read(rod("until = \"" + std::string(formula) + "\""));
        EXPECT_NE(find(result, "event-not-finite"), nullptr) << formula << shown(result);
    }
    for (const char* formula : {"log(-pin.angle) > 3", "sqrt(-pin.angle) > 2"}) {   // when it hangs
        const SolvedScenario s = solved(rod("until = \"" + std::string(formula) + "\""));
        EXPECT_FALSE(s.solution.report.converged()) << formula;
        EXPECT_NE(s.solution.report.message.find("'time.until'"), std::string::npos)
            << s.solution.report.message;
        EXPECT_NE(s.solution.report.message.find("is no number between"), std::string::npos);
        EXPECT_LT(s.solution.report.failed_at, 0.45);
    }
    EXPECT_TRUE(solved(rod("until = \"log(2 - pin.angle) < 0\"")).solution.report.converged());
}

TEST(EventsTruth, WhatNeverEndsIsNamed)
{
    const SolvedScenario s = solved(test::SwingingRod{-0.5}.text(
        "end = 2\nelements = 40", "[[event]]\nname = \"often\"\nwhen = \"sin(1e9*t) > 0\"\n"));
    EXPECT_FALSE(s.solution.report.converged());
    EXPECT_NE(s.solution.report.message.find("'often'"), std::string::npos) << s.solution.report.message;
    // laws that contradict each other begin at one instant
    const auto drive = [](const char* name, const char* law) {
        return std::string("[[drive]]\ntype = \"joint\"\nname = \"") + name +
               "\"\njoint = \"pin\"\nexpression = \"" + law + "\"\nfrom = \"pin.angle > 0\"\n";
    };
    const SolvedScenario both = solved(rod("", drive("one", "0") + drive("other", "0.5")));
    EXPECT_FALSE(both.solution.report.converged());
    EXPECT_NE(both.solution.report.message.find("'one', 'other'"), std::string::npos);
}

/// Every way to ask for a motion other than forwards from a state.
TEST(EventsTruth, StopsAreForMotionsForwardsFromAState)
{
    const std::string stop = "[[stop]]\nname = \"end\"\njoint = \"pin\"\nlimits = [-2, 0.1]\n";
    const auto code = [&](const std::string& text) {
        const ScenarioResult result = read(text);
        return find(result, "event-method") != nullptr ? std::string("event-method") : shown(result);
    };
    const std::string plain = test::SwingingRod{-0.5}.text("end = 2\nelements = 10", stop);
    const auto with = [&](const std::string& key) {
        return test::replaced(plain, "[start]", "[start]\n" + key);
    };
    for (const char* method :
         {"family = \"mixed\"", "family = \"midpoint\"", "family = \"endpoint\"", "window = 2"})
        EXPECT_EQ(code(plain + "\n[method]\n" + method + "\n"), "event-method") << method;
    EXPECT_EQ(code(test::replaced(with("given = \"positions\""), "-0.5] }]",
                                  "-0.5], end = { position = [0, 0, -0.5] } }]") +
                   "\n[end]\ngiven = \"positions\"\n"),
              "event-method");
    EXPECT_EQ(code(with("given = \"positions\"") + "\n[end.known]\n\"pin.angle\" = 0\n"), "event-method");
    EXPECT_EQ(code(test::replaced(plain, "elements = 10", "elements = 10\nperiodic = true")), "event-method");
    EXPECT_EQ(code(test::replaced(plain, "mass = 2", "mass = { unknown = 2, low = 1, high = 3 }") +
                   "\n[end.known]\n\"pin.angle\" = 0\n"),
              "event-method");
    EXPECT_EQ(code(test::replaced(plain, "elements = 10", "elements = 10\nbreaks = \"ignore\"")),
              "event-method");
}

}   // namespace

}   // namespace livens::events_truth_test
