// SPDX-License-Identifier: BSD-3-Clause
// The states at the ends of an element: the one that it began with, and the one that it has come to.
#pragma once

#include <string>
#include <vector>

#include "livens/dynamics/instant/instant.h"

namespace livens::inline spacetime_internal {

class MarchKernel;
class NodalSystem;

/// The state that is passed on from element to element, and one-sided multipliers (docs/theory.md, "Element
/// ends").
class ElementEnd {
public:
    /// `sparse`: see InstantSystem.
    ElementEnd(const ModelTables& tables, bool sparse);

    InstantSystem& instant() { return instant_; }
    const InstantSystem& instant() const { return instant_; }
    InstantState& here() { return states_[now_]; }
    const InstantState& here() const { return states_[now_]; }
    InstantState& next() { return states_[1 - now_]; }
    /// Loads jump at t.
    bool is_jump(double t) const;

    /// Positions, twists and constraint basis of a given state in which the mechanism is closed. False: its
    /// mass matrix is singular on the free motions.
    bool set(InstantState& state, const State& given);
    /// Both sides of an instant where loads jump, else one for both.
    void accelerate(InstantState& state);
    /// here() <- the state at the first node, where it follows from the solution. False: the free motions
    /// carry no inertia.
    bool find_first(NodalSystem& system);
    /// Impulses W lambda at the first node of a march, in its basis.
    void begin(const double* impulses);
    /// next() <- the end state of the solved element e. `polish`: directors, too. False: as above.
    bool reach(NodalSystem& system, MarchKernel& kernel, int e, bool polish);
    /// A row that was left out as redundant and does not hold at next(); empty: they all do. They may be
    /// redundant no more, or others may have become so on the way: rows are chosen at element ends.
    std::string contradiction() const;
    /// At local node a of element e, on its side of the node; all rows of the model.
    const double* multipliers(const NodalSystem& system, int e, int a);
    /// here() <- next(), for element e + 1.
    void pass_on(const NodalSystem& system, int e);

private:
    void sum_momentum(const NodalSystem& system, int e);
    void take_spin_of_polynomial(const NodalSystem& system, int e);

    const ModelTables& tables_;
    InstantSystem instant_;
    std::vector<double> jumps_;   // instants
    InstantState states_[2];
    int now_ = 0;
    std::vector<double> lambda_, end_lambda_;   // all rows of the model
    std::vector<double> impulse_;               // h w_0 lambda of the element's first node, in its basis
    std::vector<double> momentum_, wrench_;     // twist rows about the centres of mass
    std::vector<double> raw_;                   // 12 a body
};

}   // namespace livens::inline spacetime_internal
