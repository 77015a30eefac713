// SPDX-License-Identifier: BSD-3-Clause
// What the arrival of a motion is to its start, from the factors of all its elements.
#pragma once

#include "livens/solvers/dense_matrix.h"
#include "livens/spacetime/elements/rule.h"
#include "livens/spacetime/march/window.h"

namespace livens::inline dynamics_internal {
struct ModelTables;
}   // namespace livens::inline dynamics_internal

namespace livens::inline spacetime_internal {

/// Derivatives of the state at the end of a solved motion by that at its start: columns are the f free
/// motions at the start, with momenta held in world axes, then momenta along these.
///
/// shape    n_twists x 2 f each
/// unit     twists about the centres of mass (m, rad) by scaled free motions
/// empty    the elements have no regular tangent
struct FlowDerivative {
    DenseMatrix start;     ///< twists, then velocities, of a unit of each at the start
    DenseMatrix arrival;   ///< twists that it makes at the end
};
FlowDerivative flow_derivative(const ModelTables& tables, const TimeMesh& mesh, const ElementRule& rule,
                               const Guess& motion);

}   // namespace livens::inline spacetime_internal
