// SPDX-License-Identifier: BSD-3-Clause
// Faces that touch or cross where they share no corner: pairs by a tree of boxes along a space-filling curve,
// then separating directions.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "livens/geometry/detail/facets.h"

namespace livens {

namespace {

constexpr int leaf = 8;                     // triangles
constexpr double touch = 1e-13;             // gaps below it, relative to the pair's size, are none
constexpr std::int64_t most_pairs = 3000;   // looked at a triangle: more are no surface of a part

/// Three numbers of 20 bits each, with a bit between them that is free.
using Packed = std::uint64_t;
constexpr int lane = 21;
constexpr Packed lane_mask = (Packed{1} << 20) - 1;
constexpr Packed guards = Packed{1} << 20 | Packed{1} << 41 | Packed{1} << 62;
constexpr Packed ones = Packed{1} | Packed{1} << 21 | Packed{1} << 42;

/// Free bits of the numbers of a that are not below those of b.
Packed not_below(Packed a, Packed b) { return ((a | guards) - b) & guards; }
/// Those of a where the free bit is set, else those of b.
Packed select(Packed free_bits, Packed a, Packed b)
{
    const Packed mask = free_bits - (free_bits >> 20);
    return (a & mask) | (b & ~mask);
}

/// In units of a millionth of the surface's size.
struct Box {
    Packed low, high;

    bool meets(const Box& other) const
    {
        return (not_below(other.high, low) & not_below(high, other.low)) == guards;
    }
    void add(const Box& other)
    {
        low = select(not_below(low, other.low), other.low, low);
        high = select(not_below(high, other.high), high, other.high);
    }
};

struct Triangle {
    std::array<std::int32_t, 3> corners;
    std::int32_t face;
};

/// At which points the triangles are known to lie beside each other like the slices of a cake: seen along
/// one direction all turn the same way, and go round once. Then those that share such a point have nothing
/// else in common. The others are looked at pair by pair.
class Fans {
public:
    Fans(const std::vector<Vector3>& points, const std::vector<Triangle>& triangles)
        : points_(points), axes_(points.size()), state_(points.size(), 0)
    {
        for (const Triangle& t : triangles) {
            const Vector3& p = points[t.corners[0]];
            const Vector3 n = cross(points[t.corners[1]] - p, points[t.corners[2]] - p);
            for (const std::int32_t c : t.corners) axes_[c] += n;
        }
        for (const Triangle& t : triangles) {
            const Vector3& p = points[t.corners[0]];
            const Vector3 n = cross(points[t.corners[1]] - p, points[t.corners[2]] - p);
            for (int i = 0; i < 3; ++i)
                add(t.corners[i], n, points[t.corners[(i + 1) % 3]], points[t.corners[(i + 2) % 3]]);
        }
    }

    bool is_known(std::int32_t point) const { return state_[point] == 1; }

private:
    static constexpr std::uint8_t unknown = 2;   // and beyond: more than once round

    /// A triangle with the normal n (not of unit length), from the edge to a to the edge to b.
    void add(std::int32_t at, const Vector3& n, const Vector3& a, const Vector3& b)
    {
        std::uint8_t& state = state_[at];
        if (state >= unknown) return;
        const Vector3& axis = axes_[at];
        const Vector3 u = a - points_[at], v = b - points_[at];
        const double turn = dot(n, axis), nn = dot(n, n);
        // More than 3 degrees from being seen edgewise, and no needle: far from where rounding decides.
        const bool is_clear =
            turn > 0 && turn * turn > 2.5e-3 * nn * dot(axis, axis) && nn > 1e-10 * dot(u, u) * dot(v, v);
        if (!is_clear) {
            state = unknown;
            return;
        }
        // All go round once if one of them passes the half-line with y = 0 < x in axes across.
        const bool is_steep = std::abs(axis[2]) > std::abs(axis[0]);
        const double y_u = is_steep ? axis[2] * u[1] - axis[1] * u[2] : axis[0] * u[1] - axis[1] * u[0];
        const double y_v = is_steep ? axis[2] * v[1] - axis[1] * v[2] : axis[0] * v[1] - axis[1] * v[0];
        if (y_u <= 0 && y_v > 0) ++state;
    }

