// SPDX-License-Identifier: BSD-3-Clause
// The small dense types of every public struct: plain doubles without alignment, so that a library and a
// program built with different processor flags agree on their layout.
#pragma once

#include <cmath>
#include <cstddef>

namespace [[gnu::visibility("default")]] livens {

/// Dense matrix of fixed size, stored column by column; aggregate, so `Vector3{1, 2, 3}` lists a column.
///
/// shape    Rows x Cols; `a` holds columns one after the other (an Eigen::Map over `data()` sees the same
/// matrix)
template <int Rows, int Cols>
struct Matrix {
    double a[static_cast<std::size_t>(Rows * Cols)];

    static constexpr int rows = Rows;
    static constexpr int cols = Cols;

    constexpr double& operator()(int i, int j) { return a[i + Rows * j]; }
    constexpr double operator()(int i, int j) const { return a[i + Rows * j]; }
    constexpr double& operator[](int i) { return a[i]; }
    constexpr double operator[](int i) const { return a[i]; }
    constexpr double* data() { return a; }
    constexpr const double* data() const { return a; }

    [[gnu::always_inline]] constexpr Matrix<Rows, 1> column(int j) const   // three loads
    {
        Matrix<Rows, 1> c{};
        for (int i = 0; i < Rows; ++i) c[i] = (*this)(i, j);
        return c;
    }
    constexpr void set_column(int j, const Matrix<Rows, 1>& c)
    {
        for (int i = 0; i < Rows; ++i) (*this)(i, j) = c[i];
    }
    constexpr Matrix& operator+=(const Matrix& b)
    {
        for (int i = 0; i < Rows * Cols; ++i) a[i] += b.a[i];
        return *this;
    }
    constexpr Matrix& operator-=(const Matrix& b)
    {
        for (int i = 0; i < Rows * Cols; ++i) a[i] -= b.a[i];
        return *this;
    }
    constexpr Matrix& operator*=(double s)
    {
        for (int i = 0; i < Rows * Cols; ++i) a[i] *= s;
        return *this;
    }
    friend constexpr Matrix operator+(Matrix l, const Matrix& r) { return l += r; }
    friend constexpr Matrix operator-(Matrix l, const Matrix& r) { return l -= r; }
    friend constexpr Matrix operator-(Matrix l) { return l *= -1.0; }
    friend constexpr Matrix operator*(double s, Matrix r) { return r *= s; }
    friend constexpr Matrix operator*(Matrix l, double s) { return l *= s; }
    friend constexpr bool operator==(const Matrix&, const Matrix&) = default;
};

using Vector3 = Matrix<3, 1>;
using Vector4 = Matrix<4, 1>;
using Matrix3 = Matrix<3, 3>;
using Matrix4 = Matrix<4, 4>;
using Matrix34 = Matrix<3, 4>;   ///< configuration X = [phi d1 d2 d3], momentum and force of one body

template <int R, int K, int C>
constexpr Matrix<R, C> operator*(const Matrix<R, K>& l, const Matrix<K, C>& r)
{
    Matrix<R, C> p{};
    for (int j = 0; j < C; ++j)
        for (int k = 0; k < K; ++k)
            for (int i = 0; i < R; ++i) p(i, j) += l(i, k) * r(k, j);
    return p;
}

template <int R, int C>
constexpr Matrix<C, R> transpose(const Matrix<R, C>& m)
{
    Matrix<C, R> t{};
    for (int j = 0; j < C; ++j)
        for (int i = 0; i < R; ++i) t(j, i) = m(i, j);
    return t;
}

/// Sum of the products of all entries, tr(l^T r).
template <int R, int C>
constexpr double dot(const Matrix<R, C>& l, const Matrix<R, C>& r)
{
    double s = 0;
    for (int i = 0; i < R * C; ++i) s += l.a[i] * r.a[i];
    return s;
}

template <int R, int C>
inline double norm(const Matrix<R, C>& m)
{
    return std::sqrt(dot(m, m));
}

template <int N>
constexpr Matrix<N, N> identity()
{
    Matrix<N, N> m{};
    for (int i = 0; i < N; ++i) m(i, i) = 1;
    return m;
}

template <int N>
constexpr double trace(const Matrix<N, N>& m)
{
    double s = 0;
    for (int i = 0; i < N; ++i) s += m(i, i);
    return s;
}

constexpr Vector3 cross(const Vector3& l, const Vector3& r)
{
    return {l[1] * r[2] - l[2] * r[1], l[2] * r[0] - l[0] * r[2], l[0] * r[1] - l[1] * r[0]};
}

/// The matrix of `cross(w, .)`.
constexpr Matrix3 cross_matrix(const Vector3& w) { return {0, w[2], -w[1], -w[2], 0, w[0], w[1], -w[0], 0}; }

constexpr double determinant(const Matrix3& m) { return dot(m.column(0), cross(m.column(1), m.column(2))); }

/// Inverse by cofactors; the caller has made sure that the determinant is not zero.
constexpr Matrix3 inverse(const Matrix3& m)
{
    const Vector3 a = m.column(0), b = m.column(1), c = m.column(2);
    const double s = 1 / determinant(m);
    Matrix3 rows{};
    rows.set_column(0, s * cross(b, c));
    rows.set_column(1, s * cross(c, a));
    rows.set_column(2, s * cross(a, b));
    return transpose(rows);
}

/// Outer product l r^T.
template <int R, int C>
constexpr Matrix<R, C> outer(const Matrix<R, 1>& l, const Matrix<C, 1>& r)
{
    return l * transpose(r);
}

/// Body coordinates theta of a material point as the column (1, theta) that X multiplies.
constexpr Vector4 point(const Vector3& theta) { return {1, theta[0], theta[1], theta[2]}; }

/// Body coordinates of a direction as the column (0, a) that X multiplies.
constexpr Vector4 direction(const Vector3& a) { return {0, a[0], a[1], a[2]}; }

/// The directors of X as a 3 x 3 matrix, and X from point and directors.
constexpr Matrix3 directors(const Matrix34& x)
{
    return {x.a[3], x.a[4], x.a[5], x.a[6], x.a[7], x.a[8], x.a[9], x.a[10], x.a[11]};
}
constexpr Matrix34 configuration(const Vector3& phi, const Matrix3& d)
{
    return {phi[0], phi[1], phi[2], d.a[0], d.a[1], d.a[2], d.a[3], d.a[4], d.a[5], d.a[6], d.a[7], d.a[8]};
}

}   // namespace livens
