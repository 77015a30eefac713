// SPDX-License-Identifier: BSD-3-Clause
// Volume, centroid and second moments of solids: what (P19) leaves of a mesh. Over surfaces by the divergence
// theorem, triangle by triangle in closed form; over elements of volume by quadrature. theory.md, "Bodies
// from meshes", derives both.
#include "livens/geometry/moments.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>

#include "livens/geometry/detail/elements.h"
#include "livens/geometry/detail/workers.h"

namespace livens {

namespace {

/// Integrals of 1, x and x x^T, summed with what rounding loses [Knuth 1969, TwoSum].
class Sums {
public:
    static constexpr int n = 10;
    using Terms = std::array<double, n>;

    void add(const Terms& terms)
    {
        for (int i = 0; i < n; ++i) {
            const double sum = sums_[i] + terms[i], of_term = sum - sums_[i];
            lost_[i] += (sums_[i] - (sum - of_term)) + (terms[i] - of_term);
            sums_[i] = sum;
        }
    }
    void add(const Sums& others)
    {
        add(others.sums_);
        for (int i = 0; i < n; ++i) lost_[i] += others.lost_[i];
    }
    /// The point x has a share of the volume.
    void add(const Vector3& x, double share)
    {
        add({share, share * x[0], share * x[1], share * x[2], share * x[0] * x[0], share * x[1] * x[1],
             share * x[2] * x[2], share * x[0] * x[1], share * x[1] * x[2], share * x[2] * x[0]});
    }

