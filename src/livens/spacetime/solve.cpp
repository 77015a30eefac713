#include "livens/spacetime/solve.h"

#include <cmath>
#include <utility>

#include "livens/base/error.h"
#include "livens/spacetime/lobatto/march.h"
#include "livens/spacetime/mixed/solve_mixed.h"
#include "livens/stepping/stepping.h"

namespace livens {

namespace {

Solution march(const Model& model, const Assembly& assembly, const TimeMesh& mesh, const Method& method,
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

void check_state(const Model& model, const State& state, const char* path)
{
    if (state.X.size() == model.bodies().size() && state.V.size() == model.bodies().size()) return;
    throw InputError({"start-size", path, std::string("the ") + path + " needs X and V of every body",
                      std::to_string(state.X.size()), std::to_string(model.n_bodies()), "", ""});
}

void check_boundary(const Model& model, const Boundary& boundary, const Method& method)
{
    check_state(model, boundary.start, "start");
    if (boundary.at_end != Given::nothing) check_state(model, boundary.end, "end");
    const auto count = [&](Given what) {
        const auto is = [&](Given given) { return given == what || given == Given::state ? 1 : 0; };
        return is(boundary.at_start) + is(boundary.at_end);
    };
    if (count(Given::positions) + count(Given::momenta) != 2)
        throw InputError({"boundary-conditions", "end.given",
                          "the conditions at the ends of time do not determine a motion", "",
                          "two of: positions and momenta at the start, positions and momenta at the end", "",
                          "give the state at one end, or one half of it at each"});
    if (count(Given::positions) == 0)
        throw InputError({"boundary-conditions", "end.given",
                          "momenta at both ends do not tell where the bodies are", "",
                          "positions at one end at least",
                          "what moves freely could be displaced without any change of its momenta",
                          "give positions at the start or at the end"});
    if (std::holds_alternative<Mixed>(method) || boundary.at_start == Given::state) return;
    throw InputError({"boundary-method", "start.given",
                      "the method " + name_of(method) + " needs the whole state at the start", "",
                      "given = \"state\" at the start", "",
                      "use the family mixed for conditions at the end of time"});
}

}   // namespace

std::string name_of(const Method& method)
{
    if (const auto* lobatto = std::get_if<Lobatto>(&method))
        return "lobatto(" + std::to_string(lobatto->degree) + ")";
    if (std::holds_alternative<Midpoint>(method)) return "midpoint";
    if (std::holds_alternative<Endpoint>(method)) return "endpoint";
    const Mixed& mixed = std::get<Mixed>(method);
    const char* const bases[] = {"lagrange", "bspline", "nurbs"};
    return std::string("mixed(") + bases[static_cast<int>(mixed.basis)] + ", " +
           std::to_string(mixed.degree) + ", " +
           (mixed.start == Mixed::Start::natural ? "natural" : "strong") + ", " +
           (mixed.multipliers == Mixed::Multipliers::equal ? "equal" : "lower") + ")";
}

void check_method(const Model& model, const Boundary& boundary, const TimeMesh& mesh, const Method& method,
                  const SolveOptions& options)
{
    if (model.n_bodies() == 0)
        throw InputError({"no-bodies", "body", "a model needs at least one body", "", "", "", "add a body"});
    check_boundary(model, boundary, method);
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
    if (const auto* mixed = std::get_if<Mixed>(&method)) check_mixed(model, boundary, mesh, *mixed);
}

Solution solve(const Model& model, const Boundary& boundary, const TimeMesh& mesh, const Method& method,
               const SolveOptions& options)
{
    check_method(model, boundary, mesh, method, options);
    if (const auto* mixed = std::get_if<Mixed>(&method))
        return solve_mixed(model, boundary, mesh, *mixed, options);
    const Assembly assembly = assemble(model, boundary.start, options.initial);
    return march(model, assembly, mesh, method, options);
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
    if (std::holds_alternative<Mixed>(method))
        throw InputError(
            {"sample-exact-method", "at", "the elements of the family mixed cannot be solved one by one", "",
             "", "each depends on all others of its block",
             "sample the polynomials, whose order is stated, or make the instant an output time"});
    SolveOptions quiet = options;
    quiet.progress = {};
    quiet.condition = false;   // one shortened element is not what was asked about
    quiet.initial =
        StartPolicy::project;   // an end state holds its constraints to rounding; polish, never refuse
    const Assembly assembly = assemble(model, motion.at_end(element), quiet.initial);
    const TimeMesh one{{motion.mesh.ends[element], t}};
    Solution s = march(model, assembly, one, method, quiet);
    return {s.motion.at_end(s.motion.mesh.n_elements()), std::move(s.report)};
}

}   // namespace livens
