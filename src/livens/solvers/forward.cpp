// SPDX-License-Identifier: BSD-3-Clause
// Systems that are known at one end: block triangular over elements.
// Elimination goes with the flow of time: the rows of an element hold no unknowns of later ones (theory.md,
// "Windows"), so each element needs one dense LU, and nothing fills in outside of its blocks. With the state
// known at the end the same pieces are taken in the opposite order.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "livens/solvers/crew.h"
#include "livens/solvers/dense.h"
#include "livens/solvers/linear_solver.h"
#include "livens/solvers/patience.h"
#include "livens/solvers/short_rows.h"

namespace livens::inline solvers_internal {

namespace {

using Values = std::vector<double>;

/// Whether the sum of all is finite, eight sums at a time so that they do not wait for each other: this is
/// done before every factorisation, which for a few unknowns takes hardly longer.
bool is_finite(const Values& x)
{
    std::array<double, 8> sums{};
    std::size_t i = 0;
    for (; i + sums.size() <= x.size(); i += sums.size())
        for (std::size_t lane = 0; lane < sums.size(); ++lane) sums[lane] += x[i + lane];
    for (; i < x.size(); ++i) sums[0] += x[i];
    return std::isfinite(std::accumulate(sums.begin(), sums.end(), 0.0));
}

/// A dense block of an element's matrix.
struct Block {
    int n_rows = 0, n_columns = 0;
    Values values;

    void resize(int rows, int columns)
    {
        n_rows = rows;
        n_columns = columns;
        values.assign(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns), 0.0);
    }

    void copy(const double* from, int stride)
    {
        double* to = values.data();
        for (int i = 0; i < n_rows; ++i, from += stride, to += n_columns) std::copy_n(from, n_columns, to);
    }

    void copy_transposed(const double* from, int stride)
    {
        for (int j = 0; j < n_columns; ++j, from += stride)
            for (int i = 0; i < n_rows; ++i)
                values[count(i, n_columns) + static_cast<std::size_t>(j)] = from[i];
    }

    /// y <- y - B x and y <- y - B^T x.
    void subtract_product(const double* x, double* y) const
    {
        const RowFunctions& rows = row_functions();
        const double* b = values.data();
        for (int i = 0; i < n_rows; ++i, b += n_columns) y[i] -= inner(rows, b, x, n_columns);
    }
    void subtract_transposed_product(const double* x, double* y) const
    {
        const RowFunctions& rows = row_functions();
        const double* b = values.data();
        for (int i = 0; i < n_rows; ++i, b += n_columns) subtract_scaled(rows, y, x[i], b, n_columns);
    }
};

constexpr int least_shared_pieces = 8;   // that a thread takes, where there are several

[[noreturn]] void refuse_ends(const std::string& why)
{
    throw std::invalid_argument("not known at one end: " + why);
}

/// One element: its own rows and unknowns are `size` numbers from `begin` on, in the order of rows and in
/// that of unknowns alike, since all before (mirrored: all behind) are as many.
struct Piece {
    int begin = 0;
    int size = 0;
    int row_node = 0, unknown_node = 0;   // first of its own
    int known_node = 0;                   // whose unknowns come from the piece before
    int passed_node = 0;                  // whose rows belong to the piece after
    int known_begin = 0, passed_begin = 0, all_begin = 0;
    DenseLU lu;
    Outcome outcome = Outcome::singular;   // of its factors
    Block known;                           // unknowns of the known node x own rows
    Block passed;                          // rows of the passed node x all unknowns
};

class ForwardSolver final : public LinearSolver {
public:
    void analyse(const BlockStructure& structure) override
    {
        if (structure_ && *structure_ == structure) return;
        structure_.reset();   // stays so if the structure is refused
        is_regular_ = false;
        singular_node_ = -1;
        structure.check();
        if (structure.n_border > 0 || structure.n_closing > 0) refuse_ends("there is a border");
        is_mirrored_ = choose_end(structure);
        running_sums(structure.n_rows, first_row_);
        running_sums(structure.n_unknowns, first_unknown_);
        pieces_.resize(structure.elements.size());
        for (int e = 0; e < structure.n_elements(); ++e) {
            Patience::ask();
            shape(structure, e);
        }
        for_each_item(n_pieces(), least_shared_pieces, [&](int e) { take_room(structure, e); });
        structure_ = structure;
    }

