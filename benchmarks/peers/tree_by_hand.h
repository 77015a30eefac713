// SPDX-License-Identifier: BSD-3-Clause
// A tree of bodies on hinges and slides, with springs and dampers, by the coordinates of its joints.
//
// All is told about the origin of space: a motion is (w, v), v the velocity of what passes the origin, a
// force (moment, force). With s_i the motion of coordinate i, V_i that of body i, A_i its acceleration where
// all q'' are zero, and I_i its inertia, M_ij = s_i . (sum of I beyond j) s_j for j beyond i, and
//   r_i = Q_i - s_i . sum_{j beyond i} (I_j A_j + V_j x I_j V_j - loads on j).
#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "chain_by_hand.h"
#include "mechanism.h"

namespace peers {

template <class T>
struct Pair {   // a motion (turning, along) or a force (moment, force)
    Triple<T> a, b;
    Pair& operator+=(const Pair& p) { return a += p.a, b += p.b, *this; }
    Pair operator+(const Pair& p) const { return {a + p.a, b + p.b}; }
    Pair operator-(const Pair& p) const { return {a - p.a, b - p.b}; }
    Pair operator*(T s) const { return {a * s, b * s}; }
    T dot(const Pair& p) const { return a.dot(p.a) + b.dot(p.b); }
    Pair of_motion(const Pair& p) const { return {a.cross(p.a), a.cross(p.b) + b.cross(p.a)}; }
    Pair of_force(const Pair& p) const { return {a.cross(p.a) + b.cross(p.b), a.cross(p.b)}; }
    /// Velocity of what is at x.
    Triple<T> at(const Triple<T>& x) const { return b + a.cross(x); }
};

/// Mass, mass times centre, and second moments of mass: sums are those of bodies together.
template <class T>
struct Inertia {
    T m = 0;
    Triple<T> mc;
    Triple<T> J[3];   // rows, about the origin

    Inertia& operator+=(const Inertia& o)
    {
        m += o.m, mc += o.mc;
        for (int k = 0; k < 3; ++k) J[k] += o.J[k];
        return *this;
    }
    Pair<T> operator*(const Pair<T>& V) const
    {
        const Triple<T> turned{J[0].dot(V.a), J[1].dot(V.a), J[2].dot(V.a)};
        return {turned + mc.cross(V.b), V.b * m + V.a.cross(mc)};
    }
};

template <class T>
class Tree {
    using V = Triple<T>;

public:
    explicit Tree(const Mechanism& m) : m_(m), n_(static_cast<int>(m.bodies.size()))
    {
        if (!m.bushings.empty()) throw std::runtime_error("not derived");
        for (int i = 0; i < n_; ++i) {
            const Body& b = m.bodies[i];
            if (b.hung == nothing || b.parent >= i || !hung(i).has_coordinate())
                throw std::runtime_error("no tree of hinges and slides");
            in_parent_.push_back(Turn<T>::of(m.turn_in_parent(b)));
        }
        for (std::vector<V>* each : {&x_, &axis_}) each->resize(n_);
        for (std::vector<Pair<T>>* each : {&s_, &V_, &A_, &F_}) each->resize(n_);
        R_.resize(n_), I_.resize(n_);
        M.resize(static_cast<std::size_t>(n_) * n_), r.resize(n_);
    }

    int size() const { return n_; }
    T start_rate(int i) const { return T(dot(hung(i).axis_second, m_.rate_in_parent(m_.bodies[i]))); }
    V place(int body, const Vec& at) const { return body == ground ? V(at) : x_[body] + R_[body] * V(at); }
    const Pair<T>& motion(int coordinate) const { return s_[coordinate]; }

    void put(const T* q)
    {
        using std::cos, std::sin;
        for (int i = 0; i < n_; ++i) {
            const Body& b = m_.bodies[i];
            const Joint& j = hung(i);
            const Turn<T> before = b.parent == ground ? in_parent_[i] : after(R_[b.parent], in_parent_[i]);
            const V axis(j.axis_second);
            x_[i] = place(b.parent, j.point_first);
            axis_[i] = before * axis;
            if (j.kind == "slide") {
                x_[i] += axis_[i] * q[i];
                R_[i] = before;
                s_[i] = {V(), axis_[i]};
            } else {
                const V a = axis * sin(q[i] / 2);
                R_[i] = after(before, Turn<T>::of(cos(q[i] / 2), a.x, a.y, a.z));
                s_[i] = {axis_[i], x_[i].cross(axis_[i])};
            }
        }
    }

