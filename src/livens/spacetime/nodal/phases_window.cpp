// SPDX-License-Identifier: BSD-3-Clause
// What phases are made of, and how each begins where the one before it ends.
#include "livens/spacetime/nodal/phases_window.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/spacetime/phases/events.h"

namespace livens::inline spacetime_internal {

namespace {

TimeMesh stretch_of(const TimeMesh& whole, int first, int last)
{
    TimeMesh part{{whole.ends.begin() + first, whole.ends.begin() + last + 1}};
    for (const double t : whole.required)
        if (t >= part.start() && t <= part.end()) part.required.push_back(t);
    return part;
}

/// Balances hold at all nodes of a phase, with unknown momenta at both ends (docs/theory.md, "Phases between
/// conditions"); the state of the plan is a guess, with angles of loads.
Ends ends_of(const PhasePlan::Phase& plan, const TimeMesh& mesh)
{
    Ends ends;
    ends.at_start = ends.at_end = Known::nothing;
    ends.start_is = Ends::Start::of_phase;
    ends.start = ends.end = plan.start;
    ends.start.t = mesh.start();
    ends.end.t = mesh.end();
    ends.independent = plan.independent;
    return ends;
}

}   // namespace

/// Which joints act is asked in the middle, since they begin and end at the ends of phases.
WindowPhase::WindowPhase(const Model& model, const TimeMesh& whole, const PhasePlan::Phase& plan,
                         const ElementRule& rule)
    : acting(acting_at(model, 0.5 * (whole.ends[plan.first] + whole.ends[plan.last]))),
      is_planned(acting.joints == plan.joints), mesh(stretch_of(whole, plan.first, plan.last)),
      ends(ends_of(plan, mesh)), tables(acting.model, is_planned ? plan.independent : std::vector<int>()),
      window(tables, mesh, ends, rule)
{}

PhasesWindow::PhasesWindow(std::shared_ptr<const Model> model, const TimeMesh& mesh, const Ends& ends,
                           const PhasePlan& plan, const ElementRule& rule, bool look_at_laws)
    : BorderedWindow(static_cast<ElementMonitor&>(*this)), model_(std::move(model)), mesh_(mesh), ends_(ends)
{
    for (const PhasePlan::Phase& of : plan.phases) {
        phases_.push_back(std::make_unique<Phase>(*model_, mesh_, of, rule));
        if (!phases_.back()->is_planned) return;
        if (!look_at_laws) phases_.back()->window.ignore_laws();
    }
    missed_ = std::make_unique<MissedConditions>(phases_.back()->tables, ends_);
    for (const Body& body : model_->bodies()) stated_.push_back(body.X);
    if (!ends_.is_start_known()) return;
    EndPoint start(phases_.front()->tables);
    if (!start.place(ends_.start)) return;
    start_momenta_ = start.momenta();
    for (const Matrix34& X : start.state().X) start_X_.insert(start_X_.end(), std::begin(X.a), std::end(X.a));
}

bool PhasesWindow::open(int, int, SolveReport& report)
{
    const bool is_planned = phases_.back()->is_planned;
    if (!is_planned || (ends_.is_start_known() && start_momenta_.empty())) {
        report.status = SolveStatus::singular;
        report.message = is_planned ? "the joints cannot hold the bodies where they start"
                                    : "joints begin or end to act in another order";
        return false;
    }
    return std::ranges::all_of(
        phases_, [&](const auto& phase) { return phase->window.open(0, phase->mesh.n_elements(), report); });
}

bool PhasesWindow::start_from(const Guess& guess)
{
    is_formed_ = false;
    return guess &&
           std::ranges::all_of(phases_, [&](const auto& phase) { return phase->window.start_from(guess); });
}

State PhasesWindow::at(int element_end) const
{
    int before = 0;
    for (const auto& phase : phases_) {
        const int n = phase->mesh.n_elements();
        if (element_end <= before + n) return phase->window.at(element_end - before);
        before += n;
    }
    return {};
}

AcceptedElements PhasesWindow::close(const AcceptanceCriteria& criteria, SolveReport& report)
{
    AcceptedElements all;
    if (!is_formed_) is_formed_ = factorise();   // closing takes bases of nodes
    motion_ = {};
    for (const auto& phase : phases_) {
        const int before = all.n_elements;
        all = phase->window.close(criteria, report);
        const bool is_whole = all.n_elements == phase->mesh.n_elements();
        all.n_elements += before;
        if (!is_whole) break;
        Motion part = phase->window.take_motion();
        widen(part, *model_, phase->acting);
        join(motion_, std::move(part), false);
    }
    return all;
}

std::vector<Unseen> PhasesWindow::take_unseen()
{
    std::vector<Unseen> all;
    for (const auto& phase : phases_)
        for (Unseen& one : phase->window.monitor().take_unseen()) all.push_back(std::move(one));
    return all;
}

WorstResidual PhasesWindow::worst() const
{
    const auto size = [](const auto& phase) { return phase->system().rows().size; };
    return (*std::ranges::max_element(phases_, {}, size))->window.worst();
}

void PhasesWindow::describe(SolveReport& report) const
{
    int unknowns = 0;
    long long evaluations = 0;
    for (const auto& phase : phases_) {
        SolveReport of;
        of.smallest_pivot = report.smallest_pivot;
        phase->window.describe(of);
        unknowns += of.unknowns;
        evaluations += of.evaluations;
        report.smallest_pivot = of.smallest_pivot;
        report.factor_entries = std::max(report.factor_entries, of.factor_entries);
    }
    report.unknowns = std::max(report.unknowns, unknowns + n_all());
    report.evaluations = evaluations;
}

void PhasesWindow::measure_condition(SolveReport& report, const std::function<bool()>&)
{
    report.notes.push_back("condition numbers are not computed over phases");
}

int PhasesWindow::n_unknowns() const
{
    std::size_t n = static_cast<std::size_t>(ends_.n_numbers);
    for (const auto& phase : phases_) n += n_of(*phase);
    return static_cast<int>(n);
}

/// In the order of time: a phase begins where the one before it stands now, with digits below the last and
/// momenta, before its rows are formed. Conditions come last, with angles that are followed through all
/// phases.
bool PhasesWindow::residual()
{
    const std::vector<double> zeros(start_X_.size(), 0.0);
    if (ends_.is_start_known() &&
        !phases_.front()->system().begin_with(start_X_.data(), zeros.data(), start_momenta_))
        return false;
    for (std::size_t k = 0; k < phases_.size(); ++k) {
        NodalSystem& system = phases_[k]->system();
        if (k > 0) {
            const Phase& before = *phases_[k - 1];
            const Nodes& nodes = before.system().nodes();
            const int last = before.last_node();
            if (!system.begin_with(nodes.X(last), nodes.low(last),
                                   before.system().conditions()->momenta(true)))
                return false;
        }
        if (!system.residual()) return false;
    }
    return missed_->compare(phases_.front()->system().conditions()->point(false),
                            phases_.back()->system().conditions()->point(true), mesh_.end() - mesh_.start(),
                            [&](const NamedCoordinate& q, double from) {
                                for (const auto& phase : phases_)
                                    from = phase->system().followed(q, stated_, from);
                                return from;
                            });
}

/// Unknowns of phases stand one behind the other. The numbers behind them are of the model, which is another.
bool PhasesWindow::move(std::span<const double> dx, double damping)
{
    is_formed_ = false;
    for (const auto& phase : phases_) {
        const std::size_t n = n_of(*phase);
        if (!phase->system().move(dx.first(n), damping)) return false;
        dx = dx.subspan(n);
    }
    return true;
}

void PhasesWindow::keep()
{
    for (const auto& phase : phases_) phase->system().keep();
}

bool PhasesWindow::adopt(const BorderedWindow& other, bool is_pulled)
{
    const auto& others = static_cast<const PhasesWindow&>(other).phases_;
    is_formed_ = false;
    for (std::size_t k = 0; k < phases_.size(); ++k)
        if (!phases_[k]->system().adopt(others[k]->system(), is_pulled)) return false;
    return true;
}

double PhasesWindow::size_of(std::span<const double> dx) const
{
    double size = 0;
    for (const auto& phase : phases_) {
        const std::size_t n = n_of(*phase);
        const double here = phase->system().size_of(dx.first(n));
        if (!(here <= size) && !std::isnan(size)) size = here;
        dx = dx.subspan(n);
    }
    return size;
}

double PhasesWindow::scale() const
{
    double scale = 0;
    for (const auto& phase : phases_) scale = std::max(scale, phase->system().scale());
    return scale;
}

/// Conditions count by what they miss of their scales, as a share of the terms of balances.
NewtonProblem::Rows PhasesWindow::rows() const
{
    Rows all;
    for (const auto& phase : phases_) {
        const Rows of = phase->system().rows();
        all.size = std::max(all.size, of.size);
        all.terms = std::max(all.terms, of.terms);
        all.rounding = std::max(all.rounding, of.rounding);
        all.correction = std::max(all.correction, of.correction);
    }
    all.size = std::max(all.size, all.terms * missed_->largest());
    return all;
}

std::vector<double> PhasesWindow::rows_in(Formed formed)
{
    std::vector<double> all;
    for (std::size_t k = 0; k < phases_.size(); ++k) {
        const std::vector<double> of = phases_[k]->system().rows_in(*formed[k]);
        all.insert(all.end(), of.begin(), of.end());
    }
    all.insert(all.end(), missed_->rows().begin(), missed_->rows().end());
    return all;
}

void PhasesWindow::solve_for(const BorderedWindow& window, std::span<double> dx)
{
    const auto& other = static_cast<const PhasesWindow&>(window);
    std::vector<std::vector<double>> balances;
    for (const auto& phase : other.phases_)
        balances.push_back(phase->system().conditions()->behind(phase->system().balances().reduced()));
    solve_rows(other, balances, other.missed_->rows(), dx);
}

/// What rows of the size of rounding move, with signs that nobody chose.
Uncertainty PhasesWindow::uncertainty()
{
    constexpr int n_tries = 4;
    if (!is_formed_) return {1, "the motion with what is unknown of it", 1, {}};
    Uncertainty found;
    found.numbers.assign(static_cast<std::size_t>(ends_.n_numbers), 0.0);
    Scatter scatter;
    std::vector<double> dx(static_cast<std::size_t>(n_unknowns()));
    for (int i = 0; i < n_tries; ++i) {
        const auto sign = [&] { return scatter.next() < 0 ? -1.0 : 1.0; };
        std::vector<std::vector<double>> balances;
        for (const auto& phase : phases_) {
            std::vector<double> rows;
            for (const double rounding : phase->system().roundings())
                for (int j = 0; j < phase->f(); ++j) rows.push_back(sign() * rounding);
            rows.resize(static_cast<std::size_t>(phase->system().layout().n_nodes() * phase->f()));
            rows.resize(rows.size() + static_cast<std::size_t>(2 * phase->f()), 0.0);
            balances.push_back(std::move(rows));
        }
        std::vector<double> conditions = missed_->roundings();
        for (double& one : conditions) one *= sign();
        solve_rows(*this, balances, conditions, dx);
        const double moved = size_of(dx);
        if (moved > found.moved || std::isnan(moved)) found.moved = moved;
        for (std::size_t j = 0; j < found.numbers.size(); ++j)
            found.numbers[j] = std::max(found.numbers[j], std::abs(dx[dx.size() - found.numbers.size() + j]));
    }
    found.size = found.moved / scale();
    found.name = "the motion";
    return found;
}

}   // namespace livens::inline spacetime_internal
