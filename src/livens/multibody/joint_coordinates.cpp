// SPDX-License-Identifier: BSD-3-Clause
// Angles, displacements and curves as coordinates of joints, and the rows of slots. theory.md, "Coordinates
// of joints", has the derivatives.
#include "livens/multibody/joint_coordinates.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/base/error.h"
#include "livens/base/text.h"

namespace livens {

namespace {

using Point = SmoothFunction::Point;
using Value = SmoothFunction::Value;

/// A row of functions of forms, on the bodies of the first.
ConstraintRow row_of(std::vector<PairForm> coordinates, std::vector<SmoothFunction> functions, double scale,
                     const std::string& label)
{
    ConstraintRow row;
    row.body_i = coordinates.front().body_i;
    row.body_j = coordinates.front().body_j;
    row.scale = scale;
    row.label = label;
    row.coordinates = std::move(coordinates);
    row.functions = std::move(functions);
    return row;
}

[[noreturn]] void refuse(const char* code, const std::string& message, const std::string& value,
                         const std::string& bound, const std::string& note, const std::string& help)
{
    throw InputError({code, "", message, value, bound, note, help});
}

double value_of(const PairForm& form, std::span<const Matrix34> X)
{
    return form_value(form, form.body_i, form.body_j, X);
}

double rate_of(const PairForm& form, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    ConstraintRow row;
    static_cast<PairForm&>(row) = form;
    const RowGradient gradient = constraint_gradient(row, X);
    double rate = 0;
    for (int side = 0; side < gradient.bodies.size; ++side)
        rate += dot(gradient.by[side], V[gradient.bodies.bodies[side]]);
    return rate;
}

// --- curves

constexpr int n_samples = 256, few = 16;

/// A curve with samples from which nearest points are sought.
struct SampledCurve : Curve {
    std::vector<Vector3> samples;   ///< at first + k step
    double longest = 0;             ///< from one to the next

    explicit SampledCurve(const Curve& curve) : Curve(curve)
    {
        if (!without_normals) without_normals = at;
        for (int k = 0; k <= n_samples; ++k) samples.push_back(without_normals(first + k * step()).x);
        for (int k = 0; k < n_samples; ++k) longest = std::max(longest, norm(samples[k + 1] - samples[k]));
        refuse_crossings();
    }

    double step() const { return (last - first) / n_samples; }

    /// The parameter of the point nearest to x, from a parameter near it.
    double nearest(const Vector3& x, double s) const
    {
        for (int i = 0; i < 50; ++i) {
            const CurvePoint here = without_normals(s);
            const Vector3 r = x - here.x;
            // Newton's iteration for r . gamma' = 0, steps bounded by four samples so that it stays on its
            // branch.
            const double slope = dot(here.first, here.first) - dot(r, here.second);
            // beyond the centre of curvature the distance has no minimum: along the tangent then
            const double change = dot(r, here.first) / (slope > 0 ? slope : dot(here.first, here.first));
            s += std::clamp(change, -4 * step(), 4 * step());
            if (!(std::abs(change) > 1e-15 * (std::abs(s) + step()))) break;
        }
        return s;
    }

