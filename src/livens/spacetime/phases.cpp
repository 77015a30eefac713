// SPDX-License-Identifier: BSD-3-Clause
// Motions over events: joints and drives that act for a part of the time divide it into phases, each with a
// model of its own. theory.md, "Drives", Events, says what goes on and what must meet.
#include "livens/spacetime/phases.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/diagnostics/largest.h"
#include "livens/diagnostics/sample.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/accuracy/until_accurate.h"
#include "livens/spacetime/march/window_notes.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr double first_phase_share = 0.3, phase_target = 0.3;   // of the accuracy
constexpr int most_phase_tries = 4;

std::vector<double> events_inside(const Model& model, double start, double end)
{
    const double gap = nearest_ends * (end - start);
    std::vector<double> inside;
    for (const double t : model.events())
        if (t > start + gap && t < end - gap) inside.push_back(t);
    return inside;
}

/// Start, end, and what is between them where joints begin or end to act; of a mesh its element ends.
std::vector<double> phase_ends(const Model& model, const Time& time)
{
    const double start = start_of(time), end = end_of(time);
    std::vector<double> ends{start};
    for (const double t : events_inside(model, start, end)) {
        double at = t;
        if (const auto* mesh = std::get_if<TimeMesh>(&time))
            // A mesh has merged near instants; the phase ends where the element does.
            at = *std::ranges::min_element(mesh->ends, {}, [t](double e) { return std::abs(e - t); });
        if (at > ends.back() && at < end) ends.push_back(at);
    }
    ends.push_back(end);
    return ends;
}

Time part_of(const Time& time, double first, double last, double accuracy)
{
    const auto inside = [&](const std::vector<double>& all) {
        std::vector<double> some;
        for (const double t : all)
            if (t >= first && t <= last) some.push_back(t);
        return some;
    };
    if (const auto* mesh = std::get_if<TimeMesh>(&time))
        return TimeMesh{inside(mesh->ends), inside(mesh->required)};
    return Span{first, last, accuracy, inside(std::get<Span>(time).output)};
}

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

/// The motion with the multipliers of the whole model's rows.
void widen(Motion& motion, const Model& model, const ActingModel& acting)
{
    const std::size_t n_elements = static_cast<std::size_t>(motion.n_elements());
    motion.n_rows = model.n_rows();
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

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more, std::size_t from)
{
    to.insert(to.end(), more.begin() + static_cast<std::ptrdiff_t>(from), more.end());
}

/// One motion after the other, which begins where it ended. Where they meet the state is that of the first,
/// and each has its side of what has two.
void join(Motion& whole, Motion&& next)
{
    if (whole.mesh.ends.empty()) {
        whole = std::move(next);
        return;
    }
    const auto bodies = static_cast<std::size_t>(whole.n_bodies),
               rows = static_cast<std::size_t>(whole.n_rows);
    append(whole.mesh.ends, next.mesh.ends, 1);
    append(whole.mesh.required, next.mesh.required, 0);
    append(whole.mesh.bends, next.mesh.bends, 0);
    // The first node of the next phase is the last of this one, and is kept once.
    append(whole.X.values, next.X.values, static_cast<std::size_t>(whole.X.n_values));
    append(whole.multipliers.values, next.multipliers.values, 0);
    append(whole.velocities, next.velocities, bodies);
    append(whole.momenta, next.momenta, bodies);
    if (!whole.accelerations.empty()) {
        whole.accelerations.resize(whole.accelerations.size() - bodies);
        append(whole.accelerations, next.accelerations, bodies);
    }
    if (!whole.end_multipliers.empty()) {
        whole.end_multipliers.resize(whole.end_multipliers.size() - rows);
        append(whole.end_multipliers, next.end_multipliers, rows);
    }
    const std::size_t ends = next.mesh.ends.size();
    append(whole.load_angles, next.load_angles, next.load_angles.size() / ends);
    for (const int row : next.redundant_rows)
        if (std::ranges::find(whole.redundant_rows, row) == whole.redundant_rows.end())
            whole.redundant_rows.push_back(row);
    std::ranges::sort(whole.redundant_rows);
}

}   // namespace

ActivationMismatch activation_mismatch(const Model& model, const Motion& motion, int end)
{
    ActivationMismatch miss;
    const double t = motion.mesh.ends[end], gap = nearest_ends * (motion.end() - motion.start());
    const bool begins = std::ranges::any_of(
        model.joints(), [&](const Joint& joint) { return std::abs(joint.from - t) <= gap; });
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
        raise_to(miss.speed, norm(dV.column(0)) / model.length());
        raise_to(miss.spin, norm(directors(dV)) / std::numbers::sqrt2);
    }
    return miss;
}

