// SPDX-License-Identifier: BSD-3-Clause
// Which stops hold a rest, by what they push with: docs/theory.md, "Equilibrium", Stops.
#include "livens/statics/resting_stops.h"

#include <algorithm>
#include <cmath>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/dynamics/instant/reactions.h"
#include "livens/statics/statics.h"

namespace livens::inline statics_internal {

namespace {

constexpr double touched = 1e-9;    // of the scale of a row
constexpr double no_force = 1e-9;   // of all weights and loads together

/// The event that closes a stop; null: it is none, or nothing does.
const Event* closing(const Model& model, int joint)
{
    const Joint& one = model.joints()[static_cast<std::size_t>(joint)];
    if (!one.impact || one.impact->open_side == 0) return nullptr;
    for (const Event& event : model.events())
        if (event.action.does == EventAction::Does::begin && event.action.joint == joint) return &event;
    return nullptr;
}

/// In units of force or of torque, whichever is more: what is smaller is none.
double noise_of(std::span<const double> given, double length)
{
    // Of 12 numbers a body the first three are forces, N; those on directors are N m.
    double forces = 0, torques = 0;
    for (std::size_t k = 0; k < given.size(); ++k) ((k % 12) < 3 ? forces : torques) += std::abs(given[k]);
    return no_force * std::max({forces, torques, forces * length, torques / length});
}

}   // namespace

RestingStops::RestingStops(const Model& whole, double t) : whole_(whole), t_(t)
{
    for (int j = 0; j < static_cast<int>(whole.joints().size()); ++j)
        if (const Event* event = closing(whole, j)) {
            joints_.push_back(j);
            closings_.push_back(event);
        }
}

/// As if events had decided: a closed stop acts at all times, an open one at none.
ActingModel RestingStops::holding(const std::vector<int>& closed) const
{
    DecidedTimes times;
    for (const Joint& joint : whole_.joints()) times.joints.push_back(joint.spans());
    for (const Load& load : whole_.loads()) times.loads.push_back(load.spans());
    for (int k = 0; k < size(); ++k) {
        std::vector<TimeSpan>& spans = times.joints[joint_index(k)];
        spans.clear();
        if (std::ranges::find(closed, k) != closed.end()) spans.emplace_back();
    }
    return acting_at(as_decided(whole_, times), t_);
}

ActingModel RestingStops::watching(const std::vector<int>& closed) const
{
    ActingModel held = holding(closed);
    const State stated = whole_.start();
    for (const Event* event : closings_) {
        Load watch = livens::watching(*event, {}, whole_.n_bodies(), Configurations(stated.X));
        // Names of loads are unique, and a load of the model may be called as the event is.
        while (std::ranges::any_of(held.model.loads(), [&](const Load& l) { return l.name == watch.name; }))
            watch.name += "'";
        held.model.add_load(std::move(watch));
    }
    return held;
}

/// By the guards, which are positive beyond a stop. Conditions see bodies at rest: V is zero.
std::vector<double> RestingStops::depths(const Model& watching, const LoadTables& loads,
                                         std::span<const Matrix34> X, std::span<const double> angles) const
{
    std::vector<double> all;
    const std::vector<double> V(12 * X.size(), 0.0);
    const int first = static_cast<int>(whole_.loads().size());
    for (int k = 0; k < size(); ++k) {
        double depth = 0;
        const auto load = static_cast<std::size_t>(first + k);
        watching.loads()[load].guarded(loads.arguments(first + k, {t_}, X.data()->data(), V.data(), angles),
                                       std::span(&depth, 1));
        all.push_back(depth / joint(k).rows[0].scale);
    }
    return all;
}

std::vector<double> RestingStops::depths_near(std::span<const Matrix34> X) const
{
    const ActingModel seen = watching({});
    const LoadTables loads(seen.model);
    std::vector<double> angles = loads.turns.begin();
    loads.turns.follow(Configurations(X), angles);
    return depths(seen.model, loads, X, angles);
}

/// A row exerts -G^T lambda, and a stop pushes towards its open side, where its row has the sign open_side.
Pushes RestingStops::pushes(const ActingModel& held, const std::vector<int>& closed,
                            std::span<const Matrix34> X, std::span<const double> multipliers,
                            std::span<const int> independent, std::span<const double> given) const
{
    Pushes found;
    found.noise = noise_of(given, whole_.length());
    const UniqueReactions least = least_reactions(held.model, X, multipliers, independent);
    for (const int k : closed) {
        const int whole = static_cast<int>(joint_index(k));
        const auto j = static_cast<std::size_t>(std::ranges::find(held.joints, whole) - held.joints.begin());
        const int row = held.model.first_row(static_cast<int>(j));
        found.push.push_back(-joint(k).impact->open_side * least.multipliers[static_cast<std::size_t>(row)]);
        found.is_unique.push_back(least.joint_is_unique[j]);
    }
    return found;
}

int RestingStops::to_release(const Pushes& pushes)
{
    const bool is_shared = std::ranges::find(pushes.is_unique, false) != pushes.is_unique.end();
    int least = -1;
    for (int k = 0; k < static_cast<int>(pushes.push.size()); ++k) {
        const auto at = static_cast<std::size_t>(k);
        const bool may_go = is_shared ? !pushes.is_unique[at] : pushes.push[at] < -pushes.noise;
        if (may_go && (least < 0 || pushes.push[at] < pushes.push[static_cast<std::size_t>(least)]))
            least = k;
    }
    return least;
}

void refuse_beyond_stops(const RestingStops& stops, std::span<const double> depths)
{
    for (int k = 0; k < stops.size(); ++k) {
        const double depth = depths[static_cast<std::size_t>(k)];
        if (depth <= touched) continue;
        const Joint& joint = stops.joint(k);
        throw InputError({"stop-violated", "joint[" + joint.name + "]",
                          "'" + joint.name + "' is passed where the bodies are",
                          to_text(depth * joint.rows[0].scale, 6), "", "a stop lets nothing beyond it",
                          "begin on its open side, or change its limits"});
    }
}

/// Where stops share what they bear, one at a time is left out and all is solved again, since the shares of
/// the others change. What is left has reactions of its own, and these have to push.
std::vector<int> stops_of_rest(const RestingStops& stops, const State& state, Side side)
{
    std::vector<int> closed;
    const std::vector<double> depths = stops.depths_near(state.X);
    refuse_beyond_stops(stops, depths);
    for (int k = 0; k < stops.size(); ++k)
        if (depths[static_cast<std::size_t>(k)] >= -touched) closed.push_back(k);
    State rest = state;
    for (Matrix34& V : rest.V) V = {};
    while (!closed.empty()) {
        ActingModel held = stops.holding(closed);
        held.model = frozen(held.model, {state.t, side});
        const PreparedState at(held.model, rest, side, true);
        const std::vector<double> multipliers = at.state.multipliers[side == Side::left ? 0 : 1];
        const Statics statics(at.tables, at.state, side);
        const Pushes pushes =
            stops.pushes(held, closed, rest.X, multipliers, at.tables.independent, statics.given);
        const bool is_shared = std::ranges::find(pushes.is_unique, false) != pushes.is_unique.end();
        if (is_shared) {   // what others hold as well is held
            closed.erase(closed.begin() + RestingStops::to_release(pushes));
            continue;
        }
        for (std::size_t k = 0; k < closed.size(); ++k) {
            const Joint& joint = stops.joint(closed[k]);
            if (pushes.push[k] > pushes.noise) continue;
            if (pushes.push[k] < -pushes.noise)
                throw InputError({"not-in-equilibrium", "joint[" + joint.name + "]",
                                  "stop '" + joint.name + "' would have to pull: bodies would leave it",
                                  to_text(pushes.push[k], 3), "", "", "find the equilibrium first"});
            throw InputError({"event-method", "joint[" + joint.name + "]",
                              "this rest touches stop '" + joint.name + "' without a force", "", "",
                              "small motions to its two sides follow different equations",
                              "move the stop, or load it"});
        }
        return closed;
    }
    return closed;
}

}   // namespace livens::inline statics_internal
