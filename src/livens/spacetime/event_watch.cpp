// SPDX-License-Identifier: BSD-3-Clause
// What the motion decides is asked of states at element ends, which have the order of the method, and never
// of the polynomials between them: docs/theory.md, "Events".
#include "livens/spacetime/event_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/dynamics/instant/reactions.h"

namespace livens::inline spacetime_internal {

namespace {

/// Of an element: so far behind an instant a condition has changed that changes there.
constexpr double behind = 1e-6;

std::vector<double> numbers_of(const std::vector<Matrix34>& all)
{
    std::vector<double> numbers;
    numbers.reserve(12 * all.size());
    for (const Matrix34& one : all) numbers.insert(numbers.end(), std::begin(one.a), std::end(one.a));
    return numbers;
}

double component_of(const Reaction& reaction, const ReactionInput& input)
{
    const Vector3& v = input.is_torque ? reaction.torque : reaction.force;
    return input.component < 0 ? norm(v) : v[input.component];
}

void refuse_shared(const Model& model, const ActingModel& acting, const ModelTables& tables,
                   const Event& event, const State& start)
{
    const Model now = frozen(acting.model, {start.t});
    const std::vector<double> none(static_cast<std::size_t>(now.n_rows()), 0.0);
    const UniqueReactions found = least_reactions(now, start.X, none, tables.independent);
    for (const ReactionInput& input : event.terms.reactions) {
        const auto at = std::ranges::find(acting.joints, input.joint);
        const auto j = static_cast<std::size_t>(at - acting.joints.begin());
        if (at == acting.joints.end() || found.joint_is_unique[j]) continue;
        throw InputError({"event-reaction", "event[" + event.name + "]",
                          "'" + event.name + "' asks for a reaction of joint '" +
                              model.joints()[input.joint].name +
                              "' that is not unique: other joints could carry " + in_words(found.shared[j]),
                          "", "", "bodies are held more often than they need to be",
                          "let joints hold what they must and no more, as a spherical joint in place of a "
                          "revolute one"});
    }
}

}   // namespace

EventWatch::EventWatch(const Model& model, ActingModel acting, std::vector<bool> armed, const State& start)
    : whole_(model), acting_(std::move(acting)), armed_(std::move(armed)), start_(start),
      first_watch_(static_cast<int>(acting_.model.loads().size()))
{
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
        acting_.model.add_load(std::move(watch));
    }
    loads_ = std::make_unique<LoadTables>(acting_.model);
    start_.angles.resize(loads_->turns.size(), 0.0);
}

std::function<void(const LoadArguments&, std::span<double>)> EventWatch::reactions_of(const Event& event)
{
    if (event.terms.reactions.empty()) return {};
    refuse_shared(whole_, acting_, mechanism_->tables(), event, start_);
    std::vector<ReactionInput> inputs = event.terms.reactions;
    const std::size_t n_counted = UnwrappedAngles(acting_.model).size();
    return [mechanism = mechanism_, model = mechanism_model_, joints = acting_.joints, inputs,
            n_counted](const LoadArguments& at, std::span<double> numbers) {
        State state{at.at.t, {}, {}};
        for (std::size_t b = 0; b < at.X.size(); ++b) {
            if (b == 1) continue;   // the world
            state.X.push_back(at.X[b]);
            state.V.push_back(at.V[b]);
        }
        std::vector<double> angles;
        if (at.angles.size() >= n_counted) angles.assign(at.angles.end() - n_counted, at.angles.end());
        const Side side = at.at.side == Side::left ? Side::left : Side::right;
        const bool is_known = mechanism->accelerate(state, angles, side);
        for (std::size_t k = 0; k < inputs.size(); ++k) {
            const auto j = std::ranges::find(joints, inputs[k].joint);
            numbers[k] = j == joints.end() ? 0.0 : std::numeric_limits<double>::quiet_NaN();
            if (j == joints.end() || !is_known) continue;
            const int index = static_cast<int>(j - joints.begin());
            const double* multiplier = mechanism->multipliers(side).data() + model->first_row(index);
            const Joint& joint = model->joints()[static_cast<std::size_t>(index)];
            Matrix34 F{};
            for (const ConstraintRow& row : joint.rows)
                F -= *multiplier++ *
                     constraint_gradient(frozen(row, {at.at.t, side}), state.X).of(joint.second);
            numbers[k] = component_of(joint_reaction(joint, state.X[joint.second], F), inputs[k]);
        }
    };
}

