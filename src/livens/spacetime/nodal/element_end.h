// SPDX-License-Identifier: BSD-3-Clause
// The states at the ends of an element: the one that it began with, and the one that it has come to.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "livens/dynamics/instant/instant.h"
#include "livens/multibody/state.h"

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
    /// Anybody's, 12 numbers a body.
    std::span<double> work() { return raw_; }
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
    /// Momenta at the ends of all elements from the balance of their rows, n_twists each, of which joints
    /// have yet to take what is not tangent to them. The kernel has that of its element by itself.
    std::vector<double> momenta(const NodalSystem& system) const;
    /// Begins where another one does; before element e it is reach() alone that may be asked for.
    void begin_as(const ElementEnd& other, const NodalSystem& system, int e);
    /// next() <- the end state of the solved element e. `momentum`: there, see momenta(), null of an element
    /// that the kernel has solved. `polish`: directors, too. False: as above.
    bool reach(NodalSystem& system, MarchKernel& kernel, int e, const double* momentum, bool polish);
    /// A row that was left out as redundant and does not hold at next(); empty: they all do. They may be
    /// redundant no more, or others may have become so on the way: rows are chosen at element ends.
    std::string contradiction() const;
    /// At local node a of element e, on its side of the node; all rows of the model.
    const double* multipliers(const NodalSystem& system, int e, int a);
    /// here() <- next(), for element e + 1.
    void pass_on(const NodalSystem& system, int e);

private:
    void add_wrenches(const NodalSystem& system, int e, std::span<double> raw, std::span<double> wrench,
                      double* sum) const;
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
