// SPDX-License-Identifier: BSD-3-Clause
// Reactions of joints at any instant, on both sides of it: of the acceleration level (theory.md, "Element
// ends", "Accelerations"), interpolated where that cannot be had; the least where joints are redundant.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "livens/diagnostics/accelerations.h"
#include "livens/diagnostics/detail/sampler.h"
#include "livens/diagnostics/sample.h"
#include "livens/dynamics/instant/least_loads.h"
#include "livens/dynamics/instant/reactions.h"
#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/row_tables.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/multibody/acting_models.h"

namespace livens {

namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
constexpr Reaction unknown{{not_known, not_known, not_known}, {not_known, not_known, not_known}};

/// Joints all of whose multipliers are numbers.
std::vector<bool> bounded_joints(const Model& model, std::span<const double> left,
                                 std::span<const double> right)
{
    std::vector<bool> is_bounded(model.joints().size(), true);
    for (int r = 0; r < model.n_rows(); ++r)
        if (std::isnan(left[r]) || std::isnan(right[r])) is_bounded[model.row_joint(r)] = false;
    return is_bounded;
}

/// One after the other, without what is no number, which would spread to all joints of a loop.
std::vector<double> numbers_of(std::span<const double> left, std::span<const double> right)
{
    std::vector<double> numbers;
    numbers.reserve(left.size() + right.size());
    for (const std::span<const double> side : {left, right})
        for (const double value : side) numbers.push_back(std::isnan(value) ? 0 : value);
    return numbers;
}

/// What is found of multipliers on both sides of an instant, one after the other. `least`: of redundant rows;
/// null: there are none.
struct BothSides {
    std::vector<bool> is_bounded;
    std::vector<double> multipliers;
    const UniqueReactions* least = nullptr;
};

/// reaction(joint, multipliers)
template <class ReactionOf>
std::vector<JointSample> reactions_by(const Model& model, const BothSides& both, const ReactionOf& reaction)
{
    const std::vector<double>& multipliers = both.least ? both.least->multipliers : both.multipliers;
    const std::span<const double> before(multipliers.data(), multipliers.size() / 2),
        after(multipliers.data() + before.size(), before.size());
    const bool jumps = !std::ranges::equal(before, after);
    std::vector<JointSample> samples(model.joints().size());
    for (int j = 0; j < static_cast<int>(samples.size()); ++j) {
        JointSample& sample = samples[j];
        if (both.least) {
            sample.is_unique = both.least->joint_is_unique[j];
            sample.shared = both.least->shared[j];
        }
        sample.is_bounded = both.is_bounded[j];
        sample.left = sample.right = unknown;
        if (!sample.is_bounded) continue;
        sample.left = reaction(j, before);
        sample.right = jumps ? reaction(j, after) : sample.left;
    }
    return samples;
}

/// Rows that are not independent make reactions that are not unique.
std::vector<JointSample> reactions_of(const Model& model, const State& state, std::span<const double> left,
                                      std::span<const double> right, std::span<const int> independent)
{
    std::optional<Model> frozen_now;
    if (model.has_drives()) frozen_now = frozen(model, {state.t});
    const Model& now = frozen_now ? *frozen_now : model;
    BothSides both{bounded_joints(model, left, right), numbers_of(left, right)};
    UniqueReactions least;
    if (static_cast<int>(independent.size()) < model.n_rows()) {
        least = least_reactions(now, state.X, both.multipliers, independent);
        both.least = &least;
    }
    return reactions_by(model, both, [&](int j, std::span<const double> multipliers) {
        return joint_reaction(now, j, state.X, multipliers);
    });
}

/// Those that nobody dropped.
std::vector<int> kept_rows(const Model& model, const Motion& motion)
{
    std::vector<int> independent = all_rows(model);
    std::erase_if(independent, [&](int row) {
        return std::ranges::find(motion.redundant_rows, row) != motion.redundant_rows.end();
    });
    return independent;
}

/// The same of the joints alone that act around `beside`; others do nothing.
std::vector<JointSample> reactions_beside(ActingModels& models, const Motion& motion, const State& state,
                                          std::span<const double> multipliers, double beside)
{
    const std::shared_ptr<const ActingModel> known = models.at(beside);
    const ActingModel& acting = *known;
    std::vector<double> lambda;
    for (const int row : acting.rows) lambda.push_back(multipliers[row]);
    std::vector<int> independent = all_rows(acting.model);
    if (!motion.redundant_rows.empty())
        independent = row_rank(frozen(acting.model, {state.t}), state.X, independent).independent;
    const std::vector<JointSample> found = reactions_of(acting.model, state, lambda, lambda, independent);
    JointSample nothing;
    nothing.is_unique = nothing.is_bounded = true;
    std::vector<JointSample> samples(models.whole().joints().size(), nothing);
    for (std::size_t i = 0; i < found.size(); ++i) samples[acting.joints[i]] = found[i];
    return samples;
}

/// Marks joints without a reaction inside an element: where rows lose rank that are independent at its start,
/// those that take part, without which fewer are lost.
void forget_unbounded(ActingModels& models, const Motion& motion, const State& state,
                      std::vector<JointSample>& samples)
{
    constexpr double lost = 1e-4;   // docs/theory.md, "Singular positions"
    const std::shared_ptr<const ActingModel> known = models.at(state.t);
    const ActingModel& acting = *known;
    const State start = motion.at_end(motion.mesh.element_at(state.t));
    const Model then = frozen(acting.model, {start.t}), now = frozen(acting.model, {state.t});
    const std::vector<int> rows = row_rank(then, start.X, all_rows(acting.model)).independent;
    const auto n_lost = [&](const Model& model, const State& at, const std::vector<int>& some) {
        return row_rank(model, at.X, some, lost).dependent.size();
    };
    const std::size_t n = n_lost(now, state, rows);
    // Rows that are dependent at the start of the element as well are redundant, not lost.
    if (n <= n_lost(then, start, rows)) return;
    for (int j = 0; j < static_cast<int>(acting.model.joints().size()); ++j) {
        std::vector<int> others = rows;
        std::erase_if(others, [&](int row) { return acting.model.row_joint(row) == j; });
        if (n_lost(now, state, others) == n) continue;
        JointSample& sample = samples[acting.joints[j]];
        sample.is_bounded = false;
        sample.left = sample.right = unknown;
    }
}

/// Inside the element before or after an element end, or around another instant.
double beside(const Motion& motion, double t, int end, Side side)
{
    if (end < 0) return t;
    const int element = std::clamp(side == Side::left ? end - 1 : end, 0, motion.n_elements() - 1);
    // Events are element ends, so the middle of an element has the joints that act all over it.
    return motion.mesh.ends[element] + 0.5 * motion.mesh.length(element);
}

/// What joints hold at an instant, all rows of the model.
struct Held {
    State state;   ///< where they hold it
    std::vector<double> left, right;
    bool is_acceleration_level = true;
};

/// reactions(state, left, right) where all joints act.
template <class Reactions>
std::vector<JointSample> joints_in(ActingModels& models, const Motion& motion, const Held& held,
                                   const Reactions& reactions)
{
    const State& state = held.state;
    const int end = element_end_at(motion.mesh, state.t);
    std::vector<JointSample> samples;
    if (!models.whole().has_events())
        samples = reactions(state, held.left, held.right);
    else {
        samples =
            reactions_beside(models, motion, state, held.left, beside(motion, state.t, end, Side::left));
        const std::vector<JointSample> after =
            reactions_beside(models, motion, state, held.right, beside(motion, state.t, end, Side::right));
        for (std::size_t j = 0; j < samples.size(); ++j) {
            samples[j].right = after[j].right;
            samples[j].is_unique = samples[j].is_unique && after[j].is_unique;
            for (std::size_t i = 0; i < 6; ++i) samples[j].shared[i] |= after[j].shared[i];
            samples[j].is_bounded = samples[j].is_bounded && after[j].is_bounded;
        }
    }
    if (!held.is_acceleration_level && end < 0) forget_unbounded(models, motion, state, samples);
    for (JointSample& sample : samples) sample.is_acceleration_level = held.is_acceleration_level;
    return samples;
}

}   // namespace

