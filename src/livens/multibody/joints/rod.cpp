// SPDX-License-Identifier: BSD-3-Clause
// One distance row, 1/2 (|x_j - x_i|^2 - l^2) = 0 (P27): theory.md, "Joints are quadratic forms"; over more
// points than two the sum of distances, theory.md, "Coordinates of joints", Ropes.
#include <cmath>
#include <limits>

#include "livens/base/elementary.h"
#include "livens/base/error.h"
#include "livens/multibody/joints/joint_frame.h"
#include "livens/multibody/wording.h"

namespace livens {

namespace {

using Point = SmoothFunction::Point;
using Value = SmoothFunction::Value;

void require_length(const std::string& name, double length)
{
    if (!(length > 0) || !std::isfinite(length))
        throw InputError({"rod-length", "joint[" + name + "]", "the length of a rod must be positive",
                          to_text(length), "> 0", "", "points that coincide are a spherical joint"});
}

double size(const Point& r) { return hypotenuse(r[0], r[1], r[2]); }

double inner(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// |r| and its derivatives; no number where r is zero.
Value length_at(const Point& r)
{
    const double l = size(r);
    Value of;
    of.value = l > 0 ? l : std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < 3; ++i) {
        of.gradient[i] = r[i] / l;
        for (std::size_t j = 0; j < 3; ++j) of.hessian[i][j] = ((i == j ? 1 : 0) - r[i] / l * (r[j] / l)) / l;
    }
    return of;
}

/// Whether the straight way between two places leads past the origin so closely that a span vanishes on it:
/// behind, its length would grow again, which no rope does that is drawn through a point.
bool vanishes(const Point& from, const Point& step, double longest)
{
    constexpr double closest = 0.01;   // of the span: it may shrink so far in one element
    const double way = inner(step, step);
    const double s = way > 0 ? std::clamp(-inner(from, step) / way, 0.0, 1.0) : 0;
    const Point there{from[0] + s * step[0], from[1] + s * step[1], from[2] + s * step[2]};
    return !(size(there) > closest * longest);
}

/// |from + step| - |from| = step . (2 from + step) / (|from| + |from + step|), without cancellation.
Value length_after(const Point& from, const Point& step)
{
    const Point to{from[0] + step[0], from[1] + step[1], from[2] + step[2]};
    const Point sum{from[0] + to[0], from[1] + to[1], from[2] + to[2]};
    const double before = size(from), after = size(to);
    Value of = length_at(to);
    of.value = vanishes(from, step, std::max(before, after)) ? std::numeric_limits<double>::quiet_NaN()
                                                             : inner(step, sum) / (before + after);
    return of;
}

SmoothFunction length_of_span()
{
    return {length_at,
            [](const Point& from, std::span<const Point> steps, std::span<Value> out) {
                for (std::size_t i = 0; i < steps.size(); ++i) out[i] = length_after(from, steps[i]);
            },
            3};
}

/// The last point on a body, and the nearest before it on another one or in the world.
void place_ends(Joint& joint)
{
    const std::vector<BodyPoint>& over = joint.over;
    std::size_t last = over.size();
    while (last > 0 && over[last - 1].body == world) --last;
    joint.second = over[last - 1].body;
    joint.point_second = over[last - 1].point;
    for (std::size_t k = over.size(); k-- > 0;)
        if (over[k].body != joint.second) {
            joint.first = over[k].body;
            joint.point_first = over[k].point;
            if (k < last) return;   // one behind it, as the world is, serves where there is none before
        }
}

/// Adds a span between two bodies.
/// Its forms are the three components of the way between its points in world axes, which are linear in X.
void add_span(ConstraintRow& row, const std::string& name, std::size_t k, const BodyPoint& a,
              const BodyPoint& b)
{
    std::vector<ConstraintRow> forms = coincidence_rows(a.body, point(a.point), b.body, point(b.point), 1);
    row.coordinates.insert(row.coordinates.end(), forms.begin(), forms.end());
    row.functions.push_back(length_of_span());
    row.edges.push_back({size, row.scale,
                         "the points " + std::to_string(k) + " and " + std::to_string(k + 1) +
                             " of the rope '" + name + "' meet"});
}

}   // namespace

Joint rod(const std::string& name, int first, int second, const JointFrame& frame, double length)
{
    require_length(name, length);
    JointFrame f = frame;
    Joint joint = start_joint(name, "rod", first, second, f, length);
    joint.rows.push_back(
        distance_row(joint.first, point(joint.point_first), joint.second, point(joint.point_second), length));
    return joint;
}

Joint rod(const std::string& name, const std::vector<BodyPoint>& over, double length, const Configurations& X)
{
    const std::string path = "joint[" + name + "].over";
    require_length(name, length);
    check_rope(path, over, X);
    Joint joint;
    joint.name = name;
    joint.type = "rod";
    joint.over = over;
    place_ends(joint);
    ConstraintRow row;
    row.label = "length";
    row.scale = length;
    row.c = constant_length(over) - length;
    for (std::size_t k = 1; k < over.size(); ++k)
        if (over[k - 1].body != over[k].body) add_span(row, name, k, over[k - 1], over[k]);
    row.body_i = row.coordinates.front().body_i;
    row.body_j = row.coordinates.front().body_j;
    joint.rows.push_back(std::move(row));
    return joint;
}

}   // namespace livens
