// SPDX-License-Identifier: BSD-3-Clause
// The makers of rows, see constraint.h.
// Each is one line of algebra in the coordinates (1, theta) of points and (0, a) of directions: theory.md,
// "Joints are quadratic forms". (P27) is a distance row, (P4) are the rigidity rows.
#include <cmath>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/base/error.h"
#include "livens/multibody/constraint.h"

namespace livens {

namespace {

/// A row without terms, on two bodies that differ.
ConstraintRow empty_row(int body_i, int body_j, double scale, const char* label)
{
    if (body_i == body_j)
        throw InputError({"joint-self", "", "a constraint row needs two different bodies",
                          std::to_string(body_i), "", "",
                          "a point or an axis of the world belongs to body -1"});
    ConstraintRow row;
    row.body_i = body_i;
    row.body_j = body_j;
    row.scale = scale;
    row.label = label;
    return row;
}

/// The same function of the same bodies, stored so that body_j is a body and the world's terms are in B_j, c.
ConstraintRow with_world_folded(ConstraintRow row)
{
    if (row.body_j == world) {
        std::swap(row.body_i, row.body_j);
        std::swap(row.c_ii, row.c_jj);
        std::swap(row.b_i, row.b_j);
        row.c_ij = transpose(row.c_ij);
    }
    if (row.body_i != world) return row;
    const Matrix34& X_world = world_configuration;
    // The world's configuration is constant: products with it are linear, and its own terms are constants.
    row.b_j += X_world * row.c_ij;
    row.c += 0.5 * dot(X_world * row.c_ii, X_world) + dot(row.b_i, X_world);
    row.c_ii = {};
    row.c_ij = {};
    row.b_i = {};
    return row;
}

}   // namespace

ConstraintRow inner_product_row(int body_i, const Vector4& a, int body_j, const Vector4& b, double value,
                                double scale)
{
    ConstraintRow row = empty_row(body_i, body_j, scale, "axis");
    row.c_ij = outer(a, b);
    row.c = -value;
    return with_world_folded(row);
}

std::vector<ConstraintRow> coincidence_rows(int body_i, const Vector4& a, int body_j, const Vector4& b,
                                            double scale)
{
    static constexpr const char* labels[3] = {"x", "y", "z"};
    std::vector<ConstraintRow> rows;
    for (int k = 0; k < 3; ++k) {
        Vector3 e{};
        e[k] = 1;
        ConstraintRow row = empty_row(body_i, body_j, scale, labels[k]);
        row.b_i = -outer(e, a);
        row.b_j = outer(e, b);
        rows.push_back(with_world_folded(row));
    }
    return rows;
}

ConstraintRow distance_row(int body_i, const Vector4& a, int body_j, const Vector4& b, double length)
{
    ConstraintRow row = empty_row(body_i, body_j, length * length, "distance");
    // Half of the squared distance is a form, and its gradient vanishes only where the points coincide.
    row.c_ii = outer(a, a);
    row.c_ij = -outer(a, b);
    row.c_jj = outer(b, b);
    row.c = -0.5 * length * length;
    return with_world_folded(row);
}

ConstraintRow plane_row(int body_i, const Vector4& n, const Vector4& a, int body_j, const Vector4& b,
                        double distance, double scale)
{
    ConstraintRow row = empty_row(body_i, body_j, scale, "plane");
    // n . (x_j - x_i): the part of body i alone is quadratic, since n and the point turn with the same body.
    row.c_ii = -(outer(n, a) + outer(a, n));
    row.c_ij = outer(n, b);
    row.c = -distance;
    return with_world_folded(row);
}

namespace {

/// y and its two derivatives by t, from f(t) and dy/df, d2y/df2.
TimeValue chain(const TimeValue& f, double y, double by_f, double by_ff)
{
    return {y, by_f * f.first, by_ff * f.first * f.first + by_f * f.second};
}

/// outer(f) of a function of time; `outer` takes its TimeValue.
template <typename Outer>
TimeFunction composed(const TimeFunction& inner, Outer outer)
{
    return {[inner, outer](Instant at) { return outer(inner(at)); }, inner.breaks()};
}

TimeValue cosine(const TimeValue& angle)
{
    const auto [s, c] = sine_cosine(angle.value);
    return chain(angle, c, -s, -c);
}

TimeValue sine(const TimeValue& angle)
{
    const auto [s, c] = sine_cosine(angle.value);
    return chain(angle, s, c, -s);
}

}   // namespace

std::vector<ConstraintRow> driven_point_rows(int body_i, const Vector4& a, int body_j, const Vector4& b,
                                             const std::array<TimeFunction, 3>& path, double scale)
{
    static constexpr const char* labels[3] = {"driven x", "driven y", "driven z"};
    std::vector<ConstraintRow> rows;
    for (int k = 0; k < 3; ++k) {
        Vector3 e{};
        e[k] = 1;
        ConstraintRow row = plane_row(body_i, direction(e), a, body_j, b, 0, scale);
        row.label = labels[k];
        QuadraticForm one;
        one.c = -1;
        // The form of the drive is the constant -1, by which the path is taken off.
        row.drives.push_back({path[static_cast<std::size_t>(k)], one});
        rows.push_back(std::move(row));
    }
    return rows;
}

ConstraintRow driven_distance_row(int body_i, const Vector4& a, int body_j, const Vector4& b,
                                  const TimeFunction& length, double typical)
{
    ConstraintRow row = distance_row(body_i, a, body_j, b, typical);
    row.label = "driven distance";
    // The constant length of the row is taken back: the drive has -l(t)^2 / 2 instead.
    row.c += 0.5 * typical * typical;
    QuadraticForm one;
    one.c = -0.5;
    const auto square = [](const TimeValue& l) { return chain(l, l.value * l.value, 2 * l.value, 2); };
    row.drives.push_back({composed(length, square), one});
    return row;
}

ConstraintRow driven_angle_row(int body_i, const Vector4& a, int body_j, const Vector4& b1, const Vector4& b2,
                               const TimeFunction& angle)
{
    ConstraintRow row = inner_product_row(body_i, a, body_j, Vector4{}, 0, 1);
    row.label = "driven angle";
    // a . (cos b2 - sin b1) = 0 has a slope of one at every angle, where a . b = cos has none at 0 and pi.
    row.drives.push_back({composed(angle, cosine), inner_product_row(body_i, a, body_j, b2, 0, 1)});
    row.drives.push_back({composed(angle, sine), inner_product_row(body_i, a, body_j, -b1, 0, 1)});
    return row;
}

ConstraintRow driven_angle_branch(int body_i, const Vector4& a, int body_j, const Vector4& b1,
                                  const Vector4& b2, const TimeFunction& angle)
{
    ConstraintRow row = inner_product_row(body_i, a, body_j, Vector4{}, 0, 1);
    row.label = "driven angle";
    // a . (cos b1 + sin b2) is 1 on the branch that is meant, and -1 half a turn away.
    row.drives.push_back({composed(angle, cosine), inner_product_row(body_i, a, body_j, b1, 0, 1)});
    row.drives.push_back({composed(angle, sine), inner_product_row(body_i, a, body_j, b2, 0, 1)});
    return row;
}

std::vector<ConstraintRow> rigidity_rows(int body)
{
    struct Pair {
        int a, b;
        const char* label;
    };
    static constexpr Pair pairs[6] = {{1, 1, "rigidity 11"}, {2, 2, "rigidity 22"}, {3, 3, "rigidity 33"},
                                      {1, 2, "rigidity 12"}, {1, 3, "rigidity 13"}, {2, 3, "rigidity 23"}};
    std::vector<ConstraintRow> rows;
    for (const Pair& pair : pairs) {
        ConstraintRow row = empty_row(world, body, 1, pair.label);
        // The form is 1/2 tr(X C X^T), so these entries give 1/2 d_a . d_b for both kinds of pairs.
        row.c_jj(pair.a, pair.b) += 0.5;
        row.c_jj(pair.b, pair.a) += 0.5;
        row.c = pair.a == pair.b ? -0.5 : 0.0;
        rows.push_back(row);
    }
    return rows;
}

}   // namespace livens
