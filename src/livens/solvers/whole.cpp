// SPDX-License-Identifier: BSD-3-Clause
// One sparse matrix of all blocks.
// For conditions at both ends of time, where no end has all that is known, and for the elements of the paper:
// theory.md, "Windows". Rows are exchanged freely, as the diagonal blocks alone may be singular.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "livens/solvers/linear_solver.h"

namespace livens::inline solvers_internal {

namespace {

using Values = std::vector<double>;

class WholeSolver final : public LinearSolver {
public:
    explicit WholeSolver(SparseBackend backend) : lu_(backend) {}

    void analyse(const BlockStructure& structure) override
    {
        if (structure_ && *structure_ == structure) return;
        structure_.reset();   // stays so if the structure is refused
        structure.check();
        pattern_.resize(structure);
        places_.assign(2 * static_cast<std::size_t>(structure.n_elements()) + 1, {});
        for (int k = 0; k < n_parts(); ++k) places_[k].assign(part(pattern_, k).size(), none);
        running_sums(structure.n_unknowns, first_unknown_);
        running_sums(structure.n_rows, first_row_);
        structure_ = structure;
        find_pattern();
    }

    Outcome factorise(BlockMatrix& matrix) override
    {
        // Entries may be zero by symmetry at the first iterate and appear later. The pattern never shrinks,
        // so it is analysed a few times at most.
        if (has_grown(matrix)) find_pattern();
        std::fill(matrix_.values.begin(), matrix_.values.end(), 0.0);
        for (int k = 0; k < n_parts(); ++k) {
            const Values& values = part(matrix, k);
            const std::vector<int>& places = places_[k];
            for (std::size_t i = 0; i < values.size(); ++i)
                if (places[i] != none) matrix_.values[static_cast<std::size_t>(places[i])] += values[i];
        }
        const auto is_finite = [](double v) { return std::isfinite(v); };
        if (!std::all_of(matrix_.values.begin(), matrix_.values.end(), is_finite)) return Outcome::not_finite;
        return lu_.factorise(matrix_) ? Outcome::regular : Outcome::singular;
    }

    void solve(std::span<double> x) const override { solve(x, false); }
    void solve_transposed(std::span<double> x) const override { solve(x, true); }

    void solve_closing(std::span<const double> rows, std::span<double> ends) const override
    {
        Values x(static_cast<std::size_t>(matrix_.size), 0.0);
        std::copy(rows.begin(), rows.end(), x.end() - static_cast<std::ptrdiff_t>(rows.size()));
        solve(x, false);
        const auto behind = x.begin() + first_unknown_.back();
        const auto to = std::copy_n(x.begin(), structure_->n_unknowns.front(), ends.begin());
        std::copy(behind - structure_->n_unknowns.back(), x.end(), to);
    }

    LinearReport report() const override { return {.factor_entries = lu_.factor_entries()}; }

private:
    static constexpr int none = -1;

    /// All numbers of a matrix: of the elements in turn their blocks and what stands in the border, then the
    /// closing rows.
    int n_parts() const { return static_cast<int>(places_.size()); }
    static const Values& part(const BlockMatrix& matrix, int k)
    {
        if (k / 2 == matrix.n_elements()) return matrix.closing();
        return k % 2 == 0 ? matrix.storage(k / 2) : matrix.border_storage(k / 2);
    }
    /// Column of the whole matrix, of a number of a part in column j of it.
    int column_of(int k, int j) const
    {
        const int behind = first_unknown_.back();
        if (k / 2 == structure_->n_elements()) {
            const int first = structure_->n_unknowns.front(), last = structure_->n_unknowns.back();
            return j < first ? j : behind - last + j - first;
        }
        const auto node = static_cast<std::size_t>(structure_->elements[static_cast<std::size_t>(k / 2)][0]);
        return j + (k % 2 == 0 ? first_unknown_[node] : behind);
    }

    /// Whether an entry outside of the pattern is not zero; marks them all.
    bool has_grown(const BlockMatrix& matrix)
    {
        assert(structure_ && matrix.n_elements() == structure_->n_elements());
        bool grown = false;
        for (int k = 0; k < n_parts(); ++k) {
            const Values& values = part(matrix, k);
            const std::vector<int>& places = places_[k];
            assert(values.size() == places.size());
            for (std::size_t i = 0; i < values.size(); ++i) {
                if (places[i] != none || values[i] == 0) continue;
                const_cast<Values&>(part(pattern_, k))[i] = 1;   // the pattern is its own
                grown = true;
            }
        }
        return grown;
    }

    void find_pattern()
    {
        matrix_ = to_sparse(*structure_, pattern_);
        for (int k = 0; k < n_parts(); ++k) find_places(k);
        const auto size = static_cast<std::size_t>(matrix_.size);
        for (Values* v : {&right_side_, &residual_, &correction_}) v->assign(size, 0.0);
        lu_.analyse(matrix_);
    }

    /// Where the entries of a part stand in the sparse matrix.
    void find_places(int k)
    {
        const Values& values = part(pattern_, k);
        if (values.empty()) return;
        const bool is_closing = k / 2 == structure_->n_elements();
        const int n_rows = is_closing ? structure_->n_closing : pattern_.n_rows(k / 2);
        const int n_columns = static_cast<int>(values.size()) / n_rows;
        const int first_row = is_closing ? first_row_.back()
                                         : first_row_[static_cast<std::size_t>(
                                               structure_->elements[static_cast<std::size_t>(k / 2)][0])];
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (values[i] == 0) continue;
            const int row = first_row + static_cast<int>(i) / n_columns;
            const auto column = static_cast<std::size_t>(column_of(k, static_cast<int>(i) % n_columns));
            const auto begin = matrix_.rows.begin() + matrix_.column_starts[column];
            const auto end = matrix_.rows.begin() + matrix_.column_starts[column + 1];
            const auto found = std::lower_bound(begin, end, row);
            // The search is done once for a pattern; each factorisation then adds entries at known places.
            places_[k][i] = static_cast<int>(found - matrix_.rows.begin());
        }
    }

    /// As solve_refined() does, either way.
    void solve(std::span<double> x, bool is_transposed) const
    {
        assert(x.size() == right_side_.size());
        const auto apply_inverse = [&](std::span<const double> b, std::span<double> y) {
            is_transposed ? lu_.solve_transposed(b, y) : lu_.solve(b, y);
        };
        std::copy(x.begin(), x.end(), right_side_.begin());
        apply_inverse(right_side_, x);
        is_transposed ? matrix_.multiply_transposed(x, residual_) : matrix_.multiply(x, residual_);
        for (std::size_t i = 0; i < x.size(); ++i) residual_[i] = right_side_[i] - residual_[i];
        apply_inverse(residual_, correction_);
        for (std::size_t i = 0; i < x.size(); ++i) x[i] += correction_[i];
    }

    SparseLU lu_;
    std::optional<BlockStructure> structure_;
    BlockMatrix pattern_;                    // 1 where an entry was not zero
    std::vector<std::vector<int>> places_;   // of the parts' entries in the sparse matrix
    std::vector<int> first_unknown_, first_row_;
    SparseMatrix matrix_;
    mutable Values right_side_, residual_, correction_;
};

}   // namespace

std::unique_ptr<LinearSolver> whole_solver(SparseBackend backend)
{
    return std::make_unique<WholeSolver>(backend);
}

}   // namespace livens::inline solvers_internal
