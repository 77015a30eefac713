// SPDX-License-Identifier: BSD-3-Clause
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
        m.area += norm(n) * place;
        m.normal += outer(n, place);
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
    return {a.area + b.area, a.normal + b.normal};
}

std::vector<NamedSurface> surface_moments(const Mesh& mesh)
{
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
    const double area = length * length;
    SurfaceMoments s{area * m.area, area * m.normal};
    for (int a = 1; a < 4; ++a) {
        s.area[a] *= length;
        s.normal.set_column(a, length * s.normal.column(a));
    }
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
    return {T * m.area, R * m.normal * transpose(T)};
}

}   // namespace livens
