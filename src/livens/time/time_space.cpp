// SPDX-License-Identifier: BSD-3-Clause
// Spaces of functions of time over a block of elements: Lagrange, B-splines and NURBS, and the lower degree
// of multipliers (Remark 3.1 of the paper). They are what (P17) and (P22) call temporal shape functions;
// theory.md, "The elements of the paper" uses them as M_A and L_A.
#include "livens/time/time_space.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/time/time_mesh.h"

namespace livens::inline time_internal {
namespace {

constexpr int max_degree = 8;
constexpr std::size_t max_functions = max_degree + 1;   // of one element
// Within these bounds no slope overflows: the largest is 8 / 1e-150 times a quotient of weights, 1e100.
constexpr double latest = 1e150, shortest = 1e-150;
constexpr double lightest = 1e-50, heaviest = 1e50;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Is it a time that can be computed with? False for nan.
bool is_usable(double t) { return std::abs(t) <= latest; }

std::string usable_times() { return "-" + to_text(latest) + " .. " + to_text(latest); }

void check_degree(int degree)
{
    if (degree >= 1 && degree <= max_degree) return;
    throw InputError({"degree", "method.degree", "there is no time basis of this degree",
                      std::to_string(degree), "1 .. " + std::to_string(max_degree), "", ""});
}

void check_count(double n_elements)
{
    if (n_elements >= 1 && n_elements <= most_elements) return;
    throw InputError({"time-elements", "time.elements", "the number of time elements is out of range",
                      to_text(n_elements), "1 .. " + to_text(most_elements), "", ""});
}

void check_ends(std::span<const double> ends)
{
    check_count(ends.empty() ? 0 : static_cast<double>(ends.size()) - 1);
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const std::string which = "element end " + std::to_string(i + 1);
        if (!is_usable(ends[i])) {
            throw InputError({"not-finite", "time.elements", which + " is no instant to compute with",
                              to_text(ends[i]), usable_times(), "", ""});
        }
        if (i == 0 || ends[i] - ends[i - 1] >= shortest) continue;
        throw InputError({"time-resolution", "time.elements", which + " does not lie after the one before it",
                          to_text(ends[i]), "> " + to_text(ends[i - 1]), "", ""});
    }
}

[[noreturn]] void refuse_knots(const char* code, const std::string& message, const std::string& value,
                               const std::string& bound, const std::string& help = "")
{
    throw InputError({code, "method.knots", message, value, bound, "", help});
}

void check_numbers(const std::vector<double>& knots)
{
    for (std::size_t i = 0; i < knots.size(); ++i) {
        const std::string which = "knot " + std::to_string(i + 1);
        if (!is_usable(knots[i])) {
            refuse_knots("knots-not-finite", which + " is no instant to compute with", to_text(knots[i]),
                         usable_times());
        }
        if (i == 0 || knots[i] == knots[i - 1]) continue;
        if (knots[i] < knots[i - 1]) {
            refuse_knots("knots-decreasing", which + " is smaller than the one before it", to_text(knots[i]),
                         ">= " + to_text(knots[i - 1]), "put the knots in order of time");
        }
        if (knots[i] - knots[i - 1] < shortest) {
            refuse_knots("knots-not-finite",
                         which + " is so close to the one before it that slopes are no numbers",
                         to_text(knots[i] - knots[i - 1]), ">= " + to_text(shortest),
                         "make the knots equal, or move them apart");
        }
    }
}

/// The first and the last knot stand degree + 1 times, those between at most degree times.
void check_multiplicities(int degree, const std::vector<double>& knots)
{
    const std::size_t n = knots.size();
    for (std::size_t i = 0, next = 0; i < n; i = next) {
        while (next < n && knots[next] == knots[i]) ++next;
        const std::size_t times = next - i;
        const std::string which = "knot " + std::to_string(i + 1) + ", " + to_text(knots[i]) + ",";
        const bool outer = i == 0 || next == n;
        if (outer && times != index(degree) + 1) {
            refuse_knots("knots-not-clamped",
                         which + " is an end of the time and must stand there degree + 1 times",
                         std::to_string(times) + (times == 1 ? " time" : " times"),
                         std::to_string(degree + 1) + " times",
                         "the first and the last knot are repeated degree times each");
        }
        if (!outer && times > index(degree)) {
            refuse_knots("knots-multiplicity",
                         which + " is repeated so often that the motion would be torn there",
                         std::to_string(times) + " times", "<= " + std::to_string(degree) + " times");
        }
    }
}

void check_knots(int degree, const std::vector<double>& knots)
{
    check_degree(degree);
    check_numbers(knots);
    const std::size_t fewest = 2 * (index(degree) + 1);
    if (knots.size() < fewest) {
        refuse_knots("knots-few", "there are too few knots for a spline of degree " + std::to_string(degree),
                     std::to_string(knots.size()), ">= " + std::to_string(fewest));
    }
    check_multiplicities(degree, knots);
    int n_elements = 0;
    for (std::size_t i = 1; i < knots.size(); ++i) n_elements += knots[i - 1] < knots[i];
    check_count(n_elements);
    if (degree <= n_elements) return;
    throw InputError({"spline-degree", "method.degree",
                      "the degree of a spline is larger than the number of its elements",
                      std::to_string(degree), "<= " + std::to_string(n_elements), "",
                      "use more elements or a lower degree"});
}

void check_weights(const std::vector<double>& weights, int n_functions)
{
    if (weights.size() != index(n_functions)) {
        throw InputError({"weights-count", "method.weights", "there must be one weight for every function",
                          std::to_string(weights.size()), std::to_string(n_functions), "",
                          "a spline has as many functions as knots, less its degree and one"});
    }
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] >= lightest && weights[i] <= heaviest) continue;   // false for nan
        const bool positive = weights[i] > 0 && std::isfinite(weights[i]);
        throw InputError(
            {"weights-not-positive", "method.weights",
             "weight " + std::to_string(i + 1) +
                 (positive ? " is beyond what can be computed with" : " must be positive and finite"),
             to_text(weights[i]), positive ? to_text(lightest) + " .. " + to_text(heaviest) : "> 0", "",
             "only ratios of weights matter"});
    }
}

