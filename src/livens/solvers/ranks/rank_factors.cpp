// SPDX-License-Identifier: BSD-3-Clause
// A stretch of rows in every rank, eliminated apart from all others, and the chain of what is left of them.
#include "livens/solvers/ranks/rank_factors.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "livens/solvers/detail/stretch.h"
#include "livens/solvers/ranks/rank_borders.h"

namespace livens::inline solvers_internal {

struct RankFactors::Parts {
    StoredRows rows;
    Stretch stretch;
    ChainPlaces places;
    RankBorders borders;
    std::vector<double> y, missed, correction, left, joined;

    explicit Parts(Ranks& ranks) : borders(ranks) {}
};

namespace {

/// Row by row, columns ascending: those of A, then those behind.
void store(const SparseMatrix& A, const std::vector<OutsideEntry>& outside, int n_rows, StoredRows& rows)
{
    rows.starts.assign(static_cast<std::size_t>(n_rows) + 1, 0);
    for (const int row : A.rows) ++rows.starts[row + 1];
    for (const OutsideEntry& entry : outside) ++rows.starts[entry.row + 1];
    std::partial_sum(rows.starts.begin(), rows.starts.end(), rows.starts.begin());
    rows.columns.resize(A.rows.size() + outside.size());
    rows.values.resize(rows.columns.size());
    std::vector<int> next(rows.starts.begin(), rows.starts.end() - 1);
    const auto put = [&](int row, int column, double value) {
        const int at = next[row]++;
        rows.columns[at] = column;
        rows.values[at] = value;
    };
    for (int c = 0; c < A.size; ++c)
        for (int k = A.column_starts[c]; k < A.column_starts[c + 1]; ++k) put(A.rows[k], c, A.values[k]);
    for (const OutsideEntry& entry : outside) put(entry.row, entry.column, entry.value);
}

}   // namespace

RankFactors::RankFactors(Ranks& ranks) : ranks_(ranks), parts_(std::make_unique<Parts>(ranks)) {}
RankFactors::~RankFactors() = default;

/// All ranks hear whether each has eliminated its columns before any goes on: the chain needs rows of all.
bool RankFactors::factorise(const SparseMatrix& A, const std::vector<OutsideEntry>& outside, int n_columns,
                            const ChainPlaces& places)
{
    Parts& p = *parts_;
    p.places = places;
    store(A, outside, places.n_rows, p.rows);
    std::vector<int> work(static_cast<std::size_t>(n_columns));
    p.stretch.analyse(p.rows, {0, places.n_rows}, places.own, places.columns, work);
    p.y.assign(static_cast<std::size_t>(places.n_rows), 0.0);
    if (!ranks_.all(p.stretch.eliminate(p.rows))) return false;
    p.left.resize(p.stretch.left().size());
    p.joined.resize(places.columns.size());
    return p.borders.factorise({static_cast<int>(p.left.size()), places.n_before, places.n_behind,
                                places.of_all, places.n_of_all, p.stretch.left_values()});
}

void RankFactors::apply_inverse(std::span<const double> b, std::span<double> x)
{
    Parts& p = *parts_;
    std::ranges::copy(b, p.y.begin());
    p.stretch.forward(p.y.data());
    for (std::size_t i = 0; i < p.left.size(); ++i) p.left[i] = p.y[p.stretch.left()[i]];
    p.borders.solve(p.left, p.joined);
    for (std::size_t i = 0; i < p.joined.size(); ++i) x[p.places.columns[i]] = p.joined[i];
    p.stretch.backward(p.y.data(), x.data());
}

/// Once refined by the rows as they are: borders leave out what their sums see of others, a share of 1e-10.
void RankFactors::solve(std::span<const double> b, std::span<double> x)
{
    Parts& p = *parts_;
    apply_inverse(b, x);
    p.missed.assign(b.begin(), b.end());
    for (int r = 0; r < p.rows.size(); ++r)
        for (int k = p.rows.starts[r]; k < p.rows.starts[r + 1]; ++k)
            p.missed[r] -= p.rows.values[k] * x[p.rows.columns[k]];
    p.correction.assign(x.size(), 0.0);
    apply_inverse(p.missed, p.correction);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += p.correction[i];
}

long long RankFactors::entries() const { return parts_->stretch.n_entries(); }
long long RankFactors::flops() const { return parts_->stretch.flops(); }
int RankFactors::n_left() const { return static_cast<int>(parts_->stretch.left().size()); }
int RankFactors::n_in_chain() const { return parts_->borders.n_rows(); }
int RankFactors::n_chain() const { return parts_->borders.n_unknowns(); }

}   // namespace livens::inline solvers_internal
