// SPDX-License-Identifier: BSD-3-Clause
// Conditions of events as what looks for bends of laws knows them: guards of a load that does nothing.
#include "livens/multibody/events.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "livens/base/error.h"
#include "livens/multibody/joints.h"
#include "livens/multibody/loads/load_coordinate.h"

namespace livens {

void check_event(const Event& event, const std::vector<Joint>& joints, const std::vector<Load>& loads)
{
    const std::string path = "event[" + event.name + "]";
    const auto refuse = [&path](const char* code, const char* message) {
        throw InputError({code, path, message, "", "", "", ""});
    };
    const EventTerms& terms = event.terms;
    const auto is_term = [&](int k) { return k >= 0 && k < terms.n_terms; };
    const bool is_whole = terms.values != nullptr && !terms.when.empty() &&
                          std::ranges::all_of(terms.when, [&](const std::vector<int>& all) {
                              return !all.empty() && std::ranges::all_of(all, is_term);
                          });
    if (!is_whole) refuse("event-condition", "an event needs a condition");
    for (const ReactionInput& one : terms.reactions)
        if (one.joint < 0 || one.joint >= static_cast<int>(joints.size()))
            refuse("event-condition", "there is no joint of this index");
    const EventAction& action = event.action;
    const bool is_of_part = action.does == EventAction::Does::begin || action.does == EventAction::Does::end;
    const auto is_ready = [&](const ActingTimes& times) {
        return action.does == EventAction::Does::begin ? times.is_begun_by_event : times.is_ended_by_event;
    };
    const bool has_joint = action.joint >= 0 && action.joint < static_cast<int>(joints.size()),
               has_load = action.load >= 0 && action.load < static_cast<int>(loads.size());
    if (is_of_part &&
        (has_joint == has_load || !is_ready(has_joint ? static_cast<const ActingTimes&>(joints[action.joint])
                                                      : static_cast<const ActingTimes&>(loads[action.load]))))
        refuse("event-action", "an event begins or ends one joint or load that says so");
}

std::vector<double> Sampling::instants() const
{
    std::vector<double> all;
    // Products, not sums: instants do not gather rounding.
    for (int k = 0; first + k * every <= last; ++k) all.push_back(first + k * every);
    return all;
}

/// All values are asked before any state changes, which the others must not see.
void change_states(const Load& load, const StateChange& change, Instant at, std::span<const Matrix34> X,
                   std::span<const double> angles, std::vector<Matrix34>& V)
{
    const LoadArguments arguments = load_arguments(load, at, X, V, angles);
    std::vector<double> wanted;
    for (const LoadReading& reading : load.readings) wanted.push_back(reading.value(arguments));
    for (std::size_t k = 0; k < change.states.size(); ++k) {
        const PairForm& form = change.states[k].forms[0];
        const Vector3 along = form.b_j.column(0);   // of a displacement: its gradient
        Matrix34& of_body = V[static_cast<std::size_t>(form.body_j)];
        const double by = wanted[k] - coordinate_rate(change.states[k], X, V);
        for (int i = 0; i < 3; ++i) of_body(i, 0) += by / dot(along, along) * along[i];
    }
}

bool holds(const Event& event, std::span<const double> terms)
{
    return std::ranges::any_of(event.terms.when, [&](const std::vector<int>& all) {
        return std::ranges::all_of(all, [&](int k) { return terms[static_cast<std::size_t>(k)] > 0; });
    });
}

namespace {

/// What terms look at in a list of bodies.
struct Watched {
    EventTerms terms;
    std::vector<LoadCoordinate> coordinates;
    ReactionsAt reactions;

