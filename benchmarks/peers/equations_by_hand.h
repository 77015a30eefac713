// SPDX-License-Identifier: BSD-3-Clause
// The equations of a tree with loads in minimal coordinates, with gears and one plane loop: the reference for
// problems with loads, and the way of a user with a pencil. Where coordinates q depend on others, q' = G u'
// and q'' = G u'' + g, G^T M G u'' = G^T (r - M g).
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "tree_by_hand.h"

namespace peers {

/// G and g, u among the coordinates q.
template <class T>
struct Dependence {
    std::vector<int> free;
    std::vector<T> G, g;   // row by row

    explicit Dependence(const Mechanism& m)
    {
        const int n = static_cast<int>(m.bodies.size());
        std::vector<T> ratio(n, 1);
        std::vector<int> of(n);
        for (int i = 0; i < n; ++i) of[i] = i;
        for (const Gear& gear : m.gears) {   // in order, from the motor on
            const int first = m.joints[gear.first].second, second = m.joints[gear.second].second;
            of[second] = of[first];
            ratio[second] = ratio[first] * T(gear.ratio);
        }
        const bool loop = m.joints.size() > m.bodies.size();   // its last two bodies follow
        for (int i = 0; i < (loop ? n - 2 : n); ++i)
            if (of[i] == i) free.push_back(i);
        G.assign(n * free.size(), 0), g.assign(n, 0);
        for (std::size_t k = 0; k < free.size(); ++k)
            for (int i = 0; i < n; ++i)
                if (of[i] == free[k]) G[i * free.size() + k] = ratio[i];
    }
};

/// The loop of two arms on one body, hinged along x, and what ends them: bodies 1 and 2, and 3, which hangs
/// on 2 and meets 1 at the last joint. Its coordinates follow from that of body 1.
template <class T>
class PlaneLoop {
    using V = Triple<T>;

public:
    explicit PlaneLoop(const Mechanism& m) : close_(m.joints.back())
    {
        const V lower(m.bodies[1].x), upper(m.bodies[2].x), pin(m.bodies[3].x);
        arm_ = V(close_.point_first), coupler_ = V(close_.point_second);
        base_ = lower - upper, rod_ = pin - upper;
        side_ = cross_of(base_ + arm_, rod_) < 0 ? -1 : 1;
    }

    /// q[2] and q[3] of q[1], by the circles on which the pin lies.
    void close(T* q) const
    {
        using std::atan2, std::cos, std::sin, std::sqrt;
        const T c = cos(q[1]), s = sin(q[1]);
        const V ball = base_ + V(0, c * arm_.y - s * arm_.z, s * arm_.y + c * arm_.z);
        const T r2 = rod_.dot(rod_), d2 = ball.dot(ball),
                along = (r2 - coupler_.dot(coupler_) + d2) / (2 * d2);
        const T across = side_ * sqrt(r2 / d2 - along * along);
        const V pin = ball * along + V(0, -ball.z, ball.y) * across, back = ball - pin;
        q[2] = turn(rod_, pin);
        q[3] = turn(coupler_, back) - q[2];
    }

    void rates(const Tree<T>& tree, Dependence<T>& d) const
    {
        const V at = tree.place(1, close_.point_first);
        const V first = tree.motion(1).at(at), second = tree.motion(2).at(at), third = tree.motion(3).at(at);
        const T det = cross_of(second, third);
        d.G[2 * 2 + 1] = cross_of(first, third) / det;
        d.G[3 * 2 + 1] = cross_of(second, first) / det;
    }

    void bias(const Tree<T>& tree, Dependence<T>& d) const
    {
        const V at = tree.place(1, close_.point_first);
        const V second = tree.motion(2).at(at), third = tree.motion(3).at(at),
                more = tree.bias(1, at) - tree.bias(3, at);
        const T det = cross_of(second, third);
        d.g[2] = cross_of(more, third) / det;
        d.g[3] = cross_of(second, more) / det;
    }

private:
    static T cross_of(const V& a, const V& b) { return a.y * b.z - a.z * b.y; }
    static T turn(const V& from, const V& to)
    {
        using std::atan2;
        return atan2(cross_of(from, to), from.y * to.y + from.z * to.z);
    }

