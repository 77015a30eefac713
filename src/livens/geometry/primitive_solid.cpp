// SPDX-License-Identifier: BSD-3-Clause
// Moments and surface integrals of boxes and round solids without a mesh, by Gauss points in coordinates of
// their own: theory.md, "Bodies from meshes", Primitives. Densities may be fields; parts on which two rules
// do not agree are divided.
#include "livens/geometry/primitive_solid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "livens/base/elementary.h"
#include "livens/base/text.h"
#include "livens/geometry/detail/weighing.h"
#include "livens/time/quadrature.h"

namespace livens {

namespace {

constexpr double quarter = std::numbers::pi / 2;
constexpr int turns = 4;

const Quadrature& rule_at(std::size_t level)
{
    static const std::array<Quadrature, finer.size()> rules{gauss(finer[0]), gauss(finer[1]), gauss(finer[2]),
                                                            gauss(finer[3]), gauss(finer[4])};
    return rules[level];
}

/// A point of a profile, and its derivatives by the piece's own coordinate from 0 to 1.
struct ProfilePoint {
    double r = 0, z = 0, dr = 0, dz = 0;
};
ProfilePoint profile_point(const PrimitiveSolid::Piece& piece, double s)
{
    const auto [r0, z0] = piece.from;
    const auto [r1, z1] = piece.to;
    if (!piece.is_arc) return {r0 + s * (r1 - r0), z0 + s * (z1 - z0), r1 - r0, z1 - z0};
    // An arc has the angle for its coordinate: by height the radius would be a root at the pole, which no
    // rule integrates well.
    const auto [sine, cosine] = sine_cosine(quarter * s);
    if (r0 == 0)   // from the pole below
        return {r1 * sine, z1 - (z1 - z0) * cosine, quarter * r1 * cosine, quarter * (z1 - z0) * sine};
    return {r0 * cosine, z0 + (z1 - z0) * sine, -quarter * r0 * sine, quarter * (z1 - z0) * cosine};
}

Vector3 stretched(const Vector3& stretch, const Vector3& p)
{
    return {stretch[0] * p[0], stretch[1] * p[1], stretch[2] * p[2]};
}
double product(const Vector3& v) { return v[0] * v[1] * v[2]; }

/// A line through the solid from its beginning, at 0, to its end, at 1; and how much larger volumes are along
/// it than in the cube [0, 1]^3 of coordinates.
struct Ray {
    Vector3 start{}, along{};
    double larger = 0, growth = 0;
};

/// The solid in coordinates of its own: edges, or height along a piece of the profile, distance from the bore
/// to it, and angle over a quarter of the turn.
class Cells {
public:
    explicit Cells(const PrimitiveSolid& solid) : solid_(solid)
    {
        for (const PrimitiveSolid::Piece& piece : solid.profile)
            for (int turn = 0; turn < turns; ++turn)
                if (piece.to[1] > piece.from[1]) pieces_.push_back({&piece, turn});
    }
    std::size_t size() const { return solid_.profile.empty() ? 1 : pieces_.size(); }
    /// Two of the coordinates are fixed: the edges d1 and d3; height and angle.
    Ray ray(std::size_t cell, double u, double v) const
    {
        const Vector3& stretch = solid_.stretch;
        if (solid_.profile.empty())
            return {stretched(stretch, {u - 0.5, -0.5, v - 0.5}), {0, stretch[1], 0}, product(stretch), 0};
        const auto& [piece, turn] = pieces_[cell];
        const ProfilePoint p = profile_point(*piece, u);
        // dV = det A r (R - r0) z' ds du dphi, with the quarter of the turn as Jacobian of the angle; r is
        // linear in u, hence two factors.
        const double wide = p.r - solid_.bore, factor = quarter * wide * p.dz * product(stretch);
        const auto [sine, cosine] = sine_cosine(quarter * (turn + v));
        return {stretched(stretch, {solid_.bore * cosine, solid_.bore * sine, p.z}),
                stretched(stretch, {wide * cosine, wide * sine, 0}), factor * solid_.bore, factor * wide};
    }

private:
    struct Quarter {
        const PrimitiveSolid::Piece* piece;
        int turn;
    };
    const PrimitiveSolid& solid_;
    std::vector<Quarter> pieces_;
};

/// A box in the coordinates of a cell.
struct Part {
    Vector3 low{};
    double edge = 1;
    int n_divided = 0;
};

/// In two along each coordinate.
template <class Use>
void for_each_half(const Part& part, const Use& use)
{
    for (int k = 0; k < 8; ++k) {
        Part half{part.low, 0.5 * part.edge, part.n_divided + 1};
        for (int i = 0; i < 3; ++i) half.low[i] += (k >> i & 1) * half.edge;
        use(half);
    }
}

class Weighing {
public:
    Weighing(const PrimitiveSolid& solid, const std::function<double(const Vector3&)>& density)
        : cells_(solid), density_(density)
    {
        for (std::size_t c = 0; c < cells_.size(); ++c)
            for (const double u : {0., 0.5, 1.})
                for (const double v : {0., 0.5, 1.}) {
                    const Ray ray = cells_.ray(c, u, v);
                    length_ = std::max(length_, norm(ray.start + ray.along));
                }
    }

