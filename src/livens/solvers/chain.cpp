// SPDX-License-Identifier: BSD-3-Clause
// Elements condensed to their ends and merged one after the other: theory.md, "The chain".
//
// A balance at a node that two elements share is the sum of what both put there. As an equation of each, with
// what passes between them as an unknown, an element is a relation between the unknowns at its two ends; so
// are two neighbours once what they share is eliminated, with pivots from the rows of both. Conditions wait
// until the end: that they determine the motion is seen there alone.
#include "livens/solvers/detail/chain.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"
#include "livens/solvers/row_functions.h"

namespace livens::inline solvers_internal {

namespace {

using Values = std::vector<double>;

/// What rows that are left may have grown by since the last reflections, before others are taken.
constexpr double most_growth = 64;

}   // namespace

void ChainSolver::analyse(const BlockStructure& structure)
{
    if (structure_ && *structure_ == structure) return;
    structure_.reset();   // stays so if the structure is refused
    is_regular_ = false;
    singular_node_ = -1;
    structure.check();
    for (std::size_t e = 1; e < structure.elements.size(); ++e)
        if (structure.elements[e][0] != structure.elements[e - 1][1])
            throw std::invalid_argument("no chain: elements " + std::to_string(e - 1) + " and " +
                                        std::to_string(e) + " share more than one node");
    running_sums(structure.n_rows, first_row_);
    running_sums(structure.n_unknowns, first_unknown_);
    structure_ = structure;
    n_carried_ = structure.n_closing > 0 || structure.is_part ? structure.n_unknowns.front() : 0;
    try {
        take_room();
    } catch (...) {   // memory ended, or who waits: half a room is none
        structure_.reset();
        throw;
    }
}

void ChainSolver::take_room()
{
    links_.clear();
    links_.resize(structure_->elements.size());
    std::vector<int> n_left{0};   // of rows, before each element
    for (int e = 0; e < n_links(); ++e) {
        shape(e);
        const Link& link = links_[static_cast<std::size_t>(e)];
        const int n_own = link.r_near + link.r_own + link.r_far - link.n_own;
        const int n_merged = e == 0 ? 0 : link.p_near + link.n_near;
        n_left.push_back(std::max(n_left.back(), 0) + std::max(n_own, 0) - n_merged);
    }
    for_each_item(n_links(), least_shared_links, [&](int e) {
        Patience::ask();
        take_room(links_[static_cast<std::size_t>(e)], n_left[static_cast<std::size_t>(e)]);
    });
    const int n = n_links() == 0 ? 0 : n_carried_ + structure_->n_unknowns.back() + structure_->n_border;
    if (ends_ == nullptr) closing_.resize(n, n, 0);
    matrix_.resize(*structure_);
    const int n_rows = first_row_.back() + structure_->n_closing;
    work_.right_side.assign(static_cast<std::size_t>(std::max(size_of(*structure_), n_rows)), 0.0);
}

/// What passes between two elements, sigma, is one number for each row of their node, and nothing at the ends
/// of time: rows of the first node are all the first element's.
void ChainSolver::shape(int e)
{
    const BlockStructure& s = *structure_;
    Link& link = links_[static_cast<std::size_t>(e)];
    const bool is_first = e == 0, is_last = e + 1 == n_links();
    const auto [first, last] = s.elements[static_cast<std::size_t>(e)];
    link.first = first;
    link.last = last;
    // the first unknowns are an element's own, unless closing rows see them
    link.n_near = is_first && n_carried_ == 0 ? 0 : s.n_unknowns[static_cast<std::size_t>(first)];
    link.n_far = s.n_unknowns[static_cast<std::size_t>(last)];
    link.n_own = unknown(last) - unknown(first) - link.n_near;
    link.r_near = is_first ? 0 : s.n_rows[static_cast<std::size_t>(first)];
    link.r_far = s.n_rows[static_cast<std::size_t>(last)];
    link.r_own = row(last) - row(first) - link.r_near;
    link.p_near = link.r_near;
    link.p_far = is_last ? 0 : link.r_far;
}

/// `n_left`: rows that are left of the elements before.
void ChainSolver::take_room(Link& link, int n_left)
{
    link.inside.resize(link.r_near + link.r_own + link.r_far, link.n_own,
                       link.n_near + link.n_far + border() + link.p_near + link.p_far);
    link.inside_values.assign(static_cast<std::size_t>(link.n_own), 0.0);
    link.left_values.assign(static_cast<std::size_t>(std::max(link.inside.n_left(), 0)), 0.0);
    if (&link == &links_.front()) return;
    link.merged.resize(std::max(n_left, 0) + std::max(link.inside.n_left(), 0), link.p_near + link.n_near,
                       n_carried_ + link.n_far + border() + link.p_far);
    link.merged_values.assign(static_cast<std::size_t>(link.p_near + link.n_near), 0.0);
}

/// Rows: its own, then those of its near and of its far end.
/// sigma enters rows of the near end and leaves those of the far end. Its columns are as large as the entries
/// of the element before it, so that growth is measured by one size.
void ChainSolver::fill_inside(int e)
{
    Link& link = links_[static_cast<std::size_t>(e)];
    const Values &values = matrix_.storage(e), &seen = matrix_.border_storage(e);
    const int stride = matrix_.stride(e), n_rows = link.inside.n_rows(),
              passed = link.n_near + link.n_far + border();
    const double near_scale = e == 0 ? 1 : links_[static_cast<std::size_t>(e) - 1].scale;
    for (int i = 0; i < n_rows; ++i) {
        const bool is_near = i < link.r_near, is_far = i >= link.r_near + link.r_own;
        double* to = link.inside.row(is_near ? link.r_own + i : is_far ? i : i - link.r_near);
        const double* from = values.data() + static_cast<std::ptrdiff_t>(i) * stride;
        double* others = to + link.n_own;
        std::copy_n(from, link.n_near, others);
        std::copy_n(from + link.n_near, link.n_own, to);
        std::copy_n(from + link.n_near + link.n_own, link.n_far, others + link.n_near);
        std::copy_n(seen.data() + static_cast<std::ptrdiff_t>(i) * border(), border(),
                    others + link.n_near + link.n_far);
        std::fill_n(others + passed, link.p_near + link.p_far, 0.0);
        if (is_near) others[passed + i] = near_scale;
        if (is_far && link.p_far > 0)
            others[passed + link.p_near + i - link.r_near - link.r_own] = -link.scale;
    }
}

/// What is left of the elements before, then of this one.
void ChainSolver::fill_merged(int e)
{
    Link& link = links_[static_cast<std::size_t>(e)];
    const Panel &before = front(e - 1), &inside = link.inside;
    Panel& merged = link.merged;
    const int c = n_carried_, n = link.n_near, p = link.p_near, far = link.n_far, b = border();
    merged.clear();
    for (int i = 0; i < before.n_left(); ++i) {   // carried, near, border, passed_near
        const double* from = before.row(before.n_pivots() + i) + before.n_pivots();
        double *to = merged.row(i), *others = to + p + n;
        std::copy_n(from, c, others);
        std::copy_n(from + c, n, to + p);
        std::copy_n(from + c + n, b, others + c + far);
        std::copy_n(from + c + n + b, p, to);
    }
    for (int i = 0; i < inside.n_left(); ++i) {   // near, far, border, passed_near, passed_far
        const double* from = inside.row(inside.n_pivots() + i) + inside.n_pivots();
        double *to = merged.row(before.n_left() + i), *others = to + p + n;
        std::copy_n(from, n, to + p);
        std::copy_n(from + n, far + b, others + c);
        std::copy_n(from + n + far + b, p, to);
        std::copy_n(from + n + far + b + p, link.p_far, others + c + far + b);
    }
}

/// What is left of all elements, then the closing rows: carried, far, border.
void ChainSolver::fill_closing()
{
    const Panel& left = front(n_links() - 1);
    const int n = closing_.n_pivots();
    for (int i = 0; i < left.n_left(); ++i)
        std::copy_n(left.row(left.n_pivots() + i) + left.n_pivots(), n, closing_.row(i));
    const double* from = matrix_.closing().data();
    for (int i = 0; i < structure_->n_closing; ++i, from += n)
        std::copy_n(from, n, closing_.row(left.n_left() + i));
}

int ChainSolver::node_inside(const Link& link, int column) const
{
    const int place = unknown(link.first) + link.n_near + column;
    const auto after = std::upper_bound(first_unknown_.begin(), first_unknown_.end(), place);
    return static_cast<int>(after - first_unknown_.begin()) - 1;
}

bool ChainSolver::condense(Link& link, int e)
{
    fill_inside(e);
    link.failed = -1;
    if (link.inside.n_left() < 0) return false;
    // while pivots are its own rows', nothing that passes is touched
    const int plain = link.n_own + link.n_near + link.n_far + border();
    const double passed = e > 0 && link.p_near > 0 ? links_[static_cast<std::size_t>(e) - 1].scale : 0;
    const double size = std::max(link.size, passed);
    bool is_done = link.inside.eliminate(link.r_own, plain);
    if (is_done && link.inside.largest_left() > most_growth * size) {
        fill_inside(e);
        is_done = link.inside.reflect();
    }
    if (!is_done) link.failed = link.inside.failed_column();
    return is_done;
}

/// No rows are preferred: pivots come from those of both.
bool ChainSolver::merge(int e)
{
    Link& link = links_[static_cast<std::size_t>(e)];
    fill_merged(e);
    if (link.merged.n_left() < 0) return fail(link.first);
    const double size = link.merged.largest();
    const bool is_done = link.merged.eliminate(0, link.merged.width());
    const double growth = growth_ * (size > 0 ? link.merged.largest_left() / size : 1);
    if (is_done && growth <= most_growth) {
        growth_ = std::max(growth, 1.0);
        return true;
    }
    fill_merged(e);
    return link.merged.reflect() || fail(link.first);
}

Outcome ChainSolver::factorise(BlockMatrix& matrix)
{
    assert(structure_ && matrix.n_elements() == n_links());
    singular_node_ = -1;
    is_regular_ = false;
    growth_ = 1;
    std::swap(matrix_, matrix);
    Outcome outcome = condense_all();
    if (ends_ != nullptr) {   // which all parts ask together
        const bool is_closed = close_by_others(outcome == Outcome::regular);
        if (outcome == Outcome::regular && !is_closed) outcome = Outcome::singular;
    } else if (outcome == Outcome::regular) {
        outcome = close();
    }
    is_regular_ = outcome == Outcome::regular;
    return outcome;
}

/// What merging costs of what elements cost, by the sizes of panels.
LoopInOrder ChainSolver::in_order(const std::function<double(const Panel&)>& cost) const
{
    if (links_.empty()) return {};
    const Link& typical = links_[links_.size() / 2];
    return {n_links(), least_shared_links, cost(typical.merged) / std::max(cost(typical.inside), 1.0)};
}

Outcome ChainSolver::condense_all()
{
    const RowFunctions& functions = row_functions();
    const auto largest = [&functions](const Values& values) {
        return functions.largest(values.data(), static_cast<int>(values.size()));
    };
    std::vector<char> is_good(links_.size());
    for_each_item(n_links(), least_shared_links, [&](int e) {
        const double size = largest(matrix_.storage(e)), seen = largest(matrix_.border_storage(e));
        is_good[e] = std::isfinite(size) && std::isfinite(seen);
        links_[e].scale = size > 0 ? size : 1;
        links_[e].size = std::max(links_[e].scale, seen);
    });
    const auto are_all_good = [&] { return std::ranges::all_of(is_good, [](char is) { return is != 0; }); };
    if (!std::isfinite(largest(matrix_.closing())) || !are_all_good()) return Outcome::not_finite;
    const bool is_regular = in_order_behind(
        in_order([](const Panel& panel) {
            return static_cast<double>(panel.n_rows()) * panel.n_pivots() * panel.width();
        }),
        [&](int, int e) {
            Patience::ask();
            is_good[e] = condense(links_[e], e);
        },
        [&](int e) {
            Patience::ask();
            if (is_good[e]) return e == 0 || merge(e);
            singular_node_ =
                links_[e].failed < 0 ? links_[e].first : node_inside(links_[e], links_[e].failed);
            return false;
        });
    return is_regular ? Outcome::regular : Outcome::singular;
}

Outcome ChainSolver::close()
{
    if (n_links() == 0) return Outcome::regular;
    if (front(n_links() - 1).n_left() + structure_->n_closing != closing_.n_rows()) return Outcome::singular;
    fill_closing();
    if (closing_.eliminate(0, closing_.width())) return Outcome::regular;
    singular_node_ = closing_.failed_column() < n_carried_ ? 0 : structure_->n_nodes() - 1;
    return Outcome::singular;
}

bool ChainSolver::close_by_others(bool is_regular)
{
    Values rows;
    if (is_regular) {
        const Panel& left = front(n_links() - 1);
        for (int i = 0; i < left.n_left(); ++i) {
            const double* row = left.row(left.n_pivots() + i);
            rows.insert(rows.end(), row + left.n_pivots(), row + left.width());
        }
        rows.insert(rows.end(), matrix_.closing().begin(), matrix_.closing().end());
    }
    return ends_->factorise(rows);
}

LinearReport ChainSolver::report() const
{
    LinearReport report{.singular_node = singular_node_};
    const auto look = [&](const Panel& panel) {
        report.factor_entries += static_cast<long long>(panel.n_rows()) * panel.width();
        for (long long k = 0; k < panel.n_pivots(); ++k)
            report.flops += 2 * (panel.n_rows() - k - 1) * (panel.width() - k - 1);
    };
    for (const Link& link : links_) {
        look(link.inside);
        look(link.merged);
    }
    look(closing_);
    if (!is_regular_) return report;
    Values smallest(links_.size()), largest(links_.size());
    for_each_item(n_links(), least_shared_links, [&](int e) {
        const Panel &inside = links_[e].inside, &merged = links_[e].merged;
        smallest[e] = std::min(inside.smallest_pivot(), merged.smallest_pivot());
        largest[e] = std::max(inside.largest(), merged.largest());
    });
    report.smallest_pivot = closing_.smallest_pivot();
    report.largest_entry = closing_.largest();
    for (const double pivot : smallest) report.smallest_pivot = std::min(report.smallest_pivot, pivot);
    for (const double entry : largest) report.largest_entry = std::max(report.largest_entry, entry);
    return report;
}

std::unique_ptr<LinearSolver> chain_solver() { return std::make_unique<ChainSolver>(); }
std::unique_ptr<LinearSolver> solver_of_part(ChainEnds& ends) { return std::make_unique<ChainSolver>(&ends); }

}   // namespace livens::inline solvers_internal