/// The functions that are not zero in an element go from N_A to w_A N_A / W, W = sum_B w_B N_B.
///
/// The derivative is written as w_A sum_B w_B (N_A' N_B - N_A N_B') / W^2 (the quotient rule, multiplied
/// out): terms of A and B cancel to the bit in the sum over all functions, and a function near one, whose
/// derivative is small, loses no digits.
void make_rational(const double* weights, std::span<double> values, std::span<double> derivatives)
{
    const std::size_t n = values.size();
    double W = 0;
    for (std::size_t a = 0; a < n; ++a) W += weights[a] * values[a];
    std::array<double, max_functions> slopes{};
    for (std::size_t a = 0; a < n; ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            // Antisymmetric in a and b: what one function gains the other loses, so slopes add up to zero to
            // the bit.
            const double turn = derivatives[a] * values[b] - values[a] * derivatives[b];
            const double part = (weights[a] / W) * (weights[b] / W) * turn;
            slopes[a] += part;
            slopes[b] -= part;
        }
    }
    for (std::size_t a = 0; a < n; ++a) {
        values[a] = weights[a] * values[a] / W;
        derivatives[a] = slopes[a];
    }
}

}   // namespace

/// `shared` functions of an element are functions of the next one too.
TimeSpace TimeSpace::on_nodes(std::vector<double> ends, std::vector<double> nodes, int shared)
{
    TimeSpace space;
    space.degree_ = static_cast<int>(nodes.size()) - 1;
    space.ends_ = std::move(ends);
    space.local_.emplace(std::move(nodes));
    // Continuous functions share the node at an element end; those of lower multipliers share none.
    const int stride = space.degree_ + 1 - shared;
    space.first_.resize(index(space.n_elements()));
    for (int e = 0; e < space.n_elements(); ++e) space.first_[index(e)] = e * stride;
    space.size_ = space.n_elements() * stride + shared;
    return space;
}

