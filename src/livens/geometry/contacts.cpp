// SPDX-License-Identifier: BSD-3-Clause
// Faces that touch or cross where they share no corner: pairs by a tree of boxes along a space-filling curve,
// then separating directions.
#include <algorithm>
#include <array>
#include <cmath>

#include "livens/geometry/detail/facets.h"

namespace livens {

namespace {

constexpr int leaf = 4;                     // triangles
constexpr double touch = 1e-13;             // gaps below it, relative to the pair's size, are none
constexpr std::int64_t most_pairs = 3000;   // looked at a triangle: more are no surface of a part

struct Box {
    std::array<float, 3> low, high;

    bool meets(const Box& other) const
    {
        bool meets = true;
        for (int i = 0; i < 3; ++i) meets = meets && low[i] <= other.high[i] && other.low[i] <= high[i];
        return meets;
    }
    void add(const Box& other)
    {
        for (int i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], other.low[i]);
            high[i] = std::max(high[i], other.high[i]);
        }
    }
};

struct Triangle {
    std::array<std::int32_t, 3> corners;
    std::int32_t face;
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
        double low_a = HUGE_VAL, high_a = -HUGE_VAL, low_b = HUGE_VAL, high_b = -HUGE_VAL, size = 0;
        const auto widen = [&](const Vector3& p, double& low, double& high) {
            const double x = dot(n, p);
            low = std::min(low, x);
            high = std::max(high, x);
            size = std::max(size, dot(p, p));
        };
        for (int i = n_shared_; i < 3; ++i) {
            widen(a_[i], low_a, high_a);
            widen(b_[i], low_b, high_b);
        }
        const double gap = touch * std::sqrt(size * dot(n, n));
        if (n_shared_ == 0) return low_b - high_a > gap || low_a - high_b > gap;
        // Common corners lie at 0, if there is one; with a common edge so must the direction.
        if (n_shared_ == 2 && std::abs(dot(n, a_[1])) > gap) return false;
        const bool is_below = (high_a < -gap && low_b >= -gap) || (high_a <= gap && low_b > gap);
        const bool is_above = (high_b < -gap && low_a >= -gap) || (high_b <= gap && low_a > gap);
        return is_below || is_above;
    }

    std::array<Vector3, 3> a_, b_;
    int n_shared_ = 0;
};

class Contacts {
public:
    explicit Contacts(const Facets& f) : points_(f.mesh->points)
    {
        std::vector<Triangle> triangles;
        triangles.reserve(f.n_faces());
        for (std::int32_t face = 0; face < f.n_faces(); ++face)
            for (std::int32_t h = f.begins[face] + 1; h + 1 < f.begins[face + 1]; ++h)
                triangles.push_back({{f.corners[f.begins[face]], f.corners[h], f.corners[h + 1]}, face});
        sort(triangles);
        make_tree();
    }

    /// The first pair that touches; {-1, -1} if there is none, {0, 0} if there are too many to look at.
    std::pair<std::int32_t, std::int32_t> find()
    {
        left_ = 1'000'000 + most_pairs * static_cast<std::int64_t>(triangles_.size());
        inside(1);
        return found_;
    }

private:
    Box box_of(const Triangle& t) const
    {
        Box box;
        for (int i = 0; i < 3; ++i) {
            double low = points_[t.corners[0]][i], high = low;
            for (const std::int32_t c : t.corners) {
                low = std::min(low, points_[c][i]);
                high = std::max(high, points_[c][i]);
            }
            // To floats outwards, about the middle of all and in units of its size.
            box.low[i] = std::nextafter(static_cast<float>((low - middle_[i]) * scale_), -HUGE_VALF);
            box.high[i] = std::nextafter(static_cast<float>((high - middle_[i]) * scale_), HUGE_VALF);
        }
        return box;
    }

    /// Along a curve that fills space [Morton 1966].
    void sort(const std::vector<Triangle>& triangles)
    {
        Vector3 low = points_[triangles[0].corners[0]], high = low;
        for (const Triangle& t : triangles)
            for (const std::int32_t c : t.corners)
                for (int i = 0; i < 3; ++i) {
                    low[i] = std::min(low[i], points_[c][i]);
                    high[i] = std::max(high[i], points_[c][i]);
                }
        middle_ = 0.5 * low + 0.5 * high;
        const Vector3 half = 0.5 * high - 0.5 * low;
        const double size = std::max({half[0], half[1], half[2]});
        scale_ = size > 0 ? 1 / size : 1;
        std::vector<std::pair<std::uint32_t, std::int32_t>> order(triangles.size());
        for (std::size_t k = 0; k < triangles.size(); ++k) {
            const Vector3& p = points_[triangles[k].corners[0]];
            std::uint32_t code = 0;
            for (int i = 0; i < 3; ++i)
                code |= spread(static_cast<std::uint32_t>(511.5 * (1 + (p[i] - middle_[i]) * scale_))) << i;
            order[k] = {code, static_cast<std::int32_t>(k)};
        }
        std::sort(order.begin(), order.end());
        triangles_.reserve(triangles.size());
        boxes_.reserve(triangles.size());
        for (const auto& [code, k] : order) {
            triangles_.push_back(triangles[k]);
            boxes_.push_back(box_of(triangles[k]));
        }
    }

    /// A full binary tree in one array: node k has the nodes 2 k and 2 k + 1, leaves are the last level.
    void make_tree()
    {
        const std::size_t n = (triangles_.size() + leaf - 1) / leaf;
        n_leaves_ = 1;
        while (n_leaves_ < n) n_leaves_ *= 2;
        constexpr Box nothing{{2, 2, 2}, {-2, -2, -2}};
        tree_.assign(2 * n_leaves_, nothing);
        for (std::size_t k = 0; k < boxes_.size(); ++k) tree_[n_leaves_ + k / leaf].add(boxes_[k]);
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
        between(2 * k, 2 * k + 1);
    }

    void between(std::size_t k, std::size_t l)   // of one level
    {
        if (is_done() || !tree_[k].meets(tree_[l])) return;
        if (--left_ < 0) found_ = {0, 0};
        if (k >= n_leaves_) return look(k, l);
        for (const std::size_t i : {2 * k, 2 * k + 1})
            for (const std::size_t j : {2 * l, 2 * l + 1}) between(i, j);
    }

    void look(std::size_t k, std::size_t l)
    {
        const std::size_t first = leaf * (k - n_leaves_), other = leaf * (l - n_leaves_),
                          n = triangles_.size();
        for (std::size_t i = first; i < std::min(first + leaf, n); ++i)
            for (std::size_t j = k == l ? i + 1 : other; j < std::min(other + leaf, n); ++j) {
                if (!boxes_[i].meets(boxes_[j])) continue;
                if (--left_ < 0) found_ = {0, 0};
                const Triangle &a = triangles_[i], &b = triangles_[j];
                if (a.face != b.face && !Pair(points_, a, b).is_apart()) found_ = std::minmax(a.face, b.face);
                if (is_done()) return;
            }
    }

    const std::vector<Vector3>& points_;
    std::vector<Triangle> triangles_;
    std::vector<Box> boxes_, tree_;
    std::size_t n_leaves_ = 1;
    Vector3 middle_{};
    double scale_ = 1;
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
