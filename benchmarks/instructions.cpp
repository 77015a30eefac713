// SPDX-License-Identifier: BSD-3-Clause
// The program that scripts/instructions runs under callgrind: `instructions NAME` solves one kernel, `--all`
// every one. Prints a line "name elements error" each; fails if a motion is not the right one.
// `instructions chain KIND BODIES ELEMENTS` solves a chain and prints "KIND BODIES ELEMENTS steps", the most
// of an element; fails if that needed a tangent.
// `instructions scenario FILE [bare | again | all RESULT]` solves a scenario as it asks, without estimate and
// growth, without them on the mesh and with the method that it ended with, or judges it and writes it to
// RESULT, too, and prints "elements largest-estimate tries"; what is counted is not reading, and neither judging
// nor writing but in the last case.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>
#include <utility>

#include "kernels.h"
#include "livens/io/results.h"
#include "livens/io/scenario.h"
#include "livens/io/solve_scenario.h"

namespace {

using livens::benchmarks::Kernel;

std::function<livens::Solution()> counted_work;
livens::Solution* counted_solution = nullptr;

}   // namespace

// Callgrind counts between entry and return of this function and knows it by its plain name, so it must
// neither be inlined nor cloned: external, and called through a pointer that the compiler cannot see through.
extern "C" void livens_counted_solve();
__attribute__((noinline, used)) void livens_counted_solve()
{
    *counted_solution = counted_work();
}

namespace {

livens::Solution count(std::function<livens::Solution()> work)
{
    void (*volatile counted)() = livens_counted_solve;
    livens::Solution solution;
    counted_work = std::move(work);
    counted_solution = &solution;
    counted();
    return solution;
}

livens::Solution solve_counted(const Kernel& kernel)
{
    return count([&] { return livens::benchmarks::run(kernel); });
}

livens::Solution solve_and_write(const livens::Scenario& scenario, const char* path)
{
    livens::Run run = livens::judged_run(
        scenario, livens::solve_scenario(scenario, scenario.options, std::make_shared<livens::Prepared>()),
        {});
    livens::write_run(path, scenario.model, run);
    livens::Solution solution;
    solution.motion = std::move(run.motion);
    solution.report = std::move(run.report);
    solution.estimate = std::move(run.estimate);
    return solution;
}

int solve_file(const char* path, const std::string& how, const char* result)
{
    const livens::ScenarioResult read = livens::read_scenario(path);
    if (!read.scenario) {
        std::fprintf(stderr, "%s cannot be read\n", path);
        return 2;
    }
    const livens::Scenario& scenario = *read.scenario;
    livens::SolveOptions bare = scenario.options;
    bare.estimate = livens::SolveOptions::Estimate::none;
    bare.growth = bare.judge = false;
    const auto solve_as = [&](const livens::SolveOptions& options) {
        return livens::solve_scenario(scenario, options, std::make_shared<livens::Prepared>()).solution;
    };
    livens::Solution solution;
    if (how == "again") {
        const livens::Solution first = solve_as(scenario.options);
        solution = count([&] {
            return livens::solve(scenario.model, {scenario.model.start()}, first.motion.mesh, first.method,
                                 bare);
        });
    } else if (how == "all") {
        solution = count([&] { return solve_and_write(scenario, result); });
    } else {
        solution = count([&] { return solve_as(how == "bare" ? bare : scenario.options); });
    }
    std::printf("%d %.2e %d\n", solution.motion.n_elements(), solution.estimate.largest,
                solution.report.tries);
    if (solution.report.converged()) return 0;
    std::fprintf(stderr, "%s\n", solution.report.message.c_str());
    return 1;
}

int solve_chain(int n, const char* kind, int n_elements)
{
    const livens::SolveReport report =
        solve_counted(livens::benchmarks::chain_kernel(n, kind, n_elements)).report;
    int most = 0;   // but for the first elements, which have nothing to go on from
    for (std::size_t e = 3; e < report.iterations.size(); ++e)
        most = report.iterations[e] > most ? report.iterations[e] : most;
    std::printf("%s %d %d %d\n", kind, n, n_elements, most);
    if (report.converged() && report.factorisations == 0) return 0;
    std::fprintf(stderr, "not by the kernel alone; %s\n", report.message.c_str());
    return 1;
}

}   // namespace

int main(int argc, char** argv)
{
    if (argc == 5 && std::strcmp(argv[1], "chain") == 0)
        return solve_chain(std::atoi(argv[3]), argv[2], std::atoi(argv[4]));
    if (argc >= 3 && std::strcmp(argv[1], "scenario") == 0)
        return solve_file(argv[2], argc > 3 ? argv[3] : "", argc > 4 ? argv[4] : "instructions.nc");
    if (argc != 2) {
        std::fprintf(stderr, "usage: instructions NAME | --all | chain KIND BODIES ELEMENTS\n"
                             "       instructions scenario FILE [bare | again | all RESULT]\n");
        return 2;
    }
    bool found = false, good = true;
    for (const Kernel& kernel : livens::benchmarks::counted_kernels()) {
        if (std::strcmp(argv[1], "--all") != 0 && kernel.name != argv[1]) continue;
        found = true;
        const livens::Solution solution = solve_counted(kernel);
        const double error = livens::benchmarks::error(kernel, solution);
        std::printf("%s %d %.2e\n", kernel.name.c_str(), kernel.mesh.n_elements(), error);
        if (!(error <= kernel.largest_error)) {
            std::fprintf(stderr, "%s: error %.2e m, at most %.0e m is right; %s\n", kernel.name.c_str(),
                         error, kernel.largest_error, solution.report.message.c_str());
            good = false;
        }
    }
    if (!found) std::fprintf(stderr, "no kernel '%s'\n", argv[1]);
    return found && good ? 0 : 1;
}
