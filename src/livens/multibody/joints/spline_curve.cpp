// SPDX-License-Identifier: BSD-3-Clause
// Curves of slots through points: cubic splines by chord length with normals that do not turn about the
// tangent [Bishop1975], which theory.md, "Coordinates of joints", Curves, takes for granted in its
// derivatives.
#include "livens/multibody/joints/spline_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "livens/base/elementary.h"
#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/time/quadrature.h"
#include "livens/time/time_function.h"
#include "livens/time/time_laws.h"

namespace livens {

namespace {

constexpr double repeated = 1e-12;   // of the size of a curve: the same point but for rounding
constexpr int steps_a_piece = 8;     // of the normals' turn, whose error is rounding then
constexpr double flat = 1e-14;       // of a unit vector, out of its plane: nothing turns then
constexpr int overlap = 30;          // knots, by which what a spline does at its ends has died away

[[noreturn]] void refuse_curve(const std::string& message, const std::string& value, const std::string& bound,
                               const std::string& code = "curve-points")
{
    throw InputError({code, "joint.curve", message, value, bound, "", ""});
}

void refuse_repeated_points(const std::vector<Vector3>& points, bool is_closed)
{
    double size = 0;
    for (const Vector3& point : points) size = std::max(size, norm(point - points.front()));
    for (std::size_t k = 1; k < points.size(); ++k)
        if (!(norm(points[k] - points[k - 1]) > repeated * size))
            refuse_curve("a curve has a point twice in a row",
                         "points " + std::to_string(k) + " and " + std::to_string(k + 1), "");
    if (is_closed && !(norm(points.back() - points.front()) > repeated * size))
        refuse_curve("the last point of a closed curve is its first again",
                     "point " + std::to_string(points.size()), "it is left out");
}

Vector3 unit(const Vector3& v) { return 1 / norm(v) * v; }

class Spline {
public:
    Spline(const std::vector<Vector3>& points, bool is_closed) : is_closed_(is_closed)
    {
        const int n = static_cast<int>(points.size()), least = is_closed ? 3 : 2;
        if (n < least)
            refuse_curve("a curve has too few points", std::to_string(n),
                         "at least " + std::to_string(least));
        for (const Vector3& point : points)
            if (!std::isfinite(norm(point))) refuse_curve("a curve needs finite points", "", "");
        // A closed one goes on beyond its seam, far enough for both sides of it to be the same.
        const int around = is_closed ? overlap : 0, n_knots = n + (is_closed ? 1 : 0) + 2 * around;
        const auto point = [&](int k) {
            return points[static_cast<std::size_t>((k - around + n * overlap) % n)];
        };
        refuse_repeated_points(points, is_closed);
        std::vector<double> knots{0};
        for (int k = 1; k < n_knots; ++k) {
            const double chord = norm(point(k) - point(k - 1));
            knots.push_back(knots.back() + chord);
        }
        const double begin = knots[static_cast<std::size_t>(around)];
        for (double& knot : knots) knot -= begin;
        last_ = knots[static_cast<std::size_t>(n_knots - 1 - around)];
        keep_knots(knots, around);
        pieces_.resize(knots.size() + 1);
        for (int c = 0; c < 3; ++c) {
            std::vector<double> values;
            for (int k = 0; k < n_knots; ++k) values.push_back(point(k)[c]);
            add_component(c, knots, values);
        }
        find_cells();
        for (int k = around; k + 1 < n_knots - around; ++k)
            for (int i = 0; i < steps_a_piece; ++i)
                places_.push_back(knots[k] + (knots[k + 1] - knots[k]) * i / steps_a_piece);
        places_.push_back(last_);
        carry_normals();
    }

    double last() const { return last_; }
    /// Of one round, or with both ends.
    const std::vector<double>& knots() const { return knots_; }

    /// The parameter on this round.
    double inside(double s) const { return is_closed_ ? s - last_ * std::floor(s / last_) : s; }

    CurvePoint at(double s) const
    {
        s = inside(s);
        const auto next = std::upper_bound(places_.begin() + 1, places_.end() - 1, s);
        const auto sample = static_cast<std::size_t>(next - places_.begin() - 1);
        CurvePoint here = shape(s);
        const Vector3 along = unit(here.first);
        here.normals[0] = is_flat_ ? unit(normals_[sample] - dot(normals_[sample], along) * along)
                                   : carried(normals_[sample], places_[sample], s);
        here.normals[1] = cross(along, here.normals[0]);
        return here;
    }

    /// Without normals.
    CurvePoint shape(double s) const
    {
        const Piece& piece = pieces_[piece_at(s)];
        const double d = s - piece.from;
        CurvePoint here;
        for (int i = 0; i < 3; ++i) {
            const auto& [x, slope, c2, c3] = piece.of[i];
            here.x[i] = x + d * (slope + d * (c2 + d * c3));
            here.first[i] = slope + d * (2 * c2 + d * 3 * c3);
            here.second[i] = 2 * c2 + 6 * d * c3;
        }
        return here;
    }

private:
    /// A cubic from a knot on, by the powers of the way; beyond the ends of the knots a straight line.
    struct Piece {
        double from;
        std::array<double, 4> of[3];
    };

    /// The last piece that begins at s or before, the first one for all that is before the knots: from the
    /// first that lies in the cell of s, of as many cells as there are pieces.
    std::size_t piece_at(double s) const
    {
        const double begin = pieces_[1].from, cell = (s - begin) * cells_per_length_;
        if (!(cell > 0)) return s >= begin ? 1 : 0;
        const auto last = first_piece_.size() - 1;
        std::size_t piece =
            first_piece_[cell < static_cast<double>(last) ? static_cast<std::size_t>(cell) : last];
        while (piece + 1 < pieces_.size() && pieces_[piece + 1].from <= s) ++piece;
        while (piece > 0 && pieces_[piece].from > s) --piece;   // by rounding of the cell
        return piece;
    }

