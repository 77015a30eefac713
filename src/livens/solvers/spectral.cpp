// SPDX-License-Identifier: BSD-3-Clause
// Eigenvalues and singular values on plain arrays: vibration modes and frequencies (theory.md, "Highest
// frequencies" and "Small motions"), principal inertias, and the rotation next to a triad. Eigen's solvers
// see finite numbers alone; all else comes out as nan, or as not found.
#include "livens/solvers/spectral.h"

#include <algorithm>
#include <cassert>

#include <Eigen/Dense>

#include "livens/solvers/detail/eigen_views.h"
#include "livens/solvers/factors.h"

namespace livens::inline solvers_internal {

namespace {

using Symmetric = Eigen::SelfAdjointEigenSolver<MatrixXd>;

SymmetricSpectrum not_found(int n, bool with_vectors)
{
    SymmetricSpectrum spectrum{false, std::vector<double>(static_cast<std::size_t>(n), nan), {}};
    if (with_vectors) spectrum.vectors = DenseMatrix(n, n);
    std::ranges::fill(spectrum.vectors.a, nan);
    return spectrum;
}

SymmetricSpectrum result_of(const Symmetric& solver, bool with_vectors)
{
    const VectorXd& values = solver.eigenvalues();
    if (solver.info() != Eigen::Success) return not_found(static_cast<int>(values.size()), with_vectors);
    return {
        true, {values.begin(), values.end()}, with_vectors ? stored(solver.eigenvectors()) : DenseMatrix{}};
}

SymmetricSpectrum symmetric(DenseView A, bool with_vectors)
{
    assert(A.rows == A.cols);
    if (A.rows == 0) return {};
    if (!all_finite(A.entries())) return not_found(A.rows, with_vectors);
    const Symmetric solver(seen(A), with_vectors ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly);
    return result_of(solver, with_vectors);
}

/// With M = L L^T: L^-1 K L^-T w = value w and v = L^-T w.
SymmetricSpectrum generalised(DenseView K, DenseView M, bool with_vectors)
{
    assert(K.rows == K.cols && M.rows == K.rows && M.cols == K.cols);
    if (K.rows == 0) return {};
    const DenseMatrix factor = cholesky(M);
    if (!all_finite(K.entries()) || !all_finite(factor.a)) return not_found(K.rows, with_vectors);
    const auto L = seen(factor).triangularView<Eigen::Lower>();
    const auto U = seen(factor).adjoint().triangularView<Eigen::Upper>();
    MatrixXd C = seen(K).selfadjointView<Eigen::Lower>();
    // The congruence keeps the matrix symmetric, so all values are real although M^-1 K is not symmetric.
    L.solveInPlace<Eigen::OnTheLeft>(C);
    U.solveInPlace<Eigen::OnTheRight>(C);
    const Symmetric solver(C, with_vectors ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly);
    SymmetricSpectrum spectrum = result_of(solver, with_vectors);
    if (with_vectors && spectrum.is_found)
        U.solveInPlace(Eigen::Map<MatrixXd>(spectrum.vectors.a.data(), K.rows, K.rows));
    return spectrum;
}

}   // namespace

SymmetricSpectrum symmetric_spectrum(DenseView A) { return symmetric(A, true); }
std::vector<double> symmetric_values(DenseView A) { return symmetric(A, false).values; }
SymmetricSpectrum generalised_spectrum(DenseView K, DenseView M) { return generalised(K, M, true); }
std::vector<double> generalised_values(DenseView K, DenseView M) { return generalised(K, M, false).values; }

SymmetricSpectrum tridiagonal_spectrum(std::span<const double> diagonal, std::span<const double> beside)
{
    if (diagonal.empty()) return {};
    assert(beside.size() + 1 == diagonal.size());
    if (!all_finite(diagonal) || !all_finite(beside))
        return not_found(static_cast<int>(diagonal.size()), true);
    Symmetric solver;
    // Of a tridiagonal matrix no reduction is needed.
    solver.computeFromTridiagonal(seen(diagonal), seen(beside));
    return result_of(solver, true);
}

// Of small matrices as of all: solvers for a fixed size are seconds of compiling each.
PrincipalValues symmetric_spectrum(const Matrix3& A)
{
    const SymmetricSpectrum spectrum = symmetric({3, 3, A.data()}, true);
    PrincipalValues found{};
    std::ranges::copy(spectrum.values, found.values.data());
    std::ranges::copy(spectrum.vectors.a, found.vectors.data());
    return found;
}

Vector3 symmetric_values(const Matrix3& A)
{
    Vector3 values;
    std::ranges::copy(symmetric({3, 3, A.data()}, false).values, values.data());
    return values;
}

Vector4 symmetric_values(const Matrix4& A)
{
    Vector4 values;
    std::ranges::copy(symmetric({4, 4, A.data()}, false).values, values.data());
    return values;
}

GeneralSpectrum general_spectrum(DenseView A)
{
    assert(A.rows == A.cols);
    const auto n = static_cast<std::size_t>(A.rows);
    GeneralSpectrum spectrum{std::vector<std::complex<double>>(n, {nan, nan}), {}};
    spectrum.vectors.assign(n, spectrum.values);
    if (n == 0 || !all_finite(A.entries())) return spectrum;
    // Damped motions have a general matrix: its values are complex, in conjugate pairs.
    const Eigen::EigenSolver<MatrixXd> solver(seen(A));
    if (solver.info() != Eigen::Success) return spectrum;
    std::copy_n(solver.eigenvalues().data(), n, spectrum.values.begin());
    const Eigen::MatrixXcd vectors = solver.eigenvectors();
    for (std::size_t k = 0; k < n; ++k) std::copy_n(vectors.data() + n * k, n, spectrum.vectors[k].begin());
    return spectrum;
}

std::vector<double> singular_values(DenseView A)
{
    const auto n = static_cast<std::size_t>(std::min(A.rows, A.cols));
    if (n == 0 || !all_finite(A.entries())) return std::vector<double>(n, nan);
    const Eigen::JacobiSVD<MatrixXd> svd(seen(A));
    return {svd.singularValues().begin(), svd.singularValues().end()};
}

DenseMatrix null_directions(DenseView A, double level)
{
    assert(A.rows == A.cols);
    if (A.rows == 0 || !all_finite(A.entries())) return {A.rows, 0};
    // Singular values descend, so that the null directions are the last columns of V.
    const Eigen::JacobiSVD<MatrixXd> svd(seen(A), Eigen::ComputeFullV);
    return stored(svd.matrixV().rightCols((svd.singularValues().array() <= level).count()));
}

Matrix3 orthogonal_factor(const Matrix3& A)
{
    Matrix3 Q = nan * identity<3>();
    if (!all_finite(A.a)) return Q;
    const Eigen::JacobiSVD<MatrixXd> svd(seen({3, 3, A.data()}), Eigen::ComputeFullU | Eigen::ComputeFullV);
    // The polar factor R of A = R U: of all orthogonal matrices it is the nearest to A.
    const MatrixXd polar = svd.matrixU() * svd.matrixV().transpose();
    std::copy_n(polar.data(), 9, Q.data());
    return Q;
}

}   // namespace livens::inline solvers_internal
