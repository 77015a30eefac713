// SPDX-License-Identifier: BSD-3-Clause
// Loads that are spread over a body or its surface.   (P20)
#pragma once

#include "livens/geometry/moments.h"
#include "livens/multibody/loads.h"

namespace [[gnu::visibility("default")]] livens {

/// A field of force that is the same vector everywhere, in world axes or turning with the body: the integrals
/// of (P20) leave F = t w^T of it, with w = int (1, theta) over the surface (t in Pa) or weighted by the
/// density (t in m/s^2). Its cost does not depend on the mesh.
Load traction(const std::string& name, int body, const SurfaceMoments& surface, const TimeVector& value,
              Frame frame);
/// Force per unit mass (m/s^2): w is the first column of the body's mass matrix.
Load body_force(const std::string& name, int body, const Matrix4& mass_matrix, const TimeVector& value,
                Frame frame);

/// Pressure (Pa), positive against the surface, which it follows: F = -p D int n (1, theta)^T dA with D the
/// directors. On a closed surface that is -p volume [0 d1 d2 d3]: no force, and no moment sum d_i x F_i.
Load pressure(const std::string& name, int body, const SurfaceMoments& surface, const TimeFunction& value);

}   // namespace livens
