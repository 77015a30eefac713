// SPDX-License-Identifier: BSD-3-Clause
// Unknown numbers to an accuracy: elements are found, and what is told of the errors of the numbers is held
// against closed forms, elliptic integrals and figures of another integrator.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "livens/dynamics/start/prepared.h"
#include "livens/io/solve_scenario.h"
#include "unit/io/scenario_text.h"

namespace livens::unknown_accuracy_test {
namespace {

using test::read;
using test::replaced;
using test::shown;

constexpr double g = 9.81;

/// A point on a rod in a plane, whose air drags it.
const std::string pendulum = R"(format = 1
gravity = [0, 0, -9.81]
[parameters]
L = "1 m"
[time]
end = 2
accuracy = 1e-9
[[body]]
name = "bob"
shape = { point = true }
mass = 1
position = ["L", 0, 0]
[[joint]]
name = "rod"
type = "rod"
between = ["world", "bob"]
[[joint]]
name = "plane"
type = "point_in_plane"
between = ["world", "bob"]
points = [[0, 0, 0], [0, 0, 0]]
axis = [0, 1, 0]
[[load]]
name = "air"
type = "drag"
body = "bob"
linear = 0.3
[start.known]
"bob.z" = 0
"bob.vz" = 0
[end.known]
"bob.x" = "L/2"
)";
const std::string damped =
    replaced(pendulum, "linear = 0.3", "linear = { unknown = 0.3, low = 0, high = 5 }");
const std::string longer =
    replaced(pendulum, "L = \"1 m\"", "L = { unknown = \"1 m\", low = \"50 cm\", high = \"2 m\" }");

/// Thrown with 7 m/s along x and up against a drag of c v.
const std::string thrown = R"(format = 1
gravity = [0, 0, -9.81]
[time]
end = { unknown = 1, low = 0.2, high = 3 }
accuracy = 1e-9
[[body]]
name = "ball"
shape = { point = true }
mass = 0.3
velocity = [7, 0, 7]
[[load]]
name = "air"
type = "drag"
body = "ball"
linear = 0.9
[start]
given = "state"
[end.known]
"ball.z" = 0
)";

SolvedScenario solved(const Scenario& scenario, bool judged = false)
{
    SolvedScenario s = solve_scenario(scenario, scenario.options, std::make_shared<Prepared>());
    if (judged) judge(s.found ? s.found->model : scenario.model, s.problem, scenario.options, s.solution, {});
    return s;
}

SolvedScenario solved(const std::string& text)
{
    const ScenarioResult result = read(text);
    EXPECT_TRUE(result.scenario) << shown(result);
    if (!result.scenario) return {};
    return solved(*result.scenario, true);
}

std::string with_accuracy(const std::string& text, const std::string& accuracy)
{
    return replaced(text, "accuracy = 1e-9", "accuracy = " + accuracy);
}

/// In the accuracy, and told neither too small nor much too large where the truth is more than its rounding.
void expect_told(const SolvedScenario& s, double truth, double accuracy, double rounding = 3e-14)
{
    const Solution& solution = s.solution;
    ASSERT_TRUE(solution.report.converged()) << accuracy << ": " << solution.report.message;
    ASSERT_EQ(solution.numbers.errors.size(), 1u);
    const double error = std::abs(solution.numbers.values[0] - truth), told = solution.numbers.errors[0];
    EXPECT_LE(error, accuracy);
    EXPECT_LE(solution.estimate.largest, accuracy);
    EXPECT_GE(told + rounding, 0.3 * error) << accuracy;
    EXPECT_LE(told, 30 * std::max(error, rounding)) << accuracy;
}

constexpr std::array accuracies{1e-3, 1e-5, 1e-7, 1e-9, 1e-11};

/// That bring it to 30 degrees off the vertical after 2 s: SciPy's DOP853 and a search.
TEST(UnknownsToAccuracy, DampingAndLengthAreAsExactAsIsTold)
{
    for (const double accuracy : accuracies) {
        char text[20];
        std::snprintf(text, sizeof text, "%g", accuracy);
        expect_told(solved(with_accuracy(damped, text)), 0.763693631412843, accuracy);
        expect_told(solved(with_accuracy(longer, text)), 1.113745597915364, accuracy);
    }
}

