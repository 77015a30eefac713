// SPDX-License-Identifier: BSD-3-Clause
// A chain of bodies, each hung with its origin on the one before, in minimal coordinates derived on paper:
// the way of a user with a pencil, whose work grows with the cube of the bodies, and the reference for
// chains.
//
// With S(a) b = a x b, arms l_i from the origin of body i to that of the next, c_i to its centre of mass, and
// mu_i the mass beyond it, Lagrange's equations for the angular velocities w_i in space are M w' = r,
//   M_ii = J_i - m_i S(c_i)^2 - mu_i S(l_i)^2,   M_ik = -S(l_i) S(m_k c_k + mu_k l_k)   (i < k)
//   r_i  = -w_i x J_i w_i + (m_i c_i + mu_i l_i) x g - m_i c_i x b_i - l_i x sum_{j > i} m_j b_j,
// b_j what is left of the acceleration of centre j where all w' are zero. On hinges w_i = sum_{k <= i} a_k
// u_k, and rows and columns are summed by the axes a_k.
#pragma once

#include <cmath>
#include <vector>

#include "mechanism.h"

namespace peers {

template <class T>
struct Triple {
    T x = 0, y = 0, z = 0;
    Triple() = default;
    Triple(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
    explicit Triple(const Vec& a) : x(a[0]), y(a[1]), z(a[2]) {}
    Triple& operator+=(const Triple& a) { return *this = {x + a.x, y + a.y, z + a.z}; }
    Triple operator+(const Triple& a) const { return {x + a.x, y + a.y, z + a.z}; }
    Triple operator-(const Triple& a) const { return {x - a.x, y - a.y, z - a.z}; }
    Triple operator*(T s) const { return {s * x, s * y, s * z}; }
    T dot(const Triple& a) const { return x * a.x + y * a.y + z * a.z; }
    Triple cross(const Triple& a) const { return {y * a.z - z * a.y, z * a.x - x * a.z, x * a.y - y * a.x}; }
};

template <class T>
struct Turn {   // by its columns
    Triple<T> d[3];
    Triple<T> operator*(const Triple<T>& a) const { return d[0] * a.x + d[1] * a.y + d[2] * a.z; }
    static Turn of(T w, T x, T y, T z)   // of length 1 or not
    {
        const T s = 2 / (w * w + x * x + y * y + z * z);
        return {{{1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)},
                 {s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)},
                 {s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)}}};
    }
    static Turn of(const Mat& m) { return {{{m[0], m[3], m[6]}, {m[1], m[4], m[7]}, {m[2], m[5], m[8]}}}; }
};

/// M x = r by Cholesky's factors, in the lower triangle of M; x takes the place of r.
template <class T>
inline void solve_positive(T* M, T* r, int n)
{
    using std::sqrt;
    for (int j = 0; j < n; ++j) {
        T* row = M + j * n;
        for (int k = 0; k < j; ++k) {
            T sum = row[k];
            const T* other = M + k * n;
            for (int s = 0; s < k; ++s) sum -= row[s] * other[s];
            row[k] = sum * other[k];   // its diagonal is kept inverted
            r[j] -= row[k] * r[k];
        }
        T pivot = row[j];
        for (int s = 0; s < j; ++s) pivot -= row[s] * row[s];
        row[j] = 1 / sqrt(pivot);
        r[j] *= row[j];
    }
    for (int j = n; j-- > 0;) {
        r[j] *= M[j * n + j];
        for (int k = 0; k < j; ++k) r[k] -= M[j * n + k] * r[j];
    }
}

