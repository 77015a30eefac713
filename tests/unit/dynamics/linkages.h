// SPDX-License-Identifier: BSD-3-Clause
// Linkages of known rank, with any masses, at any place and in any unit of length.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "livens/multibody/model.h"
#include "unit/multibody/random_states.h"

namespace livens {

/// Where a linkage stands and what its bodies are like.
struct Surroundings {
    double unit = 1;            ///< all lengths are multiplied by it
    double shift = 0;           ///< of the whole in space, in these units
    double reference = 0;       ///< distance of reference points from the centres of mass, in these units
    double largest_power = 0;   ///< masses are 10^k, |k| up to this
};

class Linkage {
public:
    Linkage(unsigned seed, const Surroundings& how) : random(seed), how_(how) {}

    Random random;
    Model model;

    Vector3 place(const Vector3& at) const
    {
        return how_.unit * (at + how_.shift * Vector3{0.6, -0.48, 0.64});
    }

    /// A link with unequal moments, its centre of mass at the given place, turned at random.
    int add_link(const Vector3& at)
    {
        const double mass = std::pow(10.0, std::round(how_.largest_power * random.number()));
        const Matrix3 D = random.rotation();
        const Vector3 center = how_.reference * how_.unit * random.unit();
        Matrix3 J{};
        for (int i = 0; i < 3; ++i) J(i, i) = mass * how_.unit * how_.unit * (0.1 + 0.03 * i);
        Placement placement;
        placement.position = place(at) - D * center;
        placement.directors = D;
        return model.add_body(
            rigid_body("b" + std::to_string(model.n_bodies()), {mass, center, J}, placement));
    }

    const Matrix34& X(int body) const
    {
        return body == world ? world_configuration : model.bodies()[body].X;
    }
    JointFrame frame(int first, int second, const Vector3& at, const Vector3& axis) const
    {
        return joint_frame(X(first), X(second), place(at), axis);
    }

    void hinge(int first, int second, const Vector3& at, const Vector3& axis)
    {
        model.add_joint(revolute(name(), first, second, frame(first, second, at, axis), how_.unit));
    }
    void ball(int first, int second, const Vector3& at)
    {
        model.add_joint(spherical(name(), first, second, frame(first, second, at, {0, 0, 1}), how_.unit));
    }
    /// One of nine kinds at a random place between two bodies that are near the origin; twice if wanted.
    void any_joint(int first, int second, bool twice)
    {
        const int kind = static_cast<int>(std::floor(4.5 * (random.number() + 1)));
        const Vector3 at = random.vector(), axis = random.unit(), far = at + random.unit();
        JointFrame f = frame(first, second, at, axis);
        for (int copy = 0; copy < (twice ? 2 : 1); ++copy) {
            if (kind == 0) model.add_joint(revolute(name(), first, second, f, how_.unit));
            if (kind == 1) model.add_joint(spherical(name(), first, second, f, how_.unit));
            if (kind == 2) {
                const Vector3 across = cross(axis, far - at);
                f.axis_second = transpose(directors(X(second))) * across;
                model.add_joint(universal(name(), first, second, f, how_.unit));
            }
            if (kind == 3) model.add_joint(weld(name(), first, second, f, X(first), X(second), how_.unit));
            if (kind == 5)
                model.add_joint(prismatic(name(), first, second, f, X(first), X(second), how_.unit));
            if (kind == 6) model.add_joint(cylindrical(name(), first, second, f, how_.unit));
            if (kind == 7) model.add_joint(planar(name(), first, second, f, how_.unit));
            if (kind == 8) model.add_joint(point_on_line(name(), first, second, f, how_.unit));
            if (kind == 4) {
                JointFrame g = f;
                g.point_first = frame(first, second, far, axis).point_first;
                const Vector3 gap = X(first) * point(g.point_first) - X(second) * point(g.point_second);
                model.add_joint(rod(name(), first, second, g, norm(gap)));
            }
        }
    }

private:
    std::string name() const { return "j" + std::to_string(model.joints().size()); }

    Surroundings how_;
};

/// Each body hangs on an earlier one or the world by a joint of any kind: all rows are independent, but for
/// those of the second copies.
inline Model open_chain(unsigned seed, int n, const Surroundings& how, bool twice = false)
{
    Linkage l(seed, how);
    for (int b = 0; b < n; ++b) {
        l.add_link(l.random.vector());
        const int on = static_cast<int>(std::floor(0.5 * (l.random.number() + 1) * (b + 1))) - 1;
        l.any_joint(on, b, twice);
    }
    return l.model;
}

/// n bodies in a ring on n + 1 hinges. With one common axis, tilted in space: rank 5 n + 2. With an axis for
/// each hinge: rank min(5 (n + 1), 6 n).
inline Model ring(unsigned seed, int n, const Surroundings& how, bool planar)
{
    Linkage l(seed, how);
    const Matrix3 Q = l.random.rotation();
    std::vector<Vector3> pins;
    for (int k = 0; k <= n; ++k) {
        const Vector3 r = l.random.vector();
        pins.push_back(Q * Vector3{r[0], r[1], planar ? 0 : r[2]});
    }
    for (int b = 0; b < n; ++b) l.add_link(0.5 * (pins[b] + pins[b + 1]));
    for (int k = 0; k <= n; ++k)
        l.hinge(k == 0 ? world : k - 1, k == n ? world : k, pins[k],
                planar ? Q.column(2) : l.random.unit());
    return l.model;
}

}   // namespace livens
