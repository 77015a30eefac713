// SPDX-License-Identifier: BSD-3-Clause
// How far nodes are off their constraints: from the element's first node on, where quadratic by the exact
// identity for changes (docs/theory.md, "Increments").
#include <algorithm>
#include <cmath>
#include <vector>

#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/nodal/nodes.h"

namespace livens {

namespace {

/// Nothing to correct, where it is the rounding of Phi at the start itself.
inline double without_rounding(double phi, double scale)
{
    constexpr double rounding = 1e-16;
    return std::abs(phi) < rounding * scale ? 0 : phi;
}

}   // namespace

/// Of Phi in row c, from the element's first node, which keeps the digits of a small increment; Phi itself at
/// the first node of all.
auto Nodes::change_at(int e, int B, double* work) const
{
    const ConstraintBasis &first = basis(e * rule_.degree), &own = bases_[e * rule_.degree + B];
    return [this, e, B, work, &first, &own, step = dX(e, B)](int c, int row, bool is_quadratic) {
        const int A = e * rule_.degree + B;
        return B == 0         ? tables_.rows.value(row, at(A), X(A), own.gradient(c))
               : is_quadratic ? tables_.rows.change(row, first.gradient(c), own.gradient(c), step)
                              : followed(e, B, c, work);
    };
}

template <class Change>
void Nodes::add_violations(int e, int B, const Change& change, double& sum)
{
    const int A = e * rule_.degree + B, k = tables_.rank, before = B > 0 ? -k : 0, first = -B * k;
    const int* row = bases_[A].rows.data();
    double* violations = phi_.data() + A * k;
    for (int c = 0; c < k; ++c) {
        const auto& table = tables_.rows[row[c]];
        double phi = change(c, row[c], table.is_quadratic);
        if (B > 0) phi = violations[c + (table.is_quadratic ? first : before)] + phi;
        violations[c] = without_rounding(phi, table.row->scale);
    }
    look_at(A, sum, near_);
}

void Nodes::look_at(int A, double& sum, bool& is_near)
{
    constexpr double close = 1e-4;   // relative, for one linear step onto the constraints
    const int k = tables_.rank;
    const int* row = bases_[A].rows.data();
    double *violations = phi_.data() + A * k, *scaled = scaled_.data() + A * k;
    for (int c = 0; c < k; ++c) {
        const double phi = violations[c];
        if (!(std::abs(phi) <= close * tables_.rows[row[c]].row->scale)) is_near = false;
        scaled[c] = phi * bases_[A].row_scale(c);
        sum += std::abs(phi);
    }
}

/// From how they change from the first node of their element on, which stand in their places: along the ends
/// of elements first. False: one is not finite.
bool Nodes::add_up_in_shares(const WindowLayout& layout)
{
    const int n = layout.n_elements(), p = rule_.degree, k = tables_.rank;
    const auto add = [&](int from, int A) {
        const int* row = bases_[A].rows.data();
        double *first = phi_.data() + from * k, *violations = phi_.data() + A * k;
        for (int c = 0; c < k; ++c) {
            const double phi = A > from ? first[c] + violations[c] : violations[c];
            violations[c] = without_rounding(phi, tables_.rows[row[c]].row->scale);
        }
    };
    if (layout.is_unknown(0)) add(0, 0);
    for (int e = 0; e < n; ++e)
        if (layout.is_unknown((e + 1) * p)) add(e * p, (e + 1) * p);
    std::vector<char> are_near(work_.size(), 1), are_finite(work_.size(), 1);
    in_shares(n, least_shared, [&](int slot, int begin, int end) {
        double sum = 0;
        bool is_near = true;
        if (begin == 0 && layout.is_unknown(0)) look_at(0, sum, is_near);
        for (int e = begin; e < end; ++e)
            for (int A = e * p + 1; A <= (e + 1) * p && layout.is_unknown(A); ++A) {
                if (A < (e + 1) * p) add(e * p, A);
                look_at(A, sum, is_near);
            }
        are_near[slot] = is_near;
        are_finite[slot] = std::isfinite(sum);
    });
    near_ = std::ranges::count(are_near, 0) == 0;
    return std::ranges::count(are_finite, 0) == 0;
}

/// Bases come first, of as many nodes at a time as there are lanes, and violations last, which add up along
/// the nodes.
bool Nodes::constrain(const WindowLayout& layout, bool same_choices)
{
    near_ = true;
    begin_constraining();
    const int n = layout.n_elements(), degree = rule_.degree;
    in_shares(n, least_shared, [&](int slot, int begin, int end) {
        for (int e = begin; e < end; ++e) {
            Patience::ask();
            take_differences(e);
        }
        const int first = begin == 0 && layout.is_unknown(0) ? 0 : begin * degree + 1, last = end * degree;
        build_bases(slot, first, layout.is_unknown(last) ? last + 1 : last, same_choices);
    });
    const auto for_nodes = [&](int e, const auto& act) {
        const int last = layout.is_unknown((e + 1) * degree) ? degree : degree - 1;
        for (int B = e == 0 && layout.is_unknown(0) ? 0 : 1; B <= last; ++B) act(B);
    };
    double sum = 0;
    if (!Crew::divides(n, least_shared)) {
        for (int e = 0; e < n; ++e)
            for_nodes(e, [&](int B) { add_violations(e, B, change_at(e, B, work_[0].data()), sum); });
        return std::isfinite(sum);
    }
    const auto find_changes = [&](int slot, int e) {
        for_nodes(e, [&](int B) {
            const auto change = change_at(e, B, work_[slot].data());
            double* changes = phi_.data() + (e * degree + B) * tables_.rank;
            const int* row = bases_[e * degree + B].rows.data();
            for (int c = 0; c < tables_.rank; ++c)
                changes[c] = change(c, row[c], tables_.rows[row[c]].is_quadratic);
        });
    };
    if (std::ranges::all_of(rows(), [this](int r) { return tables_.rows[r].is_quadratic; })) {
        in_shares(n, least_shared, [&](int slot, int begin, int end) {
            for (int e = begin; e < end; ++e) find_changes(slot, e);
        });
        return add_up_in_shares(layout);
    }
    in_order_behind({n, least_shared, 0.2}, find_changes, [&](int e) {
        for_nodes(e, [&](int B) {
            const double* changes = phi_.data() + (e * degree + B) * tables_.rank;
            add_violations(e, B, [changes](int c, int, bool) { return changes[c]; }, sum);
        });
        return true;
    });
    return std::isfinite(sum);
}

/// The change of Phi from the node before, so that angles are followed through several turns.
double Nodes::followed(int e, int B, int c, double* work) const
{
    const int A = e * rule_.degree + B;
    const ConstraintRow& row = *tables_.rows[bases_[A].rows[c]].row;
    const double* step = dX(e, B);
    for (std::size_t i = 0; i < size_; ++i) work[i] = B > 1 ? step[i] - dX(e, B - 1)[i] : step[i];
    return constraint_change(row, at(A - 1), Configurations(X(A - 1)), at(A), Configurations(X(A)),
                             Configurations(work));
}

}   // namespace livens
