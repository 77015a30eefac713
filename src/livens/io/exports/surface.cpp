// SPDX-License-Identifier: BSD-3-Clause
// Triangles of outlines: a profile turned about d3.
// Bodies without a stated shape get a mark of a twentieth of the model's length. Normals are those of the
// curved surface where neighbours are nearly parallel, else each face has its own.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/io/exports/formats.h"

namespace livens::inline io_internal {

namespace {

using Vector2 = std::array<double, 2>;   // radius, height

constexpr int fewest_round_sides = 8;    // with fewer a body has edges along d3, else it is round
constexpr double smooth_cosine = 0.75;   // between normals of neighbours that belong to one curve
constexpr double mark = 0.05;            // of the model's length

/// Outward normal of each piece of a profile that has its inside on the left.
std::vector<Vector2> normals_of(const std::vector<Vector2>& profile)
{
    std::vector<Vector2> normals;
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        const double r = profile[i + 1][0] - profile[i][0], z = profile[i + 1][1] - profile[i][1];
        const double size = hypotenuse(r, z, 0);
        normals.push_back({z / size, -r / size});
    }
    return normals;
}

/// Of two neighbours the mean, if both belong to one curve; else that of the first.
Vector2 blended(const Vector2& own, const Vector2& neighbour)
{
    if (own[0] * neighbour[0] + own[1] * neighbour[1] < smooth_cosine) return own;
    const double r = own[0] + neighbour[0], z = own[1] + neighbour[1], size = hypotenuse(r, z, 0);
    return {r / size, z / size};
}

Vector3 unit(const Vector3& v) { return (1 / norm(v)) * v; }

class Turning {
public:
    Turning(const Outline& outline, const Vector3& place) : outline_(outline), place_(place) {}

    Surface take()
    {
        const std::vector<Vector2>& profile = outline_.profile;
        const std::vector<Vector2> normals = normals_of(profile);
        for (std::size_t i = 0; i < normals.size(); ++i) {
            const Vector2 low = i > 0 ? blended(normals[i], normals[i - 1]) : normals[i];
            const Vector2 high = i + 1 < normals.size() ? blended(normals[i], normals[i + 1]) : normals[i];
            for (int k = 0; k < outline_.sides; ++k) add_face(k, {profile[i], profile[i + 1]}, {low, high});
        }
        return std::move(surface_);
    }

private:
    using Piece = std::array<Vector2, 2>;   // its lower and its upper end

    double angle(double k) const { return 2 * std::numbers::pi * (k + 0.5) / outline_.sides; }

    /// Four corners of a piece between two meridians; at the axis two of them are one.
    void add_face(int k, const Piece& ends, const Piece& normals)
    {
        const int first = static_cast<int>(surface_.points.size());
        const bool is_round = outline_.sides >= fewest_round_sides;
        for (const int side : {0, 1})
            for (const int end : {0, 1}) {
                const double at = angle(k + side), facing = is_round ? at : angle(k + 0.5);
                add_corner(at, ends[end], facing, normals[end]);
            }
        if (ends[0][0] > 0) surface_.triangles.push_back({first, first + 2, first + 3});
        if (ends[1][0] > 0) surface_.triangles.push_back({first, first + 3, first + 1});
    }

    void add_corner(double angle, const Vector2& at, double facing, const Vector2& normal)
    {
        const Vector3& stretch = outline_.stretch;
        const SineCosine turned = sine_cosine(angle), faced = sine_cosine(facing);
        const Vector3 p{at[0] * turned.cosine, at[0] * turned.sine, at[1]};
        Vector3 n{normal[0] * faced.cosine, normal[0] * faced.sine, normal[1]}, q;
        for (int i = 0; i < 3; ++i) {
            q[i] = place_[i] + stretch[i] * p[i];
            // Normals go with the inverse of the stretch, points with the stretch itself.
            n[i] /= stretch[i];
        }
        surface_.points.push_back(q);
        surface_.normals.push_back(unit(n));
    }

