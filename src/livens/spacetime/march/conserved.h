// SPDX-License-Identifier: BSD-3-Clause
// Quantities that every motion of a mechanism keeps, and how a periodic one is unfolded by them: theory.md,
// "Periodic motions".
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "livens/spacetime/march/end_point.h"
#include "livens/spacetime/problem.h"

namespace livens::inline spacetime_internal {

/// Whether a joint is driven, or forces at these places are others at other instants of the duration: else
/// any motion may begin later.
bool depends_on_time(const ModelTables& tables, const std::deque<EndPoint>& places, double start,
                     double duration);

/// Of energy, linear momenta and angular momenta those that no motion changes, each independent of the
/// others; with a turn of which none changes them either. Judged at these places, which nobody chose;
/// `duration`: s, in which things change.
std::vector<StateQuantity> conserved_quantities(const ModelTables& tables, const std::deque<EndPoint>& places,
                                                double duration, const std::optional<AxisTurn>& turn);

/// Whether bodies that are turned about this axis are still joined, and move as they did, turned.
bool is_symmetric_about(const ModelTables& tables, const std::deque<EndPoint>& places, const AxisTurn& turn);

/// For each conserved quantity by how much conditions may miss that it changes, in their units: its gradient
/// by their quantities at the start, of length 1 in units of unit_of(). Empty: they are no coordinates there.
std::vector<std::vector<double>> unfolding(const ModelTables& tables, const EndPoint& start,
                                           const std::vector<Condition>& alike,
                                           const std::vector<StateQuantity>& conserved, double duration);

}   // namespace livens::inline spacetime_internal
