// SPDX-License-Identifier: BSD-3-Clause
// Minimal coordinates derived on paper, and DOP853. Settings: a tolerance; "reference:STEPS" extrapolates in
// 64 bits of mantissa.
#include <cmath>

#include "chain_by_hand.h"
#include "dop853.h"
#include "equations_by_hand.h"
#include "extrapolate.h"
#include "serve.h"

namespace {

using namespace peers;
using Setting = std::vector<std::string>;
using std::acos, std::atan2, std::cos, std::sin, std::sqrt;

template <class T, class F>
std::vector<T> solved(const F& f, std::vector<T> y, double end, const Setting& setting)
{
    if constexpr (std::is_same_v<T, double>)
        Dop853().integrate(f, y, end, std::stod(setting[0]));
    else
        extrapolate(f, y, end, std::stoi(setting.at(1)));
    return y;
}

template <class T>
Vec as_doubles(T x, T y, T z)
{
    return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

/// Two links that turn in one plane by their angles from +x: P14 in x y, and the paper's pendulum in x z.
template <class T>
struct TwoLinks {
    T length, center, m1, m2, J, g;

    TwoLinks(bool rods)
        : length(rods ? 4 : 1), center(rods ? T(4) : T(1) / 2), m1(rods ? T(3) / 2 : 1),
          m2(rods ? m1 * 512 / 1000 : 1), J(rods ? 0 : 1), g(rods ? T(981) / 100 : 10)
    {}

    void operator()(const T* u, T* d) const
    {
        const T A = m1 * center * center + J + m2 * length * length, B = m2 * length * center;
        const T C = m2 * center * center + J;
        const T k = B * cos(u[0] - u[1]), s = B * sin(u[0] - u[1]);
        const T r1 = -s * u[3] * u[3] - g * (m1 * center + m2 * length) * cos(u[0]);
        const T r2 = s * u[2] * u[2] - g * m2 * center * cos(u[1]);
        const T det = A * C - k * k;
        d[0] = u[2];
        d[1] = u[3];
        d[2] = (C * r1 - k * r2) / det;
        d[3] = (A * r2 - k * r1) / det;
    }
};

template <class T>
Points solve_links(bool rods, double end, const Setting& setting)
{
    const TwoLinks<T> links(rods);
    const T start = rods ? acos(T(-1)) / 4 : T(0);
    const std::vector<T> y = solved<T>(links, {start, start, 0, 0}, end, setting);
    const T x = links.length * cos(y[0]), h = links.length * sin(y[0]);
    const T x2 = x + links.length * cos(y[1]), h2 = h + links.length * sin(y[1]);
    if (rods) return {as_doubles<T>(x, 0, h), as_doubles<T>(x2, 0, h2)};
    return {as_doubles<T>(x, h, 0), as_doubles<T>(x2, h2, 0)};
}

/// Two parallelograms (P02) on the branch where all links stay parallel: one angle from the upright.
template <class T>
Points solve_parallelograms(double end, const Setting& setting)
{
    const T n = 2, inertia = (n + 1) / 3 + n, moment = T(981) / 100 * ((n + 1) / 2 + n);
    const auto f = [ratio = moment / inertia](const T* u, T* d) {
        d[0] = u[1];
        d[1] = ratio * sin(u[0]);
    };
    const std::vector<T> y = solved<T>(f, {0, 1}, end, setting);
    Points points;
    for (int k = 0; k < 3; ++k) points.push_back(as_doubles<T>(k + sin(y[0]), cos(y[0]), 0));
    return points;
}

/// The four-bar by the angle a of its crank; coupler b and rocker c follow from the closed loop, their rates
/// are kb a' and kc a', their accelerations kb a'' + pb and kc a'' + pc.
template <class T>
struct FourBar {
    T l1 = T(42) / 100, l2 = T(9) / 10, l3 = 1, base = 1, g = T(981) / 100;
    T m1 = bar(l1), m2 = bar(l2), m3 = bar(l3);
    T J1 = about_center(m1, l1) + m1 * l1 * l1 / 4, J2 = about_center(m2, l2);
    T J3 = about_center(m3, l3) + m3 * l3 * l3 / 4;

    static T bar(T l) { return 7850 * l * 8 / 10000; }
    static T about_center(T m, T l) { return m * (l * l + T(4) / 10000) / 12; }

    void close(T a, T& b, T& c) const
    {
        const T x = base - l1 * cos(a), z = -l1 * sin(a), d = sqrt(x * x + z * z);
        b = atan2(z, x) + acos((l2 * l2 + d * d - l3 * l3) / (2 * l2 * d));   // the branch of the start
        c = atan2(l1 * sin(a) + l2 * sin(b), l1 * cos(a) + l2 * cos(b) - base);
    }

    void operator()(const T* u, T* d) const
    {
        const T a = u[0], w = u[1];
        T b, c;
        close(a, b, c);
        const T sa = sin(a), ca = cos(a), sb = sin(b), cb = cos(b), sc = sin(c), cc = cos(c);
        const T s = 1 / (sc * cb - cc * sb), kb = l1 / l2 * (sa * cc - ca * sc) * s;
        const T kc = l1 / l3 * (sa * cb - ca * sb) * s, wb = kb * w, wc = kc * w;
        const T cos_bc = cb * cc + sb * sc;
        const T pb = (l1 * w * w * (ca * cc + sa * sc) + l2 * wb * wb * cos_bc - l3 * wc * wc) / l2 * s;
        const T pc = (l1 * w * w * (ca * cb + sa * sb) + l2 * wb * wb - l3 * wc * wc * cos_bc) / l3 * s;
        // The coupler's centre accelerates by (ux, uz) a'' + (qx, qz).
        const T h = l2 / 2, ux = -l1 * sa - h * sb * kb, uz = l1 * ca + h * cb * kb;
        const T qx = -l1 * ca * w * w - h * (cb * wb * wb + sb * pb);
        const T qz = -l1 * sa * w * w - h * (sb * wb * wb - cb * pb);
        const T mass = J1 + J2 * kb * kb + J3 * kc * kc + m2 * (ux * ux + uz * uz);
        const T pull = g * (m1 * l1 / 2 * ca + m2 * uz + m3 * l3 / 2 * cc * kc);
        d[0] = w;
        d[1] = -(pull + J2 * kb * pb + J3 * kc * pc + m2 * (ux * qx + uz * qz)) / mass;
    }
};

template <class T>
Points solve_four_bar(double end, const Setting& setting)
{
    const FourBar<T> bars;
    const std::vector<T> y = solved<T>(bars, {acos(T(-1)) / 2, 0}, end, setting);
    T b, c;
    bars.close(y[0], b, c);
    return {as_doubles<T>(bars.l1 * cos(y[0]), 0, bars.l1 * sin(y[0])),
            as_doubles<T>(bars.base + bars.l3 * cos(c), 0, bars.l3 * sin(c))};
}

template <class T, int N>
Points solve_chain(const Mechanism& m, const Setting& setting)
{
    Chain<T, N> chain(m);
    const auto f = [&chain](const T* y, T* dy) { chain(y, dy); };
    const std::vector<T> y = solved<T>(f, chain.start(), m.end, setting);
    return chain.where(y.data(), m.points);
}

template <class T>
Points solve_tree(const Mechanism& m, const Setting& setting)
{
    Equations<T> equations(m);
    const auto f = [&equations](const T* y, T* dy) { equations(y, dy); };
    const std::vector<T> y = solved<T>(f, equations.start(), m.end, setting);
    return equations.where(y.data(), m.points);
}

template <class T>
Points solve(const Mechanism& m, const Setting& setting)
{
    if (m.is_loaded()) return solve_tree<T>(m, setting);
    if (m.name == "rods" || m.name == "links") return solve_links<T>(m.name == "rods", m.end, setting);
    if (m.name == "parallelograms") return solve_parallelograms<T>(m.end, setting);
    if (m.name == "four_bar") return solve_four_bar<T>(m.end, setting);
    return m.bodies.size() == 2 ? solve_chain<T, 2>(m, setting) : solve_chain<T, 0>(m, setting);
}

}   // namespace

int main()
{
    return serve([](const Mechanism& m, const Setting& setting) {
        return [&m, setting] {
            return setting.at(0) == "reference" ? solve<long double>(m, setting) : solve<double>(m, setting);
        };
    });
}
