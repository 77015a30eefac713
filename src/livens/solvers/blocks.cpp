// SPDX-License-Identifier: BSD-3-Clause
// Matrices whose rows and unknowns stand at nodes of time, element by element: the shape of every tangent in
// theory.md, "Windows". Neighbouring elements share a node, so their dense blocks overlap and add up; the
// sparse matrix of the whole is made from them where a sparse solver asks.
#include "livens/solvers/blocks.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"

namespace livens::inline solvers_internal {

namespace {

constexpr int least_shared_rooms = 32;   // of elements, that a thread takes, where there are several

std::size_t entries(int rows, int columns)
{
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
}

[[noreturn]] void refuse(const std::string& why) { throw std::invalid_argument("block structure: " + why); }

void check_elements(const BlockStructure& structure)
{
    const auto& elements = structure.elements;
    for (std::size_t e = 0; e < elements.size(); ++e) {
        const auto [first, last] = elements[e];
        const std::string name = "element " + std::to_string(e);
        if (first < 0 || first >= last || last >= structure.n_nodes())
            refuse(name + " spans nodes " + std::to_string(first) + " to " + std::to_string(last) + " of " +
                   std::to_string(structure.n_nodes()));
        if (e == 0) continue;
        // Both ends must ascend: forward elimination relies on an order of elements that is an order of time.
        if (first <= elements[e - 1][0] || last <= elements[e - 1][1]) refuse(name + " is out of order");
        if (first > elements[e - 1][1]) refuse(name + " shares no node with the one before");
    }
    const int end = elements.empty() ? 0 : elements.back()[1] + 1;
    if ((!elements.empty() && elements.front()[0] != 0) || end != structure.n_nodes())
        refuse("the elements do not cover the nodes");
}

}   // namespace

void BlockStructure::check() const
{
    if (n_rows.size() != n_unknowns.size()) refuse("rows are counted at other nodes than unknowns");
    const auto is_negative = [](int n) { return n < 0; };
    if (std::any_of(n_rows.begin(), n_rows.end(), is_negative) ||
        std::any_of(n_unknowns.begin(), n_unknowns.end(), is_negative))
        refuse("a count is negative");
    check_elements(*this);
    if (n_border < 0 || n_closing < 0) refuse("a count of the border is negative");
    if (n_nodes() == 0 && (n_border > 0 || n_closing > 0)) refuse("a border without nodes");
    const int rows = std::accumulate(n_rows.begin(), n_rows.end(), n_closing);
    const int unknowns = size_of(*this);
    // Which rows are active depends on the conditions at the ends of time; a mistake there shows up here
    // first.
    if (rows != unknowns && !is_part)
        refuse(std::to_string(rows) + " rows for " + std::to_string(unknowns) + " unknowns");
}

int size_of(const BlockStructure& structure)
{
    return std::accumulate(structure.n_unknowns.begin(), structure.n_unknowns.end(), structure.n_border);
}

void running_sums(std::span<const int> counts, std::vector<int>& starts)
{
    starts.resize(counts.size() + 1);
    starts[0] = 0;
    std::partial_sum(counts.begin(), counts.end(), starts.begin() + 1);
}

void BlockMatrix::resize(const BlockStructure& structure)
{
    structure.check();
    elements_ = structure.elements;
    running_sums(structure.n_rows, first_row_);
    running_sums(structure.n_unknowns, first_unknown_);
    storage_.resize(elements_.size());
    // assign() keeps the memory of an element whose size has not grown: marches refill one matrix for ever.
    n_border_ = structure.n_border;
    border_.resize(elements_.size());
    for_each_item(n_elements(), least_shared_rooms, [&](int e) {
        Patience::ask();
        storage(e).assign(entries(n_rows(e), n_columns(e)), 0.0);
        border_storage(e).assign(entries(n_rows(e), n_border_), 0.0);
    });
    const int seen = elements_.empty() ? 0 : structure.n_unknowns.front() + structure.n_unknowns.back();
    closing_.assign(entries(structure.n_closing, seen + n_border_), 0.0);
}

void BlockMatrix::clear()
{
    for (auto* of : {&storage_, &border_})
        for (auto& values : *of) std::fill(values.begin(), values.end(), 0.0);
    std::fill(closing_.begin(), closing_.end(), 0.0);
}

int BlockMatrix::n_rows(int element) const
{
    const auto [first, last] = elements_[static_cast<std::size_t>(element)];
    return first_row_[static_cast<std::size_t>(last) + 1] - first_row_[static_cast<std::size_t>(first)];
}

int BlockMatrix::n_columns(int element) const
{
    const auto [first, last] = elements_[static_cast<std::size_t>(element)];
    return first_unknown_[static_cast<std::size_t>(last) + 1] -
           first_unknown_[static_cast<std::size_t>(first)];
}

std::size_t BlockMatrix::place(int element, int row_node, int column_node) const
{
    const auto [first, last] = elements_[static_cast<std::size_t>(element)];
    assert(first <= row_node && row_node <= last && first <= column_node && column_node <= last);
    const auto from = static_cast<std::size_t>(first);
    const int row = first_row_[static_cast<std::size_t>(row_node)] - first_row_[from];
    const int column = first_unknown_[static_cast<std::size_t>(column_node)] - first_unknown_[from];
    // a block without entries may begin behind the end
    return std::min(entries(row, stride(element)) + static_cast<std::size_t>(column),
                    storage_[static_cast<std::size_t>(element)].size());
}

std::size_t BlockMatrix::border_place(int element, int row_node) const
{
    const auto from = static_cast<std::size_t>(elements_[static_cast<std::size_t>(element)][0]);
    return entries(first_row_[static_cast<std::size_t>(row_node)] - first_row_[from], n_border_);
}

namespace {

/// Calls visit(row, column, value) for the entries that are not zero, element after element, rows ascending,
/// and then of the closing rows.
template <class Visit>
void for_each_entry(const BlockStructure& structure, const BlockMatrix& matrix, const Visit& visit)
{
    std::vector<int> first_row, first_unknown;
    running_sums(structure.n_rows, first_row);
    running_sums(structure.n_unknowns, first_unknown);
    for (int e = 0; e < structure.n_elements(); ++e) {
        Patience::ask();
        const auto node = static_cast<std::size_t>(structure.elements[static_cast<std::size_t>(e)][0]);
        const double* value = matrix.storage(e).data();
        for (int i = 0; i < matrix.n_rows(e); ++i)
            for (int j = 0; j < matrix.n_columns(e); ++j, ++value)
                // Exact zeros are left out, which is what keeps blocks of bodies without a common joint or
                // load apart.
                if (*value != 0) visit(first_row[node] + i, first_unknown[node] + j, *value);
        if (structure.n_border == 0) continue;
        value = matrix.border_storage(e).data();
        for (int i = 0; i < matrix.n_rows(e); ++i)
            for (int j = 0; j < structure.n_border; ++j, ++value)
                if (*value != 0) visit(first_row[node] + i, first_unknown.back() + j, *value);
    }
    if (structure.n_closing == 0) return;
    const int first = structure.n_unknowns.front(), last = structure.n_unknowns.back();
    const double* value = matrix.closing().data();
    for (int i = 0; i < structure.n_closing; ++i)
        for (int j = 0; j < first + last + structure.n_border; ++j, ++value)
            if (*value != 0)
                visit(first_row.back() + i, j < first ? j : first_unknown.back() - last + j - first, *value);
}

/// Sorts the rows of every column and adds equal ones: elements ascend, but what they share comes twice.
void add_up(SparseMatrix& A)
{
    std::vector<std::pair<int, double>> column;
    int n = 0, begin = 0;
    for (int j = 0; j < A.size; ++j) {
        Patience::ask();
        const int end = A.column_starts[j + 1];
        column.clear();
        for (int k = begin; k < end; ++k) column.emplace_back(A.rows[k], A.values[k]);
        // A stable order adds equal entries element after element, so that the sum does not depend on the
        // sort.
        std::ranges::stable_sort(column, {}, &std::pair<int, double>::first);
        A.column_starts[j] = n;
        for (const auto& [row, value] : column) {
            if (n > A.column_starts[j] && A.rows[n - 1] == row) {
                A.values[n - 1] += value;
                continue;
            }
            A.rows[n] = row;
            A.values[n++] = value;
        }
        begin = end;
    }
    A.column_starts[A.size] = n;
    A.rows.resize(static_cast<std::size_t>(n));
    A.values.resize(static_cast<std::size_t>(n));
}

}   // namespace

/// Entries are counted first: lists of them would take several times the matrix.
SparseMatrix to_sparse(const BlockStructure& structure, const BlockMatrix& matrix)
{
    SparseMatrix A;
    A.size = size_of(structure);
    A.column_starts.assign(static_cast<std::size_t>(A.size) + 1, 0);
    for_each_entry(structure, matrix, [&](int, int column, double) { ++A.column_starts[column + 1]; });
    std::partial_sum(A.column_starts.begin(), A.column_starts.end(), A.column_starts.begin());
    A.rows.resize(static_cast<std::size_t>(A.column_starts.back()));
    A.values.resize(A.rows.size());
    std::vector<int> next(A.column_starts.begin(), A.column_starts.end() - 1);
    for_each_entry(structure, matrix, [&](int row, int column, double value) {
        A.rows[next[column]] = row;
        A.values[next[column]++] = value;
    });
    add_up(A);
    return A;
}

}   // namespace livens::inline solvers_internal
