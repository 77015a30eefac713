// SPDX-License-Identifier: BSD-3-Clause
// What solve() refuses before it solves anything, and what methods are called.
// Conditions at the ends of time decide what methods can do (theory.md, "Windows"); each refusal names the
// key of the scenario, the reason and a way out.
#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/solvers/crew.h"
#include "livens/spacetime/elements/rule.h"
#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/mixed/bases.h"
#include "livens/spacetime/mixed/window.h"
#include "livens/spacetime/phases/phases.h"
#include "livens/spacetime/rotating.h"
#include "livens/spacetime/solve.h"
#include "livens/stepping/stepping.h"

namespace livens {

namespace {

void check_state(const Model& model, const State& state, const char* path)
{
    if (state.X.size() == model.bodies().size() && state.V.size() == model.bodies().size()) return;
    throw InputError({"start-size", path, std::string("the ") + path + " needs X and V of every body",
                      std::to_string(state.X.size()), std::to_string(model.n_bodies()), "", ""});
}

/// Momenta at both ends do not say where free bodies are: bodies that neither joints nor loads tie to the
/// world, directly or through others, can be displaced together.
void refuse_free_bodies(const Model& model)
{
    std::vector<int> group(model.bodies().size());
    for (int b = 0; b < model.n_bodies(); ++b) group[b] = b;
    std::vector<bool> is_held(group.size(), false);
    const auto tie = [&](int i, int j) {
        if (i == world) std::swap(i, j);
        if (i == world) return;
        if (j == world) {
            is_held[group[i]] = true;
            return;
        }
        const int from = group[j], to = group[i];
        if (from == to) return;
        is_held[to] = is_held[to] || is_held[from];
        for (int& g : group)
            if (g == from) g = to;
    };
    for (int r = 0; r < model.n_rows(); ++r) {
        tie(model.row(r).body_i, model.row(r).body_j);
        for (const PairForm& q : model.row(r).coordinates) tie(q.body_i, q.body_j);
    }
    for (const Load& load : model.loads())
        // A spring holds a body like a joint; a force without a potential may follow it anywhere.
        for (std::size_t b = 1; load.depends_on_X && load.potential && b < load.n_acted; ++b)
            tie(load.bodies[0], load.bodies[b]);
    for (int b = 0; b < model.n_bodies(); ++b)
        if (!is_held[group[b]])
            throw InputError(
                {"boundary-conditions", "end.given",
                 "momenta at both ends do not determine where body '" + model.body_name(b) + "' is", "",
                 "positions at one end at least",
                 "it could be displaced in any direction without any change of its momenta",
                 "give positions at the start or at the end"});
}

/// The other families follow no drives, and elements of the paper no turns, which are counted from node to
/// node.
void refuse_special_rows(const Model& model, const Method& method)
{
    if (is_nodal(method) || !model.events().empty()) return;   // check_events() tells
    const std::string name = std::holds_alternative<Mixed>(method) ? "mixed" : name_of(method);
    if (model.has_drives())
        throw InputError({"drives-method", "method.family", "the method " + name + " cannot follow drives",
                          name, "lobatto or radau", "", "use lobatto for joints that depend on time"});
    for (int r = 0; r < model.n_rows() && std::holds_alternative<Mixed>(method); ++r)
        if (model.row(r).period > 0)
            throw InputError({"joint-method", "method.family",
                              "the method " + name + " cannot hold " + model.row_name(r), name,
                              "lobatto, radau, midpoint or endpoint",
                              "its row counts turns of angles, from node to node",
                              "use lobatto for screws, gears and couplings of angles"});
}

/// Where forces follow the motion, vibrations and laws that bend make errors that add up from element to
/// element, of which velocity jumps tell up to a hundred times too little.
void refuse_laws_of_the_motion(const Model& model)
{
    for (const Load& load : model.loads())
        if (load.depends_on_X || load.depends_on_V)
            throw InputError({"estimate-method", "method.estimate",
                              "the errors of elements do not bound that of the motion here", "local",
                              "second or none",
                              "the force of load '" + load.name +
                                  "' depends on the motion: errors of its vibrations add up over elements, "
                                  "which velocity jumps do not show",
                              "use the estimate by a second solution"});
}

void check_accuracy(const Conditions& given, const Span& span, const Method& method,
                    const SolveOptions& options)
{
    if (!(span.accuracy > 0) || !(span.accuracy <= 0.1))
        throw InputError({"accuracy-out-of-range", "time.accuracy", "the accuracy must lie between 0 and 0.1",
                          to_text(span.accuracy), "0 < accuracy <= 0.1",
                          "it is an error, in model lengths and in rad", ""});
    const auto refuse = [](const char* place, const std::string& why) {
        throw InputError({"accuracy-elements", place, "elements are not found for an accuracy here", "", "",
                          why, "give elements instead of the accuracy"});
    };
    const auto* lobatto = std::get_if<Lobatto>(&method);
    const auto* either = std::get_if<AutomaticFamily>(&method);
    if (!is_nodal(method)) refuse("method.family", "only lobatto and radau find their elements themselves");
    if (given.at_end == Known::state)
        refuse("end.given", "they are found from a state at the start, or between conditions at both ends");
    if (lobatto != nullptr && lobatto->window != 1)
        refuse("method.window", "they are found one by one, in windows of one element");
    if (options.estimate != SolveOptions::Estimate::second)
        refuse("method.estimate", "the error is not known without the second solution");
    if (options.condition)
        refuse("method.condition", "condition numbers belong to a mesh that is known before");
    const int degree = lobatto != nullptr  ? lobatto->degree
                       : either != nullptr ? either->degree
                                           : std::get<Radau>(method).degree;
    if (degree != 0) check_degree(either != nullptr ? Lobatto{degree} : method, false);
    make_time_mesh(span.start, span.end, 1, span.output);   // throws
}

/// Speeds and kinetic energies have their least value where all rates are zero, which is more than one
/// condition.
void refuse_no_speed(const Condition& one)
{
    const std::string& name = one.quantity.name;
    if (!(name.ends_with(".speed") || name.ends_with(".kinetic_energy")) || !one.quantity.function) return;
    if (one.value > 0 || one.at == Condition::At::both) return;
    throw InputError({"conditions-value",
                      std::string(one.at == Condition::At::end ? "end" : "start") + ".known[" + name + "]",
                      "'" + name + "' has to be positive", to_text(one.value, 6), "> 0",
                      "at rest it says that all rates are zero, which is more than one condition",
                      "give rates or velocities instead"});
}

/// Conditions by component take all of time at once.
void check_components(const Model& model, const Problem& problem, const Time& time, const Method& method,
                      const SolveOptions& options)
{
    const Conditions& given = problem.conditions;
    check_state(model, given.start, "start");
    if (!given.end.X.empty()) check_state(model, given.end, "end");
    for (const Condition::At at : {Condition::At::start, Condition::At::end}) {
        const std::string end = at == Condition::At::start ? "start" : "end";
        const Known known = at == Condition::At::start ? given.at_start : given.at_end;
        if (known != Known::nothing && std::ranges::count(given.components, at, &Condition::at) > 0)
            throw InputError({"boundary-conditions", end + ".known",
                              "conditions by component stand beside what is given for all bodies at this end",
                              "", "one of the two", "",
                              "leave " + end + ".given away, or " + end + ".known"});
        if (known == Known::momenta && given.is_periodic)
            throw InputError({"boundary-conditions", end + ".given",
                              "momenta of all bodies are given of a periodic motion", "momenta",
                              "positions, state or nothing",
                              "both ends are alike, so that each condition says something of both",
                              "give rates by component in " + end + ".known"});
    }
    const auto refuse = [](const char* path, const std::string& what, const std::string& why,
                           const std::string& help) {
        throw InputError(
            {"conditions-method", path, what + " cannot take conditions by component", "", "", why, help});
    };
    const auto* mixed = std::get_if<Mixed>(&method);
    if (!std::holds_alternative<Lobatto>(method) && !std::holds_alternative<AutomaticFamily>(method) &&
        mixed == nullptr)
        refuse("method.family", "the method " + name_of(method),
               "momenta at both ends are unknowns of lobatto and mixed alone", "use lobatto");
    if (mixed != nullptr && mixed->start == Mixed::Start::strong)
        refuse("method.momentum", "the strong momentum",
               "its law has no momenta at the ends of time that conditions could decide",
               "take the natural momentum");
    if (mixed != nullptr && given.at_start == Known::state && !problem.unknowns.is_empty())
        refuse("method.family", "elements 'mixed' with unknown numbers and a known state at the start",
               "they are solved with the momenta at both ends",
               "use lobatto, or give components at the start");
    if (mixed != nullptr && (given.at_start == Known::momenta || given.at_end == Known::momenta))
        refuse("method.family", "elements 'mixed' with momenta of all bodies at the other end",
               "other motions that meet them are looked for with lobatto alone", "use lobatto");
    if (given.turn && !(norm(given.turn->axis) > 0))
        throw InputError(
            {"axis-zero", "time.periodic", "the axis of the turn must not be zero", "0, 0, 0", "", "", ""});
    for (const Condition& one : given.components)
        if (!std::isfinite(one.value))
            throw InputError({"not-finite", "start.known[" + one.quantity.name + "]",
                              "the value of '" + one.quantity.name + "' is no number", to_text(one.value),
                              "a finite number", "", ""});
    for (const Condition& one : given.components) refuse_no_speed(one);
    close_ends(model, problem, start_of(time), end_of(time), options.initial);   // throws
}

/// Unknown numbers: those of the problem itself, before any is looked for.
void check_unknowns(const Problem& problem, const SolveOptions& options)
{
    const Conditions& given = problem.conditions;
    const bool is_whole = (given.at_start != Known::nothing && given.at_start != Known::state) ||
                          given.at_end != Known::nothing;
    const auto refuse = [&](bool is_wrong, const char* path, const char* what, const char* help) {
        if (is_wrong && !problem.unknowns.is_empty() && given.has_components())
            throw InputError({"conditions-method", path,
                              std::string(what) + " is not solved for together with unknown numbers", "", "",
                              "", help});
    };
    refuse(is_whole, "start.given", "a motion with places or momenta of all bodies at an end",
           "give its conditions by component, or the state at the start");
    refuse(options.roots > 1, "method.roots", "more than one motion", "leave roots out");
    for (const UnknownNumber& number : problem.unknowns.numbers) {
        const std::string path = "unknown[" + number.name + "]", named = "the unknown '" + number.name + "'";
        if (!std::isfinite(number.guess))
            throw InputError({"not-finite", path, named + " has no number as its guess",
                              to_text(number.guess), "a finite number", "", ""});
        if (!(number.low < number.high))
            throw InputError({"unknown-bounds", path, named + " has no room between its bounds",
                              "low = " + to_text(number.low) + ", high = " + to_text(number.high),
                              "low < high", "", "give bounds between which it may be, or none"});
        if (!(number.guess >= number.low && number.guess <= number.high))
            throw InputError({"unknown-guess", path, named + " is guessed outside of its bounds",
                              to_text(number.guess), to_text(number.low) + " to " + to_text(number.high), "",
                              "guess a number between the bounds, or widen them"});
        if (!given.has_components())
            throw InputError({"unknown-march", path, named + " stands where nothing decides it", "", "",
                              "conditions by component at both ends of time decide unknown numbers; a march "
                              "from a state has none to spare",
                              "give conditions by component, one more for each unknown"});
    }
}

void check_conditions(const Model& model, const Conditions& given, const Method& method)
{
    const auto is_at = [&](const State& state, Known known, const char* path) {
        if (known != Known::nothing) check_state(model, state, path);
    };
    is_at(given.start, given.at_start, "start");
    is_at(given.end, given.at_end, "end");
    const int positions = (knows_positions(given.at_start) ? 1 : 0) + (knows_positions(given.at_end) ? 1 : 0);
    const int momenta = (knows_momenta(given.at_start) ? 1 : 0) + (knows_momenta(given.at_end) ? 1 : 0);
    // Hamilton's law has two boundary terms: one half of the state at each end, or both at one.
    if (positions + momenta != 2)
        throw InputError({"boundary-conditions", "end.given",
                          "the conditions at the ends of time do not determine a motion", "",
                          "two of: positions and momenta at the start, positions and momenta at the end", "",
                          "give the state at one end, or one half of it at each"});
    if (given.at_start == Known::state) return;
    if (!is_elements(method) || std::holds_alternative<Radau>(method))
        throw InputError({"boundary-method", "start.given",
                          "the method " + name_of(method) + " needs the whole state at the start", "",
                          "the state at the start", "",
                          "use lobatto or mixed for conditions at the end of time"});
    if (positions == 0) refuse_free_bodies(model);
}

}   // namespace

std::string name_of(const Method& method)
{
    if (const auto* lobatto = std::get_if<Lobatto>(&method))
        return "lobatto(" + std::to_string(lobatto->degree) + ")";
    if (const auto* radau = std::get_if<Radau>(&method))
        return "radau(" + std::to_string(radau->degree) + ")";
    if (std::holds_alternative<AutomaticFamily>(method)) return "auto";
    if (std::holds_alternative<Midpoint>(method)) return "midpoint";
    if (std::holds_alternative<Endpoint>(method)) return "endpoint";
    const Mixed& mixed = std::get<Mixed>(method);
    return "mixed(" + std::string(mixed::basis_of(mixed).word) + ", " + std::to_string(mixed.degree) + ", " +
           std::string(word_of(mixed.start)) + ", " + std::string(word_of(mixed.multipliers)) + ")";
}

/// Conditions elsewhere say nothing of states, and would take them for places and velocities of bodies.
static void refuse_states(const Model& model, const Conditions& conditions)
{
    const bool has_states = std::ranges::any_of(model.bodies(), &Body::holds_states);
    const bool is_from_start = conditions.at_start == Known::state && conditions.at_end == Known::nothing &&
                               !conditions.has_components();
    if (!has_states || is_from_start) return;
    throw InputError({"controller-ends", conditions.at_end == Known::nothing ? "start" : "end",
                      "controllers need a motion from its start, whose whole state is given", "",
                      "the state at the start",
                      "conditions at the end and periodic motions say nothing of what controllers remember",
                      "give the state at the start, or put formulas in the place of controllers"});
}

void check_method(const Model& model, const Problem& problem, const Time& time, const Method& method,
                  const SolveOptions& options)
{
    if (model.n_bodies() == 0)
        throw InputError({"no-bodies", "body", "a model needs at least one body", "", "", "", "add a body"});
    refuse_rotors(model, problem.conditions, method);
    refuse_states(model, problem.conditions);
    refuse_special_rows(model, method);
    check_unknowns(problem, options);
    check_events(model, problem, time, method, options);
    if (!problem.conditions.has_components())
        check_conditions(model, problem.conditions, method);
    else
        check_components(model, problem, time, method, options);
    const auto* mesh = std::get_if<TimeMesh>(&time);
    if (mesh != nullptr && mesh->n_elements() < 1)
        throw InputError(
            {"no-elements", "time.elements", "at least one time element is needed", "", ">= 1", "", ""});
    if (!(options.tolerance > 0) || !(options.tolerance < 1))
        throw InputError({"tolerance-out-of-range", "method.tolerance",
                          "the tolerance must lie between 0 and 1", to_text(options.tolerance),
                          "0 < tolerance < 1", "", ""});
    if (options.max_iterations < 1)
        throw InputError({"max-iterations-out-of-range", "method.max_iterations",
                          "at least one iteration is needed", std::to_string(options.max_iterations), ">= 1",
                          "", ""});
    if (options.threads < 0 || options.threads > Crew::most_threads)
        throw InputError({"threads-out-of-range", "method.threads",
                          "a motion is solved by one thread or several", std::to_string(options.threads),
                          "0 to " + std::to_string(Crew::most_threads), "0 stands for one per processor",
                          ""});
    if (options.roots < 1 || (options.roots > 1 && problem.conditions.has_state()))
        throw InputError(
            {"roots-unused", "method.roots", "several motions are looked for between both ends of time",
             std::to_string(options.roots), "1", options.roots < 1 ? "" : "a state at one end has one motion",
             "leave roots out, or give conditions at both ends"});
    if (options.estimate == SolveOptions::Estimate::local && mesh != nullptr &&
        (!is_nodal(method) || problem.conditions.at_start != Known::state))
        throw InputError({"estimate-method", "method.estimate",
                          "the errors of elements do not bound that of the motion here", "local",
                          "second or none",
                          is_nodal(method) ? "their growth is found from neighbours of a state at the start"
                                           : "those of " + name_of(method) + " are not known one by one",
                          "use the estimate by a second solution"});
    if (options.estimate == SolveOptions::Estimate::local) refuse_laws_of_the_motion(model);
    if (!is_elements(method)) check_stepping(model);
    if (mesh == nullptr) return check_accuracy(problem.conditions, std::get<Span>(time), method, options);
    if (std::holds_alternative<AutomaticFamily>(method))
        throw InputError({"accuracy-elements", "method.family",
                          "the family of elements that are given is not chosen", "auto", "lobatto or radau",
                          "which of them suits depends on how long elements are found to be",
                          "name the family, or give accuracy instead of elements"});
    if (const auto* mixed = std::get_if<Mixed>(&method))
        check_mixed(model, problem.conditions, *mesh, *mixed);
    if (is_nodal(method)) check_degree(method, problem.near != nullptr);
    if (const auto* lobatto = std::get_if<Lobatto>(&method); lobatto != nullptr && lobatto->window < 0)
        throw InputError({"window-out-of-range", "method.window", "a window has at least one element",
                          std::to_string(lobatto->window), "1 to all", "", ""});
}

}   // namespace livens