/// Crank, coupler and rocker, whose foot has an unknown height.
std::string four_bar(const std::string& known)
{
    std::string text = R"(format = 1
gravity = [0, 0, -9.81]
[time]
end = 0.3
accuracy = 1e-9
)";
    for (const char* body : {"crank|[0, 0, 0.5]", "coupler|[1, 0, 1]", "rocker|[2, 0, 0.5]"}) {
        const std::string both = body, name = both.substr(0, both.find('|'));
        text += "[[body]]\nname = \"" + name +
                "\"\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = " + both.substr(name.size() + 1) + "\n";
    }
    struct Hinge {
        const char *name, *between, *at;
    };
    for (const Hinge& one :
         {Hinge{"A", R"(["world", "crank"])", "[0, 0, 0]"},
          {"B", R"(["crank", "coupler"])", "[0, 0, 1]"},
          {"C", R"(["coupler", "rocker"])", "[2, 0, 1]"},
          {"D", R"(["world", "rocker"])", "[2, 0, { unknown = 0, low = -0.5, high = 0.4 }]"}})
        text += std::string("[[joint]]\nname = \"") + one.name +
                "\"\ntype = \"revolute\"\nbetween = " + one.between + "\nat = " + one.at +
                "\naxis = [0, 1, 0]\n";
    return text + known;
}

/// From the angle at which the rocker is after 0.3 s with a foot at 0.125 m: two accelerations of the closure
/// beside Lagrange's equations in three angles, by SciPy's DOP853 (1e-13 and 1e-12 agree to 4e-14).
TEST(UnknownsToAccuracy, ThePlaceOfAJointOfAClosedLoopIsAsExactAsIsTold)
{
    const std::string text = four_bar(R"([start.known]
"A.angle" = "20 deg"
"A.angle_rate" = 1
[end.known]
"D.angle" = 1.0697536345200986
)");
    for (const double accuracy : accuracies) {
        char word[20];
        std::snprintf(word, sizeof word, "%g", accuracy);
        expect_told(solved(with_accuracy(text, word)), 0.125, accuracy, 1e-13);
    }
    // control: with the foot of another mechanism the rocker is elsewhere, by 1.7487 rad a metre
    const SolvedScenario other = solved(replaced(text, "1.0697536345200986", "1.0699285065"));
    ASSERT_TRUE(other.solution.report.converged()) << other.solution.report.message;
    EXPECT_NEAR(other.solution.numbers.values.at(0), 0.1251, 1e-7);
}

/// Until it is back at its height: z = (v/k + g/k^2) (1 - exp(-k T)) - g T/k, with k = c/m.
double duration_of_throw(double k)
{
    double T = 1.2;
    for (int i = 0; i < 50; ++i) {
        const double e = std::exp(-k * T), z = (7 / k + g / (k * k)) * (1 - e) - g * T / k;
        T -= z / ((7 + g / k) * e - g / k);
    }
    return T;
}

TEST(UnknownsToAccuracy, DurationsOfThrowsAreAsExactAsIsTold)
{
    const std::string by_components =
        replaced(thrown, "[start]\ngiven = \"state\"\n",
                 "[start.known]\n\"ball.x\" = 0\n\"ball.y\" = 0\n\"ball.z\" = 0\n"
                 "\"ball.vx\" = 7\n\"ball.vy\" = 0\n\"ball.vz\" = 7\n");
    for (const std::string& text : {thrown, by_components})
        for (const char* accuracy : {"1e-3", "1e-5", "1e-7", "1e-9", "1e-11"}) {
            const SolvedScenario s = solved(with_accuracy(text, accuracy));
            expect_told(s, duration_of_throw(3), std::stod(accuracy));
            EXPECT_EQ(s.solution.motion.end(), s.solution.numbers.values.at(0));
        }
}

