// The reduction of a body's twelve numbers to a twist: rows, columns, update, and the terms of the tangent.
//
// A body's columns are [phi d1 d2 d3]; a twist is [dphi, w] with d_a moving by w x d_a. The rows
// [r_phi ; sum_a d_a x r_a] lose the six rigidity multipliers identically, because sum_a d_a x lambda_ab d_b
// = 0 for a symmetric lambda. Increments are measured from the element's start (docs/theory.md,
// "Increments").
#pragma once

namespace livens::twist {

/// Increment of one body from the element's start: displacement and quaternion (s, v) of the turn, world
/// axes.
struct Increment {
    double u[3] = {0, 0, 0};
    double s = 1;
    double v[3] = {0, 0, 0};
};

/// dX = [u, (R - 1) d_a] with (R - 1) d = 2 v x (v x d + s d), exact to rounding of the increment itself.
void displacement(const Increment& increment, const double* X0, double* dX);

/// increment <- the twist [dphi, w] after increment: u += dphi, R <- exp(w) R.
void update(Increment& increment, const double* twist);

/// The increment of the screw u = linear, R = exp(angular).
Increment from_vectors(const double* linear, const double* angular);

/// Rows: out = [r_0 ; sum_a d_a x r_a]. X and r are 3 x 4, column by column.
inline void rows(const double* X, const double* r, double* out)
{
    double m[3] = {0, 0, 0};
    for (int a = 3; a < 12; a += 3) {
        m[0] += X[a + 1] * r[a + 2] - X[a + 2] * r[a + 1];
        m[1] += X[a + 2] * r[a] - X[a] * r[a + 2];
        m[2] += X[a] * r[a + 1] - X[a + 1] * r[a];
    }
    for (int i = 0; i < 3; ++i) {
        out[i] = r[i];
        out[3 + i] = m[i];
    }
}

/// Columns: [dphi, w x d_a] as 3 x 4.
inline void columns(const double* X, const double* twist, double* dX)
{
    const double* w = twist + 3;
    for (int i = 0; i < 3; ++i) dX[i] = twist[i];
    for (int a = 3; a < 12; a += 3) {
        dX[a] = w[1] * X[a + 2] - w[2] * X[a + 1];
        dX[a + 1] = w[2] * X[a] - w[0] * X[a + 2];
        dX[a + 2] = w[0] * X[a + 1] - w[1] * X[a];
    }
}

/// out += factor * sum_ab c_ab N_a(X_row)^T N_b(X_column), the 6 x 6 block of a bilinear form c (4 x 4, c_ab
/// at c[a + 4 b]) between two configurations; `out` has the given row stride.
void add_block(const double* c, const double* X_row, const double* X_column, double factor, double* out,
               int stride);

/// The geometric term out += sum_a d_a r_a^T - (r_a . d_a) 1 in the lower right 3 x 3 part, r the total
/// residual.
void add_geometric(const double* X, const double* r, double* out, int stride);

}   // namespace livens::twist