    const Outline& outline_;
    Vector3 place_;
    Surface surface_;
};

double largest(const Vector3& v) { return std::max({v[0], v[1], v[2]}); }

/// Normals of a surface that was thinned: each corner has the mean of the faces around it that face alike, as
/// the curved surface had that they stand for. `areas`: normals of the triangles, as long as they are large.
void blend_normals(const Outline& outline, const std::vector<Vector3>& areas, std::span<Vector3> normals)
{
    std::vector<std::vector<std::size_t>> around(outline.points.size());
    for (std::size_t f = 0; f < areas.size(); ++f)
        for (const int point : outline.triangles[f]) around[point].push_back(f);
    std::size_t corner = 0;
    for (std::size_t f = 0; f < areas.size(); ++f)
        for (int k = 0; k < 3 && norm(areas[f]) > 0; ++k, ++corner) {
            Vector3 sum{};
            for (const std::size_t other : around[outline.triangles[f][k]])
                if (dot(areas[f], areas[other]) >= smooth_cosine * norm(areas[f]) * norm(areas[other]))
                    sum += areas[other];
            normals[corner] = unit(sum);
        }
}

/// Flat faces: each has its own corners.
void add_triangles(const Outline& outline, Surface& to)
{
    const std::size_t n_before = to.normals.size();
    std::vector<Vector3> areas;
    for (const std::array<int, 3>& t : outline.triangles) {
        std::array<Vector3, 3> p;
        for (int k = 0; k < 3; ++k)
            for (int i = 0; i < 3; ++i) p[k][i] = outline.stretch[i] * outline.points[t[k]][i];
        const Vector3 area = areas.emplace_back(cross(p[1] - p[0], p[2] - p[0]));
        if (norm(area) == 0) {   // a needle has no side
            to.n_left_out += outline.n_left_out > 0 ? 1 : 0;
            continue;
        }
        const int first = static_cast<int>(to.points.size());
        for (const Vector3& corner : p) {
            to.points.push_back(corner);
            to.normals.push_back(unit(area));
        }
        to.triangles.push_back({first, first + 1, first + 2});
    }
    if (outline.n_left_out > 0) blend_normals(outline, areas, std::span(to.normals).subspan(n_before));
}

/// Adds a surface at a place in axes.
void add_surface(Surface& to, const Surface& surface, const Vector3& place, const Matrix3& axes)
{
    const int first = static_cast<int>(to.points.size());
    to.n_left_out += surface.n_left_out;
    to.moved = std::max(to.moved, surface.moved);
    for (const Vector3& p : surface.points) to.points.push_back(place + axes * p);
    for (const Vector3& n : surface.normals) to.normals.push_back(axes * n);
    for (const auto& t : surface.triangles)
        to.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

/// About the origin of the outline.
Surface surface_of(const Outline& outline)
{
    Surface whole = outline.profile.empty() ? Surface{} : Turning(outline, {}).take();
    add_triangles(outline, whole);
    whole.n_left_out += outline.n_left_out;
    whole.moved = largest(outline.stretch) * outline.moved;
    for (const Outline& part : outline.parts) add_surface(whole, surface_of(part), part.place, part.axes);
    return whole;
}

/// Of a body without visuals.
Drawn shape_of(const Body& body, Outline outline, double size)
{
    if (outline.is_empty()) {
        const std::optional<Vector3> color = outline.color;
        const double opacity = outline.opacity;
        outline = body.is_point ? ball_outline() : Outline{{{0, -1}, {1, 0}, {0, 1}}, 4};
        outline.stretch = {size, size, size};
        outline.color = color;
        outline.opacity = opacity;
    }
    const Vector3 centre = body.is_point ? Vector3{} : mass_properties(body.mass).center_of_mass;
    return {surface_of(outline), centre, identity<3>(), outline.color, outline.opacity};
}

}   // namespace

std::vector<std::vector<Drawn>> drawn_of(const Scenario& scenario)
{
    std::vector<std::vector<Drawn>> all;
    const std::vector<Body>& bodies = scenario.model.bodies();
    const double size = mark * scenario.model.length();
    for (std::size_t b = 0; b <= bodies.size(); ++b) {
        std::vector<Drawn>& drawn = all.emplace_back();
        const Outline outline = b < scenario.outlines.size() ? scenario.outlines[b] : Outline{};
        for (const Outline& one : outline.visuals)
            // A mesh of needles alone has nothing to show.
            if (Surface surface = surface_of(one); !surface.triangles.empty())
                drawn.push_back({std::move(surface), one.place, one.axes, one.color, one.opacity});
        if (b < bodies.size() && drawn.empty() && !bodies[b].holds_states())
            drawn.push_back(shape_of(bodies[b], outline, size));
    }
    return all;
}

Surface united(const std::vector<Drawn>& all)
{
    Surface whole;
    for (const Drawn& one : all) add_surface(whole, one.surface, one.place, one.axes);
    return whole;
}

}   // namespace livens::inline io_internal
