// SPDX-License-Identifier: BSD-3-Clause
// Result files that several ranks write: whole, as one writes them, or absent.
#include "livens/io/parts.h"

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "livens/spacetime/on_ranks.h"
#include "unit/io/sample_run.h"

namespace livens::parts_test {
namespace {

class Parts : public Results {};

Scenario scenario_of(const std::string& method)
{
    ScenarioResult result = parse_scenario(R"(
format = 1
gravity = [0, 0, -9.81]
[[body]]
name = "rod"
shape = { box = [0.1, 0.1, 1] }
mass = 1
position = [0, 0, -0.5]
[[joint]]
name = "pivot"
type = "revolute"
between = ["world", "rod"]
at = [0, 0, 0]
axis = [0, 1, 0]
rate = 3
[[load]]
type = "spring"
name = "spring"
joint = "pivot"
stiffness = 2
[time]
end = 1
elements = 40
[method]
degree = 2
)" + method,
                                           "run.toml");
    EXPECT_TRUE(result.scenario) << (result.diagnostics.empty() ? "" : result.diagnostics[0].message);
    return std::move(*result.scenario);
}

Scenario scenario() { return scenario_of("family = \"mixed\""); }

void write_on(int n_ranks, const Scenario& scenario, const std::filesystem::path& file, int failing = -1)
{
    run_as_ranks(n_ranks, [&](Ranks& ranks) {
        RankWork work;
        const Problem problem{scenario.conditions};
        Solution solution = solve_on_ranks(scenario.model, problem, scenario.time, scenario.method,
                                           scenario.options, ranks, work);
        const Run part = part_of_run(scenario, std::move(solution), work);
        if (ranks.rank() == failing) throw IoError("no space left");
        write_parts(file, scenario, part, ranks, true);
    });
}

void expect_the_file_of_one(const Scenario& one, const std::filesystem::path& file)
{
    SolveOptions options = one.options;
    options.estimate = SolveOptions::Estimate::none;
    const Solution alone = solve(one.model, {one.conditions}, one.time, one.method, options);
    for (const int n : {1, 2, 3, 5}) {
        std::filesystem::remove(file);
        write_on(n, one, file);
        const RunFile run = read_run(file);   // looks at all checksums
        EXPECT_EQ(run.motion.mesh.ends, alone.motion.mesh.ends);
        EXPECT_EQ(run.motion.block_ends, alone.motion.block_ends);
        EXPECT_EQ(run.output, alone.motion.mesh.ends);
        const auto compare = [&](const std::vector<double>& a, const std::vector<double>& b,
                                 const char* what) {
            ASSERT_EQ(a.size(), b.size()) << what;
            double off = 0, size = 1;
            for (std::size_t i = 0; i < a.size(); ++i) {
                off = std::max(off, std::abs(a[i] - b[i]));
                size = std::max(size, std::abs(a[i]));
            }
            EXPECT_LT(off, 1e-11 * size) << what << ", " << n << " ranks";
        };
        compare(alone.motion.X.values, run.motion.X.values, "X");
        compare(alone.motion.P.values, run.motion.P.values, "P");
        compare(alone.motion.multipliers.values, run.motion.multipliers.values, "multipliers");
        compare(alone.motion.load_angles, run.motion.load_angles, "angles of loads");
        EXPECT_NO_THROW(check_model(one.model, run));
    }
}

TEST_F(Parts, AreTheFileThatOneWrites)
{
    for (const char* method : {"family = \"mixed\"", "family = \"lobatto\"\nwindow = \"all\""})
        expect_the_file_of_one(scenario_of(method), in_folder("parts.nc"));
}

TEST_F(Parts, AreAbsentWhereARankFails)
{
    const Scenario one = scenario();
    for (const int failing : {0, 1, 2}) {
        EXPECT_THROW(write_on(3, one, in_folder("absent.nc"), failing), IoError);
        EXPECT_FALSE(std::filesystem::exists(in_folder("absent.nc")));
    }
    EXPECT_EQ(n_files(), 0);   // no temporary either
}

}   // namespace
}   // namespace livens::parts_test
