// SPDX-License-Identifier: BSD-3-Clause
// Shape functions of elements in space and quadrature for them.   (P17)
#pragma once

#include <array>
#include <vector>

#include "livens/geometry/mesh.h"

namespace livens::inline geometry_internal {

/// N_A and its derivatives at a point of the parent element.
struct ShapeValues {
    std::array<double, 10> N{};
    std::array<Vector3, 10> dN{};   ///< by the three coordinates of the parent; the last is 0 of faces
    double weight = 0;              ///< of the quadrature, in the parent
};

/// Where a rule has its points. Parents: the simplex r, s, t >= 0, r + s + t <= 1, or the cube [0, 1]^3, and
/// likewise for faces.
ShapeValues shape_at(ElementKind kind, const Vector3& parent);

/// Points of a rule that integrates second moments exactly: x x^T times the Jacobian of x = sum N_A x_A, for
/// faces x x^T x times the normal.
const std::vector<ShapeValues>& quadrature_of(ElementKind kind);

/// Likewise with n points in each direction.
std::vector<ShapeValues> rule_of(ElementKind kind, int n);

/// Where signs of Jacobians are looked at: points of the rule and all corners.
const std::vector<ShapeValues>& probes_of(ElementKind kind);

/// x, and its derivatives by the coordinates of the parent as columns.
struct ElementPoint {
    Vector3 x{};
    Matrix3 F{};
};
ElementPoint element_point(const ShapeValues& shape, const Mesh& mesh, ElementKind kind,
                           const std::int32_t* nodes, const Vector3& about);

}   // namespace livens::inline geometry_internal
