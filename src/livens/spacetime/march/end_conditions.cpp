// SPDX-License-Identifier: BSD-3-Clause
// theory.md, "Conditions by component".
#include "livens/spacetime/march/end_conditions.h"

#include <algorithm>
#include <cmath>

#include "livens/multibody/model.h"
#include "livens/spacetime/march/components.h"

namespace livens::inline spacetime_internal {

MissedConditions::MissedConditions(const ModelTables& tables, const Ends& ends)
    : tables_(tables), ends_(ends), rows_(ends.components.size())
{
    for (const bool last : {false, true}) quantities_[last ? 1 : 0] = quantities_at(ends.components, last);
}

/// Rows are what is wanted less what is found. An angle at the start is taken in the turn of its value;
/// one at the end is followed from the start; of a change that forgets turns the part within half a turn
/// counts.
bool MissedConditions::compare(const EndPoint& first, const EndPoint& last, double duration,
                               const Followed& followed)
{
    duration_ = duration;
    largest_ = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Condition& condition = ends_.components[i];
        const StateQuantity& q = condition.quantity;
        const bool at_start = condition.at == Condition::At::start;
        double found = (at_start ? first : last).value(quantities_[at_start ? 0 : 1][i]);
        if (q.counts_turns() && !at_start && !condition.turn)
            found = followed(q.coordinate, start_of_turns(ends_, q));
        if (q.counts_turns() && at_start) found = turned_to(found, ends_.value(i));
        if (condition.at == Condition::At::both) {
            const double begin = first.value(q);
            found -= q.counts_turns() ? turned_to(begin, start_of_turns(ends_, q)) : begin;
            if (condition.forgets_turns && q.counts_turns()) found = turned_to(found, 0);
        }
        rows_[i] = ends_.value(i) - found;
        largest_ = std::max(largest_, std::abs(rows_[i]) / scale(i));
    }
    return all_finite(rows_) && are_known(Condition::At::end, first) && are_known(Condition::At::start, last);
}

/// Coordinates of the conditions at an end, which need not have a value at the other one.
bool MissedConditions::are_known(Condition::At without, const EndPoint& point) const
{
    for (const Condition& one : ends_.components)
        if (one.at != without && !point.is_known(one.quantity)) return false;
    return true;
}

double MissedConditions::scale(std::size_t i) const
{
    return scale_of(ends_.components[i], tables_.length, duration_);
}

std::vector<double> MissedConditions::roundings() const
{
    std::vector<double> all;
    for (std::size_t i = 0; i < rows_.size(); ++i) all.push_back(1e-16 * scale(i));
    return all;
}

/// A condition of both ends is the value at the end less that at the start. Of an end that a condition does
/// not ask zeros are set and not multiplied, since a derivative there may be no number.
DenseMatrix MissedConditions::derivatives(bool last, const EndPoint& point,
                                          const ConstraintBasis& basis) const
{
    DenseMatrix D = point.derivatives(quantities_[last ? 1 : 0], basis, 1 / duration_);
    for (int i = 0; i < D.rows; ++i) {
        const Condition::At at = ends_.components[i].at;
        const bool is_there = at != (last ? Condition::At::start : Condition::At::end);
        const double sign = !is_there ? 0 : at == Condition::At::both && !last ? -1 : 1;
        for (int j = 0; j < D.cols; ++j) D(i, j) = sign == 0 ? 0 : sign * D(i, j);
    }
    return D;
}

void FollowedAngle::pass(const double* X)
{
    for (std::size_t b = 0; b < X_.size(); ++b) std::copy_n(X + 12 * b, 12, X_[b].a);
    now_ = turned_to(coordinate_change(coordinate_.coordinate, stated_, X_), now_);
}

EndConditions::EndConditions(const ModelTables& tables, const Ends& ends)
    : tables_(tables), ends_(ends), missed_(tables, ends), points_{EndPoint(tables), EndPoint(tables)}
{
    for (const Body& body : tables.model->bodies()) stated_.push_back(body.X);
    for (auto* p : {&current_, &kept_})
        for (std::vector<double>& one : *p) one.assign(static_cast<std::size_t>(tables.n_twists), 0.0);
}