std::vector<JointSample> sample_joints(const Model& model, const Motion& motion, double t)
{
    return JointSampler(model, motion).at(sample_state(motion, t));
}

struct JointSampler::Parts {
    Parts(const Model& model, const Motion& motion)
        : rows(model, false), independent(kept_rows(model, motion)), acting(model)
    {}

    [[gnu::visibility("hidden")]] std::optional<Held> held_in(const Model& model, const Motion& motion,
                                                              const State& state);
    Reaction reaction(const Model& model, int joint, Instant at, std::span<const Matrix34> X,
                      std::span<const double> multipliers) const;

    RowTables rows;
    std::vector<int> independent;
    ActingModels acting;
    UniqueReactions least;   // at an element end
    int least_end = -1;
    std::optional<Accelerations> accelerations;   // once an instant between ends is asked for
    std::optional<LeastLoads> least_loads;        // once forces alone are asked for
};

JointSampler::JointSampler(const Model& model, const Motion& motion)
    : model_(model), motion_(motion), parts_(std::make_shared<Parts>(model, motion))
{}

JointSampler::JointSampler(const Model& model, const Motion& motion, const Accelerations& accelerations)
    : JointSampler(model, motion)
{
    parts_->accelerations.emplace(accelerations);
}

/// Ends have multipliers of order 2p from the equations of motion. Between them the same equations are solved
/// in the state of the instant; where joints lose rank, and of motions that hold nothing of the kind at ends,
/// the nodes' multipliers are interpolated. Nothing: there are none.
std::optional<Held> JointSampler::Parts::held_in(const Model& model, const Motion& motion, const State& state)
{
    const int end = element_end_at(motion.mesh, state.t);
    if (end >= 0 && !motion.end_multipliers.empty()) {
        const std::size_t n = static_cast<std::size_t>(motion.n_rows);
        const auto left = motion.end_multipliers.begin() + static_cast<std::ptrdiff_t>(2 * end * n),
                   right = left + static_cast<std::ptrdiff_t>(n);
        return Held{state, {left, right}, {right, right + static_cast<std::ptrdiff_t>(n)}};
    }
    if (motion.n_elements() == 0) return {};
    if (end < 0 && !motion.end_multipliers.empty() && !motion.accelerations.empty()) {
        if (!accelerations) accelerations.emplace(model, motion);
        std::vector<double> found = accelerations->multipliers_at(state);
        if (!found.empty()) return Held{accelerations->on_joints(state), found, found};
    }
    if (motion.multipliers.empty()) return {};
    const std::vector<double> interpolated = field_at(motion.multipliers, motion.mesh, state.t);
    return Held{state, interpolated, interpolated, false};
}

