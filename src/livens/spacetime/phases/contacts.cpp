// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/phases/contacts.h"

#include <algorithm>
#include <cmath>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/dynamics/instant/impact.h"

namespace livens::inline spacetime_internal {

namespace {

/// Of the fastest: slower than that bodies are together.
constexpr double no_speed = 1e-12;

bool is_stop(const Joint& joint) { return joint.impact && joint.impact->open_side != 0; }

/// The joints at an instant that hold both ways, with others that are chosen.
class HeldModels {
public:
    HeldModels(const Model& model, const Decisions& decisions, double t)
        : model_(model), times_(decisions.times()), t_(t)
    {}

    /// `begins`: joints that act from now on as well; of stops those that are chosen alone.
    Model with(const std::vector<int>& begins, const std::vector<int>& stops) const
    {
        DecidedTimes times = times_;
        for (std::size_t j = 0; j < times.joints.size(); ++j) {
            const int joint = static_cast<int>(j);
            const auto is_among = [&](const std::vector<int>& all) {
                return std::ranges::find(all, joint) != all.end();
            };
            if (is_stop(model_.joints()[joint])) {
                times.joints[j].clear();
                if (is_among(stops)) times.joints[j].push_back({t_, t_ + 1});
            } else if (is_among(begins)) {
                times.joints[j].push_back({t_, t_ + 1});
            }
        }
        return acting_at(as_decided(model_, times), t_).model;
    }

private:
    const Model& model_;
    DecidedTimes times_;
    double t_;
};

std::string names_of(const Model& model, const std::vector<int>& joints)
{
    std::string names;
    for (const int j : joints) names += (names.empty() ? "'" : ", '") + model.joints()[j].name + "'";
    return names;
}

double fastest(const State& before, const Joint& stop)
{
    double size = 0;
    for (const Matrix34& V : before.V)
        size = std::max(size, norm(V.column(0)) + norm(directors(V)) * stop.rows[0].scale);
    return size;
}

}   // namespace

void check_stops(const Model& model, const State& start)
{
    constexpr double deepest = 1e-9;   // of the scale of its row
    for (const Joint& joint : model.joints()) {
        if (!is_stop(joint)) continue;
        const double depth = -gap_of(joint, start);
        if (depth > deepest * joint.rows[0].scale)
            throw InputError({"stop-violated", "joint[" + joint.name + "]",
                              "'" + joint.name + "' is passed where the motion begins", to_text(depth, 6), "",
                              "a stop lets nothing beyond it",
                              "begin on its open side, or change its limits"});
    }
}

ContactOutcome meet_joints(const Model& model, const Decisions& decisions, const State& reached,
                           const std::vector<int>& begins, double lowest_hop)
{
    const double t = reached.t;
    const HeldModels held_models(model, decisions, t);
    ContactOutcome outcome;
    outcome.V = reached.V;
    std::vector<int> both_ways, stops, closed;
    for (const int j : begins) (is_stop(model.joints()[j]) ? stops : both_ways).push_back(j);
    const std::size_t n_new = stops.size();
    for (int j = 0; j < static_cast<int>(model.joints().size()); ++j)
        if (is_stop(model.joints()[j]) && decisions.acts({EventAction::Does::end, j}, t)) stops.push_back(j);
    const auto joints_of = [&](const std::vector<int>& all) {
        std::vector<Joint> some;
        for (const int j : all) some.push_back(model.joints()[j]);
        return some;
    };
    const auto no_velocities = [&](const std::string& why) {
        outcome.refused = names_of(model, begins) + " at " + to_text(t, 6) + " s: " + why;
        return outcome;
    };
    if (stops.size() > most_stops_at_once)
        return no_velocities("more than " + std::to_string(most_stops_at_once) + " stops touch at once");
    const std::vector<Joint> all_stops = joints_of(stops);
    std::vector<int> hit;
    for (std::size_t k = 0; k < n_new; ++k) {
        const double speed = speed_apart(all_stops[k], reached);
        if (speed < -no_speed * fastest(reached, all_stops[k])) hit.push_back(stops[k]);
    }
    const bool is_named =
        std::ranges::all_of(hit, [&](int j) { return model.joints()[j].impact->goes_together; });
    if (hit.size() > 1 && !is_named)
        return no_velocities(names_of(model, hit) +
                             " are hit at the same instant, where what happens is a law of its own "
                             "(impact-simultaneous); state that they go together, by Moreau's law");
    const Model held = held_models.with(both_ways, {});
    if (!hit.empty() || !both_ways.empty()) {
        const ImpactOutcome found = impact(held, reached, all_stops);
        if (!found.is_found)
            return no_velocities("no velocities behind the impact fulfil the joints: they lose rank there");
        outcome.V = found.V;
        outcome.jumps = true;
        for (const int j : both_ways) outcome.begun.push_back({j, 0, 0, true, true, t});
        for (std::size_t k = 0; k < stops.size(); ++k) {
            const StopImpact& one = found.stops[k];
            if (k < n_new)
                outcome.begun.push_back({stops[k], one.impulse, std::max(-one.approach, 0.0),
                                         std::ranges::find(hit, stops[k]) != hit.end(), false, t});
            else if (one.impulse == 0 && one.apart > no_speed * fastest(reached, all_stops[k]))
                outcome.opens.push_back(stops[k]);
            else
                closed.push_back(stops[k]);
        }
    } else {
        for (std::size_t k = 0; k < n_new; ++k) outcome.begun.push_back({stops[k], 0, 0, false, false, t});
        closed.assign(stops.begin() + static_cast<std::ptrdiff_t>(n_new), stops.end());
    }
    State behind = reached;
    behind.V = outcome.V;
    for (Contact& one : outcome.begun) {
        const Joint& stop = model.joints()[one.joint];
        if (!is_stop(stop)) continue;
        const double apart = one.is_hit ? stop.impact->restitution * one.approach : speed_apart(stop, behind),
                     together = -acceleration_apart(stop, held_models.with(both_ways, closed), behind);
        if (!(together > 0) || apart < -no_speed * fastest(behind, stop)) continue;   // nothing presses
        const double rebound = std::max(apart, 0.0), e = stop.impact->restitution;
        one.closes = rebound * rebound < 2 * together * lowest_hop * stop.rows[0].scale ||
                     rebound <= no_speed * fastest(reached, stop);
        if (!one.closes) continue;
        if (one.is_hit && e < 1) one.rests_at = t + 2 * rebound / (together * (1 - e));
    }
    // What rests moves no more: velocities that closed stops leave.
    std::vector<int> resting = closed;
    for (const Contact& one : outcome.begun)
        if (one.closes && is_stop(model.joints()[one.joint])) resting.push_back(one.joint);
    if (!resting.empty() && outcome.jumps) {
        const ImpactOutcome still = impact(held_models.with(both_ways, resting), behind, {});
        if (still.is_found) outcome.V = still.V;
    }
    return outcome;
}

}   // namespace livens::inline spacetime_internal
