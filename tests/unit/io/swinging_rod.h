// SPDX-License-Identifier: BSD-3-Clause
// What tests of events and stops share: a rod that swings, and the solution of a scenario without warnings.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "livens/io/solve_scenario.h"
#include "unit/io/scenario_text.h"

namespace livens::test {

inline Scenario scenario_of(const std::string& text)
{
    ScenarioResult result = read(text);
    EXPECT_TRUE(result.scenario.has_value() && result.diagnostics.empty()) << text << shown(result);
    return result.scenario ? std::move(*result.scenario) : Scenario();
}

inline SolvedScenario solved(const std::string& text)
{
    const Scenario scenario = scenario_of(text);
    return solve_scenario(scenario, scenario.options, scenario.prepared);
}

/// Events with a speed.
inline std::vector<SolvedEvent> hits_of(const SolvedScenario& s)
{
    std::vector<SolvedEvent> hits;
    for (const SolvedEvent& one : s.solution.events)
        if (one.speed > 0) hits.push_back(one);
    return hits;
}

/// An arm of 2 kg that hangs on a pin, its centre 0.4 m below: 0.34 kg m^2 about it. `more`: tables.
inline std::string hanging_arm(const std::string& more)
{
    return R"(format = 1
gravity = [0, 0, -9.81]

[[body]]
name = "arm"
mass = 2
inertia = [0.02, 0.02, 0.01]
position = [0, 0, -0.4]

[[joint]]
name = "pin"
type = "revolute"
between = ["world", "arm"]
at = [0, 0, 0]
axis = [0, 1, 0]

)" + more;
}

/// A rod of 1 m and 2 kg about its end, let go at an angle from where it hangs. `more`: tables, of which keys
/// of the joint come first.
struct SwingingRod {
    double angle;   ///< rad
    std::string joint{};

    static constexpr double about_pin = 2 * ((1 + 0.05 * 0.05) / 12 + 0.25);
    /// Of small motions, rad/s.
    static double frequency() { return std::sqrt(2 * 9.81 * 0.5 / about_pin); }

    std::string text(const std::string& time, const std::string& more = "") const
    {
        return R"(format = 1
gravity = [0, 0, -9.81]
body = [{ name = "rod", shape = { box = [0.05, 0.05, 1] }, mass = 2, position = [0, 0, -0.5] }]

[[joint]]
name = "pin"
type = "revolute"
between = ["world", "rod"]
at = [0, 0, 0]
axis = [0, 1, 0]
)" + joint + R"(
[start]
coordinates = [{ joint = "pin", value = )" +
               std::to_string(angle) + R"( }]

[time]
)" + time + "\n" +
               more;
    }
};

}   // namespace livens::test
