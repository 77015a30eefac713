// SPDX-License-Identifier: BSD-3-Clause
// Expressions in scenarios: what their symbols stand for.
// A symbol is a coordinate of a joint or a number of a sensor, both functions of the configuration, or the
// rate of one (docs/joints.md, Expressions). What depends on accelerations or multipliers is refused: a load
// that follows a load would be an algebraic loop.
#include "livens/io/scenario/joints/expressions.h"

#include <algorithm>

#include "livens/io/scenario/joints/joints.h"

namespace livens::inline io_internal {

namespace {

/// "pivot.angle_rate": a name, which may have points and blanks, and what is read of it.
struct Reference {
    std::string name, what;
};

Reference split(const std::string& text)
{
    // The last point divides: names may have points, quantities have none.
    const std::size_t point = text.rfind('.');
    return point == std::string::npos ? Reference{text, ""}
                                      : Reference{text.substr(0, point), text.substr(point + 1)};
}

constexpr std::string_view rate_suffix = "_rate";

[[noreturn]] void refuse_input(const std::string& code, const std::string& path, const std::string& symbol,
                               const std::string& text, const std::string& message, const std::string& help)
{
    // Names that stand in the expression itself are their own symbols.
    const bool is_own = symbol == text;
    throw InputError({code, path + (is_own ? ".expression" : ".inputs"),
                      (is_own ? "'" : "input '") + symbol + "': " + message, is_own ? "" : "'" + text + "'",
                      "", "", help});
}

[[noreturn]] void refuse_acceleration(const std::string& path, const std::string& symbol,
                                      const std::string& text)
{
    refuse_input("input-algebraic", path, symbol, text,
                 "a load cannot follow an acceleration, which follows from the loads",
                 "give an expression of coordinates and their rates");
}

/// A number of a sensor.
void add_reading(Inputs& inputs, const Sensor& sensor, const std::string& symbol, const std::string& text,
                 const std::string& path)
{
    const Reference reference = split(text);
    std::string has;
    for (const SensorComponent& component : sensor.components) {
        has += (has.empty() ? "it has " : ", ") + component.name;
        const NamedCoordinate& q = component.coordinate;
        if (component.name != reference.what || q.coordinate.forms.empty()) continue;
        if (component.is_acceleration()) refuse_acceleration(path, symbol, text);
        inputs.symbols.push_back(symbol);
        inputs.reads.push_back({inputs.coordinates.size(), component.is_rate()});
        inputs.coordinates.push_back({q.coordinate, q.at_stated, !component.is_rate()});
        return;
    }
    const bool is_readable = !sensor.components[0].coordinate.coordinate.forms.empty();
    refuse_input(is_readable ? "input-unknown" : "input-algebraic", path, symbol, text,
                 is_readable
                     ? "sensor '" + sensor.name + "' has no such number"
                     : "a load cannot follow " + std::string(sensor.load >= 0 ? "a load" : "an energy"),
                 is_readable ? has + ", as in \"" + sensor.name + "." + sensor.components[0].name + "\""
                             : "give an expression of coordinates and their rates");
}

}   // namespace

namespace {

/// A formula of other symbols becomes one of these, which are told apart by `owner`.
/// Symbols that it does not read have no place (-1). One with a parenthesis was taken in before from another
/// controller, whose name it has.
Expression taken_in(const Expression& formula, const Inputs& of, const std::string& owner, Inputs& inputs)
{
    std::vector<int> places;
    for (std::size_t k = 0; k < of.symbols.size(); ++k) {
        places.push_back(-1);
        if (!formula.depends_on(k)) continue;
        // No text can have a name like this.
        const std::string name =
            of.symbols[k].find('(') == std::string::npos ? owner + ".(" + of.symbols[k] + ")" : of.symbols[k];
        const auto known = std::ranges::find(inputs.symbols, name);
        places.back() = static_cast<int>(known - inputs.symbols.begin());
        if (known != inputs.symbols.end()) continue;
        inputs.symbols.push_back(name);
        if (const int reaction = of.reads[k].reaction; reaction >= 0) {
            inputs.reads.push_back({0, false, static_cast<int>(inputs.reactions.size())});
            inputs.reactions.push_back(of.reactions[static_cast<std::size_t>(reaction)]);
            continue;
        }
        inputs.reads.push_back({inputs.coordinates.size(), of.reads[k].is_rate});
        inputs.coordinates.push_back(of.coordinates[of.reads[k].coordinate]);
    }
    return formula.renumbered(places);
}

/// A state or output.
void add_number(Inputs& inputs, const ReadController& controller, const std::string& symbol,
                const std::string& text, const std::string& path)
{
    const std::string what = split(text).what;
    std::string has;
    for (const ReadController::State& state : controller.states) {
        has += (has.empty() ? "it has " : ", ") + state.name;
        if (state.name != what) continue;
        inputs.symbols.push_back(symbol);
        inputs.reads.push_back({inputs.coordinates.size(), true});
        inputs.coordinates.push_back({state.coordinate, 0, false});
        return;
    }
    for (const ReadController::Output& output : controller.outputs) {
        has += (has.empty() ? "it has " : ", ") + output.name;
        if (output.name != what) continue;
        inputs.formulas.emplace_back(symbol,
                                     taken_in(output.formula, output.inputs, controller.name, inputs));
        return;
    }
    refuse_input("input-unknown", path, symbol, text,
                 "controller '" + controller.name + "' has no such state or output", has);
}

}   // namespace

/// `force` and `torque` alone are the lengths of these vectors, for which `along` stays zero; _x, _y, _z are
/// components in the world.
std::optional<ReactionInput> reaction_of(const Model& model, const std::string& name)
{
    const std::size_t point = name.rfind('.');
    if (point == std::string::npos) return {};
    const std::string what = name.substr(point + 1);
    ReactionInput input{model.find_joint(name.substr(0, point)), what.starts_with("torque")};
    const std::string rest = what.substr(input.is_torque ? 6 : std::min<std::size_t>(5, what.size()));
    const bool is_reaction = input.is_torque || what.starts_with("force");
    if (input.joint < 0 || !is_reaction) return {};
    for (int i = 0; i < 3; ++i)
        if (rest == std::string("_") + "xyz"[i]) input.along[i] = 1;
    if (!rest.empty() && input.along == Vector3{}) return {};
    return input;
}

namespace {

void add_reaction(Inputs& inputs, const ReactionInput& reaction, const std::string& symbol,
                  const std::string& text, const std::string& path)
{
    if (!inputs.may_read_reactions)
        refuse_input(
            "input-algebraic", path, symbol, text,
            "reactions are read by loads along joints and on bodies, by controllers and by conditions",
            "let a load read it, a controller or a condition");
    inputs.symbols.push_back(symbol);
    inputs.reads.push_back({0, false, static_cast<int>(inputs.reactions.size())});
    inputs.reactions.push_back(reaction);
}

}   // namespace

void add_input(const Builder& builder, Inputs& inputs, const std::string& symbol, const std::string& text,
               const std::string& path)
{
    if (const std::optional<ReactionInput> reaction = reaction_of(builder.model(), text))
        return add_reaction(inputs, *reaction, symbol, text, path);
    const Reference reference = split(text);
    for (const ReadController& controller : builder.controllers())
        if (controller.name == reference.name) return add_number(inputs, controller, symbol, text, path);
    const bool is_rate = reference.what.ends_with(rate_suffix);
    const std::string what =
        is_rate ? reference.what.substr(0, reference.what.size() - rate_suffix.size()) : reference.what;
    std::vector<std::string_view> known;
    for (const ReadController& controller : builder.controllers()) known.push_back(controller.name);
    for (const Joint& joint : builder.model().joints()) {
        known.push_back(joint.name);
        if (joint.name != reference.name) continue;
        const NamedCoordinate* coordinate = find_coordinate(joint, what);
        if (coordinate == nullptr) {
            std::string has;
            for (const NamedCoordinate& one : joint.coordinates)
                has += (has.empty() ? "it has " : ", ") + one.name + ", " + one.name + "_rate";
            refuse_input("joint-coordinate", path, symbol, text,
                         "joint '" + joint.name + "' (" + joint.type + ") has no " +
                             (what.empty() ? "such number" : what),
                         has.empty() ? "such a joint has no coordinates" : has);
        }
        inputs.symbols.push_back(symbol);
        inputs.reads.push_back({inputs.coordinates.size(), is_rate});
        // An angle is counted from where the joint is stated, and only its value has turns to be counted.
        inputs.coordinates.push_back({coordinate->coordinate, coordinate->at_stated, !is_rate});
        return;
    }
    for (const Sensor& sensor : builder.model().sensors()) {
        known.push_back(sensor.name);
        if (sensor.name == reference.name || sensor.name == text)
            return add_reading(inputs, sensor, symbol, text, path);
    }
    for (const NamedPoint& point : builder.model().points()) {
        if (point.body == world) continue;
        known.push_back(point.name);
        if (point.name == reference.name || point.name == text)
            return add_reading(
                inputs, point_sensor(point.name, point.body, point.position, builder.model().start().X),
                symbol, text, path);
    }
    for (const Section& sensor : builder.top().sections("sensor"))
        if (sensor.has("name") && sensor.text("name") == reference.name && sensor.takes("load"))
            refuse_input("input-algebraic", path, symbol, text, "a load cannot follow a load",
                         "give an expression of coordinates and their rates");
    if (builder.is_excused(reference.name))
        throw InputError({"", path, "", "", "", "", ""});   // told already
    refuse_input("input-unknown", path, symbol, text, "there is nothing of this name",
                 suggest(reference.name, known).empty()
                     ? "give a joint and its coordinate, as in \"pivot.angle\" or \"pivot.angle_rate\""
                     : suggest(reference.name, known));
}

namespace {

std::vector<std::string> texts_of(const Value& given)
{
    return given.texts.empty() ? std::vector{given.text} : given.texts;
}

/// "np.sin": the reader of expressions says what it is called here.
bool is_of_a_library(const std::string& name)
{
    return name.starts_with("np.") || name.starts_with("numpy.") || name.starts_with("math.");
}

}   // namespace

std::vector<Key> expression_keys(bool is_vector)
{
    static constexpr KeyType three{"three strings", Form::names, 3};
    return {Key{"expression", is_vector ? three : types::text,
                is_vector ? "One formula per component, instead of `value` ([syntax](joints.md#expressions))."
                          : "A formula, instead of `value` ([syntax](joints.md#expressions))."},
            Key{"inputs", types::named_texts,
                "Symbols for quantities used in `expression`: joint coordinates, their rates, and sensor "
                "readings, in rad, m and s, as in `{ phi = \"pivot.angle\", w = \"pivot.angle_rate\", x = "
                "\"tip.x\" }`; states and outputs of controllers, as in `\"pid.u\"`; and of loads reactions "
                "of joints, as in `\"pivot.force\"`. An expression may also contain these names directly, "
                "`-10*pivot.angle`; names "
                "with blanks need quotes, `-10*'crank pin'.angle`."},
            Key{"breaks", types::list, "Times at which `expression` jumps or has a kink; elements end there.",
                "s"}};
}

void read_named_inputs(const Builder& builder, const Section& section, Inputs& inputs,
                       const std::string& path)
{
    const Value* given = section.find("inputs");
    if (given == nullptr) return;
    const std::vector<Entry>& entries = given->node->entries();
    for (std::size_t i = 0; i < entries.size(); ++i)
        add_input(builder, inputs, entries[i].key, given->texts[i], path);
}

Inputs read_inputs(const Builder& builder, const Section& section, const std::string& path)
{
    Inputs inputs;
    inputs.may_read_reactions = true;
    read_named_inputs(builder, section, inputs, path);
    if (const Value* given = section.find("expression"))
        for (const std::string& text : texts_of(*given))
            for (const std::string& name : names_with_points(text)) {
                const bool is_known = std::ranges::find(inputs.symbols, name) != inputs.symbols.end() ||
                                      inputs.formula(name) != nullptr || is_of_a_library(name);
                if (!is_known) add_input(builder, inputs, name, name, path);
            }
    return inputs;
}

/// Of a word that nothing has: a parameter that is spelled almost so.
static void propose_parameter(Complaint& complaint, const Parameters& parameters)
{
    const std::size_t open = complaint.value.find('\''), close = complaint.value.find('\'', open + 1);
    if (close == std::string::npos) return;
    const std::vector<std::string_view> names = parameters.names();
    const std::string near(closest(complaint.value.substr(open + 1, close - open - 1), names));
    if (!near.empty()) complaint.help = "did you mean '" + near + "'? " + complaint.help;
}

std::vector<Expression> read_expressions(const Section& section, const Inputs& inputs,
                                         const std::string& path)
{
    std::vector<Expression> all;
    const Parameters& parameters = section.parameters();
    for (const std::string& symbol : inputs.symbols)
        if (parameters.find(symbol) != nullptr)
            refuse_input("parameter-name", path, symbol, "", "a parameter has this name, too",
                         "call one of them otherwise");
    ExpressionWords words{[&](std::string_view name, int) -> std::optional<double> {
        const Parameters::One* one = parameters.find(name);
        return one == nullptr ? std::nullopt : std::optional(one->amount.value);
    }};
    std::vector<std::string_view> used;   // formulas
    words.formula = [&](std::string_view name) {
        used.push_back(name);
        return inputs.formula(name);
    };
    for (const std::string& text : texts_of(*section.find("expression"))) {
        try {
            all.emplace_back(text, inputs.symbols, words);
        } catch (const InputError& error) {
            Complaint complaint = error.complaint();
            complaint.path = path + ".expression";
            if (complaint.code == "expression-name") propose_parameter(complaint, parameters);
            throw InputError(complaint);
        }
    }
    for (const auto& [name, formula] : inputs.formulas)
        if (std::ranges::find(used, name) == used.end())
            refuse_input("input-unused", path, name, "", "no expression has it", "leave it out");
    for (std::size_t k = 0; k < inputs.symbols.size(); ++k)
        // A symbol that no formula has is a misspelt one in most cases.
        if (std::ranges::none_of(all, [&](const Expression& one) { return one.depends_on(k); }))
            refuse_input("input-unused", path, inputs.symbols[k], "", "no expression has it", "leave it out");
    return all;
}

std::vector<double> breaks_of(const Builder& builder, const Section& section,
                              const std::vector<Expression>& expressions)
{
    std::vector<double> breaks;
    if (const Value* given = section.find("breaks")) breaks = given->numbers;
    add_breaks(builder, expressions, breaks);
    return breaks;
}

void add_breaks(const Builder& builder, const std::vector<Expression>& expressions,
                std::vector<double>& breaks)
{
    const Section* time = only_section(builder.run(), "time");
    for (const Expression& one : expressions) {
        if (time == nullptr || !time->is_valid()) break;
        // Bends that follow from time alone are known beforehand: elements end there.
        const std::vector<double> events = one.events(time->number("start"), time->number("end"));
        breaks.insert(breaks.end(), events.begin(), events.end());
    }
    std::ranges::sort(breaks);
    const auto repeated = std::unique(breaks.begin(), breaks.end());
    breaks.erase(repeated, breaks.end());
}

}   // namespace livens::inline io_internal
