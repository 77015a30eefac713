// SPDX-License-Identifier: BSD-3-Clause
// Integrals over solids that a few lengths state exactly: boxes, and what a profile sweeps as it turns.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "livens/geometry/moments.h"

namespace [[gnu::visibility("default")]] livens {

/// Turned about the third axis, then stretched along all axes; about its own origin. Lengths in m.
struct PrimitiveSolid {
    /// Of the profile, the inside on its left.
    struct Piece {
        std::array<double, 2> from{}, to{};   ///< radius, height
        bool is_arc = false;   ///< a quarter of a circle about a point of the axis, from or to that axis
    };
    std::vector<Piece> profile;   ///< none: a cube with edges of length 1 about the origin
    double bore = 0;              ///< radius that is left out all along the axis
    Vector3 stretch{1, 1, 1};
};
PrimitiveSolid box_solid(const Vector3& edges);
PrimitiveSolid ellipsoid_solid(const Vector3& semi_axes);
PrimitiveSolid cylinder_solid(double radius, double length, double inner_radius);
PrimitiveSolid capsule_solid(double radius, double length);   ///< length of the cylindrical part
PrimitiveSolid cone_solid(double radius, double height);      ///< centroid at the origin, apex up

/// As weighted_moments() of a mesh: by quadrature in coordinates that fit the solid (in those of a round one,
/// turning included, polynomials are analytic), refined and divided until it says the same twice, to 1e-13 of
/// the mass. What is narrower than the distance of points, about a fortieth of the solid, may be overlooked.
///
/// throws   InputError (`density-field`) where the density is negative or no number, leaves no mass, or where
///          more than 1e-9 of it is not known
Moments weighted_moments(const PrimitiveSolid& solid, const std::function<double(const Vector3&)>& density);

/// Of all of its surface. `whole`: volume and centroid of the solid; of a closed surface
/// int n_i (1, x) (1, x)^T dA is int d/dx_i (1, x) (1, x)^T dV.
///
/// Areas to 1e-12, by quadrature likewise.
SurfaceMoments surface_moments(const PrimitiveSolid& solid, const Moments& whole);

}   // namespace livens
