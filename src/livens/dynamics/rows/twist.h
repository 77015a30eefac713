// SPDX-License-Identifier: BSD-3-Clause
// Rigid kinematics: the reduction of a body's twelve numbers to a twist. Rows, columns, finite displacements,
// and the terms of the tangent.
//
// A body's columns are [phi d1 d2 d3]; a twist is [dphi, w] with d_a moving by w x d_a. The rows
// [r_phi ; sum_a d_a x r_a] lose the six rigidity multipliers identically, because sum_a d_a x lambda_ab d_b
// = 0 for a symmetric lambda (docs/theory.md, "On the rotation group").
#pragma once

#include "livens/base/linear.h"

namespace livens::twist {

/// dX = [dphi, (exp(w) - 1) d_a] of the finite twist [dphi, w], exact to rounding of the displacement itself.
void displacement(const double* twist, const double* X, double* dX);

/// The same for a turn by the unit quaternion (s, v) = q.
void displacement(const double* dphi, const double* q, const double* X, double* dX);

/// The unit quaternion (s, v) of the turn from X to X + dX, whose directors are orthonormal; less than half a
/// turn.
void quaternion_of(const double* X, const double* dX, double* q);

/// The rotation vector of the turn between two triads, at most pi long.
Vector3 turn_between(const Matrix34& from, const Matrix34& to);

/// X moved by a step and turned by a rotation vector, both in world axes.
Matrix34 moved(const Matrix34& X, const Vector3& step, const Vector3& turn);

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
