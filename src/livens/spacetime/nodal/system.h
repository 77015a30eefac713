// SPDX-License-Identifier: BSD-3-Clause
// The equations of lobatto(p) or radau(p) on one window, as Newton's iteration sees them.
#pragma once

#include <memory>
#include <vector>

#include "livens/solvers/newton.h"
#include "livens/spacetime/march/end_conditions.h"
#include "livens/spacetime/nodal/nodes.h"
#include "livens/spacetime/nodal/rows.h"
#include "livens/spacetime/nodal/tangent.h"

namespace livens::inline spacetime_internal {

class Elimination;

/// Of elements: what moves inside, in lengths and radians, and mass times motion over h, in scaled rows.
struct Extent {
    double motion = 0, impulse = 0;
};

/// Rows and constraints of a stretch of elements, whose unknowns are the twists of its unknown nodes, one
/// node after the other. Multipliers are eliminated; every move ends with a pull back onto the constraints.
class NodalSystem final : public NewtonProblem {
public:
    NodalSystem(const ModelTables& tables, const ElementRule& rule);
    ~NodalSystem() override;

    /// Makes a stretch current, with the states known at its ends (null: X is unknown there). To be followed
    /// by places for all unknown nodes, and settle().
    void open(const WindowLayout& layout, const InstantState* first, const InstantState* last);
    /// Conditions by component, for layouts whose momenta at both ends are unknown; must outlive the system.
    void close_with(EndConditions& conditions) { conditions_ = &conditions; }
    /// What a system of the same layout has kept, on another model. `is_pulled`: onto the joints of that. The
    /// layout's states are not known. False: not finite, or too far away.
    bool adopt(const NodalSystem& other, bool is_pulled);
    /// The first node becomes this place, pulled onto the joints, and its momenta these. False: not finite.
    bool begin_with(const double* X, const double* low, const std::vector<double>& momenta)
    {
        conditions_->hold(false, momenta);
        return put(0, X, low);
    }
    /// An unknown node becomes this place, pulled onto the joints. False: not finite.
    bool put(int A, const double* X, const double* low);
    /// The same where it is there already but for rounding: nothing is pulled.
    bool meet(int A, const double* X, const double* low);
    /// Angles of loads where the window begins, or about there.
    void begin_angles(const std::vector<double>& angles) { layout_.angles = angles; }
    /// Rows of balances and conditions with the opposite sign, in the null spaces of a sink that has begun.
    std::vector<double> rows_in(Elimination& formed) const;
    /// Placed nodes may lie far from the constraints: pulls until the bases fit the nodes. False: not finite.
    bool settle();

    const ElementRule& rule() const { return rule_; }
    const WindowLayout& layout() const { return layout_; }
    Nodes& nodes() { return nodes_; }
    const Nodes& nodes() const { return nodes_; }
    NodalRows& balances() { return rows_; }
    const NodalRows& balances() const { return rows_; }
    /// Null before settle().
    const Elimination* elimination() const { return elimination_.get(); }
    Elimination* elimination() { return elimination_.get(); }
    /// Forms the tangent at the current point into another sink, for tests.
    void form_tangent(TangentSink& sink) { tangent_.form(layout_, nodes_, rows_, sink); }
    /// Of the conditions by component, or null.
    EndConditions* conditions() { return conditions_; }
    const EndConditions* conditions() const { return conditions_; }
    /// An angle at the last node that is `from` at the first, node after node.
    double followed(const NamedCoordinate& coordinate, std::span<const Matrix34> stated, double from) const;
    /// The bases fit the nodes to rounding: nothing was pulled since they were made.
    bool bases_fit() const { return correction_ < 1e-15; }

    /// How far the rounding of the rows may move the solution at hand, in lengths and radians, by the last
    /// factors; and the twists of unknown nodes that nothing holds but rounding, or that are held least.
    double uncertainty(std::vector<double>& twists);

    int n_unknowns() const override;
    bool residual() override;
    /// Of the equations at a node, so far.
    long long evaluations() const { return evaluations_; }
    bool factorise() override;
    void solve(std::span<double> dx) override { solve_for(*this, dx); }
    /// Increments of another system of the same layout, on another model, by the factors of this one.
    void solve_for(const NodalSystem& other, std::span<double> dx);
    /// The same for other rows with the opposite sign, conditions behind the balances.
    void solve_rows(const NodalSystem& other, std::span<const double> rows, std::span<double> dx);
    /// Of the rows of each node.
    std::vector<double> roundings() const;
    bool move(std::span<const double> dx, double damping) override;
    void keep() override;
    double size_of(std::span<const double> dx) const override;
    double scale() const override;
    NewtonProblem::Rows rows() const override;
    /// Its factors are lost: nothing is solved any more until the window is opened as another one.
    void measure_condition(SolveReport& report, const std::function<bool()>& goes_on) override;

private:
    void choose_elimination();
    bool takes_bodies_apart() const;
    void form_all(Elimination& elimination);
    std::size_t n_node_numbers() const;
    std::ptrdiff_t place_of(int A) const;
    std::unique_ptr<Elimination> on_null_spaces(bool as_a_whole) const;
    bool evaluate_conditions();
    bool pull(bool are_placed);
    void measure();
    double impulse_of(int e, double& motion) const;
    double largest_k() const;

    const ModelTables& tables_;
    ElementRule rule_;
    WindowLayout layout_;
    Nodes nodes_;
    NodalRows rows_;
    Tangent tangent_;
    std::unique_ptr<Elimination> elimination_;
    EndConditions* conditions_ = nullptr;   // by component
    bool in_use_ = false;                   // a tangent is: null spaces vary smoothly
    bool pending_ = false;                  // violations are left to the next linear step
    double correction_ = 0;                 // largest pull of the last move
    Extent extent_;                         // the largest inside of elements
    long long evaluations_ = 0;
    std::vector<double> range_;     // violations that are left, in the basis
    std::vector<Extent> extents_;   // of each thread's elements
};

}   // namespace livens::inline spacetime_internal