/// joint_reaction() by the tables.
Reaction JointSampler::Parts::reaction(const Model& model, int joint, Instant at, std::span<const Matrix34> X,
                                       std::span<const double> multipliers) const
{
    const Joint& j = model.joints()[joint];
    Matrix34 F{};
    const int first = model.first_row(joint), last = first + static_cast<int>(j.rows.size());
    for (int r = first; r < last; ++r) {
        if (multipliers[r] == 0) continue;
        const RowTable& row = rows[static_cast<std::size_t>(r)];
        double g[RowTables::gradient_size];
        rows.gradient(r, at, X.data()->data(), g);
        for (int side = 0; side < row.n_sides; ++side) {
            if (row.bodies[side] != j.second) continue;
            for (const int column : row.columns[side])
                for (int i = column; i < column + 3; ++i) F.a[i] -= multipliers[r] * g[12 * side + i];
        }
    }
    return joint_reaction(j, X[j.second], F);
}

std::vector<JointSample> JointSampler::at(const State& given) const
{
    const std::optional<Held> held = parts_->held_in(model_, motion_, given);
    if (!held) return {};
    const auto reactions = [&](const State& state, std::span<const double> left,
                               std::span<const double> right) {
        const bool is_redundant = static_cast<int>(parts_->independent.size()) < model_.n_rows();
        if (model_.has_drives() && is_redundant)
            return reactions_of(model_, state, left, right, parts_->independent);
        BothSides both{bounded_joints(model_, left, right), numbers_of(left, right)};
        UniqueReactions own;
        if (is_redundant) {
            both.least = least_at(state, element_end_at(motion_.mesh, state.t));
            if (both.least == nullptr) {
                own = least_reactions(model_, state.X, both.multipliers, parts_->independent);
                both.least = &own;
            }
        }
        return reactions_by(model_, both, [&](int j, std::span<const double> multipliers) {
            return parts_->reaction(model_, j, {state.t}, state.X, multipliers);
        });
    };
    return joints_in(parts_->acting, motion_, *held, reactions);
}

