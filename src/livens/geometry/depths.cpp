// SPDX-License-Identifier: BSD-3-Clause
// In how many other pieces of a surface a point lies: theory.md, "Bodies from meshes", Is it a solid? A ray
// along the first axis counts crossings with their sign; where it is not clear that it passes through the
// inside of faces, the solid angle over 4 pi decides.
#include "livens/geometry/detail/depths.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace livens::inline geometry_internal {

namespace {

constexpr double unclear = 1e-12;            // of what is subtracted
constexpr std::int64_t looks_of_view = 30;   // what the solid angle of a face costs
constexpr std::int64_t looks_at_least = 30'000'000, looks_a_triangle = 1000;   // more take seconds

/// Of the triangle 0, a, b seen along the first axis, doubled. 0 where it is not clear.
double area(const Vector3& a, const Vector3& b)
{
    // Inequality: a doubled area below 1e-12 of the terms it is the difference of has no sign.
    const double one = a[1] * b[2], other = a[2] * b[1];
    return std::abs(one - other) <= unclear * (std::abs(one) + std::abs(other)) ? 0 : one - other;
}

}   // namespace

Depths::Depths(const Facets& facets, const Triangles& triangles, const Pieces& pieces)
    : facets_(facets), triangles_(triangles), pieces_(pieces), around_(pieces.n), wounds_(pieces.n),
      grid_(facets.mesh->points, triangles)
{
    for (std::int32_t face = 0; face < facets.n_faces(); ++face) {
        Around& around = around_[pieces.of(face)];
        around.faces.push_back(face);
        for (std::int32_t h = facets.begin(face); h < facets.begin(face + 1); ++h) around.widen(facets.at(h));
    }
}

void Depths::Around::widen(const Vector3& p)
{
    for (int i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], p[i]);
        high[i] = std::max(high[i], p[i]);
    }
}

bool Depths::Around::holds(const Vector3& p) const
{
    for (int i = 0; i < 3; ++i)
        if (!(p[i] >= low[i] && p[i] <= high[i])) return false;
    return true;
}

bool Depths::is_beyond() const
{
    const auto n_triangles = static_cast<std::int64_t>(triangles_.corners.size() / 3);
    return n_looks_ > looks_at_least + looks_a_triangle * n_triangles;
}

void Depths::cross(const Vector3& point, std::size_t triangle, Wound& wound) const
{
    const std::int32_t* const c = &triangles_.corners[3 * triangle];
    const std::vector<Vector3>& points = facets_.mesh->points;
    const Vector3 p[3] = {points[c[0]] - point, points[c[1]] - point, points[c[2]] - point};
    for (int i = 1; i < 3; ++i) {
        if (p[0][i] > 0 && p[1][i] > 0 && p[2][i] > 0) return;
        if (p[0][i] < 0 && p[1][i] < 0 && p[2][i] < 0) return;
    }
    const double a[3] = {area(p[1], p[2]), area(p[2], p[0]), area(p[0], p[1])};
    int n_left = 0, n_right = 0;
    for (const double x : a) {
        n_left += x > 0;
        n_right += x < 0;
    }
    if (n_left > 0 && n_right > 0) return;   // passes by
    const double away = a[0] * p[0][0] + a[1] * p[1][0] + a[2] * p[2][0],
                 size = std::abs(a[0] * p[0][0]) + std::abs(a[1] * p[1][0]) + std::abs(a[2] * p[2][0]);
    if (n_left + n_right < 3 || std::abs(away) <= unclear * size) {
        wound.is_clear = false;
        return;
    }
    const int turn = n_left > 0 ? 1 : -1;
    wound.in_all += turn;
    // Crossings behind the point count alone; their sum over both sides has to vanish on a closed piece,
    // which tells whether all were seen.
    if (away * turn > 0) wound.behind += turn;
}

double Depths::seen(const Vector3& point, std::int32_t piece)
{
    const Around& around = around_[piece];
    if (is_beyond() || !around.holds(point)) return 0;
    double sum = 0;
    for (const std::int32_t face : around.faces) sum += share_of_view(facets_, face, point);
    n_looks_ += looks_of_view * static_cast<std::int64_t>(around.faces.size());
    return sum;
}

int Depths::of(const Vector3& point, std::int32_t own, bool as_if_outwards)
{
    if (is_beyond()) return 0;
    const std::span<const std::int32_t> triangles = grid_.over(point);
    n_looks_ += std::ssize(triangles);
    met_.clear();
    for (const std::int32_t triangle : triangles) {
        const std::int32_t piece = pieces_.of(triangles_.face(triangle));
        if (piece == own) continue;
        Wound& wound = wounds_[piece];
        if (!std::exchange(wound.is_met, true)) met_.push_back(piece);
        cross(point, triangle, wound);
    }
    double depth = 0;
    for (const std::int32_t piece : met_) {
        const Wound wound = std::exchange(wounds_[piece], Wound{});
        const bool is_counted = wound.is_clear && wound.in_all == 0;
        const double around = is_counted ? wound.behind : seen(point, piece);
        depth += as_if_outwards ? std::abs(around) : around;
    }
    return static_cast<int>(std::lround(depth));
}

double share_of_view(const Facets& f, std::int32_t face, const Vector3& p)
{
    double angle = 0;
    for (std::int32_t h = f.begin(face) + 1; h + 1 < f.begin(face + 1); ++h) {
        const Vector3 a = f.at(f.begin(face)) - p, b = f.at(h) - p, c = f.at(h + 1) - p;
        const double la = norm(a), lb = norm(b), lc = norm(c);
        // The solid angle of a triangle by Van Oosterom and Strackee (1983): right up to 4 pi, as atan2 knows
        // the quadrant.
        const double below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        angle += 2 * std::atan2(dot(a, cross(b, c)), below);
    }
    return angle / (4 * std::numbers::pi);
}

}   // namespace livens::inline geometry_internal
