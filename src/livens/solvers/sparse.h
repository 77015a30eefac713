// SPDX-License-Identifier: BSD-3-Clause
// Sparse direct solution: LU with row exchanges, behind one interface for several libraries.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace [[gnu::visibility("default")]] livens {

/// Square matrix by compressed columns; the rows of a column ascend strictly.
struct SparseMatrix {
    int size = 0;
    std::vector<int> column_starts;   ///< size + 1
    std::vector<int> rows;
    std::vector<double> values;

    int n_entries() const { return static_cast<int>(rows.size()); }
    /// y = A x and y = A^T x.
    void multiply(std::span<const double> x, std::span<double> y) const;
    void multiply_transposed(std::span<const double> x, std::span<double> y) const;
};

/// From lists of (row, value) for every column, rows ascending.
SparseMatrix sparse_from_columns(const std::vector<std::vector<std::pair<int, double>>>& columns);

enum class SparseBackend {
    eigen,    ///< Eigen's SparseLU in the natural order: columns are eliminated as they come
    umfpack   ///< UMFPACK in METIS' order, the paper's choice; optional, see LIVENS_UMFPACK
};

/// In scenarios, in this order.
constexpr std::array<std::string_view, 2> words_of(SparseBackend) { return {"eigen", "umfpack"}; }

/// Whether this build has the backend.
bool has_backend(SparseBackend backend);

/// A factorisation, made again and again for one pattern.
class SparseLU {
public:
    /// Throws InputError (code `backend-missing`, path method.linear_solver) where the build lacks it.
    explicit SparseLU(SparseBackend backend);
    ~SparseLU();
    SparseLU(SparseLU&&) noexcept;
    SparseLU& operator=(SparseLU&&) noexcept;

    /// Orders and analyses the pattern; values do not matter. To be repeated when the pattern changes.
    void analyse(const SparseMatrix& A);
    /// False if the matrix is singular to the library or an entry is not finite. `A` must have the analysed
    /// pattern; it is not kept. Throws Stopped where Patience ends (Eigen; UMFPACK cannot be stopped).
    bool factorise(const SparseMatrix& A);
    /// x = A^-1 b and x = A^-T b; b and x may be the same.
    void solve(std::span<const double> b, std::span<double> x) const;
    void solve_transposed(std::span<const double> b, std::span<double> x) const;
    /// Stored entries of both factors.
    long long factor_entries() const;
    /// "Eigen 3.4.0 SparseLU, natural order", for reports.
    std::string description() const;

    struct Implementation;

private:
    std::unique_ptr<Implementation> implementation_;
};

/// x = A^-1 b with `steps` of iterative refinement: residuals of A, corrections by the factors.
void solve_refined(const SparseLU& lu, const SparseMatrix& A, std::span<const double> b, std::span<double> x,
                   int steps = 1);

/// A square matrix known by what it does to a vector: y = f(x).
using LinearMap = std::function<void(std::span<const double> x, std::span<double> y)>;

/// Norms of a linear map of this size, by its products alone: the 1-norm by the block algorithm of
/// [Higham2000] (a lower bound, almost always exact), the 2-norm by Lanczos' process on A^T A (within 1e-4 of
/// the value, as a rule far closer; it ends when twice the last change is below 1e-6 of the value, or after
/// 1200 products with each). Repeatable: started from fixed vectors. Infinity where a product is not finite.
double one_norm(int size, const LinearMap& apply, const LinearMap& apply_transposed);
double two_norm(int size, const LinearMap& apply, const LinearMap& apply_transposed);

struct ConditionNumbers {
    double one = 0;   ///< |A|_1 |A^-1|_1
    double two = 0;   ///< |A|_2 |A^-1|_2
};
/// Of a matrix that somebody else solves with. `goes_on` is asked before each product; once it says false the
/// numbers are 0, which says that they are not known.
ConditionNumbers condition_numbers(const SparseMatrix& A, const LinearMap& solve,
                                   const LinearMap& solve_transposed,
                                   const std::function<bool()>& goes_on = {});

/// Of the matrix A = R^-1 S C^-1 whose scaled form S = R A C was factorised: R and C are diagonal, given by
/// `row_scale` and `column_scale`; empty: ones.
ConditionNumbers condition_numbers(const SparseMatrix& scaled, const SparseLU& lu,
                                   std::span<const double> row_scale = {},
                                   std::span<const double> column_scale = {},
                                   const std::function<bool()>& goes_on = {});

}   // namespace gnu::visibility("default")]]livens
