// SPDX-License-Identifier: BSD-3-Clause
// Faces that touch or cross where they share no corner: pairs by a tree of boxes along a space-filling curve,
// then separating directions.
// theory.md, "Bodies from meshes", Is it a solid? For convex sets such as triangles the normals, the normals
// of edges in the planes and the products of edges suffice as directions (separating axes).
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <utility>

#include "livens/geometry/detail/box_tree.h"
#include "livens/geometry/detail/facets.h"
#include "livens/geometry/detail/workers.h"

namespace livens::inline geometry_internal {

namespace {

constexpr double touch = 1e-13;             // gaps below it, relative to the pair's size, are none
constexpr std::int64_t some_pairs = 4096;   // after which a thread tells the others
constexpr std::size_t few_leaves = 1024;    // below it threads are not worth their while
constexpr std::int64_t many_pairs = 100;    // boxes that meet, a triangle: most surfaces have a tenth of it
constexpr std::int64_t most_pairs =
    3000;   // more are no surface of a part; of slanted needles there are as many

/// Whether two triangles have nothing in common but the corners that both have. Projections onto a direction
/// are of corners relative to the first one of `a`; `shared` are the leading corners of both that are the
/// same points.
class Pair {
public:
    Pair(const std::vector<Vector3>& points, Four a, Four b)
    {
        std::array<std::int32_t, 3> of_a{a[0], a[1], a[2]}, of_b{b[0], b[1], b[2]};
        for (int i = 0; i < 3; ++i)
            for (int j = n_shared_; j < 3; ++j)
                if (of_a[i] == of_b[j] && i >= n_shared_) {
                    std::swap(of_a[i], of_a[n_shared_]);
                    std::swap(of_b[j], of_b[n_shared_]);
                    ++n_shared_;
                    break;
                }
        // Differences of near corners are exact or nearly so; far from the origin products of coordinates are
        // not.
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
        // The order is by chance of success: nearly all pairs are told apart by one of the two planes.
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
        // Inequality: gap along n > 1e-13 |n| times the pair's size. Shared corners have gap zero by
        // construction.
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

/// The pairs of boxes of one level of a tree that meet, or one with itself: what is looked at in one go.
struct Task {
    std::size_t k, l;
    std::int64_t n_pairs = 0;   ///< of boxes that meet
    std::pair<std::int32_t, std::int32_t> found{-1, -1};
};

class Contacts {
public:
    Contacts(const Facets& f, const Triangles& triangles, const Rings& rings)
        : points_(f.mesh->points), directions_(rings.directions), tree_(points_, triangles, rings),
          many_(limit(triangles, many_pairs)), most_(most(triangles))
    {
        tree_.leave_out(lone_sheets(tree_, points_));
    }
    static std::int64_t most(const Triangles& triangles) { return limit(triangles, most_pairs); }
    static std::int64_t limit(const Triangles& triangles, std::int64_t each)
    {
        return 1'000'000 + each * static_cast<std::int64_t>(triangles.corners.size() / 3);
    }

    /// The first pair that touches; {-1, -1} if there is none, {0, 0} if there are too many to look at. They
    /// are counted before, where they are many; the first of them are looked at all the same, for whoever
    /// made the mesh wants to hear of a place.
    std::pair<std::int32_t, std::int32_t> find()
    {
        std::vector<Task> tasks;
        divide(tasks, 1, 1, tree_.n_leaves < few_leaves ? 0 : 6);
        // Nearly every surface ends here. Only where boxes meet too often are the pairs counted before they
        // are looked at.
        if (run(tasks, many_)) return first_of(tasks);
        if (const auto found = first_of_many(tasks); found.first >= 0) return found;
        is_counting_ = true;
        const bool are_few = run(tasks, most_);
        is_counting_ = false;
        if (!are_few) return {0, 0};
        run(tasks, most_);
        return first_of(tasks);
    }

private:
    /// The nodes of one level that meet, in the order in which one thread alone would look at them.
    void divide(std::vector<Task>& tasks, std::size_t k, std::size_t l, int levels)
    {
        if (levels == 0 || k >= tree_.n_leaves)
            tasks.push_back({k, l});
        else if (k == l) {
            divide(tasks, 2 * k, 2 * k, levels - 1);
            divide(tasks, 2 * k + 1, 2 * k + 1, levels - 1);
            if (tree_.boxes[2 * k].meets(tree_.boxes[2 * k + 1])) divide(tasks, 2 * k, 2 * k + 1, levels - 1);
        } else
            for (const std::size_t i : {2 * k, 2 * k + 1})
                for (const std::size_t j : {2 * l, 2 * l + 1})
                    if (tree_.boxes[i].meets(tree_.boxes[j])) divide(tasks, i, j, levels - 1);
    }

    /// False if they are more than `limit`: then it stopped somewhere.
    bool run(std::vector<Task>& tasks, std::int64_t limit)
    {
        begin(tasks, limit);
        std::atomic<int> last = static_cast<int>(tasks.size());   // with something found
        in_parallel(static_cast<int>(tasks.size()), [&](int i) {
            if (i > last || is_beyond()) return;
            Task& task = tasks[i];
            go(task, task.k, task.l);
            n_pairs_ += task.n_pairs % some_pairs;
            if (task.found.first < 0) return;
            for (int known = last; i < known && !last.compare_exchange_weak(known, i);) {
            }
        });
        return !is_beyond();
    }

    /// In the order of tasks, whoever did them.
    static std::pair<std::int32_t, std::int32_t> first_of(const std::vector<Task>& tasks)
    {
        for (const Task& task : tasks)
            if (task.found.first >= 0) return task.found;
        return {-1, -1};
    }

    /// By one thread, so that it is the same for any number of them.
    std::pair<std::int32_t, std::int32_t> first_of_many(std::vector<Task>& tasks)
    {
        begin(tasks, many_);
        for (Task& task : tasks) {
            go(task, task.k, task.l);
            n_pairs_ += task.n_pairs % some_pairs;
            if (task.found.first >= 0 || is_beyond()) return task.found;
        }
        return {-1, -1};
    }

    void begin(std::vector<Task>& tasks, std::int64_t limit)
    {
        for (Task& task : tasks) task = {task.k, task.l};
        n_pairs_ = 0;
        limit_ = limit;
    }

    bool is_beyond() const { return n_pairs_.load(std::memory_order_relaxed) > limit_; }
    bool is_done(const Task& task) const { return task.found.first >= 0 || is_beyond(); }
    void count(Task& task, std::int64_t n)
    {
        const std::int64_t before = task.n_pairs;
        task.n_pairs += n;
        n_pairs_ += task.n_pairs / some_pairs * some_pairs - before / some_pairs * some_pairs;
    }

    void go(Task& task, std::size_t k, std::size_t l)   // that meet, of one level
    {
        if (is_done(task) || !tree_.boxes[k].meets(tree_.boxes[k])) return;   // nothing meets nothing
        if (k >= tree_.n_leaves) return look(task, k - tree_.n_leaves, l - tree_.n_leaves);
        if (k == l) {
            go(task, 2 * k, 2 * k);
            go(task, 2 * k + 1, 2 * k + 1);
            if (tree_.boxes[2 * k].meets(tree_.boxes[2 * k + 1])) go(task, 2 * k, 2 * k + 1);
            return;
        }
        count(task, 1);
        for (const std::size_t i : {2 * k, 2 * k + 1}) {
            if (!tree_.boxes[i].meets(tree_.boxes[l])) continue;
            for (const std::size_t j : {2 * l, 2 * l + 1})
                if (tree_.boxes[i].meets(tree_.boxes[j])) go(task, i, j);
        }
    }

    void look(Task& task, std::size_t k, std::size_t l)
    {
        const Leaf& others = tree_.leaves[l];
        unsigned rows = k == l ? 255 : tree_.leaves[k].met(CoarseBox(tree_.boxes[tree_.n_leaves + l]));
        for (; rows != 0; rows &= rows - 1) {
            const int i = std::countr_zero(rows);
            unsigned met = others.met(tree_.leaves[k].box(i));
            if (k == l) met &= ~1u << i;
            if (met == 0) continue;
            count(task, std::popcount(met));
            if (is_counting_) continue;
            const Four a = tree_.triangle(Leaf::n * k + i);
            std::array<Four, 3> known;   // corners that nothing else need be asked about, and the face
            for (int c = 0; c < 3; ++c) {
                const std::int32_t at = a[c] >= 0 && directions_[a[c]] != 0 ? a[c] : -1;
                known[c] = Four{at, at, at, a[3]};
            }
            for (; met != 0 && !is_done(task); met &= met - 1) {
                const Four b = tree_.triangle(Leaf::n * l + std::countr_zero(met));
                if (any((b == known[0]) | (b == known[1]) | (b == known[2]))) continue;
                if (!Pair(points_, a, b).is_apart()) task.found = std::minmax(a[3], b[3]);
            }
        }
    }

    const std::vector<Vector3>& points_;
    const std::vector<std::uint8_t>& directions_;
    BoxTree tree_;
    std::int64_t many_, most_, limit_ = 0;
    std::atomic<std::int64_t> n_pairs_{0};   ///< of all tasks, some at a time
    bool is_counting_ = false;
};

}   // namespace

void check_contacts(const Facets& f, const Triangles& triangles, const Rings& rings,
                    std::vector<Complaint>& faults)
{
    const auto [a, b] = Contacts(f, triangles, rings).find();
    if (a < 0) return;
    const std::string& name = f.mesh->name;
    if (a == b)
        faults.push_back({"mesh-self-contact", "",
                          name + ": more than " + std::to_string(Contacts::most(triangles)) +
                              " pairs of its " + std::to_string(f.n_faces()) +
                              " faces lie near each other, too many to see whether they touch",
                          "", "", "",
                          "export the part with shorter triangles, and without what lies inside of it"});
    else
        faults.push_back({"mesh-self-contact", "",
                          name + ": " + name_of_face(*f.mesh, a) + " and " + name_of_face(*f.mesh, b) +
                              " touch or cross, near " + text_of(f.at(f.begin(a))),
                          "", "", "where a surface meets itself, inside and outside are not told apart",
                          "separate or unite what meets there"});
}

}   // namespace livens::inline geometry_internal
