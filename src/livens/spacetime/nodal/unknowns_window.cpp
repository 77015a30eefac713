// SPDX-License-Identifier: BSD-3-Clause
// Rows of one model are solved with columns that compare it with others: theory.md, "Unknown numbers".
#include "livens/spacetime/nodal/unknowns_window.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/base/text.h"
#include "livens/multibody/model.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/nodal/window.h"

namespace livens::inline spacetime_internal {

UnknownsWindow::Maker nodal_windows(const ElementRule& rule, bool look_at_laws)
{
    struct Own {
        Own(const NumberedProblem::Instance& of, const ElementRule& rule)
            : tables(*of.rebuilt.model, of.ends.independent), window(tables, of.mesh, of.ends, rule)
        {}
        ModelTables tables;
        NodalWindow window;
    };
    return [=](const NumberedProblem::Instance& of) -> std::shared_ptr<BorderedWindow> {
        auto own = std::make_shared<Own>(of, rule);
        if (!look_at_laws) own->window.ignore_laws();
        return {own, &own->window};
    };
}

UnknownsWindow::UnknownsWindow(const NumberedProblem& problem, const std::vector<double>& begin, Maker maker,
                               FoundNumbers& found)
    : Window(static_cast<ElementMonitor&>(*this)), problem_(problem), begin_(begin), maker_(std::move(maker)),
      found_(found)
{
    begin_.resize(static_cast<std::size_t>(problem.size()), 0.0);   // nothing is unfolded yet
}

/// Null means in move() that a step was too long, in open() the end. The reason is kept for the message.
UnknownsWindow::Shared UnknownsWindow::make(const std::vector<double>& values)
{
    Patience::ask();
    NumberedProblem::Tried tried = problem_.try_at(values);
    if (tried.made) {
        auto made = std::make_shared<Instance>(Instance{values, std::move(*tried.made), nullptr});
        made->window = maker_(made->of);
        SolveReport report;
        if (made->window->open(first_, last_, report)) return made;
        why_ = report.message;
    } else {
        why_ = tried.why.message;
    }
    for (int i = 0; i < problem_.size(); ++i)
        why_ += std::string(i == 0 ? " where '" : ", '") + problem_[i].name + "' is " + to_text(values[i], 6);
    return nullptr;
}

bool UnknownsWindow::open(int first, int last, SolveReport& report)
{
    first_ = first;
    last_ = last;
    now_ = kept_ = make(begin_);
    formed_ = nullptr;
    if (now_ != nullptr) return true;
    report.status = SolveStatus::singular;
    report.message = why_;
    return false;
}

/// Meshes are stretched with numbers of time; the guess is asked on the problem's own mesh.
bool UnknownsWindow::start_from(const Guess& guess)
{
    SolveReport report;
    if (!guess || !open(first_, last_, report)) return false;
    return now_->window->start_from(
        [&](double t) { return guess(carried_to(now_->of.mesh, t, problem_.mesh())); });
}

bool UnknownsWindow::factorise()
{
    formed_ = now_;
    now_->window->border_with([this](Formed formed) { return columns(formed); });
    return now_->window->factorise();
}

/// Rows with the opposite sign are what columns have on the other side.
DenseMatrix UnknownsWindow::columns(Formed formed)
{
    const std::size_t n = now_->window->rows_in(formed).size();
    DenseMatrix all(static_cast<int>(n), problem_.size());
    for (int i = 0; i < problem_.size(); ++i)
        for (const NumberedProblem::Sample& sample : problem_.samples(i, now_->values[i]))
            if (!add_sample(i, sample, formed, all.column(i))) std::ranges::fill(all.column(i), std::nan(""));
    return all;
}

/// Nodes keep their X and are pulled onto the joints of the other model. Its rows are carried to the axes and
/// null spaces of the factors before differences are taken.
bool UnknownsWindow::add_sample(int i, const NumberedProblem::Sample& sample, Formed formed,
                                std::span<double> column)
{
    std::vector<double> values = now_->values;
    values[i] = sample.value;
    const Shared other = make(values);
    if (other == nullptr) return false;
    if (!other->window->adopt(*now_->window, true) || !other->window->equations().residual()) return false;
    const std::vector<double> rows = other->window->rows_in(formed);
    for (std::size_t k = 0; k < rows.size(); ++k) column[k] -= sample.weight * rows[k];
    return true;
}

void UnknownsWindow::solve(std::span<double> dx) { formed_->window->solve_for(*now_->window, dx); }

/// From the kept point, in a window of the new model. A number that would pass its bound stays at it.
bool UnknownsWindow::move(std::span<const double> dx, double damping)
{
    now_ = kept_;
    if (damping == 0) return true;
    std::vector<double> values = kept_->values;
    const std::span<const double> numbers = numbers_in(dx);
    for (int i = 0; i < problem_.size(); ++i)
        values[i] = std::clamp(values[i] + damping * problem_.scale(i) * numbers[i], problem_[i].low,
                               problem_[i].high);
    const Shared other = make(values);
    if (other == nullptr) return false;
    const bool is_placed =
        other->window->adopt(*kept_->window, false) && other->window->equations().move(dx, damping);
    now_ = other;
    return is_placed;
}

void UnknownsWindow::keep()
{
    now_->window->equations().keep();
    kept_ = now_;
}

/// Numbers count by their scales. A nan stays: it is neither passed by nor replaced.
double UnknownsWindow::size_of(std::span<const double> dx) const
{
    double size = now_->window->equations().size_of(dx);
    for (const double number : numbers_in(dx))
        if (!(std::abs(number) <= size) && !std::isnan(size)) size = std::abs(number);
    return size;
}

AcceptedElements UnknownsWindow::close(const AcceptanceCriteria& criteria, SolveReport& report)
{
    is_formed_ = factorise();   // as long as nodes have their bases, of which closing takes some
    found_.left.clear();
    std::vector<double> dx(static_cast<std::size_t>(n_unknowns()));
    if (is_formed_ && residual()) solve(dx);
    for (int i = 0; i < problem_.n_stated(); ++i)
        found_.left.push_back(std::abs(numbers_in(dx)[i]) * problem_.scale(i));
    const AcceptedElements closed = now_->window->close(criteria, report);
    const auto n_stated = problem_.n_stated();
    found_.values.assign(now_->values.begin(), now_->values.begin() + n_stated);
    found_.unfolded.assign(now_->values.begin() + n_stated, now_->values.end());
    if (n_stated > 0) found_.rebuilt = now_->of.rebuilt;
    return closed;
}

/// Without factors nothing is known to be determined.
Uncertainty UnknownsWindow::uncertainty()
{
    if (!is_formed_) return {1, "the motion with its unknown numbers", 1};
    Uncertainty found = now_->window->monitor().uncertainty();
    for (int i = 0; i < problem_.size(); ++i) {
        const double moved = found.numbers.empty() ? 0 : found.numbers[i];
        if (moved <= found.size) continue;
        found.size = moved;
        found.name = "the unknown '" + problem_[i].name + "'";
    }
    return found;
}

std::string UnknownsWindow::bounds_reached() const
{
    std::string all;
    for (int i = 0; i < problem_.size(); ++i) {
        const UnknownNumber& number = problem_[i];
        const double value = kept_->values[i];
        const bool is_low = value <= number.low, is_high = value >= number.high;
        if (is_low || is_high)
            all += "; the unknown '" + number.name + "' has come to its " + (is_low ? "lower" : "upper") +
                   " bound " + to_text(value, 6);
    }
    return all;
}

void UnknownsWindow::describe(SolveReport& report) const
{
    if (now_ != nullptr) now_->window->describe(report);
    if (kept_ == nullptr) return;
    const std::string bounds = bounds_reached();
    if (!report.converged()) {
        report.message += bounds;
        if (!why_.empty()) report.message += "; no model is made: " + why_;
    } else if (!bounds.empty()) {
        report.notes.push_back(bounds.substr(2));
    }
}

}   // namespace livens::inline spacetime_internal
