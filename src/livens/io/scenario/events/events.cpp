// SPDX-License-Identifier: BSD-3-Clause
// Conditions of events: comparisons of formulas, tied by `and` and `or`. A comparison a > b is the number
// a - b, which is positive where it is true (docs/theory.md, "Events").
#include "livens/io/scenario/events/events.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "livens/io/scenario/joints/expressions.h"
#include "livens/io/scenario/joints/joints.h"
#include "livens/io/scenario/loads/load_makers.h"
#include "livens/io/scenario/text/parameters.h"
#include "livens/multibody/controllers.h"

namespace livens::inline io_internal {

namespace {

[[noreturn]] void refuse_condition(const std::string& path, const std::string& text,
                                   const std::string& message, const std::string& help)
{
    throw InputError({"event-condition", path, message, "\"" + text + "\"", "", "", help});
}

/// The parts of a text between words that stand alone, outside of quotes.
std::vector<std::string> parts_between(const std::string& text, std::string_view word)
{
    std::vector<std::string> parts{""};
    bool is_quoted = false;
    const auto is_apart = [&](std::size_t i) {
        return i >= text.size() || text[i] == ' ' || text[i] == '(' || text[i] == ')';
    };
    for (std::size_t i = 0; i < text.size(); ++i) {
        is_quoted = is_quoted != (text[i] == '\'');
        const bool is_word = !is_quoted && text.compare(i, word.size(), word) == 0 &&
                             (i == 0 || is_apart(i - 1)) && is_apart(i + word.size());
        if (!is_word) {
            parts.back() += text[i];
            continue;
        }
        parts.emplace_back();
        i += word.size() - 1;
    }
    return parts;
}

/// "a > b" as the formula of what is positive where it is true.
std::string formula_of(const std::string& comparison, const std::string& text, const std::string& path)
{
    const std::size_t at = comparison.find_first_of("<>");
    const bool is_one =
        at != std::string::npos && comparison.find_first_of("<>", at + 1) == std::string::npos;
    if (!is_one)
        refuse_condition(path, text, "a condition compares two formulas with < or >",
                         "as in \"door.angle > 60 deg\", several of them with 'and' or 'or' between");
    std::string left = comparison.substr(0, at), right = comparison.substr(at + 1);
    if (right.starts_with('=')) right.erase(0, 1);
    const auto is_blank = [](const std::string& side) {
        return side.find_first_not_of(" \t") == std::string::npos;
    };
    if (is_blank(left) || is_blank(right) || right.find('=') != std::string::npos)
        refuse_condition(path, text, "a condition has a formula on either side of < or >",
                         "as in \"door.angle > 60 deg\"");
    if (comparison[at] == '<') std::swap(left, right);
    return "(" + left + ") - (" + right + ")";
}

/// `and` binds closer than `or`: `when` holds alternatives, each true where all of its comparisons are, which
/// are numbered through.
EventTerms terms_of(const Builder& builder, const Section& section, const std::string& text,
                    const std::string& path)
{
    EventTerms terms;
    std::vector<std::string> formulas;
    for (const std::string& alternative : parts_between(text, "or")) {
        terms.when.emplace_back();
        for (const std::string& one : parts_between(alternative, "and")) {
            terms.when.back().push_back(static_cast<int>(formulas.size()));
            formulas.push_back(formula_of(one, text, path));
        }
    }
    Inputs inputs;
    inputs.may_read_reactions = true;
    for (const std::string& formula : formulas)
        for (const std::string& name : names_with_points(formula)) {
            const bool is_known = std::ranges::find(inputs.symbols, name) != inputs.symbols.end() ||
                                  inputs.formula(name) != nullptr;
            if (!is_known) add_input(builder, inputs, name, name, path);
        }
    std::vector<Expression> expressions;
    ExpressionWords words = words_of_formulas(section.parameters());
    words.formula = [&](std::string_view name) { return inputs.formula(name); };
    for (const std::string& formula : formulas) {
        expressions.emplace_back(formula, inputs.symbols, words);
        if (!expressions.back().guards().empty())
            refuse_condition(path, text, "a condition has formulas that are smooth",
                             "several comparisons with 'and' or 'or' between say what min, max and abs say");
    }
    terms.coordinates = inputs.coordinates;
    terms.reactions = inputs.reactions;
    terms.n_terms = static_cast<int>(expressions.size());
    terms.values = [expressions, inputs](const LawArguments& at, std::span<const double> reactions,
                                         std::span<double> out) {
        const std::vector<double> numbers = numbers_of(inputs, at, reactions);
        for (std::size_t k = 0; k < expressions.size(); ++k) out[k] = expressions[k](at.at.t, numbers);
    };
    return terms;
}

/// The load that tells what states become.
std::string name_of_change(const std::string& event) { return "set by " + event; }

std::string name_of(const Section& event)
{
    return event.has("name") ? event.text("name") : event.text("when");
}

/// That a controller has the state, which is looked at.
std::string state_of(const Builder& builder, const std::string& name, const std::string& path, Inputs& inputs)
{
    for (const ReadController& controller : builder.controllers())
        for (const ReadController::State& state : controller.states) {
            if (controller.name + "." + state.name != name) continue;
            inputs.coordinates.push_back({state.coordinate, 0, false});
            return name;
        }
    throw InputError({"controller-state", path, "there is no such state of a controller", "'" + name + "'",
                      "", "", "as in { \"pid.i\" = \"0\" }"});
}

/// What an event sets. Throws InputError.
/// By the load that read_changes() has made, whose readings have the names of the states they are for.
StateChange change_of(const Builder& builder, const std::string& event)
{
    StateChange change;
    const std::vector<Load>& loads = builder.model().loads();
    const auto load = std::ranges::find(loads, name_of_change(event), &Load::name);
    if (load == loads.end()) return change;   // what is wrong was told
    change.load = static_cast<int>(load - loads.begin());
    for (const LoadReading& reading : load->readings)
        for (const ReadController& controller : builder.controllers())
            for (const ReadController::State& state : controller.states)
                if (controller.name + "." + state.name == reading.name)
                    change.states.push_back(state.coordinate);
    return change;
}

void add_event(Builder& builder, const Section& section, const std::string& name, const std::string& text,
               const EventAction& action, const std::string& path)
{
    builder.remember("event[" + name + "]", section);
    builder.guard(path, [&] {
        try {
            Event event{name, text, terms_of(builder, section, text, path), action};
            if (action.does == EventAction::Does::set) event.change = change_of(builder, name);
            builder.model().add_event(std::move(event));
        } catch (const InputError& error) {
            Complaint complaint = error.complaint();
            if (complaint.path.starts_with(path + ".")) complaint.path = path;   // the condition is the place
            throw InputError(complaint);
        }
    });
}

/// `from` and `until` of what acts for a part of the time.
/// Each end that is a condition is an event of its own. Both by the same one would begin it and end it at
/// one instant.
void read_times_of(Builder& builder, const Section& section, const std::string& name, EventAction action)
{
    const std::string path = (action.joint >= 0 ? "joint[" : "load[") + name + "]";
    const auto in_letters = [](std::string text) {
        std::erase_if(text, [](char c) { return c == ' ' || c == '\t'; });
        return text;
    };
    const std::string from = in_letters(condition_of(section, "from"));
    if (!from.empty() && from == in_letters(condition_of(section, "until"))) {
        builder.guard(path, [&] {
            refuse_condition(path + ".until", condition_of(section, "until"),
                             "'" + name + "' begins and ends by one condition",
                             "leave out one of them, or let it end by another one");
        });
        return;
    }
    for (const std::string key : {"from", "until"}) {
        const std::string text = condition_of(section, key);
        if (text.empty()) continue;
        action.does = key == "from" ? EventAction::Does::begin : EventAction::Does::end;
        add_event(builder, section, name + "." + key, text, action, path + "." + key);
    }
}

}   // namespace

Table event_table()
{
    return {
        "[[event]]",
        "A condition of the motion. Where it becomes true a time element ends, and the instant is reported "
        "with its estimated error. See [conditions](howto/events.md#conditions). For the families lobatto "
        "and radau with the state at the initial time.",
        {Key{"name", types::text, "Name of the event. Default: its condition."},
         Key{"when", types::condition,
             "Comparison of two formulas of joint coordinates, rates, sensors, points, reactions of "
             "joints and the time `t`, such as `\"stone.z < 0\"`; several with `and` or `or` between them."}
             .needed(),
         Key{"set", types::named_texts,
             "New values of states of controllers, as in `{ \"pid.i\" = \"0\" }`. Formulas read what was "
             "before."},
         choice("action", {"note", "stop"}, "note: the event is reported; stop: the motion ends there.")}};
}

void read_changes(Builder& builder)
{
    for (const Section& section : builder.top().sections("event")) {
        const Value* given = section.find("set");
        if (!section.is_valid() || given == nullptr) continue;
        const std::string path = "event[" + name_of(section) + "].set";
        builder.remember("event[" + name_of(section) + "]", section);
        builder.guard(path, [&] {
            Inputs inputs;
            inputs.may_read_reactions = true;
            std::vector<ReactionLaw::Reading> next;
            std::vector<std::string> names;
            for (const Entry& entry : given->node->entries()) names.push_back(entry.key);
            for (const std::string& text : given->texts)
                for (const std::string& name : names_with_points(text))
                    if (std::ranges::find(inputs.symbols, name) == inputs.symbols.end() &&
                        inputs.formula(name) == nullptr)
                        add_input(builder, inputs, name, name, path);
            ExpressionWords words = words_of_formulas(section.parameters());
            words.formula = [&](std::string_view name) { return inputs.formula(name); };
            for (std::size_t k = 0; k < names.size(); ++k) {
                const std::string known = state_of(builder, names[k], path, inputs);
                const Expression formula(given->texts[k], inputs.symbols, words);
                next.push_back({known, "", number_by(formula, inputs)});
            }
            builder.model().add_load(telling(builder, name_of_change(name_of(section)), inputs, next));
        });
    }
}

void read_events(Builder& builder, bool is_run)
{
    const Model& model = builder.model();
    // What was wrong with joints and loads has been told of, and conditions may name them.
    if (builder.findings().n_errors() > 0) return;
    for (const StatedConditions& one : builder.conditions()) {
        const auto index = [&](const auto& all) {
            const auto at =
                std::ranges::find_if(all, [&](const auto& part) { return part.name == one.name; });
            return static_cast<int>(at - all.begin());
        };
        EventAction action;
        (one.is_load ? action.load : action.joint) =
            one.is_load ? index(model.loads()) : index(model.joints());
        read_times_of(builder, *one.section, one.name, action);
    }
    for (const Section& section : builder.top().sections("event")) {
        if (!section.is_valid()) continue;
        const std::string text = section.text("when"), name = name_of(section);
        EventAction action;
        if (section.has("set")) action.does = EventAction::Does::set;
        if (section.text("action") == "stop") action.does = EventAction::Does::end_motion;
        add_event(builder, section, name, text, action, "event[" + name + "].when");
    }
    const Section* time = only_section(builder.run(), "time");
    if (!is_run || time == nullptr || !time->is_valid() || condition_of(*time, "until").empty()) return;
    add_event(builder, *time, "time.until", condition_of(*time, "until"), {EventAction::Does::end_motion},
              "time.until");
}

}   // namespace livens::inline io_internal
