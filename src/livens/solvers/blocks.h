// SPDX-License-Identifier: BSD-3-Clause
// Matrices of systems whose unknowns stand at nodes of time: dense blocks, element by element.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "livens/solvers/sparse.h"

namespace livens::inline solvers_internal {

/// Unknowns and rows stand at nodes of time; an element couples consecutive nodes.
///
/// Unknowns are numbered node after node, and so are rows. At the ends they follow the conditions: where all
/// is known, a node has no unknowns. Behind all nodes there may be a border: unknowns that every row may see,
/// and closing rows, which see the first node, the last one and the border.
struct BlockStructure {
    std::vector<int> n_unknowns, n_rows;        ///< of each node
    std::vector<std::array<int, 2>> elements;   ///< first and last node; the first begins at node 0, the last
                                                ///< ends at the last node, and neighbours share a node or
                                                ///< more (splines); first < last, both ascend
    int n_border = 0, n_closing = 0;            ///< unknowns, rows; none where there are no nodes
    bool is_part = false;   ///< of a longer chain: closing rows of other parts complete the matrix

    int n_nodes() const { return static_cast<int>(n_unknowns.size()); }
    int n_elements() const { return static_cast<int>(elements.size()); }
    /// Throws std::invalid_argument, naming what is wrong, where the above does not hold or the whole matrix
    /// would not be square, unless it is a part.
    void check() const;
    bool operator==(const BlockStructure&) const = default;
};

/// Unknowns of the whole matrix, which is square unless it is a part.
int size_of(const BlockStructure& structure);

/// starts[i] = counts[0] + ... + counts[i - 1], one more than there are counts.
void running_sums(std::span<const int> counts, std::vector<int>& starts);

/// For every element a dense matrix, row by row: rows of its nodes x unknowns of its nodes, and one of its
/// rows x the border. The whole matrix is their sum, where elements share nodes what they put there adds up,
/// and the closing rows.
class BlockMatrix {
public:
    /// All zero. Checks the structure; allocates only where something grows.
    void resize(const BlockStructure& structure);
    void clear();

    int n_elements() const { return static_cast<int>(storage_.size()); }
    /// Of an element's matrix; rows are stride() apart.
    int n_rows(int element) const;
    int n_columns(int element) const;
    int stride(int element) const { return n_columns(element); }
    /// Nodes are counted in the whole window and belong to the element; the first entry of their block.
    double* block(int element, int row_node, int column_node)
    {
        return storage_[static_cast<std::size_t>(element)].data() + place(element, row_node, column_node);
    }
    const double* block(int element, int row_node, int column_node) const
    {
        return storage_[static_cast<std::size_t>(element)].data() + place(element, row_node, column_node);
    }
    /// n_rows x n_columns numbers; may be exchanged for a vector of that size.
    std::vector<double>& storage(int element) { return storage_[static_cast<std::size_t>(element)]; }
    const std::vector<double>& storage(int element) const
    {
        return storage_[static_cast<std::size_t>(element)];
    }

    /// An element's rows x the border; rows are n_border() apart. First row of a node that belongs to it.
    double* border(int element, int row_node)
    {
        return border_[static_cast<std::size_t>(element)].data() + border_place(element, row_node);
    }
    std::vector<double>& border_storage(int element) { return border_[static_cast<std::size_t>(element)]; }
    const std::vector<double>& border_storage(int element) const
    {
        return border_[static_cast<std::size_t>(element)];
    }
    int n_border() const { return n_border_; }
    /// Closing rows x (unknowns of the first node, of the last one, border), row by row.
    std::vector<double>& closing() { return closing_; }
    const std::vector<double>& closing() const { return closing_; }

private:
    std::size_t place(int element, int row_node, int column_node) const;
    std::size_t border_place(int element, int row_node) const;

    std::vector<std::array<int, 2>> elements_;
    std::vector<int> first_row_, first_unknown_;   // of each node, and the end
    std::vector<std::vector<double>> storage_, border_;
    std::vector<double> closing_;
    int n_border_ = 0;
};

/// The whole matrix, rows and unknowns in the order of the nodes; entries that are zero in all elements are
/// left out.
SparseMatrix to_sparse(const BlockStructure& structure, const BlockMatrix& matrix);

}   // namespace livens::inline solvers_internal
