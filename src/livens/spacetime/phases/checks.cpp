// SPDX-License-Identifier: BSD-3-Clause
// Which methods and conditions know events.
#include <algorithm>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/spacetime/phases/contacts.h"
#include "livens/spacetime/phases/decisions.h"
#include "livens/spacetime/phases/event_watch.h"
#include "livens/spacetime/phases/events.h"
#include "livens/spacetime/phases/phases.h"

namespace livens::inline spacetime_internal {

namespace {

/// Between conditions at both ends all phases are solved at once, by lobatto.
void check_between_ends(const Model& model, const Problem& problem, const Method& method,
                        const SolveOptions& options)
{
    const Conditions& given = problem.conditions;
    const auto refuse = [](bool is_wrong, const char* path, const std::string& value, const char* why,
                           const char* help) {
        if (is_wrong)
            throw InputError({"joint-time-method", path,
                              "joints and drives that act for a part of the time are not solved so", value,
                              "", why, help});
    };
    const bool is_lobatto =
        std::holds_alternative<Lobatto>(method) || std::holds_alternative<AutomaticFamily>(method);
    refuse(!is_nodal(method), "method.family", name_of(method),
           "only lobatto and radau know joints that begin or end to act",
           "use lobatto, or radau from a state");
    refuse(!is_lobatto, "method.family", name_of(method),
           "between conditions at both ends all phases are solved at once, by lobatto alone", "use lobatto");
    refuse(given.at_end == Known::state, "end.given", "state",
           "what a joint did cannot be undone from the end of time", "give the state at the start");
    refuse(given.at_start == Known::momenta || given.at_end == Known::momenta,
           given.at_start == Known::momenta ? "start.given" : "end.given", "momenta",
           "momenta of all bodies are more than joints leave to choose",
           "give positions, or rates by component");
    refuse(given.is_periodic, "time.periodic", "true", "its end has other joints than its start",
           "give conditions at the start and at the end");
    const bool has_impacts =
        std::ranges::any_of(model.joints(), [](const Joint& joint) { return joint.impact.has_value(); });
    refuse(has_impacts, "joint", "restitution", "an impact is no equation between both ends",
           "give the state at the start");
    refuse(options.roots > 1, "method.roots", std::to_string(options.roots),
           "one motion is looked for over phases", "leave roots out");
}

/// Events that the motion decides are for marches forwards, one element after the other.
void check_decided(const Model& model, const Problem& problem, const Method& method,
                   const SolveOptions& options)
{
    const Event& first = model.events().front();
    const std::string path = "event[" + first.name + "]";
    const Joint* begun = begun_by_impact(model, first.action);
    const bool is_stop = begun != nullptr && begun->impact->open_side != 0;
    const auto refuse = [&](bool is_wrong, const std::string& value, const char* why, const char* help) {
        if (is_wrong)
            throw InputError(
                {"event-method", path, "what the motion decides cannot be found so", value, "", why, help});
    };
    const Conditions& given = problem.conditions;
    refuse(!is_nodal(method), name_of(method), "only elements of lobatto and radau end where events are",
           is_stop ? "use the family lobatto or radau; limits of a joint may be springs"
                   : "use the family lobatto or radau");
    refuse(!given.has_state() || given.at_start != Known::state || !problem.unknowns.is_empty(), "",
           "it is decided on the way from a state at the start",
           "give the state at the start, and no unknowns");
    const auto* lobatto = std::get_if<Lobatto>(&method);
    refuse(lobatto != nullptr && lobatto->window != 1, "a window of more than one element",
           "elements that are solved together do not end where an event is", "leave 'window' out");
    refuse(!options.end_at_bends, "breaks ignored", "elements have to end where events are",
           "leave 'breaks' out");
    if (!std::isinf(options.meeting)) check_stops(model, given.start);
    // Reactions that are not unique are refused before anything is solved, and what is no number.
    std::vector<bool> none(model.events().size(), false);
    const EventWatch watch(model, acting_at(model, given.start.t), std::move(none), given.start);
    if (watch.refusal()) throw InputError(*watch.refusal());
    for (int e = 0; e < static_cast<int>(model.events().size()); ++e) {
        const Event& event = model.events()[static_cast<std::size_t>(e)];
        if (!event.terms.reactions.empty() || watch.is_number_at(e, watch.start())) continue;
        throw InputError({"event-not-finite", "event[" + event.name + "]",
                          "the condition of '" + event.name + "' is no number where the motion begins",
                          event.text, "", "a pole, or a function outside of its range",
                          "take formulas that are finite wherever the motion comes"});
    }
    refuse(options.estimate == SolveOptions::Estimate::local, "a local estimate",
           "a second solution with events of its own tells their errors", "use \"second\" or \"none\"");
}

}   // namespace

void check_events(const Model& model, const Problem& problem, const Time& time, const Method& method,
                  const SolveOptions& options)
{
    if (!model.has_events()) return;
    const Conditions& given = problem.conditions;
    if (!model.events().empty()) check_decided(model, problem, method, options);
    const bool is_march = !given.has_components() && given.at_start == Known::state;
    if (!is_march || !is_nodal(method)) check_between_ends(model, problem, method, options);
    const auto* mesh = std::get_if<TimeMesh>(&time);
    if (mesh == nullptr) return;
    const std::vector<double> late = missed(*mesh, events_inside(model, mesh->start(), mesh->end()));
    if (!late.empty())
        throw InputError({"joint-time-mesh", "time.elements",
                          "a joint or drive begins or ends to act inside an element", to_text(late[0]) + " s",
                          "an element end", "elements follow one set of joints each",
                          "let elements end there"});
}

}   // namespace livens::inline spacetime_internal
