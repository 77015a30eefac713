#include "livens/spacetime/lobatto/elimination.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace livens {

Elimination::Elimination(const Tables& tables, int degree)
    : tables_(tables), degree_(degree), f_(tables.freedoms())
{
    const auto n = static_cast<std::size_t>(tables.n_twists);
    product_.assign(n * static_cast<std::size_t>(f_), 0.0);
    work_.assign(n, 0.0);
    if (degree == 1) {
        inverse_.assign(9 * tables.bodies.size(), 0.0);
        range_.assign(n * static_cast<std::size_t>(tables.rank), 0.0);
        schur_.resize(tables.rank);
    }
    lu_.resize(degree * f_);
    z_.assign(static_cast<std::size_t>(degree + 1) * n * static_cast<std::size_t>(f_), 0.0);
}

void Elimination::begin(const std::vector<const OrthogonalBasis*>& bases)
{
    bases_ = bases;
    by_bodies_ = takes_constraints();
    if (!by_bodies_) form_null_spaces();
}

void Elimination::form_null_spaces()
{
    const auto size = static_cast<std::size_t>(tables_.n_twists * f_);
    for (int A = 0; A <= degree_; ++A) bases_[A]->null_space(z_.data() + static_cast<std::size_t>(A) * size);
}

/// Rows of the null space at node A that belong to a body.
const double* Elimination::null_space(int A, int body) const
{
    return z_.data() + (static_cast<std::size_t>(A) * static_cast<std::size_t>(tables_.n_twists) +
                        static_cast<std::size_t>(tables_.bodies[body].first)) *
                           static_cast<std::size_t>(f_);
}

void Elimination::open(int A, int B)
{
    A_ = A;
    B_ = B;
    if (by_bodies_) return;
    std::fill(product_.begin(), product_.end(), 0.0);
}

void Elimination::add_mass(int body, double factor, const double* H)
{
    if (by_bodies_) {
        factor_ = factor;
        if (tables_.bodies[body].dofs == 3) return;
        Matrix3 h{};
        std::copy(H, H + 9, h.a);
        const Matrix3 inverted = inverse(h);
        std::copy(inverted.a, inverted.a + 9, inverse_.begin() + 9 * body);
        return;
    }
    const double* __restrict z = null_space(B_, body);
    const int first = tables_.bodies[body].first, f = f_;
    double* __restrict v = product_.data() + first * f;
    for (int j = 0; j < 3 * f; ++j) v[j] += factor * z[j];
    if (tables_.bodies[body].dofs == 3) return;
    const double* __restrict z0 = z + 3 * f;
    const double* __restrict z1 = z + 4 * f;
    const double* __restrict z2 = z + 5 * f;
    for (int i = 0; i < 3; ++i) {
        const double a = factor * H[i], b = factor * H[i + 3], c = factor * H[i + 6];
        double* __restrict w = v + (3 + i) * f;
        for (int j = 0; j < f; ++j) w[j] += a * z0[j] + b * z1[j] + c * z2[j];
    }
}

void Elimination::add(int body_i, int body_j, const double* block)
{
    assert(!by_bodies_ && "nothing but mass comes to elements that are inverted body by body");
    const double* z = null_space(B_, body_j);
    for (int i = 0; i < tables_.bodies[body_i].dofs; ++i) {
        double* __restrict v = product_.data() + (tables_.bodies[body_i].first + i) * f_;
        for (int k = 0; k < tables_.bodies[body_j].dofs; ++k) {
            const double s = block[6 * i + k];
            if (s == 0) continue;
            const double* __restrict row = z + k * f_;
            for (int j = 0; j < f_; ++j) v[j] += s * row[j];
        }
    }
}