namespace {

std::string names_of(const Model& model, double t, double Joint::*when, double gap)
{
    std::string names;
    for (const Joint& joint : model.joints())
        if (std::abs(joint.*when - t) <= gap) names += (names.empty() ? "'" : ", '") + joint.name + "'";
    return names;
}

class Chain {
public:
    Chain(const Model& model, const Problem& problem, const Time& time, const SolveOptions& options,
          const SolvePhase& solve_phase)
        : model_(model), problem_(problem), time_(time), options_(options), solve_phase_(solve_phase),
          ends_(phase_ends(model, time)), gap_(nearest_ends * (ends_.back() - ends_.front()))
    {
        options_.judge = false;
        options_.growth = false;   // of a part from its own start: it says nothing of the whole
    }

    /// All phases, as far as they go.
    Solution solve(Method method, double accuracy, double tolerance_of_meeting) const
    {
        Solution whole;
        Problem problem = problem_;
        SolveOptions options = options_;
        for (std::size_t k = 0; k + 1 < ends_.size(); ++k) {
            const double first = ends_[k], last = ends_[k + 1];
            const ActingModel acting = acting_at(model_, 0.5 * (first + last));
            if (k > 0 && !meet(whole.motion, tolerance_of_meeting, whole.report)) return whole;
            Solution next = solve_next(acting, problem, first, last, accuracy, method, options);
            if (k > 0)
                for (std::string& note : next.report.notes)
                    if (std::ranges::find(whole.report.notes, note) == whole.report.notes.end())
                        note = "from " + to_text(first, 6) + " s on: " + note;
            if (next.motion.mesh.ends.empty()) {
                whole.report += std::move(next.report);
                whole.cannot_begin = std::move(next.cannot_begin);
                return whole;
            }
            method = next.method;   // what was open is chosen once
            if (next.report.status == SolveStatus::inaccurate && next.motion.end() == last) {
                next.report.status = SolveStatus::converged;   // the whole is judged, not a part of it
                next.report.message.clear();
            }
            widen(next.motion, model_, acting);
            whole.method = next.method;
            whole.estimate_seconds += next.estimate_seconds;
            whole.report += std::move(next.report);
            join(whole.motion, std::move(next.motion));
            if (!whole.report.converged()) return whole;
            if (k + 2 == ends_.size()) break;
            problem.conditions.start = whole.motion.at_end(whole.motion.n_elements());
            options.initial = StartPolicy::project;   // an end state holds its joints to rounding
        }
        return whole;
    }

    /// What joints did when they let go, told once.
    void tell(Solution& solution) const
    {
        for (std::size_t k = 1; k + 1 < ends_.size(); ++k) {
            if (ends_[k] >= solution.motion.end()) return;
            const std::vector<JointSample> at = sample_joints(model_, solution.motion, ends_[k]);
            for (std::size_t j = 0; j < at.size(); ++j) {
                const Joint& joint = model_.joints()[j];
                if (!(std::abs(joint.until - ends_[k]) <= gap_)) continue;
                solution.report.notes.push_back("'" + joint.name + "' is released at " +
                                                to_text(ends_[k], 6) + " s, with a reaction of " +
                                                to_text(norm(at[j].left.force), 3) + " N and " +
                                                to_text(norm(at[j].left.torque), 3) +
                                                " N m; velocities, momenta and energy go on without a jump");
            }
        }
    }

private:
    /// A joint that begins where bodies are elsewhere, or move otherwise, would be an impact.
    bool meet(const Motion& so_far, double tolerance, SolveReport& report) const
    {
        const double t = so_far.end();
        const std::string names = names_of(model_, t, &Joint::from, gap_);
        if (names.empty() || std::isinf(tolerance)) return true;
        const ActivationMismatch miss = activation_mismatch(model_, so_far, so_far.n_elements());
        // Velocities that must meet are compared with the fastest rate of the motion, and with one over its
        // duration at least.
        double fastest = 1 / (ends_.back() - ends_.front());
        for (const Matrix34& V : so_far.velocities)
            raise_to(fastest, std::max(norm(V.column(0)) / model_.length(), norm(directors(V))));
        if (std::max(miss.shift, miss.turn) <= tolerance &&
            std::max(miss.speed, miss.spin) <= tolerance * fastest)
            return true;
        const bool is_near = std::isfinite(miss.shift);
        report.status = SolveStatus::not_converged;
        report.failed_at = t;
        report.message =
            names + " begins to act at " + to_text(t, 6) +
            " s, where bodies are, or move, otherwise than it holds them (" +
            (is_near ? "off by " + to_text(miss.shift * model_.length(), 2) + " m, " + to_text(miss.turn, 2) +
                           " rad, " + to_text(miss.speed * model_.length(), 2) + " m/s, " +
                           to_text(miss.spin, 2) + " rad/s"
                     : std::string("no place near fits")) +
            "): livens knows no impacts; try: a law that meets position and rate there, or shorter elements "
            "if they are meant to meet";
        return false;
    }