    const std::vector<Vector3>& points_;
    std::vector<Vector3> axes_;
    std::vector<std::uint8_t> state_;   ///< how often round, or unknown
};

/// Every third bit.
std::uint32_t spread(std::uint32_t x)
{
    x = (x | (x << 16)) & 0x030000ff;
    x = (x | (x << 8)) & 0x0300f00f;
    x = (x | (x << 4)) & 0x030c30c3;
    return (x | (x << 2)) & 0x09249249;
}

/// Whether two triangles have nothing in common but the corners that both have. Projections onto a direction
/// are of corners relative to the first one of `a`; `shared` are the leading corners of both that are the
/// same points.
class Pair {
public:
    Pair(const std::vector<Vector3>& points, const Triangle& a, const Triangle& b)
    {
        std::array<std::int32_t, 3> of_a = a.corners, of_b = b.corners;
        for (int i = 0; i < 3; ++i)
            for (int j = n_shared_; j < 3; ++j)
                if (of_a[i] == of_b[j] && i >= n_shared_) {
                    std::swap(of_a[i], of_a[n_shared_]);
                    std::swap(of_b[j], of_b[n_shared_]);
                    ++n_shared_;
                    break;
                }
        const Vector3 about = points[of_a[0]];
        for (int i = 0; i < 3; ++i) {
            a_[i] = points[of_a[i]] - about;
            b_[i] = points[of_b[i]] - about;
        }
        for (int i = n_shared_; i < 3; ++i) size_ = std::max({size_, dot(a_[i], a_[i]), dot(b_[i], b_[i])});
    }

    bool is_apart() const
    {
        if (n_shared_ == 3) return true;   // faces that stand twice are found by their edges
        const std::array<Vector3, 3> ea{a_[1] - a_[0], a_[2] - a_[1], a_[0] - a_[2]};
        const std::array<Vector3, 3> eb{b_[1] - b_[0], b_[2] - b_[1], b_[0] - b_[2]};
        const Vector3 na = cross(ea[0], ea[1]), nb = cross(eb[0], eb[1]);
        if (separates(na) || separates(nb)) return true;
        for (int i = 0; i < 3; ++i)
            if (separates(cross(ea[i], na)) || separates(cross(eb[i], nb))) return true;
        for (const Vector3& u : ea)
            for (const Vector3& v : eb)
                if (separates(cross(u, v))) return true;
        return false;
    }

private:
    bool separates(const Vector3& n) const
    {
        double low_a = HUGE_VAL, high_a = -HUGE_VAL, low_b = HUGE_VAL, high_b = -HUGE_VAL;
        const auto widen = [&](const Vector3& p, double& low, double& high) {
            const double x = dot(n, p);
            low = std::min(low, x);
            high = std::max(high, x);
        };
        for (int i = n_shared_; i < 3; ++i) {
            widen(a_[i], low_a, high_a);
            widen(b_[i], low_b, high_b);
        }
        if (n_shared_ == 0 && !(low_b > high_a || low_a > high_b)) return false;
        const double gap = touch * std::sqrt(size_ * dot(n, n));
        if (n_shared_ == 0) return low_b - high_a > gap || low_a - high_b > gap;
        // Common corners lie at 0, if there is one; with a common edge so must the direction.
        if (n_shared_ == 2 && std::abs(dot(n, a_[1])) > gap) return false;
        const bool is_below = (high_a < -gap && low_b >= -gap) || (high_a <= gap && low_b > gap);
        const bool is_above = (high_b < -gap && low_a >= -gap) || (high_b <= gap && low_a > gap);
        return is_below || is_above;
    }

    std::array<Vector3, 3> a_, b_;
    int n_shared_ = 0;
    double size_ = 0;   ///< squared: of the largest distance from the first corner of a
};

class Contacts {
public:
    explicit Contacts(const Facets& f) : Contacts(f, triangles_of(f)) {}