    /// V and A, of rates.
    void move(const T* rates)
    {
        const Pair<T> fall{V(), V(m_.gravity) * T(-1)};
        for (int i = 0; i < n_; ++i) {
            const int parent = m_.bodies[i].parent;
            const Pair<T> own = s_[i] * rates[i];
            V_[i] = parent == ground ? own : V_[parent] + own;
            A_[i] = (parent == ground ? fall : A_[parent]) + V_[i].of_motion(own);
        }
    }

    /// What a point accelerates by where all q'' are zero, less weight.
    V bias(int body, const V& at) const { return A_[body].at(at) + V_[body].a.cross(V_[body].at(at)); }

    /// M, its lower half, and r.
    void balance(const T* q, const T* rates, T t)
    {
        for (int i = 0; i < n_; ++i) {
            I_[i] = inertia(i);
            F_[i] = I_[i] * A_[i] + V_[i].of_force(I_[i] * V_[i]);
        }
        for (const Spring& spring : m_.springs) pull(spring, t);
        for (int i = n_; i-- > 0;) {
            const Joint& j = hung(i);
            const int parent = m_.bodies[i].parent;
            r[i] = T(j.push) - T(j.stiffness) * q[i] - T(j.damping) * rates[i] - s_[i].dot(F_[i]);
            const Pair<T> momentum = I_[i] * s_[i];
            T* row = &M[static_cast<std::size_t>(i) * n_];
            std::fill(row, row + i, T(0));
            for (int k = i; k != ground; k = m_.bodies[k].parent) row[k] = s_[k].dot(momentum);
            if (parent != ground) I_[parent] += I_[i], F_[parent] += F_[i];
        }
    }

    std::vector<T> M, r;

private:
    const Joint& hung(int i) const { return m_.joints[m_.bodies[i].hung]; }
    static Turn<T> after(const Turn<T>& second, const Turn<T>& first)
    {
        return {{second * first.d[0], second * first.d[1], second * first.d[2]}};
    }

    Inertia<T> inertia(int i) const
    {
        const Body& b = m_.bodies[i];
        const Turn<T>& R = R_[i];
        const V c = x_[i] + R * V(b.center),
                d[3] = {R.d[0] * T(b.inertia[0]), R.d[1] * T(b.inertia[1]), R.d[2] * T(b.inertia[2])};
        const T m = b.mass, cc = m * c.dot(c);
        Inertia<T> I{m, c * m, {}};
        I.J[0] = d[0] * R.d[0].x + d[1] * R.d[1].x + d[2] * R.d[2].x + V(cc, 0, 0) - c * (m * c.x);
        I.J[1] = d[0] * R.d[0].y + d[1] * R.d[1].y + d[2] * R.d[2].y + V(0, cc, 0) - c * (m * c.y);
        I.J[2] = d[0] * R.d[0].z + d[1] * R.d[1].z + d[2] * R.d[2].z + V(0, 0, cc) - c * (m * c.z);
        return I;
    }

    void pull(const Spring& spring, T t)
    {
        using std::sin, std::cos, std::sqrt;
        const T phase = T(spring.omega) * t, height = spring.amplitude;
        V first = place(spring.first, spring.point_first), v;
        if (spring.first == ground)
            first += V(0, 0, height * sin(phase)), v = V(0, 0, height * T(spring.omega) * cos(phase));
        else
            v = V_[spring.first].at(first);
        const V second = place(spring.second, spring.point_second), way = second - first;
        const T length = sqrt(way.dot(way)), rate = way.dot(V_[spring.second].at(second) - v) / length;
        const V f =
            way *
            ((T(spring.stiffness) * (length - T(spring.free_length)) + T(spring.damping) * rate) / length);
        F_[spring.second] += Pair<T>{second.cross(f), f};
        if (spring.first != ground) F_[spring.first] += Pair<T>{f.cross(first), f * T(-1)};
    }

    const Mechanism& m_;
    int n_;
    std::vector<Turn<T>> in_parent_, R_;
    std::vector<V> x_, axis_;
    std::vector<Pair<T>> s_, V_, A_, F_;
    std::vector<Inertia<T>> I_;
};

}   // namespace peers
