// SPDX-License-Identifier: BSD-3-Clause
// Surfaces of large meshes are thinned for pictures by clustering of vertices (Rossignac and Borrel, 1993):
// points of one cell become their mean. How far points were moved is told, since a picture is no longer the
// solid.
#include "livens/io/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace livens::inline io_internal {

namespace {

constexpr std::size_t most_in_all = 120'000, fewest_of_one = 4'000;
constexpr int finest = 1024, coarsest = 4;   // cells along the longest side

/// Of the points that are one: their mean.
struct Cluster {
    Vector3 sum{};
    double n = 0;

    Vector3 mean() const { return (1 / n) * sum; }
};

/// A grid over all points, and what falls into its cells.
class Clusters {
public:
    Clusters(const Surface& surface, int n_cells)
    {
        Vector3 least = surface.points.front(), most = least;
        for (const Vector3& p : surface.points)
            for (int i = 0; i < 3; ++i) {
                least[i] = std::min(least[i], p[i]);
                most[i] = std::max(most[i], p[i]);
            }
        const double size = std::max({most[0] - least[0], most[1] - least[1], most[2] - least[2]}) / n_cells;
        cell_of_.reserve(surface.points.size());
        for (const Vector3& p : surface.points) {
            std::uint64_t cell = 0;
            for (int i = 0; i < 3; ++i)
                // 11 bits hold 0 to 1024, the last for what lies on the far side of the finest grid
                cell = cell << 11 | static_cast<std::uint64_t>((p[i] - least[i]) / size);
            cell_of_.push_back(add(cells_, cell_index_, cell, p));
        }
    }

    /// The triangles whose corners are in three cells.
    std::size_t n_triangles(const Surface& surface) const
    {
        return static_cast<std::size_t>(
            std::ranges::count_if(surface.triangles, [&](const auto& t) { return has_area(t); }));
    }

    Surface made(const Surface& surface) const
    {
        Surface thin;
        thin.n_left_out = surface.n_left_out + surface.triangles.size();
        double moved = 0;
        for (std::size_t k = 0; k < surface.points.size(); ++k)
            moved = std::max(moved, norm(surface.points[k] - at(cell_of_[k])));
        thin.moved = surface.moved + moved;
        const std::vector<int> corner_of = surface.normals.empty() ? bare(thin) : facing(surface, thin);
        for (const auto& t : surface.triangles)
            // A triangle whose corners fall into fewer than three cells has become a line or a point.
            if (has_area(t)) {
                auto& triangle = thin.triangles.emplace_back();
                for (std::size_t i = 0; i < 3; ++i) triangle[i] = corner_of[static_cast<std::size_t>(t[i])];
            }
        thin.n_left_out -= thin.triangles.size();
        return thin;
    }

private:
    using Index = std::unordered_map<std::uint64_t, int>;

    Vector3 at(int cell) const { return cells_[static_cast<std::size_t>(cell)].mean(); }
    /// A point for each cell; of the points that were, the new ones.
    std::vector<int> bare(Surface& thin) const
    {
        for (const Cluster& cell : cells_) thin.points.push_back(cell.mean());
        return cell_of_;
    }
    /// A point for each way that the corners of a cell face.
    std::vector<int> facing(const Surface& surface, Surface& thin) const
    {
        std::vector<Cluster> normals;
        Index index;
        std::vector<int> corner_of;
        for (std::size_t k = 0; k < surface.points.size(); ++k) {
            auto key = static_cast<std::uint64_t>(cell_of_[k]);
            // Edges stay sharp: corners of one cell that face different ways do not share a normal.
            for (int i = 0; i < 3; ++i) key = key << 2 | way(surface.normals[k][i]);
            corner_of.push_back(add(normals, index, key, surface.normals[k]));
            if (normals.size() > thin.points.size()) thin.points.push_back(at(cell_of_[k]));
        }
        for (const Cluster& cluster : normals) {
            const double size = norm(cluster.sum);
            thin.normals.push_back(size > 0 ? (1 / size) * cluster.sum : Vector3{0, 0, 1});
        }
        return corner_of;
    }
    /// Of a component of a normal: along its axis, against it, or across.
    static std::uint64_t way(double x) { return x > 0.4 ? 2 : x < -0.4 ? 0 : 1; }
    static int add(std::vector<Cluster>& all, Index& index, std::uint64_t key, const Vector3& v)
    {
        const int at = index.try_emplace(key, static_cast<int>(all.size())).first->second;
        if (at == static_cast<int>(all.size())) all.emplace_back();
        Cluster& cluster = all[static_cast<std::size_t>(at)];
        cluster.sum = cluster.sum + v;
        cluster.n += 1;
        return at;
    }
    int cell(int point) const { return cell_of_[static_cast<std::size_t>(point)]; }
    bool has_area(const std::array<int, 3>& t) const
    {
        return cell(t[0]) != cell(t[1]) && cell(t[1]) != cell(t[2]) && cell(t[2]) != cell(t[0]);
    }

    std::vector<Cluster> cells_;
    Index cell_index_;
    std::vector<int> cell_of_;
};

}   // namespace

Surface thinned(Surface surface, std::size_t most_triangles)
{
    if (surface.triangles.size() <= most_triangles) return surface;
    // About 4 n^2 triangles of a plate, 12 n^2 of a cube, fewer of a rod.
    const double most = static_cast<double>(most_triangles);
    int n_cells = std::min(finest, static_cast<int>(1.5 * std::sqrt(most)));
    while (n_cells > coarsest) {
        const Clusters clusters(surface, n_cells);
        const double n = static_cast<double>(clusters.n_triangles(surface));
        if (n <= most) return clusters.made(surface);
        // Triangles grow as the square of cells along a side; the bound of nine tenths makes the search end.
        n_cells = std::min(n_cells * 9 / 10, static_cast<int>(n_cells * std::sqrt(most / n)));
    }
    return Clusters(surface, coarsest).made(surface);
}

std::size_t triangles_of_each(std::span<const Surface> surfaces)
{
    std::size_t n_large = 0;
    for (const Surface& surface : surfaces) n_large += surface.triangles.size() > fewest_of_one ? 1 : 0;
    return std::max(fewest_of_one, most_in_all / std::max<std::size_t>(n_large, 1));
}

}   // namespace livens::inline io_internal
