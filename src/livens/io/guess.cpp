// SPDX-License-Identifier: BSD-3-Clause
// Bodies are found by their names; all else of the model may differ.
#include "livens/io/guess.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "livens/base/error.h"
#include "livens/base/text.h"

namespace livens {

namespace {

/// Indices of the scenario's bodies in the run.
std::vector<std::size_t> bodies_in(const Run& run, const Model& model)
{
    const auto refuse = [](const std::string& message) {
        throw InputError({"guess-bodies", "guess", message, "", "a run of the same bodies",
                          "a guess says where every body is at every instant",
                          "give a run of this mechanism; masses, joints and loads may differ"});
    };
    std::vector<std::size_t> found;
    for (const Body& body : model.bodies()) {
        const auto at = std::ranges::find(run.body_names, body.name);
        if (at == run.body_names.end()) refuse("the guess has no body '" + body.name + "'");
        const auto index = static_cast<std::size_t>(at - run.body_names.begin());
        if (run.body_is_point[index] != body.is_point)
            refuse("body '" + body.name + "' of the guess is " +
                   (body.is_point ? "no point mass" : "a point mass"));
        found.push_back(index);
    }
    if (run.body_names.size() == found.size()) return found;
    const auto other = std::ranges::find_if(run.body_names, [&](const std::string& name) {
        return std::ranges::find(model.bodies(), name, &Body::name) == model.bodies().end();
    });
    if (other != run.body_names.end()) refuse("the guess has a body '" + *other + "' more");
    return found;
}

/// A motion at any instant, beyond its ends straight on; start_from() makes directors orthonormal.
State going_on(const Motion& motion, double t)
{
    if (t >= motion.start() && t <= motion.end()) return motion.at(t);
    const bool is_before = t < motion.start();
    State state = motion.at_end(is_before ? 0 : motion.n_elements());
    const double ahead = t - (is_before ? motion.start() : motion.end());
    for (std::size_t b = 0; b < state.X.size(); ++b) state.X[b] += ahead * state.V[b];
    state.t = t;
    return state;
}

}   // namespace

std::function<State(double t)> guess_of(const Scenario& scenario, const Run& run)
{
    const Conditions& given = scenario.conditions;
    if (given.has_state())
        throw InputError({"guess-unused", given.at_start == Known::state ? "start.given" : "end.given",
                          "a guess goes with conditions at both ends of time", "state",
                          "positions or momenta at each end",
                          "from a state elements are solved one after the other, each from the one before",
                          "leave the guess out, or give one half of the state at each end"});
    std::vector<std::size_t> bodies = bodies_in(run, scenario.model);
    const Motion& motion = run.motion;
    const double start = start_of(scenario.time), end = end_of(scenario.time);
    if (motion.n_elements() < 1 || motion.end() <= start || motion.start() >= end)
        throw InputError({"guess-time", "guess", "the guess has no time in common with the motion",
                          motion.n_elements() < 1
                              ? "no elements"
                              : to_text(motion.start()) + " s to " + to_text(motion.end()) + " s",
                          to_text(start) + " s to " + to_text(end) + " s", "",
                          "give a run over the time of [time], or over a part of it"});
    return [&motion, bodies = std::move(bodies)](double t) {
        const State of_run = going_on(motion, t);
        State state;
        state.t = t;
        for (const std::size_t b : bodies) {
            state.X.push_back(of_run.X[b]);
            state.V.push_back(of_run.V[b]);
        }
        return state;
    };
}

}   // namespace livens
