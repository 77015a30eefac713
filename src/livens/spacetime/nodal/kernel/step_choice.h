// SPDX-License-Identifier: BSD-3-Clause
// By which steps an element is solved: those of free bodies, or those that know the slopes of loads.
#pragma once

#include <memory>
#include <utility>

#include "livens/dynamics/lanes/row_pattern.h"
#include "livens/spacetime/elements/kernel_functions.h"
#include "livens/spacetime/elements/window_layout.h"

namespace livens::inline spacetime_internal {

class KernelTangent;

/// What earlier elements took.
class StepChoice {
public:
    StepChoice(const ModelTables& tables, const ElementRule& rule, const lanes::Functions* functions);
    ~StepChoice();

    /// An element with these rows.
    void begin(const std::shared_ptr<const RowPattern>& pattern, const WindowLayout& layout);
    /// See ElementMonitor.
    void hold_back(double longer) { longer_ = longer; }
    /// Such steps first: those of free bodies were many, or did not shrink.
    bool by_tangent() const { return is_stiff_ && n_until_trial_ > 0; }
    /// Beyond, an element costs less by slopes.
    int most_free_steps() const;
    /// The factor at hand fits the element, as far as is known.
    bool is_kept() const { return is_kept_; }
    /// Of the rows at hand.
    KernelTangent& tangent();
    void factorised(bool is_good, double h);
    /// Steps with it shrink too little.
    void forget_factor();
    /// The element was solved, or not.
    void took(int steps, bool is_solved, bool was_by_tangent);
    /// Made for the element at hand.
    int n_factors() const { return n_factors_; }
    int last_steps() const { return last_steps_; }
    /// Steps of free bodies shrank at last by no more than this, and were given up.
    void gave_up(double contraction, double h);
    /// An element with these factors costs more than shorter ones by steps of free bodies.
    bool is_dearer_than_short(int n_factors) const;
    /// A factor costs more than the steps of some elements as the last one.
    bool is_dear() const;

private:
    bool is_held_back(int steps) const;

    std::unique_ptr<KernelTangent> tangent_;
    std::shared_ptr<const RowPattern> pattern_;
    bool may_be_short_;   // radau has long elements where motions end soon
    bool is_stiff_ = false, is_kept_ = false;
    double h_ = 0, longer_ = 1;
    std::pair<double, double> given_up_{};   // contraction and length; 0: steps of free bodies never were
    double cost_by_tangent_ = 0;   // of an element, in steps of free bodies, as the last ones had it
    int last_steps_ = 0, n_until_trial_ = 0, trial_after_ = 0, n_factors_ = 0;
    std::pair<int, int> kept_{};   // steps and elements with the last factor
};

}   // namespace livens::inline spacetime_internal
