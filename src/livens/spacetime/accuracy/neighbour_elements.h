// SPDX-License-Identifier: BSD-3-Clause
// Elements of motions beside one that is known: what is alike in all of them is found once.
#pragma once

#include <memory>
#include <vector>

#include "livens/dynamics/instant/instant.h"
#include "livens/spacetime/accuracy/known_elements.h"
#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/nodal/kernel/kernel_rule.h"
#include "livens/spacetime/nodal/kernel/kernel_wrenches.h"
#include "livens/spacetime/nodal/kernel/step_choice.h"

namespace livens::inline spacetime_internal {

/// Where a motion beside the known one has come to, and how it went through its last element.
struct BesideState {
    InstantState ends[2];
    int now = 0;
    AlignedDoubles apart{};   // places of the last element's nodes, less those of the known motion
    bool has_past = false;

    InstantState& here() { return ends[now]; }
    const InstantState& here() const { return ends[now]; }
};

/// How near all are to the known motion, and what steps may leave of it; lengths and radians.
struct BesideLimits {
    double apart, left;
};

/// States at element ends.
class NeighbourEnds {
public:
    NeighbourEnds(const ModelTables& tables, const ElementRule& rule, bool serves);

    /// See NeighbourElements.
    bool begin(BesideState& one, const State& start);
    State state(const BesideState& one) const;
    /// Room for momentum and spin at the end, about the centres of mass.
    double* momentum() { return momentum_.data(); }
    /// To the end of an element that was solved from here, with these increments in lanes. False: rows leave
    /// a free motion without inertia.
    bool reach(BesideState& one, const WindowLayout& layout, const lanes::Values& nodes, int width,
               const NearFactor& near);

private:
    void take_spin_of_polynomial(double h, const lanes::Values& nodes, int width, InstantState& next);

    const ModelTables& tables_;
    const ElementRule& rule_;
    InstantSystem instant_;
    std::vector<double> momentum_, lambda_, rates_, raw_;
};

/// The equations of MarchKernel, for one element of all neighbours after the other. Their guess is the known
/// motion and the polynomial by which they were beside it in the element before; one factor of the joints
/// serves all, as do multipliers to begin with and the slopes of stiff loads.
/// (docs/theory.md, "The horizon", What it costs)
class NeighbourElements {
public:
    /// References must outlive it. `closed`: as the motion begins.
    NeighbourElements(const Model& model, Prepared& prepared, const Method& method, const Ends& closed,
                      const Motion& motion);

    /// Of all bodies.
    int freedoms() const { return tables_.freedoms(); }
    /// From degree 3 on, rows and inertias that the kernel knows: else neighbours are marched by windows.
    bool serves() const { return serves_; }
    /// A state at the start of the next element that is opened, where `one` is beside the known motion by
    /// `share` of what it was. Off its joints by no more than what bends it is taken as it is. False: joints
    /// do not hold it well.
    bool begin(BesideState& one, const State& start, double share);
    /// All are solved in this element of the motion next.
    void open(int element);
    /// To the end of the open element. `mirror`: on the other side of the motion, already there. False: steps
    /// do not shrink.
    bool solve(BesideState& one, const BesideLimits& limits, const BesideState* mirror);
    /// Where it is.
    State state(const BesideState& one) const { return ends_.state(one); }

private:
    void use(BesideState& one);
    void guess(const BesideState& one, const BesideState* mirror);
    bool iterate(BesideState& one, const BesideLimits& limits, bool by_tangent);
    void evaluate(const BesideState& one, bool has_factor, lanes::Sizes& sizes);
    bool take_step(const BesideState& one, bool by_tangent, lanes::Sizes& sizes);
    const lanes::Values& first_row(const BesideState& one);
    NearFactor factor_at_end(double apart) const;

    ModelTables tables_;
    ElementRule rule_;
    const lanes::Functions* functions_;
    bool serves_;
    KnownElements known_;
    NeighbourEnds ends_;
    std::shared_ptr<const RowPattern> pattern_;
    LaneStore nodes_, end_row_;   // end_row_, with radau: of node p, as scalars
    KernelRule lane_rule_;
    KernelWrenches wrenches_;
    StepChoice choice_;
    bool is_new_ = true;   // nobody was solved in the open element
    double pivot_ = 0;     // of the factor at hand, squared
};

}   // namespace livens::inline spacetime_internal
