// SPDX-License-Identifier: BSD-3-Clause
// Windows of lobatto by several ranks: the states and numbers of one, which is held against closed forms
// elsewhere; nobody has elements of others; what is sent is as long as it is said to be.
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "livens/base/error.h"
#include "unit/io/rank_cases.h"

namespace livens::ranks_lobatto_test {

namespace {

using namespace of_ranks;

std::string lobatto(const std::string& time, int degree, const std::string& more = "")
{
    return "[time]\n" + time +
           "\n[method]\nestimate = \"none\"\nfamily = \"lobatto\"\nwindow = \"all\"\ndegree = " +
           std::to_string(degree) + "\n" + more;
}

/// The same problem by these elements.
Case by_lobatto(const Case& one, int degree)
{
    std::string text = replaced(one.text, "family = \"mixed\"", "family = \"lobatto\"");
    const std::size_t at = text.rfind("degree = ");
    text.replace(at, text.find('\n', at) - at, "degree = " + std::to_string(degree));
    return {one.what, text};
}

const std::string rates = replaced(replaced(chain, "axis = [0, 1, 0.2]\n", "axis = [0, 1, 0.2]\nrate = 2\n"),
                                   "axis = [0.3, 1, 0]\n", "axis = [0.3, 1, 0]\nrate = -3\n");
/// A parallel crank: a loop, one of whose rows is redundant.
const std::string loop = gravity + body("left", "[0, 0, 0.5]") + body("top", "[1, 0, 1]") +
                         body("right", "[2, 0, 0.5]") +
                         joint("revolute", "a", "[\"world\", \"left\"]", "[0, 0, 0]", "[0, 1, 0]\nrate = 2") +
                         joint("revolute", "b", "[\"left\", \"top\"]", "[0, 0, 1]", "[0, 1, 0]") +
                         joint("revolute", "c", "[\"top\", \"right\"]", "[2, 0, 1]", "[0, 1, 0]") +
                         joint("revolute", "d", "[\"world\", \"right\"]", "[2, 0, 0]", "[0, 1, 0]");
/// It turns more than once, and a law knows how often; a drive turns another one.
const std::string turning =
    gravity + body("bob", "[0, 0, -1]") + body("fan", "[3, 0, 0]") +
    joint("revolute", "pivot", "[\"world\", \"bob\"]", "[0, 0, 0]", "[0, 1, 0]\nrate = 14") +
    joint("revolute", "shaft", "[\"world\", \"fan\"]", "[3, 0, 0]", "[1, 0, 0]\nrate = 13.5") +
    "[[load]]\ntype = \"spring\"\nname = \"s\"\njoint = \"pivot\"\nstiffness = 0.7\n"
    "[[drive]]\nname = \"motor\"\ntype = \"joint\"\njoint = \"shaft\"\nexpression = \"12*t + "
    "0.3*sin(5*t)\"\n";

const Case of_states[] = {
    {"from a state", rates + lobatto("end = 0.5\nelements = 41", 3)},
    {"linear", rates + lobatto("end = 0.1\nelements = 40", 1)},
    {"a loop", loop + lobatto("end = 0.5\nelements = 30", 4)},
    {"a law that counts turns, and a drive", turning + lobatto("end = 1\nelements = 40", 3)},
    {"driven alone",
     body("fan", "[3, 0, 0]") +
         joint("revolute", "shaft", "[\"world\", \"fan\"]", "[3, 0, 0]", "[1, 0, 0]\nrate = 9") +
         "[[drive]]\nname = \"motor\"\ntype = \"joint\"\njoint = \"shaft\"\nexpression = \"9*t\"\n" +
         lobatto("end = 1\nelements = 20", 2)},
};

TEST(RanksLobatto, MotionsFromAStateAreThoseOfTheSerialRun)
{
    for (const Case& one : of_states) expect_the_same(one, ranks({1, 2, 3, 4, 7}));
}

TEST(RanksLobatto, ConditionsByComponentAreThoseOfTheSerialRun)
{
    for (const Case& one : by_component)
        if (one.text.find("lower") == std::string::npos || one.what != std::string("lower multipliers"))
            expect_the_same(by_lobatto(one, 3), ranks({1, 2, 4, 7}));
}

TEST(RanksLobatto, PeriodicMotionsAreThoseOfTheSerialRun)
{
    for (const Case& one : periodic) expect_the_same(by_lobatto(one, 4), ranks({1, 2, 3, 4, 7}));
}

TEST(RanksLobatto, UnknownNumbersAreThoseOfTheSerialRun)
{
    for (const Case& one : numbered_cases) expect_the_same(by_lobatto(one, 3), ranks({1, 3, 4}));
}

/// The period of a swing by the mean of arithmetic and geometric means: closed forms, and their controls.
TEST(RanksLobatto, NumbersAreRight)
{
    const double w = std::sqrt(2 * 9.81 / (2 + 0.2));
    double a = 1, b = std::cos(0.5);
    for (int i = 0; i < 8; ++i) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    const double period = 2 * 3.141592653589793 / (w * a);
    const auto off = [&](int elements) {
        const std::string text =
            pendulum + "[start]\nknown = { \"pivot.angle\" = 1, \"pivot.angle_rate\" = 0 }\n" +
            lobatto("end = { unknown = 2.3 }\nperiodic = true\nelements = " + std::to_string(elements), 2);
        const std::vector<Part> parts = by_ranks(text, 4);
        EXPECT_TRUE(parts[0].solution.report.converged()) << parts[0].solution.report.message;
        return parts[0].solution.numbers.values.at(0) - period;
    };
    const double coarse = off(40), fine = off(80);
    EXPECT_LT(std::abs(fine), 1e-6);
    EXPECT_NEAR(std::log2(coarse / fine), 4, 0.25) << coarse << " " << fine;
    EXPECT_GT(std::abs(fine), 1e-12) << "the bound sees what a mesh is off by";
}

std::string between_angles(int elements)
{
    return pendulum +
           "[start]\nknown = { \"pivot.angle\" = 0.1 }\n[end]\nknown = { \"pivot.angle\" = 0.9 }\n" +
           lobatto("end = 0.5\nelements = " + std::to_string(elements), 2);
}

/// Of a stretch 2 f rows are left, in the 2 f numbers of both of its borders, beside those of the ends of
/// time: the chain has 2 f (K + 1) unknowns, and one more for each condition of both ends and each number.
TEST(RanksLobatto, TheChainIsAsLongAsIsSaid)
{
    for (const int n : {1, 2, 4, 7}) {
        for (const Part& part : by_ranks(between_angles(64), n)) EXPECT_EQ(part.work.n_chain, 2 * (n + 1));
        for (const Part& part : by_ranks(by_lobatto(numbered_cases[2], 2).text, n)) {
            EXPECT_EQ(part.work.n_chain, 2 * (n + 1) + (n > 1 ? 2 : 0) + 2) << n;
            EXPECT_EQ(part.work.n_left, 2);
            EXPECT_EQ(part.work.n_formed, part.work.last - part.work.first);
        }
    }
}

/// At a tolerance so far above rounding that all numbers of ranks take as many iterations.
TEST(RanksLobatto, WhatIsSentGrowsAsIsSaid)
{
    const std::string text = rates + lobatto("end = 0.5\nelements = 512", 2, "tolerance = 1e-9\n");
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
        EXPECT_EQ(parts[0].work.n_chain, 4 * (n + 1));
        EXPECT_EQ(parts[0].solution.report.newton_iterations, 1);
        std::printf("%2d ranks: %lld messages, %lld bytes, %lld flops; of the first %lld, %lld\n", n,
                    most.messages, most.bytes, flops, parts[0].work.of_solution.messages,
                    parts[0].work.of_solution.bytes);
    }
    for (std::size_t i = 2; i < messages.size(); ++i) {
        EXPECT_EQ(messages[i] - messages[i - 1], messages[1] - messages[0]);
        EXPECT_EQ(bytes[i] - bytes[i - 1], bytes[1] - bytes[0]);
    }
    EXPECT_LT(10 * (bytes[1] - bytes[0]), bytes[0]);
}

TEST(RanksLobatto, WhatIsNotDividedIsRefused)
{
    const auto code = [](const std::string& text) {
        const Scenario s = scenario_of(text);
        try {
            check_ranks(s.model, problem_of(s), s.time, s.method, s.options, 2);
        } catch (const InputError& why) {
            return std::string(why.complaint().code);
        }
        return std::string();
    };
    const std::string text = of_states[0].text;
    EXPECT_EQ(code(text), "") << "negative control";
    EXPECT_EQ(code(replaced(text, "window = \"all\"", "window = 8")), "ranks-method");
    EXPECT_EQ(code(replaced(text, "window = \"all\"", "condition = true\nwindow = \"all\"")), "ranks-method");
    EXPECT_EQ(code(replaced(replaced(text, "window = \"all\"\n", ""), "lobatto", "radau")), "ranks-method");
    EXPECT_EQ(code(replaced(text, "elements = 41", "elements = 1")), "ranks-elements");
    const std::string bends = "[[load]]\ntype = \"actuator\"\nname = \"stop\"\njoint = \"j1\"\n"
                              "expression = \"-9*max(phi, 0)\"\ninputs = { phi = \"j1.angle\" }\n";
    EXPECT_EQ(code(replaced(text, "[time]", bends + "[time]")), "ranks-conditions");
}

/// What serial runs divide, ranks refuse: nobody may believe it.
TEST(RanksLobatto, ElementsThatDoNotSeeTheMotionAreRefused)
{
    const std::string fast = replaced(pendulum, "axis = [0, 1, 0]\n", "axis = [0, 1, 0]\nrate = 60\n");
    for (const Part& part : by_ranks(fast + lobatto("end = 1\nelements = 24", 2), 3)) {
        EXPECT_EQ(part.solution.report.status, SolveStatus::not_converged);
        EXPECT_NE(part.solution.report.message.find("leaves the velocity that its momentum has"),
                  std::string::npos)
            << part.solution.report.message;
    }
    const std::vector<Part> good = by_ranks(fast + lobatto("end = 1\nelements = 240", 2), 3);
    EXPECT_TRUE(good[0].solution.report.converged()) << good[0].solution.report.message;
}

/// A march says so, and ends; ranks have the whole of it and do not believe it. Shorter elements are the
/// control.
TEST(RanksLobatto, SpringsThatTurnAreSuspect)
{
    const auto row = [](int elements) {
        std::string text;
        for (const auto& [name, side] : {std::pair{"a", ""}, {"b", "-"}})
            text += std::string("[[body]]\nname = \"") + name +
                    "\"\nmass = 1\nshape = { point = true }\nposition = [0, 0, " + side +
                    "1.25]\nvelocity = [" + side + "1.25, 0, 0]\n";
        return text +
               "[[load]]\ntype = \"spring\"\nname = \"s\"\nbetween = [\"a\", \"b\"]\nstiffness = "
               "1e4\nfree_length = 2.5\n" +
               lobatto("end = 12\nelements = " + std::to_string(elements), 2);
    };
    const Solution long_ones = alone(row(30)), short_ones = by_ranks(row(400), 3)[1].solution;
    EXPECT_FALSE(long_ones.report.converged());
    EXPECT_TRUE(short_ones.report.converged()) << short_ones.report.message;
    for (const Part& part : by_ranks(row(30), 3)) EXPECT_FALSE(part.solution.report.converged());
}

}   // namespace

}   // namespace livens::ranks_lobatto_test