    double nearest(const Vector3& x) const
    {
        int best = 0;
        double least = norm(x - samples[0]);
        const auto look = [&](int k) {
            const double distance = norm(x - samples[k]);
            if (distance < least || (distance == least && k < best)) best = k, least = distance;
            return distance;
        };
        for (int k = few; k <= n_samples; k += few) look(k);
        // none that is nearer lies between here and as many samples on as the longest way from one to the
        // next goes into what this one is farther
        for (int k = 1; k <= n_samples;) {
            const double farther = (look(k) - least) / longest;   // no number: one on
            k += farther > 1 ? 1 + static_cast<int>(std::min<double>(farther, n_samples)) : 1;
        }
        return nearest(x, first + best * step());
    }

private:
    void refuse_crossings() const
    {
        // Neighbouring samples are near each other on every curve; only those further along may be a
        // crossing.
        constexpr int apart = 8;
        for (int k = 0; k < n_samples; ++k)
            for (int l = k + apart; l < n_samples; ++l) {
                if (is_closed && k + n_samples - l < apart) continue;
                if (norm(samples[k] - samples[l]) > norm(samples[k + 1] - samples[k])) continue;
                refuse("curve-crosses-itself", "the curve crosses itself, or nearly",
                       "at the parameters " + to_text(first + k * step(), 6) + " and " +
                           to_text(first + l * step(), 6),
                       "", "a point there would be on two branches", "divide the curve, or round it");
            }
    }
};

Vector3 place_of(const Point& q) { return {q[0], q[1], q[2]}; }

/// d n / ds = -(n . gamma'') / |gamma'|^2 gamma' and ds/dx = gamma' / (|gamma'|^2 - r . gamma'').
Value across_curve(const SampledCurve& curve, std::size_t normal, const Vector3& x, double s)
{
    const CurvePoint here = curve.at(s);
    const Vector3 r = x - here.x, n = here.normals[normal];
    const double square = dot(here.first, here.first);
    const double bend = -dot(n, here.second) / (square * (square - dot(r, here.second)));
    Value value;
    value.value = dot(n, r);
    for (int i = 0; i < 3; ++i) {
        value.gradient[i] = n[i];
        for (int j = 0; j < 3; ++j) value.hessian[i][j] = bend * here.first[i] * here.first[j];
    }
    return value;
}

}   // namespace

JointCoordinate displacement_along(int body_i, const Vector4& n, const Vector4& a, int body_j,
                                   const Vector4& b)
{
    return {{plane_row(body_i, n, a, body_j, b, 0, 1)}};
}

JointCoordinate angle_between(int body_i, const Vector4& a1, const Vector4& a2, int body_j, const Vector4& b)
{
    return {{inner_product_row(body_i, a1, body_j, b, 0, 1), inner_product_row(body_i, a2, body_j, b, 0, 1)}};
}

JointCoordinate turn_between(int body_i, const Vector4& a1, const Vector4& a2, int body_j, const Vector4& b1,
                             const Vector4& b2)
{
    const auto sum = [](PairForm form, const PairForm& other, double sign) {
        form.c_ij += sign * other.c_ij;   // products of two directions: of the world they are in b_j alone
        form.b_j += sign * other.b_j;
        return form;
    };
    const JointCoordinate one = angle_between(body_i, a1, a2, body_j, b1),
                          two = angle_between(body_i, a1, a2, body_j, b2);
    return {{sum(one.forms[0], two.forms[1], 1), sum(one.forms[1], two.forms[0], -1)}};
}

double coordinate_value(const JointCoordinate& q, std::span<const Matrix34> X)
{
    return q.is_angle() ? arc_tangent(value_of(q.forms[1], X), value_of(q.forms[0], X))
                        : value_of(q.forms[0], X);
}

double coordinate_rate(const JointCoordinate& q, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    if (!q.is_angle()) return rate_of(q.forms[0], X, V);
    const double c = value_of(q.forms[0], X), s = value_of(q.forms[1], X);
    return (c * rate_of(q.forms[1], X, V) - s * rate_of(q.forms[0], X, V)) / (c * c + s * s);
}

double coordinate_change(const JointCoordinate& q, std::span<const Matrix34> from,
                         std::span<const Matrix34> to)
{
    if (!q.is_angle()) return value_of(q.forms[0], to) - value_of(q.forms[0], from);
    const double c0 = value_of(q.forms[0], from), s0 = value_of(q.forms[1], from);
    const double c = value_of(q.forms[0], to), s = value_of(q.forms[1], to);
    return arc_tangent(c0 * s - s0 * c, c0 * c + s0 * s);
}

double turned_to(double angle, double near)
{
    constexpr double turn = 2 * std::numbers::pi;
    return angle + turn * std::round((near - angle) / turn);
}

std::vector<ConstraintRow> curve_rows(const Curve& curve, int body_i, int body_j, const Vector4& b,
                                      double scale)
{
    const auto sampled = std::make_shared<const SampledCurve>(curve);
    std::vector<PairForm> place;
    for (int k = 0; k < 3; ++k) {
        Vector3 e{};
        e[k] = 1;
        place.push_back(plane_row(body_i, direction(e), point({}), body_j, b, 0, 1));
    }
    std::vector<ConstraintRow> rows;
    for (std::size_t k = 0; k < 2; ++k) {
        const auto at = [sampled, k](const Point& q) {
            return across_curve(*sampled, k, place_of(q), sampled->nearest(place_of(q)));
        };
        const auto moved = [sampled, k](const Point& q, std::span<const Point> steps, std::span<Value> out) {
            const Vector3 from = place_of(q);
            const double s = sampled->nearest(from), before = across_curve(*sampled, k, from, s).value;
            for (std::size_t i = 0; i < steps.size(); ++i) {
                const Vector3 to = from + place_of(steps[i]);
                out[i] = across_curve(*sampled, k, to, sampled->nearest(to, s));
                out[i].value -= before;
            }
        };
        rows.push_back(
            row_of(place, {{at, moved, 3}}, scale, k == 0 ? "curve, normal 1" : "curve, normal 2"));
    }
    if (!curve.knots.empty())
        rows[0].guard = {{curve.knots, curve.is_closed ? curve.last - curve.first : 0},
                         [sampled](const Point& q) { return sampled->nearest(place_of(q)); }};
    return rows;
}

}   // namespace livens
