// SPDX-License-Identifier: BSD-3-Clause
// What a controller's formulas become: forces on what holds its states, or what is asked at instants
// (docs/theory.md, "States").
#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/base/text.h"
#include "livens/io/scenario/controllers/controller_reader.h"
#include "livens/io/scenario/joints/expressions.h"
#include "livens/io/scenario/loads/load_makers.h"

namespace livens::inline io_internal {

namespace {

/// At which its size is asked, beside the start.
constexpr int instants_of_size = 64;

}   // namespace

/// The largest of |z| and of |f| times the shorter of the duration and 1 / |df/dz| (theory.md, "States"): at
/// instants of all of the time, as f may depend on it, with what is read taken as it is at the start. Where
/// that is zero, as of what begins at its set point, changes of inputs by a tenth of the length, 0.1 rad or a
/// tenth of the weight tell what f may become.
void ControllerReader::measure(SizesOfStates& sizes) const
{
    const Section* time = only_section(builder_.run(), "time");
    const double start = time == nullptr ? 0 : time->number("start");
    const double duration = time == nullptr ? 1 : time->number("end") - start;
    const State at = builder_.model().start();
    const Model& at_start = builder_.model();
    std::vector<double> numbers, reach;   // at the start, and by how much they may change
    double weight = 0;
    for (const Body& body : at_start.bodies())
        weight += norm(livens::weight(body, at_start.gravity()).column(0));
    for (const Inputs::Read& read : inputs_.reads) {
        if (read.reaction >= 0) {   // what joints bear by then is of the size of the weight
            numbers.push_back(weight);
            reach.push_back(0.1 * weight);
            continue;
        }
        const LawCoordinate& q = inputs_.coordinates[read.coordinate];
        numbers.push_back(read.is_rate ? coordinate_rate(q.coordinate, at.X, at.V) : q.at_stated);
        const int body = q.coordinate.forms[0].body_j;
        const bool is_state =
            body != world && at_start.bodies()[static_cast<std::size_t>(body)].holds_states();
        reach.push_back(is_state ? 0 : q.coordinate.is_angle() ? 0.1 : 0.1 * builder_.length());
    }
    for (std::size_t k = 0; k < states_.size(); ++k) {
        double size = std::abs(states_[k].start), by_reach = 0;
        for (int i = 0; i <= instants_of_size; ++i) {
            std::vector<double> slopes(numbers.size());
            const double value = formulas_[k](start + i * duration / instants_of_size, numbers, slopes);
            const double decay = decay_of(k, slopes), change = is_sampled_            ? 1
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

double ControllerReader::decay_of(std::size_t k, const std::vector<double>& slopes) const
{
    const auto own = std::ranges::find(inputs_.symbols, states_[k].name);
    return own == inputs_.symbols.end()
               ? 0
               : std::abs(slopes[static_cast<std::size_t>(own - inputs_.symbols.begin())]);
}

std::vector<ReactionLaw::Reading> ControllerReader::readings(const std::vector<Expression>& of_outputs)
{
    std::vector<ReactionLaw::Reading> all;
    for (const ReadController::State& state : own().states) {
        std::size_t k = 0;   // its coordinate
        while (k < inputs_.coordinates.size() &&
               !is_same(inputs_.coordinates[k].coordinate, state.coordinate))
            ++k;
        if (k == inputs_.coordinates.size()) inputs_.coordinates.push_back({state.coordinate, 0, false});
        all.push_back(
            {state.name, "", [k](const LawArguments& at, std::span<const double>) { return at.rates[k]; }});
    }
    for (std::size_t k = 0; k < of_outputs.size(); ++k)
        all.push_back({outputs_[k].name, "", number_by(of_outputs[k], inputs_)});
    return all;
}

bool ControllerReader::is_same(const JointCoordinate& a, const JointCoordinate& b)
{
    return a.forms.size() == 1 && b.forms.size() == 1 && a.forms[0].body_j == b.forms[0].body_j &&
           a.forms[0].body_i == b.forms[0].body_i && a.forms[0].b_j == b.forms[0].b_j;
}

void ControllerReader::add_observer(const std::string& name, const std::vector<ReactionLaw::Reading>& told)
{
    builder_.model().add_load(telling(builder_, name, inputs_, told));
}

Load ControllerReader::rates_of_body(std::size_t first, const std::vector<Expression>& of_rates,
                                     const std::vector<double>& breaks) const
{
    const std::vector<Matrix34> X = places(builder_);
    std::vector<Load> units;
    for (std::size_t k = 0; k < of_rates.size(); ++k)
        units.push_back(unit_of_state(states_[first + k].name, bodies_[first / states_of_body],
                                      static_cast<int>(k), states_[first + k], scale_, X));
    const std::string name = part_name("rates of ", first), type(controller_type);
    if (!inputs_.reactions.empty()) {
        ReactionLaw law = reaction_law_of(of_rates, inputs_, breaks, 1.0);
        law.name = name;
        law.type = type;
        law.units = std::move(units);
        return waiting(std::move(law));
    }
    LoadParts parts = parts_of(of_rates, inputs_, breaks, 1.0);
    parts.units = std::move(units);
    // It does no work on what has mass.
    parts.power = [](const LawArguments&) { return 0.0; };
    parts.domain = "the rates of its states have no value there (0/0, or a root of a negative number)";
    return modulated(name, type, parts, X);
}

void ControllerReader::make_rates(const std::vector<Expression>& of_rates,
                                  const std::vector<Expression>& of_outputs)
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
        if (!ends_at_bends(builder_)) warn_of_kinks(builder_, section_, "states", some);
        builder_.model().add_load(rates_of_body(first, some, breaks));
    }
    // The observer that is added next.
    own().load = static_cast<int>(builder_.model().loads().size());
    const std::vector<ReactionLaw::Reading> told = readings(of_outputs);
    add_observer("controller " + name_, told);
}

void ControllerReader::make_sampling()
{
    const Section* time = only_section(builder_.run(), "time");
    const double first = section_.has("first") ? section_.number("first")
                         : time == nullptr     ? 0
                                               : time->number("start");
    // It asks the load that tells the next values, which is the first one added below.
    Sampling sampling{name_,
                      {static_cast<int>(builder_.model().loads().size()), {}},
                      section_.number("every"),
                      first,
                      time == nullptr ? first : time->number("end")};
    if (!(sampling.every > 0))
        refuse("controller-every", "every", "the period must be positive", to_text(sampling.every), "");
    constexpr double most = 1e6;
    if ((sampling.last - sampling.first) / sampling.every > most)
        refuse("resource-limit", "every", "a controller is asked more than a million times", "",
               "a longer period, or an earlier end of time");
    std::vector<ReactionLaw::Reading> next;
    for (std::size_t k = 0; k < states_.size(); ++k) {
        sampling.change.states.push_back(own().states[k].coordinate);
        next.push_back({states_[k].name, "", number_by(formulas_[k], inputs_)});
    }
    const std::vector<ReactionLaw::Reading> told = readings({});
    add_observer("next of " + name_, next);
    own().load = static_cast<int>(builder_.model().loads().size());
    add_observer("controller " + name_, told);
    builder_.model().add_sampling(std::move(sampling));
}

}   // namespace livens::inline io_internal