/// At element ends, where nothing has to be found but what multipliers say.
void JointSampler::forces_at(int end, const State& state, std::vector<JointSample>& samples) const
{
    if (!find_forces(end, state, samples)) samples = at(state);
}

/// False: they need more than the multipliers at element ends.
bool JointSampler::find_forces(int end, const State& given, std::vector<JointSample>& samples) const
{
    const auto n_independent = static_cast<int>(parts_->independent.size());
    const bool is_redundant = n_independent < model_.n_rows();
    if (end < 0 || motion_.end_multipliers.empty() || model_.has_events()) return false;
    const std::size_t n = static_cast<std::size_t>(motion_.n_rows);
    const std::span<const double> both =
        std::span(motion_.end_multipliers).subspan(2 * static_cast<std::size_t>(end) * n, 2 * n);
    if (std::ranges::any_of(both, [](double x) { return std::isnan(x); })) return false;
    const Reaction* found = nullptr;
    if (is_redundant) {
        if (!parts_->least_loads) parts_->least_loads.emplace(model_, parts_->rows, n_independent);
        found = parts_->least_loads->find(given.t, given.X, both);
        if (found == nullptr) return false;
    }
    samples.assign(model_.joints().size(), {});
    const bool jumps = !std::ranges::equal(both.first(n), both.last(n));
    for (std::size_t j = 0; j < samples.size(); ++j) {
        JointSample& sample = samples[j];
        sample.is_acceleration_level = sample.is_bounded = true;
        const auto reaction = [&](std::size_t side) {
            return found != nullptr ? found[side * samples.size() + j]
                                    : parts_->reaction(model_, static_cast<int>(j), {given.t}, given.X,
                                                       both.subspan(side * n, n));
        };
        sample.left = reaction(0);
        sample.right = jumps ? reaction(1) : sample.left;
    }
    return true;
}

const UniqueReactions* JointSampler::least_at(const State& state, int end) const
{
    const bool is_redundant = static_cast<int>(parts_->independent.size()) < model_.n_rows();
    if (!is_redundant || model_.has_drives() || end < 0 || motion_.end_multipliers.empty()) return nullptr;
    if (parts_->least_end == end) return &parts_->least;
    const std::size_t n = static_cast<std::size_t>(motion_.n_rows);
    const std::span<const double> both =
        std::span(motion_.end_multipliers).subspan(2 * static_cast<std::size_t>(end) * n, 2 * n);
    if (std::ranges::any_of(both, [](double x) { return std::isnan(x); })) return nullptr;
    parts_->least = least_reactions(model_, state.X, both, parts_->independent);
    parts_->least_end = end;
    return &parts_->least;
}

}   // namespace livens