    void values(const LoadArguments& arguments, std::span<double> out) const
    {
        std::vector<double> q, rates, forces(terms.reactions.size());
        for (const LoadCoordinate& coordinate : coordinates) {
            const CoordinateState state = coordinate.look(arguments);
            q.push_back(state.value);
            rates.push_back(state.rate);
        }
        if (!forces.empty()) reactions(arguments, forces);
        terms.values({arguments.at, q, rates}, forces, out);
    }
};

}   // namespace

Load watching(const Event& event, const ReactionsAt& reactions, int n_bodies, const Configurations& X)
{
    Load load;
    load.name = event.name;
    load.type = "event";
    Watched watched{event.terms, {}, reactions};
    for (const LawCoordinate& q : event.terms.coordinates)
        watched.coordinates.emplace_back(q.coordinate, q.at_stated, X);
    std::vector<int> bodies;
    for (const LoadCoordinate& coordinate : watched.coordinates)
        for (const int body : coordinate.bodies())
            if (body != world && std::ranges::find(bodies, body) == bodies.end()) bodies.push_back(body);
    // Reactions follow from the state of all bodies; a condition of time alone needs a body all the same.
    if (!event.terms.reactions.empty() || bodies.empty()) {
        bodies.clear();
        for (int b = 0; b < n_bodies; ++b) bodies.push_back(b);
    }
    // It would act on the first body, and on the world, if it did something.
    load.bodies = {bodies[0], world};
    load.bodies.insert(load.bodies.end(), bodies.begin() + 1, bodies.end());
    for (std::size_t i = 0; i < watched.coordinates.size(); ++i)
        watched.coordinates[i].place(load, event.terms.coordinates[i].is_needed);
    load.is_smooth = true;
    load.guards.assign(static_cast<std::size_t>(event.terms.n_terms), Guard{});
    const auto all = std::make_shared<const Watched>(std::move(watched));
    load.guarded = [all](const LoadArguments& arguments, std::span<double> numbers) {
        all->values(arguments, numbers);
    };
    load.forces = [](const LoadArguments&, LoadForces&) {};
    load.forces.record = [](LoadTape&, const TapeNumber&) {};
    return load;
}

namespace {

/// Whether a load acts, on the side of an instant that is meant.
struct Gate {
    std::vector<TimeSpan> spans;

    bool is_open(Instant at) const
    {
        return std::ranges::any_of(spans, [&](const TimeSpan& one) {
            return at.side == Side::left ? one.has_before(at.t) : one.has(at.t);
        });
    }
    TimeFunction as_function(const std::vector<double>& breaks) const
    {
        return {[gate = *this](Instant at) { return TimeValue{gate.is_open(at) ? 1.0 : 0.0, 0, 0}; }, breaks};
    }
};

}   // namespace

/// Where it does not act its forces and slopes are zero, also those of a law inside of elements; directions
/// of products stay, as they are no forces. It has no potential of its own: what it stores comes and goes
/// with it, so that all of its power is counted as work.
Load for_its_time(const Load& load)
{
    const Gate gate{load.spans()};
    const auto inner = std::make_shared<const Load>(load);
    Load now = load;
    now.whenever = inner;
    std::vector<double> instants;
    for (const TimeSpan& one : gate.spans)
        for (const double t : {one.from, one.until})
            if (std::isfinite(t)) instants.push_back(t);
    std::ranges::sort(instants);
    instants.erase(std::unique(instants.begin(), instants.end()), instants.end());
    now.forces = [gate, inner](const LoadArguments& arguments, LoadForces& F) {
        if (gate.is_open(arguments.at)) inner->forces(arguments, F);
    };
    if (load.forces.record)
        now.forces.record = [acts = gate.as_function(instants), inner](LoadTape& tape,
                                                                       const TapeNumber& factor) {
            inner->forces.record(tape, factor * tape.of_time(acts));
        };
    if (load.tangent)
        now.tangent = [gate, inner](const LoadArguments& arguments, LoadTangent& tangent) {
            if (gate.is_open(arguments.at)) inner->tangent(arguments, tangent);
        };
    if (load.products)
        now.products = [gate, inner](const LoadArguments& arguments) {
            std::vector<ProductSlopes> found = inner->products(arguments);
            if (!gate.is_open(arguments.at))
                for (ProductSlopes& one : found) {
                    const LoadForces direction = one.direction;
                    one = ProductSlopes(arguments.X.size());
                    one.direction = direction;
                }
            return found;
        };
    if (load.inside)
        now.inside->factors = [gate, inner](Instant at, std::span<const double> numbers,
                                            std::span<double> factors) {
            if (gate.is_open(at))
                inner->inside->factors(at, numbers, factors);
            else
                std::ranges::fill(factors, 0.0);
        };
    now.potential = nullptr;
    now.power = nullptr;
    now.recorded_power = nullptr;
    for (std::size_t k = 0; k < load.readings.size(); ++k)
        if (load.readings[k].unit == "N" || load.readings[k].unit == "N m")
            now.readings[k].value = [gate, inner, k](const LoadArguments& arguments) {
                return gate.is_open(arguments.at) ? inner->readings[k].value(arguments) : 0.0;
            };
    now.breaks.insert(now.breaks.end(), instants.begin(), instants.end());
    std::ranges::sort(now.breaks);
    return now;
}

}   // namespace livens
