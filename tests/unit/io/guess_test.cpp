// SPDX-License-Identifier: BSD-3-Clause
// A run as the guess of another motion: a pendulum that hangs at both ends of a second may rest or turn once.
#include <gtest/gtest.h>

#include "livens/base/error.h"
#include "livens/io/guess.h"
#include "livens/io/solve_scenario.h"

namespace livens::guess_test {
namespace {

using RunFile = Run;   // testing::Test has a Run of its own

std::string hanging(const std::string& rates, const std::string& time = "end = 1\nelements = 20",
                    const std::string& name = "rod")
{
    return "format = 1\ngravity = [0, 0, -9.81]\n[[body]]\nname = \"" + name +
           "\"\nshape = { box = [1, 0.05, 0.05] }\ndensity = 1000\nposition = [0, 0, -0.5]\n"
           "rotation_vector = [0, \"90 deg\", 0]\nstart = { " +
           rates +
           " }\nend = { position = [0, 0, -0.5], rotation_vector = [0, \"90 deg\", 0] }\n[[joint]]\n" +
           "name = \"hook\"\ntype = \"revolute\"\nbetween = [\"world\", \"" + name +
           "\"]\nat = [0, 0, 0]\naxis = [0, 1, 0]\n[time]\n" + time +
           "\n[start]\ngiven = \"positions\"\n[end]\ngiven = \"positions\"\n";
}
const std::string turning = "velocity = [-4, 0, 0], angular_velocity = [0, 8, 0]";

Scenario scenario_of(const std::string& text)
{
    ScenarioResult result = parse_scenario(text, "hanging.toml");
    for (const Diagnostic& d : result.diagnostics) ADD_FAILURE() << d.message;
    return std::move(*result.scenario);
}

RunFile solved(const Scenario& scenario, const RunFile* guess = nullptr)
{
    SolvedScenario one = solve_scenario(scenario, scenario.options, nullptr,
                                        guess != nullptr ? guess_of(scenario, *guess) : nullptr);
    return judged_run(scenario, std::move(one), {});
}

/// Where the rod stands in the middle of time: above its hook, if it turns.
double height(const RunFile& run) { return run.motion.at(0.5).X[0](2, 0); }

TEST(Guess, ARunChoosesTheMotion)
{
    const Scenario turns = scenario_of(hanging(turning)), rests = scenario_of(hanging(""));
    const RunFile turn = solved(turns);
    ASSERT_TRUE(turn.report.converged()) << turn.report.message;
    ASSERT_GT(height(turn), 0.4);
    ASSERT_LT(height(solved(rests)), -0.49) << "control: without a guess it rests";
    const RunFile guessed = solved(rests, &turn);
    ASSERT_TRUE(guessed.report.converged()) << guessed.report.message;
    EXPECT_NEAR(height(guessed), height(turn), 1e-12);
    EXPECT_LE(guessed.report.newton_iterations, 2);
}

/// Over a part of the time, with other elements, to an accuracy.
TEST(Guess, MayBeShorterThanTheMotion)
{
    const RunFile turn = solved(scenario_of(hanging(turning)));
    for (const char* time : {"end = 1.05\nelements = 17", "start = -0.05\nend = 1\naccuracy = 1e-8"}) {
        const RunFile guessed = solved(scenario_of(hanging("", time)), &turn);
        ASSERT_TRUE(guessed.report.converged()) << guessed.report.message;
        EXPECT_GT(height(guessed), 0.3) << time;
    }
}

TEST(Guess, OfAnotherMechanismOrTimeIsRefused)
{
    const RunFile turn = solved(scenario_of(hanging(turning)));
    const auto code = [&](const std::string& text, const RunFile& run) -> std::string {
        try {
            guess_of(scenario_of(text), run);
        } catch (const InputError& error) {
            EXPECT_FALSE(error.complaint().help.empty());
            return error.complaint().code;
        }
        return "";
    };
    EXPECT_EQ(code(hanging(""), turn), "");
    EXPECT_EQ(code(hanging("", "end = 1\nelements = 20", "bar"), turn), "guess-bodies");
    EXPECT_EQ(code(hanging("", "start = 1\nend = 2\nelements = 20"), turn), "guess-time");
    std::string march = hanging("");
    march = march.substr(0, march.find("\n[start]")) + "\n";
    const std::size_t end = march.find("end = { ");
    march.erase(end, march.find('\n', end) - end);
    EXPECT_EQ(code(march, turn), "guess-unused");
    RunFile two = turn;
    two.body_names.push_back("rider");
    two.body_is_point.push_back(false);
    EXPECT_EQ(code(hanging(""), two), "guess-bodies");
    RunFile point = turn;
    point.body_is_point[0] = true;
    EXPECT_EQ(code(hanging(""), point), "guess-bodies");
    RunFile none = turn;
    none.motion.mesh.ends.resize(1);
    EXPECT_EQ(code(hanging(""), none), "guess-time");
}

}   // namespace
}   // namespace livens::guess_test
