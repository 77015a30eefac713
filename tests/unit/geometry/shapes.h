// SPDX-License-Identifier: BSD-3-Clause
// Meshes of known solids, and files of them.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "livens/base/error.h"
#include "livens/geometry/moments.h"
#include "livens/geometry/soundness.h"

namespace livens::test {

inline constexpr double pi = std::numbers::pi;

inline Mesh empty_mesh(ElementKind kind)
{
    Mesh mesh;
    mesh.name = "test";
    mesh.regions.push_back({dimension(kind), {}});
    mesh.blocks.push_back({kind, {}, {}});
    return mesh;
}

inline void add(Mesh& mesh, std::initializer_list<std::int32_t> nodes, std::int32_t region = 0)
{
    mesh.blocks[0].nodes.insert(mesh.blocks[0].nodes.end(), nodes);
    mesh.blocks[0].regions.push_back(region);
}

/// A surface over a grid of n x m quadrilaterals, u and v from 0 to 1; equal points become one, and faces
/// that fall together vanish. Outwards is x_u cross x_v.
template <class Map>
Mesh surface_over(int n, int m, Map map)
{
    Mesh mesh = empty_mesh(ElementKind::triangle);
    std::map<std::array<double, 3>, std::int32_t> known;
    const auto index = [&](int i, int j) {
        Vector3 p = map(static_cast<double>(i) / n, static_cast<double>(j) / m);
        for (int k = 0; k < 3; ++k) p[k] = std::abs(p[k]) < 1e-13 ? 0 : p[k];
        const std::array<double, 3> key{std::round(p[0] * 1e10), std::round(p[1] * 1e10),
                                        std::round(p[2] * 1e10)};
        const auto [at, is_new] = known.try_emplace(key, static_cast<std::int32_t>(mesh.points.size()));
        if (is_new) mesh.points.push_back(p);
        return at->second;
    };
    const auto face = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
        if (a != b && b != c && c != a) add(mesh, {a, b, c});
    };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
            const std::int32_t a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1),
                               d = index(i, j + 1);
            face(a, b, c);
            face(a, c, d);
        }
    return mesh;
}

inline Mesh ball(int n)
{
    return surface_over(2 * n, n, [](double u, double v) {
        const double a = 2 * pi * u, b = pi * (v - 0.5);
        return Vector3{std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)};
    });
}
inline Mesh torus(int n, double R, double r)
{
    return surface_over(2 * n, n, [=](double u, double v) {
        const double a = 2 * pi * u, b = 2 * pi * v, c = R + r * std::cos(b);
        return Vector3{c * std::cos(a), c * std::sin(a), r * std::sin(b)};
    });
}
/// A profile (radius, height) turned about z, inside on the left.
inline Mesh turned(int n, const std::vector<std::array<double, 2>>& profile)
{
    const int m = static_cast<int>(profile.size()) - 1;
    return surface_over(n, m, [&](double u, double v) {
        const auto& [r, z] = profile[static_cast<std::size_t>(std::lround(v * m))];
        return Vector3{r * std::cos(2 * pi * u), r * std::sin(2 * pi * u), z};
    });
}
/// Each side in n x n squares of two triangles.
inline Mesh box_surface(const Vector3& low, const Vector3& high, int n = 1)
{
    Mesh mesh = empty_mesh(ElementKind::triangle);
    std::map<std::array<int, 3>, std::int32_t> known;
    const auto index = [&](const std::array<int, 3>& at) {
        const auto [found, is_new] = known.try_emplace(at, static_cast<std::int32_t>(mesh.points.size()));
        if (is_new) {
            Vector3 p;
            for (int i = 0; i < 3; ++i) p[i] = at[i] == n ? high[i] : low[i] + (high[i] - low[i]) * at[i] / n;
            mesh.points.push_back(p);
        }
        return found->second;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side)
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    std::array<std::int32_t, 4> c;
                    for (int k = 0; k < 4; ++k) {
                        std::array<int, 3> at{};
                        at[axis] = side * n;
                        at[(axis + 1) % 3] = i + (k == 1 || k == 2);
                        at[(axis + 2) % 3] = j + (k >= 2);
                        c[k] = index(at);
                    }
                    if (side == 0) std::swap(c[1], c[3]);
                    add(mesh, {c[0], c[1], c[2]});
                    add(mesh, {c[0], c[2], c[3]});
                }
    return mesh;
}

