// SPDX-License-Identifier: BSD-3-Clause
// lobatto(p) and radau(p) as families: their windows, what they hand on, and its motion.
#pragma once

#include "livens/spacetime/march/ends.h"
#include "livens/spacetime/nodal/bordered_window.h"
#include "livens/spacetime/nodal/element_checks.h"
#include "livens/spacetime/nodal/element_end.h"
#include "livens/spacetime/nodal/kernel/march_kernel.h"
#include "livens/spacetime/nodal/record.h"
#include "livens/spacetime/nodal/series.h"
#include "livens/spacetime/nodal/system.h"

namespace livens::inline spacetime_internal {

struct ElementCloser;

/// Windows from the end where the state is known, or one window of all elements; radau: single elements from
/// the state at the start.
class NodalWindow final : public BorderedWindow, private ElementMonitor {
public:
    /// References must outlive the window.
    NodalWindow(const ModelTables& tables, const TimeMesh& mesh, const Ends& ends, const ElementRule& rule);

    /// Laws of loads are not inspected between load points.
    void ignore_laws() { checks_.ignore_laws(); }
    /// A motion nearby, which has to outlive the window, as the guess where its elements are the same.
    void follow(const Motion& motion) { kernel_.follow(motion); }
    /// Goes on from the state that the ends have now, over the elements that the mesh has now, as another
    /// motion. What was learnt of the last element stays.
    void restart();
    /// The elements are those of one of several ranks, whose chains `ends` closes.
    void be_part(ChainEnds& ends, const WindowLayout::Part& part);
    bool open(int first, int last, SolveReport& report) override;
    NodalSystem& equations() override { return system_; }
    const NodalSystem& equations() const { return system_; }
    void border_with(std::function<DenseMatrix(Formed)> columns) override;
    bool factorise() override { return system_.factorise(); }
    bool adopt(const BorderedWindow& other, bool is_pulled) override;
    std::vector<double> rows_in(Formed formed) override { return system_.rows_in(*formed.front()); }
    void solve_for(const BorderedWindow& other, std::span<double> dx) override;
    bool start_from(const Guess& guess) override;
    State at(int element_end) const override;
    AcceptedElements close(const AcceptanceCriteria& criteria, SolveReport& report) override;
    Uncertainty uncertainty() override;
    WorstResidual worst() const override;
    void describe(SolveReport& report) const override;
    Motion take_motion() override { return record_.take(ends_.start); }

private:
    bool solve(const NewtonOptions& options, bool soon, NewtonReport& report) override;
    void hold_back(double longer) override { kernel_.hold_back(longer); }
    double tangent_cost() const override;
    /// Nodes that are far from their constraints say nothing of it.
    RankLoss rank_loss() const override
    {
        return system_.nodes().is_near() ? checks_.rank_loss(system_.nodes(), 0) : RankLoss::none;
    }
    double bend(double until) override { return checks_.bend(system_, until); }
    std::string jumping_load() const override { return checks_.jumping_load(); }
    void divided(int element) override { record_.divided(element); }
    std::vector<Unseen> take_unseen() override { return checks_.take_unseen(); }
    const Motion* so_far() override { return &record_.so_far(); }

    /// Whether ends of elements are found by elimination along the joints, see InstantSystem.
    bool is_sparse() const { return kernel_.serves() && ends_.has_state(); }
    int mesh_end(int end) const;
    void set_momenta(const State& given, std::vector<double>& momenta) const;
    bool begin_conditions(const Guess& guess);
    bool set_state(InstantState& state, const State& given, SolveReport& report);
    bool begin_front(SolveReport& report);
    void begin_newton();
    bool start_by_series();
    bool find_first(SolveReport& report);
    bool is_believed(ElementCloser& by, int e, const AcceptanceCriteria& criteria, const double* momentum);
    void close_element(ElementCloser& by, int e);
    bool close_share(ElementCloser& by, std::pair<int, int> elements, const AcceptanceCriteria& criteria,
                     const std::vector<double>& momenta, std::vector<Unseen>& unseen);
    bool close_in_shares(const AcceptanceCriteria& criteria, const std::vector<double>& momenta,
                         AcceptedElements& closed);
    void record_end(ElementEnd& state, int end);
    bool fail(SolveReport& report, const std::string& message) const;

    const ModelTables& tables_;
    const Ends& ends_;
    std::unique_ptr<EndConditions> conditions_;   // by component, or null
    NodalSystem system_;
    Series series_;
    MarchKernel kernel_;
    ElementEnd end_;
    ElementChecks checks_;
    Record record_;
    WindowLayout layout_;
    InstantState far_;        // where X is known at the far end
    bool is_ready_ = false;   // the state at hand is known and in the motion
    int first_ = 0, last_ = 0;
};

}   // namespace livens::inline spacetime_internal
