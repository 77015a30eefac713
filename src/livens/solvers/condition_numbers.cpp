// SPDX-License-Identifier: BSD-3-Clause
// Condition numbers of matrices by products and solutions.
// kappa = |A| |A^-1| in the 1-norm and the 2-norm, of the matrix that was stated and not of the scaled one:
// docs/paper.md, "Figure 3", compares both. Scales are undone around each product, so no second matrix is
// formed.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "livens/solvers/sparse.h"

namespace livens {

namespace {

using Values = std::vector<double>;

/// |R^-1 S C^-1|_1, exactly.
double one_norm(const SparseMatrix& S, const Values& row_scale, const Values& column_scale)
{
    double largest = 0;
    for (int j = 0; j < S.size; ++j) {
        // Columns are at hand, so this norm is exact; only that of the inverse has to be estimated.
        double sum = 0;
        for (int k = S.column_starts[j]; k < S.column_starts[j + 1]; ++k)
            sum += std::abs(S.values[k] / row_scale[S.rows[k]]);
        largest = std::max(largest, sum / std::abs(column_scale[j]));
    }
    return largest;
}

Values scale_or_ones(std::span<const double> scale, int size)
{
    assert(scale.empty() || static_cast<int>(scale.size()) == size);
    return scale.empty() ? Values(static_cast<std::size_t>(size), 1.0) : Values(scale.begin(), scale.end());
}

void multiply_by(std::span<double> x, const Values& scale)
{
    for (std::size_t i = 0; i < x.size(); ++i) x[i] *= scale[i];
}

void divide_by(std::span<double> x, const Values& scale)
{
    for (std::size_t i = 0; i < x.size(); ++i) x[i] /= scale[i];
}

/// All that is known of a matrix.
struct KnownMatrix {
    int size = 0;
    double one_norm = 0;
    LinearMap multiply, multiply_transposed, solve, solve_transposed;
};

ConditionNumbers condition_numbers(const KnownMatrix& A, const std::function<bool()>& goes_on)
{
    // Who is stopped gets infinity, which ends every search for a norm at once.
    bool is_stopped = false;
    const auto asking = [&](const LinearMap& map) -> LinearMap {
        return [&](std::span<const double> x, std::span<double> y) {
            is_stopped = is_stopped || (goes_on && !goes_on());
            if (is_stopped)
                std::fill(y.begin(), y.end(), std::numeric_limits<double>::infinity());
            else
                map(x, y);
        };
    };
    const LinearMap matrix = asking(A.multiply), matrix_transposed = asking(A.multiply_transposed),
                    inverse = asking(A.solve), inverse_transposed = asking(A.solve_transposed);
    const ConditionNumbers numbers{.one = A.one_norm * livens::one_norm(A.size, inverse, inverse_transposed),
                                   .two = two_norm(A.size, matrix, matrix_transposed) *
                                          two_norm(A.size, inverse, inverse_transposed)};
    return is_stopped ? ConditionNumbers{} : numbers;
}

}   // namespace

ConditionNumbers condition_numbers(const SparseMatrix& A, const LinearMap& solve,
                                   const LinearMap& solve_transposed, const std::function<bool()>& goes_on)
{
    const Values ones(static_cast<std::size_t>(A.size), 1.0);
    const double norm = one_norm(A, ones, ones);
    const auto multiply = [&](std::span<const double> x, std::span<double> y) { A.multiply(x, y); };
    const auto transposed = [&](std::span<const double> x, std::span<double> y) {
        A.multiply_transposed(x, y);
    };
    return condition_numbers(KnownMatrix{A.size, norm, multiply, transposed, solve, solve_transposed},
                             goes_on);
}

ConditionNumbers condition_numbers(const SparseMatrix& scaled, const SparseLU& lu,
                                   std::span<const double> row_scale, std::span<const double> column_scale,
                                   const std::function<bool()>& goes_on)
{
    const Values R = scale_or_ones(row_scale, scaled.size), C = scale_or_ones(column_scale, scaled.size);
    Values scratch(static_cast<std::size_t>(scaled.size));
    using Input = std::span<const double>;
    using Output = std::span<double>;
    // y = after * f(before * x), scaled by products or quotients.
    const auto map = [&](auto scale, const Values& before, auto f, const Values& after) -> LinearMap {
        return [&, scale, f](Input x, Output y) {
            std::copy(x.begin(), x.end(), scratch.begin());
            scale(scratch, before);
            f(scratch, y);
            scale(y, after);
        };
    };
    const auto S = [&](Input x, Output y) { scaled.multiply(x, y); };
    const auto S_transposed = [&](Input x, Output y) { scaled.multiply_transposed(x, y); };
    const auto solve = [&](Input x, Output y) { lu.solve(x, y); };
    const auto solve_transposed = [&](Input x, Output y) { lu.solve_transposed(x, y); };
    // S = R A C was factorised: A = R^-1 S C^-1 and A^-1 = C S^-1 R, and the transposes in the other order.
    // R^-1 S C^-1 and C S^-1 R
    return condition_numbers(KnownMatrix{scaled.size, one_norm(scaled, R, C), map(divide_by, C, S, R),
                                         map(divide_by, R, S_transposed, C), map(multiply_by, R, solve, C),
                                         map(multiply_by, C, solve_transposed, R)},
                             goes_on);
}

}   // namespace livens
