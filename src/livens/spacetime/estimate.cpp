// SPDX-License-Identifier: BSD-3-Clause
// The error of a motion by a second solution on the same elements.
#include <algorithm>
#include <variant>

#include "livens/spacetime/solve.h"

namespace livens {

namespace {

/// Elements of a second solution that are kept in memory together.
constexpr int elements_at_once = 4096;

TimeMesh halved(const TimeMesh& mesh)
{
    TimeMesh finer;
    for (int e = 0; e < mesh.n_elements(); ++e) {
        finer.ends.push_back(mesh.ends[e]);
        finer.ends.push_back(mesh.ends[e] + 0.5 * mesh.length(e));
    }
    finer.ends.push_back(mesh.end());
    return finer;
}

/// The same problem with one degree more, or with half the steps.
Solution solve_finer(const Model& model, const Problem& problem, const TimeMesh& mesh, const Method& method,
                     const SolveOptions& options)
{
    if (const auto* lobatto = std::get_if<Lobatto>(&method)) {
        Lobatto finer = *lobatto;
        ++finer.degree;
        return solve(model, problem, mesh, finer, options);
    }
    return solve(model, problem, halved(mesh), method, options);
}

/// The error by the distance from the finer solution.
double order_factor(const Method& method)
{
    return std::holds_alternative<Midpoint>(method)   ? 4.0 / 3
           : std::holds_alternative<Endpoint>(method) ? 2
                                                      : 1;
}

}   // namespace

void estimate(const Model& model, const Problem& problem, const Method& method, const SolveOptions& options,
              Solution& solution)
{
    if (options.estimate == SolveOptions::Estimate::none || !solution.report.converged() ||
        std::holds_alternative<Mixed>(method))
        return;
    const Motion& motion = solution.motion;
    const int n = motion.n_elements();
    const bool backwards = problem.conditions.at_end == Known::state;
    const bool is_march = backwards || problem.conditions.at_start == Known::state;
    const int piece = is_march ? std::min(n, elements_at_once) : n;
    ErrorMeter meter(model, motion, order_factor(method));
    Problem rest = problem;
    rest.guess = [&motion](double t) { return motion.at(t); };
    SolveOptions quiet = options;
    quiet.condition = quiet.judge = false;
    for (int done = 0; done < n; done += piece) {
        const int first = backwards ? std::max(n - done - piece, 0) : done, last = std::min(first + piece, n);
        const TimeMesh mesh{
            {motion.mesh.ends.begin() + first, motion.mesh.ends.begin() + (backwards ? n - done : last) + 1}};
        const Solution second = solve_finer(model, rest, mesh, method, quiet);
        if (!second.report.converged()) {
            if (second.report.status == SolveStatus::cancelled)
                solution.report.notes.push_back("stopped as asked before the error was estimated");
            else
                solution.report.second_failed = second.report.message;
            return;
        }
        meter.compare(second.motion, first, backwards ? n - done : last);
        (backwards ? rest.conditions.end : rest.conditions.start) =
            second.motion.at_end(backwards ? 0 : second.motion.n_elements());
        quiet.initial = StartPolicy::project;   // an end state holds its constraints to rounding
    }
    solution.estimate = meter.take();
}

}   // namespace livens
