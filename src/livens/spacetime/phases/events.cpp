// SPDX-License-Identifier: BSD-3-Clause
// theory.md, "Drives", Events, says what goes on and what must meet.
#include "livens/spacetime/phases/events.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "livens/base/text.h"
#include "livens/diagnostics/largest.h"
#include "livens/diagnostics/sample.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/unwrapped_angles.h"

namespace livens::inline spacetime_internal {

namespace {

/// From rows of an acting model to all.
void spread(std::vector<double>& values, const std::vector<int>& rows, int n_rows)
{
    if (values.empty() && rows.size() > 0) return;
    const std::size_t n_sets = rows.empty() ? 0 : values.size() / rows.size();
    std::vector<double> all(n_sets * static_cast<std::size_t>(n_rows), 0.0);
    for (std::size_t set = 0; set < n_sets; ++set)
        for (std::size_t k = 0; k < rows.size(); ++k)
            // Rows that do not act have zero multipliers.
            all[set * static_cast<std::size_t>(n_rows) + static_cast<std::size_t>(rows[k])] =
                values[set * rows.size() + k];
    values = std::move(all);
}

template <class T>
void append_from(std::vector<T>& to, const std::vector<T>& more, std::size_t from)
{
    to.insert(to.end(), more.begin() + static_cast<std::ptrdiff_t>(from), more.end());
}

std::string names_of_beginning(const Model& model, double t, double gap)
{
    std::string names;
    for (const Joint& joint : model.joints())
        if (joint.begins_near(t, gap)) names += (names.empty() ? "'" : ", '") + joint.name + "'";
    return names;
}

/// Of an element: what is left of one behind an event is no element of its own.
constexpr double least_rest = 1e-3;

}   // namespace

Time part_of(const Time& time, double first, double last, double accuracy, double first_length)
{
    const double gap = nearest_ends * (end_of(time) - start_of(time));
    const auto inside = [&](const std::vector<double>& all) {
        std::vector<double> some;
        for (const double t : all)
            if (t > first + gap && t <= last) some.push_back(t);
        return some;
    };
    const auto* mesh = std::get_if<TimeMesh>(&time);
    if (mesh == nullptr)
        return Span{first, last, accuracy, inside(std::get<Span>(time).output), first_length};
    TimeMesh part{{first}, inside(mesh->required), inside(mesh->bends)};
    const std::vector<double> ends = inside(mesh->ends);
    const bool is_end = std::ranges::binary_search(mesh->ends, first);
    for (const double t : ends) {
        // Where an event came before a bend that was expected, that has been this event.
        const std::size_t next =
            static_cast<std::size_t>(std::ranges::upper_bound(mesh->ends, t) - mesh->ends.begin());
        const double length = next < mesh->ends.size() ? mesh->ends[next] - t : t - first;
        const bool is_met = std::ranges::binary_search(mesh->bends, t) && t - first < 0.5 * length;
        const bool is_rest =
            t - first < least_rest * length && t < last && !std::ranges::binary_search(mesh->required, t);
        if (part.ends.size() > 1 || is_end || (!is_met && !is_rest)) part.ends.push_back(t);
    }
    std::erase_if(part.bends, [&](double t) { return !std::ranges::binary_search(part.ends, t); });
    return part;
}

std::vector<double> events_inside(const Model& model, double start, double end)
{
    const double gap = nearest_ends * (end - start);
    std::vector<double> inside;
    for (const double t : model.event_times())
        if (t > start + gap && t < end - gap) inside.push_back(t);
    return inside;
}

std::vector<double> phase_ends(const Model& model, const Time& time)
{
    const double start = start_of(time), end = end_of(time), gap = nearest_ends * (end - start);
    std::vector<double> ends{start};
    const std::vector<double> breaks = model.load_breaks();
    for (const double t : events_inside(model, start, end)) {
        // Instants that rounding keeps apart are one, as 3 times 0.1 s and 0.3 s are: the first of them.
        double at = *std::ranges::lower_bound(breaks, t - gap);
        if (const auto* mesh = std::get_if<TimeMesh>(&time))
            // A mesh has merged near instants; the phase ends where the element does.
            at = *std::ranges::min_element(mesh->ends, {}, [t](double e) { return std::abs(e - t); });
        if (at > ends.back() && at < end) ends.push_back(at);
    }
    ends.push_back(end);
    return ends;
}

void widen(Motion& motion, const Model& model, const ActingModel& acting)
{
    const std::size_t n_elements = static_cast<std::size_t>(motion.n_elements());
    motion.n_rows = model.n_rows();
    // Angles that events count come last, and no one reads them later.
    const std::size_t n_ends = motion.mesh.ends.size(), n_angles = motion.load_angles.size() / n_ends,
                      n_kept = UnwrappedAngles(model).size();
    if (n_angles > n_kept) {
        std::vector<double> kept;
        for (std::size_t end = 0; end < n_ends; ++end)
            append_from(kept,
                        {motion.load_angles.begin() + static_cast<std::ptrdiff_t>(end * n_angles),
                         motion.load_angles.begin() + static_cast<std::ptrdiff_t>(end * n_angles + n_kept)},
                        0);
        motion.load_angles = std::move(kept);
    }
    spread(motion.multipliers.values, acting.rows, model.n_rows());
    spread(motion.end_multipliers, acting.rows, model.n_rows());
    if (acting.rows.empty()) {   // no row acts: the arrays were empty
        const auto n = static_cast<std::size_t>(model.n_rows());
        motion.multipliers.values.assign(
            n_elements * static_cast<std::size_t>(motion.multipliers.degree + 1) * n, 0.0);
        motion.end_multipliers.assign(2 * (n_elements + 1) * n, 0.0);
    }
    motion.multipliers.n_values = model.n_rows();
    for (int& row : motion.redundant_rows) row = acting.rows[row];
}

void join(Motion& whole, Motion&& next, bool jumps)
{
    if (whole.mesh.ends.empty()) {
        whole = std::move(next);
        return;
    }
    const auto bodies = static_cast<std::size_t>(whole.n_bodies),
               rows = static_cast<std::size_t>(whole.n_rows);
    if (jumps) {
        const auto move_last = [bodies](std::vector<Matrix34>& of_whole, const std::vector<Matrix34>& of_next,
                                        std::vector<Matrix34>& before) {
            const auto last = of_whole.end() - static_cast<std::ptrdiff_t>(bodies);
            before.insert(before.end(), last, of_whole.end());
            std::copy_n(of_next.begin(), bodies, last);
        };
        whole.impacts.ends.push_back(whole.n_elements());
        move_last(whole.momenta, next.momenta, whole.impacts.momenta);
        move_last(whole.velocities, next.velocities, whole.impacts.velocities);
    }
    append_from(whole.mesh.ends, next.mesh.ends, 1);
    append_from(whole.mesh.required, next.mesh.required, 0);
    append_from(whole.mesh.bends, next.mesh.bends, 0);
    // The first node of the next phase is the last of this one, and is kept once.
    append_from(whole.X.values, next.X.values, static_cast<std::size_t>(whole.X.n_values));
    append_from(whole.multipliers.values, next.multipliers.values, 0);
    append_from(whole.velocities, next.velocities, bodies);
    append_from(whole.momenta, next.momenta, bodies);
    if (!whole.accelerations.empty()) {
        whole.accelerations.resize(whole.accelerations.size() - bodies);
        append_from(whole.accelerations, next.accelerations, bodies);
    }
    if (!whole.end_multipliers.empty()) {
        whole.end_multipliers.resize(whole.end_multipliers.size() - rows);
        append_from(whole.end_multipliers, next.end_multipliers, rows);
    }
    const std::size_t ends = next.mesh.ends.size();
    append_from(whole.load_angles, next.load_angles, next.load_angles.size() / ends);
    for (const int row : next.redundant_rows)
        if (std::ranges::find(whole.redundant_rows, row) == whole.redundant_rows.end())
            whole.redundant_rows.push_back(row);
    std::ranges::sort(whole.redundant_rows);
}

void jump_at_end(Motion& motion, const Model& model, const std::vector<Matrix34>& V)
{
    const auto n = static_cast<std::ptrdiff_t>(V.size());
    motion.impacts.ends.push_back(motion.n_elements());
    for (auto [now, before] : {std::pair(&motion.momenta, &motion.impacts.momenta),
                               std::pair(&motion.velocities, &motion.impacts.velocities)})
        before->insert(before->end(), now->end() - n, now->end());
    for (std::ptrdiff_t b = 0; b < n; ++b) {
        *(motion.velocities.end() - n + b) = V[static_cast<std::size_t>(b)];
        *(motion.momenta.end() - n + b) =
            V[static_cast<std::size_t>(b)] * model.bodies()[static_cast<std::size_t>(b)].mass;
    }
}

/// Arrays of n parts by elements lose one of these, those by element ends one of n + 1.
void drop_last(Motion& motion)
{
    const auto n = static_cast<std::size_t>(motion.n_elements());
    const auto keep = [](auto& values, std::size_t a_part, std::size_t parts) {
        if (!values.empty()) values.resize(values.size() / parts * (parts - a_part));
    };
    motion.mesh.ends.pop_back();
    for (auto* some : {&motion.mesh.required, &motion.mesh.bends})
        std::erase_if(*some, [&](double t) { return t > motion.mesh.ends.back(); });
    const auto values = static_cast<std::size_t>(motion.X.n_values);
    motion.X.values.resize(motion.X.values.size() - values * static_cast<std::size_t>(motion.X.degree));
    keep(motion.multipliers.values, 1, n);
    keep(motion.velocities, 1, n + 1);
    keep(motion.momenta, 1, n + 1);
    keep(motion.accelerations, 1, n + 1);
    keep(motion.end_multipliers, 1, n + 1);
    keep(motion.load_angles, 1, n + 1);
}

ActivationMismatch activation_mismatch(const Model& model, const Motion& motion, int end)
{
    ActivationMismatch miss;
    const double t = motion.mesh.ends[end], gap = nearest_ends * (motion.end() - motion.start());
    bool begins = false, is_impact = false;
    for (const Joint& joint : model.joints()) {
        if (!joint.begins_near(t, gap)) continue;
        begins = true;
        is_impact = is_impact || joint.impact;
    }
    if (!begins) return miss;
    const State state = motion.at_end(end);
    // Just behind the event: the joints that begin are there, those that end are not.
    const ActingModel acting = acting_at(model, t + 0.5 * nearest_ends * (motion.end() - motion.start()));
    const TriedStart tried = try_consistent_start(acting.model, state, StartPolicy::project);
    if (!tried.closed)   // no place near holds them
        miss.shift = std::numeric_limits<double>::infinity();
    for (std::size_t b = 0; tried.closed && b < state.X.size(); ++b) {
        const State& closed = tried.closed->start;
        const Matrix34 dX = closed.X[b] - state.X[b], dV = closed.V[b] - state.V[b];
        raise_to(miss.shift, norm(dX.column(0)) / model.length());
        raise_to(miss.turn, norm(directors(dX)) / std::numbers::sqrt2);
        if (is_impact) continue;   // it changes velocities
        raise_to(miss.speed, norm(dV.column(0)) / model.length());
        raise_to(miss.spin, norm(directors(dV)) / std::numbers::sqrt2);
    }
    return miss;
}

bool is_met(const Model& model, const Motion& motion, int end, double duration, double tolerance,
            SolveReport& report)
{
    const double t = motion.mesh.ends[end];
    const std::string names = names_of_beginning(model, t, nearest_ends * duration);
    if (names.empty() || std::isinf(tolerance)) return true;
    const ActivationMismatch miss = activation_mismatch(model, motion, end);
    // Velocities that must meet are compared with the fastest rate of the motion so far, and with one over
    // its duration at least.
    double fastest = 1 / duration;
    const auto n = static_cast<std::size_t>(motion.n_bodies) * (static_cast<std::size_t>(end) + 1);
    for (std::size_t i = 0; i < std::min(n, motion.velocities.size()); ++i)
        raise_to(fastest, std::max(norm(motion.velocities[i].column(0)) / model.length(),
                                   norm(directors(motion.velocities[i]))));
    if (std::max(miss.shift, miss.turn) <= tolerance &&
        std::max(miss.speed, miss.spin) <= tolerance * fastest)
        return true;
    const bool is_near = std::isfinite(miss.shift);
    report.status = SolveStatus::not_converged;
    report.failed_at = t;
    report.message =
        names + " begins to act at " + to_text(t, 6) +
        " s, where bodies are, or move, otherwise than it holds them (" +
        (is_near ? "off by " + to_text(miss.shift * model.length(), 2) + " m, " + to_text(miss.turn, 2) +
                       " rad, " + to_text(miss.speed * model.length(), 2) + " m/s, " + to_text(miss.spin, 2) +
                       " rad/s"
                 : std::string("no place near fits")) +
        "); try: a restitution of the joint if this is an impact, a law that meets position and rate there, "
        "or "
        "shorter elements if they are meant to meet";
    return false;
}

std::string begin_in_words(const Model& model, double start, double end)
{
    std::string words;
    for (const double t : events_inside(model, start, end))
        if (const std::string names = names_of_beginning(model, t, 0); !names.empty())
            words += (words.empty() ? "" : ", ") + names + " begins to act at " + to_text(t, 6) + " s";
    return words;
}

void date_notes(const std::vector<std::string>& known, double t, std::vector<std::string>& notes)
{
    for (std::string& note : notes)
        if (std::ranges::find(known, note) == known.end()) note = "from " + to_text(t, 6) + " s on: " + note;
}

std::string of_storm(const Model& model, const std::vector<SolvedEvent>& events, std::size_t n, double t)
{
    const std::string last =
        events.empty() ? "" : model.events()[static_cast<std::size_t>(events.back().event)].name;
    return "events follow each other without an end: " + std::to_string(n) + " so far, the last of them '" +
           last + "' at " + to_text(t, 9) +
           " s; try: conditions that leave some way between what begins and what ends";
}

void tell_releases(const Model& model, const Motion& motion, const std::vector<double>& ends,
                   SolveReport& report)
{
    const double gap = nearest_ends * (ends.back() - ends.front());
    for (std::size_t k = 1; k + 1 < ends.size(); ++k) {
        if (ends[k] >= motion.end()) return;
        const std::vector<JointSample> at = sample_joints(model, motion, ends[k]);
        for (std::size_t j = 0; j < at.size(); ++j) {
            const Joint& joint = model.joints()[j];
            const bool is_stop = joint.impact && joint.impact->open_side != 0;   // told as an event
            if (is_stop || !joint.ends_near(ends[k], gap)) continue;
            report.notes.push_back("'" + joint.name + "' is released at " + to_text(ends[k], 6) +
                                   " s, with a reaction of " + to_text(norm(at[j].left.force), 3) +
                                   " N and " + to_text(norm(at[j].left.torque), 3) +
                                   " N m; velocities, momenta and energy go on without a jump");
        }
    }
}

}   // namespace livens::inline spacetime_internal