/// 4 sqrt(l/g) K(sin 45 deg), by the arithmetic-geometric mean.
double period_from_the_horizontal()
{
    double a = 1, b = std::sqrt(0.5);
    for (int i = 0; i < 8; ++i) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    return 2 * std::numbers::pi / a / std::sqrt(g);
}

TEST(UnknownsToAccuracy, PeriodsAreAsExactAsIsTold)
{
    std::string text = replaced(pendulum, "end = 2", "end = { unknown = 2.6 }\nperiodic = true");
    text = replaced(text, "linear = 0.3", "linear = 0");
    text = text.substr(0, text.find("[end.known]"));
    for (const char* accuracy : {"1e-3", "1e-6", "1e-9", "1e-11"})
        expect_told(solved(with_accuracy(text, accuracy)), period_from_the_horizontal(), std::stod(accuracy));
}

/// Of a mesh that is given, too; by two meshes of which one is fine.
TEST(UnknownsToAccuracy, ErrorsAreToldOfGivenElements)
{
    for (const int n : {2, 4, 8, 16}) {
        std::string text = replaced(damped, "accuracy = 1e-9", "elements = " + std::to_string(n));
        text += "[method]\nfamily = \"lobatto\"\ndegree = 4\n";
        const SolvedScenario s = solved(text);
        ASSERT_EQ(s.solution.numbers.errors.size(), 1u);
        const double error = std::abs(s.solution.numbers.values[0] - 0.763693631412843),
                     told = s.solution.numbers.errors[0];
        EXPECT_GE(told, 0.3 * error) << n;
        EXPECT_LE(told, 30 * error) << n;
        EXPECT_TRUE(n > 4 || error > 1e-8) << "what would be off is seen";
    }
    const std::string none = replaced(damped, "accuracy = 1e-9", "elements = 8") +
                             "[method]\nfamily = \"lobatto\"\ndegree = 4\nestimate = \"none\"\n";
    EXPECT_TRUE(solved(none).solution.numbers.errors.empty());
}

/// A number whose value is zero has no digits of its own: it is compared with what was guessed.
TEST(UnknownsToAccuracy, MayComeOutAsZero)
{
    std::string text = replaced(thrown, "end = { unknown = 1, low = 0.2, high = 3 }", "end = 0.7");
    text = replaced(text, "gravity = [0, 0, -9.81]", "gravity = [{ unknown = 2 }, 0, -9.81]");
    const double k = 3, T = 0.7;
    char there[60];
    std::snprintf(there, sizeof there, "\"ball.x\" = %.17g\n", 7 / k * (1 - std::exp(-k * T)));
    text = text.substr(0, text.find("\"ball.z\"")) + there;
    for (const char* accuracy : {"accuracy = 1e-9", "elements = 4"}) {
        const SolvedScenario s = solved(replaced(text, "accuracy = 1e-9", accuracy));
        ASSERT_TRUE(s.solution.report.converged()) << accuracy << ": " << s.solution.report.message;
        EXPECT_NEAR(s.solution.numbers.values.at(0), 0, 1e-7) << accuracy;
        ASSERT_EQ(s.solution.numbers.errors.size(), 1u) << accuracy;
        EXPECT_LE(std::abs(s.solution.numbers.values[0]), 3 * s.solution.numbers.errors[0] + 1e-13)
            << accuracy;
        EXPECT_LE(s.solution.numbers.errors[0], 1e-7) << accuracy;
    }
}

/// Output times do not go with a duration that is found.
TEST(UnknownsToAccuracy, OutputTimesAreElementEnds)
{
    for (const char* output : {"output = 0.1", "output = [0.05, 0.3]"}) {
        const SolvedScenario s =
            solved(replaced(thrown, "accuracy = 1e-9", std::string("accuracy = 1e-9\n") + output));
        expect_told(s, duration_of_throw(3), 1e-9);
        for (const double t : s.found->output)
            EXPECT_EQ(s.solution.motion.mesh
                          .ends[s.solution.motion.mesh.element_at(t) + (t == s.solution.motion.end())],
                      t)
                << output;
        EXPECT_GT(s.found->output.size(), 1u);
    }
    const SolvedScenario held = solved(replaced(damped, "accuracy = 1e-9", "accuracy = 1e-9\noutput = 0.1"));
    expect_told(held, 0.763693631412843, 1e-9);
    for (int i = 1; i < 20; ++i) EXPECT_EQ(held.solution.motion.at(0.1 * i).t, 0.1 * i);
    const auto& ends = held.solution.motion.mesh.ends;
    for (const double t : held.found->output) EXPECT_TRUE(std::ranges::binary_search(ends, t)) << t;
}