    Moments result()
    {
        for (std::size_t c = 0; c < cells_.size(); ++c)
            // A first coarse sum of the whole, to which parts are compared: a part without mass has no
            // relative error of its own.
            for_each_half({}, [&](const Part& part) { size_ += at_level(c, part, 0).size; });
        for (std::size_t c = 0; c < cells_.size(); ++c)
            for_each_half({}, [&](const Part& part) { add(c, part); });
        if (is_unsure())
            refuse_density(
                "the density changes too fast: more than " + to_text(unsure_sums) +
                    " of the mass is not known",
                "", "unite parts, each with the density that it has, or give a mesh with elements of volume");
        return about_centroid(whole_, {});
    }

private:
    Sums at_level(std::size_t cell, const Part& part, std::size_t level)
    {
        const auto& [points, weights] = rule_at(level);
        n_points_ += points.size() * points.size() * points.size();
        const double volume = part.edge * part.edge * part.edge;
        Sums sums;
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t k = 0; k < points.size(); ++k) {
                const Ray ray = cells_.ray(cell, part.low[0] + part.edge * points[i],
                                           part.low[2] + part.edge * points[k]);
                for (std::size_t j = 0; j < points.size(); ++j) {
                    const double u = part.low[1] + part.edge * points[j];
                    const Vector3 x = ray.start + u * ray.along;
                    sums.add(x, volume * weights[i] * weights[j] * weights[k] *
                                    (ray.larger + u * ray.growth) * checked_density(density_(x), x, 0));
                }
            }
        return sums;
    }

    bool is_unsure() const { return missing_ > unsure_sums * size_; }

    void add(std::size_t cell, const Part& part)
    {
        if (is_unsure()) return;
        const Settled found =
            settled(length_, [&](std::size_t level) { return at_level(cell, part, level); });
        if (found.gap <= same_sums * std::max(found.sums.size, 1e-3 * size_)) return whole_.add(found.sums);
        if (part.n_divided < most_divided && n_points_ < most_points)
            return for_each_half(part, [&](const Part& half) { add(cell, half); });
        missing_ += found.gap;
        whole_.add(found.sums);
    }

    static constexpr int most_divided = 3;
    static constexpr std::size_t most_points = 4'000'000;   // a second or two
    Cells cells_;
    const std::function<double(const Vector3&)>& density_;
    std::size_t n_points_ = 0;
    double length_ = 0, size_ = 0, missing_ = 0;
    Sums whole_;
};

/// (1, x) (1, x)^T over the surface that a piece of the profile sweeps in a quarter of the turn: the normal
/// is that before stretching times the cofactors.
class Area {
public:
    Area(const PrimitiveSolid& solid, const PrimitiveSolid::Piece& piece) : solid_(solid), piece_(piece) {}

    Matrix4 whole()
    {
        for (int turn = 0; turn < turns; ++turn) add(turn, Field());
        return sum_;
    }

private:
    /// Along the piece of the profile, and round the axis.
    struct Field {
        std::array<double, 2> low{0, 0}, edge{1, 1};
        int n_divided = 0;
    };

    Matrix4 at_levels(int turn, const Field& field, std::size_t along, std::size_t round) const
    {
        const Vector3& stretch = solid_.stretch;
        const Quadrature &rule = rule_at(along), &turned = rule_at(round);
        Matrix4 sum{};
        for (std::size_t i = 0; i < rule.points.size(); ++i) {
            const ProfilePoint p = profile_point(piece_, field.low[0] + field.edge[0] * rule.points[i]);
            for (std::size_t k = 0; k < turned.points.size(); ++k) {
                const auto [sine, cosine] =
                    sine_cosine(quarter * (turn + field.low[1] + field.edge[1] * turned.points[k]));
                // n dA = cof A (z' cos, z' sin, -R') R ds dphi: normals stretch by the cofactors, not by A.
                const Vector3 normal{stretch[1] * stretch[2] * p.dz * cosine,
                                     stretch[2] * stretch[0] * p.dz * sine, -stretch[0] * stretch[1] * p.dr};
                const Vector4 at = point(stretched(stretch, {p.r * cosine, p.r * sine, p.z}));
                sum += rule.weights[i] * turned.weights[k] * quarter * p.r * norm(normal) * outer(at, at);
            }
        }
        return field.edge[0] * field.edge[1] * sum;
    }

