// SPDX-License-Identifier: BSD-3-Clause
// One pass over a motion, element by element, for all that is judged of its points.
#pragma once

#include <memory>
#include <vector>

#include "livens/diagnostics/detail/supply.h"
#include "livens/diagnostics/diagnostics.h"

namespace livens::inline diagnostics_internal {

/// Whether the points where a method takes loads are enough for the integrals of action(): rules of p Gauss
/// or p + 1 Gauss-Lobatto points are exact to degree 2p - 1, which no integrand of a polynomial of degree p
/// without other potentials than weight exceeds.
bool has_own_integrals(const Model& model, const Motion& motion);

/// What of a pass is wanted.
struct PassWants {
    bool supplies = false;
    bool violations = false;   ///< of nodes; of rates where elements end
    bool integrals = false;    ///< see has_own_integrals()
    bool series = false;       ///< violations of every node are kept
    int first = 0;             ///< element with which it begins
};

/// Everything that is told of an element, or of a motion so far.
struct PassFigures {
    ViolationReport violations;
    NodeViolations nodes;
    ActionSeries integrals;
    double largest_kinetic = 0;        ///< where loads are taken
    double largest_gross_moment = 0;   ///< see Supply
};

/// The means of violations() over elements, of motions whose constraints hold weakly.
void add_weak_violations(const Model& model, const Motion& motion, ViolationReport& report);

class MotionPass {
public:
    MotionPass(const Model& model, const Motion& motion, const PassWants& wants);
    ~MotionPass();

    /// Of loads, at the start of elements.
    const LoadTurns& turns() const;
    /// Supplies of elements, each asked for once and in their order.
    const Supply& supply(int element);
    /// Integrals of the elements up to this one, from the first on.
    ActionSeries integrals(int last);
    /// Goes to the end.
    void finish();
    PassFigures& figures();

private:
    class Stretch;
    std::unique_ptr<Stretch> stretch_;
};

}   // namespace livens::inline diagnostics_internal
