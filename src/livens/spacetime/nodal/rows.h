// SPDX-License-Identifier: BSD-3-Clause
// The rows of a window: momentum balances of its nodes, and the multipliers that joints put into them.
#pragma once

#include <string>
#include <vector>

#include "livens/dynamics/rows/tables.h"
#include "livens/spacetime/nodal/stretch.h"

namespace livens {

class Nodes;
struct ConstraintBasis;
struct InstantState;

/// For every active node A
///
///     N^T [ sum_e ( h^-1 sum_B k_AB (X_B - X_0) m + F_A ) + P(0) - P(T) - W_A G^T lambda_A ] = 0
///
/// over the elements e at A, with F_A = h sum_c w_c M_A(s_c) F(X(s_c), X'(s_c)) at the load points and the
/// momenta at the first and the last node of the window (docs/theory.md, "The element"); with radau c_A P(0)
/// at every node, and no other momentum ("Radau points"). Multipliers are
/// eliminated node by node with an orthogonal basis of the constraint directions; what they leave are the
/// reduced rows, which are solved.
class Rows {
public:
    Rows(const Tables& tables, const ElementRule& rule);

    void open(const Stretch& stretch);
    /// Momentum at the first (sign 1) or the last node (sign -1) of the window: where X is known there, in
    /// scaled rows; else linear momentum and moment about the reference point, in world axes.
    struct EndMomentum {
        std::vector<double> scaled, about_reference;
        std::vector<double> columns;   ///< X' m, 12 numbers a body, for rows that share it (radau)
    };
    EndMomentum& end_momentum(bool last) { return momenta_[last ? 1 : 0]; }
    void start_with(const InstantState& first);

    /// False if something is not finite.
    bool evaluate(const Stretch& stretch, const Nodes& nodes);
    /// Reduced rows with the opposite sign, active node after active node.
    const std::vector<double>& reduced() const { return reduced_; }
    double size() const { return size_; }     ///< largest reduced row
    double terms() const { return terms_; }   ///< largest row before multipliers take their part

    /// W_A lambda_A, in the order of the basis.
    const double* impulses(int A) const
    {
        return impulses_.data() + static_cast<std::size_t>(A * tables_.rank);
    }
    /// For impulses that were found elsewhere.
    double* own_impulses(int A) { return impulses_.data() + static_cast<std::size_t>(A * tables_.rank); }
    /// F_A of element e, local node A, without weight.
    const double* forces(int e, int A) const { return of_loads_.forces.data() + place(e * rule_.size() + A); }
    /// The row before N^T and multipliers, at an active node.
    const double* raw(int A) const { return raw_.data() + place(A); }
    /// out <- N^T of the row without multipliers and end momenta, about the centres of mass, at any node.
    void twist_row(const Stretch& stretch, const Nodes& nodes, int A, double* out);
    /// out -= G^T impulses, in the order of the node's basis.
    void subtract(const ConstraintBasis& basis, const double* impulses, double* out) const;
    /// X and X' at load point c.
    void interpolate(const Stretch& stretch, const Nodes& nodes, int e, int c, double* X, double* V) const;
    /// Name of a load that is not finite, empty if all are.
    std::string bad_load(const Stretch& stretch, const Nodes& nodes) const;
    /// Follows the angles of loads through all nodes, as evaluate() does; see Turns.
    void count_turns(const Stretch& stretch, const Nodes& nodes);
    /// About what these are at load point c of element e: what they are at the node before.
    std::span<const double> angles(int e, int c) const;

private:
    struct OfLoads {
        std::vector<double> forces;   // F_A, element after element
        std::vector<double> angles;   // see Turns, node after node
    };

    std::size_t place(int node) const { return static_cast<std::size_t>(node) * size_of_X_; }
    void add_loads(const Stretch& stretch, const Nodes& nodes, int e);
    void add_element(const Stretch& stretch, const Nodes& nodes, int e, int A, double* raw);
    void add_end_momentum(const Stretch& stretch, const Nodes& nodes, int A, double* y) const;
    bool eliminate(const Stretch& stretch, const Nodes& nodes, int A, double* reduced);

    const Tables& tables_;
    const ElementRule& rule_;
    std::size_t size_of_X_;
    EndMomentum momenta_[2];
    OfLoads of_loads_;
    std::vector<double> raw_, q_;   // q_: N^T raw
    std::vector<double> impulses_, reduced_;
    std::vector<double> work_, X_, V_;
    double size_ = 0, terms_ = 0, start_terms_ = 0;
};

}   // namespace livens