    /// The largest, each entry in its own unit.
    static double gap(const Matrix4& a, const Matrix4& b)
    {
        double gap = 0;
        for (int i = 0; i < 4; ++i) gap = std::max(gap, std::abs(a(i, i) - b(i, i)) / b(i, i));
        return gap;
    }

    void add(int turn, const Field& field)
    {
        constexpr std::size_t finest = finer.size() - 1;
        Matrix4 found = at_levels(turn, field, 1, 1);
        for (std::size_t level = 2; level <= finest; ++level) {
            const Matrix4 better = at_levels(turn, field, level, level);
            const bool is_same = gap(found, better) <= same_sums;
            found = better;
            if (is_same || (level == finest && field.n_divided == most_divided)) {
                sum_ += found;
                return;
            }
        }
        // In two, where a coarser rule makes more of a difference.
        const int which =
            // Flat ellipsoids bend along the profile alone. Dividing both directions would square the number
            // of points.
            gap(at_levels(turn, field, 1, finest), found) > gap(at_levels(turn, field, finest, 1), found) ? 0
                                                                                                          : 1;
        Field half = field;
        half.edge[which] *= 0.5;
        ++half.n_divided;
        add(turn, half);
        half.low[which] += half.edge[which];
        add(turn, half);
    }

    static constexpr int most_divided = 16;
    const PrimitiveSolid& solid_;
    const PrimitiveSolid::Piece& piece_;
    Matrix4 sum_{};
};

/// A pair of sides across each edge.
Matrix4 area_of_box(const Vector3& edges)
{
    Matrix4 area{};
    for (int i = 0; i < 3; ++i) {
        const double both = 2 * product(edges) / edges[i];
        area(0, 0) += both;
        // Squares of the coordinate over a pair of sides: at distance half an edge across, a twelfth of the
        // edge along.
        for (int j = 0; j < 3; ++j) area(j + 1, j + 1) += both * edges[j] * edges[j] / (i == j ? 4 : 12);
    }
    return area;
}

}   // namespace

PrimitiveSolid box_solid(const Vector3& edges) { return {{}, 0, edges}; }

PrimitiveSolid ellipsoid_solid(const Vector3& semi_axes)
{
    return {{{{0, -1}, {1, 0}, true}, {{1, 0}, {0, 1}, true}}, 0, semi_axes};
}

PrimitiveSolid cylinder_solid(double radius, double length, double inner_radius)
{
    const double r = inner_radius, h = 0.5 * length;
    PrimitiveSolid tube{
        {{{r, -h}, {radius, -h}}, {{radius, -h}, {radius, h}}, {{radius, h}, {r, h}}}, r, {1, 1, 1}};
    if (r > 0) tube.profile.push_back({{r, h}, {r, -h}});
    return tube;
}

PrimitiveSolid capsule_solid(double radius, double length)
{
    const double h = 0.5 * length;
    return {{{{0, -h - radius}, {radius, -h}, true},
             {{radius, -h}, {radius, h}},
             {{radius, h}, {0, h + radius}, true}},
            0,
            {1, 1, 1}};
}

PrimitiveSolid cone_solid(double radius, double height)
{
    const double low = -0.25 * height, high = 0.75 * height;
    return {{{{0, low}, {radius, low}}, {{radius, low}, {0, high}}}, 0, {1, 1, 1}};
}

Moments weighted_moments(const PrimitiveSolid& solid, const std::function<double(const Vector3&)>& density)
{
    return Weighing(solid, density).result();
}

SurfaceMoments surface_moments(const PrimitiveSolid& solid, const Moments& whole)
{
    SurfaceMoments m;
    if (solid.profile.empty()) m.area = area_of_box(solid.stretch);
    for (const PrimitiveSolid::Piece& piece : solid.profile) m.area += Area(solid, piece).whole();
    for (int i = 0; i < 3; ++i) {
        Matrix4& normal = m.normal[i];
        // Divergence theorem: int n_i (1, x)(1, x)^T dA = int d/dx_i of it, so one pressure gives no force to
        // the last bit.
        normal(0, i + 1) = normal(i + 1, 0) = whole.volume;
        for (int j = 0; j < 3; ++j) {
            normal(i + 1, j + 1) += whole.volume * whole.centroid[j];
            normal(j + 1, i + 1) += whole.volume * whole.centroid[j];
        }
    }
    return m;
}

}   // namespace livens
