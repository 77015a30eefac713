// SPDX-License-Identifier: BSD-3-Clause
// Orthogonal sums of rows that see one border alone, and what these leave free there. Sums are chosen by
// pivoted QR; what they still see of others, a share of 1e-10, is left out, and comes back when solutions are
// refined by the rows as they are.
#include "livens/solvers/ranks/rank_borders.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Dense>

namespace livens::inline solvers_internal {

namespace {

using Columns = Eigen::MatrixXd;
using Numbers = Eigen::VectorXd;
using RowByRow = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Pivoted = Eigen::ColPivHouseholderQR<Columns>;

constexpr double left_out = 1e-10;         // of the largest pivot: rows below see nothing
constexpr double least_apart = 1e-3;       // sums for both borders are independent
constexpr double least_pivot_of = 1e-13;   // of the largest: rows at a border that are singular

/// The last n columns of Q.
Columns last_of(const Pivoted& qr, Eigen::Index n)
{
    Columns Q = Columns::Identity(qr.rows(), qr.rows()).rightCols(n);
    if (Q.size() > 0) Q.applyOnTheLeft(qr.householderQ());
    return Q;
}

/// Parts beside each other; those that are empty have no place in memory.
template <class Whole>
void put_beside(Whole& whole, std::initializer_list<Columns> parts)
{
    Eigen::Index at = 0;
    for (const Columns& part : parts) {
        if (part.size() > 0) whole.middleCols(at, part.cols()) = part;
        at += part.cols();
    }
}

}   // namespace

/// Rows and columns that see each other, and no others: an exact zero stays one, as it does in elimination.
struct MatrixBlock {
    std::vector<Eigen::Index> rows, columns;
};

namespace {

std::vector<MatrixBlock> blocks_of(const Columns& A)
{
    const Eigen::Index n = A.rows(), all = n + A.cols();
    std::vector<Eigen::Index> group(static_cast<std::size_t>(all));
    std::iota(group.begin(), group.end(), 0);
    const auto root = [&](Eigen::Index i) {
        while (group[i] != i) i = group[i] = group[group[i]];
        return i;
    };
    for (Eigen::Index j = 0; j < A.cols(); ++j)
        for (Eigen::Index i = 0; i < n; ++i)
            if (A(i, j) != 0) group[root(n + j)] = root(i);
    std::vector<MatrixBlock> blocks;
    std::vector<std::ptrdiff_t> at(static_cast<std::size_t>(all), -1);
    for (Eigen::Index i = 0; i < all; ++i) {
        std::ptrdiff_t& place = at[root(i)];
        if (place < 0) {
            place = std::ssize(blocks);
            blocks.emplace_back();
        }
        MatrixBlock& block = blocks[place];
        i < n ? block.rows.push_back(i) : block.columns.push_back(i - n);
    }
    return blocks;
}

/// Orthonormal columns y with y^T A = 0 nearly.
Columns blind_to(const Columns& A)
{
    if (A.cols() == 0 || A.rows() == 0) return Columns::Identity(A.rows(), A.rows());
    const Pivoted qr(A);
    const auto pivots = qr.matrixR().diagonal().cwiseAbs();
    const double least = left_out * pivots(0);
    Eigen::Index rank = 0;
    while (rank < pivots.size() && pivots(rank) > least) ++rank;
    return last_of(qr, A.rows() - rank);
}

/// Columns of blocks beside each other, of n rows.
Columns beside(const std::vector<MatrixBlock>& blocks, const std::vector<Columns>& parts, Eigen::Index n)
{
    Eigen::Index all = 0, at = 0;
    for (const Columns& part : parts) all += part.cols();
    Columns whole = Columns::Zero(n, all);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        for (Eigen::Index i = 0; parts[b].cols() > 0 && i < parts[b].rows(); ++i)
            whole.row(blocks[b].rows[i]).segment(at, parts[b].cols()) = parts[b].row(i);
        at += parts[b].cols();
    }
    return whole;
}

/// Sums of rows that see one border alone, and the others.
struct RowSums {
    Columns before, behind, both;
};

/// None for a border where they are too few to be worth a message.
RowSums sums_of(const Columns& A, Eigen::Index n1, Eigen::Index n2)
{
    const std::vector<MatrixBlock> blocks = blocks_of(A);
    std::vector<Columns> sums[2], rest;
    Eigen::Index found[2] = {0, 0};
    for (const MatrixBlock& block : blocks)
        for (const int side : {0, 1}) {
            std::vector<Eigen::Index> others;
            for (const Eigen::Index c : block.columns)
                if (side == 0 ? c >= n1 : c < n1 || c >= n1 + n2) others.push_back(c);
            sums[side].push_back(blind_to(A(block.rows, others)));
            found[side] += sums[side].back().cols();
        }
    for (const int side : {0, 1}) {
        const Eigen::Index fewest = (side == 0 ? n1 : n2) / 4;
        if (fewest == 0 || found[side] < fewest)
            for (Columns& one : sums[side]) one.resize(one.rows(), 0);
    }
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const Eigen::Index n = sums[0][b].rows(), k = sums[0][b].cols() + sums[1][b].cols();
        rest.push_back(Columns::Identity(n, n));
        if (k == 0) continue;
        Columns both(n, k);
        put_beside(both, {sums[0][b], sums[1][b]});
        const Pivoted qr(both);
        if (k <= n && qr.matrixR().diagonal().cwiseAbs().minCoeff() > least_apart)
            rest.back() = last_of(qr, n - k);
        else
            for (const int side : {0, 1}) sums[side][b].resize(n, 0);
    }
    const Eigen::Index n = A.rows();
    return {beside(blocks, sums[0], n), beside(blocks, sums[1], n), beside(blocks, rest, n)};
}

}   // namespace