    /// A phase that cannot begin leaves what was solved before it.
    Solution solve_next(const ActingModel& acting, const Problem& problem, double first, double last,
                        double accuracy, const Method& method, const SolveOptions& options) const
    {
        const Time part = part_of(time_, first, last, accuracy);
        const auto solve = [&] { return solve_phase_(acting.model, problem, part, method, options); };
        if (first == ends_.front()) return solve();
        try {
            Solution next = solve();
            if (std::exchange(next.cannot_begin, {}))
                next.report.message = "behind the event at " + to_text(first, 6) +
                                      " s the motion cannot begin: " + next.report.message;
            return next;
        } catch (const Stopped&) {
            Solution none;
            none.method = method;
            none.report.failed_at = first;
            none.report.status = SolveStatus::cancelled;
            none.report.message = of_stop(first);
            return none;
        }
    }

    const Model& model_;
    const Problem& problem_;
    const Time& time_;
    SolveOptions options_;
    const SolvePhase& solve_phase_;
    std::vector<double> ends_;
    double gap_;
};

/// Phases to a share of the accuracy each, until the whole is within.
class PhasesToAccuracy final : public RepeatedMarch {
public:
    PhasesToAccuracy(const Chain& chain, const Model& model, const Problem& problem, const Span& span,
                     const Method& method, const SolveOptions& options)
        : chain_(chain), model_(model), problem_(problem), method_(method), options_(options),
          accuracy_(span.accuracy), share_(first_phase_share * span.accuracy)
    {
        options_.growth = false;   // of the whole motion once, when it is accepted
    }

    Solution solve() override
    {
        Solution whole = chain_.solve(method_, share_, std::max(options_.meeting, accuracy_));
        if (whole.report.converged()) estimate(model_, problem_, whole.method, options_, whole);
        return whole;
    }

    AfterTry judge(Solution& whole, int tries) override
    {
        const ErrorEstimate& found = whole.estimate;
        if (whole.report.status == SolveStatus::inaccurate)   // a phase, whose message has its own accuracy
            whole.report.message += "; this is the share of a phase in the accuracy " +
                                    to_text(accuracy_, 6) + " that is asked for over events";
        if (!whole.report.converged() || (!found.empty() && found.largest <= accuracy_))
            return AfterTry::accept;
        if (found.empty() || tries == most_phase_tries) return AfterTry::give_up;
        // errors of phases add up and grow by factors that nobody knows beforehand; the measured one tells
        share_ *= std::min(0.3, phase_target * accuracy_ / found.largest);
        return AfterTry::again;
    }

    std::string why_not(const Solution&) const override { return "over events, with ever shorter elements"; }

private:
    const Chain& chain_;
    const Model& model_;
    const Problem& problem_;
    const Method& method_;
    SolveOptions options_;
    double accuracy_, share_;
};

}   // namespace

void check_events(const Model& model, const Problem& problem, const Time& time, const Method& method)
{
    if (!model.has_events()) return;
    if (!is_nodal(method) || problem.conditions.at_start != Known::state)
        throw InputError({"joint-time-method", is_nodal(method) ? "end.given" : "method.family",
                          "joints and drives that act for a part of the time need lobatto or radau, and the "
                          "state at the start",
                          name_of(method), "", "what a joint did cannot be undone from the end of time",
                          "leave 'from' and 'until' out, or choose lobatto and the state at the start"});
    const auto* mesh = std::get_if<TimeMesh>(&time);
    if (mesh == nullptr) return;
    const std::vector<double> late = missed(*mesh, events_inside(model, mesh->start(), mesh->end()));
    if (!late.empty())
        throw InputError({"joint-time-mesh", "time.elements",
                          "a joint or drive begins or ends to act inside an element", to_text(late[0]) + " s",
                          "an element end", "elements follow one set of joints each",
                          "let elements end there"});
}

Solution solve_by_phases(const Model& model, const Problem& problem, const Time& time, const Method& method,
                         const SolveOptions& options, const SolvePhase& solve_phase)
{
    const Chain chain(model, problem, time, options, solve_phase);
    Solution solution;
    if (const auto* span = std::get_if<Span>(&time)) {
        PhasesToAccuracy phases(chain, model, problem, *span, method, options);
        solution = until_accurate(phases, model, span->accuracy, span->end);
    } else {
        solution = chain.solve(method, 0, options.meeting);
    }
    if (!std::isinf(options.meeting)) chain.tell(solution);
    return solution;
}

}   // namespace livens::inline spacetime_internal
