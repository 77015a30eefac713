// SPDX-License-Identifier: BSD-3-Clause
// A scenario in text, solved, and what can be asked of it.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/scenario.h"
#include "livens/spacetime/solve.h"

namespace livens::tests {

struct Solved {
    Model model;
    Solution solution;

    int joint(const std::string& name) const
    {
        for (int j = 0; j < static_cast<int>(model.joints().size()); ++j)
            if (model.joints()[j].name == name) return j;
        ADD_FAILURE() << "no joint " << name;
        return 0;
    }
    CoordinateValue coordinate(const std::string& name, const std::string& which, double t) const
    {
        const JointCoordinates all(model, solution.motion);
        const std::vector<CoordinateValue> values = all.at(t);
        for (std::size_t i = 0; i < values.size(); ++i)
            if (all.places()[i].joint == joint(name) && all.coordinate(static_cast<int>(i)).name == which)
                return values[i];
        ADD_FAILURE() << name << " has no " << which;
        return {};
    }
    /// What sensors read, all one after the other.
    std::vector<double> sensed(double t) const { return SensorReadings(model, solution.motion).at(t); }
    Reaction reaction(const std::string& name, double t) const
    {
        return sample_joints(model, solution.motion, t)[static_cast<std::size_t>(joint(name))].right;
    }
};

inline Solved solved(const std::string& text)
{
    const ScenarioResult read = parse_scenario("format = 1\n" + text, "test.toml");
    for (const Diagnostic& d : read.diagnostics) EXPECT_EQ(d.message, "");
    const Scenario& s = read.scenario.value();
    Solution solution = solve(s.model, {s.model.start()}, s.time, s.method, s.options);
    EXPECT_TRUE(solution.report.converged()) << solution.report.message;
    EXPECT_TRUE(solution.verdict.reasons.empty()) << solution.verdict.reasons.front();
    return {s.model, std::move(solution)};
}

}   // namespace livens::tests