/// Rows of both sides of a border, transposed, block by block.
class RowsAtBorder {
public:
    /// False: singular.
    bool factorise(const Columns& transposed)
    {
        blocks_ = blocks_of(transposed);
        factors_.clear();
        std::vector<Columns> free;
        for (const MatrixBlock& block : blocks_) {
            const auto n = std::ssize(block.rows), k = std::ssize(block.columns);
            if (k > n) return false;
            factors_.emplace_back();
            free.push_back(Columns::Identity(n, n));
            if (k == 0) continue;
            Pivoted& qr = factors_.back();
            qr.compute(transposed(block.rows, block.columns));
            const auto pivots = qr.matrixR().diagonal().cwiseAbs();
            if (!(pivots.minCoeff() > least_pivot_of * pivots(0))) return false;
            free.back() = last_of(qr, n - k);
        }
        free_ = beside(blocks_, free, transposed.rows());
        return true;
    }
    const Columns& free() const { return free_; }
    /// The shortest x with B x = c.
    /// With B^T P = Q R of the pivoted QR: R^T y = P^T c and x = Q (y, 0).
    void solve(const Numbers& c, Numbers& x) const
    {
        for (std::size_t b = 0; b < blocks_.size(); ++b) {
            const MatrixBlock& block = blocks_[b];
            const auto k = std::ssize(block.columns);
            if (k == 0) continue;
            const Pivoted& qr = factors_[b];
            Numbers y = qr.colsPermutation().transpose() * Numbers(c(block.columns));
            qr.matrixR().topLeftCorner(k, k).triangularView<Eigen::Upper>().transpose().solveInPlace(y);
            Numbers found = Numbers::Zero(std::ssize(block.rows));
            found.head(k) = y;
            found.applyOnTheLeft(qr.householderQ());
            x(block.rows) = found;
        }
    }

private:
    std::vector<MatrixBlock> blocks_;
    std::vector<Pivoted> factors_;
    Columns free_;
};