/// N bodies known to the compiler, or 0. Unknowns of balls: quaternions of what has turned since the start,
/// then w; of hinges: angles since the start, then their rates.
template <class T, int N>
class Chain {
    using V = Triple<T>;

public:
    explicit Chain(const Mechanism& m) : n_(static_cast<int>(m.bodies.size()))
    {
        if (N != 0 && n_ != N) throw std::logic_error("another chain");
        beyond_.resize(n_);
        for (int i = 0; i < n_; ++i) {
            const Body& b = m.bodies[i];
            if (b.parent != i - 1) throw std::runtime_error("no chain");
            hinges_ = m.joints[b.hung].kind == "hinge";
            bodies_.push_back(b);
            axes_.emplace_back(m.joints[b.hung].axis_second);
            rates_.emplace_back(m.rate_in_parent(b));
            start_.push_back(Turn<T>::of(b.R));
            in_parent_.push_back(Turn<T>::of(m.turn_in_parent(b)));
            arms_.emplace_back(i + 1 < n_ ? Vec(m.joints[m.bodies[i + 1].hung].point_first) : Vec{});
            for (int k = 0; k < i; ++k) beyond_[k] += b.mass;
        }
        gravity_ = V(m.gravity);
        const int f = free();
        M_.resize(static_cast<std::size_t>(f) * f);
        r_.resize(f);
        R_.resize(n_);
        for (std::vector<V>* each : {&l_, &c_, &d_, &w_, &a_, &b_, &e_, &g_, &p_, &h_}) each->resize(n_);
    }

    int free() const { return (hinges_ ? 1 : 3) * count(); }
    std::vector<T> start() const
    {
        std::vector<T> y((hinges_ ? 2 : 7) * count(), T(0));
        for (int i = 0; i < count(); ++i) {
            if (hinges_) {
                y[count() + i] = axes_[i].dot(rates_[i]);
            } else {
                y[4 * i] = 1;
                for (int c = 0; c < 3; ++c) y[4 * count() + 3 * i + c] = bodies_[i].w[c];
            }
        }
        return y;
    }

    void operator()(const T* y, T* dy)
    {
        configure(y);
        move();
        if (hinges_) {
            hinge_equations();
            for (int i = 0; i < count(); ++i) dy[i] = y[count() + i];
        } else {
            ball_equations();
            for (int i = 0; i < count(); ++i) turn_rates(y + 4 * i, w_[i], dy + 4 * i);
        }
        solve_positive(M_.data(), r_.data(), free());
        T* rates = dy + (hinges_ ? 1 : 4) * count();
        for (int i = 0; i < free(); ++i) rates[i] = r_[i];
    }

    /// Where body coordinates are in space.
    std::vector<Vec> where(const T* y, const std::vector<Point>& points)
    {
        configure(y);
        std::vector<Vec> found;
        for (const Point& p : points) {
            V x = R_[p.body] * V(p.at);
            for (int i = 0; i < p.body; ++i) x += l_[i];
            found.push_back({static_cast<double>(x.x), static_cast<double>(x.y), static_cast<double>(x.z)});
        }
        return found;
    }

private:
    int count() const { return N != 0 ? N : n_; }

    void configure(const T* y)
    {
        const int n = count();
        for (int i = 0; i < n; ++i) {
            if (hinges_) {
                using std::cos, std::sin;
                const V a = axes_[i] * sin(y[i] / 2);
                const Turn<T> by = Turn<T>::of(cos(y[i] / 2), a.x, a.y, a.z);
                const Turn<T> base = i == 0 ? in_parent_[0] : after(R_[i - 1], in_parent_[i]);
                R_[i] = after(base, by);
                a_[i] = R_[i] * axes_[i];
                w_[i] = a_[i] * y[n + i] + (i == 0 ? V() : w_[i - 1]);
            } else {
                const T* q = y + 4 * i;
                R_[i] = after(Turn<T>::of(q[0], q[1], q[2], q[3]), start_[i]);
                w_[i] = V(y[4 * n + 3 * i], y[4 * n + 3 * i + 1], y[4 * n + 3 * i + 2]);
            }
            l_[i] = R_[i] * arms_[i];
            c_[i] = R_[i] * V(bodies_[i].center);
            d_[i] = c_[i] * T(bodies_[i].mass) + l_[i] * beyond_[i];
        }
    }

    static Turn<T> after(const Turn<T>& second, const Turn<T>& first)
    {
        return {{second * first.d[0], second * first.d[1], second * first.d[2]}};
    }

