// SPDX-License-Identifier: BSD-3-Clause
// Each phase is condensed by a start that is what it is: increments are sums of what its rows ask for, of its
// start, which is the end of the phase before, and of numbers. Conditions see the first start and the last
// end, and make a small system of what is unknown there (docs/theory.md, "Phases between conditions").
#include <algorithm>
#include <array>
#include <cmath>

#include "livens/spacetime/nodal/elimination.h"
#include "livens/spacetime/nodal/phases_window.h"

namespace livens::inline spacetime_internal {

/// Copies: factors serve several steps, in which nodes move on.
PhasesWindow::Frame PhasesWindow::frame_of(const Phase& phase, int node)
{
    const Nodes& nodes = phase.system().nodes();
    const auto n = static_cast<std::ptrdiff_t>(12 * phase.tables.bodies.size());
    Frame frame{{nodes.X(node), nodes.X(node) + n}, {nodes.maps(node), nodes.maps(node) + n}, {}};
    frame.z = DenseMatrix(phase.tables.n_twists, phase.f());
    for (int j = 0; j < phase.f(); ++j) {
        frame.z(phase.tables.rank + j, j) = 1;
        nodes.basis(node).q.apply(frame.z.column(j).data());
    }
    return frame;
}

std::vector<double> PhasesWindow::along(const Phase& phase, const Frame& frame, std::span<const double> twist,
                                        std::span<const double> momenta)
{
    const BodyTables& bodies = phase.tables.bodies;
    std::vector<double> rates(frame.X.size()), raw(rates), q(twist.size()), y(q), all;
    bodies.rates_of(frame.X.data(), twist.data(), rates.data());
    bodies.times_mass(rates.data(), 1.0, raw.data());
    bodies.twist_rows(frame.X.data(), frame.maps.data(), raw.data(), q.data());
    bodies.to_scaled_rows(frame.maps.data(), q.data(), y.data());   // D^T M D = 1
    all = transposed_product(frame.z, y);
    EndMomentum momentum;
    momentum.about_reference.assign(momenta.begin(), momenta.end());
    std::ranges::fill(y, 0.0);
    momentum.add_to(phase.tables, frame.maps.data(), 1, y.data());
    const std::vector<double> p = transposed_product(frame.z, y);
    all.insert(all.end(), p.begin(), p.end());
    return all;
}

std::vector<double> PhasesWindow::end_along(std::size_t k, std::span<const double> dx) const
{
    const auto n = static_cast<std::size_t>(phases_[k]->tables.n_twists);
    // nodes, the momenta at the start, those at the end
    return along(*phases_[k], responses_[k].end, dx.subspan(dx.size() - 3 * n, n), dx.last(n));
}

/// The start of the next phase by the end of this one. Momenta stay what they are in world axes while the
/// bodies move, but for what the joints of this phase take off.
DenseMatrix PhasesWindow::handed_on(std::size_t k) const
{
    constexpr std::array<std::array<double, 2>, 4> rule{
        {{-2, 1.0 / 12}, {-1, -8.0 / 12}, {1, 8.0 / 12}, {2, -1.0 / 12}}};
    constexpr double step = 1e-3;   // lengths and radians
    const Phase &phase = *phases_[k], &next = *phases_[k + 1];
    const Frame& end = responses_[k].end;
    const Frame start = frame_of(next, 0);
    const EndPoint& point = phase.system().conditions()->point(true);
    const ConstraintBasis& basis = phase.system().nodes().basis(phase.last_node());
    const int f = phase.f();
    const auto n = static_cast<std::size_t>(phase.tables.n_twists);
    DenseMatrix by_end(2 * next.f(), 2 * f);
    const auto take = [&](int j, const std::vector<double>& twist, const std::vector<double>& momenta) {
        const std::vector<double> column = along(next, start, twist, momenta);
        std::ranges::copy(column, by_end.column(j).begin());
    };
    EndPoint moved(phase.tables);
    for (int j = 0; j < f; ++j) {
        std::vector<double> twist(n), y(n), momenta(n, 0.0);
        const auto z = end.z.column(j);
        phase.tables.bodies.to_twist(end.maps.data(), z.data(), twist.data());
        const double h = step / point.size_along(basis, end.maps.data(), j);
        for (const auto& [times, weight] : rule) {
            for (std::size_t i = 0; i < n; ++i) y[i] = times * h * z[i];
            if (!moved.place_moved(point, y.data(), point.momenta())) momenta[0] = std::nan("");
            for (std::size_t i = 0; i < n; ++i)
                momenta[i] += weight / h * (moved.momenta()[i] - point.momenta()[i]);
        }
        take(j, twist, momenta);
        point.momenta_along(basis, end.maps.data(), j, momenta.data());
        take(f + j, std::vector<double>(n, 0.0), momenta);
    }
    return by_end;
}

/// Increments of a phase by its start and by numbers.
/// The last 2 f rows of a phase are its closing ones: of a right-hand side that is 1 in one of them the start
/// moves by one free motion, or by the momentum along it, and all else follows.
void PhasesWindow::respond(std::size_t k, const DenseMatrix& by_numbers, std::size_t first_row)
{
    Phase& phase = *phases_[k];
    Response& of = responses_[k];
    const int f = phase.f();
    const std::size_t n_rows =
        phase.system().conditions()->behind(phase.system().balances().reduced()).size();
    std::vector<double> rows(n_rows, 0.0);
    of.end_by_start = DenseMatrix(2 * f, 2 * f);
    of.end_by_numbers = DenseMatrix(2 * f, by_numbers.cols);
    const auto solved = [&](DenseMatrix& ends, int j) {
        std::vector<double> dx(n_of(phase));
        phase.system().solve_rows(phase.system(), rows, dx);
        std::ranges::copy(end_along(k, dx), ends.column(j).begin());
        return dx;
    };
    for (int j = 0; j < 2 * f; ++j) {
        double& row = rows[n_rows - static_cast<std::size_t>(2 * f - j)];
        row = 1;
        of.by_start.push_back(solved(of.end_by_start, j));
        row = 0;
    }
    for (int j = 0; j < by_numbers.cols; ++j) {
        const auto column = by_numbers.column(j).subspan(first_row, n_rows);
        std::ranges::transform(column, rows.begin(), [](double v) { return -v; });
        of.by_numbers.push_back(solved(of.end_by_numbers, j));
    }
}

bool PhasesWindow::factorise()
{
    std::vector<Elimination*> formed;
    for (const auto& phase : phases_) {
        if (!phase->system().factorise()) return false;
        formed.push_back(phase->system().elimination());
    }
    const DenseMatrix by_numbers = columns_ && ends_.n_numbers > 0 ? columns_(formed) : DenseMatrix();
    responses_.assign(phases_.size(), {});
    std::size_t row = 0;
    for (std::size_t k = 0; k < phases_.size(); ++k) {
        responses_[k].end = frame_of(*phases_[k], phases_[k]->last_node());
        respond(k, by_numbers, row);
        row += phases_[k]->system().conditions()->behind(phases_[k]->system().balances().reduced()).size();
        if (k + 1 < phases_.size()) responses_[k].start_by_end = handed_on(k);
    }
    is_formed_ = condense(by_numbers);
    return is_formed_;
}

/// The system of the conditions: for the start, if it is not known, and for numbers.
bool PhasesWindow::condense(const DenseMatrix& by_numbers)
{
    const int m = static_cast<int>(missed_->rows().size()), n = n_all(), s = n_start();
    const auto& first = phases_.front()->system();
    const auto& last = phases_.back()->system();
    start_rows_ = missed_->derivatives(false, first.conditions()->point(false), first.nodes().basis(0));
    end_rows_ = missed_->derivatives(true, last.conditions()->point(true),
                                     last.nodes().basis(phases_.back()->last_node()));
    if (m != n) return false;   // refused before
    condensed_.resize(n);
    for (std::size_t k = 0; k < phases_.size(); ++k)
        responses_[k].start_by_all = DenseMatrix(2 * phases_[k]->f(), n);
    for (int c = 0; c < n; ++c) {
        std::vector<double> start(static_cast<std::size_t>(2 * phases_.front()->f()), 0.0), end;
        if (c < s) start[c] = 1;
        const std::vector<double> first_start = start;
        for (std::size_t k = 0; k < phases_.size(); ++k) {
            const Response& of = responses_[k];
            std::ranges::copy(start, responses_[k].start_by_all.column(c).begin());
            end = product(of.end_by_start, start);
            if (c >= s) add_scaled(end, 1, of.end_by_numbers.column(c - s));
            if (k + 1 < phases_.size()) start = product(of.start_by_end, end);
        }
        const std::vector<double> at_start = product(start_rows_, first_start),
                                  at_end = product(end_rows_, end);
        for (int i = 0; i < m; ++i) {
            double value = at_start[i] + at_end[i];
            if (c >= s) value += by_numbers(by_numbers.rows - m + i, c - s);
            condensed_.row(i)[c] = value / missed_->scale(i);
        }
    }
    return condensed_.factorise();
}

/// First along the phases, with numbers and a first start that stay; conditions then tell both, and each
/// phase adds what its own start, which has moved likewise, and numbers make of it.
void PhasesWindow::solve_rows(const PhasesWindow& other, const std::vector<std::vector<double>>& balances,
                              const std::vector<double>& conditions, std::span<double> dx)
{
    const std::size_t n = phases_.size();
    std::vector<std::vector<double>> starts(n);
    starts[0].assign(static_cast<std::size_t>(2 * phases_.front()->f()), 0.0);
    std::vector<double> end;
    std::span<double> to = dx;
    for (std::size_t k = 0; k < n; ++k) {
        const std::span<double> of = to.first(n_of(*phases_[k]));
        phases_[k]->system().solve_rows(other.phases_[k]->system(), balances[k], of);
        end = end_along(k, of);
        add_scaled(end, 1, product(responses_[k].end_by_start, starts[k]));
        if (k + 1 < n) starts[k + 1] = product(responses_[k].start_by_end, end);
        to = to.subspan(of.size());
    }
    const std::vector<double> at_end = product(end_rows_, end);
    std::vector<double> x(conditions);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = (x[i] - at_end[i]) / missed_->scale(i);
    condensed_.solve(x.data());
    std::ranges::copy(std::span(x).subspan(static_cast<std::size_t>(n_start())), to.begin());
    to = dx;
    for (std::size_t k = 0; k < n; ++k) {
        const Response& of = responses_[k];
        const std::span<double> here = to.first(n_of(*phases_[k]));
        add_scaled(starts[k], 1, product(of.start_by_all, x));
        for (std::size_t i = 0; i < of.by_start.size(); ++i) add_scaled(here, starts[k][i], of.by_start[i]);
        for (std::size_t i = 0; i < of.by_numbers.size(); ++i)
            add_scaled(here, x[static_cast<std::size_t>(n_start()) + i], of.by_numbers[i]);
        to = to.subspan(here.size());
    }
}

}   // namespace livens::inline spacetime_internal
