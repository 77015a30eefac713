// SPDX-License-Identifier: BSD-3-Clause
// One element of a march, solved without a tangent: all nodes side by side, the joints by elimination.
#pragma once

#include <vector>

#include "livens/dynamics/lanes/joint_factor.h"
#include "livens/solvers/newton.h"
#include "livens/spacetime/nodal/kernel/acceleration.h"
#include "livens/spacetime/nodal/kernel/kernel_guess.h"
#include "livens/spacetime/nodal/kernel/kernel_rule.h"
#include "livens/spacetime/nodal/kernel/kernel_wrenches.h"
#include "livens/spacetime/nodal/kernel/step_choice.h"

namespace livens::inline spacetime_internal {

/// The equations of NodalSystem for one element of lobatto or radau from a known state, by
///
///     y_B <- P_B [ - h sum_A (K^-1)_BA P_A r_A ] - G_B^+ Phi_B,      P = 1 - G^T (G G^T)^-1 G
///
/// in mass-orthonormal twists (docs/theory.md, "Without a tangent"). What it does not know or does not solve
/// soon is left to Newton's iteration.
class MarchKernel {
public:
    /// References must outlive the kernel.
    MarchKernel(const ModelTables& tables, const ElementRule& rule);

    /// Whether there are lanes for the rule, and JointFactor serves.
    bool serves() const { return functions_ != nullptr; }
    /// A motion nearby, which has to outlive the kernel, as the guess where its elements are the same; not of
    /// large mechanisms, whose iteration it was not seen to shorten.
    void follow(const Motion& motion)
    {
        if (serves() && tables_.n_twists < many_twists) guess_.follow(motion);
    }
    /// See ElementMonitor.
    void hold_back(double longer) { choice_.hold_back(longer); }
    /// The element of `stretch` from `start`. False: not converged within 14 steps, steps that do not shrink
    /// to 0.3 twice, a number that is not finite, or a pivot that is nearly zero. Steps of many bodies, of
    /// which a tangent would be large, are then combined (Acceleration), unless it has to be told `soon`.
    bool solve(const WindowLayout& layout, const InstantState& start, const NewtonOptions& options, bool soon,
               NewtonReport& report);
    /// The last solve() was successful, and nothing else was tried since.
    bool is_solved() const { return is_solved_; }
    /// And it was found near the element of the motion that is followed, on whose branch it is.
    bool has_followed() const { return is_solved_ && guess_.was_followed(); }
    void forget()
    {
        is_solved_ = false;
        guess_.forget();
    }
    /// Evaluations of the equations at a node so far.
    long long evaluations() const { return evaluations_; }

    // Of the element solved last.

    /// X less X at the start, 12 numbers a body about its centre of mass, each for all nodes in lanes.
    const double* increments() const { return nodes_.values().increments; }
    int width() const { return functions_->width; }
    /// What fits at the end of an element that was just solved.
    NearFactor factor_at_end() const
    {
        if (!is_solved_ || !has_near_factor_) return {};
        return {pattern_.get(), &nodes_.values(), functions_->width};
    }
    /// W_A lambda_A of an active node, in the order of the start's rows.
    void impulses(int A, double* out) const;
    /// Smallest scaled pivot of the constraints at a node.
    double pivot(int A) const;
    /// The lanes that evaluated its loads; null: there are none.
    const LoadLanes* loads() const { return wrenches_.loads(); }
    /// Momentum and spin at the end, about the centres of mass.
    void momentum(const WindowLayout& layout, const InstantState& start, double* p);

private:
    static constexpr int many_twists = 100;

    void use(const InstantState& start);
    void evaluate_loads(const WindowLayout& layout);
    /// The third: with a new factor wherever one is slow, though it costs as much as many steps.
    enum class Steps { free, by_tangent, by_new_tangents, combined };
    static bool has_slopes(Steps kind) { return kind == Steps::by_tangent || kind == Steps::by_new_tangents; }
    bool iterate(const WindowLayout& layout, const InstantState& start, const NewtonOptions& options,
                 Steps kind, NewtonReport& report);
    /// Numbers, gradients and factor of the row in lane 0.
    const lanes::Values& first_row();
    bool is_radau() const { return rule_.points == Points::radau; }
    bool propose(const WindowLayout& layout, Steps kind);
    double size_of_proposal() const;
    int lane_of(int B) const { return B == rule_.degree ? 0 : B; }

    const ModelTables& tables_;
    const ElementRule& rule_;
    const lanes::Functions* functions_;   // null: no lanes for this rule or model
    std::shared_ptr<const RowPattern> pattern_;
    const JointFactor* start_ = nullptr;
    LaneStore nodes_, end_;   // end_, with radau: of node p, as scalars
    KernelRule lane_rule_;
    KernelWrenches wrenches_;
    KernelGuess guess_;
    Acceleration acceleration_;
    StepChoice choice_;
    long long evaluations_ = 0;
    bool is_solved_ = false, has_near_factor_ = false;
};

}   // namespace livens::inline spacetime_internal
