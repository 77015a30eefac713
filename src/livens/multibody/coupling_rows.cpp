// SPDX-License-Identifier: BSD-3-Clause
// Rows that are sums of functions of joint coordinates: screws, gears, racks, couplings, and laws of one
// coordinate. theory.md, "Coordinates of joints", has the derivatives and how turns are counted.
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/multibody/joint_coordinates.h"

namespace livens {

namespace {

using Point = SmoothFunction::Point;
using Value = SmoothFunction::Value;

[[noreturn]] void refuse_row(const char* code, const std::string& message, const std::string& value,
                             const std::string& bound, const std::string& note, const std::string& help)
{
    throw InputError({code, "", message, value, bound, note, help});
}

/// The largest number of which all are whole multiples, by Euclid's algorithm; 0: none of at most 10,000
/// parts.
double common_measure(const std::vector<double>& numbers)
{
    constexpr double rounding = 1e-11;   // of the largest factor: what decimals of a ratio leave
    double measure = 0, largest = 0;
    for (const double number : numbers) {
        double rest = std::abs(number);
        largest = std::max(largest, rest);
        // Remainders of Euclid's algorithm: what is left below rounding counts as zero.
        while (rest > rounding * largest)
            measure = std::exchange(rest, std::abs(std::remainder(measure, rest)));
    }
    return measure * 10000.5 >= largest ? measure : 0;   // by half a part for rounding
}

Value times(double factor, Value value)
{
    value.value *= factor;
    for (std::size_t i = 0; i < value.gradient.size(); ++i) {
        value.gradient[i] *= factor;
        for (double& one : value.hessian[i]) one *= factor;
    }
    return value;
}

/// Of atan2(s, c).
Value angle_of(double c, double s) { return coordinate_at(CoordinateKind::angle, {c, s}); }

/// How far an angle turns by a step, by cross and inner product: no difference of two angles, so no cut and
/// no cancellation.
double turn_by(const Point& q, const Point& step)
{
    return arc_tangent(q[0] * step[1] - q[1] * step[0], q[0] * (q[0] + step[0]) + q[1] * (q[1] + step[1]));
}

/// Angles take the shorter way round.
SmoothFunction multiple_of_angle(double factor)
{
    return {[factor](const Point& q) { return times(factor, angle_of(q[0], q[1])); },
            [factor](const Point& q, std::span<const Point> steps, std::span<Value> out) {
                for (std::size_t i = 0; i < steps.size(); ++i) {
                    const double c = q[0] + steps[i][0], s = q[1] + steps[i][1];
                    out[i] = times(factor, angle_of(c, s));
                    out[i].value = factor * turn_by(q, steps[i]);
                }
            },
            2};
}

SmoothFunction multiple(double factor)
{
    const auto at = [factor](double q) {
        Value value;
        value.value = factor * q;
        value.gradient[0] = factor;
        return value;
    };
    return {[at](const Point& q) { return at(q[0]); },
            [at](const Point&, std::span<const Point> steps, std::span<Value> out) {
                for (std::size_t i = 0; i < steps.size(); ++i) out[i] = at(steps[i][0]);
            }};
}

constexpr std::size_t rotation_forms = 4;   // no other coordinate is of as many
constexpr const char* rotation_ends =
    "the rotation vector of a ball joint gets to 175 degrees, where it ends";

double angle_left_of_rotation(const Point& q)
{
    return widest_rotation - coordinate_at(CoordinateKind::rotation_angle, q).value;
}

/// Whether the shortest turn from one place to the next leads over half a turn, where a rotation vector
/// begins again on the other side. Forms are s and c in any order of the first three.
bool leads_over_half_a_turn(const Point& from, const Point& to)
{
    return from[3] < 0 && to[3] < 0 && from[0] * to[0] + from[1] * to[1] + from[2] * to[2] < 0;
}

/// What does not count turns, times a number; of a rotation vector no number where nobody knows it.
SmoothFunction multiple_of_function(CoordinateKind kind, std::size_t n, double factor)
{
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const bool ends = kind == CoordinateKind::rotation_component;
    const auto at = [=](const Point& q) {
        Value value = times(factor, coordinate_at(kind, q));
        if (ends && !is_known(kind, q)) value.value = unknown;
        return value;
    };
    return {at,
            [at, ends](const Point& from, std::span<const Point> steps, std::span<Value> out) {
                const double before = at(from).value;
                for (std::size_t i = 0; i < steps.size(); ++i) {
                    Point to = from;
                    for (std::size_t k = 0; k < to.size(); ++k) to[k] += steps[i][k];
                    out[i] = at(to);
                    out[i].value = ends && leads_over_half_a_turn(from, to) ? unknown : out[i].value - before;
                }
            },
            n};
}

SmoothFunction multiple_of(const JointCoordinate& q, double factor)
{
    if (q.counts_turns()) return multiple_of_angle(factor);
    if (!q.is_angle()) return multiple(factor);
    return multiple_of_function(q.kind, q.forms.size(), factor);
}

// --- laws

/// A law of a coordinate that differs by `shift` from what its forms say.
struct ShiftedLaw {
    CoordinateLaw law;
    bool is_angle;
    double shift;

