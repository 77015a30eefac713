// SPDX-License-Identifier: BSD-3-Clause
// Solutions with the factors of a chain: right-hand sides go through its panels in the order of their
// elimination, solutions back; transposed, the same panels the same ways.
#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

#include "livens/solvers/crew.h"
#include "livens/solvers/detail/chain.h"
#include "livens/solvers/short_rows.h"

namespace livens::inline solvers_internal {

namespace {

using Values = std::vector<double>;

/// Of a right-hand side through a panel, some allocations and copies with it.
double cost_of_pass(const Panel& panel) { return 500.0 + panel.n_pivots() * panel.width(); }

void take(const double*& from, Values& to, int n)
{
    to.assign(from, from + n);
    from += n;
}

}   // namespace

/// One step of refinement.
void ChainSolver::solve(std::span<double> x, bool is_transposed) const
{
    assert(is_regular_ && x.size() == work_.right_side.size() && !(is_transposed && ends_ != nullptr));
    const auto invert = [&](double* v) { is_transposed ? apply_inverse_transposed(v) : apply_inverse(v); };
    std::copy(x.begin(), x.end(), work_.right_side.begin());
    invert(x.data());
    subtract_product(x.data(), work_.right_side.data(), is_transposed);
    invert(work_.right_side.data());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += work_.right_side[i];
}

/// Nothing but the closing system has a right-hand side then.
void ChainSolver::solve_closing(std::span<const double> rows, std::span<double> ends) const
{
    assert(is_regular_ && n_links() > 0 && static_cast<int>(ends.size()) == closing_.n_pivots());
    work_.front.assign(ends.size() - rows.size(), 0.0);
    work_.front.insert(work_.front.end(), rows.begin(), rows.end());
    closing_.apply(work_.front.data());
    closing_.solve(work_.front.data());
    std::copy(work_.front.begin(), work_.front.end(), ends.begin());
}

/// y -= A x or A^T x.
void ChainSolver::subtract_product(const double* x, double* y, bool is_transposed) const
{
    const RowFunctions& rows = row_functions();
    const auto take = [&](int i, int j, const double* values, int n) {
        if (is_transposed)
            subtract_scaled(rows, y + j, x[i], values, n);
        else
            y[i] -= inner(rows, values, x + j, n);
        return values + n;
    };
    const int behind = first_unknown_.empty() ? 0 : first_unknown_.back();
    const auto take_rows = [&](int e, int begin, int end) {
        const Link& link = links_[static_cast<std::size_t>(e)];
        const int n = matrix_.n_columns(e), i0 = row(link.first), j0 = unknown(link.first);
        const double* value = matrix_.storage(e).data() + static_cast<std::ptrdiff_t>(begin) * n;
        const double* seen = matrix_.border_storage(e).data() + static_cast<std::ptrdiff_t>(begin) * border();
        for (int i = begin; i < end; ++i) {
            value = take(i0 + i, j0, value, n);
            seen = take(i0 + i, behind, seen, border());
        }
    };
    const auto far_rows = [&](int e) {
        return matrix_.n_rows(e) - links_[static_cast<std::size_t>(e)].r_far;
    };
    if (is_transposed)
        for (int e = 0; e < n_links(); ++e) take_rows(e, 0, matrix_.n_rows(e));
    else   // each all of its rows, in the order of elements, that nobody waits for another
        for_each_item(n_links(), least_shared_links, [&](int e) {
            if (e > 0) take_rows(e - 1, far_rows(e - 1), matrix_.n_rows(e - 1));
            take_rows(e, 0, e + 1 < n_links() ? far_rows(e) : matrix_.n_rows(e));
        });
    if (n_links() == 0) return;
    const int first = structure_->n_unknowns.front(), last = structure_->n_unknowns.back();
    const double* value = matrix_.closing().data();
    for (int i = 0; i < structure_->n_closing; ++i) {
        value = take(first_row_.back() + i, 0, value, first);
        value = take(first_row_.back() + i, behind - last, value, last + border());
    }
}

/// Right-hand side of an element: what its own unknowns have of it, and what is left.
void ChainSolver::eliminate_inside(const Link& link, const double* x) const
{
    const double* from = x + row(link.first);
    Values rows(static_cast<std::size_t>(link.inside.n_rows()), 0.0);
    std::copy_n(from + link.r_near, link.r_own, rows.begin());
    std::copy_n(from, link.r_near, rows.begin() + link.r_own);
    // a balance that two elements share is on the right of the later one
    if (&link == &links_.back())
        std::copy_n(from + link.r_near + link.r_own, link.r_far, rows.end() - link.r_far);
    link.inside.apply(rows.data());
    std::copy_n(rows.begin(), link.n_own, link.inside_values.begin());
    std::copy(rows.begin() + link.n_own, rows.end(), link.left_values.begin());
}

/// x, by rows, <- A^-1 x, by unknowns.
void ChainSolver::apply_inverse(double* x) const
{
    if (n_links() == 0) return;
    work_.front.clear();
    const auto take_in = [&](int e) {
        const Link& link = links_[static_cast<std::size_t>(e)];
        work_.front.insert(work_.front.end(), link.left_values.begin(), link.left_values.end());
        if (e == 0) return true;
        const auto n = static_cast<std::ptrdiff_t>(link.merged_values.size());
        link.merged.apply(work_.front.data());
        std::copy_n(work_.front.begin(), n, link.merged_values.begin());
        work_.front.erase(work_.front.begin(), work_.front.begin() + n);
        return true;
    };
    in_order_behind(
        in_order(cost_of_pass), [&](int, int e) { eliminate_inside(links_[static_cast<std::size_t>(e)], x); },
        take_in);
    work_.front.insert(work_.front.end(), x + first_row_.back(),
                       x + first_row_.back() + structure_->n_closing);
    if (ends_ != nullptr) {
        work_.others.resize(
            static_cast<std::size_t>(n_carried_ + structure_->n_unknowns.back() + structure_->n_border));
        ends_->solve(work_.front, work_.others);
        work_.front.swap(work_.others);
    } else {
        closing_.apply(work_.front.data());
        closing_.solve(work_.front.data());
    }
    substitute(x);
}

/// From what the closing rows gave, which stands in work_.front: carried, far, border. Back along the
/// elements, with their own unknowns behind.
void ChainSolver::substitute(double* x) const
{
    const int far = links_.back().n_far, last = n_links() - 1;
    const double* carried = work_.front.data();
    std::copy_n(carried + n_carried_ + far, border(), x + first_unknown_.back());
    std::copy_n(carried + n_carried_, far, x + unknown(links_.back().last));
    std::copy_n(carried, n_carried_, x);
    work_.passed.clear();   // at the far end
    in_order_ahead(
        in_order(cost_of_pass),
        [&](int i) {
            if (i < last) substitute_between(links_[static_cast<std::size_t>(last - i)], x);
        },
        [&](int, int i) { substitute_inside(links_[static_cast<std::size_t>(last - i)], x); });
}

/// Unknowns at the near end of an element, and what passes there, which takes the place of the rows merged.
void ChainSolver::substitute_between(const Link& link, double* x) const
{
    const double *carried = work_.front.data(), *of_far = x + unknown(link.last);
    const double* of_border = x + first_unknown_.back();
    Values& merged = link.merged_values;
    work_.others.assign(merged.begin(), merged.end());
    work_.others.insert(work_.others.end(), carried, carried + n_carried_);
    work_.others.insert(work_.others.end(), of_far, of_far + link.n_far);
    work_.others.insert(work_.others.end(), of_border, of_border + border());
    work_.others.insert(work_.others.end(), work_.passed.begin(), work_.passed.end());
    link.merged.solve(work_.others.data());
    std::copy_n(work_.others.begin(), merged.size(), merged.begin());
    std::copy_n(merged.begin() + link.p_near, link.n_near, x + unknown(link.first));
    work_.passed.assign(merged.begin(), merged.begin() + link.p_near);
}

/// An element's own unknowns.
void ChainSolver::substitute_inside(const Link& link, double* x) const
{
    const double *of_near = x + unknown(link.first), *of_far = x + unknown(link.last);
    const double* of_border = x + first_unknown_.back();
    Values all;
    all.reserve(static_cast<std::size_t>(link.inside.width()));
    all = link.inside_values;
    const auto passes = [&all](const Values& merged, int n) {
        all.insert(all.end(), merged.begin(), merged.begin() + n);
    };
    all.insert(all.end(), of_near, of_near + link.n_near);
    all.insert(all.end(), of_far, of_far + link.n_far);
    all.insert(all.end(), of_border, of_border + border());
    passes(link.merged_values, link.p_near);
    if (link.p_far > 0) passes((&link + 1)->merged_values, link.p_far);   // the next element's
    link.inside.solve(all.data());
    std::copy_n(all.begin(), link.n_own, x + unknown(link.first) + link.n_near);
}

/// Of an element in a transposed solution: what its own unknowns leave to near, far, border and what passes.
void ChainSolver::eliminate_own_transposed(const Link& link, const double* x) const
{
    std::copy_n(x + unknown(link.first) + link.n_near, link.n_own, link.inside_values.begin());
    link.passed_on.assign(static_cast<std::size_t>(link.inside.width() - link.inside.n_pivots()), 0.0);
    link.inside.solve_transposed(link.inside_values.data(), link.passed_on.data());
}

/// What stands at its near end then, and what is carried, go on to its far end.
void ChainSolver::eliminate_transposed(const Link& link, const double* x) const
{
    const bool is_first = &link == &links_.front();
    auto& [right_side, front, passed, others, carried, of_border, near] = work_;
    const double* of_far = x + unknown(link.last);
    Values& nearest = is_first ? carried : near;
    Values far(of_far, of_far + link.n_far), passed_far(static_cast<std::size_t>(link.p_far), 0.0);
    const double* from = link.passed_on.data();
    for (Values* to : {&nearest, &far, &of_border, &passed, &passed_far})
        for (double& value : *to) value += *from++;
    if (!is_first) {
        std::copy(passed.begin(), passed.end(), link.merged_values.begin());
        std::copy(near.begin(), near.end(), link.merged_values.begin() + link.p_near);
        others = carried;
        for (const Values* v : {&far, &of_border, &passed_far})
            others.insert(others.end(), v->begin(), v->end());
        link.merged.solve_transposed(link.merged_values.data(), others.data());
        from = others.data();
        take(from, carried, n_carried_);
        take(from, far, link.n_far);
        take(from, of_border, border());
        take(from, passed_far, link.p_far);
    }
    near = std::move(far);
    passed = std::move(passed_far);
}

/// x, by unknowns, <- A^-T x, by rows: the same panels, transposed, in the same order and back.
void ChainSolver::apply_inverse_transposed(double* x) const
{
    if (n_links() == 0) return;
    Values& front = work_.front;
    const int behind = first_unknown_.back(), n_closing = structure_->n_closing;
    work_.carried.assign(x, x + n_carried_);
    work_.of_border.assign(x + behind, x + behind + border());
    work_.near.clear();
    work_.passed.clear();
    in_order_behind(
        in_order(cost_of_pass),
        [&](int, int e) { eliminate_own_transposed(links_[static_cast<std::size_t>(e)], x); },
        [&](int e) {
            eliminate_transposed(links_[static_cast<std::size_t>(e)], x);
            return true;
        });
    front = work_.carried;
    for (const Values* v : {&work_.near, &work_.of_border}) front.insert(front.end(), v->begin(), v->end());
    closing_.solve_transposed(front.data(), nullptr);
    closing_.apply_transposed(front.data());
    std::copy(front.end() - n_closing, front.end(), x + first_row_.back());
    front.resize(front.size() - static_cast<std::size_t>(n_closing));
    const int last = n_links() - 1;
    in_order_ahead(
        in_order(cost_of_pass),
        [&](int i) {
            const Link& link = links_[static_cast<std::size_t>(last - i)];
            if (i < last) {
                front.insert(front.begin(), link.merged_values.begin(), link.merged_values.end());
                link.merged.apply_transposed(front.data());
            }
            const auto n_left = static_cast<std::ptrdiff_t>(link.left_values.size());
            std::copy(front.end() - n_left, front.end(), link.left_values.begin());
            front.resize(front.size() - link.left_values.size());
        },
        [&](int, int i) { rows_inside(links_[static_cast<std::size_t>(last - i)], x); });
}

/// An element's own rows, those of its near end, and of the last of its far end.
void ChainSolver::rows_inside(const Link& link, double* x) const
{
    Values rows = link.inside_values;
    rows.insert(rows.end(), link.left_values.begin(), link.left_values.end());
    link.inside.apply_transposed(rows.data());
    double* to = x + row(link.first);
    if (&link == &links_.back())
        std::copy_n(rows.end() - link.r_far, link.r_far, to + link.r_near + link.r_own);
    std::copy_n(rows.begin(), link.r_own, to + link.r_near);
    std::copy_n(rows.begin() + link.r_own, link.r_near, to);
}

}   // namespace livens::inline solvers_internal
