// SPDX-License-Identifier: BSD-3-Clause
// A window over events: one stretch of elements for each phase, with the joints that act in it. theory.md,
// "Phases between conditions".
#pragma once

#include <memory>
#include <vector>

#include "livens/multibody/model.h"
#include "livens/solvers/dense.h"
#include "livens/spacetime/march/condition_rows.h"
#include "livens/spacetime/nodal/phase_plan.h"
#include "livens/spacetime/nodal/window.h"

namespace livens::inline spacetime_internal {

/// Elements of a phase with its joints.
struct WindowPhase {
    WindowPhase(const Model& model, const TimeMesh& whole, const PhasePlan::Phase& plan,
                const ElementRule& rule);

    int f() const { return tables.freedoms(); }
    NodalSystem& system() { return window.equations(); }
    const NodalSystem& system() const { return window.equations(); }
    int last_node() const { return window.equations().layout().n_nodes() - 1; }

    ActingModel acting;
    bool is_planned;   ///< the joints that act are those of the plan
    TimeMesh mesh;
    Ends ends;
    ModelTables tables;
    NodalWindow window;
};
/// Free motions of a node where tangents were formed.
struct PhaseFrame {
    std::vector<double> X, maps;
    DenseMatrix z;   ///< scaled twists
};
/// Of a phase where its tangent was formed.
struct PhaseResponse {
    PhaseFrame start, end;
    std::vector<std::vector<double>> by_start, by_numbers;   ///< increments
    DenseMatrix end_by_start, end_by_numbers;                ///< along free motions, then momenta along them
    DenseMatrix start_by_end;                                ///< of the next phase
    DenseMatrix start_by_all;   ///< of this phase by what the condensed system is for
};

/// Of lobatto. The first node of a phase is the last one of the phase before, with its momenta: what is left
/// to be found are the nodes inside, the start if it is not known, and numbers.
class PhasesWindow final : public BorderedWindow, private ElementMonitor, private NewtonProblem {
public:
    /// The plan must outlive it. Where in one of its phases other joints act, or the start does not close, it
    /// does not open.
    PhasesWindow(std::shared_ptr<const Model> model, const TimeMesh& mesh, const Ends& ends,
                 const PhasePlan& plan, const ElementRule& rule, bool look_at_laws);

    bool open(int first, int last, SolveReport& report) override;
    NewtonProblem& equations() override { return *this; }
    bool start_from(const Guess& guess) override;
    State at(int element_end) const override;
    AcceptedElements close(const AcceptanceCriteria& criteria, SolveReport& report) override;
    Uncertainty uncertainty() override;
    WorstResidual worst() const override;
    void describe(SolveReport& report) const override;
    Motion take_motion() override { return std::move(motion_); }

    void border_with(std::function<DenseMatrix(Formed)> columns) override { columns_ = std::move(columns); }
    bool factorise() override;
    bool adopt(const BorderedWindow& other, bool is_pulled) override;
    std::vector<double> rows_in(Formed formed) override;
    void solve_for(const BorderedWindow& other, std::span<double> dx) override;

private:
    using Phase = WindowPhase;
    using Frame = PhaseFrame;
    using Response = PhaseResponse;

    std::vector<Unseen> take_unseen() override;
    const Motion* so_far() override { return &motion_; }

    int n_unknowns() const override;
    bool residual() override;
    using ElementMonitor::solve;
    void solve(std::span<double> dx) override { solve_for(*this, dx); }
    bool move(std::span<const double> dx, double damping) override;
    void keep() override;
    double size_of(std::span<const double> dx) const override;
    double scale() const override;
    NewtonProblem::Rows rows() const override;
    void measure_condition(SolveReport& report, const std::function<bool()>& goes_on) override;

    std::size_t n_of(const Phase& phase) const
    {
        return static_cast<std::size_t>(phase.window.equations().n_unknowns());
    }
    int n_start() const { return ends_.is_start_known() ? 0 : 2 * phases_.front()->f(); }
    int n_all() const { return n_start() + ends_.n_numbers; }
    static Frame frame_of(const Phase& phase, int node);
    /// Along free motions, then momenta along them, of an increment of places and momenta.
    static std::vector<double> along(const Phase& phase, const Frame& frame, std::span<const double> twist,
                                     std::span<const double> momenta);
    std::vector<double> end_along(std::size_t k, std::span<const double> dx) const;
    DenseMatrix handed_on(std::size_t k) const;
    void respond(std::size_t k, const DenseMatrix& by_numbers, std::size_t first_row);
    bool condense(const DenseMatrix& by_numbers);
    /// Increments for rows of balances of every phase and of conditions.
    void solve_rows(const PhasesWindow& other, const std::vector<std::vector<double>>& balances,
                    const std::vector<double>& conditions, std::span<double> dx);

    std::shared_ptr<const Model> model_;
    TimeMesh mesh_;
    Ends ends_;
    std::vector<std::unique_ptr<Phase>> phases_;
    std::unique_ptr<MissedConditions> missed_;
    std::vector<Matrix34> stated_;
    std::vector<double> start_X_, start_momenta_;   // where they are known
    std::function<DenseMatrix(Formed)> columns_;    // or none
    std::vector<Response> responses_;               // of the last factors
    DenseMatrix start_rows_, end_rows_;             // conditions by the start and by the end
    DenseLU condensed_;
    bool is_formed_ = false;   // the factors are those of the current point
    Motion motion_;
};

}   // namespace livens::inline spacetime_internal