/// Times of a list that are behind the end that is found are left out, whatever was guessed.
TEST(UnknownsToAccuracy, OutputTimesBehindTheEndAreLeftOut)
{
    const double T = duration_of_throw(3);
    for (const char* guess : {"unknown = 0.9", "unknown = 1.6"})
        for (const char* mesh : {"accuracy = 1e-9", "elements = 8"}) {
            std::string text = replaced(thrown, "unknown = 1", guess);
            text = replaced(text, "accuracy = 1e-9", std::string(mesh) + "\noutput = [0.2, 0.9, 1.5]");
            const SolvedScenario s = solved(text);
            ASSERT_TRUE(s.solution.report.converged()) << guess << ": " << s.solution.report.message;
            EXPECT_NEAR(s.solution.motion.end(), T, 1e-6);
            EXPECT_EQ(s.found->output, (T < 0.9 ? std::vector{0.2} : std::vector{0.2, 0.9})) << guess;
        }
}

/// The bound is off by less than what counts as met: the motion is taken, with what is missing of the number.
TEST(UnknownsToAccuracy, BoundsThatAllButSufficeAreAsFarOffAsIsTold)
{
    for (const char* bound : {"high = 0.7636936314", "high = 0.76369363141"}) {
        const SolvedScenario s = solved(replaced(damped, "high = 5", bound));
        ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
        const double error = std::abs(s.solution.numbers.values.at(0) - 0.763693631412843);
        EXPECT_GE(s.solution.numbers.errors.at(0), 0.3 * error) << bound;
        EXPECT_LE(s.solution.numbers.errors.at(0), 30 * std::max(error, 1e-11)) << bound;
    }
}

/// As many as a march of the model that is found, twice at most.
TEST(UnknownsToAccuracy, TakeFewElements)
{
    for (const std::string& text : {damped, longer, thrown})
        for (const char* accuracy : {"1e-4", "1e-9", "1e-11"}) {
            const SolvedScenario s = solved(with_accuracy(text, accuracy));
            ASSERT_TRUE(s.solution.report.converged()) << s.solution.report.message;
            const Motion& motion = s.solution.motion;
            const Solution march = solve(s.found->model, {{motion.at_end(0)}},
                                         Span{motion.start(), motion.end(), std::stod(accuracy)}, Lobatto{0});
            ASSERT_TRUE(march.report.converged()) << march.report.message;
            EXPECT_LE(motion.n_elements(), 2 * march.motion.n_elements()) << accuracy << '\n' << text;
        }
}

/// A mass whose drag is weak hardly moves the pendulum: the place at the end is that of 1 kg, by a Taylor
/// series in 30 digits.
TEST(UnknownsToAccuracy, NumbersThatHardlyShowTakeShorterElements)
{
    std::string text = replaced(pendulum, "mass = 1", "mass = { unknown = 0.8, low = 0.3, high = 3 }");
    text = replaced(text, "linear = 0.3", "linear = 0.001");
    text = replaced(text, "\"L/2\"", "0.793524158562215731");
    for (const char* accuracy : {"1e-5", "1e-7", "1e-9"}) {
        const SolvedScenario s = solved(with_accuracy(text, accuracy));
        expect_told(s, 1, std::stod(accuracy), 1e-11);
        EXPECT_LE(30 * s.solution.estimate.largest, s.solution.numbers.errors.at(0)) << "it hardly shows";
    }
    const SolvedScenario s = solved(with_accuracy(text, "1e-12"));
    EXPECT_EQ(s.solution.report.status, SolveStatus::inaccurate);
    EXPECT_NE(s.solution.report.message.find("the error of the unknown 'bob.mass' is about"),
              std::string::npos)
        << s.solution.report.message;
    EXPECT_NE(s.solution.report.message.find("rounding may move an unknown number by"), std::string::npos)
        << s.solution.report.message;
}