std::vector<double> EventWatch::terms_at(int event, const State& state) const
{
    const Load& watch = acting_.model.loads()[first_watch_ + event];
    std::vector<double> angles = state.angles, terms(watch.guards.size());
    const std::vector<double> X = numbers_of(state.X), V = numbers_of(state.V);
    if (!angles.empty()) loads_->turns.follow(Configurations(X.data()), angles);
    watch.guarded(loads_->arguments(first_watch_ + event, {state.t}, X.data(), V.data(), angles), terms);
    return terms;
}

bool EventWatch::holds_at(int event, const State& state) const
{
    return holds(whole_.events()[static_cast<std::size_t>(event)], terms_at(event, state));
}

/// Somewhat behind an element end: by its state, and by how the polynomial beside it bends.
State EventWatch::beside(const Motion& motion, int end, double share) const
{
    const int element = std::max(end - 1, 0);
    const double h = motion.mesh.length(element), s = end > 0 ? 1 : 0;
    State state = motion.at_end(end);
    std::vector<double> here(static_cast<std::size_t>(motion.X.n_values)), there(here);
    motion.X.evaluate(element, s, 1, here);
    motion.X.evaluate(element, s + share, 1, there);
    state.t += share * h;
    for (std::size_t b = 0; b < state.X.size(); ++b) {
        state.X[b] += share * h * state.V[b];
        for (std::size_t i = 0; i < 12; ++i) state.V[b].a[i] += (there[12 * b + i] - here[12 * b + i]) / h;
    }
    return state;
}

std::vector<int> EventWatch::fired(const Motion& so_far)
{
    const int n = so_far.n_elements(), n_events = static_cast<int>(armed_.size());
    std::vector<int> found;
    if (n == 0) return found;
    if (held_.empty()) {
        const State start = beside(so_far, 0, behind);
        for (int e = 0; e < n_events; ++e) held_.push_back(holds_at(e, start));
    }
    const State now = beside(so_far, n, behind);
    for (int e = 0; e < n_events; ++e) {
        const bool holds_now = holds_at(e, now);
        if (holds_now && !held_[e] && armed_[e]) found.push_back(e);
        held_[e] = holds_now;
    }
    return found;
}

double EventWatch::lateness(const Motion& motion, const std::vector<int>& fired) const
{
    const int n = motion.n_elements();
    const State end = motion.at_end(n), later = beside(motion, n, behind);
    constexpr double none = std::numeric_limits<double>::infinity();
    double latest = -none;
    for (const int e : fired) {
        const std::vector<double> before = terms_at(e, end), after = terms_at(e, later);
        double nearest = none;   // of its terms: the one that has just become true
        for (std::size_t k = 0; k < before.size(); ++k) {
            const double rate = (after[k] - before[k]) / (later.t - end.t);
            if (!(after[k] > 0 && rate > 0)) continue;
            if (std::abs(before[k] / rate) < std::abs(nearest)) nearest = before[k] / rate;
        }
        if (std::abs(nearest) < 0.5 * motion.mesh.length(n - 1)) latest = std::max(latest, nearest);
    }
    return latest > -none ? latest : 0;
}

bool EventWatch::holds_at_start(const Motion& motion, int event) const
{
    return holds_at(event, beside(motion, 0, behind));
}

}   // namespace livens::inline spacetime_internal
