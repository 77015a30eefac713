// SPDX-License-Identifier: BSD-3-Clause
// What conditions by component are compared with: theory.md, "Conditions by component".
#include <algorithm>
#include <cmath>

#include "livens/base/text.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/march/components.h"

namespace livens::inline spacetime_internal {

namespace {

const char* word_of(Condition::At at)
{
    return at == Condition::At::start ? "start" : at == Condition::At::end ? "end" : "both";
}

}   // namespace

std::string in_words(const Condition& condition)
{
    const std::string name = "'" + condition.quantity.name + "'";
    if (condition.at == Condition::At::both) return name + " alike at both ends";
    return name + " at the " + word_of(condition.at);
}

std::string path_of(const Condition& condition)
{
    if (condition.forgets_turns) return "time.periodic";
    const std::string end = condition.at == Condition::At::end ? "end" : "start";
    return condition.is_of_all ? end + ".given" : end + ".known[" + condition.quantity.name + "]";
}

std::vector<StateQuantity> quantities_at(const std::vector<Condition>& conditions, bool last)
{
    std::vector<StateQuantity> all;
    for (const Condition& one : conditions) all.push_back(last ? one.at_end() : one.quantity);
    return all;
}

double unit_of(const StateQuantity& quantity, double length, double duration)
{
    if (quantity.is_energy()) return quantity.mass * (length / duration) * (length / duration);
    const double unit = quantity.is_angle() ? 1 : length;
    return quantity.is_rate() ? unit / duration : unit;
}

double scale_of(const Condition& condition, double length, double duration)
{
    return std::max(std::abs(condition.value), unit_of(condition.quantity, length, duration));
}

double start_of_turns(const Ends& ends, const StateQuantity& quantity)
{
    for (const Condition& one : ends.components)
        if (one.at == Condition::At::start && one.quantity.name == quantity.name) return one.value;
    return quantity.coordinate.at_stated;
}

/// An angle at the end is followed over the instants, taken in the turn that is nearest to the one before:
/// between two of them it must change by less than half a turn.
std::vector<double> values_in(const Model& model, const Ends& ends,
                              const std::function<State(double t)>& motion,
                              const std::vector<double>& instants)
{
    std::vector<Matrix34> stated;
    for (const Body& body : model.bodies()) stated.push_back(body.X);
    std::vector<State> states;
    for (const double t : instants) states.push_back(motion(t));
    std::vector<double> values;
    for (const Condition& one : ends.components) {
        const StateQuantity& q = one.quantity;
        const auto raw = [&](const State& state) { return value_of(q, stated, state.X, state.V); };
        double first = raw(states.front()),
               last = value_of(one.at_end(), stated, states.back().X, states.back().V);
        if (q.counts_turns() && !one.turn) {
            last = first = turned_to(first, start_of_turns(ends, q));
            for (const State& state : states) last = turned_to(raw(state), last);
        }
        double change = last - first;
        if (one.forgets_turns && q.counts_turns()) change = turned_to(change, 0);
        values.push_back(one.at == Condition::At::start ? first
                         : one.at == Condition::At::end ? last
                                                        : change);
    }
    return values;
}

/// Angles are followed over all nodes: element ends alone may be more than half a turn apart.
std::vector<std::string> unmet_components(const Model& model, const Ends& ends, const Motion& motion)
{
    if (ends.components.empty() || motion.n_elements() == 0) return {};
    std::vector<double> instants;
    const std::vector<double> nodes = motion.X.basis().nodes();
    for (int e = 0; e < motion.n_elements(); ++e)
        for (int a = 0; a < motion.X.degree; ++a)
            instants.push_back(motion.mesh.ends[e] + nodes[a] * motion.mesh.length(e));
    instants.push_back(motion.end());
    const std::vector<double> values =
        values_in(model, ends, [&](double t) { return motion.at(t); }, instants);
    return unmet_values(model, ends, values, motion.end() - motion.start());
}

std::vector<std::string> unmet_values(const Model& model, const Ends& ends, const std::vector<double>& values,
                                      double duration)
{
    std::vector<std::string> reasons;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Condition& one = ends.components[i];
        const double scale = scale_of(one, model.length(), duration);
        if (std::abs(values[i] - one.value) <= met_component * scale) continue;
        reasons.push_back("what is given is not met: " + in_words(one) + " is " + to_text(values[i], 9) +
                          " " + one.quantity.unit + ", given is " + to_text(one.value, 9) + " " +
                          one.quantity.unit + "; try: more elements, or a better guess");
    }
    return reasons;
}

}   // namespace livens::inline spacetime_internal