    Joint close_;
    V arm_, coupler_, base_, rod_;
    T side_ = 1;
};

/// y' = f(y) of a tree: u, u', and the time.
template <class T>
class Equations {
public:
    explicit Equations(const Mechanism& m)
        : tree_(m), on_(m), f_(static_cast<int>(on_.free.size())), q_(tree_.size()), rates_(tree_.size()),
          Mg_(tree_.size()), M_(static_cast<std::size_t>(f_) * f_), b_(f_),
          M_G_(static_cast<std::size_t>(tree_.size()) * f_)
    {
        if (m.joints.size() > m.bodies.size()) loop_ = std::make_unique<PlaneLoop<T>>(m);
        is_reduced_ = f_ < tree_.size();
        start_.assign(2 * f_ + 1, 0);
        for (int k = 0; k < f_; ++k) start_[f_ + k] = tree_.start_rate(on_.free[k]);
    }

    std::vector<T> start() const { return start_; }

    void operator()(const T* y, T* dy)
    {
        configure(y);
        if (loop_) loop_->rates(tree_, on_);
        spread(y + f_, rates_);
        tree_.move(rates_.data());
        if (loop_) loop_->bias(tree_, on_);
        tree_.balance(q_.data(), rates_.data(), y[2 * f_]);
        reduce();
        solve_positive(M_.data(), b_.data(), f_);
        for (int k = 0; k < f_; ++k) dy[k] = y[f_ + k], dy[f_ + k] = b_[k];
        dy[2 * f_] = 1;
    }

    std::vector<Vec> where(const T* y, const std::vector<Point>& points)
    {
        configure(y);
        std::vector<Vec> found;
        for (const Point& p : points) {
            const Triple<T> x = tree_.place(p.body, p.at);
            found.push_back({static_cast<double>(x.x), static_cast<double>(x.y), static_cast<double>(x.z)});
        }
        return found;
    }

private:
    /// Where G is that of the start: gears, and of a loop what is free.
    void configure(const T* y)
    {
        if (loop_) {
            q_[0] = y[0], q_[1] = y[1];
            loop_->close(q_.data());
        } else {
            spread(y, q_);
        }
        tree_.put(q_.data());
    }

    void spread(const T* u, std::vector<T>& q) const
    {
        for (int i = 0; i < tree_.size(); ++i) {
            q[i] = 0;
            for (int k = 0; k < f_; ++k) q[i] += on_.G[i * f_ + k] * u[k];
        }
    }

    void reduce()
    {
        const int n = tree_.size();
        if (!is_reduced_) {
            M_.swap(tree_.M);
            b_.swap(tree_.r);
            return;
        }
        const auto M = [&](int i, int j) { return i < j ? tree_.M[j * n + i] : tree_.M[i * n + j]; };
        for (int i = 0; i < n; ++i) {
            T sum = tree_.r[i];
            for (int j = 0; j < n; ++j) sum -= M(i, j) * on_.g[j];
            Mg_[i] = sum;
            for (int k = 0; k < f_; ++k) {
                M_G_[i * f_ + k] = 0;
                for (int j = 0; j < n; ++j) M_G_[i * f_ + k] += M(i, j) * on_.G[j * f_ + k];
            }
        }
        for (int k = 0; k < f_; ++k) {
            b_[k] = 0;
            for (int i = 0; i < n; ++i) b_[k] += on_.G[i * f_ + k] * Mg_[i];
            for (int l = 0; l <= k; ++l) {
                M_[k * f_ + l] = 0;
                for (int i = 0; i < n; ++i) M_[k * f_ + l] += on_.G[i * f_ + k] * M_G_[i * f_ + l];
            }
        }
    }

    Tree<T> tree_;
    Dependence<T> on_;
    std::unique_ptr<PlaneLoop<T>> loop_;
    int f_;
    bool is_reduced_ = false;
    std::vector<T> start_, q_, rates_, Mg_, M_, b_, M_G_;
};

}   // namespace peers
