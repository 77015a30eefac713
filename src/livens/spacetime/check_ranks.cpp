// SPDX-License-Identifier: BSD-3-Clause
// What is divided among ranks, and what is not.
#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "livens/base/error.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/march/part_of_ranks.h"
#include "livens/spacetime/mixed/bases.h"
#include "livens/spacetime/on_ranks.h"

namespace livens {

namespace {

[[noreturn]] void refuse(const char* code, const char* path, const std::string& what,
                         const std::string& given, const std::string& help)
{
    throw InputError({code, path, what, given, "", "docs/howto/cluster.md", help});
}

constexpr const char* without = "solve it without '--distributed'";

void check_mixed_elements(const Mixed& method, const TimeMesh& mesh, const SolveOptions& options)
{
    const std::string all = without;
    if (method.window != 0 && method.window < mesh.n_elements())
        refuse("ranks-method", "method.window", "blocks that follow each other are not divided among ranks",
               std::to_string(method.window), "all elements at once, or " + all);
    if (method.basis != Mixed::Basis::lagrange)
        refuse("ranks-method", "method.basis", "functions of several elements are not divided among ranks",
               std::string(mixed::basis_of(method).word), "Lagrange's basis, or " + all);
    if (method.linear_solver != SparseBackend::eigen || options.condition)
        refuse("ranks-method", options.condition ? "method.condition" : "method.linear_solver",
               "ranks have no matrix of the whole", "", "leave it out, or " + all);
}

/// Of laws that bend at places of their own. A spring through its centre is looked at inside of elements.
bool has_bends(const Model& model)
{
    const auto bends = [](const ConstraintRow& row) { return row.guard.has_value(); };
    return std::ranges::any_of(model.loads(), [](const Load& load) { return !load.guards.empty(); }) ||
           std::ranges::any_of(model.joints(),
                               [&](const Joint& j) { return std::ranges::any_of(j.rows, bends); });
}

void check_lobatto(const Model& model, const Problem& problem, const Lobatto& method, const TimeMesh& mesh,
                   const SolveOptions& options)
{
    const std::string all = without;
    const bool is_from_state = problem.conditions.has_state();
    if (is_from_state && method.window != 0 && method.window < mesh.n_elements())
        refuse("ranks-method", "method.window",
               "a march goes element by element, and cannot be divided among ranks",
               std::to_string(method.window), "all elements at once, or " + all);
    if (options.condition)
        refuse("ranks-method", "method.condition", "ranks have no matrix of the whole", "",
               "leave it out, or " + all);
    if (is_from_state && options.end_at_bends && has_bends(model))
        refuse("ranks-conditions", "load",
               "where laws bend, elements end: only a march, element by element, finds these instants", "",
               all);
    if (is_over_phases(model, problem))
        refuse("ranks-conditions", "end.known",
               "unknown numbers behind a start that is known are not found by ranks", "",
               "a start that is known by component, or " + all);
    const bool is_against_time = problem.conditions.at_end == Known::state;
    if (is_against_time && !ModelTables(model, {}).loads.turns.empty())
        refuse("ranks-conditions", "end",
               "laws that count turns of joints are not solved by ranks from the end of time", "", all);
}

}   // namespace

void check_ranks(const Model& model, const Problem& problem, const Time& time, const Method& method,
                 const SolveOptions& options, int n_ranks)
{
    check_method(model, problem, time, method, options);
    const auto* mesh = std::get_if<TimeMesh>(&time);
    const auto* lobatto = std::get_if<Lobatto>(&method);
    const std::string all = without;
    if (mesh == nullptr || (lobatto == nullptr && !std::holds_alternative<Mixed>(method)))
        refuse("ranks-method", "method.family",
               "only elements of the families mixed and lobatto, of a given number, are divided among ranks",
               name_of(method), "one of these families with a number of elements, or " + all);
    if (lobatto != nullptr)
        check_lobatto(model, problem, *lobatto, *mesh, options);
    else
        check_mixed_elements(std::get<Mixed>(method), *mesh, options);
    if (options.roots > 1)
        refuse("ranks-conditions", "method.roots", "several motions are not looked for by ranks",
               std::to_string(options.roots), "leave roots out, or " + all);
    if (model.has_events() || model.has_rotors())
        refuse("ranks-conditions", "event",
               "events and inertias along coordinates are not divided among ranks", "", all);
    const std::vector<int> parts = parts_of_ranks(model, *mesh, n_ranks, method);
    for (std::size_t i = 1; i < parts.size(); ++i)
        if (parts[i] <= parts[i - 1])
            refuse("ranks-elements", "time.elements", "every rank needs an element of its own",
                   std::to_string(mesh->n_elements()) + " elements for " + std::to_string(n_ranks) + " ranks",
                   "start fewer ranks");
}

}   // namespace livens
