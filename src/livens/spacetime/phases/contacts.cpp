// SPDX-License-Identifier: BSD-3-Clause
// docs/theory.md, "Impacts".
#include "livens/spacetime/phases/contacts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/dynamics/instant/impact.h"
#include "livens/spacetime/phases/event_watch.h"

namespace livens::inline spacetime_internal {

namespace {

/// Of the fastest: slower than that bodies are together.
constexpr double no_speed = 1e-12;

bool is_stop(const Joint& joint) { return joint.impact && joint.impact->open_side != 0; }

/// A mechanism at an instant: the joints that hold both ways, with others that are chosen.
class HeldMechanism {
public:
    HeldMechanism(const Model& model, const Decisions& decisions, const State& reached)
        : model_(model), times_(decisions.times()), reached_(reached)
    {}

    /// `begins`: joints that act from now on as well; of stops those that are chosen alone.
    SettledInstant& with(const std::vector<int>& begins, const std::vector<int>& stops)
    {
        if (instant_ && begins == begins_ && stops == chosen_) return *instant_;
        begins_ = begins;
        chosen_ = stops;
        DecidedTimes times = times_;
        const double t = reached_.t;
        for (std::size_t j = 0; j < times.joints.size(); ++j) {
            const int joint = static_cast<int>(j);
            const auto is_among = [&](const std::vector<int>& all) {
                return std::ranges::find(all, joint) != all.end();
            };
            if (is_stop(model_.joints()[joint])) {
                times.joints[j].clear();
                if (is_among(stops)) times.joints[j].push_back({t, t + 1});
            } else if (is_among(begins)) {
                times.joints[j].push_back({t, t + 1});
            }
        }
        instant_.reset();
        held_.emplace(acting_at(as_decided(model_, times), t).model);
        return instant_.emplace(*held_, most_rows(*held_, std::span(&reached_, 1)));
    }

private:
    const Model& model_;
    DecidedTimes times_;
    const State& reached_;
    std::vector<int> begins_, chosen_;   // of the last
    std::optional<Model> held_;
    std::optional<SettledInstant> instant_;
};

std::string names_of(const Model& model, const std::vector<int>& joints)
{
    std::string names;
    std::vector<int> told;
    for (const int j : joints) {
        if (std::ranges::find(told, j) != told.end()) continue;
        told.push_back(j);
        names += (names.empty() ? "'" : ", '") + model.joints()[j].name + "'";
    }
    return names;
}

double fastest(const State& before, const Joint& stop)
{
    double size = 0;
    for (const Matrix34& V : before.V)
        size = std::max(size, norm(V.column(0)) + norm(directors(V)) * stop.rows[0].scale);
    return size;
}

/// Of the joints that begin at a state: stops behind those that hold both ways.
class Meeting {
public:
    Meeting(const Model& model, const Decisions& decisions, const State& reached,
            const std::vector<int>& begins)
        : model_(model), held_(model, decisions, reached), before_(reached), begins_(begins)
    {
        outcome_.V = reached.V;
        for (const int j : begins) (is_stop(model.joints()[j]) ? stops_ : both_ways_).push_back(j);
        n_new_ = stops_.size();
        for (int j = 0; j < static_cast<int>(model.joints().size()); ++j)
            if (is_stop(model.joints()[j]) && decisions.acts({EventAction::Does::end, j}, reached.t))
                stops_.push_back(j);
        for (std::size_t k = 0; k < n_new_; ++k)
            if (speed_apart(stop(k), reached) < -no_speed * fastest(reached, stop(k)))
                hit_.push_back(stops_[k]);
    }

    ContactOutcome outcome(double lowest_hop)
    {
        if (strike()) {
            close(lowest_hop);
            settle();
        }
        return std::move(outcome_);
    }

private:
    const Joint& stop(std::size_t k) const { return model_.joints()[stops_[k]]; }
    bool is_hit(int joint) const { return std::ranges::find(hit_, joint) != hit_.end(); }
    bool refuse(const std::string& why)
    {
        outcome_.refused = why;
        return false;
    }

