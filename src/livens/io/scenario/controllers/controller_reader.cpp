// SPDX-License-Identifier: BSD-3-Clause
// One [[controller]] in steps: names; bodies whose velocities are its states; formulas, when the states of
// all controllers are there to be read; and what these do to the bodies (docs/theory.md, "States"). With
// `every` outputs are states as well, which hold their values between the samples.
#include "livens/io/scenario/controllers/controller_reader.h"

#include <algorithm>
#include <span>
#include <utility>

#include "livens/base/text.h"
#include "livens/io/scenario/joints/expressions.h"
#include "livens/io/scenario/text/parameters.h"

namespace livens::inline io_internal {

namespace {

std::vector<NamedText> texts_of(const Section& section, std::string_view key)
{
    std::vector<NamedText> all;
    if (const Value* given = section.find(key))
        for (std::size_t i = 0; i < given->texts.size(); ++i)
            all.push_back({given->node->entries()[i].key, given->texts[i]});
    return all;
}

/// Numbers under names of states.
std::map<std::string, double> numbers_under(const Section& section, std::string_view key)
{
    std::map<std::string, double> all;
    if (const Value* given = section.find(key))
        for (std::size_t i = 0; i < given->numbers.size(); ++i)
            all[given->node->entries()[i].key] = given->numbers[i];
    return all;
}

}   // namespace

ControllerReader::ControllerReader(Builder& builder, const Section& section, const SizesOfStates& sizes)
    : builder_(builder), section_(section), name_(section.text("name")), path_("controller[" + name_ + "]"),
      is_sampled_(section.has("every")), rates_(texts_of(section, "states")),
      outputs_(texts_of(section, "outputs"))
{
    check_names();
    const std::map<std::string, double> start = numbers_under(section, "start"),
                                        size = numbers_under(section, "size");
    for (const NamedText& one : held()) {
        ControllerState state{one.name};
        if (const auto given = start.find(one.name); given != start.end()) state.start = given->second;
        const auto stated = size.find(one.name), found = sizes.find(name_ + "." + one.name);
        state.size = stated != size.end() ? stated->second : found != sizes.end() ? found->second : 1;
        states_.push_back(std::move(state));
    }
}

/// Three states are the velocity of one point mass, whose place nothing reads; the last body may hold fewer.
void ControllerReader::hold(const StateScale& scale)
{
    scale_ = scale;
    ReadController made{name_};
    for (std::size_t first = 0; first < states_.size(); first += states_of_body) {
        const auto some =
            std::span(states_).subspan(first).first(std::min(states_of_body, states_.size() - first));
        const std::string name = part_name("states of ", first);
        const int body = builder_.model().add_body(body_of_states(name, name_, some, scale));
        bodies_.push_back(body);
        for (std::size_t k = 0; k < some.size(); ++k)
            made.states.push_back(
                {some[k].name, coordinate_of_state(body, static_cast<int>(k), some[k], scale)});
    }
    builder_.controllers().push_back(std::move(made));
    index_ = builder_.controllers().size() - 1;
}

/// Outputs in the order of the file: each becomes a word for those behind it and for the states, so that
/// there are no loops among them.
void ControllerReader::make()
{
    Inputs inputs;
    inputs.may_read_reactions = true;
    read_named_inputs(builder_, section_, inputs, path_);
    for (const ReadController::State& state : own().states) {
        if (is_output(state.name)) continue;   // what is held is none of its own formulas
        inputs.symbols.push_back(state.name);
        inputs.reads.push_back({inputs.coordinates.size(), true});
        inputs.coordinates.push_back({state.coordinate, 0, false});
    }
    check_symbols(inputs);
    std::vector<Expression> of_outputs, of_rates;
    for (const NamedText& one : outputs_) {
        of_outputs.push_back(read(one, "outputs", inputs));
        inputs.formulas.emplace_back(one.name, of_outputs.back());
    }
    for (const NamedText& one : rates_) of_rates.push_back(read(one, "states", inputs));
    check_use(inputs, of_outputs, of_rates);
    formulas_ = of_rates;
    formulas_.insert(formulas_.end(), of_outputs.begin(), of_outputs.end());
    inputs_ = inputs;
    if (is_sampled_)
        make_sampling();
    else
        make_rates(of_rates, of_outputs);
}

void ControllerReader::refuse(const std::string& code, std::string_view key, const std::string& message,
                              const std::string& value, const std::string& help) const
{
    throw InputError(
        {code, path_ + (key.empty() ? "" : ".") + std::string(key), message, value, "", "", help});
}

std::vector<NamedText> ControllerReader::held() const
{
    std::vector<NamedText> all = rates_;
    if (is_sampled_) all.insert(all.end(), outputs_.begin(), outputs_.end());
    return all;
}

bool ControllerReader::is_output(const std::string& name) const
{
    return std::ranges::find(outputs_, name, &NamedText::name) != outputs_.end();
}

std::string ControllerReader::part_name(const std::string& kind, std::size_t first) const
{
    return kind + name_ + (first == 0 ? "" : " " + std::to_string(first / states_of_body + 1));
}

void ControllerReader::check_names() const
{
    std::vector<std::string> names;
    for (const auto* all : {&rates_, &outputs_})
        for (const NamedText& one : *all) {
            if (std::ranges::find(names, one.name) != names.end())
                refuse("controller-name", all == &rates_ ? "states" : "outputs",
                       "a state and an output have one name", "'" + one.name + "'",
                       "call one of them differently");
            names.push_back(one.name);
        }
    const auto check = [&](const char* key, bool is_size) {
        for (const auto& [name, number] : numbers_under(section_, key)) {
            const bool is_state = std::ranges::find(rates_, name, &NamedText::name) != rates_.end() ||
                                  (is_sampled_ && is_output(name));
            if (!is_state)
                refuse("controller-name", key, "there is no state of this name", "'" + name + "'",
                       names.empty() ? "" : "it has " + names[0]);
            if (is_size && !(number > 0))
                refuse("controller-size", key, "a size must be positive", to_text(number), "");
        }
    };
    check("start", false);
    check("size", true);
    if (rates_.empty() && !is_sampled_)
        refuse("controller-states", "", "a controller without states says no more than a formula", "",
               "state 'states', or put the formula where it is used");
    if (rates_.empty() && outputs_.empty())
        refuse("controller-states", "", "a controller needs 'states' or 'outputs'", "", "");
}

void ControllerReader::check_symbols(const Inputs& inputs) const
{
    for (std::size_t k = 0; k < inputs.symbols.size(); ++k) {
        const std::string& name = inputs.symbols[k];
        const bool is_twice = std::find(inputs.symbols.begin() + static_cast<std::ptrdiff_t>(k) + 1,
                                        inputs.symbols.end(), name) != inputs.symbols.end();
        if (is_twice || is_output(name) || section_.parameters().find(name) != nullptr)
            refuse("controller-name", "inputs", "two things have one name", "'" + name + "'",
                   "inputs, states, outputs and parameters have names of their own");
    }
    for (const NamedText& one : outputs_)
        if (section_.parameters().find(one.name) != nullptr || !is_plain_name(one.name) ||
            is_word_of_expressions(one.name))
            refuse("controller-name", "outputs", "an output cannot have this name", "'" + one.name + "'",
                   "letters, digits and _, no digit first, and no name of a parameter or function");
}

Expression ControllerReader::read(const NamedText& one, const std::string& key, Inputs& inputs)
{
    const std::string path = path_ + "." + key;
    for (const std::string& name : names_with_points(one.text)) {
        const bool is_known = std::ranges::find(inputs.symbols, name) != inputs.symbols.end() ||
                              inputs.formula(name) != nullptr;
        if (!is_known) add_input(builder_, inputs, name, name, path);
    }
    ExpressionWords words = words_of_formulas(section_.parameters());
    words.formula = [&](std::string_view name) {
        used_.emplace_back(name);
        return inputs.formula(name);
    };
    try {
        return Expression(one.text, inputs.symbols, words);
    } catch (const InputError& error) {
        Complaint complaint = error.complaint();
        complaint.path = path;
        complaint.message = "'" + one.name + "': " + complaint.message;
        // What stands further below is not known yet.
        if (complaint.code == "expression-name" && is_named_later(complaint.value))
            complaint.help = "outputs may read those before them, not themselves or what follows: that "
                             "would be an algebraic loop";
        throw InputError(complaint);
    }
}

bool ControllerReader::is_named_later(const std::string& value) const
{
    return std::ranges::any_of(outputs_, [&](const NamedText& one) {
        return value.find("'" + one.name + "'") != std::string::npos;
    });
}

void ControllerReader::check_use(const Inputs& inputs, const std::vector<Expression>& of_outputs,
                                 const std::vector<Expression>& of_rates) const
{
    const Value* given = section_.find("inputs");
    if (given == nullptr) return;
    for (const Entry& entry : given->node->entries()) {
        const auto at = std::ranges::find(inputs.symbols, entry.key);
        const auto k = static_cast<std::size_t>(at - inputs.symbols.begin());
        const auto reads = [&](const Expression& one) { return one.depends_on(k); };
        const bool is_read = at != inputs.symbols.end() ? std::ranges::any_of(of_outputs, reads) ||
                                                              std::ranges::any_of(of_rates, reads)
                                                        : std::ranges::find(used_, entry.key) != used_.end();
        if (!is_read)
            refuse("input-unused", "inputs", "'" + entry.key + "': no formula has it", "", "leave it out");
    }
}

}   // namespace livens::inline io_internal
