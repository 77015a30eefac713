// SPDX-License-Identifier: BSD-3-Clause
// Steps of free bodies, or by slopes of loads: what an element took decides for the next ones, and the former
// are tried again now and then (docs/theory.md, "Without a tangent", Stiff loads).
#include "livens/spacetime/nodal/kernel/step_choice.h"

#include <algorithm>
#include <cmath>

#include "livens/spacetime/nodal/kernel/kernel_tangent.h"

namespace livens {

namespace {

constexpr int always_allowed = 14;   // of free bodies, which are always allowed
// Of an element by slopes, before one was seen: of all freedoms at once, along joints, and there with
// lobatto, whose elements are long while free bodies' steps shrink fast.
constexpr double usual_steps = 8, usual_along_joints = 10, usual_with_lobatto = 20;
constexpr double usual_share = 0.25;               // of a factor that an element makes, likewise
constexpr double worth_slopes = 2;                 // times the length, which elements might have by slopes
constexpr int first_trial = 8, last_trial = 512;   // elements until steps of free bodies are tried again
constexpr double dear = 2;                         // elements
// Factors in an element that say that none is kept for long; how steps of free bodies shrink where they are
// worth their while, which goes with the square of the length; and a length short enough to try them.
constexpr int many_factors = 2;
constexpr double dearest = 50;   // steps of free bodies: two elements of half the length are cheaper
constexpr double good_contraction = 0.3, much_shorter = 0.5, shorter = 0.85;
constexpr double same_length = 0.03;   // of the motion of stiff loads a factor then leaves about twice that

}   // namespace

StepChoice::StepChoice(const ModelTables& tables, const ElementRule& rule, const lanes::Functions* functions)
    : may_be_short_(rule.points == Points::lobatto)
{
    if (functions != nullptr) tangent_ = std::make_unique<KernelTangent>(tables, rule, functions);
}

StepChoice::~StepChoice() = default;

KernelTangent& StepChoice::tangent()
{
    tangent_->use(pattern_);
    return *tangent_;
}

/// A factor fits the rows and the length that it was made for. Where factors are dear, and steps of free
/// bodies that were given up at some length would do at half of it, they are tried again with lobatto once
/// elements are clearly shorter.
void StepChoice::begin(const std::shared_ptr<const RowPattern>& pattern, const WindowLayout& layout)
{
    is_kept_ = is_kept_ && pattern == pattern_ && std::abs(layout.h(0) - h_) <= same_length * std::abs(h_);
    n_factors_ = 0;
    const bool is_hopeful = tangent_ && may_be_short_ && tangent_->cost().factor * many_factors >= dearest &&
                            given_up_.first * much_shorter * much_shorter < good_contraction;
    if (is_hopeful && std::abs(layout.h(0)) < shorter * given_up_.second) n_until_trial_ = 0;
    if (pattern == pattern_ || !tangent_) return;
    pattern_ = pattern;
    const KernelTangent::Cost cost = tangent().cost();
    const double along_joints = may_be_short_ ? usual_with_lobatto : usual_along_joints,
                 steps = tangent_->is_reduced() ? usual_steps : along_joints;
    cost_by_tangent_ = usual_share * cost.factor + steps * cost.step;
}

bool StepChoice::is_dear() const
{
    const KernelTangent::Cost cost = tangent_->cost();
    return cost.factor > dear * last_steps_ * cost.step;
}

int StepChoice::most_free_steps() const
{
    return std::max(always_allowed, static_cast<int>(cost_by_tangent_));
}

void StepChoice::gave_up(double contraction, double h) { given_up_ = {contraction, std::abs(h)}; }

bool StepChoice::is_dearer_than_short(int n_factors) const
{
    return may_be_short_ && n_factors >= many_factors && given_up_.second > 0 &&
           n_factors * tangent_->cost().factor >= dearest &&
           given_up_.first * much_shorter * much_shorter < good_contraction;
}

/// By slopes elements would be as long as their errors let them, and cost less for their length.
bool StepChoice::is_held_back(int steps) const
{
    if (!tangent_ || tangent_->is_reduced()) return false;
    return longer_ >= worth_slopes && steps * longer_ > cost_by_tangent_;
}

void StepChoice::factorised(bool is_good, double h)
{
    is_kept_ = is_good;
    h_ = h;
    kept_ = {};
    ++n_factors_;
}

void StepChoice::forget_factor()
{
    is_kept_ = false;
    tangent_->ask_joints();
}

/// Elements by slopes tell what steps of free bodies may cost, each half as much as the one behind it. Free
/// steps that were too many again put their next trial off, twice as far each time.
void StepChoice::took(int steps, bool is_solved, bool was_by_tangent)
{
    last_steps_ = steps;
    if (!was_by_tangent) {
        const bool was_stiff = is_stiff_;
        is_stiff_ = !is_solved || steps > cost_by_tangent_ || is_held_back(steps);
        if (is_stiff_) trial_after_ = was_stiff ? std::min(2 * trial_after_, last_trial) : first_trial;
        n_until_trial_ = trial_after_;
        return;
    }
    const KernelTangent::Cost cost = tangent_->cost();
    cost_by_tangent_ += 0.5 * (n_factors_ * cost.factor + steps * cost.step - cost_by_tangent_);
    n_factors_ = 0;
    --n_until_trial_;
    // a factor is made anew once an element with it costs more than those before did with it, it included
    const double mean = (cost.factor + cost.step * kept_.first) / std::max(kept_.second, 1);
    if (!is_solved || (kept_.second > 0 && cost.step * steps > mean)) is_kept_ = false;
    kept_.first += steps;
    ++kept_.second;
}

}   // namespace livens