/// The knots are as they must be, except that they may stand degree + 1 times inside too.
TimeSpace TimeSpace::on_knots(int degree, std::vector<double> knots)
{
    TimeSpace space;
    space.degree_ = degree;
    space.size_ = static_cast<int>(knots.size()) - degree - 1;
    // Elements are the knot spans of positive length; a repeated knot only lowers smoothness.
    for (std::size_t i = index(degree); i < index(space.size_); ++i) {
        if (knots[i] == knots[i + 1]) continue;
        space.ends_.push_back(knots[i]);
        space.first_.push_back(static_cast<int>(i) - degree);
    }
    space.ends_.push_back(knots.back());
    space.knots_ = std::move(knots);
    return space;
}

TimeSpace TimeSpace::lagrange(std::vector<double> ends, int degree)
{
    check_degree(degree);
    check_ends(ends);
    std::vector<double> nodes;
    for (int a = 0; a <= degree; ++a) nodes.push_back(static_cast<double>(a) / degree);
    return on_nodes(std::move(ends), std::move(nodes), 1);
}

TimeSpace TimeSpace::bspline(int degree, std::vector<double> knots)
{
    check_knots(degree, knots);
    return on_knots(degree, std::move(knots));
}

TimeSpace TimeSpace::nurbs(int degree, std::vector<double> knots, std::vector<double> weights)
{
    TimeSpace space = bspline(degree, std::move(knots));
    check_weights(weights, space.size());
    space.weights_ = std::move(weights);
    return space;
}

TimeSpace TimeSpace::lower() const
{
    assert(is_continuous());
    // The derivative of a spline of degree p is a spline of degree p - 1 on the same knots, one fewer at each
    // end.
    if (!local_) return on_knots(degree_ - 1, {knots_.begin() + 1, knots_.end() - 1});
    std::vector<double> nodes;
    // Nodes inside the element: these functions may jump at element ends, and no node is needed there.
    for (int a = 0; a < degree_; ++a) nodes.push_back((a + 0.5) / degree_);
    return on_nodes(ends_, std::move(nodes), 0);
}

bool TimeSpace::is_continuous() const
{
    if (degree_ == 0) return false;
    if (local_) return local_->nodes().front() == 0;
    // A knot of multiplicity m leaves the functions smooth of order degree - m, and moves `first` by m.
    const int p = degree_;
    return std::ranges::adjacent_find(first_, [p](int a, int b) { return b - a > p; }) == first_.end();
}

void TimeSpace::evaluate(int element, double s, std::span<double> values, std::span<double> derivatives) const
{
    assert(element >= 0 && element < n_elements());
    assert(s >= 0 && s <= 1);
    assert(values.size() == index(degree_) + 1 && derivatives.size() == values.size());
    if (!local_) {
        evaluate_splines(element, s, values, derivatives);
        if (is_rational()) make_rational(&weights_[index(first(element))], values, derivatives);
        return;
    }
    local_->values(s, values);
    local_->derivatives(s, derivatives);
    const double h = length(element);
    for (double& derivative : derivatives) derivative /= h;
}

/// N_A and N_A' by the recursion of Cox and de Boor over the degree [Piegl1997, eq. 2.5 and 2.7].
///
/// Nothing is subtracted but knots from knots: the distances from t to the knots are made of knot differences
/// and s h, so they are as accurate far from t = 0 as near to it. All terms of the values are positive. The
/// two quotients of a function are exactly 0 and 1 at the ends of the time, hence the values there are too.
void TimeSpace::evaluate_splines(int element, double s, std::span<double> values,
                                 std::span<double> derivatives) const
{
    const std::size_t p = index(degree_), span = index(first(element)) + p;   // t in [knot span, span + 1]
    const double h = length(element);
    std::array<double, max_functions + 1> before{}, after{};   // distances to knots span + 1 - j and span + j
    for (std::size_t j = 1; j <= p; ++j) {
        before[j] = (knots_[span] - knots_[span + 1 - j]) + s * h;
        after[j] = (knots_[span + j] - knots_[span + 1]) + (1 - s) * h;
    }
    values[0] = 1;
    derivatives[0] = 0;
    for (std::size_t j = 1; j <= p; ++j) {
        double saved = 0, slope_before = 0;
        for (std::size_t r = 0; r < j; ++r) {
            const double support = after[r + 1] + before[j - r];   // of the function r of degree j - 1
            const double previous = values[r];
            values[r] = saved + previous * (after[r + 1] / support);
            saved = previous * (before[j - r] / support);
            // N_A' of degree p takes the functions of degree p - 1, which are at hand in the last pass alone.
            if (j < p) continue;
            const double slope = degree_ * (previous / support);
            derivatives[r] = slope_before - slope;
            slope_before = slope;
        }
        values[j] = saved;
        if (j == p) derivatives[j] = slope_before;
    }
}