    /// The first pair that touches; {-1, -1} if there is none, {0, 0} if there are too many to look at.
    std::pair<std::int32_t, std::int32_t> find()
    {
        left_ = 1'000'000 + most_pairs * static_cast<std::int64_t>(triangles_.size());
        inside(1);
        return found_;
    }

private:
    Contacts(const Facets& f, const std::vector<Triangle>& triangles)
        : points_(f.mesh->points), fans_(f.mesh->points, triangles)
    {
        sort(triangles);
        make_tree();
    }

    static std::vector<Triangle> triangles_of(const Facets& f)
    {
        std::vector<Triangle> triangles;
        triangles.reserve(f.n_faces());
        for (std::int32_t face = 0; face < f.n_faces(); ++face)
            for (std::int32_t h = f.begins[face] + 1; h + 1 < f.begins[face + 1]; ++h)
                triangles.push_back({{f.corners[f.begins[face]], f.corners[h], f.corners[h + 1]}, face});
        return triangles;
    }

    /// Every coordinate is rounded down in the same way, so that what meets still does; a box is one unit
    /// larger above, for gaps that are as good as none.
    std::vector<Packed> pack(const std::vector<Triangle>& triangles) const
    {
        Vector3 low = points_[triangles[0].corners[0]], high = low;
        for (const Triangle& t : triangles)
            for (const std::int32_t c : t.corners)
                for (int i = 0; i < 3; ++i) {
                    low[i] = std::min(low[i], points_[c][i]);
                    high[i] = std::max(high[i], points_[c][i]);
                }
        const Vector3 half = 0.5 * high - 0.5 * low;
        constexpr double most = lane_mask - 2;   // what is nothing meets nothing
        const double units = most / std::max({half[0], half[1], half[2]}),
                     scale = std::isfinite(units) ? units : 0;
        std::vector<Packed> packed(points_.size());
        for (std::size_t k = 0; k < packed.size(); ++k)
            for (int i = 0; i < 3; ++i) {   // points of no triangle may lie outside
                const double x = std::clamp((0.5 * points_[k][i] - 0.5 * low[i]) * scale, 0., most);
                packed[k] |= static_cast<Packed>(x) << (lane * i);
            }
        return packed;
    }

    /// Along a curve that fills space [Morton 1966].
    void sort(const std::vector<Triangle>& triangles)
    {
        const std::vector<Packed> packed = pack(triangles);
        const std::size_t n = triangles.size();
        const auto box_of = [&](const Triangle& t) {
            Box box{packed[t.corners[0]], packed[t.corners[0]]};
            for (int i = 1; i < 3; ++i) box.add({packed[t.corners[i]], packed[t.corners[i]]});
            return Box{box.low, box.high + ones};
        };
        std::vector<std::uint64_t> order(n), other(n);   // place on the curve, number of the triangle
        std::array<std::array<std::uint32_t, 1024>, 3> begins{};
        for (std::size_t k = 0; k < n; ++k) {
            const Box box = box_of(triangles[k]);
            const Packed twice = box.low + (box.high - ones);
            std::uint64_t code = 0;
            for (int i = 0; i < 3; ++i)
                code |= spread(static_cast<std::uint32_t>(twice >> (lane * i + 11)) & 1023) << i;
            order[k] = code << 32 | k;
            for (int pass = 0; pass < 3; ++pass) ++begins[pass][code >> (10 * pass) & 1023];
        }
        for (int pass = 0; pass < 3; ++pass) {   // by digits, the lowest first
            std::uint32_t begin = 0;
            for (std::uint32_t& count : begins[pass]) begin += std::exchange(count, begin);
            for (const std::uint64_t item : order)
                other[begins[pass][item >> (32 + 10 * pass) & 1023]++] = item;
            order.swap(other);
        }
        triangles_.reserve(n);
        boxes_.reserve(n);
        for (const std::uint64_t item : order) {
            triangles_.push_back(triangles[item & 0xffffffff]);
            boxes_.push_back(box_of(triangles_.back()));
        }
    }