    /// `scales`: of volume, first and second moment. About the centroid, which lies off `about`.
    Moments moments(const Vector3& about, const Vector3& scales) const
    {
        const auto total = [&](int i) { return sums_[i] + lost_[i]; };
        Moments m;
        m.volume = scales[0] * total(0);
        if (m.volume == 0) return m;
        Vector3 off;
        for (int i = 0; i < 3; ++i) {
            off[i] = scales[1] * total(1 + i) / m.volume;
            m.second(i, i) = scales[2] * total(4 + i);
            m.second(i, (i + 1) % 3) = m.second((i + 1) % 3, i) = scales[2] * total(7 + i);
        }
        // Steiner's theorem. `off` is small, as the integrals are about the middle of the box: the difference
        // keeps its digits.
        m.second -= m.volume * outer(off, off);
        m.centroid = about + off;
        return m;
    }

private:
    Terms sums_{}, lost_{};
};

/// Of the points that elements use; others may lie anywhere. Marks cost less than to look at a point once for
/// each element that has it.
Vector3 middle_of(const Mesh& mesh, int of_dimension)
{
    std::vector<std::uint8_t> is_used(mesh.points.size(), 0);
    for (const ElementBlock& b : mesh.blocks)
        if (dimension(b.kind) == of_dimension)
            for (const std::int32_t node : b.nodes) is_used[node] = 1;
    Vector3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = -low;
    for (std::size_t k = 0; k < is_used.size(); ++k)
        for (int i = 0; is_used[k] != 0 && i < 3; ++i) {
            low[i] = std::min(low[i], mesh.points[k][i]);
            high[i] = std::max(high[i], mesh.points[k][i]);
        }
    if (low[0] > high[0]) return {};
    return 0.5 * low + 0.5 * high;   // the sum might overflow
}

/// Cones from the middle to each face: for p homogeneous of degree k, int p dV = int p x . n dA / (3 + k).
void add_triangle(Sums::Terms& terms, const Vector3& a, const Vector3& b, const Vector3& c)
{
    // In closed form, for s = a + b + c: a . (b x c) (1, s / 4, (s s^T + a a^T + b b^T + c c^T) / 20) / 6.
    const double six = dot(a, cross(b, c));
    const Vector3 s = a + b + c;
    terms[0] += six;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        terms[1 + i] += six * s[i];
        terms[4 + i] += six * (s[i] * s[i] + a[i] * a[i] + b[i] * b[i] + c[i] * c[i]);
        terms[7 + i] += six * (s[i] * s[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
    }
}

/// What is rounded off between a few neighbours is as small as what is rounded in each: no carrying along.
void add_triangles(Sums& sums, const Mesh& mesh, const std::int32_t* first, const std::int32_t* last,
                   const Vector3& about)
{
    constexpr std::ptrdiff_t neighbours = 3 * 4;
    while (first != last) {
        const std::int32_t* const until = first + std::min(neighbours, last - first);
        Sums::Terms terms{};
        for (; first != until; first += 3)
            add_triangle(terms, mesh.points[first[0]] - about, mesh.points[first[1]] - about,
                         mesh.points[first[2]] - about);
        sums.add(terms);
    }
}

/// In the scales of triangles: int x . n dA is three times the volume, and so on.
void add_point(Sums& sums, const Vector3& x, double share)
{
    // The theorem divides by 3 + k for degree k; the scales of triangles are 6, 24 and 120, hence 2, 6 and
    // 24.
    const double first = 6 * share, second = 24 * share;
    sums.add({2 * share, first * x[0], first * x[1], first * x[2], second * x[0] * x[0], second * x[1] * x[1],
              second * x[2] * x[2], second * x[0] * x[1], second * x[1] * x[2], second * x[2] * x[0]});
}

void add_face(Sums& sums, const Mesh& mesh, ElementKind kind, const std::int32_t* nodes, const Vector3& about)
{
    for (const ShapeValues& point : quadrature_of(kind)) {
        const ElementPoint at = element_point(point, mesh, kind, nodes, about);
        add_point(sums, at.x, point.weight * dot(at.x, cross(at.F.column(0), at.F.column(1))));
    }
}

/// Parts of fixed size are summed by themselves: the sum does not depend on the number of threads.
constexpr std::size_t part_size = 65536;

Moments moments_of_surface(const Mesh& mesh)
{
    const Vector3 middle = middle_of(mesh, 2);
    Sums sums;
    for (const ElementBlock& b : mesh.blocks) {
        if (dimension(b.kind) != 2) continue;
        std::vector<Sums> of_parts(b.size() / part_size + 1);
        in_parts(b.size(), part_size, [&](std::size_t begin, std::size_t end, int part) {
            if (b.kind == ElementKind::triangle)
                return add_triangles(of_parts[part], mesh, b.nodes.data() + 3 * begin,
                                     b.nodes.data() + 3 * end, middle);
            for (std::size_t e = begin; e < end; ++e)
                add_face(of_parts[part], mesh, b.kind, b.element(static_cast<std::int64_t>(e)), middle);
        });
        // Parts are added in their order, so the bits do not depend on the number of threads.
        for (const Sums& of_part : of_parts) sums.add(of_part);
    }
    return sums.moments(middle, {1. / 6, 1. / 24, 1. / 120});
}

}   // namespace

Moments moments(const Mesh& mesh)
{
    if (!mesh.is_volume()) return moments_of_surface(mesh);
    const std::vector<Moments> parts = region_moments(mesh);
    const std::vector<double> ones(parts.size(), 1);
    return combined(parts, ones);
}

std::vector<Moments> region_moments(const Mesh& mesh)
{
    const Vector3 middle = middle_of(mesh, 3);
    std::vector<Sums> sums(mesh.regions.size());
    for (const ElementBlock& b : mesh.blocks) {
        if (dimension(b.kind) != 3) continue;
        for (std::int64_t e = 0; e < b.size(); ++e)
            for (const ShapeValues& point : quadrature_of(b.kind)) {
                const ElementPoint at = element_point(point, mesh, b.kind, b.element(e), middle);
                sums[b.regions[e]].add(at.x, point.weight * determinant(at.F));
            }
    }
    std::vector<Moments> all;
    for (const Sums& sum : sums) all.push_back(sum.moments(middle, {1, 1, 1}));
    return all;
}

Moments combined(std::span<const Moments> parts, std::span<const double> weights)
{
    assert(parts.size() == weights.size());
    Moments whole;
    Vector3 about{}, off{};   // about the first part, so that a far place costs no digits
    for (std::size_t k = parts.size(); k-- > 0;)
        if (parts[k].volume != 0) about = parts[k].centroid;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        whole.volume += weights[k] * parts[k].volume;
        if (parts[k].volume != 0) off += weights[k] * parts[k].volume * (parts[k].centroid - about);
    }
    off *= 1 / whole.volume;
    whole.centroid = about + off;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        if (parts[k].volume == 0) continue;
        const Vector3 d = parts[k].centroid - about - off;
        whole.second += weights[k] * (parts[k].second + parts[k].volume * outer(d, d));
    }
    return whole;
}

Moments scaled(const Moments& m, double length)
{
    const double area = length * length, volume = area * length;
    return {volume * m.volume, length * m.centroid, area * volume * m.second};
}

Moments moved(const Moments& m, const Matrix3& rotation, const Vector3& displacement)
{
    return {m.volume, rotation * m.centroid + displacement, rotation * m.second * transpose(rotation)};
}

}   // namespace livens
