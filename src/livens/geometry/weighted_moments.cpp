// SPDX-License-Identifier: BSD-3-Clause
// Integrals over solids whose density is a field.
// theory.md, "Bodies from meshes", "A density that is a field": rules of rising order until two agree. What
// stays unknown is summed up, and refused beyond 1e-9 of the mass.
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/geometry/detail/elements.h"
#include "livens/geometry/detail/weighing.h"
#include "livens/geometry/moments.h"

namespace livens {

namespace {

/// They stay: what ends with its thread asks for memory at its first use, without which the C library ends
/// the program.
const std::vector<ShapeValues>& rule_at(ElementKind kind, std::size_t level)
{
    using Rules = std::array<std::array<std::vector<ShapeValues>, finer.size()>, 6>;
    static std::mutex in_use;
    static auto& rules = *new Rules;
    const std::scoped_lock lock(in_use);
    std::vector<ShapeValues>& rule = rules[static_cast<int>(kind)][level];
    if (rule.empty()) rule = rule_of(kind, finer[level]);
    return rule;
}

struct Extent {
    Vector3 middle{};
    double length = 0;   ///< half of the longest edge of the box
};
Extent extent_of(const Mesh& mesh, int of_dimension)
{
    Vector3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = -low;
    for (const ElementBlock& b : mesh.blocks)
        for (const std::int32_t node : b.nodes)
            for (int i = 0; dimension(b.kind) == of_dimension && i < 3; ++i) {
                low[i] = std::min(low[i], mesh.points[node][i]);
                high[i] = std::max(high[i], mesh.points[node][i]);
            }
    const Vector3 half = 0.5 * high - 0.5 * low;
    return {0.5 * low + 0.5 * high, std::max({half[0], half[1], half[2]})};
}

std::string text_of_point(const Vector3& p)
{
    return "(" + to_text(p[0]) + ", " + to_text(p[1]) + ", " + to_text(p[2]) + ")";
}

}   // namespace

void geometry_internal::refuse_density(const std::string& what, const std::string& value,
                                       const std::string& help)
{
    throw InputError({"density-field", "", what, value, "", "", help});
}

double geometry_internal::checked_density(double density, const Vector3& at, double least)
{
    if (density >= least && std::isfinite(density)) return density;
    refuse_density("the density at " + text_of_point(at) + " of the shape's numbers is no density",
                   to_text(density), "it must be a number >= 0 all over the solid");
}

Moments geometry_internal::about_centroid(const Sums& sums, const Vector3& about)
{
    if (!(sums.mass > 0)) refuse_density("the density leaves no mass", to_text(sums.mass), "");
    const Vector3 off = (1 / sums.mass) * sums.first;
    // The parallel axis theorem: the second moment is taken about the centroid, after sums about the middle.
    return {sums.mass, about + off, sums.second - sums.mass * outer(off, off)};
}

Moments weighted_moments(const Mesh& mesh, const std::function<double(const Vector3&)>& density)
{
    const auto extent = extent_of(mesh, 3);
    const Vector3 middle = extent.middle;   // captured below
    const double length = extent.length;
    Sums whole;
    double missing = 0;
    for (const ElementBlock& b : mesh.blocks)
        for (std::int64_t e = 0; dimension(b.kind) == 3 && e < b.size(); ++e) {
            const auto sums_at = [&](std::size_t level) {
                Sums sums;
                for (const ShapeValues& point : rule_at(b.kind, level)) {
                    const ElementPoint at = element_point(point, mesh, b.kind, b.element(e), middle);
                    const Vector3 place = middle + at.x;
                    sums.add(at.x,
                             point.weight * determinant(at.F) * checked_density(density(place), place, 0));
                }
                return sums;
            };
            const Settled found = settled(length, sums_at);
            // An element whose rules agree counts as exact; only what stays open is summed up.
            if (found.gap > same_sums * found.sums.size) missing += found.gap;
            whole.add(found.sums);
        }
    if (missing > unsure_sums * whole.mass)
        refuse_density("the density changes too fast within elements: the mass is known to 1 part in " +
                           to_text(std::floor(whole.mass / missing)) + " only",
                       "", "let edges of elements lie where the density bends or jumps, or refine the mesh");
    return about_centroid(whole, middle);
}

/// For p homogeneous of degree k about the middle, int p dV = int p x . n dA / (3 + k).
Moments weighted_moments(const Mesh& mesh, const LinearDensity& density)
{
    const auto value = [&](const Vector3& x) { return density.at_origin + dot(density.gradient, x); };
    if (mesh.is_volume()) return weighted_moments(mesh, value);
    const auto [middle, length] = extent_of(mesh, 2);
    const double rho = value(middle);
    const double slack = 1e-12 * (std::abs(rho) + norm(density.gradient) * length);   // 0 on a side, rounded
    Sums sums;
    for (const ElementBlock& b : mesh.blocks)
        for (std::int64_t e = 0; dimension(b.kind) == 2 && e < b.size(); ++e) {
            for (int k = 0; k < n_nodes(b.kind); ++k) {
                const Vector3& corner = mesh.points[b.element(e)[k]];
                checked_density(value(corner), corner, -slack);
            }
            for (const ShapeValues& point : rule_at(b.kind, 0)) {
                const ElementPoint at = element_point(point, mesh, b.kind, b.element(e), middle);
                const double share = point.weight * dot(at.x, cross(at.F.column(0), at.F.column(1))),
                             slope = dot(density.gradient, at.x);
                // The density is rho + g . x about the middle: each part is homogeneous, of degree k + 0 and
                // k + 1, over 3 + k.
                sums.mass += share * (rho / 3 + slope / 4);
                sums.first += share * (rho / 4 + slope / 5) * at.x;
                sums.second += share * (rho / 5 + slope / 6) * outer(at.x, at.x);
            }
        }
    return about_centroid(sums, middle);
}

}   // namespace livens