    Outcome factorise(BlockMatrix& matrix) override
    {
        assert(structure_ && matrix.n_elements() == structure_->n_elements());
        singular_node_ = -1;
        is_regular_ = false;
        for_each_item(matrix.n_elements(), least_shared_pieces, [&](int e) {
            Patience::ask();
            Piece& piece = pieces_[static_cast<std::size_t>(e)];
            piece.outcome = Outcome::not_finite;
            if (!is_finite(matrix.storage(e))) return;
            take(matrix, e);
            piece.outcome = piece.lu.factorise() ? Outcome::regular : Outcome::singular;
        });
        for (const Piece& piece : pieces_) {
            if (piece.outcome == Outcome::singular)
                singular_node_ = node_of(piece.begin + piece.lu.failed_column());
            if (piece.outcome != Outcome::regular) return piece.outcome;
        }
        is_regular_ = true;
        return Outcome::regular;
    }

    void solve(std::span<double> x) const override
    {
        assert(is_regular_ && static_cast<int>(x.size()) == first_unknown_.back());
        for (int i = 0; i < n_pieces(); ++i) {
            const Piece& piece = in_order(i);
            // What the piece before has solved moves to the right-hand side; then the rows that the next
            // piece owns receive this one's unknowns. That is block forward substitution.
            piece.known.subtract_transposed_product(x.data() + piece.known_begin, x.data() + piece.begin);
            piece.lu.solve(x.data() + piece.begin);
            piece.passed.subtract_product(x.data() + piece.all_begin, x.data() + piece.passed_begin);
        }
    }

    void solve_transposed(std::span<double> x) const override
    {
        assert(is_regular_ && static_cast<int>(x.size()) == first_unknown_.back());
        for (int i = n_pieces() - 1; i >= 0; --i) {
            const Piece& piece = in_order(i);
            // The transposed matrix is block upper triangular, so the same two products run backwards and
            // exchange their parts.
            piece.passed.subtract_transposed_product(x.data() + piece.passed_begin,
                                                     x.data() + piece.all_begin);
            piece.lu.solve_transposed(x.data() + piece.begin);
            piece.known.subtract_product(x.data() + piece.begin, x.data() + piece.known_begin);
        }
    }

    void solve_closing(std::span<const double>, std::span<double>) const override {}   // there are none

    LinearReport report() const override
    {
        LinearReport report{.singular_node = singular_node_};
        for (const Piece& piece : pieces_)
            report.factor_entries += static_cast<long long>(piece.size) * piece.size +
                                     static_cast<long long>(piece.known.values.size()) +
                                     static_cast<long long>(piece.passed.values.size());
        if (!is_regular_) return report;   // some have no factors
        Values smallest(pieces_.size()), largest(pieces_.size());
        for_each_item(n_pieces(), least_shared_pieces, [&](int e) {
            smallest[e] = pieces_[e].lu.smallest_pivot();
            largest[e] = pieces_[e].lu.largest_in_U();
        });
        report.smallest_pivot = std::numeric_limits<double>::infinity();
        for (const double pivot : smallest) report.smallest_pivot = std::min(report.smallest_pivot, pivot);
        for (const double entry : largest) report.largest_entry = std::max(report.largest_entry, entry);
        return report;
    }

private:
    int n_pieces() const { return static_cast<int>(pieces_.size()); }
    const Piece& in_order(int i) const
    {
        return pieces_[static_cast<std::size_t>(is_mirrored_ ? n_pieces() - 1 - i : i)];
    }