double TimeSpace::denominator(int element, double s) const
{
    if (!is_rational()) return 1;
    assert(element >= 0 && element < n_elements() && s >= 0 && s <= 1);
    std::array<double, max_functions> values{}, derivatives{};
    const std::size_t n = index(degree_) + 1;
    evaluate_splines(element, s, {values.data(), n}, {derivatives.data(), n});
    double W = 0;
    for (std::size_t a = 0; a < n; ++a) W += weights_[index(first(element)) + a] * values[a];
    return W;
}

std::vector<double> TimeSpace::highest_derivative(int element) const
{
    // The divided difference of the values at degree + 1 places is that derivative over its factorial.
    const int n = degree_ + 1;
    std::vector<double> result(static_cast<std::size_t>(n), 0.0), values(result), rates(result);
    for (int i = 0; i < n; ++i) {
        const double s = static_cast<double>(i) / degree_;
        evaluate(element, s, values, rates);
        double factor = denominator(element, s);
        for (int j = 0; j < n; ++j)
            if (j != i) factor *= static_cast<double>(degree_) / (i - j);
        for (int a = 0; a < n; ++a) result[a] += factor * values[a];
    }
    return result;
}

std::vector<double> TimeSpace::interpolation_points() const
{
    assert(is_continuous());
    std::vector<double> points;
    points.reserve(index(size_));
    if (local_) {
        for (int e = 0; e < n_elements(); ++e) {
            for (int a = 0; a < degree_; ++a) {
                points.push_back(ends_[index(e)] + local_->nodes()[index(a)] * length(e));
            }
        }
        points.push_back(ends_.back());
        return points;
    }
    for (std::size_t a = 1; a <= index(size_); ++a) {
        // The mean of knots a .. a + p - 1, by differences: p equal knots give themselves to the bit.
        double sum = 0;
        for (std::size_t j = 1; j < index(degree_); ++j) sum += knots_[a + j] - knots_[a];
        points.push_back(knots_[a] + sum / degree_);
    }
    return points;
}

TimeSpace::Place TimeSpace::place(double t) const
{
    assert(!std::isnan(t));
    const auto after = std::upper_bound(ends_.begin(), ends_.end(), t);
    const int element = std::clamp(static_cast<int>(after - ends_.begin()) - 1, 0, n_elements() - 1);
    // Rounding of t may leave s a little outside of [0, 1], where splines of the element are not defined.
    return {element, std::clamp((t - ends_[index(element)]) / length(element), 0.0, 1.0)};
}

std::vector<double> clamped_knots(int degree, std::span<const double> ends, std::span<const double> kinks)
{
    check_degree(degree);
    check_ends(ends);
    // A mesh may have moved a kink by this much when it merged instants, so the kink is sought within the
    // same distance.
    const double reach = nearest_ends * (ends.back() - ends.front());
    std::vector<int> times(ends.size(), 1);
    times.front() = times.back() = degree + 1;
    for (const double kink : kinks) {
        if (!(kink > ends.front() && kink < ends.back())) continue;
        const auto after = std::upper_bound(ends.begin(), ends.end(), kink) - ends.begin();
        const auto nearest = kink - ends[after - 1] <= ends[after] - kink ? after - 1 : after;
        if (nearest == 0 || nearest + 1 == static_cast<std::ptrdiff_t>(ends.size())) continue;
        if (std::abs(kink - ends[nearest]) <= reach) times[index(static_cast<int>(nearest))] = degree;
    }
    std::vector<double> knots;
    for (std::size_t i = 0; i < ends.size(); ++i) knots.insert(knots.end(), index(times[i]), ends[i]);
    return knots;
}

}   // namespace livens::inline time_internal