    /// Velocities behind the impact, and what it was for each. False: there are none.
    bool strike()
    {
        if (stops_.size() > most_stops_at_once)
            return refuse("more than " + std::to_string(most_stops_at_once) + " stops touch at once at " +
                          to_text(before_.t, 6) + " s");
        ImpactOutcome found;
        if (!hit_.empty() || !both_ways_.empty()) {
            std::vector<Joint> all;
            for (const int j : stops_) all.push_back(model_.joints()[j]);
            found = impact(held_.with(both_ways_, {}), before_, all);
            if (!found.is_found)
                return refuse("no velocities behind the impact of " + names_of(model_, begins_) + " at " +
                              to_text(before_.t, 6) + " s fulfil the joints, which lose rank there");
            bool is_handed_on = false;   // by bodies that touched without moving together
            for (std::size_t k = 0; k < n_new_; ++k)
                if (found.stops[k].impulse > 0 && !is_hit(stops_[k])) {
                    hit_.push_back(stops_[k]);
                    is_handed_on = true;
                }
            const bool is_named =
                std::ranges::all_of(hit_, [&](int j) { return model_.joints()[j].impact->goes_together; });
            if (hit_.size() > 1 && (!found.are_apart || is_handed_on) && !is_named)
                return refuse(names_of(model_, hit_) + " are hit at the same instant, " +
                              to_text(before_.t, 6) +
                              " s, and feel each other: what happens is a law of its own, which they have to "
                              "name (all at once, by Moreau's law)");
            outcome_.V = found.V;
            outcome_.jumps = true;
        } else {
            found.stops.resize(stops_.size());
        }
        for (const int j : both_ways_) outcome_.begun.push_back({j, 0, 0, true, true, before_.t});
        for (std::size_t k = 0; k < stops_.size(); ++k) {
            const StopImpact& one = found.stops[k];
            const bool leaves = one.impulse == 0 && one.apart > no_speed * fastest(before_, stop(k));
            if (k < n_new_)
                outcome_.begun.push_back({stops_[k], one.impulse, std::max(-one.approach, 0.0),
                                          is_hit(stops_[k]), false, before_.t});
            else
                (leaves ? outcome_.opens : resting_).push_back(stops_[k]);
        }
        return true;
    }

    /// Those of the new stops at which bodies stay.
    void close(double lowest_hop)
    {
        State behind = before_;
        behind.V = outcome_.V;
        std::vector<Joint> begun;
        for (const Contact& one : outcome_.begun) begun.push_back(model_.joints()[one.joint]);
        std::erase_if(begun, [](const Joint& joint) { return !is_stop(joint); });
        if (begun.empty()) return;
        const std::vector<double> accelerations =
            accelerations_apart(begun, held_.with(both_ways_, resting_), behind);
        auto acceleration = accelerations.begin();
        for (Contact& one : outcome_.begun) {
            const Joint& stop = model_.joints()[one.joint];
            if (!is_stop(stop)) continue;
            const double e = stop.impact->restitution, slow = no_speed * fastest(before_, stop),
                         apart = one.is_hit ? e * one.approach : speed_apart(stop, behind),
                         together = -*acceleration++;
            const double of_rounding = slow * fastest(before_, stop) / model_.length();
            if (!(together > of_rounding) || apart < -slow) continue;   // nothing presses
            const double rebound = std::max(apart, 0.0), hop = rebound * rebound / (2 * together);
            one.closes = hop < lowest_hop * stop.rows[0].scale || rebound <= slow;
            if (!one.closes) continue;
            if (one.is_hit && e < 1) one.rests_at = before_.t + 2 * rebound / (together * (1 - e));
            resting_.push_back(one.joint);
        }
    }

    /// What rests moves no more: velocities that closed stops leave.
    void settle()
    {
        if (resting_.empty() || !outcome_.jumps) return;
        State behind = before_;
        behind.V = outcome_.V;
        const ImpactOutcome still = impact(held_.with(both_ways_, resting_), behind, {});
        if (still.is_found) outcome_.V = still.V;
    }

