// SPDX-License-Identifier: BSD-3-Clause
// Eigenvalues and singular values of dense matrices. Work grows with the cube of the size.
//
// Everywhere: a matrix of size 0 has no values; where an entry is not finite, and where iterations do not
// converge, all values and vectors are nan. Memory that ends is std::bad_alloc, and nothing else is thrown.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "livens/base/linear.h"
#include "livens/solvers/dense_matrix.h"

namespace livens::inline solvers_internal {

/// Of symmetric matrices, of which the lower triangle is read.
struct SymmetricSpectrum {
    bool is_found = true;         ///< else all is nan
    std::vector<double> values;   ///< n, ascending
    DenseMatrix vectors;          ///< n x n, in the order of the values
};

/// A v = value v with |v| = 1.
SymmetricSpectrum symmetric_spectrum(DenseView A);
std::vector<double> symmetric_values(DenseView A);

/// K v = value M v with v^T M v = 1. Not found also where M is not positive definite.
SymmetricSpectrum generalised_spectrum(DenseView K, DenseView M);
std::vector<double> generalised_values(DenseView K, DenseView M);

/// Of the tridiagonal matrix with this diagonal (n) and what stands beside it (n - 1).
SymmetricSpectrum tridiagonal_spectrum(std::span<const double> diagonal, std::span<const double> beside);

/// The same of small matrices, whose size is known.
struct PrincipalValues {
    Vector3 values;    ///< ascending
    Matrix3 vectors;   ///< |v| = 1, in columns
};
PrincipalValues symmetric_spectrum(const Matrix3& A);
Vector3 symmetric_values(const Matrix3& A);
Vector4 symmetric_values(const Matrix4& A);

/// Of any square matrix: A v = value v with |v| = 1, pairs of conjugate values next to each other, the one
/// with the positive imaginary part first.
struct GeneralSpectrum {
    std::vector<std::complex<double>> values;                 ///< n
    std::vector<std::vector<std::complex<double>>> vectors;   ///< n of n entries
};
GeneralSpectrum general_spectrum(DenseView A);

/// Singular values, descending; min(rows, cols) of them.
std::vector<double> singular_values(DenseView A);
/// Of a square matrix: the right singular vectors whose values are at most `level`; n x how many,
/// orthonormal. None where an entry is not finite.
DenseMatrix null_directions(DenseView A, double level);
/// U V^T of A = U S V^T: the rotation or reflection next to A.
Matrix3 orthogonal_factor(const Matrix3& A);

}   // namespace livens::inline solvers_internal
