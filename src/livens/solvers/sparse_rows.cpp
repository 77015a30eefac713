// SPDX-License-Identifier: BSD-3-Clause
// Rows G that touch few columns each: the Cholesky factor of G G^T, and the projection onto the null space of
// G. Serves rank and least reactions along long chains (theory.md, "Rank is geometry").
#include "livens/solvers/sparse_rows.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <string>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

namespace livens::inline solvers_internal {

namespace {

using EigenColumns = Eigen::SparseMatrix<double>;

EigenColumns sum_of(std::span<const SparseEntry> entries, int n_rows, int n_columns, bool keep_zeros)
{
    std::vector<Eigen::Triplet<double>> triplets;
    triplets.reserve(entries.size());
    for (const SparseEntry& entry : entries)
        if (keep_zeros || entry.value != 0) triplets.emplace_back(entry.row, entry.column, entry.value);
    EigenColumns sum(n_rows, n_columns);
    sum.setFromTriplets(triplets.begin(), triplets.end());
    return sum;
}

}   // namespace

struct SparseRows::Matrices {
    EigenColumns G;
    Eigen::SimplicialLDLT<EigenColumns> factor;
};

/// The same by plain loops, row by row: of few rows it takes a fourth of the time.
struct SparseRows::FewRows {
    static constexpr int most_rows = 48, most_columns = 60;

    FewRows(int rows, int columns, std::span<const Entry> entries)
        : n_rows(rows), n_columns(columns), G(static_cast<std::size_t>(rows * columns), 0.0),
          L(static_cast<std::size_t>(rows * rows)), first(static_cast<std::size_t>(rows), columns),
          last(static_cast<std::size_t>(rows), 0)
    {
        for (const Entry& entry : entries) {
            G[entry.row * n_columns + entry.column] += entry.value;
            first[entry.row] = std::min(first[entry.row], entry.column);
            last[entry.row] = std::max(last[entry.row], entry.column + 1);
        }
    }

    /// L D L^T of G G^T, D on the diagonal. Returns the smallest pivot over the row's own square; 0: no
    /// factor.
    double factorise()
    {
        double smallest = 1;
        for (int r = 0; r < n_rows; ++r) {
            double* row = L.data() + r * n_rows;
            for (int k = 0; k <= r; ++k) row[k] = product_of_rows(r, k);
            const double square = row[r];
            for (int k = 0; k < r; ++k) {
                const double* above = L.data() + k * n_rows;
                double sum = row[k];
                for (int m = 0; m < k; ++m) sum -= row[m] * above[m];   // D L^T of those before
                row[k] = sum;
            }
            for (int k = 0; k < r; ++k) {
                const double scaled = row[k] / L[k * n_rows + k];
                row[r] -= row[k] * scaled;
                row[k] = scaled;
            }
            if (!(row[r] > 0)) return 0;
            smallest = std::min(smallest, row[r] / square);
        }
        return smallest;
    }

    /// mu <- (G G^T)^-1 mu
    void solve(std::vector<double>& mu) const
    {
        for (int r = 0; r < n_rows; ++r) {
            double sum = mu[r];
            for (int k = 0; k < r; ++k) sum -= L[r * n_rows + k] * mu[k];
            mu[r] = sum;
        }
        for (int r = 0; r < n_rows; ++r) mu[r] /= L[r * n_rows + r];
        for (int r = n_rows; r-- > 0;) {
            const double of_row = mu[r];
            for (int k = 0; k < r; ++k) mu[k] -= L[r * n_rows + k] * of_row;
        }
    }

    /// mu <- G y - wanted
    void miss(std::span<const double> y, std::span<const double> wanted, std::vector<double>& mu) const
    {
        for (int r = 0; r < n_rows; ++r) {
            double sum = -wanted[r];
            for (int c = first[r]; c < last[r]; ++c) sum += G[r * n_columns + c] * y[c];
            mu[r] = sum;
        }
    }

