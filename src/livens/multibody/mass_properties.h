// SPDX-License-Identifier: BSD-3-Clause
// Mass, centre and inertia of a rigid body, and the 4 x 4 mass matrix made of them.
#pragma once

#include <string>

#include "livens/base/linear.h"

namespace [[gnu::visibility("default")]] livens {

/// Mass properties in body-fixed axes.
struct MassProperties {
    double mass = 0;            ///< kg
    Vector3 center_of_mass{};   ///< body coordinates of the centre of mass, m
    Matrix3 inertia{};          ///< J about the centre of mass in body axes, kg m^2
};

/// m = [[M, S^T], [S, E]] (P7) with E = (tr J / 2) I - J about the centre (P, Remark 2.1), moved to the
/// reference point.
Matrix4 mass_matrix(const MassProperties& properties);

/// The inverse of mass_matrix; undefined for mass 0.
MassProperties mass_properties(const Matrix4& mass_matrix);

/// Whether m cannot be inverted in director space, as for needles and laminae, which are legal bodies: the
/// smallest eigenvalue of m, scaled to ones on its diagonal, is not above 1e-12, or a diagonal entry of E is
/// not above 1e-14 tr E. Point masses (M alone): whether M is not positive.
bool is_singular(const Matrix4& mass_matrix, bool is_point);
/// m^-1, symmetric to the bit; for a point mass 1 / M in the first entry and zero elsewhere, so that
/// X' = P m^-1 for both. m must not be singular.
Matrix4 inverse_mass(const Matrix4& mass_matrix, bool is_point);

/// Refuses what no body can have: mass not positive, inertia not symmetric, a negative principal moment,
/// principal moments that break the triangle inequality (all by 1e-12 of the largest, or of M |c|^2, which
/// rounds those that were moved to the centre). `path` names the body in the error.
void check_mass_properties(const MassProperties& properties, const std::string& path);

/// Bodies of constant density, centred at the body's origin; kg/m^3, m. The axis of revolution is d3.
/// Throw InputError for sizes that are not positive (an inner radius may be 0).
MassProperties box(double density, const Vector3& edges);
MassProperties sphere(double density, double radius);
MassProperties cylinder(double density, double radius, double length, double inner_radius = 0);
MassProperties capsule(double density, double radius, double length);   ///< length of the cylindrical part
MassProperties ellipsoid(double density, const Vector3& semi_axes);
MassProperties cone(double density, double radius, double height);   ///< centroid at the origin, apex up d3

/// The same body scaled to another mass, or with its centre elsewhere.
MassProperties with_mass(MassProperties properties, double mass);
MassProperties with_center(MassProperties properties, const Vector3& center_of_mass);

}   // namespace gnu::visibility("default")]]livens