    /// A full binary tree in one array: node k has the nodes 2 k and 2 k + 1, leaves are the last level.
    void make_tree()
    {
        const std::size_t n_triangles = boxes_.size(), n = (n_triangles + leaf - 1) / leaf;
        n_leaves_ = 1;
        while (n_leaves_ < n) n_leaves_ *= 2;
        constexpr Box nothing{lane_mask * ones, 0};
        tree_.assign(2 * n_leaves_, nothing);
        boxes_.resize(n_leaves_ * leaf, nothing);
        for (std::size_t k = 0; k < n_triangles; ++k) tree_[n_leaves_ + k / leaf].add(boxes_[k]);
        for (std::size_t k = n_leaves_; k-- > 1;) {
            tree_[k] = tree_[2 * k];
            tree_[k].add(tree_[2 * k + 1]);
        }
    }

    bool is_done() const { return found_.first >= 0; }

    void inside(std::size_t k)
    {
        if (is_done()) return;
        if (k >= n_leaves_) return look(k, k);
        inside(2 * k);
        inside(2 * k + 1);
        if (tree_[2 * k].meets(tree_[2 * k + 1])) between(2 * k, 2 * k + 1);
    }

    void between(std::size_t k, std::size_t l)   // that meet, of one level
    {
        if (is_done()) return;
        if (--left_ < 0) found_ = {0, 0};
        if (k >= n_leaves_) return look(k, l);
        for (const std::size_t i : {2 * k, 2 * k + 1}) {
            if (!tree_[i].meets(tree_[l])) continue;
            for (const std::size_t j : {2 * l, 2 * l + 1})
                if (tree_[i].meets(tree_[j])) between(i, j);
        }
    }

    /// Which boxes of a leaf meet one: bits. Without branches, as none of them can be foreseen.
    unsigned met(const Box& box, std::size_t first) const
    {
        unsigned bits = 0;
        for (int j = 0; j < leaf; ++j) bits |= static_cast<unsigned>(box.meets(boxes_[first + j])) << j;
        return bits;
    }

    void look(std::size_t k, std::size_t l)
    {
        const std::size_t first = leaf * (k - n_leaves_), other = leaf * (l - n_leaves_);
        for (unsigned rows = met(tree_[l], first); rows != 0; rows &= rows - 1) {
            const std::size_t i = first + std::countr_zero(rows);
            unsigned met = this->met(boxes_[i], other);
            if (k == l) met &= ~1u << (i - other);
            if (met == 0) continue;
            std::array<std::int32_t, 3> known = triangles_[i].corners;
            for (std::int32_t& c : known)
                if (!fans_.is_known(c)) c = -1;
            for (; met != 0 && !is_done(); met &= met - 1) {
                if (--left_ < 0) found_ = {0, 0};
                look_at(triangles_[i], known, triangles_[other + std::countr_zero(met)]);
            }
        }
    }

    /// `known`: corners of a that nothing else need be asked about.
    void look_at(const Triangle& a, const std::array<std::int32_t, 3>& known, const Triangle& b)
    {
        bool shares = false;
        for (const std::int32_t c : known)
            for (const std::int32_t d : b.corners) shares |= c == d;
        if (!shares && a.face != b.face && !Pair(points_, a, b).is_apart())
            found_ = std::minmax(a.face, b.face);
    }

    const std::vector<Vector3>& points_;
    Fans fans_;
    std::vector<Triangle> triangles_;
    std::vector<Box> boxes_, tree_;
    std::size_t n_leaves_ = 1;
    std::int64_t left_ = 0;
    std::pair<std::int32_t, std::int32_t> found_{-1, -1};
};

}   // namespace

void check_contacts(const Facets& f, std::vector<Complaint>& faults)
{
    const auto [a, b] = Contacts(f).find();
    if (a < 0) return;
    const std::string& name = f.mesh->name;
    if (a == b)
        faults.push_back({"mesh-self-contact", "",
                          name + ": the faces are too entangled to see whether they touch", "", "", "",
                          "export the part with shorter triangles"});
    else
        faults.push_back({"mesh-self-contact", "",
                          name + ": " + name_of_face(*f.mesh, a) + " and " + name_of_face(*f.mesh, b) +
                              " touch or cross, near " + text_of(f.at(f.begins[a])),
                          "", "", "where a surface meets itself, inside and outside are not told apart",
                          "separate or unite what meets there"});
}

}   // namespace livens