    /// y -= G^T mu
    void take_off(const std::vector<double>& mu, std::span<double> y) const
    {
        for (int r = 0; r < n_rows; ++r)
            for (int c = first[r]; c < last[r]; ++c) y[c] -= mu[r] * G[r * n_columns + c];
    }

    int n_rows, n_columns;

private:
    double product_of_rows(int r, int k) const
    {
        double sum = 0;
        for (int c = std::max(first[r], first[k]); c < std::min(last[r], last[k]); ++c)
            sum += G[r * n_columns + c] * G[k * n_columns + c];
        return sum;
    }

    std::vector<double> G, L;
    std::vector<int> first, last;   // columns of each row
};

SparseRows::SparseRows(int n_rows, int n_columns, std::span<const Entry> entries)
{
    if (n_rows <= FewRows::most_rows && n_columns <= FewRows::most_columns) {
        few_ = std::make_unique<FewRows>(n_rows, n_columns, entries);
        smallest_pivot_ = std::sqrt(few_->factorise());
        return;
    }
    matrices_ = std::make_unique<Matrices>();
    matrices_->G = sum_of(entries, n_rows, n_columns, false);
    const EigenColumns S = matrices_->G * matrices_->G.transpose();
    matrices_->factor.compute(S);
    if (matrices_->factor.info() != Eigen::Success) return;
    const Eigen::VectorXd pivots = matrices_->factor.vectorD(),
                          order = matrices_->factor.permutationP() * Eigen::VectorXd(S.diagonal());
    double smallest = 1;
    for (Eigen::Index i = 0; i < pivots.size(); ++i) {
        // A pivot of G G^T over the row's own square is the squared sine of the angle to the rows before it.
        const double ratio = pivots[i] / order[i];
        if (!(ratio >= smallest)) smallest = ratio > 0 ? ratio : 0;   // nan is no pivot
    }
    smallest_pivot_ = std::sqrt(smallest);
}

SparseRows::~SparseRows() = default;

std::vector<double> SparseRows::project(std::span<double> y, std::span<const double> wanted) const
{
    // Each pass leaves eps / pivot^2 of what it was to take off, so smaller pivots need more passes.
    const int n_passes = smallest_pivot_ > 1e-3 ? 2 : 4;
    if (few_) {
        std::vector<double> sum(wanted.size(), 0.0), mu(sum);
        for (int pass = 0; pass < n_passes; ++pass) {
            few_->miss(y, wanted, mu);
            few_->solve(mu);
            few_->take_off(mu, y);
            for (std::size_t r = 0; r < mu.size(); ++r) sum[r] += mu[r];
        }
        return sum;
    }
    Eigen::Map<Eigen::VectorXd> to(y.data(), static_cast<Eigen::Index>(y.size()));
    const Eigen::Map<const Eigen::VectorXd> aim(wanted.data(), static_cast<Eigen::Index>(wanted.size()));
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(aim.size());
    for (int pass = 0; pass < n_passes; ++pass) {
        const Eigen::VectorXd mu = matrices_->factor.solve(matrices_->G * to - aim);
        to -= matrices_->G.transpose() * mu;
        sum += mu;
    }
    return {sum.begin(), sum.end()};
}

std::optional<std::vector<double>> sparse_solution(std::span<const SparseEntry> A, std::span<const double> b)
{
    const int n = static_cast<int>(b.size());
    if (n == 0) return std::vector<double>{};
    if (!std::ranges::all_of(A, [](const SparseEntry& e) { return std::isfinite(e.value); })) return {};
    const Eigen::SparseLU<EigenColumns> lu(sum_of(A, n, n, true));
    if (lu.lastErrorMessage().starts_with("UNABLE")) throw std::bad_alloc();   // to allocate working memory
    if (lu.info() != Eigen::Success) return {};
    const Eigen::VectorXd x = lu.solve(Eigen::Map<const Eigen::VectorXd>(b.data(), n));
    return std::vector<double>(x.begin(), x.end());
}

}   // namespace livens::inline solvers_internal
