// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/nodal/carried.h"

namespace livens::inline spacetime_internal {

namespace {

/// K^-T column by column: the cross products of the columns of K over its determinant.
Matrix3 inverse_transposed(const double* map)
{
    const Vector3 a{map[0], map[1], map[2]}, b{map[3], map[4], map[5]}, c{map[6], map[7], map[8]};
    const Vector3 bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
    const double s = 1 / dot(a, bc);
    return {s * bc[0], s * bc[1], s * bc[2], s * ca[0], s * ca[1],
            s * ca[2], s * ab[0], s * ab[1], s * ab[2]};
}

/// From the reference point to the centre of mass at `from`, less that at `to`.
Vector3 arm_between(const double* from, const double* to)
{
    return {from[9] - to[9], from[10] - to[10], from[11] - to[11]};
}

}   // namespace

/// A scaled row is the force times the inverse root of mass and K^T times the moment about the centre. The
/// moment about the reference point is what stays, so that the one about the centre changes with the arm.
void carry_rows(const Scaling& from, const Scaling& to, double* y)
{
    for (int b = 0; b < from.bodies.n_bodies(); ++b) {
        const BodyTable& body = from.bodies[b];
        const double root = to.bodies[b].inverse_root_mass;
        double* row = y + body.first;
        const Vector3 force = (1 / body.inverse_root_mass) * Vector3{row[0], row[1], row[2]};
        if (root != body.inverse_root_mass)
            for (int i = 0; i < 3; ++i) row[i] = root * force[i];
        if (body.dofs == 3) continue;
        const double *before = from.maps + 12 * b, *now = to.maps + 12 * b;
        const Vector3 moment = inverse_transposed(before) * Vector3{row[3], row[4], row[5]} +
                               cross(arm_between(before, now), force);
        for (int i = 0; i < 3; ++i)
            row[3 + i] = now[3 * i] * moment[0] + now[3 * i + 1] * moment[1] + now[3 * i + 2] * moment[2];
    }
}

/// A scaled twist is the velocity of the centre times the root of mass and K^-1 times the spin: here the
/// velocity of the reference point stays.
void carry_twists(const Scaling& from, const Scaling& to, double* y)
{
    for (int b = 0; b < from.bodies.n_bodies(); ++b) {
        const BodyTable& body = from.bodies[b];
        const double root = to.bodies[b].inverse_root_mass;
        double* twist = y + body.first;
        if (root != body.inverse_root_mass)
            for (int i = 0; i < 3; ++i) twist[i] *= body.inverse_root_mass / root;
        if (body.dofs == 3) continue;
        const double *before = from.maps + 12 * b, *now = to.maps + 12 * b;
        Vector3 spin;
        for (int i = 0; i < 3; ++i)
            spin[i] = before[i] * twist[3] + before[3 + i] * twist[4] + before[6 + i] * twist[5];
        const Vector3 shift = (1 / root) * cross(arm_between(before, now), spin);
        const Vector3 scaled = transpose(inverse_transposed(now)) * spin;
        for (int i = 0; i < 3; ++i) {
            twist[i] += shift[i];
            twist[3 + i] = scaled[i];
        }
    }
}

}   // namespace livens::inline spacetime_internal
