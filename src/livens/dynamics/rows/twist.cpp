// SPDX-License-Identifier: BSD-3-Clause
// Rigid kinematics: turns by unit quaternions without cancellation, blocks N^T (c x 1) N of the tangent and
// the geometric term. theory.md, "On the rotation group", "The tangent" and "Increments".
#include "livens/dynamics/rows/twist.h"

#include <algorithm>
#include <cmath>

#include "livens/base/elementary.h"
#include "livens/multibody/body.h"

namespace livens::twist {

void displacement(const double* dphi, const double* q, const double* X, double* dX)
{
    const double s = q[0], x = q[1], y = q[2], z = q[3];
    // R - 1 = 2 (v v^T - |v|^2 1 + s [v]), its diagonal without cancellation
    const double t[9] = {-2 * (y * y + z * z), 2 * (x * y + s * z),  2 * (x * z - s * y),
                         2 * (x * y - s * z),  -2 * (x * x + z * z), 2 * (y * z + s * x),
                         2 * (x * z + s * y),  2 * (y * z - s * x),  -2 * (x * x + y * y)};
    for (int i = 0; i < 3; ++i) dX[i] = dphi[i];
    for (int a = 3; a < 12; a += 3)
        for (int i = 0; i < 3; ++i) dX[a + i] = t[i] * X[a] + t[3 + i] * X[a + 1] + t[6 + i] * X[a + 2];
}

void displacement(const double* twist, const double* X, double* dX)
{
    const double* w = twist + 3;
    const double angle2 = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    double factor, q[4];
    if (angle2 < 1e-4) {
        // sin(a/2)/a and cos(a/2) to below 1e-18
        factor = 0.5 - angle2 * (1.0 / 48 - angle2 * (1.0 / 3840 - angle2 / 645120));
        q[0] = 1 - angle2 * (1.0 / 8 - angle2 * (1.0 / 384 - angle2 / 46080));
    } else {
        const double angle = std::sqrt(angle2);
        const SineCosine half = sine_cosine(0.5 * angle);
        factor = half.sine / angle;
        q[0] = half.cosine;
    }
    for (int i = 0; i < 3; ++i) q[i + 1] = factor * w[i];
    displacement(twist, q, X, dX);
}

void quaternion_of(const double* X, const double* dX, double* q)
{
    double m[9] = {};   // R - 1 = sum_a dd_a d_a^T, column by column
    for (int a = 3; a < 12; a += 3)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) m[3 * j + i] += dX[a + i] * X[a + j];
    // tr(R - 1) = -4 |v|^2, so s = sqrt(1 + tr / 4): formed from the increment, small turns keep all digits.
    q[0] = std::sqrt(std::max(0.0, 1 + 0.25 * (m[0] + m[4] + m[8])));
    const double scale = 0.25 / q[0];
    q[1] = scale * (m[5] - m[7]);
    q[2] = scale * (m[6] - m[2]);
    q[3] = scale * (m[1] - m[3]);
}

Vector3 turn_between(const Matrix34& from, const Matrix34& to)
{
    // Products of directors are rotations up to rounding; the projection makes the quaternion a unit one.
    const Matrix3 R = directors(to) * transpose(directors(from));
    const Vector4 q = quaternion_from_directors(project_directors(R));
    const Vector3 v{q[1], q[2], q[3]};
    const double s = norm(v);
    return s > 0 ? (2 * arc_tangent(s, q[0]) / s) * v : Vector3{};
}

Matrix34 moved(const Matrix34& X, const Vector3& step, const Vector3& turn)
{
    return configuration(X.column(0) + step, directors_from_rotation_vector(turn) * directors(X));
}

/// The 2 x 2 blocks of theory.md, "The tangent": moments s beside the diagonal, c_00 for the place.
void add_block(const double* c, const double* X_row, const double* X_column, double factor, double* out,
               int stride)
{
    // N_0 = [1 0], N_a = [0 -[d_a]]: first moments s_a = sum_b c_0b d_b and s_b = sum_a c_a0 d_a, and the
    // middle part sum_ab c_ab ((d_a . d_b) 1 - d_b d_a^T)
    double s_column[3] = {0, 0, 0}, s_row[3] = {0, 0, 0};
    double w[9];    // sum_ab c_ab d_b d_a^T, row by row
    double cd[9];   // column b of [sum_a c_ab d_a]
    for (int b = 0; b < 3; ++b) {
        const double* cb = c + 4 * (b + 1);
        for (int i = 0; i < 3; ++i) {
            cd[3 * b + i] = cb[1] * X_row[3 + i] + cb[2] * X_row[6 + i] + cb[3] * X_row[9 + i];
            s_column[i] += cb[0] * X_column[3 + 3 * b + i];
            s_row[i] += c[b + 1] * X_row[3 + 3 * b + i];
        }
    }
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            w[3 * i + j] =
                X_column[3 + i] * cd[j] + X_column[6 + i] * cd[3 + j] + X_column[9 + i] * cd[6 + j];
    const double tr = w[0] + w[4] + w[8];
    for (int i = 0; i < 3; ++i) {
        double* lower = out + (3 + i) * stride + 3;
        out[i * stride + i] += factor * c[0];
        for (int j = 0; j < 3; ++j) lower[j] -= factor * w[3 * i + j];
        lower[i] += factor * tr;
    }
    const double a0 = factor * s_column[0], a1 = factor * s_column[1], a2 = factor * s_column[2];
    out[4] += a2;
    out[5] -= a1;
    out[stride + 3] -= a2;
    out[stride + 5] += a0;
    out[2 * stride + 3] += a1;
    out[2 * stride + 4] -= a0;
    const double b0 = factor * s_row[0], b1 = factor * s_row[1], b2 = factor * s_row[2];
    out[3 * stride + 1] -= b2;
    out[3 * stride + 2] += b1;
    out[4 * stride] += b2;
    out[4 * stride + 2] -= b0;
    out[5 * stride] -= b1;
    out[5 * stride + 1] += b0;
}

/// The derivative of sum d_a x r_a by a turn w of the directors:
/// (w x d_a) x r_a = d_a (r_a . w) - (r_a . d_a) w.
void add_geometric(const double* X, const double* r, double* out, int stride)
{
    double tr = 0;
    for (int a = 3; a < 12; ++a) tr += X[a] * r[a];
    for (int i = 0; i < 3; ++i) {
        double* lower = out + (3 + i) * stride + 3;
        for (int j = 0; j < 3; ++j)
            lower[j] += X[3 + i] * r[3 + j] + X[6 + i] * r[6 + j] + X[9 + i] * r[9 + j];
        lower[i] -= tr;
    }
}

}   // namespace livens::twist
