// SPDX-License-Identifier: BSD-3-Clause
// What the motion decides is asked of states at element ends, which have the order of the method, and never
// of the polynomials between them: docs/theory.md, "Events".
#include "livens/spacetime/phases/event_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "livens/base/text.h"
#include "livens/diagnostics/largest.h"
#include "livens/dynamics/instant/reactions.h"

namespace livens::inline spacetime_internal {

namespace {

/// Of an element: so far behind an instant a condition has changed that changes there.
constexpr double behind = 1e-6;
/// Elements of which the longest tells how far that is.
constexpr int recent = 32;
/// Of the scale of its row: what leaves a stop, or slides along it, is beyond it by rounding.
constexpr double beyond_stop = 1e-14;
/// Of an element: so far ahead the state has what the polynomial has at its end.
constexpr double at_once = 0.05;

std::vector<double> numbers_of(const std::vector<Matrix34>& all)
{
    std::vector<double> numbers;
    numbers.reserve(12 * all.size());
    for (const Matrix34& one : all) numbers.insert(numbers.end(), std::begin(one.a), std::end(one.a));
    return numbers;
}

/// Of reactions that an event asks for: why one of them is not unique.
std::optional<Complaint> why_shared(const Model& model, const ActingModel& acting, const ModelTables& tables,
                                    const Event& event, const State& start)
{
    const Model now = frozen(acting.model, {start.t});
    const std::vector<double> none(static_cast<std::size_t>(now.n_rows()), 0.0);
    const UniqueReactions found = least_reactions(now, start.X, none, tables.independent);
    for (const ReactionInput& input : event.terms.reactions) {
        const auto at = std::ranges::find(acting.joints, input.joint);
        const auto j = static_cast<std::size_t>(at - acting.joints.begin());
        if (at == acting.joints.end() || found.joint_is_unique[j]) continue;
        return Complaint{
            "event-reaction",
            "event[" + event.name + "]",
            "'" + event.name + "' asks for a reaction of joint '" + model.joints()[input.joint].name +
                "' that is not unique: other joints could carry " + livens::in_words(found.shared[j]),
            "",
            "",
            "bodies are held more often than they need to be",
            "let joints hold what they must and no more, as a spherical joint in place of a "
            "revolute one"};
    }
    return {};
}

}   // namespace

double rounding_of_stop(const Model& model, const Event& event)
{
    const bool is_distance = event.terms.coordinates.size() == 3;   // the row has squares
    return beyond_stop * (is_distance ? model.length() : model.joints()[event.action.joint].rows[0].scale);
}

EventWatch::EventWatch(const Model& model, ActingModel acting, std::vector<bool> armed, const State& start,
                       double last, const std::vector<double>& slacks)
    : whole_(model), acting_(std::move(acting)), armed_(std::move(armed)), start_(start), times_{last},
      first_watch_(static_cast<int>(acting_.model.loads().size())),
      slack_(std::make_shared<std::vector<double>>(model.events().size()))
{
    take(slacks);
    const auto reads_reactions = [](const Event& event) { return !event.terms.reactions.empty(); };
    if (std::ranges::any_of(model.events(), reads_reactions)) {
        // A copy: what solves for reactions does not see who asks for them.
        mechanism_model_ = std::make_shared<const Model>(acting_.model);
        mechanism_ = std::make_shared<SettledInstant>(*mechanism_model_,
                                                      most_rows(*mechanism_model_, std::span(&start, 1)));
    }
    const State places = model.start();
    const std::vector<JointCoordinate> counted = [&] {
        std::vector<JointCoordinate> all;
        for (const Load& load : acting_.model.loads())
            all.insert(all.end(), load.angles.begin(), load.angles.end());
        return all;
    }();
    for (const Event& event : model.events()) {
        Load watch = watching(event, reactions_of(event), model.n_bodies(), Configurations(places.X));
        // Loads that follow turns are asked for reactions, too.
        if (reads_reactions(event)) watch.angles.insert(watch.angles.end(), counted.begin(), counted.end());
        while (
            std::ranges::any_of(acting_.model.loads(), [&](const Load& l) { return l.name == watch.name; }))
            watch.name += "'";
        const int e = static_cast<int>(acting_.model.loads().size()) - first_watch_;
        if (slack(e) > 0)
            watch.guarded = [exact = watch.guarded, all = slack_, e](const LoadArguments& at,
                                                                     std::span<double> out) {
                exact(at, out);
                out[0] -= (*all)[e];
            };
        // Where nothing would happen nothing is looked for: what a closed stop holds is near its border
        // always.
        if (!armed_[e]) watch.guards.clear();
        acting_.model.add_load(std::move(watch));
    }
    loads_ = std::make_unique<LoadTables>(acting_.model);
    start_.angles.resize(loads_->turns.size(), 0.0);
}

void EventWatch::begin_again(const State& start, const std::vector<double>& slacks)
{
    start_ = start;
    start_.angles.resize(loads_->turns.size(), 0.0);
    take(slacks);
    lost_ = -1;
    held_ = {};
}

void EventWatch::take(const std::vector<double>& slacks)
{
    for (int e = 0; e < static_cast<int>(whole_.events().size()); ++e) {
        const auto at = static_cast<std::size_t>(e);
        (*slack_)[at] = is_open_stop(e) ? rounding_of_stop(whole_, whole_.events()[at]) : 0;
        if (!slacks.empty()) (*slack_)[at] *= slacks[at];
    }
}

std::function<void(const LoadArguments&, std::span<double>)> EventWatch::reactions_of(const Event& event)
{
    if (event.terms.reactions.empty()) return {};
    if (!refusal_) refusal_ = why_shared(whole_, acting_, mechanism_->tables(), event, start_);
    std::vector<ReactionInput> inputs = event.terms.reactions;
    const std::size_t n_counted = UnwrappedAngles(acting_.model).size();
    return [mechanism = mechanism_, model = mechanism_model_, joints = acting_.joints, inputs, n_counted,
            last = times_.last](const LoadArguments& at, std::span<double> numbers) {
        const bool is_over = at.at.t >= last;   // the looks behind the end, too
        State state{is_over ? last : at.at.t, {}, {}};
        for (std::size_t b = 0; b < at.X.size(); ++b) {
            if (b == 1) continue;   // the world
            state.X.push_back(at.X[b]);
            state.V.push_back(at.V[b]);
        }
        std::vector<double> angles;
        if (at.angles.size() >= n_counted) angles.assign(at.angles.end() - n_counted, at.angles.end());
        const Side side = is_over || at.at.side == Side::left ? Side::left : Side::right;
        const bool is_known = mechanism->accelerate(state, angles, side);
        for (std::size_t k = 0; k < inputs.size(); ++k) {
            const auto j = std::ranges::find(joints, inputs[k].joint);
            numbers[k] = j == joints.end() ? 0.0 : std::numeric_limits<double>::quiet_NaN();
            if (j == joints.end() || !is_known) continue;
            const int index = static_cast<int>(j - joints.begin());
            const double* multiplier = mechanism->multipliers(side).data() + model->first_row(index);
            if (inputs[k].is_multiplier) {
                numbers[k] = *multiplier;
                continue;
            }
            const Joint& joint = model->joints()[static_cast<std::size_t>(index)];
            Matrix34 F{};
            for (const ConstraintRow& row : joint.rows)
                F -= *multiplier++ *
                     constraint_gradient(frozen(row, {state.t, side}), state.X).of(joint.second);
            numbers[k] = number_of(joint_reaction(joint, state.X[joint.second], F), inputs[k]);
        }
    };
}

/// Without the slack that the guard of an open stop has taken off, for which elements end.
std::vector<double> EventWatch::terms_at(int event, const State& state, Side side) const
{
    const Load& watch = acting_.model.loads()[first_watch_ + event];
    std::vector<double> angles = state.angles,
                        terms(static_cast<std::size_t>(
                            whole_.events()[static_cast<std::size_t>(event)].terms.n_terms));
    const std::vector<double> X = numbers_of(state.X), V = numbers_of(state.V);
    if (!angles.empty()) loads_->turns.follow(Configurations(X.data()), angles);
    watch.guarded(loads_->arguments(first_watch_ + event, {state.t, side}, X.data(), V.data(), angles),
                  terms);
    if (slack(event) > 0) terms[0] += slack(event);
    return terms;
}

/// Conditions are sums (or) of products (and): the largest of the least.
double EventWatch::margin(int event, const State& state, Side side) const
{
    const std::vector<double> terms = terms_at(event, state, side);
    double margin = -std::numeric_limits<double>::infinity();
    for (const std::vector<int>& all : whole_.events()[static_cast<std::size_t>(event)].terms.when) {
        double least = std::numeric_limits<double>::infinity();
        for (const int k : all) least = std::min(least, terms[static_cast<std::size_t>(k)]);
        margin = std::max(margin, least);
    }
    return margin;
}

void EventWatch::follow(const std::vector<Matrix34>& X, std::vector<double>& angles) const
{
    if (!angles.empty()) loads_->turns.follow(Configurations(X), angles);
}

bool EventWatch::holds_at(int event, const State& state) const
{
    return holds(whole_.events()[static_cast<std::size_t>(event)], terms_at(event, state));
}

/// Somewhat behind an element end: by its state, and by how the polynomial beside it bends. Of `by_slope` the
/// rates are those of the polynomial at the end of the element.
State EventWatch::beside(const Motion& motion, int end, double share, bool by_slope) const
{
    const int element = std::max(end - 1, 0);
    const double h = motion.mesh.length(element), s = end > 0 ? 1 : 0;
    State state = motion.at_end(end);
    std::vector<double> here(static_cast<std::size_t>(motion.X.n_values)), there(here);
    motion.X.evaluate(element, s, 1, here);
    motion.X.evaluate(element, s + share, 1, there);
    state.t += share * h;
    for (std::size_t b = 0; b < state.X.size(); ++b) {
        if (by_slope)
            for (std::size_t i = 0; i < 12; ++i) state.V[b].a[i] = here[12 * b + i] / h;
        state.X[b] += share * h * state.V[b];
        for (std::size_t i = 0; i < 12; ++i) state.V[b].a[i] += (there[12 * b + i] - here[12 * b + i]) / h;
    }
    return state;
}

/// By accelerations of the state, so far that rounding does not decide: elements that end at passages may be
/// short, but not all of some in succession.
State EventWatch::just_behind(const Motion& motion, int end) const
{
    double length = times_.length;
    for (int e = std::max(end - recent, 0); e < std::max(end, 1); ++e)
        raise_to(length, motion.mesh.length(e));
    const double way = behind * length;
    State state = motion.at_end(end);
    const Matrix34* A = motion.accelerations.data() + (2 * end + 1) * state.X.size();
    state.t += way;
    for (std::size_t b = 0; b < state.X.size(); ++b) {
        state.X[b] += way * state.V[b] + 0.5 * way * way * A[b];
        state.V[b] += way * A[b];
    }
    return state;
}

bool EventWatch::is_open_stop(int event) const
{
    const EventAction& action = whole_.events()[static_cast<std::size_t>(event)].action;
    return armed_[event] && action.does == EventAction::Does::begin && action.joint >= 0 &&
           whole_.joints()[action.joint].impact && whole_.joints()[action.joint].impact->open_side != 0;
}

bool EventWatch::is_number_at(int event, const State& state) const
{
    return std::ranges::all_of(terms_at(event, state), [](double x) { return std::isfinite(x); });
}

std::string EventWatch::lost_in_words(const Motion& so_far) const
{
    const Event& event = whole_.events()[static_cast<std::size_t>(lost_)];
    return "the condition of '" + event.name + "', " + event.text + ", is no number between " +
           to_text(so_far.mesh.ends[so_far.n_elements() - 1], 6) + " s and " + to_text(so_far.end(), 6) +
           " s; try: formulas that are finite wherever the motion comes";
}

/// Looks along the last element; of reactions at its end alone.
bool EventWatch::is_number_along(const Motion& motion, int event) const
{
    const int n = motion.n_elements();
    if (!is_number_at(event, motion.at_end(n))) return false;
    if (!whole_.events()[static_cast<std::size_t>(event)].terms.reactions.empty()) return true;
    const double start = motion.mesh.ends[n - 1], h = motion.mesh.length(n - 1);
    constexpr int looks = 8;
    for (int k = 1; k < looks; ++k) {
        State state = motion.at(start + h * k / looks);
        state.angles = motion.at_end(n - 1).angles;
        if (!is_number_at(event, state)) return false;
    }
    return true;
}

std::vector<int> EventWatch::fired(const Motion& so_far)
{
    const int n = so_far.n_elements(), n_events = static_cast<int>(armed_.size());
    std::vector<int> found;
    if (n == 0) return found;
    for (int e = 0; e < n_events; ++e)
        if (armed_[e] && !is_number_along(so_far, e)) {
            lost_ = e;
            return {e};
        }
    if (held_.at_end.empty()) {
        const State start = just_behind(so_far, 0);
        // What is open has not been met yet, though rounding may have it beyond the stop it has just left.
        for (int e = 0; e < n_events; ++e)
            held_.at_end.push_back(!is_open_stop(e) &&
                                   (std::ranges::count(held_.at_start, e) > 0 || holds_at(e, start)));
    }
    const State end = so_far.at_end(n), now = just_behind(so_far, n),
                beside_end = beside(so_far, n, behind, false), by_slope = beside(so_far, n, behind, true);
    for (int e = 0; e < n_events; ++e) {
        const auto is_beyond = [&](const State& state) {
            return slack(e) > 0 ? margin(e, state) > slack(e) : holds_at(e, state);
        };
        // stops may follow each other within any time, and are places: rounding is in their slack
        const State& look = slack(e) > 0 ? beside_end : now;
        const bool holds_now = is_beyond(look);
        // The polynomial has it, the state will: its zero lies in the jump between both. Of a short element
        // the slope knows nothing of where the state goes.
        const bool comes = !holds_now && !held_.at_end[e] && armed_[e] && is_beyond(by_slope) &&
                           margin(e, look) > margin(e, end) && comes_at_once(so_far, e);
        if ((holds_now && !held_.at_end[e] && armed_[e]) || comes) found.push_back(e);
        held_.at_end[e] = holds_now;
    }
    return found;
}

/// By its own rate the state has it within a twentieth of an element more.
bool EventWatch::comes_at_once(const Motion& motion, int event) const
{
    const Border border = border_of(motion, std::span(&event, 1));
    return border.rate > 0 &&
           slack(event) - border.margin < at_once * motion.mesh.length(motion.n_elements() - 1) * border.rate;
}

std::vector<int> EventWatch::holding(const Motion& motion, std::span<const int> events) const
{
    const int n = motion.n_elements();
    const State now = just_behind(motion, n), near = beside(motion, n, behind, false);
    std::vector<int> all;
    for (const int e : events)
        if (holds_at(e, slack(e) > 0 ? near : now)) all.push_back(e);
    if (!all.empty()) return all;
    // Where rounding decides, the one that is nearest.
    const State end = motion.at_end(motion.n_elements());
    const auto nearest = std::ranges::max_element(events, {}, [&](int e) { return margin(e, end); });
    return {*nearest};
}

}   // namespace livens::inline spacetime_internal