    /// Whether all is known at the end instead of the start.
    static bool choose_end(const BlockStructure& structure)
    {
        for (std::size_t e = 1; e < structure.elements.size(); ++e)
            if (structure.elements[e][0] != structure.elements[e - 1][1])
                refuse_ends("elements " + std::to_string(e - 1) + " and " + std::to_string(e) +
                       " share more than one node");
        if (structure.elements.empty()) return false;
        // With the state known at the start the first node has no unknowns and the last one no rows;
        // mirrored, vice versa.
        if (structure.n_unknowns.front() == 0 && structure.n_rows.back() == 0) return false;
        if (structure.n_rows.front() == 0 && structure.n_unknowns.back() == 0) return true;
        refuse_ends("the first node has " + std::to_string(structure.n_unknowns.front()) + " unknowns and " +
               std::to_string(structure.n_rows.front()) + " rows, the last " +
               std::to_string(structure.n_unknowns.back()) + " and " +
               std::to_string(structure.n_rows.back()));
    }

    int row(int node) const { return first_row_[static_cast<std::size_t>(node)]; }
    int unknown(int node) const { return first_unknown_[static_cast<std::size_t>(node)]; }

    /// Known at the start, an element has the rows of its first node and the unknowns of its last one, beside
    /// what is inside; mirrored, the other way round.
    void shape(const BlockStructure& structure, int e)
    {
        const auto [first, last] = structure.elements[static_cast<std::size_t>(e)];
        Piece& piece = pieces_[static_cast<std::size_t>(e)];
        piece.row_node = is_mirrored_ ? first + 1 : first;
        piece.unknown_node = is_mirrored_ ? first : first + 1;
        piece.known_node = is_mirrored_ ? last : first;
        piece.passed_node = is_mirrored_ ? first : last;
        const int inner = last - first;
        const int n_rows = row(piece.row_node + inner) - row(piece.row_node);
        piece.size = unknown(piece.unknown_node + inner) - unknown(piece.unknown_node);
        if (n_rows != piece.size)
            refuse_ends("element " + std::to_string(e) + " has " + std::to_string(n_rows) + " rows for " +
                   std::to_string(piece.size) + " unknowns");
        piece.begin = unknown(piece.unknown_node);
        assert(piece.begin == row(piece.row_node));
        piece.known_begin = unknown(piece.known_node);
        piece.passed_begin = row(piece.passed_node);
        piece.all_begin = unknown(first);
    }

    void take_room(const BlockStructure& structure, int e)
    {
        const auto [first, last] = structure.elements[static_cast<std::size_t>(e)];
        Piece& piece = pieces_[static_cast<std::size_t>(e)];
        piece.lu.resize(piece.size);
        piece.known.resize(structure.n_unknowns[static_cast<std::size_t>(piece.known_node)], piece.size);
        piece.passed.resize(structure.n_rows[static_cast<std::size_t>(piece.passed_node)],
                            unknown(last + 1) - unknown(first));
    }

    /// Fills in the piece's blocks.
    void take(BlockMatrix& matrix, int e)
    {
        Piece& piece = pieces_[static_cast<std::size_t>(e)];
        const int stride = matrix.stride(e);
        if (piece.known.n_rows == 0 && piece.passed.n_rows == 0) {   // nothing but its own block
            piece.lu.exchange(matrix.storage(e));
            return;
        }
        const double* own = matrix.block(e, piece.row_node, piece.unknown_node);
        for (int i = 0; i < piece.size; ++i, own += stride) std::copy_n(own, piece.size, piece.lu.row(i));
        const int first = structure_->elements[static_cast<std::size_t>(e)][0];
        piece.known.copy_transposed(matrix.block(e, piece.row_node, piece.known_node), stride);
        piece.passed.copy(matrix.block(e, piece.passed_node, first), stride);
    }

    int node_of(int unknown) const
    {
        const auto after = std::upper_bound(first_unknown_.begin(), first_unknown_.end(), unknown);
        return static_cast<int>(after - first_unknown_.begin()) - 1;
    }

    std::optional<BlockStructure> structure_;
    bool is_mirrored_ = false;
    std::vector<int> first_row_, first_unknown_;
    std::vector<Piece> pieces_;
    bool is_regular_ = false;   // the last factorisation
    int singular_node_ = -1;
};

}   // namespace

std::unique_ptr<LinearSolver> forward_solver() { return std::make_unique<ForwardSolver>(); }

}   // namespace livens::inline solvers_internal
