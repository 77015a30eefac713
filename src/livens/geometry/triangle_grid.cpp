// SPDX-License-Identifier: BSD-3-Clause
#include "livens/geometry/detail/triangle_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace livens {

namespace {

constexpr int most_cells = 1024;   // along a side
constexpr std::size_t entries_a_triangle = 8;

}   // namespace

/// As fine as leaves each triangle in a few cells.
TriangleGrid::TriangleGrid(const std::vector<Vector3>& points, const Triangles& triangles)
{
    const std::size_t n = triangles.corners.size() / 3;
    double high[2]{};
    for (int side = 0; side < 2; ++side) {
        low_[side] = HUGE_VAL;
        high[side] = -HUGE_VAL;
        for (const std::int32_t c : triangles.corners) {
            low_[side] = std::min(low_[side], points[c][side + 1]);
            high[side] = std::max(high[side], points[c][side + 1]);
        }
        const double size = high[side] - low_[side];
        scale_[side] = size > 0 && std::isfinite(1 / size) ? 1 / size : 0;
    }
    const auto for_cells = [&](std::size_t t, const auto& work) {
        int first[2], last[2];
        for (int side = 0; side < 2; ++side) {
            const auto x = [&](int i) { return points[triangles.corners[3 * t + i]][side + 1]; };
            first[side] = cell(side, std::min({x(0), x(1), x(2)}));
            last[side] = cell(side, std::max({x(0), x(1), x(2)}));
        }
        work(first, last);
    };
    std::size_t n_entries = 0;
    n_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(n))), 1, most_cells);
    for (;; n_ /= 2) {
        n_entries = 0;
        for (std::size_t t = 0; t < n; ++t)
            for_cells(t, [&](const int* first, const int* last) {
                n_entries += static_cast<std::size_t>(last[0] - first[0] + 1) *
                             static_cast<std::size_t>(last[1] - first[1] + 1);
            });
        if (n_ == 1 || n_entries <= entries_a_triangle * n) break;
    }
    begins_.assign(static_cast<std::size_t>(n_) * static_cast<std::size_t>(n_) + 1, 0);
    triangles_.resize(n_entries);
    const auto for_places = [&](std::size_t t, const auto& work) {
        for_cells(t, [&](const int* first, const int* last) {
            for (int i = first[0]; i <= last[0]; ++i)
                for (int j = first[1]; j <= last[1]; ++j) work(begins_[i * n_ + j + 1]);
        });
    };
    for (std::size_t t = 0; t < n; ++t) for_places(t, [](std::int32_t& count) { ++count; });
    // Each cell's end becomes its begin, and grows to its end again.
    std::int32_t sum = 0;
    for (std::size_t c = 1; c < begins_.size(); ++c) sum += std::exchange(begins_[c], sum);
    for (std::size_t t = 0; t < n; ++t)
        for_places(t, [&](std::int32_t& at) { triangles_[at++] = static_cast<std::int32_t>(t); });
}

int TriangleGrid::cell(int side, double x) const
{
    const double share = std::clamp((x - low_[side]) * scale_[side], 0.0, 1.0);
    return std::clamp(static_cast<int>(n_ * share), 0, n_ - 1);
}

std::span<const std::int32_t> TriangleGrid::over(const Vector3& point) const
{
    const int at = cell(0, point[1]) * n_ + cell(1, point[2]);
    return std::span(triangles_).subspan(begins_[at], begins_[at + 1] - begins_[at]);
}

}   // namespace livens