/// A volume over a grid of cells, each divided into six tetrahedra [Kuhn] or one hexahedron. Middles of edges
/// lie where the map takes those of the grid.
template <class Map>
Mesh volume_over(const std::array<int, 3>& n, ElementKind kind, Map map)
{
    Mesh mesh = empty_mesh(kind);
    std::map<std::array<double, 3>, std::int32_t> known;
    using Place = std::array<int, 3>;   // in halves of cells
    const auto index = [&](const Place& at) {
        const Vector3 p = map(0.5 * at[0] / n[0], 0.5 * at[1] / n[1], 0.5 * at[2] / n[2]);
        const std::array<double, 3> key{std::round(p[0] * 1e10) + 0.0, std::round(p[1] * 1e10) + 0.0,
                                        std::round(p[2] * 1e10) + 0.0};
        const auto [found, is_new] = known.try_emplace(key, static_cast<std::int32_t>(mesh.points.size()));
        if (is_new) mesh.points.push_back(p);
        return found->second;
    };
    const auto middle = [](const Place& a, const Place& b) {
        return Place{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
    };
    constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int i = 0; i < n[0]; ++i)
        for (int j = 0; j < n[1]; ++j)
            for (int k = 0; k < n[2]; ++k) {
                const Place o{2 * i, 2 * j, 2 * k};
                if (kind == ElementKind::hexahedron) {
                    const auto c = [&](int a, int b, int d) {
                        return index({o[0] + 2 * a, o[1] + 2 * b, o[2] + 2 * d});
                    };
                    add(mesh, {c(0, 0, 0), c(1, 0, 0), c(1, 1, 0), c(0, 1, 0), c(0, 0, 1), c(1, 0, 1),
                               c(1, 1, 1), c(0, 1, 1)});
                    continue;
                }
                for (int t = 0; t < 6; ++t) {
                    std::array<Place, 4> p{o, o, o, o};
                    for (int s = 1; s < 4; ++s) {
                        p[s] = p[s - 1];
                        p[s][orders[t][s - 1]] += 2;
                    }
                    if (t >= 3) std::swap(p[1], p[2]);
                    if (kind == ElementKind::tetrahedron)
                        add(mesh, {index(p[0]), index(p[1]), index(p[2]), index(p[3])});
                    else
                        add(mesh,
                            {index(p[0]), index(p[1]), index(p[2]), index(p[3]), index(middle(p[0], p[1])),
                             index(middle(p[1], p[2])), index(middle(p[2], p[0])), index(middle(p[3], p[0])),
                             index(middle(p[3], p[2])), index(middle(p[3], p[1]))});
                }
            }
    return mesh;
}

/// r < radius < R, 0 < z < h.
inline Mesh tube(int n, ElementKind kind, double r, double R, double h)
{
    return volume_over({4 * n, n, n}, kind, [=](double u, double v, double w) {
        const double radius = R + (r - R) * v, a = 2 * pi * u;   // round, inwards, up: right-handed
        return Vector3{radius * std::cos(a), radius * std::sin(a), h * w};
    });
}

template <class Change>
Mesh changed(Mesh mesh, Change change)
{
    for (Vector3& p : mesh.points) p = change(p);
    return mesh;
}

inline Mesh joined(Mesh a, const Mesh& b)
{
    const auto n = static_cast<std::int32_t>(a.points.size());
    a.points.insert(a.points.end(), b.points.begin(), b.points.end());
    for (const std::int32_t node : b.blocks[0].nodes) a.blocks[0].nodes.push_back(n + node);
    a.blocks[0].regions.insert(a.blocks[0].regions.end(), b.blocks[0].regions.begin(),
                               b.blocks[0].regions.end());
    return a;
}
inline Mesh inside_out(Mesh mesh)
{
    for (std::size_t k = 0; k < mesh.blocks[0].nodes.size(); k += 3)
        std::swap(mesh.blocks[0].nodes[k], mesh.blocks[0].nodes[k + 1]);
    return mesh;
}

/// Trace(E) I - E.
inline Matrix3 inertia(const Moments& m) { return trace(m.second) * identity<3>() - m.second; }

template <class T>
void put(std::string& bytes, T value, bool is_big = false)
{
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (is_big) std::reverse(raw, raw + sizeof raw);
    bytes.append(raw, sizeof raw);
}

inline std::string stl_of(const Mesh& mesh)
{
    std::string bytes(80, ' ');
    const ElementBlock& b = mesh.blocks[0];
    put(bytes, static_cast<std::uint32_t>(b.size()));
    for (std::int64_t e = 0; e < b.size(); ++e) {
        for (int i = 0; i < 3; ++i) put(bytes, 0.0f);
        for (int k = 0; k < 3; ++k)
            for (int i = 0; i < 3; ++i) put(bytes, static_cast<float>(mesh.points[b.element(e)[k]][i]));
        put(bytes, std::uint16_t{0});
    }
    return bytes;
}

}   // namespace livens::test
