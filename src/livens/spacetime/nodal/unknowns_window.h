// SPDX-License-Identifier: BSD-3-Clause
// A window between both ends of time whose model has unknown numbers: theory.md, "Unknown numbers".
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "livens/spacetime/elements/rule.h"
#include "livens/spacetime/march/numbered.h"
#include "livens/spacetime/nodal/bordered_window.h"

namespace livens::inline spacetime_internal {

/// Windows of lobatto on models without events.
std::function<std::shared_ptr<BorderedWindow>(const NumberedProblem::Instance&)> nodal_windows(
    const ElementRule& rule, bool look_at_laws);

/// Of lobatto. Every trial of Newton's iteration has a model of its own; columns by the numbers are
/// differences of rows of rebuilt models, with nodes that are pulled onto the joints of these.
class UnknownsWindow final : public Window, private ElementMonitor, private NewtonProblem {
public:
    /// The window of a problem with some values, with what it is made of.
    using Maker = std::function<std::shared_ptr<BorderedWindow>(const NumberedProblem::Instance&)>;
    /// References must outlive it; `begin`: values to begin with, of stated numbers at least. What is found
    /// goes into `found`.
    UnknownsWindow(const NumberedProblem& problem, const std::vector<double>& begin, Maker maker,
                   FoundNumbers& found);

    bool open(int first, int last, SolveReport& report) override;
    NewtonProblem& equations() override { return *this; }
    /// A guess on the mesh of the problem.
    bool start_from(const Guess& guess) override;
    State at(int element_end) const override { return now_->window->at(element_end); }
    AcceptedElements close(const AcceptanceCriteria& criteria, SolveReport& report) override;
    Uncertainty uncertainty() override;
    WorstResidual worst() const override { return now_->window->worst(); }
    void describe(SolveReport& report) const override;
    Motion take_motion() override { return now_->window->take_motion(); }
    /// The window at the numbers at hand, and what it was made of.
    const BorderedWindow& now() const { return *now_->window; }
    const NumberedProblem::Instance& instance() const { return now_->of; }

private:
    struct Instance {
        std::vector<double> values;
        NumberedProblem::Instance of;
        std::shared_ptr<BorderedWindow> window;
    };
    using Shared = std::shared_ptr<Instance>;

    std::vector<Unseen> take_unseen() override { return now_->window->monitor().take_unseen(); }
    const Motion* so_far() override { return now_->window->monitor().so_far(); }

    int n_unknowns() const override { return now_->window->equations().n_unknowns(); }
    bool residual() override { return now_->window->equations().residual(); }
    bool factorise() override;
    using ElementMonitor::solve;
    void solve(std::span<double> dx) override;
    bool move(std::span<const double> dx, double damping) override;
    void keep() override;
    double size_of(std::span<const double> dx) const override;
    double scale() const override { return now_->window->equations().scale(); }
    NewtonProblem::Rows rows() const override { return now_->window->equations().rows(); }
    void measure_condition(SolveReport& report, const std::function<bool()>& goes_on) override
    {
        now_->window->equations().measure_condition(report, goes_on);
    }

    /// Null: no model has these values, or it is not to be solved; `why_` says it.
    Shared make(const std::vector<double>& values);
    DenseMatrix columns(Formed formed);
    bool add_sample(int i, const NumberedProblem::Sample& sample, Formed formed, std::span<double> column);
    std::span<const double> numbers_in(std::span<const double> dx) const
    {
        return dx.last(static_cast<std::size_t>(problem_.size()));
    }
    std::string bounds_reached() const;

    const NumberedProblem& problem_;
    std::vector<double> begin_;
    Maker maker_;
    FoundNumbers& found_;
    int first_ = 0, last_ = 0;
    bool is_formed_ = false;       // at the point that was closed
    Shared now_, kept_, formed_;   // the current point, the kept one, that of the factors
    std::string why_;
};

}   // namespace livens::inline spacetime_internal
