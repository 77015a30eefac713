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

/// Derivatives of the places at the end of a solved motion by velocities at its start, along its f free
/// motions there.
///
/// shape    n_twists x f each
/// unit     twists about the centres of mass (m, rad) by scaled free motions
/// empty    the elements have no regular tangent
struct FlowDerivative {
    DenseMatrix start;     ///< velocities of a unit of each
    DenseMatrix arrival;   ///< twists that it makes at the end
};
FlowDerivative flow_derivative(const ModelTables& tables, const TimeMesh& mesh, const ElementRule& rule,
                               const Guess& motion);

}   // namespace livens::inline spacetime_internal
