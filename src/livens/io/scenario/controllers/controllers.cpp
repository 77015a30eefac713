// SPDX-License-Identifier: BSD-3-Clause
// A controller is read twice: its formulas at the start tell how large its states are, by which they are scaled
// (docs/theory.md, "States").
#include "livens/io/scenario/controllers/controllers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "livens/base/text.h"
#include "livens/io/scenario/joints/expressions.h"
#include "livens/io/scenario/loads/load_makers.h"
#include "livens/io/scenario/text/parameters.h"
#include "livens/multibody/controllers.h"

namespace livens::inline io_internal {

namespace {

/// Of the time of the motion: a state of its size moves its body by the length of the model in this.
constexpr double share_of_time = 0.01;
/// At which its size is asked, beside the start.
constexpr int instants_of_size = 64;

/// Sizes of states by "controller.state".
using Sizes = std::map<std::string, double>;

/// A name of a table of formulas, and its text.
struct NamedText {
    std::string name, text;
};

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

/// One [[controller]] on its way into a model.
class Reading {
public:
    Reading(Builder& builder, const Section& section, const Sizes& sizes)
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

    const std::string& path() const { return path_; }

    /// The bodies that hold its states, and these by their names.
    void hold(const StateScale& scale)
    {
        scale_ = scale;
        ReadController made{name_};
        for (std::size_t first = 0; first < states_.size(); first += states_of_body) {
            const auto some = std::span(states_).subspan(first).first(
                std::min(states_of_body, states_.size() - first));
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

    /// Its formulas, and what they make of its states.
    void make()
    {
        Inputs inputs;
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

    /// How large its states are, as far as the start and time tell, whether it is stated or not.
    void measure(Sizes& sizes) const
    {
        const Section* time = only_section(builder_.run(), "time");
        const double start = time == nullptr ? 0 : time->number("start");
        const double duration = time == nullptr ? 1 : time->number("end") - start;
        const State at = builder_.model().start();
        std::vector<double> numbers, reach;   // at the start, and by how much they may change
        for (const Inputs::Read& read : inputs_.reads) {
            const LawCoordinate& q = inputs_.coordinates[read.coordinate];
            numbers.push_back(read.is_rate ? coordinate_rate(q.coordinate, at.X, at.V) : q.at_stated);
            reach.push_back(q.coordinate.is_angle() ? 0.1 : 0.1 * builder_.length());
        }
        for (std::size_t k = 0; k < states_.size(); ++k) {
            double size = std::abs(states_[k].start), by_reach = 0;
            for (int i = 0; i <= instants_of_size; ++i) {
                std::vector<double> slopes(numbers.size());
                const double value =
                    formulas_[k](start + i * duration / instants_of_size, numbers, slopes);
                const double decay = decay_of(k, slopes),
                             change = is_sampled_            ? 1
                                      : decay * duration > 1 ? 1 / decay
                                                             : duration;
                if (std::isfinite(value)) size = std::max(size, change * std::abs(value));
                for (std::size_t n = 0; n < numbers.size(); ++n)
                    if (std::isfinite(slopes[n]))
                        by_reach = std::max(by_reach, change * std::abs(slopes[n]) * reach[n]);
            }
            if (size == 0) size = by_reach;
            sizes[name_ + "." + states_[k].name] = std::isfinite(size) && size > 0 ? size : 1;
        }
    }

private:
    [[noreturn]] void refuse(const std::string& code, std::string_view key, const std::string& message,
                             const std::string& value, const std::string& help) const
    {
        throw InputError({code, path_ + (key.empty() ? "" : ".") + std::string(key), message, value, "", "", help});
    }

    /// How fast state k falls by itself, 1/s.
    double decay_of(std::size_t k, const std::vector<double>& slopes) const
    {
        const auto own = std::ranges::find(inputs_.symbols, states_[k].name);
        return own == inputs_.symbols.end()
                   ? 0
                   : std::abs(slopes[static_cast<std::size_t>(own - inputs_.symbols.begin())]);
    }

    /// Of a sampled one also what it says, which holds until it is asked again.
    std::vector<NamedText> held() const
    {
        std::vector<NamedText> all = rates_;
        if (is_sampled_) all.insert(all.end(), outputs_.begin(), outputs_.end());
        return all;
    }

    bool is_output(const std::string& name) const
    {
        return std::ranges::find(outputs_, name, &NamedText::name) != outputs_.end();
    }

    ReadController& own() { return builder_.controllers()[index_]; }

    std::string part_name(const std::string& kind, std::size_t first) const
    {
        return kind + name_ + (first == 0 ? "" : " " + std::to_string(first / states_of_body + 1));
    }

    void check_names() const
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

    void check_symbols(const Inputs& inputs) const
    {
        for (std::size_t k = 0; k < inputs.symbols.size(); ++k) {
            const std::string& name = inputs.symbols[k];
            const bool is_twice =
                std::find(inputs.symbols.begin() + static_cast<std::ptrdiff_t>(k) + 1, inputs.symbols.end(),
                          name) != inputs.symbols.end();
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

    Expression read(const NamedText& one, const std::string& key, Inputs& inputs)
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

    bool is_named_later(const std::string& value) const
    {
        return std::ranges::any_of(outputs_, [&](const NamedText& one) {
            return value.find("'" + one.name + "'") != std::string::npos;
        });
    }

    /// An input that nothing reads is a misspelt one in most cases.
    void check_use(const Inputs& inputs, const std::vector<Expression>& of_outputs,
                   const std::vector<Expression>& of_rates) const
    {
        const Value* given = section_.find("inputs");
        if (given == nullptr) return;
        for (const Entry& entry : given->node->entries()) {
            const auto at = std::ranges::find(inputs.symbols, entry.key);
            const auto k = static_cast<std::size_t>(at - inputs.symbols.begin());
            const auto reads = [&](const Expression& one) { return one.depends_on(k); };
            const bool is_read = at != inputs.symbols.end()
                                     ? std::ranges::any_of(of_outputs, reads) || std::ranges::any_of(of_rates, reads)
                                     : std::ranges::find(used_, entry.key) != used_.end();
            if (!is_read)
                refuse("input-unused", "inputs", "'" + entry.key + "': no formula has it", "", "leave it out");
        }
    }

    /// What it tells of itself: states as they are, then outputs.
    std::vector<LawReading> readings(const std::vector<Expression>& of_outputs)
    {
        std::vector<LawReading> all;
        for (const ReadController::State& state : own().states) {
            std::size_t k = 0;   // its coordinate
            while (k < inputs_.coordinates.size() && !is_same(inputs_.coordinates[k].coordinate, state.coordinate))
                ++k;
            if (k == inputs_.coordinates.size()) inputs_.coordinates.push_back({state.coordinate, 0, false});
            all.push_back({state.name, "", [k](const LawArguments& at) { return at.rates[k]; }});
        }
        for (std::size_t k = 0; k < of_outputs.size(); ++k)
            all.push_back({outputs_[k].name, "", [formula = of_outputs[k], inputs = inputs_](const LawArguments& at) {
                               return formula(at.at.t, numbers_of(inputs, at));
                           }});
        return all;
    }

    static bool is_same(const JointCoordinate& a, const JointCoordinate& b)
    {
        return a.forms.size() == 1 && b.forms.size() == 1 && a.forms[0].body_j == b.forms[0].body_j &&
               a.forms[0].body_i == b.forms[0].body_i && a.forms[0].b_j == b.forms[0].b_j;
    }

    void add_observer(const std::string& name, const std::vector<LawReading>& told)
    {
        builder_.model().add_load(observer(name, inputs_.coordinates, told, places(builder_)));
    }

    void make_rates(const std::vector<Expression>& of_rates, const std::vector<Expression>& of_outputs)
    {
        for (const NamedText& one : outputs_)
            own().outputs.push_back({one.name, *inputs_.formula(one.name), inputs_});
        for (ReadController::Output& one : own().outputs) one.inputs.formulas.clear();
        std::vector<double> breaks;
        add_breaks(builder_, of_rates, breaks);
        for (std::size_t first = 0; first < states_.size(); first += states_of_body) {
            const std::size_t n = std::min(states_of_body, states_.size() - first);
            const std::vector<Expression> some(of_rates.begin() + static_cast<std::ptrdiff_t>(first),
                                               of_rates.begin() + static_cast<std::ptrdiff_t>(first + n));
            LoadParts parts = parts_of(some, inputs_, breaks, 1.0);
            const std::vector<Matrix34> X = places(builder_);
            for (std::size_t k = 0; k < n; ++k)
                parts.units.push_back(unit_of_state(states_[first + k].name, bodies_[first / states_of_body],
                                                    static_cast<int>(k), states_[first + k], scale_, X));
            // It does no work on what has mass.
            parts.power = [](const LawArguments&) { return 0.0; };
            parts.domain = "the rates of its states have no value there (0/0, or a root of a negative number)";
            if (!ends_at_bends(builder_)) warn_of_kinks(builder_, section_, "states", some);
            builder_.model().add_load(
                modulated(part_name("rates of ", first), std::string(controller_type), parts, X));
        }
        own().load = static_cast<int>(builder_.model().loads().size());
        const std::vector<LawReading> told = readings(of_outputs);
        add_observer("controller " + name_, told);
    }

    void make_sampling()
    {
        const Section* time = only_section(builder_.run(), "time");
        const double first = section_.has("first") ? section_.number("first")
                             : time == nullptr     ? 0
                                                   : time->number("start");
        Sampling sampling{name_, {static_cast<int>(builder_.model().loads().size()), {}},
                          section_.number("every"), first, time == nullptr ? first : time->number("end")};
        if (!(sampling.every > 0))
            refuse("controller-every", "every", "the period must be positive", to_text(sampling.every), "");
        constexpr double most = 1e6;
        if ((sampling.last - sampling.first) / sampling.every > most)
            refuse("resource-limit", "every", "a controller is asked more than a million times", "",
                   "a longer period, or an earlier end of time");
        std::vector<LawReading> next;
        for (std::size_t k = 0; k < states_.size(); ++k) {
            sampling.change.states.push_back(own().states[k].coordinate);
            next.push_back({states_[k].name, "",
                            [formula = formulas_[k], inputs = inputs_](const LawArguments& at) {
                                return formula(at.at.t, numbers_of(inputs, at));
                            }});
        }
        std::vector<LawReading> told = readings({});
        add_observer("next of " + name_, next);
        own().load = static_cast<int>(builder_.model().loads().size());
        add_observer("controller " + name_, told);
        builder_.model().add_sampling(std::move(sampling));
    }

    Builder& builder_;
    const Section& section_;
    std::string name_, path_;
    bool is_sampled_;
    std::vector<NamedText> rates_, outputs_;
    std::vector<ControllerState> states_{};
    StateScale scale_{};
    std::vector<int> bodies_{};
    std::size_t index_ = 0;   // among the controllers of the builder
    std::vector<std::string> used_{};
    std::vector<Expression> formulas_{};   // of states, in their order
    Inputs inputs_{};
};

StateScale scale_of(const Builder& builder)
{
    const Section* time = only_section(builder.run(), "time");
    const double duration = time == nullptr ? 1 : time->number("end") - time->number("start");
    double mass = 0;
    int n = 0;
    for (const Body& body : builder.model().bodies())
        if (body.is_matter()) mass += body.mass(0, 0), ++n;
    // States of their size have momenta like those of bodies.
    const double share = share_of_time * share_of_time;
    return {n > 0 ? share * mass / n : 1,
            builder.length() / (share_of_time * (duration > 0 && std::isfinite(duration) ? duration : 1))};
}

/// False after an error.
bool read_all(Builder& builder, const Sizes& sizes, Sizes* found)
{
    const StateScale scale = scale_of(builder);
    const int before = builder.findings().n_errors();
    std::vector<Reading> all;
    for (const Section& section : builder.top().sections("controller")) {
        if (!section.is_valid()) continue;
        const std::string path = "controller[" + section.text("name") + "]";
        builder.guard(path, [&] {
            all.emplace_back(builder, section, sizes);
            all.back().hold(scale);
        });
    }
    if (builder.findings().n_errors() > before) return false;
    for (Reading& one : all) builder.guard(one.path(), [&] { one.make(); });
    if (builder.findings().n_errors() > before) return false;
    if (found != nullptr)
        for (const Reading& one : all) one.measure(*found);
    return true;
}

}   // namespace

Table controller_table()
{
    return {"[[controller]]",
            "States with rates of their own, `z' = f`, or values that are computed anew at fixed intervals: "
            "controllers, filters, motors, hydraulics. See [controllers](howto/controllers.md).",
            {Key{"name", types::text, "Name by which formulas and results refer to its states and outputs."}
                 .needed(),
             Key{"inputs", types::named_texts,
                 "Symbols for quantities of the motion or of other controllers, as for "
                 "[loads](joints.md#expressions)."},
             Key{"states", types::named_texts,
                 "Formula per state: its rate per second; with `every` its next value."},
             Key{"outputs", types::named_texts,
                 "Formulas of inputs, states and earlier outputs, that other formulas read as "
                 "`controller.output`. With `every` they hold their value between the samples."},
             Key{"start", types::factors, "Initial values of states. Default: 0."},
             Key{"size", types::factors,
                 "Typical magnitude per state, to which its errors are relative. Default: estimated from the "
                 "initial rates."},
             Key{"every", types::number,
                 "Sampling period: inputs are read and states and outputs set at these intervals.", "s"},
             Key{"first", types::number, "Time of the first sample. Default: the start of the motion.", "s"}}};
}

void read_controllers(Builder& builder)
{
    std::unordered_set<std::string> taken;
    for (const Joint& joint : builder.model().joints()) taken.insert(joint.name);
    for (const Sensor& sensor : builder.model().sensors()) taken.insert(sensor.name);
    for (const ReadController& one : builder.controllers()) taken.insert(one.name);
    const int before = builder.findings().n_errors();
    for (const Section& section : builder.top().sections("controller")) {
        check_name(section);
        builder.remember("controller[" + section.text("name") + "]", section);
        if (const std::string name = section.text("name"); !name.empty())
            claim_name(section, "controller, sensor or joint", name, taken,
                       {"formulas refer to controllers as to joints and sensors", "give it another 'name'"});
        if (section.has("first") && !section.has("every"))
            section.error("first", "controller-every", section.label() + " is not sampled",
                          {"", "state 'every', or leave out 'first'"});
    }
    if (builder.findings().n_errors() > before || builder.top().sections("controller").empty()) return;
    const Model as_it_was = builder.model();
    const std::vector<ReadController> of_parts = builder.controllers();
    Sizes sizes;
    if (!read_all(builder, {}, &sizes)) return;
    builder.model() = as_it_was;
    builder.controllers() = of_parts;
    read_all(builder, sizes, nullptr);
}

void add_controller_sensors(Builder& builder)
{
    for (const ReadController& one : builder.controllers()) {
        const std::vector<Sensor>& all = builder.model().sensors();
        if (std::ranges::find(all, one.name, &Sensor::name) != all.end()) continue;   // of a part
        Sensor sensor =
            load_sensor(one.name, one.load, builder.model().loads()[static_cast<std::size_t>(one.load)]);
        sensor.type = controller_type;
        builder.model().add_sensor(std::move(sensor));
    }
}

void take_controllers(const Builder& part, const Relocation& to, Builder& builder)
{
    for (ReadController one : part.controllers()) {
        one.name = to.name(one.name);
        one.load += to.first_load;
        for (ReadController::State& state : one.states) state.coordinate = relocated(state.coordinate, to);
        for (ReadController::Output& output : one.outputs)
            for (LawCoordinate& q : output.inputs.coordinates) q.coordinate = relocated(q.coordinate, to);
        builder.controllers().push_back(std::move(one));
    }
}

}   // namespace livens::inline io_internal