/// What is told goes into the result, and comes back.
TEST(UnknownsToAccuracy, ErrorsStandInTheRun)
{
    const ScenarioResult result = read(longer);
    ASSERT_TRUE(result.scenario) << shown(result);
    const livens::Run run = judged_run(*result.scenario, solved(*result.scenario), {});
    ASSERT_EQ(run.numbers.names, std::vector<std::string>{"L"});
    EXPECT_NEAR(run.numbers.values.at(0), 1.113745597915364, 1e-9);
    EXPECT_LE(std::abs(run.numbers.values[0] - 1.113745597915364), 3 * run.numbers.errors.at(0) + 1e-14);
    const auto note = std::ranges::find_if(
        run.notes, [](const std::string& one) { return one.starts_with("found: L = 1.1137455979"); });
    ASSERT_NE(note, run.notes.end());
    EXPECT_NE(note->find(" m, within "), std::string::npos) << *note;
}

std::string message_of(const std::string& text, SolveStatus status)
{
    const SolvedScenario s = solved(text);
    EXPECT_EQ(s.solution.report.status, status) << s.solution.report.message;
    return s.solution.report.message;
}

TEST(UnknownsToAccuracy, WhatCannotBeIsSaid)
{
    const auto has = [](const std::string& text, const char* words) {
        return text.find(words) != std::string::npos;
    };
    const std::string rounded = message_of(with_accuracy(damped, "1e-17"), SolveStatus::inaccurate);
    EXPECT_TRUE(has(rounded, "the accuracy 1e-17 is not reached between the two ends")) << rounded;
    const SolvedScenario bound =
        solved(replaced(thrown, "unknown = 1, low = 0.2, high = 3", "unknown = 0.5, low = 0.2, high = 0.6"));
    EXPECT_EQ(bound.solution.report.status, SolveStatus::not_converged);
    EXPECT_TRUE(has(bound.solution.report.message, "'time.end' has come to its upper bound 0.6"))
        << bound.solution.report.message;
    EXPECT_TRUE(
        has(bound.solution.report.notes.back(), "not found, and in the last iterate: time.end = 0.6"));
}

/// Of mass and drag only the ratio shows: two conditions on one way leave them free together.
TEST(UnknownsToAccuracy, NumbersThatActAlikeAreNotDetermined)
{
    std::string text = replaced(thrown, "end = { unknown = 1, low = 0.2, high = 3 }", "end = 0.7");
    text = replaced(text, "mass = 0.3", "mass = { unknown = 0.25, low = 0.1, high = 2 }");
    text = replaced(text, "linear = 0.9", "linear = { unknown = 0.7, low = 0.1, high = 3 }");
    const double e = std::exp(-3 * 0.7);
    char there[120];
    std::snprintf(there, sizeof there, "\"ball.z\" = %.17g\n\"ball.x\" = %.17g\n",
                  (7.0 / 3 + g / 9) * (1 - e) - g * 0.7 / 3, 7.0 / 3 * (1 - e));
    text = text.substr(0, text.find("\"ball.z\"")) + there;
    const SolvedScenario alike = solved(text);
    EXPECT_FALSE(alike.solution.report.converged());
    // one of them, from one of the two
    std::string one = replaced(text, "mass = { unknown = 0.25, low = 0.1, high = 2 }", "mass = 0.3");
    one = one.substr(0, one.find("\"ball.x\""));
    const SolvedScenario alone = solved(one);
    ASSERT_TRUE(alone.solution.report.converged()) << alone.solution.report.message;
    EXPECT_NEAR(alone.solution.numbers.values.at(0), 0.9, 1e-8);
}

}   // namespace
}   // namespace livens::unknown_accuracy_test