    const Model& model_;
    HeldMechanism held_;
    const State& before_;
    const std::vector<int>& begins_;
    std::vector<int> both_ways_, stops_, hit_, resting_;   // stops: the new ones first
    std::size_t n_new_ = 0;
    ContactOutcome outcome_;
};

}   // namespace

std::vector<StopDepth> depths_of_stops(const Model& model, const State& start)
{
    std::vector<StopDepth> all;
    const auto closes = [&](const Event& event) {
        const Joint* joint = begun_by_impact(model, event.action);
        return joint != nullptr && is_stop(*joint);
    };
    if (std::ranges::none_of(model.events(), closes)) return all;
    // Conditions count turns; rows of angles are alike half a turn on.
    const EventWatch watch(model, acting_at(model, start.t), std::vector<bool>(model.events().size(), false),
                           start);
    for (std::size_t e = 0; e < model.events().size(); ++e) {
        const Event& event = model.events()[e];
        if (!closes(event)) continue;
        const double depth = watch.margin(static_cast<int>(e), watch.start());
        all.push_back({static_cast<int>(e), depth / model.joints()[event.action.joint].rows[0].scale});
    }
    return all;
}

void check_stops(const Model& model, const State& start)
{
    constexpr double deepest = 1e-9;
    for (const StopDepth& one : depths_of_stops(model, start)) {
        if (one.depth <= deepest) continue;
        const Joint& joint = model.joints()[model.events()[static_cast<std::size_t>(one.event)].action.joint];
        throw InputError({"stop-violated", "joint[" + joint.name + "]",
                          "'" + joint.name + "' is passed where the motion begins",
                          to_text(one.depth * joint.rows[0].scale, 6), "", "a stop lets nothing beyond it",
                          "begin on its open side, or change its limits"});
    }
}

std::vector<int> stops_beside(const Model& model, const Decisions& decisions, const std::vector<int>& events,
                              const State& reached)
{
    std::vector<int> found;
    for (int e = 0; !events.empty() && e < static_cast<int>(model.events().size()); ++e) {
        const EventAction& action = model.events()[static_cast<std::size_t>(e)].action;
        const Joint* joint = begun_by_impact(model, action);
        const bool is_other = joint != nullptr && is_stop(*joint) && decisions.is_armed(action, reached.t) &&
                              std::ranges::find(events, e) == events.end();
        if (is_other && std::abs(gap_of(*joint, reached)) <= touching_stop * joint->rows[0].scale)
            found.push_back(e);
    }
    if (found.empty()) return found;
    for (const StopDepth& one : depths_of_stops(model, reached))   // which knows turns
        if (std::abs(one.depth) > touching_stop) std::erase(found, one.event);
    return found;
}

double slope_of_row(const Event& event, const State& state)
{
    const std::vector<LawCoordinate>& all = event.terms.coordinates;
    if (all.size() == 3) {
        Vector3 line{};
        for (int i = 0; i < 3; ++i)
            line[i] = coordinate_value(all[static_cast<std::size_t>(i)].coordinate, state.X);
        return norm(line);
    }
    const bool is_sine = all.size() == 1 && all[0].coordinate.kind == CoordinateKind::arc_sine;
    return is_sine ? std::cos(coordinate_value(all[0].coordinate, state.X)) : 1;
}

/// 64 times what was touched, up to ten thousand times rounding; and four times what a body is beyond it by.
double slack_behind(const Model& model, const Event& event, const State& reached, double touched_with)
{
    constexpr double more = 64, most = 1e4, clear = 4;
    const double depth = -gap_of(model.joints()[event.action.joint], reached) / slope_of_row(event, reached);
    return std::max(
        {1.0, std::min(more * touched_with, most), clear * depth / rounding_of_stop(model, event)});
}

ContactOutcome meet_joints(const Model& model, const Decisions& decisions, const State& reached,
                           const std::vector<int>& begins, double lowest_hop)
{
    return Meeting(model, decisions, reached, begins).outcome(lowest_hop);
}

}   // namespace livens::inline spacetime_internal
