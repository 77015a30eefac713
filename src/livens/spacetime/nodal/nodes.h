// SPDX-License-Identifier: BSD-3-Clause
// The configurations of a window's nodes, moved by twists and held to the constraints.
#pragma once

#include <vector>

#include "livens/dynamics/rows/constraint_basis.h"
#include "livens/spacetime/nodal/stretch.h"

namespace livens {

struct InstantState;

/// X of every node is the sum X + low of two doubles, so that differences of neighbours keep the digits of a
/// small motion (docs/theory.md, "Increments").
///
/// There are two sets of configurations: the kept one and the current one. Arrays hold 12 numbers a body,
/// node after node.
class Nodes {
public:
    Nodes(const Tables& tables, const ElementRule& rule);

    void open(const Stretch& stretch);
    /// Node A is a known state, whose basis and maps serve; node 0, or the last where X is given there. The
    /// basis is not looked at before constrain().
    void fix(int A, const InstantState& state);

    Instant at(int A) const { return {times_[static_cast<std::size_t>(A)]}; }
    const double* X(int A) const { return sets_[current_].X.data() + place(A); }
    const double* low(int A) const { return sets_[current_].low.data() + place(A); }
    /// X less that of the element's first node, B = 0..p.
    const double* dX(int e, int B) const { return dX_.data() + place(e * (rule_.degree + 1) + B); }
    const double* maps(int A) const { return maps_.data() + place(A); }
    const ConstraintBasis& basis(int A) const
    {
        return known_.bases[A] != nullptr ? *known_.bases[A] : bases_[A];
    }
    /// The independent rows, alike at all nodes of a march.
    const std::vector<int>& rows() const
    {
        return known_.rows != nullptr ? *known_.rows : tables_.independent;
    }
    /// For taking a node's own basis away.
    ConstraintBasis& own_basis(int A) { return bases_[A]; }
    /// Violations of the independent rows at node A, times the scales of its basis.
    const double* violations(int A) const
    {
        return phi_.scaled.data() + static_cast<std::size_t>(A * tables_.rank);
    }

    void place_at(int A, const double* X);
    /// All nodes of the only element: the first node moved by increments about the centres of mass, in lanes,
    /// of which lane 0 is the end. They get no basis, and only the end a lower part.
    void place_solved(const double* increments, int width);
    void set_pivot(int A, double pivot) { pivots_[static_cast<std::size_t>(A)] = pivot; }
    /// Node A: node `from` moved by a finite twist; by displacements and quaternions (s, v), 7 numbers a
    /// body.
    void place_from(int A, int from, const double* twist);
    void turn_from(int A, int from, const double* turns);
    /// Current node <- kept node moved by factor * twist.
    void move(int A, const double* twist, double factor);
    /// The nodes that move() does not touch must be the same in both sets.
    void begin_move() { current_ = 1 - kept_; }
    void keep() { kept_ = current_; }

    /// Differences, constraints, their gradients and bases at all unknown nodes. False if not finite.
    /// `same_choices`: bases vary smoothly with the nodes, as a tangent in use asks.
    bool constrain(const Stretch& stretch, bool same_choices);
    /// Every violation is small enough to be taken off by one linear step.
    bool is_near() const { return near_; }
    /// Moves each node by itself back to the constraints, with the bases at hand, which are then stale by as
    /// much. Returns the largest move, in lengths and radians.
    double correct(const Stretch& stretch);

    /// Smallest scaled pivot of the constraints at node A; it falls to zero where they lose rank.
    double pivot(int A) const { return pivots_[static_cast<std::size_t>(A)]; }
    /// Size of a twist: in lengths of the model and radians.
    double size_of(const double* twist) const;

private:
    struct Set {
        std::vector<double> X, low;
    };

    /// States that do not move: at the ends of a stretch.
    struct Known {
        std::vector<const ConstraintBasis*> bases;   // by node, null: not known
        const std::vector<int>* rows = nullptr;      // of the first node
    };
    struct Violations {
        std::vector<double> scaled, values;   // times the scales of the bases, and as they are
        bool has_start = false;               // those of the first node
    };

    std::size_t place(int A) const { return static_cast<std::size_t>(A) * size_; }
    void add(const Set& from, int A_from, Set& to, int A);
    void displace(const Set& from, int A_from, const double* twist, Set& to, int A);
    void measure_element(int e);
    void begin_constraining();
    bool constrain_node(int e, int B, bool same_choices, double& sum);
    double followed(int e, int B, int c);

    const Tables& tables_;
    const ElementRule& rule_;
    std::size_t size_;   // 12 a body
    Set sets_[2];
    int current_ = 0, kept_ = 0;
    std::vector<double> times_;
    std::vector<double> dX_, maps_;
    std::vector<ConstraintBasis> bases_;
    Known known_;
    Violations phi_;
    std::vector<double> work_;
    bool near_ = true;
    std::vector<double> pivots_;
};

}   // namespace livens
