// SPDX-License-Identifier: BSD-3-Clause
// Points that slide along curves: theory.md, "Coordinates of joints", Curves.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/multibody/joint_coordinates.h"

namespace livens {

namespace {

using Point = SmoothFunction::Point;
using Value = SmoothFunction::Value;

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
                throw InputError({"curve-crosses-itself", "", "the curve crosses itself, or nearly",
                                  "at the parameters " + to_text(first + k * step(), 6) + " and " +
                                      to_text(first + l * step(), 6),
                                  "", "a point there would be on two branches",
                                  "divide the curve, or round it"});
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
        ConstraintRow row;
        row.body_i = place.front().body_i;
        row.body_j = place.front().body_j;
        row.scale = scale;
        row.label = k == 0 ? "curve, normal 1" : "curve, normal 2";
        row.coordinates = place;
        row.functions = {{at, moved, 3}};
        rows.push_back(std::move(row));
    }
    if (!curve.knots.empty())
        rows[0].guard = {{curve.knots, curve.is_closed ? curve.last - curve.first : 0},
                         [sampled](const Point& q) { return sampled->nearest(place_of(q)); }};
    return rows;
}

}   // namespace livens
