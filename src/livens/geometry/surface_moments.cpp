// SPDX-License-Identifier: BSD-3-Clause
// Integrals over surfaces for loads (P20): (1, x)(1, x)^T weighted by the area for tractions, by the normal
// for pressures. theory.md, "Bodies from meshes", Loads on surfaces.
#include <algorithm>

#include "livens/geometry/detail/elements.h"
#include "livens/geometry/moments.h"
#include "livens/geometry/soundness.h"

namespace livens {

namespace {

/// Normals are polynomials, and so are their integrals; areas of curved faces are what the rule makes of the
/// root.
SurfaceMoments of_face(const Mesh& mesh, ElementKind kind, const std::int32_t* nodes)
{
    SurfaceMoments m;
    for (const ShapeValues& point : quadrature_of(kind)) {
        const ElementPoint at = element_point(point, mesh, kind, nodes, {});
        const Vector3 n = point.weight * cross(at.F.column(0), at.F.column(1));
        const Vector4 place = livens::point(at.x);
        const Matrix4 of = outer(place, place);
        m.area += norm(n) * of;
        for (int i = 0; i < 3; ++i) m.normal[i] += n[i] * of;
    }
    return m;
}

SurfaceMoments& find(std::vector<NamedSurface>& all, const std::string& name)
{
    const auto found = std::ranges::find(all, name, &NamedSurface::name);
    if (found != all.end()) return found->moments;
    return all.emplace_back(NamedSurface{name, {}}).moments;
}

}   // namespace

SurfaceMoments operator+(const SurfaceMoments& a, const SurfaceMoments& b)
{
    SurfaceMoments sum = a;
    sum.area += b.area;
    for (int i = 0; i < 3; ++i) sum.normal[i] += b.normal[i];
    return sum;
}

std::vector<NamedSurface> surface_moments(const Mesh& mesh)
{
    // Elements of volume state no surface but named faces; the whole boundary is what one element alone has.
    const Mesh boundary = mesh.is_volume() ? boundary_of(mesh) : Mesh{};
    const Mesh& surface = mesh.is_volume() ? boundary : mesh;
    std::vector<SurfaceMoments> of(surface.regions.size());
    std::vector<bool> has_faces(surface.regions.size(), false);
    for (const ElementBlock& b : surface.blocks)
        for (std::int64_t e = 0; dimension(b.kind) == 2 && e < b.size(); ++e) {
            of[b.regions[e]] = of[b.regions[e]] + of_face(surface, b.kind, b.element(e));
            has_faces[b.regions[e]] = true;
        }
    std::vector<NamedSurface> all(1);
    for (std::size_t r = 0; r < of.size(); ++r) {
        if (!has_faces[r]) continue;
        all[0].moments = all[0].moments + of[r];
        for (const std::string& name : surface.regions[r].names) {
            SurfaceMoments& sum = find(all, name);
            sum = sum + of[r];
        }
    }
    return all;
}

SurfaceMoments scaled(const SurfaceMoments& m, double length)
{
    SurfaceMoments s = m;
    for (Matrix4* of : {&s.area, &s.normal[0], &s.normal[1], &s.normal[2]})
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b)
                // An area, times one length for each factor x.
                (*of)(a, b) *= length * length * (a > 0 ? length : 1) * (b > 0 ? length : 1);
    return s;
}

/// With x' = R x + d and n' = R n.
SurfaceMoments moved(const SurfaceMoments& m, const Matrix3& R, const Vector3& d)
{
    Matrix4 T{};   // (1, x') = T (1, x)
    T(0, 0) = 1;
    for (int i = 0; i < 3; ++i) {
        T(i + 1, 0) = d[i];
        for (int j = 0; j < 3; ++j) T(i + 1, j + 1) = R(i, j);
    }
    SurfaceMoments to;
    to.area = T * m.area * transpose(T);
    for (int j = 0; j < 3; ++j) {
        const Matrix4 of = T * m.normal[j] * transpose(T);
        for (int i = 0; i < 3; ++i) to.normal[i] += R(i, j) * of;
    }
    return to;
}

}   // namespace livens
