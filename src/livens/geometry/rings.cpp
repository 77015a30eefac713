// SPDX-License-Identifier: BSD-3-Clause
// Whether the faces around each point form one ring, and from which directions they are seen without a fold:
// the first and cheapest test of theory.md, "Bodies from meshes", Is it a solid? Most points pass it, and
// pairs of faces about them need no other look.
#include "livens/geometry/detail/rings.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "livens/geometry/detail/workers.h"

namespace livens::inline geometry_internal {

namespace {

using Index = std::int32_t;

/// Round point p: the triangles (p, next, previous).
struct Arcs {
    std::span<const Index> next, previous;
    std::size_t size() const { return next.size(); }
};

/// The arcs of all points, one point's after the other's.
struct ArcTable {
    std::vector<Index> begins, next, previous;
    bool has_degenerate = false;   ///< a triangle has a corner twice

    ArcTable(std::size_t n_points, std::span<const Index> corners)
        : begins(filled<Index>(n_points + 2, 0)), next(filled<Index>(corners.size(), 0)),
          previous(filled<Index>(corners.size(), 0))
    {
        // Where the arcs of a point begin is kept one place too far, and grows to where they end.
        for (const Index c : corners) ++begins[c + 2];
        for (std::size_t i = 2; i < begins.size(); ++i) begins[i] += begins[i - 1];
        for (std::size_t h = 0; h < corners.size(); h += 3) {
            const std::array<Index, 3> c{corners[h], corners[h + 1], corners[h + 2]};
            has_degenerate |= c[0] == c[1] || c[1] == c[2] || c[2] == c[0];
            for (int i = 0; i < 3; ++i) {
                const Index at = begins[c[i] + 1]++;
                next[at] = c[(i + 1) % 3];
                previous[at] = c[(i + 2) % 3];
            }
        }
    }
    Arcs of(std::size_t point) const
    {
        const std::size_t first = begins[point], n = begins[point + 1] - begins[point];
        return {{next.data() + first, n}, {previous.data() + first, n}};
    }
};

/// Each neighbour stands once as next and once as previous: the arcs make up rings, one or several.
bool are_matched(const Arcs& arcs)
{
    const std::size_t n = arcs.size();
    // One bit for each arc suffices up to 64 of them; points of fans that are larger are sorted instead.
    if (n > 64) {
        std::vector<Index> next(arcs.next.begin(), arcs.next.end()),
            previous(arcs.previous.begin(), arcs.previous.end());
        std::sort(next.begin(), next.end());
        std::sort(previous.begin(), previous.end());
        return next == previous && std::adjacent_find(next.begin(), next.end()) == next.end();
    }
    std::uint64_t all = 0;
    for (std::size_t j = 0; j < n; ++j) {
        std::uint64_t same = 0;
        for (std::size_t k = 0; k < n; ++k)
            same |= static_cast<std::uint64_t>(arcs.previous[j] == arcs.next[k]) << k;
        if (same == 0 || (same & (same - 1)) != 0) return false;
        all |= same;
    }
    return n == 0 || all == ~std::uint64_t{0} >> (64 - n);
}

/// Of arcs that are matched.
bool is_one_ring(const Arcs& arcs)
{
    std::vector<std::pair<Index, Index>> ahead(arcs.size());
    for (std::size_t k = 0; k < arcs.size(); ++k) ahead[k] = {arcs.next[k], arcs.previous[k]};
    std::sort(ahead.begin(), ahead.end());
    std::size_t n = 0;
    Index at = ahead.front().first;
    do {
        at = std::lower_bound(ahead.begin(), ahead.end(), std::pair<Index, Index>{at, -1})->second;
        ++n;
    } while (at != ahead.front().first && n <= arcs.size());
    return n == arcs.size();
}

/// Bits as in Rings.
class Fan {
public:
    Fan(const std::vector<Vector3>& points, std::size_t at, const Arcs& arcs)
        : points_(points), at_(points[at]), arcs_(arcs)
    {}

    std::uint8_t directions() const
    {
        unsigned bits = 63;
        std::array<int, 3> rounds{};
        Vector3 axis{};
        for (std::size_t k = 0; k < arcs_.size(); ++k) {
            const Vector3 u = next(k), v = previous(k), n = cross(u, v);
            const double least = needle * dot(u, u) * dot(v, v);
            axis += n;
            for (int i = 0; i < 3; ++i) {
                // Squares with their sign: the comparison with a sine needs no root.
                const double square = n[i] * std::abs(n[i]);
                const int z = (i + 2) % 3;
                bits &= ~(static_cast<unsigned>(!(square > least)) << i);
                bits &= ~(static_cast<unsigned>(!(square < -least)) << (i + 3));
                // All go round once if one of them passes the half-line with z = 0 < y.
                rounds[i] += static_cast<int>(u[z] <= 0) & static_cast<int>(v[z] > 0);
            }
        }
        for (int i = 0; i < 3; ++i)
            // A fan may turn one way throughout and still go round twice, as a spiral stair does.
            if (rounds[i] != 1) bits &= ~(9u << i);
        if (bits == 0 && goes_round_once(axis)) bits = 64;
        return static_cast<std::uint8_t>(bits);
    }

private:
    /// The least square of the sine of an angle that is seen: far from where rounding decides.
    static constexpr double needle = 1e-8;

    bool goes_round_once(const Vector3& axis) const
    {
        const double aa = dot(axis, axis);
        const bool is_steep = std::abs(axis[2]) > std::abs(axis[0]);
        const auto y_of = [&](const Vector3& u) {
            return is_steep ? axis[2] * u[1] - axis[1] * u[2] : axis[0] * u[1] - axis[1] * u[0];
        };
        int n = 0;
        for (std::size_t k = 0; k < arcs_.size(); ++k) {
            const Vector3 u = next(k), v = previous(k), normal = cross(u, v);
            const double turn = dot(normal, axis), nn = dot(normal, normal);
            // More than 3 degrees from being seen edgewise.
            if (!(turn > 0 && turn * turn > 2.5e-3 * nn * aa && nn > needle * dot(u, u) * dot(v, v)))
                return false;
            n += y_of(u) <= 0 && y_of(v) > 0;
        }
        return n == 1;
    }
    Vector3 next(std::size_t k) const { return points_[arcs_.next[k]] - at_; }
    Vector3 previous(std::size_t k) const { return points_[arcs_.previous[k]] - at_; }

    const std::vector<Vector3>& points_;
    Vector3 at_;
    Arcs arcs_;
};

}   // namespace

Rings rings_of(const std::vector<Vector3>& points, std::span<const std::int32_t> corners)
{
    const ArcTable table(points.size(), corners);
    Rings rings{false, filled<std::uint8_t>(points.size(), 0)};
    constexpr std::size_t some = 8192;
    std::vector<std::uint8_t> are_open((points.size() + some - 1) / some, 0);
    in_parts(points.size(), some, [&](std::size_t begin, std::size_t end, int part) {
        for (std::size_t p = begin; p < end; ++p) {
            const Arcs arcs = table.of(p);
            if (arcs.size() == 0) continue;
            rings.directions[p] = Fan(points, p, arcs).directions();
            // Each ring of a fan goes round at least once: there is but one.
            if (are_open[part] == 0)
                are_open[part] = !(are_matched(arcs) && (rings.directions[p] != 0 || is_one_ring(arcs)));
        }
    });
    rings.are_closed = !table.has_degenerate && std::ranges::count(are_open, 1) == 0;
    return rings;
}

}   // namespace livens::inline geometry_internal
