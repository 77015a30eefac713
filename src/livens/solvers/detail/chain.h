// SPDX-License-Identifier: BSD-3-Clause
// Factors of a chain of elements, and solutions with them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "livens/solvers/crew.h"
#include "livens/solvers/detail/panel.h"
#include "livens/solvers/linear_solver.h"

namespace livens::inline solvers_internal {

inline constexpr int least_shared_links = 8;   // that a thread takes, where there are several

/// Of an element, while solving: of its pivots, of those of what is merged, and of rows inside without; of a
/// transposed solution also what its pivots leave to its other columns.
struct LinkValues {
    mutable std::vector<double> inside_values, merged_values, left_values, passed_on;
};

/// An element of the chain. Columns of `inside`: its own unknowns | near, far, border, passed_near,
/// passed_far; of `merged`: passed_near, near | carried, far, border, passed_far.
struct Link : LinkValues {
    int first = 0, last = 0;                // nodes
    int n_near = 0, n_own = 0, n_far = 0;   // unknowns: of the first node, between, of the last node
    int r_near = 0, r_own = 0, r_far = 0;   // rows
    int p_near = 0, p_far = 0;              // numbers that pass at its ends: rows there, or none
    double scale = 1;                       // of what passes at its far end
    double size = 0;                        // of its entries
    Panel inside, merged;
    int failed = -1;   // column inside that has no pivot
};

/// Vectors on the way of a solution.
struct ChainWork {
    std::vector<double> right_side, front, passed, others;
    std::vector<double> carried, of_border, near;   // of a transposed solution
};

class ChainSolver final : public LinearSolver {
public:
    explicit ChainSolver(ChainEnds* ends = nullptr) : ends_(ends) {}
    void analyse(const BlockStructure& structure) override;
    Outcome factorise(BlockMatrix& matrix) override;
    void solve(std::span<double> x) const override { solve(x, false); }
    void solve_transposed(std::span<double> x) const override { solve(x, true); }
    void solve_closing(std::span<const double> rows, std::span<double> ends) const override;
    LinearReport report() const override;

private:
    int n_links() const { return static_cast<int>(links_.size()); }
    int unknown(int node) const { return first_unknown_[static_cast<std::size_t>(node)]; }
    int row(int node) const { return first_row_[static_cast<std::size_t>(node)]; }
    int border() const { return structure_->n_border; }
    const Panel& front(int e) const { return e == 0 ? links_[0].inside : links_[e].merged; }
    void take_room();
    void shape(int e);
    void take_room(Link& link, int n_left);
    void fill_inside(int e);
    void fill_merged(int e);
    void fill_closing();
    bool condense(Link& link, int e);
    LoopInOrder in_order(const std::function<double(const Panel&)>& cost) const;
    bool merge(int e);
    Outcome condense_all();
    Outcome close();
    bool close_by_others(bool is_regular);
    bool fail(int node)
    {
        singular_node_ = node;
        return false;
    }
    int node_inside(const Link& link, int column) const;
    void solve(std::span<double> x, bool is_transposed) const;
    void apply_inverse(double* x) const;
    void apply_inverse_transposed(double* x) const;
    void eliminate_inside(const Link& link, const double* x) const;
    void eliminate_own_transposed(const Link& link, const double* x) const;
    void eliminate_transposed(const Link& link, const double* x) const;
    void rows_inside(const Link& link, double* x) const;
    void substitute(double* x) const;
    void substitute_between(const Link& link, double* x) const;
    void substitute_inside(const Link& link, double* x) const;
    void subtract_product(const double* x, double* y, bool is_transposed) const;

    ChainEnds* ends_;   // or null
    std::optional<BlockStructure> structure_;
    std::vector<int> first_row_, first_unknown_;   // of nodes
    int n_carried_ = 0;                            // unknowns of the first node, where closing rows see them
    std::vector<Link> links_;
    Panel closing_;
    BlockMatrix matrix_;   // as it came, for refinement
    double growth_ = 1;
    bool is_regular_ = false;
    int singular_node_ = -1;
    mutable ChainWork work_;
};

}   // namespace livens::inline solvers_internal
