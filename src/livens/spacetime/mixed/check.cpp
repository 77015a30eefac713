// SPDX-License-Identifier: BSD-3-Clause
// Which methods, meshes and conditions make solvable systems. What is refused would leave the matrix of (P23)
// without full rank, or momenta that no multiplier takes up (docs/theory.md, "The elements of the paper":
// What is refused).
#include <cmath>

#include "livens/base/error.h"
#include "livens/spacetime/march/windows.h"
#include "livens/spacetime/mixed/bases.h"
#include "livens/spacetime/mixed/window.h"

namespace livens {

using namespace mixed;

namespace {

[[noreturn]] void refuse_pairing(const std::string& path, const std::string& message,
                                 const std::string& value, const std::string& bound, const std::string& help)
{
    throw InputError({"mixed-pairing", path, message, value, bound,
                      "the whole matrix would be singular (docs/theory.md, \"The elements of the paper\")",
                      help});
}

void check_quadrature(const Mixed& method)
{
    if (method.gauss_points == 0) return;
    if (method.gauss_points < 0 || method.gauss_points > 64)
        throw InputError({"gauss-points-out-of-range", "method.gauss_points",
                          "the number of Gauss points in an element is out of range",
                          std::to_string(method.gauss_points), "1 to 64", "", ""});
    const bool is_natural = method.start == Mixed::Start::natural;
    const int fewest = is_natural ? method.degree + 1 : method.degree;
    if (method.gauss_points < fewest)
        refuse_pairing(
            "method.gauss_points",
            std::string("a ") + (is_natural ? "natural" : "strong") + " start of degree " +
                std::to_string(method.degree) + " needs more Gauss points",
            std::to_string(method.gauss_points), ">= " + std::to_string(fewest),
            is_natural ? "use the strong start for collocation at as many Gauss points as the degree" : "");
}

/// Positions at both ends leave one function fewer than lower multipliers constrain; the strong start
/// prescribes P = V m, which unknown directors would have to turn.
void check_conditions(const Conditions& conditions, const Mixed& method)
{
    const bool is_two_point =
        conditions.at_start == Known::positions && conditions.at_end == Known::positions;
    if (is_two_point && method.multipliers == Mixed::Multipliers::lower)
        refuse_pairing("method.multipliers",
                       "multipliers of lower degree constrain more than positions at both ends leave free",
                       "lower", "equal", "use equal multipliers");
    if (method.start == Mixed::Start::natural) return;
    for (const auto& [given, path] :
         {std::pair{conditions.at_start, "start.given"}, {conditions.at_end, "end.given"}})
        if (given == Known::momenta)
            refuse_pairing(path, "the strong start needs positions where it is given momenta", "momenta",
                           "state", "use the natural start");
}

/// The momentum that the law hands on has a part that only a multiplier of the next block's first function
/// can take up; those of lower degree cannot, and their energy drifts by a tenth whatever the mesh.
void check_interfaces(const TimeMesh& mesh, const Mixed& method)
{
    const bool is_single = method.window == 0 || method.window >= mesh.n_elements();
    if (is_single || method.multipliers == Mixed::Multipliers::equal ||
        method.interfaces == Mixed::Interfaces::project)
        return;
    throw InputError({"mixed-pairing", "method.interfaces",
                      "multipliers of lower degree cannot take up what blocks carry over", "carry", "project",
                      "docs/theory.md, \"The elements of the paper\"",
                      "use projected interfaces or equal multipliers, or a single block"});
}

/// Knots are element ends, all of them and no others.
void check_knots(const TimeMesh& mesh, const TimeSpace& space)
{
    const double tolerance = 1e-9 * (mesh.end() - mesh.start());
    bool fits = space.ends().size() == mesh.ends.size();
    for (std::size_t i = 0; fits && i < mesh.ends.size(); ++i)
        fits = std::abs(space.ends()[i] - mesh.ends[i]) <= tolerance;
    if (!fits)
        throw InputError({"knots-mesh", "method.knots", "the knots are not the ends of the time elements",
                          std::to_string(space.n_elements()) + " knot spans",
                          std::to_string(mesh.n_elements()) + " elements", "", "make the mesh of the knots"});
}

void check_blocks(const Conditions& conditions, const TimeMesh& mesh, const Mixed& method)
{
    const auto refuse = [&](const std::string& message, const std::string& bound, const std::string& help) {
        throw InputError(
            {"mixed-block", "method.window", message, std::to_string(method.window), bound, "", help});
    };
    if (method.window < 0) refuse("a block has at least one element", "1 to all", "");
    const bool is_single = method.window == 0 || method.window >= mesh.n_elements();
    if (is_single) return;
    if (!method.knots.empty() || !method.weights.empty())
        refuse("knots and weights belong to a single block", "all", "solve all elements together");
    if (conditions.at_start != Known::state && conditions.at_end != Known::state)
        refuse("conditions at both ends need a single block", "all", "solve all elements together");
    if (method.window < shortest_block(method))
        throw InputError({"spline-degree", "method.degree",
                          "the degree of a spline cannot exceed the number of elements of a block",
                          std::to_string(method.degree), "<= " + std::to_string(method.window), "",
                          "use larger blocks or a lower degree"});
}

}   // namespace

TimeMesh mesh_of_knots(const Mixed& method) { return {basis_of(method).space(method, {}, {}).ends()}; }

void spacetime_internal::check_mixed(const Model& model, const Conditions& conditions, const TimeMesh& mesh,
                                     const Mixed& method)
{
    if (method.degree < 1 || method.degree > 8)
        throw InputError({"degree-out-of-range", "method.degree",
                          "there are no such elements of the family mixed", std::to_string(method.degree),
                          "1 to 8", "", ""});
    check_quadrature(method);
    check_conditions(conditions, method);
    check_blocks(conditions, mesh, method);
    check_interfaces(mesh, method);
    const ModelTables tables(model, {});
    const Coordinates refuses_singular_masses(tables);
    const SparseLU refuses_missing_backend(method.linear_solver);
    const std::vector<int> division = divide(mesh.n_elements(), method.window, shortest_block(method));
    for (const std::size_t block : {std::size_t{0}, division.size() - 2}) {
        const TimeSpace space = space_of(model, method, mesh, division[block], division[block + 1]);
        if (!method.knots.empty()) check_knots(mesh, space);
    }
}

}   // namespace livens