bool EndConditions::begin(bool last, const State& guess)
{
    EndPoint& point = points_[last ? 1 : 0];
    if (!point.place(guess)) return false;
    kept_[last ? 1 : 0] = current_[last ? 1 : 0] = point.momenta();
    return true;
}

void EndConditions::move(std::span<const double> dp, double damping)
{
    const auto n = static_cast<std::size_t>(tables_.n_twists);
    for (std::size_t end = 0; end < 2; ++end)
        for (std::size_t i = 0; i < n; ++i) current_[end][i] = kept_[end][i] + damping * dp[end * n + i];
}

/// Momenta become what joints leave of them at the places at hand, so that what is kept belongs to the chart
/// of the point where it is kept.
bool EndConditions::evaluate(const std::array<EndPlaces, 2>& ends, const MissedConditions::Followed& followed)
{
    for (std::size_t end = 0; end < 2; ++end) {
        const EndPlaces& at = ends[end];
        lengths_[end] = std::abs(at.length);
        if (!points_[end].place(at.t, at.X, at.X_low, current_[end])) return false;
        current_[end] = points_[end].momenta();
        if (at.told) points_[end].tell(at.told(current_[end]));
    }
    return missed_.compare(points_[0], points_[1], std::abs(ends[1].t - ends[0].t), followed);
}

std::vector<double> EndConditions::roundings() const
{
    std::vector<double> all = missed_.roundings();
    if (ends_.is_phase()) all.resize(static_cast<std::size_t>(2 * tables_.freedoms()), 0.0);
    return all;
}

/// Closing rows have 4 f columns: free motions at the start and at the end, then momenta along them at the
/// start and at the end. Of a phase they are the unit matrix for place and momentum at its start ("Phases
/// between conditions").
void EndConditions::differentiate(const std::array<const ConstraintBasis*, 2>& bases)
{
    const int f = tables_.freedoms(),
              m = ends_.is_phase() ? 2 * f : static_cast<int>(ends_.components.size());
    closing_.assign(static_cast<std::size_t>(m) * 4 * static_cast<std::size_t>(f), 0.0);
    for (const int end : {0, 1}) {
        const ConstraintBasis& basis = *bases[static_cast<std::size_t>(end)];
        DenseMatrix D(m, 2 * f);
        if (!ends_.is_phase()) D = missed_.derivatives(end == 1, points_[end], basis);
        for (int i = 0; ends_.is_phase() && end == 0 && i < m; ++i) D(i, i) = 1;
        for (int i = 0; i < m; ++i) {
            double* row = closing_.data() + static_cast<std::ptrdiff_t>(i) * 4 * f;
            for (int j = 0; j < f; ++j) {
                row[end * f + j] = D(i, j);
                row[(2 + end) * f + j] = D(i, f + j);
            }
        }
        along_[end] = DenseMatrix(tables_.n_twists, f);
        for (int j = 0; j < f; ++j)
            points_[end].momenta_along(basis, points_[end].maps(), j, along_[end].column(j).data());
    }
}

void EndConditions::to_momenta(const double* along, double* dp) const
{
    const auto f = static_cast<std::size_t>(tables_.freedoms()),
               n = static_cast<std::size_t>(tables_.n_twists);
    for (std::size_t end = 0; end < 2; ++end) {
        const std::vector<double> one = product(along_[end], {along + end * f, f});
        std::copy(one.begin(), one.end(), dp + end * n);
    }
    std::copy_n(along + 2 * f, n_joins() + ends_.n_numbers, dp + 2 * n);
}

/// A number that is none stays, whatever the other end has.
double EndConditions::size_of(std::span<const double> dp) const
{
    const auto n = static_cast<std::size_t>(tables_.n_twists);
    double size = 0;
    std::vector<double> p(n);
    for (std::size_t end = 0; end < 2; ++end) {
        std::copy_n(dp.begin() + static_cast<std::ptrdiff_t>(end * n), n, p.begin());
        const double here = lengths_[end] * points_[end].size_of_momenta(p);
        if (!(here <= size) && !std::isnan(size)) size = here;
    }
    return size;
}

}   // namespace livens::inline spacetime_internal
