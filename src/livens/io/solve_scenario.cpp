// SPDX-License-Identifier: BSD-3-Clause
// A scenario solved, estimated and judged, once for program and Python. The time that is told is that of the
// solution alone; the estimate is timed apart.
#include "livens/io/solve_scenario.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/diagnostics/extremes.h"
#include "livens/dynamics/start/prepared.h"
#include "livens/multibody/controllers.h"
#include "livens/solvers/patience.h"

namespace livens {

namespace {

/// From now on the problem is the one that begins with what was found.
void take_found(std::shared_ptr<const Scenario> found, SolvedScenario& solved)
{
    if (found == nullptr)
        throw InputError({"internal", "",
                          "this should not happen: the numbers that were found make no scenario", "", "", "",
                          ""});
    Problem& problem = solved.problem;
    const std::vector<UnknownNumber> before = std::exchange(problem.unknowns, found->unknowns).numbers;
    for (std::size_t i = 0; i < before.size(); ++i)
        problem.unknowns.numbers[i].scale = scale_of(before[i]);   // as it was solved
    problem.conditions = found->conditions;
    problem.prepared = found->prepared;
    solved.found = std::move(found);
}

/// With which bodies meet: that of the coordinate that the stop is of.
const char* unit_of_speed(const Event& event)
{
    const std::vector<LawCoordinate>& all = event.terms.coordinates;
    return !all.empty() && all[0].coordinate.is_angle() ? " rad/s" : " m/s";
}

/// "'lands' came true at 1.23456789 s, within 3e-13 s"
void tell_events(const Model& model, Solution& solution)
{
    constexpr std::size_t most = 12;
    const std::vector<SolvedEvent>& all = solution.events;
    for (std::size_t k = 0; k < std::min(most, all.size()); ++k) {
        const SolvedEvent& one = all[k];
        const Event& event = model.events()[static_cast<std::size_t>(one.event)];
        const bool is_hit = one.speed > 0;
        std::string text =
            "'" + event.name + (is_hit ? "' is hit at " : "' came true at ") + to_text(one.t, 12) + " s";
        if (std::isfinite(one.error)) text += ", within " + to_text(one.error, 2) + " s";
        if (is_hit) text += ", with " + to_text(one.speed, 3) + unit_of_speed(event);
        if (std::isfinite(one.rests_at))
            text += ", and closes: at rest from " + to_text(one.rests_at, 12) + " s on";
        if (event.action.does == EventAction::Does::end_motion) text += ", and ends the motion";
        solution.report.notes.push_back(std::move(text));
    }
    if (all.size() > most)
        solution.report.notes.push_back("and " + std::to_string(all.size() - most) +
                                        " more events, which the result file lists");
}

}   // namespace

void tell_found(const UnknownNumbers& found, Solution& solution)
{
    const std::vector<UnknownNumber>& all = found.numbers;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const SolveReport& report = solution.report;
        const bool is_found = report.reached_end() || report.status == SolveStatus::inaccurate;
        std::string text = (is_found ? "found: " : "not found, and in the last iterate: ") + all[i].name +
                           " = " + to_text(all[i].guess, 15);
        if (!all[i].unit.empty()) text += " " + all[i].unit;
        if (is_found && i < solution.numbers.errors.size())
            text += ", within " + to_text(solution.numbers.errors[i], 2);
        solution.report.notes.push_back(std::move(text));
    }
}

RunNumbers numbers_of(const UnknownNumbers& found, std::vector<double> errors)
{
    RunNumbers all;
    for (const UnknownNumber& one : found.numbers) {
        all.names.push_back(one.name);
        all.values.push_back(one.guess);
    }
    all.errors = std::move(errors);
    all.errors.resize(all.names.size(), std::nan(""));
    return all;
}

void take_events(const Run& run, Scenario& scenario)
{
    const std::vector<Event>& known = scenario.model.events();
    if (known.empty() || run.motion.mesh.ends.empty()) return;
    std::vector<SolvedEvent> events;
    for (std::size_t k = 0; k < run.events.names.size(); ++k) {
        const auto at = std::ranges::find(known, run.events.names[k], &Event::name);
        if (at == known.end())
            throw IoError("the scenario of the run has no event '" + run.events.names[k] + "'", "io-damaged");
        events.push_back({static_cast<int>(at - known.begin()), run.events.times[k], run.events.errors[k],
                          run.events.impulses[k], run.events.speeds[k], run.events.rests[k]});
    }
    scenario.model = decided_model(scenario.model, run.motion.start(), events);
}

SolvedScenario solve_scenario(const Scenario& scenario, SolveOptions options,
                              const std::shared_ptr<Prepared>& prepared, std::function<State(double t)> guess)
{
    options.judge = false;   // not part of what is timed, nor is the estimate
    Problem problem{scenario.conditions, std::move(guess), nullptr, prepared};
    problem.unknowns = scenario.unknowns;
    const auto begin = std::chrono::steady_clock::now();
    SolvedScenario solved{solve(scenario.model, problem, scenario.time, scenario.method, options),
                          std::move(problem)};
    solved.solve_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() -
                           solved.solution.estimate_seconds;
    const FoundNumbers& numbers = solved.solution.numbers;
    if (numbers.rebuilt.model != nullptr) take_found(with_guesses(scenario, numbers.values), solved);
    if (solved.solution.decided != nullptr) {   // the same scenario, of which the motion has decided the rest
        auto decided = std::make_shared<Scenario>(scenario);
        decided->model = *solved.solution.decided;
        solved.found = std::move(decided);
    }
    const Scenario& now = solved.found != nullptr ? *solved.found : scenario;
    estimate(now.model, solved.problem, now.method, options, solved.solution);
    for (Solution& root : solved.solution.roots)
        estimate(now.model, solved.problem, now.method, options, root);
    if (solved.found != nullptr) tell_found(solved.found->unknowns, solved.solution);
    tell_events(now.model, solved.solution);
    return solved;
}

