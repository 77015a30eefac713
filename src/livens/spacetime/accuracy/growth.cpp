// SPDX-License-Identifier: BSD-3-Clause
// How perturbations of the start grow: neighbouring motions, carried along.  (docs/theory.md, "The horizon")
#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "livens/diagnostics/largest.h"
#include "livens/spacetime/accuracy/neighbours.h"
#include "livens/spacetime/accuracy/reference_solution.h"

namespace livens {

namespace {

/// Of numbers, by half.
constexpr double spacing = 0x1p-53;

double largest(const Growth& grown)
{
    double largest = 0;
    for (const double g : grown.factors) raise_to(largest, g);
    return largest;
}

/// What is told of rounding by the growth of any perturbation may be far more than what rounding does.
bool is_doubtful(const Growth& grown, double told)
{
    return largest(grown) >= growth_at_horizon || spacing * largest(grown) > told;
}

/// A perturbation in another direction might be told, or grow beyond the horizon. Also where the first one
/// could not be carried along.
bool is_near(const Growth& grown, double told, double tolerance)
{
    constexpr double missed = 30;   // times as large: what lies along a direction by chance
    return grown.factors.empty() || missed * largest(grown) >= growth_at_horizon ||
           missed * spacing * largest(grown) > told || missed * rounded_by(tolerance) * grown.later > told;
}

/// Of two perturbations, as far as one of them is known.
void take_larger(Growth& grown, Growth&& other)
{
    if (largest(other) > largest(grown)) grown.part = other.part;
    raise_to(grown.later, other.later);
    if (grown.factors.size() < other.factors.size()) std::swap(grown.factors, other.factors);
    for (std::size_t e = 0; e < other.factors.size(); ++e) raise_to(grown.factors[e], other.factors[e]);
}

/// Where a law jumps, a neighbour whose elements do not end there is pushed by all of an element; where it
/// bends and touches again and again, one whose elements do is not on the elements of the motion any more.
/// Both grow too much, not too little.
void take_smaller(Growth& grown, Growth&& other)
{
    if (!(largest(other) < largest(grown)) || other.factors.size() < grown.factors.size()) return;
    grown = std::move(other);
}

}   // namespace

Growth growth(const Model& model, const Problem& stated, const Method& method, const SolveOptions& options,
              const Motion& motion, double told)
{
    Problem problem = with_prepared(stated);
    problem.conditions.components.clear();   // of a motion from a known state
    problem.unknowns = {};
    if (problem.conditions.at_start != Known::state || motion.n_elements() == 0) return {};
    SolveOptions quiet = options;
    quiet.condition = quiet.judge = quiet.look_at_laws = false;
    quiet.end_at_bends = !model.events().empty();
    quiet.meeting = std::numeric_limits<double>::infinity();   // neighbours are beside it
    quiet.initial = StartPolicy::project;
    std::optional<Ends> closed;
    if (is_nodal(method) && !model.has_events())
        closed = close_ends(model, problem, motion.start(), motion.end(), options.initial);
    const State start = motion.at_end(0);
    const double at_start = fastest_rate(model, start.V), ever = fastest_rate(model, motion.velocities);
    Surroundings at{model, method, quiet, motion, problem.prepared, closed, ever > 0 ? ever : 1};
    const auto measured = [&](auto&& grow) {
        if (!at.is_careful) {
            Neighbours neighbours(at, options.tolerance);
            Growth grown = grow(neighbours);
            if (!neighbours.is_unsure()) return grown;
            at.is_careful = true;
        }
        Neighbours neighbours(at, options.tolerance);
        return grow(neighbours);
    };
    double stretched = 1, shrunk = 1;
    const auto measure = [&](std::span<const Kicks> kicks) {
        return measured([&](Neighbours& neighbours) {
            Growth grown = neighbours.grown_from(kicks, at_start);
            if (neighbours.is_unsure()) return grown;
            raise_to(stretched, neighbours.stretched());
            raise_to(shrunk, neighbours.shrunk());
            return grown;
        });
    };
    const std::vector<Kicks> both = kicks_everywhere(model, start, at_start);
    const std::span<const Kicks> all(both);
    Growth grown = measure(all.first(1));
    if (is_near(grown, told, options.tolerance)) {
        take_larger(grown, measure(all.last(1)));
        raise_to(grown.later, stretched * std::min(stretched, shrunk * shrunk));
    }
    at.has_bends = closed && !motion.mesh.bends.empty();
    if (at.has_bends && is_doubtful(grown, told)) take_smaller(grown, measure(all));
    if (!is_rounding_open(grown, told, options.tolerance)) return grown;
    Roundings roundings(model, motion, at.rate);
    const Growth of_rounding = measured([&](Neighbours& them) { return them.grown_from(roundings); });
    for (std::size_t e = 0; e < grown.factors.size(); ++e)
        grown.rounding.push_back(e < of_rounding.factors.size() ? of_rounding.factors[e] : grown.factors[e]);
    grown.rounding_in = of_rounding.part;
    return grown;
}

/// What is rounded on the way may grow by more than what is rounded at the start, too.
bool spacetime_internal::is_rounding_open(const Growth& grown, double told, double tolerance)
{
    return is_doubtful(grown, told) || rounded_by(tolerance) * grown.later > told;
}

}   // namespace livens
