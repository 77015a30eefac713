// SPDX-License-Identifier: BSD-3-Clause
// Loads that are spread over a body or its surface.   (P20)
#pragma once

#include "livens/geometry/moments.h"
#include "livens/multibody/loads.h"

namespace [[gnu::visibility("default")]] livens {

/// A traction t + T theta (Pa) that is linear in body coordinates theta, in world axes or turning with the
/// body: the integrals of (P20) leave F = [t T] int (1, theta) (1, theta)^T dA. Its cost does not depend on
/// the mesh.
///
/// `gradient`: the rows of T, Pa/m; empty: none
Load traction(const std::string& name, int body, const SurfaceMoments& surface, const TimeVector& value,
              Frame frame, const std::vector<TimeVector>& gradient = {});
/// The same force per unit mass everywhere (m/s^2): w is the first column of the body's mass matrix.
Load body_force(const std::string& name, int body, const Matrix4& mass_matrix, const TimeVector& value,
                Frame frame);

/// Pressure p + g . x (Pa), positive against the surface, which it follows, and linear in the place x in the
/// world: F = -D int (q . (1, theta)) n (1, theta)^T dA with the directors D and q = (p, 0) + X^T g. The same
/// p on a closed surface leaves -p volume [0 d1 d2 d3]: no force, and no moment sum d_i x F_i; g leaves
/// -g volume at the centroid, as of a body that is all under water.
///
/// `gradient`: g, world axes, Pa/m
Load pressure(const std::string& name, int body, const SurfaceMoments& surface, const TimeFunction& value,
              const TimeVector& gradient = {0.0, 0.0, 0.0});

}   // namespace livens
