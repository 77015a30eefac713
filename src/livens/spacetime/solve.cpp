#include "livens/spacetime/solve.h"

#include <cmath>
#include <utility>

#include "livens/base/error.h"
#include "livens/spacetime/lobatto/march.h"
#include "livens/stepping/stepping.h"

namespace livens {

namespace {

Solution dispatch(const Model& model, const Assembly& assembly, const TimeMesh& mesh, const Method& method,
                  const SolveOptions& options)
{
    if (const auto* lobatto = std::get_if<Lobatto>(&method))
        return march_lobatto(model, assembly, mesh, lobatto->degree, options);
    const auto rule =
        std::holds_alternative<Midpoint>(method) ? SteppingRule::midpoint : SteppingRule::endpoint;
    SteppingResult result = march_stepping(model, assembly, mesh, rule,
                                           {options.tolerance, options.max_iterations, options.progress});
    return {std::move(result.motion), std::move(result.report)};
}

void check(const Model& model, const Boundary& boundary, const TimeMesh& mesh, const SolveOptions& options)
{
    if (model.n_bodies() == 0)
        throw InputError({"no-bodies", "body", "a model needs at least one body", "", "", "", "add a body"});
    if (boundary.start.X.size() != model.bodies().size() || boundary.start.V.size() != model.bodies().size())
        throw InputError({"start-size", "start", "the start needs X and V of every body",
                          std::to_string(boundary.start.X.size()), std::to_string(model.n_bodies()), "", ""});
    if (mesh.n_elements() < 1)
        throw InputError(
            {"no-elements", "time.elements", "at least one time element is needed", "", ">= 1", "", ""});
    if (!(options.tolerance > 0) || !(options.tolerance < 1))
        throw InputError({"tolerance-out-of-range", "method.tolerance",
                          "the tolerance must lie between 0 and 1", std::to_string(options.tolerance),
                          "0 < tolerance < 1", "", ""});
    if (options.max_iterations < 1)
        throw InputError({"max-iterations-out-of-range", "method.max_iterations",
                          "at least one iteration is needed", std::to_string(options.max_iterations), ">= 1",
                          "", ""});
}

}   // namespace

Solution solve(const Model& model, const Boundary& boundary, const TimeMesh& mesh, const Method& method,
               const SolveOptions& options)
{
    check(model, boundary, mesh, options);
    const Assembly assembly = assemble(model, boundary.start, options.initial);
    return dispatch(model, assembly, mesh, method, options);
}

ExactSample sample_exactly(const Model& model, const Motion& motion, const Method& method, double t,
                           const SolveOptions& options)
{
    if (!(t >= motion.start() && t <= motion.end()))
        throw InputError({"time-out-of-range", "at", "the instant lies outside the motion", std::to_string(t),
                          std::to_string(motion.start()) + " to " + std::to_string(motion.end()), "", ""});
    const int element = motion.mesh.element_at(t);
    for (int end = element; end <= element + 1; ++end)
        if (motion.mesh.ends[end] == t) return {motion.at_end(end), {}};
    SolveOptions quiet = options;
    quiet.progress = {};
    quiet.initial =
        StartPolicy::project;   // an end state holds its constraints to rounding; polish, never refuse
    const Assembly assembly = assemble(model, motion.at_end(element), quiet.initial);
    const TimeMesh one{{motion.mesh.ends[element], t}};
    Solution s = dispatch(model, assembly, one, method, quiet);
    return {s.motion.at_end(s.motion.mesh.n_elements()), std::move(s.report)};
}

}   // namespace livens