/// Rows r and r + 1 of Z_A^T product, three terms at a time.
void Elimination::multiply_pair(int A, int B, int r)
{
    const int f = f_, n = tables_.n_twists;
    const double* z = z_.data() + static_cast<std::size_t>(A) * static_cast<std::size_t>(n * f) + r;
    double* __restrict u = lu_.row(A * f + r) + (B - 1) * f;
    double* __restrict w = lu_.row(A * f + r + 1) + (B - 1) * f;
    std::fill(u, u + f, 0.0);
    std::fill(w, w + f, 0.0);
    int i = 0;
    for (; i + 2 < n; i += 3) {
        const double* __restrict v0 = product_.data() + i * f;
        const double* __restrict v1 = v0 + f;
        const double* __restrict v2 = v1 + f;
        const double *a = z + i * f, *b = a + f, *c = b + f;
        const double a0 = a[0], b0 = b[0], c0 = c[0], a1 = a[1], b1 = b[1], c1 = c[1];
        for (int j = 0; j < f; ++j) {
            u[j] += a0 * v0[j] + b0 * v1[j] + c0 * v2[j];
            w[j] += a1 * v0[j] + b1 * v1[j] + c1 * v2[j];
        }
    }
}

void Elimination::close()
{
    if (!by_bodies_) reduce(A_, B_);
}

/// The block of the matrix at (A, B) <- Z_A^T product.
void Elimination::reduce(int A, int B)
{
    // n is a multiple of three: six unknowns a body, three a point mass
    const int f = f_, n = tables_.n_twists;
    int r = 0;
    for (; r + 1 < f; r += 2) multiply_pair(A, B, r);
    if (r == f) return;
    double* __restrict u = lu_.row(A * f + r) + (B - 1) * f;
    std::fill(u, u + f, 0.0);
    for (int i = 0; i < n; ++i) {
        const double s = null_space(A, 0)[i * f + r];
        const double* __restrict v = product_.data() + i * f;
        for (int j = 0; j < f; ++j) u[j] += s * v[j];
    }
}

bool Elimination::factorise() { return by_bodies_ ? factorise_bodies() : lu_.factorise(); }

void Elimination::solve(double* x, const double* range)
{
    if (by_bodies_)
        solve_bodies(x, range);
    else
        lu_.solve(x);
}

/// y <- J^-1 y, body by body.
void Elimination::invert_bodies(double* y) const
{
    const double s = 1 / factor_;
    for (const auto& body : tables_.bodies) {
        double* v = y + body.first;
        for (int i = 0; i < 3; ++i) v[i] *= s;
        if (body.dofs == 3) continue;
        const double* h = inverse_.data() + 9 * (&body - tables_.bodies.data());
        const double a = s * v[3], b = s * v[4], c = s * v[5];
        for (int i = 0; i < 3; ++i) v[3 + i] = h[i] * a + h[3 + i] * b + h[6 + i] * c;
    }
}

/// J y + Y_0 nu = x, Y_1^T y = 0: the Schur complement Y_1^T J^-1 Y_0.
bool Elimination::factorise_bodies()
{
    const int k = tables_.rank, n = tables_.n_twists;
    for (int c = 0; c < k; ++c) {
        double* column = range_.data() + c * n;
        std::fill(column, column + n, 0.0);
        column[c] = 1;
        bases_[0]->apply(column);
        invert_bodies(column);
        bases_[1]->apply_transposed(column);
        for (int r = 0; r < k; ++r) schur_.row(r)[c] = column[r];
    }
    return factor_ != 0 && schur_.factorise();
}

void Elimination::solve_bodies(double* x, const double* range)
{
    const int k = tables_.rank, n = tables_.n_twists;
    double* y = work_.data();
    std::fill(y, y + k, 0.0);
    std::copy(x, x + f_, y + k);
    bases_[0]->apply(y);
    invert_bodies(y);
    bases_[1]->apply_transposed(y);
    std::copy(y + k, y + n, x);
    for (int c = 0; range != nullptr && c < k; ++c) y[c] -= range[c];
    schur_.solve(y);
    for (int c = 0; c < k; ++c)
        for (int i = k; i < n; ++i) x[i - k] -= y[c] * range_[static_cast<std::size_t>(c * n + i)];
}

}   // namespace livens
