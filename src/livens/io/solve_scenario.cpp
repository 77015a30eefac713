// SPDX-License-Identifier: BSD-3-Clause
// A scenario solved, estimated and judged, once for program and Python. The time that is told is that of the
// solution alone; the estimate is timed apart.
#include "livens/io/solve_scenario.h"

#include <chrono>
#include <utility>

#include "livens/dynamics/start/prepared.h"

namespace livens {

SolvedScenario solve_scenario(const Scenario& scenario, SolveOptions options,
                              const std::shared_ptr<Prepared>& prepared)
{
    options.judge = false;   // not part of what is timed, nor is the estimate
    Problem problem{scenario.conditions, {}, nullptr, prepared};
    const auto begin = std::chrono::steady_clock::now();
    SolvedScenario solved{solve(scenario.model, problem, scenario.time, scenario.method, options),
                          std::move(problem)};
    solved.solve_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() -
        solved.solution.estimate_seconds;
    estimate(scenario.model, solved.problem, scenario.method, options, solved.solution);
    return solved;
}

Run judged_run(const Scenario& scenario, SolvedScenario&& solved, const std::function<bool()>& goes_on)
{
    Solution& solution = solved.solution;
    judge(scenario.model, solved.problem, scenario.options, solution, goes_on);
    const Method method = solution.method;
    Run run = make_run(scenario.model, std::move(solution), method);
    run.scenario_text = scenario.text;
    run.meshes = scenario.meshes;
    run.title = scenario.title;
    run.resolved = scenario.resolved;
    // Without output times the element ends are the samples, where a motion has its best states.
    run.output = scenario.output.empty() ? run.motion.mesh.ends : scenario.output;
    return run;
}

}   // namespace livens
