// SPDX-License-Identifier: BSD-3-Clause
// Shape functions of elements in space and their quadrature (P17): x = sum N_A x_A over the parent element.
// Numbers of points are those that integrate (1, x, x x^T) exactly, as theory.md, "Bodies from meshes",
// derives.
#include "livens/geometry/detail/elements.h"

#include "livens/time/quadrature.h"

namespace livens::inline geometry_internal {

namespace {

bool is_simplex(ElementKind kind)
{
    return kind != ElementKind::quadrilateral && kind != ElementKind::hexahedron;
}

constexpr int edges_of_triangle6[][2] = {{0, 1}, {1, 2}, {2, 0}};
constexpr int edges_of_tetrahedron10[][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}};

/// Corners of the parent; of cubes in Gmsh's order, counterclockwise below and above.
constexpr double corners_of_cube[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                          {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
constexpr double corners_of_simplex[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

void fill_cube(ShapeValues& v, int n, int dim, const Vector3& p)
{
    for (int A = 0; A < n; ++A) {
        double factor[3] = {1, 1, 1}, slope[3] = {0, 0, 0};
        for (int i = 0; i < dim; ++i) {
            const bool is_far = corners_of_cube[A][i] > 0;
            factor[i] = is_far ? p[i] : 1 - p[i];
            slope[i] = is_far ? 1 : -1;
        }
        v.N[A] = factor[0] * factor[1] * factor[2];
        v.dN[A] = {slope[0] * factor[1] * factor[2], factor[0] * slope[1] * factor[2],
                   factor[0] * factor[1] * slope[2]};
    }
}

/// Linear: the barycentric coordinates. Quadratic: L (2 L - 1) at corners, 4 L L' between.
void fill_simplex(ShapeValues& v, ElementKind kind, const Vector3& p)
{
    const int n = dimension(kind) + 1;
    double L[4] = {1, 0, 0, 0};
    Vector3 dL[4] = {};
    for (int i = 0; i < n - 1; ++i) {
        L[0] -= p[i];
        L[i + 1] = p[i];
        dL[0][i] = -1;
        dL[i + 1][i] = 1;
    }
    const bool is_linear = n_nodes(kind) == n;
    for (int A = 0; A < n; ++A) {
        v.N[A] = is_linear ? L[A] : L[A] * (2 * L[A] - 1);
        v.dN[A] = is_linear ? dL[A] : (4 * L[A] - 1) * dL[A];
    }
    if (is_linear) return;
    for (int k = 0; n + k < n_nodes(kind); ++k) {
        const auto& [a, b] = n == 3 ? edges_of_triangle6[k] : edges_of_tetrahedron10[k];
        v.N[n + k] = 4 * L[a] * L[b];
        v.dN[n + k] = 4 * L[a] * dL[b] + 4 * L[b] * dL[a];
    }
}

/// Points in each direction.
int n_points_of(ElementKind kind)
{
    // Degrees of x x^T det F: 2 (tetrahedron), 4 in each coordinate (hexahedron), 7 (curved tetrahedron); of
    // x x^T (x . n): 3, 4 in each (quadrilateral: 3 + 1), 8 (curved triangle).
    constexpr int n_points[] = {3, 3, 5, 3, 3, 5};
    return n_points[static_cast<int>(kind)];
}

template <class Make>
const std::vector<ShapeValues>& of_kind(ElementKind kind, Make make)
{
    static const std::array<std::vector<ShapeValues>, 6> all = [&] {
        std::array<std::vector<ShapeValues>, 6> rules;
        for (int k = 0; k < 6; ++k) rules[k] = make(static_cast<ElementKind>(k));
        return rules;
    }();
    return all[static_cast<int>(kind)];
}

}   // namespace

ShapeValues shape_at(ElementKind kind, const Vector3& parent)
{
    ShapeValues v;
    if (is_simplex(kind))
        fill_simplex(v, kind, parent);
    else
        fill_cube(v, n_nodes(kind), dimension(kind), parent);
    return v;
}

/// Gauss points of the cube; on a simplex folded together (r, s (1 - r), ..), which raises the degree by one
/// for each dimension but the first.
std::vector<ShapeValues> rule_of(ElementKind kind, int n)
{
    const Quadrature rule = gauss(n);
    const int dim = dimension(kind);
    std::vector<ShapeValues> points;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < (dim == 3 ? n : 1); ++k) {
                Vector3 p{rule.points[i], rule.points[j], dim == 3 ? rule.points[k] : 0};
                double weight = rule.weights[i] * rule.weights[j] * (dim == 3 ? rule.weights[k] : 1);
                if (is_simplex(kind)) {
                    // The factors are the Jacobian of the fold from cube to simplex.
                    const double left = 1 - p[0], further = left * (1 - p[1]);
                    weight *= dim == 3 ? left * further : left;
                    p = {p[0], left * p[1], further * p[2]};
                }
                points.push_back(shape_at(kind, p));
                points.back().weight = weight;
            }
    return points;
}

const std::vector<ShapeValues>& quadrature_of(ElementKind kind)
{
    return of_kind(kind, [](ElementKind k) { return rule_of(k, n_points_of(k)); });
}

const std::vector<ShapeValues>& probes_of(ElementKind kind)
{
    return of_kind(kind, [](ElementKind k) {
        // A Jacobian is least at corners, or inside where quadratic edges bulge: both are probed.
        std::vector<ShapeValues> probes = rule_of(k, n_points_of(k));
        for (int A = 0; A < n_corners(k); ++A) {
            const double* corner = is_simplex(k) ? corners_of_simplex[A] : corners_of_cube[A];
            probes.push_back(shape_at(k, {corner[0], corner[1], corner[2]}));
        }
        return probes;
    });
}

ElementPoint element_point(const ShapeValues& shape, const Mesh& mesh, ElementKind kind,
                           const std::int32_t* nodes, const Vector3& about)
{
    ElementPoint at;
    for (int A = 0; A < n_nodes(kind); ++A) {
        // F has no share of `about`, since slopes add up to zero; taken off first, it costs no digits far
        // away.
        const Vector3 x = mesh.points[nodes[A]] - about;
        at.x += shape.N[A] * x;
        at.F += outer(x, shape.dN[A]);
    }
    return at;
}

}   // namespace livens::inline geometry_internal
