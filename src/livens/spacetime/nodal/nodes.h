// SPDX-License-Identifier: BSD-3-Clause
// The configurations of a window's nodes, moved by twists and held to the constraints.
#pragma once

#include <optional>
#include <vector>

#include "livens/dynamics/rows/constraint_basis.h"
#include "livens/solvers/room.h"
#include "livens/spacetime/elements/window_layout.h"
#include "livens/spacetime/nodal/rows_in_lanes.h"

namespace livens::inline dynamics_internal {
struct InstantState;
}   // namespace livens::inline dynamics_internal

namespace livens::inline spacetime_internal {

/// X of every node is the sum X + low of two doubles, so that differences of neighbours keep the digits of a
/// small motion (docs/theory.md, "Increments").
///
/// There are two sets of configurations: the kept one and the current one. Arrays hold 12 numbers a body,
/// node after node.
class NodePositions {
public:
    NodePositions(const ModelTables& tables, const ElementRule& rule);

    void open(const WindowLayout& layout);
    /// In both sets: the nodes that move() does not touch must be the same in them.
    void fix(int A, const std::vector<double>& X, const std::vector<double>& low);

    Instant at(int A) const { return {times_[A]}; }
    const double* X(int A) const { return sets_[current_].X.data() + place(A); }
    const double* low(int A) const { return sets_[current_].low.data() + place(A); }
    /// X less that of the element's first node, B = 0..p.
    const double* dX(int e, int B) const { return dX_.data() + place(e * (rule_.degree + 1) + B); }
    /// Size of a twist: in lengths of the model and radians.
    double size_of(const double* twist) const;

    void place_at(int A, const double* X);
    /// With the lower parts; false: it is there.
    bool place_at(int A, const double* X, const double* low);
    /// All nodes of the only element: the first node moved by increments about the centres of mass, in lanes,
    /// of which lane 0 is the end. Only the end gets a lower part.
    void place_solved(const double* increments, int width);
    /// Node A: node `from` moved by a finite twist; by displacements and quaternions (s, v), 7 numbers a
    /// body.
    void place_from(int A, int from, const double* twist);
    void turn_from(int A, int from, const double* turns);
    /// Current node <- kept node moved by factor * twist.
    void move(int A, const double* twist, double factor);
    void begin_move() { current_ = 1 - kept_; }
    void keep() { kept_ = current_; }
    /// Unknown nodes of both sets become what others, as many nodes and bodies, have kept.
    void adopt(const NodePositions& others, const WindowLayout& layout);
    /// dX of all nodes of an element, from both parts of X.
    void take_differences(int e);

protected:
    std::size_t place(int A) const { return A * size_; }

    const ModelTables& tables_;
    const ElementRule& rule_;
    std::size_t size_;   // 12 a body

private:
    struct Set {
        Room X, low;
    };

    void displace(const Set& from, int A_from, const double* twist, double factor, Set& to, int A);

    Set sets_[2];
    int current_ = 0, kept_ = 0;
    std::vector<double> times_;
    Room dX_;
};

/// The constraints at these nodes: maps, bases of constraint and free directions, violations. Known states at
/// the ends bring their own.
class Nodes : public NodePositions {
public:
    using NodePositions::NodePositions;
    ~Nodes();   ///< by shares
    Nodes(const Nodes&) = delete;
    Nodes& operator=(const Nodes&) = delete;

    void open(const WindowLayout& layout);
    /// Node A is a known state, whose basis and maps serve; node 0, or the last where X is given there. The
    /// basis is not looked at before constrain().
    void fix(int A, const InstantState& state);

    const double* maps(int A) const { return maps_.data() + place(A); }
    const ConstraintBasis& basis(int A) const { return known_[A] != nullptr ? *known_[A] : bases_[A]; }
    /// The independent rows, alike at all nodes of a march.
    const std::vector<int>& rows() const
    {
        return first_rows_ != nullptr ? *first_rows_ : tables_.independent;
    }
    /// For taking a node's own basis away.
    ConstraintBasis& own_basis(int A) { return bases_[A]; }
    /// Violations of the independent rows at node A, times the scales of its basis.
    const double* violations(int A) const { return scaled_.data() + A * tables_.rank; }
    /// Smallest scaled pivot of the constraints at node A; it falls to zero where they lose rank.
    double pivot(int A) const { return pivots_[A]; }
    void set_pivot(int A, double pivot) { pivots_[A] = pivot; }

    /// Differences, constraints, their gradients and bases at all unknown nodes. False if not finite.
    /// `same_choices`: bases vary smoothly with the nodes, as a tangent in use asks.
    bool constrain(const WindowLayout& layout, bool same_choices);
    /// Every violation is small enough to be taken off by one linear step.
    bool is_near() const { return near_; }
    /// Moves each node by itself back to the constraints, with the bases at hand, which are then stale by as
    /// much. Returns the largest move, in lengths and radians.
    double correct(const WindowLayout& layout);

private:
    void begin_constraining();
    void build_bases(int slot, int first, int behind, bool same_choices);
    auto change_at(int e, int B, double* work) const;
    template <class Change>
    void add_violations(int e, int B, const Change& change, double& sum);
    bool add_up_in_shares(const WindowLayout& layout);
    void look_at(int A, double& sum, bool& is_near);
    double followed(int e, int B, int c, double* work) const;

    Room maps_;
    std::vector<ConstraintBasis> bases_;
    std::vector<const ConstraintBasis*> known_;      // of states at the ends, which do not move; else null
    const std::vector<int>* first_rows_ = nullptr;   // those of the state at the first node
    std::vector<double> scaled_, phi_;               // violations times the scales of bases, and as they are
    bool has_start_ = false;                         // those of the first node, where its state is known
    std::vector<double> pivots_, moves_;             // moves_: sizes of corrections
    std::optional<RowsInLanes> in_lanes_;
    /// Of each thread: numbers of a twist, a twist; gradients.
    std::vector<std::vector<double>> work_;
    std::vector<RowsInLanes::Workspace> lanes_;
    bool near_ = true;
};

}   // namespace livens::inline spacetime_internal
