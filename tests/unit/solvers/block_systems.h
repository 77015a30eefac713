// SPDX-License-Identifier: BSD-3-Clause
// Systems in blocks for the tests of their solvers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "livens/solvers/blocks.h"
#include "sparse_matrices.h"

namespace livens {

inline int sum_of(const std::vector<int>& counts)
{
    std::vector<int> starts;
    running_sums(counts, starts);
    return starts.back();
}

/// `total` spread over n nodes at random: some get none.
inline std::vector<int> spread(int total, int n, std::mt19937_64& engine)
{
    std::vector<int> counts(static_cast<std::size_t>(n), 0);
    for (int i = 0; i < total; ++i) ++counts[engine() % static_cast<std::uint64_t>(n)];
    return counts;
}

/// Known at the start: elements of 1 to 3 steps from node to node, with up to 6 unknowns a step.
inline BlockStructure random_forward_structure(int n_elements, std::uint64_t seed)
{
    std::mt19937_64 engine(seed);
    BlockStructure s;
    s.n_unknowns = {0};
    for (int e = 0; e < n_elements; ++e) {
        const int inner = 1 + static_cast<int>(engine() % 3);
        const int size = inner * static_cast<int>(engine() % 7);
        const int first = s.n_nodes() - 1;
        for (int n : spread(size, inner, engine)) s.n_unknowns.push_back(n);
        for (int n : spread(size, inner, engine)) s.n_rows.push_back(n);
        s.elements.push_back({first, first + inner});
    }
    s.n_rows.push_back(0);
    return s;
}

/// The same seen from the other end: nodes and elements in reverse.
inline BlockStructure mirrored(BlockStructure s)
{
    std::reverse(s.n_unknowns.begin(), s.n_unknowns.end());
    std::reverse(s.n_rows.begin(), s.n_rows.end());
    std::reverse(s.elements.begin(), s.elements.end());
    for (auto& [first, last] : s.elements) {
        const int new_last = s.n_nodes() - 1 - first;
        first = s.n_nodes() - 1 - last;
        last = new_last;
    }
    return s;
}

/// Every node has unknowns and rows, 1 to 5 of each; elements of up to three steps.
inline BlockStructure random_structure(int n_elements, std::uint64_t seed)
{
    std::mt19937_64 engine(seed);
    BlockStructure s;
    s.n_unknowns = {3};
    for (int e = 0; e < n_elements; ++e) {
        const int first = s.n_nodes() - 1, inner = 1 + static_cast<int>(engine() % 3);
        for (int i = 0; i < inner; ++i) s.n_unknowns.push_back(1 + static_cast<int>(engine() % 5));
        s.elements.push_back({first, first + inner});
    }
    s.n_rows = s.n_unknowns;
    for (std::size_t i = 0; i + 1 < s.n_rows.size(); i += 2) {   // rows need not be where unknowns are
        --s.n_rows[i];
        ++s.n_rows[i + 1];
    }
    return s;
}

/// Every element spans `degree` steps and begins one after the last, as splines do.
inline BlockStructure spline_structure(int n_elements, int degree, int size)
{
    BlockStructure s;
    s.n_unknowns.assign(static_cast<std::size_t>(n_elements + degree), size);
    s.n_rows = s.n_unknowns;
    for (int e = 0; e < n_elements; ++e) s.elements.push_back({e, e + degree});
    return s;
}

/// With a border of n unknowns. `n_open` rows less at the ends, as of conditions that see both; closing rows
/// for these and for the border.
inline BlockStructure bordered(BlockStructure s, int n, int n_open)
{
    s.n_border = n;
    s.n_closing = n;
    for (int i = 0; i < n_open; ++i) {
        int& rows = i % 2 == 0 ? s.n_rows.back() : s.n_rows.front();
        if (rows == 0) continue;
        --rows;
        ++s.n_closing;
    }
    return s;
}

/// Where an element's matrix begins in the whole one.
struct Corner {
    int row = 0, column = 0;
};

inline Corner corner(const BlockStructure& s, int element)
{
    std::vector<int> rows, unknowns;
    running_sums(s.n_rows, rows);
    running_sums(s.n_unknowns, unknowns);
    const auto first = static_cast<std::size_t>(s.elements[static_cast<std::size_t>(element)][0]);
    return {rows[first], unknowns[first]};
}

/// Random entries, and 4 on the diagonal of the whole matrix where an element has it.
inline void fill(const BlockStructure& s, std::uint64_t seed, BlockMatrix& matrix)
{
    Random random(seed);
    std::vector<char> is_taken(static_cast<std::size_t>(sum_of(s.n_rows)), 0);
    for (int e = 0; e < matrix.n_elements(); ++e) {
        const Corner at = corner(s, e);
        double* value = matrix.storage(e).data();
        for (int i = 0; i < matrix.n_rows(e); ++i)
            for (int j = 0; j < matrix.n_columns(e); ++j, ++value) {
                *value = 0.5 * random.next();
                char& taken = is_taken[static_cast<std::size_t>(at.row + i)];
                if (at.row + i != at.column + j || taken) continue;
                *value += 4;
                taken = 1;
            }
        for (double& v : matrix.border_storage(e)) v = 0.5 * random.next();
    }
    for (double& v : matrix.closing()) v = random.next();
}

/// The sum of the elements' matrices, block by block.
inline Dense dense(const BlockStructure& s, const BlockMatrix& matrix)
{
    std::vector<int> rows, unknowns;
    running_sums(s.n_rows, rows);
    running_sums(s.n_unknowns, unknowns);
    Dense A(size_of(s));
    const int behind = unknowns.back();
    const int n_seen = s.n_closing > 0 ? s.n_unknowns.front() + s.n_unknowns.back() + s.n_border : 0;
    for (int i = 0; i < s.n_closing; ++i)
        for (int j = 0; j < n_seen; ++j) {
            const int first = s.n_unknowns.front(), last = s.n_unknowns.back();
            const int column = j < first ? j : behind - last + j - first;
            A(rows.back() + i, column) += matrix.closing()[static_cast<std::size_t>(i * n_seen + j)];
        }
    for (int e = 0; e < s.n_elements(); ++e) {
        const auto [first, last] = s.elements[static_cast<std::size_t>(e)];
        for (int i = 0; i < matrix.n_rows(e) * s.n_border; ++i)
            A(rows[static_cast<std::size_t>(first)] + i / s.n_border, behind + i % s.n_border) +=
                matrix.border_storage(e)[static_cast<std::size_t>(i)];
        for (int a = first; a <= last; ++a)
            for (int b = first; b <= last; ++b) {
                const double* block = matrix.block(e, a, b);
                const auto row = static_cast<std::size_t>(a), column = static_cast<std::size_t>(b);
                for (int i = 0; i < s.n_rows[row]; ++i)
                    for (int j = 0; j < s.n_unknowns[column]; ++j)
                        A(rows[row] + i, unknowns[column] + j) += block[i * matrix.stride(e) + j];
            }
    }
    return A;
}

}   // namespace livens
