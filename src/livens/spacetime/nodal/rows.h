// SPDX-License-Identifier: BSD-3-Clause
// The rows of a window: momentum balances of its nodes, and the multipliers that joints put into them.
#pragma once

#include <vector>

#include "livens/dynamics/rows/tables.h"
#include "livens/solvers/room.h"
#include "livens/spacetime/nodal/laws/element_loads.h"

namespace livens::inline dynamics_internal {
struct ConstraintBasis;
struct InstantState;
}   // namespace livens::inline dynamics_internal

namespace livens::inline spacetime_internal {

class Nodes;

/// Momentum at the first or the last node of a window: where X is known there, in scaled rows; else linear
/// momentum and moment about the reference point, in world axes.
struct EndMomentum {
    std::vector<double> scaled, about_reference;
    std::vector<double> columns;   ///< X' m, 12 numbers a body, for rows that share it (radau)

    /// y, scaled rows of a node with these maps, += sign times the momentum about the reference points.
    void add_to(const ModelTables& tables, const double* maps, double sign, double* y) const;
};

/// Of a thread.
struct RowWorkspace {
    std::vector<double> work, second;   ///< 12 a body; of the second element at a node
    std::vector<double> q;              ///< N^T raw
    double size = 0, terms = 0;         ///< the largest so far
};

/// For every active node A
///
///     N^T [ sum_e ( h^-1 sum_B k_AB (X_B - X_0) m + F_A ) + P(0) - P(T) - W_A G^T lambda_A ] = 0
///
/// over the elements e at A, with F_A of ElementLoads and the momenta at the first and the last node of the
/// window (docs/theory.md, "The element"); with radau c_A P(0) at every node, and no other momentum ("Radau
/// points"). Multipliers are eliminated node by node with an orthogonal basis of the constraint directions;
/// the rows in the free directions are the reduced rows, which are solved.
class NodalRows {
public:
    NodalRows(const ModelTables& tables, const ElementRule& rule);

    void open(const WindowLayout& layout);
    EndMomentum& end_momentum(bool last) { return momenta_[last ? 1 : 0]; }
    void start_with(const InstantState& first);

    /// False if something is not finite.
    bool evaluate(const WindowLayout& layout, const Nodes& nodes);
    const ElementLoads& loads() const { return loads_; }
    ElementLoads& loads() { return loads_; }
    /// Reduced rows with the opposite sign, active node after active node.
    const std::vector<double>& reduced() const { return reduced_; }
    double size() const { return size_; }     ///< largest reduced row
    double terms() const { return terms_; }   ///< largest row before multipliers take their part

    /// W_A lambda_A, in the order of the basis.
    const double* impulses(int A) const { return impulses_.data() + A * tables_.rank; }
    /// For impulses that were found elsewhere.
    double* own_impulses(int A) { return impulses_.data() + A * tables_.rank; }
    /// The row before N^T and multipliers, at an active node.
    const double* raw(int A) const { return raw_.data() + A * size_of_node_; }
    /// out <- N^T of the row without multipliers and end momenta, about the centres of mass, at any node.
    void twist_row(const WindowLayout& layout, const Nodes& nodes, int A, double* out);
    /// out -= G^T impulses, in the order of the node's basis.
    void subtract(const ConstraintBasis& basis, const double* impulses, double* out) const;

private:
    RowWorkspace workspace() const;
    void take_row(const WindowLayout& layout, const Nodes& nodes, int A, RowWorkspace& at);
    void add_element(const WindowLayout& layout, const Nodes& nodes, int e, int A, double* raw,
                     RowWorkspace& at) const;
    bool eliminate(const WindowLayout& layout, const Nodes& nodes, int A, double* reduced, RowWorkspace& at);

    const ModelTables& tables_;
    const ElementRule& rule_;
    EndMomentum momenta_[2];
    ElementLoads loads_;
    std::ptrdiff_t size_of_node_;   // 12 a body
    Room raw_;
    std::vector<double> impulses_, reduced_;
    std::vector<char> are_finite_;   // of nodes
    std::vector<RowWorkspace> workspaces_;
    double size_ = 0, terms_ = 0;
};

}   // namespace livens::inline spacetime_internal