    double of_forms(const Point& q) const
    {
        if (!is_angle) return q[0] + shift;
        const double angle = arc_tangent(q[1], q[0]) + shift;
        // positions do not tell turns: the one that the law knows
        return law.period > 0 ? angle : turned_to(angle, 0.5 * (law.low + law.high));
    }
    double margin(double q) const
    {
        return law.period > 0 ? std::numeric_limits<double>::infinity() : std::min(q - law.low, law.high - q);
    }
    TimeValue at(double q) const
    {
        // A motion may stand at the very end of a law, but for rounding.
        const double slack = 1e-9 * (law.high - law.low);
        if (margin(q) < -slack) {
            constexpr double none = std::numeric_limits<double>::quiet_NaN();
            return {none, none, none};
        }
        if (!(law.period > 0)) return law.at({q});
        const double rounds = std::floor((q - law.low) / law.period);
        TimeValue value = law.at({q - rounds * law.period});
        value.value += rounds * law.rise;
        return value;
    }
    /// -law, by the chain rule through the forms.
    Value negative(const Point& q, const TimeValue& f) const
    {
        Value out;
        out.value = -f.value;
        if (!is_angle) {
            out.gradient[0] = -f.first;
            out.hessian[0][0] = -f.second;
            return out;
        }
        const Value angle = angle_of(q[0], q[1]);
        for (std::size_t k = 0; k < 2; ++k) {
            out.gradient[k] = -f.first * angle.gradient[k];
            for (std::size_t l = 0; l < 2; ++l)
                out.hessian[k][l] =
                    -f.second * angle.gradient[k] * angle.gradient[l] - f.first * angle.hessian[k][l];
        }
        return out;
    }
    Value after(const Point& from, const Point& step) const
    {
        const double before = of_forms(from), way = is_angle ? turn_by(from, step) : step[0];
        const TimeValue f = at(before + way);
        Value out = negative({from[0] + step[0], from[1] + step[1]}, f);
        out.value = at(before).value - f.value;
        return out;
    }
    SmoothFunction function() const
    {
        return {[all = *this](const Point& q) { return all.negative(q, all.at(all.of_forms(q))); },
                [all = *this](const Point& from, std::span<const Point> steps, std::span<Value> out) {
                    for (std::size_t i = 0; i < steps.size(); ++i) out[i] = all.after(from, steps[i]);
                },
                is_angle ? std::size_t{2} : std::size_t{1}};
    }
};

/// What angles add to Phi with each turn.
std::vector<double> factors_of_angles(const std::vector<CoupledCoordinate>& terms)
{
    std::vector<double> factors;
    for (const auto& [factor, coordinate] : terms)
        if (coordinate.counts_turns()) factors.push_back(factor);
    return factors;
}

/// -law(q) as the first function of a row; to the factors of angles what it adds with each turn.
void add_law(ConstraintRow& row, const CoupledLaw& of, std::vector<double>& angles)
{
    const ShiftedLaw law{of.law, of.coordinate.is_angle(), of.shift};
    row.coordinates = of.coordinate.forms;
    row.functions = {law.function()};
    if (of.law.rise != 0 && law.is_angle) angles.push_back(of.law.rise / of.law.period);
    if (!(of.law.period > 0) && std::isfinite(of.law.high - of.law.low))
        row.edges = {{[law](const Point& q) { return law.margin(law.of_forms(q)); }, of.law.high - of.law.low,
                      of.what}};
    if (!of.law.knots.empty())
        row.guard = {{of.law.knots, of.law.period}, [law](const Point& q) { return law.of_forms(q); }};
}

/// Where rotation vectors end, beside what the first function has.
void add_ends_of_rotations(ConstraintRow& row)
{
    constexpr double never = std::numeric_limits<double>::infinity();
    for (std::size_t m = 0; m < row.functions.size(); ++m) {
        if (row.functions[m].n != rotation_forms) continue;
        while (row.edges.size() < m) row.edges.push_back({[](const Point&) { return never; }, 1, ""});
        row.edges.push_back({angle_left_of_rotation, 1, rotation_ends});
    }
}

}   // namespace

ConstraintRow coupling_row(const std::vector<CoupledCoordinate>& terms, double constant, double scale,
                           const std::string& label, const CoupledLaw* law)
{
    ConstraintRow row;
    std::vector<double> angles = factors_of_angles(terms);
    if (law != nullptr) add_law(row, *law, angles);
    for (const auto& [factor, coordinate] : terms) {
        if (!std::isfinite(factor) || factor == 0)
            refuse_row("joint-row", "the factor of a coordinate must be finite and not zero", to_text(factor),
                       "", "", "");
        row.coordinates.insert(row.coordinates.end(), coordinate.forms.begin(), coordinate.forms.end());
        row.functions.push_back(multiple_of(coordinate, factor));
    }
    if (terms.empty()) refuse_row("joint-row", "a row couples at least one coordinate", "", "", "", "");
    add_ends_of_rotations(row);
    // After a whole turn of every angle the bodies stand as before; all the multiples of this period are one
    // position. It exists only for ratios of whole numbers: each angle is known up to whole turns.
    const double measure = common_measure(angles);
    if (!angles.empty() && measure == 0)
        refuse_row("gear-ratio", "the angles of a coupling turn in no ratio of whole numbers up to 10000", "",
                   "",
                   "after one turn of one wheel the other would stand where no tooth is, so positions do not "
                   "tell whether the constraint holds",
                   "give the ratio of two numbers of teeth");
    row.body_i = row.coordinates.front().body_i;
    row.body_j = row.coordinates.front().body_j;
    row.scale = scale;
    row.label = label;
    row.period = 2 * std::numbers::pi * measure;
    row.c = -constant;
    return row;
}

}   // namespace livens