    void find_cells()
    {
        const std::size_t n = pieces_.size();
        cells_per_length_ = static_cast<double>(n) / (pieces_.back().from - pieces_[1].from);
        std::size_t piece = 1;
        for (std::size_t cell = 0; cell < n; ++cell) {
            const double from = pieces_[1].from + static_cast<double>(cell) / cells_per_length_;
            while (piece + 1 < n && pieces_[piece + 1].from <= from) ++piece;
            first_piece_.push_back(piece);
        }
    }

    void add_component(int c, const std::vector<double>& knots, const std::vector<double>& values)
    {
        const TimeFunction spline = spline_table(knots, values);
        const std::size_t n = knots.size();
        const auto slope = [&](std::size_t k) {
            return spline({knots[k], k + 1 < n ? Side::right : Side::left}).first;
        };
        pieces_[0].from = knots[0];
        pieces_[0].of[c] = {values[0], slope(0), 0, 0};
        for (std::size_t k = 0; k < n; ++k) {
            pieces_[k + 1].from = knots[k];
            pieces_[k + 1].of[c] = {values[k], slope(k), 0, 0};
            if (k + 1 == n) continue;
            const double length = knots[k + 1] - knots[k], chord = (values[k + 1] - values[k]) / length,
                         before = slope(k), behind = slope(k + 1);
            pieces_[k + 1].of[c][2] = (3 * chord - 2 * before - behind) / length;
            pieces_[k + 1].of[c][3] = (before + behind - 2 * chord) / (length * length);
        }
    }

    /// The normal carried on from where it is n: with the part a of n across the tangent t and b = t x a it
    /// is cos(angle) a + sin(angle) b, where angle' = -a'.b = (n . t) (gamma'' . b) / (|gamma'| |n - (n . t)
    /// t|).
    Vector3 carried(const Vector3& n, double from, double until) const
    {
        struct Across {
            Vector3 a{}, b{};
            double turning = 0;
        };
        const auto across = [&](double s) {
            const CurvePoint here = shape(s);
            const Vector3 t = unit(here.first), part = n - dot(n, t) * t;
            const Vector3 a = unit(part), b = cross(t, a);
            return Across{a, b, dot(n, t) * dot(here.second, b) / (norm(here.first) * norm(part))};
        };
        const Across there = across(until);
        if (is_flat_) return there.a;   // no turn about the tangent: what at() has without this
        double angle = 0;
        for (std::size_t i = 0; i < rule_.points.size(); ++i)
            // The angle is an integral of a smooth function over an eighth of a piece, for which five Gauss
            // points leave rounding.
            angle +=
                (until - from) * rule_.weights[i] * across(from + rule_.points[i] * (until - from)).turning;
        const auto [sine, cosine] = sine_cosine(angle);
        return cosine * there.a + sine * there.b;
    }

    void keep_knots(const std::vector<double>& knots, int around)
    {
        if (!is_closed_) {
            knots_ = knots_of_spline(knots);
            return;
        }
        knots_.assign(knots.begin() + around, knots.end() - around - 1);   // the seam is its first
    }

    /// The first normal lies in the plane of the curve where it has one.
    void carry_normals()
    {
        Vector3 plane{};
        double widest = 0;
        const Vector3 begin = unit(shape(0).first);
        for (const double s : places_) {
            const CurvePoint here = shape(s);
            if (!(norm(here.first) > 0.05))   // by chord lengths it is one where the curve is straight
                refuse_curve("the curve turns back on itself", "at the parameter " + to_text(s, 6),
                             "more points there", "curve-straight-back");
            const Vector3 normal = cross(begin, here.first);
            if (norm(normal) > widest) {
                widest = norm(normal);
                plane = normal;
            }
        }
        // Any normal serves a straight line; the axis of space that is far from it loses no digits.
        if (widest < 1e-9) {   // a straight line
            const Vector3 x{1, 0, 0}, y{0, 1, 0};
            plane = cross(begin, std::abs(begin[0]) < 0.7 ? x : y);
        }
        const Vector3 across = unit(plane);
        is_flat_ = std::ranges::all_of(places_, [&](double s) {
            const CurvePoint here = shape(s);
            return std::abs(dot(across, here.first)) <= flat &&
                   std::abs(dot(across, here.second)) <= flat * norm(here.second);
        });
        normals_.push_back(cross(across, begin));
        for (std::size_t i = 1; i < places_.size(); ++i)
            normals_.push_back(carried(normals_.back(), places_[i - 1], places_[i]));
    }

    std::vector<Piece> pieces_;              ///< the first before the first knot
    std::vector<std::size_t> first_piece_;   ///< of each cell
    double cells_per_length_ = 0;
    Quadrature rule_ = gauss(5);
    bool is_closed_, is_flat_ = false;
    double last_ = 0;   ///< the first is 0
    std::vector<double> knots_;
    std::vector<double> places_;
    std::vector<Vector3> normals_;   ///< there
};

}   // namespace

Curve spline_curve(const std::vector<Vector3>& points, bool is_closed)
{
    const auto spline = std::make_shared<const Spline>(points, is_closed);
    return {[spline](double s) { return spline->at(s); },
            0,
            spline->last(),
            is_closed,
            [spline](double s) { return spline->shape(spline->inside(s)); },
            spline->knots()};
}

}   // namespace livens
