// SPDX-License-Identifier: BSD-3-Clause
// What expressions are as laws of loads: values, slopes, bounds of these, and where they bend.
#include <algorithm>

#include "livens/dynamics/instant/reaction_laws.h"
#include "livens/io/scenario/joints/expressions.h"
#include "livens/multibody/controllers.h"

namespace livens::inline io_internal {

std::vector<double> numbers_of(const Inputs& inputs, const LawArguments& at,
                               std::span<const double> reactions)
{
    std::vector<double> numbers;
    for (const Inputs::Read& read : inputs.reads)
        numbers.push_back(read.reaction >= 0 ? reactions[static_cast<std::size_t>(read.reaction)]
                                             : (read.is_rate ? at.rates : at.values)[read.coordinate]);
    return numbers;
}

ReactionNumber number_by(const Expression& formula, const Inputs& inputs)
{
    return [formula, inputs](const LawArguments& at, std::span<const double> reactions) {
        return formula(at.at.t, numbers_of(inputs, at, reactions));
    };
}

ReactionLaw reaction_law_of(const std::vector<Expression>& expressions, const Inputs& inputs,
                            const std::vector<double>& breaks, const TimeFunction& acts)
{
    ReactionLaw law;
    law.coordinates = inputs.coordinates;
    law.reactions = inputs.reactions;
    law.make = loads_by_reactions;
    law.law = [expressions, inputs, breaks, acts](const LawArguments& at, std::span<const double> reactions,
                                                  std::span<double> factors) {
        const std::vector<double> numbers = numbers_of(inputs, at, reactions);
        const double size = acts(at.at).value;
        for (std::size_t k = 0; k < expressions.size(); ++k)
            // Not even asked while it does not act: there it may have no value.
            factors[k] = size == 0 ? 0 : expressions[k](beside_breaks(at.at, breaks), numbers);
    };
    for (const Expression& one : expressions)
        law.guards.insert(law.guards.end(), one.guards().begin(), one.guards().end());
    if (!law.guards.empty())
        law.guarded = [expressions, inputs](const LawArguments& at, std::span<const double> reactions,
                                            std::span<double> found) {
            const std::vector<double> numbers = numbers_of(inputs, at, reactions);
            for (const Expression& one : expressions) {
                one.guarded(at.at.t, numbers, found);
                found = found.subspan(one.guards().size());
            }
        };
    law.breaks = breaks;
    law.breaks.insert(law.breaks.end(), acts.breaks().begin(), acts.breaks().end());
    std::ranges::sort(law.breaks);
    return law;
}

/// What reads reactions waits, without units, until the model is whole: see bind_loads().
Load telling(const Builder& builder, const std::string& name, const Inputs& inputs,
             const std::vector<ReactionLaw::Reading>& told)
{
    if (!inputs.reactions.empty()) {
        ReactionLaw law = reaction_law_of({}, inputs, {}, 1.0);
        law.name = name;
        law.type = controller_type;
        law.readings = told;
        return waiting(std::move(law), 0);
    }
    std::vector<LawReading> readings;
    for (const ReactionLaw::Reading& one : told)
        readings.push_back(
            {one.name, one.unit, [value = one.value](const LawArguments& at) { return value(at, {}); }});
    return observer(name, inputs.coordinates, readings, builder.start_configurations());
}

LoadParts parts_of(const std::vector<Expression>& expressions, const Inputs& inputs,
                   const std::vector<double>& breaks, const TimeFunction& acts)
{
    LoadParts parts;
    parts.coordinates = inputs.coordinates;
    const LoadLaw law = law_of(expressions, inputs, breaks);
    parts.law = [law, acts](const LawArguments& at, std::span<double> factors, std::span<double> slopes) {
        law(at, factors, slopes);
        // Outside of its interval the load is off, and its slopes have to vanish with it.
        if (acts(at.at).value == 1) return;
        std::ranges::fill(factors, 0.0);
        std::ranges::fill(slopes, 0.0);
    };
    parts.recorded_law = recorded_law_of(expressions, inputs, breaks, acts);
    for (const Inputs::Read& read : inputs.reads) parts.depends_on_rates |= read.is_rate;
    parts.guards = guards_of(expressions, inputs);
    parts.is_smooth = std::ranges::all_of(expressions, [](const Expression& e) { return e.is_affine(); });
    parts.steepest = steepness_of(expressions, inputs);
    parts.breaks = acts.breaks();
    parts.breaks.insert(parts.breaks.end(), breaks.begin(), breaks.end());
    parts.domain =
        "its expression has no value there (0/0, as w/abs(w) at rest), or reads an angle more than 175 "
        "degrees from its start";
    return parts;
}

LoadLaw law_of(const std::vector<Expression>& expressions, const Inputs& inputs,
               const std::vector<double>& breaks)
{
    return [expressions, inputs, breaks](const LawArguments& at, std::span<double> factors,
                                         std::span<double> slopes) {
        const std::size_t m = inputs.coordinates.size(), n = inputs.reads.size();
        const std::vector<double> numbers = numbers_of(inputs, at);
        std::vector<double> by(slopes.empty() ? 0 : n);
        std::ranges::fill(slopes, 0.0);
        for (std::size_t i = 0; i < expressions.size(); ++i) {
            factors[i] = expressions[i](beside_breaks(at.at, breaks), numbers, by);
            for (std::size_t k = 0; k < by.size(); ++k)
                // The row of one factor holds slopes by all values, then by all rates. Two symbols may read
                // one coordinate, so that slopes add up.
                slopes[2 * m * i + (inputs.reads[k].is_rate ? m : 0) + inputs.reads[k].coordinate] += by[k];
        }
    };
}

RecordedLaw recorded_law_of(const std::vector<Expression>& expressions, const Inputs& inputs,
                            const std::vector<double>& breaks, const TimeFunction& acts)
{
    std::vector<LawRead> reads;
    for (const Inputs::Read& read : inputs.reads) reads.push_back({read.coordinate, read.is_rate});
    return recorded_law(expressions, reads, breaks, acts);
}

LawSteepness steepness_of(const std::vector<Expression>& expressions, const Inputs& inputs)
{
    return [expressions, inputs](const EnclosedValue& t, std::span<const EnclosedValue> numbers,
                                 std::span<double> bounds) {
        std::vector<EnclosedValue> symbols;
        for (const Inputs::Read& read : inputs.reads)
            symbols.push_back(numbers[read.coordinate + (read.is_rate ? inputs.coordinates.size() : 0)]);
        for (std::size_t k = 0; k < expressions.size(); ++k)
            // Interval arithmetic encloses the slope over an element, for the looks at laws (theory.md, Looks
            // at laws).
            bounds[k] = expressions[k].over(t, symbols).slope.size();
    };
}

void warn_of_kinks(Builder& builder, const Section& section, std::string_view key,
                   const std::vector<Expression>& expressions)
{
    for (const Expression& one : expressions)
        if (const std::string kink = one.kink_by_symbols(); !kink.empty())
            builder.findings().warning(
                section.place(key), "expression-kink",
                section.label() + " may jump or bend where the motion decides: " + kink,
                {"no element ends there but of lobatto and radau, forwards one after the other, and of "
                 "lobatto with conditions at both ends, so that the estimated error may miss it as well",
                 "take the family lobatto, or a smooth law such as tanh"});
}

/// Guards of all formulas one after the other, and their numbers likewise.
LawGuards guards_of(const std::vector<Expression>& expressions, const Inputs& inputs)
{
    std::vector<Guard> guards;
    for (const Expression& one : expressions)
        guards.insert(guards.end(), one.guards().begin(), one.guards().end());
    if (guards.empty()) return {};
    const auto values = [expressions, inputs](const LawArguments& at, std::span<double> found) {
        const std::vector<double> numbers = numbers_of(inputs, at);
        for (const Expression& one : expressions) {
            one.guarded(at.at.t, numbers, found);
            found = found.subspan(one.guards().size());
        }
    };
    return {guards, values};
}

}   // namespace livens::inline io_internal