namespace {

/// How far joints were beyond their limits: a note for each that was there.
void tell_limits(const Scenario& scenario, Run& run)
{
    const std::vector<Load>& loads = scenario.model.loads();
    const auto has_limits = [](const Load& load) {
        return std::ranges::find(load.readings, "penetration", &LoadReading::name) != load.readings.end();
    };
    if (std::ranges::none_of(loads, has_limits) || run.motion.n_elements() == 0) return;
    const Quantities quantities(scenario.model, run.motion, run.body_names);
    std::vector<QuantitySeries> series;
    for (const NamedQuantity& q : quantities.all())
        if (q.of == QuantityOf::load && q.what == "penetration") series.push_back({q});
    const std::vector<Extremes> found = find_extremes(quantities, run.motion, series, {});
    for (std::size_t i = 0; i < series.size(); ++i) {
        const Load& load = loads[static_cast<std::size_t>(series[i].quantity.index)];
        const Extreme& most = found[i].largest;
        if (!(most.value > 0)) continue;
        std::string law;   // "100 N/m and damping 0.3 s/m"
        for (const char* name : {"limit_stiffness", "limit_damping"}) {
            const auto number = std::ranges::find(load.readings, name, &LoadReading::name);
            law += (law.empty() ? "" : " and damping ") + to_text(number->value(LoadArguments()), 4) + " " +
                   number->unit;
        }
        run.notes.push_back("'" + load.name + "' was beyond its limits by " + to_text(most.value, 4) + " " +
                            found[i].unit + " at most, at " + to_text(most.t, 6) + " s; its springs have " +
                            law);
    }
}

/// States that are of another size than the one that their errors are relative to.
void tell_sizes(const Model& model, Run& run)
{
    constexpr double far = 1e3;
    const bool has_states = std::ranges::any_of(model.bodies(), &Body::holds_states);
    std::vector<NamedState> most;
    for (int e = 0; has_states && e <= run.motion.n_elements() && run.motion.n_elements() > 0; ++e) {
        const std::vector<NamedState> now = states_in(model, run.motion.at_end(e).V);
        if (most.empty()) most = now;
        for (std::size_t k = 0; k < now.size(); ++k)
            most[k].value = std::max(std::abs(most[k].value), std::abs(now[k].value));
    }
    for (const NamedState& state : most) {
        const double share = state.value / state.size;
        if (share == 0 || (share > 1 / far && share < far)) continue;
        run.notes.push_back("state '" + state.name + "' is " + to_text(state.value, 2) +
                            " at most, and its errors are relative to its size, " + to_text(state.size, 2) +
                            ": state the 'size' of it in its controller");
    }
}

RunEvents events_of(const Model& model, const std::vector<SolvedEvent>& events)
{
    RunEvents all;
    for (const SolvedEvent& one : events) {
        all.names.push_back(model.events()[static_cast<std::size_t>(one.event)].name);
        all.times.push_back(one.t);
        all.errors.push_back(one.error);
        all.impulses.push_back(one.impulse);
        all.speeds.push_back(one.speed);
        all.rests.push_back(one.rests_at);
    }
    return all;
}

}   // namespace

std::vector<Run> judged_roots(const Scenario& scenario, SolvedScenario& solved,
                              const std::function<bool()>& goes_on)
{
    std::vector<Run> runs;
    for (Solution& root : std::exchange(solved.solution.roots, {}))
        runs.push_back(judged_run(scenario, {std::move(root), solved.problem}, goes_on));
    return runs;
}

Run judged_run(const Scenario& given, SolvedScenario&& solved, const std::function<bool()>& goes_on)
{
    const std::shared_ptr<const Scenario> found = solved.found;
    const Scenario& scenario = found != nullptr ? *found : given;
    Solution& solution = solved.solution;
    judge(scenario.model, solved.problem, scenario.options, solution, goes_on);
    const Method method = solution.method;
    RunNumbers numbers;
    if (found != nullptr) numbers = numbers_of(found->unknowns, std::move(solution.numbers.errors));
    RunEvents events = events_of(scenario.model, solution.events);
    Run run = make_run(scenario.model, std::move(solution), method);
    run.numbers = std::move(numbers);
    run.events = std::move(events);
    run.scenario_text = scenario.text;
    run.meshes = scenario.meshes;
    run.title = scenario.title;
    run.resolved = scenario.resolved;
    // Without output times the element ends are the samples, where a motion has its best states.
    run.output = scenario.output.empty() ? run.motion.mesh.ends : scenario.output;
    if (!run.events.names.empty() && run.motion.n_elements() > 0) {   // one of them may have ended it
        std::erase_if(run.output, [&](double t) { return t > run.motion.end(); });
        if (run.output.empty() || run.output.back() < run.motion.end())
            run.output.push_back(run.motion.end());
    }
    try {
        tell_limits(scenario, run);
        tell_sizes(scenario.model, run);
    } catch (const Stopped&) {   // as the motion stays unjudged then
    }
    return run;
}

}   // namespace livens