namespace {

std::span<double> numbers_in(Columns& A) { return {A.data(), static_cast<std::size_t>(A.size())}; }
std::span<double> numbers_in(Numbers& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

/// In one order, so that neighbours come to the same bits.
void add_product(const Columns& A, std::span<const double> x, Numbers& y)
{
    for (Eigen::Index j = 0; j < A.cols(); ++j)
        for (Eigen::Index i = 0; i < A.rows(); ++i) y(i) += A(i, j) * x[static_cast<std::size_t>(j)];
}

}   // namespace

/// One border of a rank.
struct OneBorder {
    Columns sums;    ///< of rows that see it alone
    Columns seen;    ///< what these see
    Columns free;    ///< what the rows of both sides leave free
    Columns rows;    ///< of the chain, by the numbers at the border
    Numbers found;   ///< particular solution
};

struct RankBorders::Parts {
    Columns A, sums;   // rows of the rank; sums of these that go into the chain
    int n_before = 0, n_behind = 0, n_others = 0;
    OneBorder before, behind;
    RowsAtBorder both;   // of the border behind
    Eigen::Index n_behind_sums = 0, n_of_next = 0;
    std::unique_ptr<RankChain> chain;
    int n_unknowns = 0;
    std::vector<double> z;
};

RankBorders::RankBorders(Ranks& ranks) : ranks_(ranks), parts_(std::make_unique<Parts>()) {}
RankBorders::~RankBorders() = default;

int RankBorders::n_unknowns() const { return parts_->n_unknowns; }
int RankBorders::n_rows() const { return static_cast<int>(parts_->sums.cols()); }

bool RankBorders::factorise(const RowsBetweenBorders& rows)
{
    Parts& p = *parts_;
    const Eigen::Index n = rows.n_rows, n1 = rows.n_before, n2 = rows.n_behind, m = rows.n_columns();
    p.A = Eigen::Map<const RowByRow>(rows.values.data(), n, m);
    p.n_before = rows.n_before;
    p.n_behind = rows.n_behind;
    p.n_others = static_cast<int>(rows.others.size());
    p.before.sums = p.behind.sums = Columns(n, 0);
    const bool is_finite = p.A.allFinite();
    RowSums sums{Columns(n, 0), Columns(n, 0), Columns::Identity(n, n)};
    if (is_finite) sums = sums_of(p.A, n1, n2);
    p.before.sums = std::move(sums.before);
    p.behind.sums = std::move(sums.behind);
    p.sums = std::move(sums.both);
    p.before.seen = p.before.sums.transpose() * p.A.leftCols(n1);
    p.behind.seen = p.behind.sums.transpose() * p.A.middleCols(n1, n2);
    return ranks_.all(solve_borders() && is_finite) && make_chain(rows);
}

/// The rank before a border gets the rows of the one behind, and tells what both leave free.
/// Where that fails all is told to be free, so that messages go on until all ranks know of it.
bool RankBorders::solve_borders()
{
    Parts& p = *parts_;
    const int here = ranks_.rank();
    const auto size_of = [](Eigen::Index n) { return static_cast<double>(n); };
    if (!ranks_.is_first()) {
        const double n = size_of(p.before.seen.rows());
        ranks_.send(here - 1, {&n, 1});
        ranks_.send(here - 1, numbers_in(p.before.seen));
    }
    bool is_done = true;
    if (!ranks_.is_last()) {
        double n = 0;
        ranks_.receive(here + 1, {&n, 1});
        p.n_of_next = static_cast<Eigen::Index>(n);
        p.n_behind_sums = p.behind.seen.rows();
        Columns next(p.n_of_next, p.n_behind);
        ranks_.receive(here + 1, numbers_in(next));
        Columns transposed(p.n_behind, p.n_behind_sums + p.n_of_next);
        put_beside(transposed, {p.behind.seen.transpose(), next.transpose()});
        is_done = transposed.allFinite() && p.both.factorise(transposed);
        p.behind.free = is_done ? p.both.free() : Columns::Identity(p.n_behind, p.n_behind);
    }
    if (!ranks_.is_first()) {
        double n = 0;
        ranks_.receive(here - 1, {&n, 1});
        p.before.free = Columns::Identity(p.n_before, static_cast<Eigen::Index>(n));
        if (p.before.free.cols() < p.n_before) ranks_.receive(here - 1, numbers_in(p.before.free));
    }
    if (!ranks_.is_last()) {
        const double n = size_of(p.behind.free.cols());
        ranks_.send(here + 1, {&n, 1});
        if (p.behind.free.cols() < p.n_behind) ranks_.send(here + 1, numbers_in(p.behind.free));
    }
    return is_done;
}

/// Unknowns of the chain are what each border leaves free, border after border, then those of all ranks. The
/// memory of the rank's rows is given back here: their sums are enough for all that follows.
bool RankBorders::make_chain(const RowsBetweenBorders& rows)
{
    Parts& p = *parts_;
    const int n1 = static_cast<int>(p.before.free.cols()), n2 = static_cast<int>(p.behind.free.cols());
    const double own = n2;
    const int first = static_cast<int>(ranks_.sum_before({&own, 1})[0]);
    double all = first + n2;
    ranks_.broadcast(ranks_.size() - 1, {&all, 1});
    const int n_free = static_cast<int>(all);
    p.n_unknowns = n_free + rows.n_others;
    ChainRows left;
    left.n_unknowns = p.n_unknowns;
    for (int i = 0; i < n1 + n2; ++i) left.columns.push_back(first - n1 + i);
    for (const int other : rows.others) left.columns.push_back(n_free + other);
    const Eigen::Index m = p.A.cols(), k = p.sums.cols();
    p.before.rows = p.sums.transpose() * p.A.leftCols(p.n_before);
    p.behind.rows = p.sums.transpose() * p.A.middleCols(p.n_before, p.n_behind);
    RowByRow values(k, n1 + n2 + p.n_others);
    put_beside(values, {p.before.rows * p.before.free, p.behind.rows * p.behind.free,
                        p.sums.transpose() * p.A.rightCols(m - p.n_before - p.n_behind)});
    left.values.assign(values.data(), values.data() + values.size());
    p.z.resize(left.columns.size());
    p.A.resize(0, 0);
    if (p.n_unknowns == 0) return true;
    if (!p.chain) p.chain = ranks_.make_chain();
    return p.chain->factorise(left);
}

void RankBorders::solve(std::span<const double> b, std::span<double> x)
{
    Parts& p = *parts_;
    const int here = ranks_.rank();
    const Eigen::Map<const Numbers> right(b.data(), static_cast<Eigen::Index>(b.size()));
    if (!ranks_.is_first()) {
        Numbers own = p.before.sums.transpose() * right;
        ranks_.send(here - 1, numbers_in(own));
    }
    p.behind.found = Numbers::Zero(p.n_behind);
    p.before.found = Numbers::Zero(p.n_before);
    if (!ranks_.is_last()) {
        Numbers next(p.n_of_next), of_both(p.n_behind_sums + p.n_of_next);
        ranks_.receive(here + 1, numbers_in(next));
        of_both.head(p.n_behind_sums) = p.behind.sums.transpose() * right;
        of_both.tail(p.n_of_next) = next;
        p.both.solve(of_both, p.behind.found);
        ranks_.send(here + 1, numbers_in(p.behind.found));
    }
    if (!ranks_.is_first()) ranks_.receive(here - 1, numbers_in(p.before.found));
    Numbers rows = p.sums.transpose() * right;
    rows -= p.before.rows * p.before.found + p.behind.rows * p.behind.found;
    if (p.n_unknowns > 0) p.chain->solve(numbers_in(rows), p.z);
    const auto n1 = static_cast<std::size_t>(p.before.free.cols()),
               n2 = static_cast<std::size_t>(p.behind.free.cols());
    const std::span<const double> z(p.z);
    add_product(p.before.free, z.first(n1), p.before.found);
    add_product(p.behind.free, z.subspan(n1, n2), p.behind.found);
    auto to = std::copy(p.before.found.begin(), p.before.found.end(), x.begin());
    to = std::copy(p.behind.found.begin(), p.behind.found.end(), to);
    std::copy(z.begin() + static_cast<std::ptrdiff_t>(n1 + n2), z.end(), to);
}

}   // namespace livens::inline solvers_internal
