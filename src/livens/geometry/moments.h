// SPDX-License-Identifier: BSD-3-Clause
// Integrals over solids that are given as meshes.   (P16)-(P19)
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "livens/geometry/mesh.h"

namespace [[gnu::visibility("default")]] livens {

/// Integrals of 1, x and (x - c)(x - c)^T over a solid, c its centroid: what (P19) leaves of a mesh where the
/// density is constant. With it M = rho volume, and about a reference point r S = M (c - r),
/// E = rho second + M (c - r)(c - r)^T.
struct Moments {
    double volume = 0;    ///< m^3
    Vector3 centroid{};   ///< m
    Matrix3 second{};     ///< about the centroid, m^5
};

/// Of a sound mesh, in its own unit. Volumes by shape functions and quadrature that is exact for elements
/// with curved edges, too (P19); surfaces by the divergence theorem. All about the middle of the bounding
/// box, with compensated sums, so that neither the place of a part nor the number of its elements costs
/// digits.
Moments moments(const Mesh& mesh);

/// Of a volume, region by region; zero for those that are none of volume.
std::vector<Moments> region_moments(const Mesh& mesh);

/// With each weighted by a number, such as densities: then `volume` is the mass. The sum of weights times
/// volumes must not be zero.
Moments combined(std::span<const Moments> parts, std::span<const double> weights);

/// With a density that changes from place to place: then `volume` is the mass, `centroid` its centre, and
/// `second` its second moment about that. Of a volume, by quadrature that is refined element by element until
/// it says the same twice, to 1e-13 of the mass: so polynomials are integrated exactly.
///
/// throws   InputError (`density-field`) where the density is negative or no number, or changes so fast
///          within elements that more than 1e-9 of the mass is not known
Moments weighted_moments(const Mesh& volume, const std::function<double(const Vector3&)>& density);

/// Linear in the mesh's coordinates.
struct LinearDensity {
    double at_origin = 0;
    Vector3 gradient{};
};
/// Likewise, also of a closed surface, whose inside is not seen: exactly, by the divergence theorem.
Moments weighted_moments(const Mesh& mesh, const LinearDensity& density);

/// Integrals of (1, x) (1, x)^T over faces: the moments of the shape functions that loads on a surface need,
/// whose fields are linear at most (P20).
struct SurfaceMoments {
    Matrix4 area{};                    ///< m^2, m^3, m^4
    std::array<Matrix4, 3> normal{};   ///< weighted by each component of the outward normal
};
SurfaceMoments operator+(const SurfaceMoments& a, const SurfaceMoments& b);

/// Of the boundary of a sound mesh, by the names of its regions; the first is all of it and has no name.
struct NamedSurface {
    std::string name;
    SurfaceMoments moments;
};
std::vector<NamedSurface> surface_moments(const Mesh& mesh);

/// After a change of the unit of length: one of the mesh's is so many m.
Moments scaled(const Moments& m, double length);
SurfaceMoments scaled(const SurfaceMoments& m, double length);
/// After a rotation about the origin, then a displacement.
Moments moved(const Moments& m, const Matrix3& rotation, const Vector3& displacement);
SurfaceMoments moved(const SurfaceMoments& m, const Matrix3& rotation, const Vector3& displacement);

}   // namespace livens
