// SPDX-License-Identifier: BSD-3-Clause
// A mechanism as every engine of the comparison is told it: the words that problems.py writes. Shares nothing
// with livens, since its references are made from it.
#pragma once

#include <array>
#include <cmath>
#include <istream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace peers {

using Vec = std::array<double, 3>;
using Mat = std::array<double, 9>;   // row by row

inline Vec operator+(const Vec& a, const Vec& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec operator*(const Mat& m, const Vec& a)
{
    return {m[0] * a[0] + m[1] * a[1] + m[2] * a[2], m[3] * a[0] + m[4] * a[1] + m[5] * a[2],
            m[6] * a[0] + m[7] * a[1] + m[8] * a[2]};
}
inline Mat transpose(const Mat& m) { return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]}; }
inline Mat operator*(const Mat& a, const Mat& b)
{
    Mat c{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) c[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    return c;
}

constexpr Mat unturned{1, 0, 0, 0, 1, 0, 0, 0, 1};
constexpr int ground = -1, nothing = -2;

/// What two bodies share: a point (ball), a point and an axis (hinge), all but the way along an axis (slide),
/// or the distance of two points (rod).
struct Joint {
    std::string kind;
    int first = ground, second = 0;
    Vec point_first{}, point_second{};                       ///< body coordinates
    Vec axis{}, axis_first{0, 0, 1}, axis_second{0, 0, 1};   ///< at the start in space, then in each body
    double length = 0;
    /// Of a hinge or slide: push - stiffness q - damping q' along its coordinate q, zero at the start.
    double stiffness = 0, damping = 0, push = 0;

    bool has_coordinate() const { return kind == "hinge" || kind == "slide"; }
};

/// Pulls by stiffness (length - free_length) + damping length'. The first point, if it is of the ground, goes
/// up by amplitude sin(omega t).
struct Spring {
    int first = ground, second = 0;
    Vec point_first{}, point_second{};
    double stiffness = 0, damping = 0, free_length = 0, amplitude = 0, omega = 0;

    Vec lift(double t) const { return {0, 0, amplitude * std::sin(omega * t)}; }
    Vec lift_rate(double t) const { return {0, 0, amplitude * omega * std::cos(omega * t)}; }
};

/// Against three displacements, of the second body's point in axes that stand in the first as the world's do
/// at the start, and the rotation vector in these.
struct Bushing {
    int first = ground, second = 0;
    Vec at{};   ///< in space, at the start
    std::array<double, 6> stiffness{}, damping{};
};

/// The coordinate of joint `second` is ratio times that of `first`.
struct Gear {
    int first, second;
    double ratio;
};

struct Body {
    double mass = 0;
    Vec center{};       ///< of mass, in the body
    Vec inertia{};      ///< principal, about the centre of mass, along the body's axes
    Vec x{};            ///< where its origin is at the start
    Mat R = unturned;   ///< body to space at the start
    Vec v{}, w{};       ///< of the origin and angular, in space
    // As a branch of the tree: hung by its origin on `parent` by the joint `hung`; neither if it is free.
    int parent = nothing, hung = nothing;
};

struct Point {
    int body;
    Vec at;
};

struct Mechanism {
    std::string name;
    double end = 1;
    Vec gravity{};
    std::vector<Body> bodies;
    std::vector<Joint> joints;
    std::vector<Spring> springs;
    std::vector<Bushing> bushings;
    std::vector<Gear> gears;
    std::vector<Point> points;   ///< that are compared at the end
    std::string scenario;        ///< a file of the same, where there are loads

    Vec place(int body) const { return body == ground ? Vec{} : bodies[body].x; }
    Mat turn(int body) const { return body == ground ? unturned : bodies[body].R; }
    /// Orientation in the parent, and angular velocity against it in the body's own axes, at the start.
    Mat turn_in_parent(const Body& b) const { return transpose(turn(b.parent)) * b.R; }
    Vec rate_in_parent(const Body& b) const
    {
        return transpose(b.R) * (b.parent == ground ? b.w : b.w - bodies[b.parent].w);
    }
    /// There is more than weight, balls, hinges and rods.
    bool is_loaded() const
    {
        for (const Joint& j : joints)
            if (j.kind == "slide" || j.stiffness != 0 || j.damping != 0) return true;
        return !springs.empty() || !bushings.empty() || !gears.empty();
    }
    bool closes_loop(int joint) const { return bodies[joints[joint].second].hung != joint; }
};

inline std::istream& operator>>(std::istream& in, Vec& a) { return in >> a[0] >> a[1] >> a[2]; }

inline Mat matrix_of(double w, double x, double y, double z)
{
    return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
            2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
            2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
}

/// Joints are given at the start in space; the first ball, hinge or slide of a body hangs it on the one
/// before.
inline void add_joint(Mechanism& m, const std::string& kind, std::istream& in)
{
    Joint j;
    j.kind = kind;
    in >> j.first >> j.second;
    const auto inside = [&m](int body, const Vec& at) {
        return transpose(m.turn(body)) * (at - m.place(body));
    };
    if (kind == "rod") {
        in >> j.point_first >> j.point_second >> j.length;
    } else {
        Vec at;
        in >> at;
        j.point_first = inside(j.first, at);
        j.point_second = inside(j.second, at);
        if (j.has_coordinate()) {
            in >> j.axis;
            j.axis_first = transpose(m.turn(j.first)) * j.axis;
            j.axis_second = transpose(m.turn(j.second)) * j.axis;
        }
        Body& body = m.bodies.at(j.second);
        if (body.hung == nothing) {
            body.parent = j.first;
            body.hung = static_cast<int>(m.joints.size());
        }
    }
    m.joints.push_back(j);
}

/// False where `kind` is no load.
inline bool add_load(Mechanism& m, const std::string& kind, std::istream& in)
{
    if (kind == "torsion" || kind == "control") {
        std::size_t joint = 0;
        double stiffness = 0, damping = 0, rest = 0;
        in >> joint >> stiffness >> damping >> rest;
        Joint& j = m.joints.at(joint);
        j.stiffness += stiffness, j.damping += damping, j.push += stiffness * rest;
    } else if (kind == "spring") {
        Spring& s = m.springs.emplace_back();
        in >> s.first >> s.second >> s.point_first >> s.point_second;
        in >> s.stiffness >> s.damping >> s.free_length >> s.amplitude >> s.omega;
    } else if (kind == "bushing") {
        Bushing& b = m.bushings.emplace_back();
        in >> b.first >> b.second >> b.at;
        for (std::array<double, 6>* six : {&b.stiffness, &b.damping})
            for (double& number : *six) in >> number;
    } else if (kind == "gear") {
        Gear& g = m.gears.emplace_back();
        in >> g.first >> g.second >> g.ratio;
    } else {
        return false;
    }
    return true;
}

/// Reads up to a line "done".
inline Mechanism read_mechanism(std::istream& in)
{
    Mechanism m;
    for (std::string line; std::getline(in, line) && line != "done";) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        if (key == "name") {
            words >> m.name;
        } else if (key == "scenario") {
            words >> m.scenario;
        } else if (key == "end") {
            words >> m.end;
        } else if (key == "gravity") {
            words >> m.gravity;
        } else if (key == "body") {
            Body b;
            double q[4];
            words >> b.mass >> b.center >> b.inertia >> b.x >> q[0] >> q[1] >> q[2] >> q[3] >> b.v >> b.w;
            b.R = matrix_of(q[0], q[1], q[2], q[3]);
            m.bodies.push_back(b);
        } else if (key == "point") {
            Point p{};
            words >> p.body >> p.at;
            m.points.push_back(p);
        } else if (!add_load(m, key, words)) {
            add_joint(m, key, words);
        }
        if (!words) throw std::runtime_error("not understood: " + line);
    }
    return m;
}

}   // namespace peers