    /// r, and what w' = 0 leaves of the accelerations.
    void move()
    {
        const int n = count();
        V along;   // of the origin
        if (hinges_) bias();
        for (int i = 0; i < n; ++i) {
            const V turning = hinges_ ? e_[i] : V();
            b_[i] = along + w_[i].cross(w_[i].cross(c_[i])) + turning.cross(c_[i]);
            along += w_[i].cross(w_[i].cross(l_[i])) + turning.cross(l_[i]);
        }
        V pulled;
        for (int i = n; i-- > 0;) {
            const T m = bodies_[i].mass;
            V spin = w_[i].cross(inertia_times(i, w_[i]));
            if (hinges_) spin += inertia_times(i, e_[i]);
            g_[i] = d_[i].cross(gravity_) - spin - c_[i].cross(b_[i]) * m - l_[i].cross(pulled);
            pulled += b_[i] * m;
        }
    }

    /// w' where all u' are zero: the axes turn.
    void bias()
    {
        V sum;
        for (int i = 0; i < count(); ++i) {
            const V own = i == 0 ? w_[0] : w_[i] - w_[i - 1];
            e_[i] = sum += w_[i].cross(own);
        }
    }

    V inertia_times(int i, const V& w) const
    {
        const Vec& J = bodies_[i].inertia;
        const V inside{T(J[0]) * R_[i].d[0].dot(w), T(J[1]) * R_[i].d[1].dot(w), T(J[2]) * R_[i].d[2].dot(w)};
        return R_[i] * inside;
    }

    /// Block (i, k), i <= k, times v.
    V block_times(int i, int k, const V& v) const
    {
        if (i < k) return l_[i].cross(v.cross(d_[k]));
        const T m = bodies_[i].mass;
        return inertia_times(i, v) + c_[i].cross(v.cross(c_[i])) * m +
               l_[i].cross(v.cross(l_[i])) * beyond_[i];
    }

    void ball_equations()
    {
        const int n = count(), f = 3 * n;
        const V unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (int k = 0; k < n; ++k) {
            for (int i = 0; i <= k; ++i)
                for (int c = 0; c < 3; ++c) {
                    const V column = block_times(i, k, unit[c]);
                    T* lower = &M_[(3 * k + c) * f + 3 * i];   // the transpose, since M is symmetric
                    lower[0] = column.x, lower[1] = column.y, lower[2] = column.z;
                }
            r_[3 * k] = g_[k].x, r_[3 * k + 1] = g_[k].y, r_[3 * k + 2] = g_[k].z;
        }
    }

    /// a_i . (sum over rows >= i and columns >= k of M) a_k: the momenta when all from k on turn by a_k.
    void hinge_equations()
    {
        const int n = count();
        for (int k = 0; k < n; ++k) {
            V x;   // of origin i from origin k
            for (int i = k; i < n; ++i) {
                p_[i] = a_[k].cross(x + c_[i]) * T(bodies_[i].mass);
                h_[i] = inertia_times(i, a_[k]) + c_[i].cross(p_[i]);
                x += l_[i];
            }
            V moment, momentum;   // of the bodies from i on, the moment about origin i
            for (int i = n; i-- > k;) {
                moment = h_[i] + moment + l_[i].cross(momentum);
                momentum += p_[i];
                M_[i * n + k] = a_[i].dot(moment);
            }
        }
        V sum;
        for (int i = n; i-- > 0;) r_[i] = a_[i].dot(sum += g_[i]);
    }

    static void turn_rates(const T* q, const V& w, T* d)
    {
        d[0] = -(q[1] * w.x + q[2] * w.y + q[3] * w.z) / 2;
        d[1] = (q[0] * w.x + w.y * q[3] - w.z * q[2]) / 2;
        d[2] = (q[0] * w.y + w.z * q[1] - w.x * q[3]) / 2;
        d[3] = (q[0] * w.z + w.x * q[2] - w.y * q[1]) / 2;
    }

    int n_;
    bool hinges_ = false;
    std::vector<Body> bodies_;
    std::vector<T> beyond_;
    std::vector<Turn<T>> start_, in_parent_;
    std::vector<V> axes_, rates_, arms_;   // of hinges in their body, at the start; to the next joint
    V gravity_;
    std::vector<Turn<T>> R_;
    std::vector<V> l_, c_, d_, w_, a_, b_, e_, g_, p_, h_;   // e: w' without u'; g: blocks of r
    std::vector<T> M_, r_;
};

}   // namespace peers
