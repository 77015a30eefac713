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
#include "sanitized.h"
#include "unit/io/rank_cases.h"

namespace livens::ranks_border_test {

namespace {

using namespace of_ranks;

TEST(RanksBorder, ConditionsByComponentAreThoseOfTheSerialRun)
{
    for (const Case& one : by_component) expect_the_same(one, ranks({1, 2, 4, 7}));
}

TEST(RanksBorder, PeriodicMotionsAreThoseOfTheSerialRun)
{
    for (const Case& one : periodic) expect_the_same(one, ranks({1, 2, 3, 4, 7}));
}

TEST(RanksBorder, UnknownNumbersAreThoseOfTheSerialRun)
{
    for (const Case& one : numbered_cases) expect_the_same(one, ranks({1, 3, 4}));
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
    expect_the_same({"few elements", between_angles(256)}, {16});
    if (!is_sanitized) expect_the_same({"few elements", between_angles(256)}, {64});
    expect_the_same({"more elements", between_angles(700)}, {20});
}

/// By a tree and along borders of ranks, and of a border of conditions two places and two momenta more a
/// point or step: messages grow as the logarithm of the number of ranks, bytes hardly.
TEST(RanksBorder, WhatIsSentGrowsAsIsSaid)
{
    if (is_sanitized) GTEST_SKIP() << study;
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
    EXPECT_EQ(code(replaced(between_angles(20), "family = \"mixed\"", "family = \"lobatto\""), 1), "");
}

/// A periodic motion with a number joins both ends of time: as many unknowns of the chain more as there are
/// conditions of both ends, and numbers.
TEST(RanksBorder, TheChainHasTheBorderBesideIt)
{
    const std::string text = replaced(replaced(numbered_cases[2].text, "elements = 60", "elements = 640"),
                                      "degree = 2", "degree = 1");
    for (const int n : ranks({1, 2, 4, 7}))
        for (const Part& part : by_ranks(text, n)) {
            // two conditions of both ends, the period and what unfolds; a border has 4 f, and two more for
            // the period, which all elements see; those of the outer ranks have two less
            EXPECT_EQ(part.work.n_chain, 2 + 2 + (n > 1 ? 6 * (n - 1) - 4 : 0)) << n;
            EXPECT_EQ(part.work.n_formed, part.work.last - part.work.first);
        }
}

}   // namespace

}   // namespace livens::ranks_border_test
