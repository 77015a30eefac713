// SPDX-License-Identifier: BSD-3-Clause
#include "properties/basis_kit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <utility>

#include "livens/time/quadrature.h"

namespace livens {
namespace {

constexpr double samples[] = {0.0, 1e-9, 0.1, 0.25, 0.5, 0.61, 0.875, 1 - 1e-12, 1.0};

std::string place_of(int element, double s)
{
    return " in element " + std::to_string(element) + " at s = " + number(s);
}

struct Functions {
    std::vector<double> values, derivatives;
};

Functions functions(const BasisCase& basis, int element, double s)
{
    const std::size_t n = static_cast<std::size_t>(basis.space.degree()) + 1;
    Functions f{std::vector<double>(n), std::vector<double>(n)};
    basis.evaluate(element, s, f.values, f.derivatives);
    return f;
}

using Column = std::vector<double>;

double length_of(const Column& v)
{
    double sum = 0;
    for (const double x : v) sum += x * x;
    return std::sqrt(sum);
}

/// Takes off what lies in the span of the orthonormal columns; what is left, relative to what there was.
double reduce(Column& v, const std::vector<Column>& Q)
{
    const double before = length_of(v);
    for (int sweep = 0; sweep < 2; ++sweep) {   // twice is enough for orthogonality to rounding
        for (const Column& q : Q) {
            double along = 0;
            for (std::size_t i = 0; i < v.size(); ++i) along += q[i] * v[i];
            for (std::size_t i = 0; i < v.size(); ++i) v[i] -= along * q[i];
        }
    }
    return before > 0 ? length_of(v) / before : 0;
}

/// Orthonormal columns of the same span, and the smallest part of a column that was not in those before it.
double orthonormalise(std::vector<Column>& columns)
{
    double smallest = 1;
    std::vector<Column> Q;
    for (Column& v : columns) {
        smallest = std::min(smallest, reduce(v, Q));
        const double length = length_of(v);
        if (length > 0) {
            for (double& x : v) x /= length;
        }
        Q.push_back(v);
    }
    columns = std::move(Q);
    return smallest;
}

struct Sample {
    int element;
    double s;
};

/// More points in every element than there are functions: no function of the space vanishes at all of them.
std::vector<Sample> dense_samples(const TimeSpace& space)
{
    std::vector<Sample> all;
    const Quadrature rule = gauss(space.degree() + 4);
    for (int e = 0; e < space.n_elements(); ++e) {
        for (const double s : rule.points) all.push_back({e, s});
    }
    return all;
}

/// Every function of the space (or its derivative) at the samples.
std::vector<Column> columns_at(const BasisCase& basis, const std::vector<Sample>& at, bool derivatives)
{
    std::vector<Column> columns(static_cast<std::size_t>(basis.space.size()), Column(at.size(), 0.0));
    for (std::size_t i = 0; i < at.size(); ++i) {
        const Functions f = functions(basis, at[i].element, at[i].s);
        const std::size_t first = static_cast<std::size_t>(basis.space.first(at[i].element));
        for (std::size_t a = 0; a < f.values.size(); ++a) {
            columns[first + a][i] = derivatives ? f.derivatives[a] : f.values[a];
        }
    }
    return columns;
}

double legendre(int degree, double x)
{
    double p = 1, before = 0;
    for (int k = 0; k < degree; ++k) before = std::exchange(p, ((2 * k + 1) * x * p - k * before) / (k + 1));
    return p;
}

}   // namespace

BasisCase basis_case(std::string family, std::string what, TimeSpace space, int exactness,
                     std::vector<int> smoothness)
{
    BasisCase basis{std::move(family),
                    std::move(what),
                    space,
                    exactness,
                    std::move(smoothness),
                    [space](int element, double s, std::span<double> values, std::span<double> derivatives) {
                        space.evaluate(element, s, values, derivatives);
                    },
                    std::nullopt,
                    {}};
    if (basis.family != "lower") basis.lower = space.lower();
    if (space.is_continuous()) basis.points = space.interpolation_points();
    return basis;
}

Failures check_basis_unity(const BasisCase& basis)
{
    Failures failures;
    const TimeSpace& space = basis.space;
    const int last = space.n_elements() - 1;
    if (space.first(0) != 0 || space.first(last) + space.degree() + 1 != space.size())
        failures.push_back("functions are not numbered from the first to the last");
    for (int e = 0; e <= last; ++e) {
        const int step = e == 0 ? 1 : space.first(e) - space.first(e - 1);
        if (step < 1 || step > space.degree() + 1)
            failures.push_back("numbers jump at element " + std::to_string(e));
        for (const double s : samples) {
            const Functions f = functions(basis, e, s);
            double sum = -1, slope = 0, largest = 0, least = 0;
            for (std::size_t a = 0; a < f.values.size(); ++a) {
                sum += f.values[a];
                slope += f.derivatives[a];
                largest = std::max(largest, std::abs(f.derivatives[a]));
                least = std::min(least, f.values[a]);
            }
            if (!(std::abs(sum) < 4e-15)) failures.push_back("sum is off by " + number(sum) + place_of(e, s));
            if (!(std::abs(slope) <= 1e-14 * largest))
                failures.push_back("sum of derivatives is " + number(slope) + place_of(e, s));
            if (basis.family != "lagrange" && basis.family != "lower" && least < 0)
                failures.push_back("a function is " + number(least) + place_of(e, s));
        }
    }
    if (!space.is_continuous()) return failures;
    const Functions at_start = functions(basis, 0, 0), at_end = functions(basis, last, 1);
    for (std::size_t a = 0; a < at_start.values.size(); ++a) {
        if (at_start.values[a] != (a == 0) || at_end.values[a] != (a + 1 == at_end.values.size()))
            failures.push_back("ends are not met by function " + std::to_string(a));
    }
    return failures;
}

Failures check_basis_exactness(const BasisCase& basis)
{
    Failures failures;
    const TimeSpace& space = basis.space;
    const std::vector<Sample> at = dense_samples(space);
    std::vector<Column> Q = columns_at(basis, at, false);
    orthonormalise(Q);
    const double start = space.ends().front(), end = space.ends().back();
    for (int degree = 0; degree <= basis.exactness + 1; ++degree) {
        Column polynomial;
        for (const Sample& sample : at) {
            const std::size_t e = static_cast<std::size_t>(sample.element);
            const double t = (space.ends()[e] - start) + sample.s * space.length(sample.element);
            polynomial.push_back(legendre(degree, 2 * t / (end - start) - 1));
        }
        const double left = reduce(polynomial, Q);
        const std::string which = "the polynomial of degree " + std::to_string(degree);
        if (degree <= basis.exactness && !(left < 1e-12))
            failures.push_back(which + " is off by " + number(left));
        if (degree > basis.exactness && !(left > 1e-11))
            failures.push_back(which + " should not be in the space: " + number(left));
    }
    return failures;
}

Failures check_basis_derivatives(const BasisCase& basis)
{
    // f'(0) d = sum_k c_k f(k d), k = 0..8, with c_k = (-1)^(k+1) binomial(8, k) / k and c_0 = - sum of the
    // others: the derivative of the polynomial through nine points. Rounding is 65 eps / d. A quotient R is
    // no polynomial, but R W is, so (R W)' = R' W + R W' is what is compared.
    constexpr double c[9] = {-761.0 / 280, 8, -14, 56.0 / 3, -35.0 / 2, 56.0 / 5, -14.0 / 3, 8.0 / 7, -0.125};
    Failures failures;
    for (int e = 0; e < basis.space.n_elements(); ++e) {
        const double h = basis.space.length(e);
        for (const double s : samples) {
            const double d = s < 0.5 ? 1.0 / 64 : -1.0 / 64;   // inwards
            const Functions f = functions(basis, e, s);
            const double W = basis.space.denominator(e, s);
            Column off(f.values.size(), 0.0);
            for (int k = 0; k <= 8; ++k) {
                const Functions there = functions(basis, e, s + k * d);
                const double W_there = basis.space.denominator(e, s + k * d);
                for (std::size_t a = 0; a < off.size(); ++a)
                    off[a] += c[k] / d * (f.values[a] * W_there - there.values[a] * W_there);
            }
            for (std::size_t a = 0; a < off.size(); ++a) {
                off[a] += f.derivatives[a] * h * W;
                if (!(std::abs(off[a]) < 1e-11))
                    failures.push_back("derivative of function " + std::to_string(a) + " is off by " +
                                       number(off[a]) + " / h" + place_of(e, s));
            }
        }
    }
    return failures;
}

namespace {

/// Entry A belongs to function A of the space; zero for functions that are not in the element.
struct OneSided {
    Column derivatives;
    double rounding = 0;   ///< what the rounding of values becomes in them
};

/// Derivative k by time, at an end of the element, of the polynomials that the functions are, times the
/// denominator: found from their values.
OneSided one_sided(const BasisCase& basis, int element, bool at_end, int order)
{
    const TimeSpace& space = basis.space;
    const LagrangeBasis nodes = lobatto_basis(std::max(1, space.degree()));
    const std::size_t n = nodes.nodes().size(), row = at_end ? n - 1 : 0;
    Column weights(n, 0.0);   // of values at the nodes: a row of the differentiation matrix to the power k
    weights[row] = 1;
    for (int k = 0; k < order; ++k) {
        Column next(n, 0.0);
        for (std::size_t c = 0; c < n; ++c) {
            for (std::size_t b = 0; b < n; ++b)
                next[b] += weights[c] * nodes.differentiation()[c * n + b] / space.length(element);
        }
        weights = next;
    }
    OneSided all{Column(static_cast<std::size_t>(space.size()), 0.0), 0};
    for (std::size_t c = 0; c < n; ++c) {
        const double s = nodes.nodes()[c], W = space.denominator(element, s);
        const Functions f = functions(basis, element, s);
        for (std::size_t a = 0; a < f.values.size(); ++a)
            all.derivatives[static_cast<std::size_t>(space.first(element)) + a] +=
                weights[c] * W * f.values[a];
        all.rounding += std::numeric_limits<double>::epsilon() * W * std::abs(weights[c]);
    }
    return all;
}

struct Jump {
    double largest = 0;   ///< of any function
    double scale = 0;     ///< the largest entry on either side
};

Jump jump_between(const Column& before, const Column& after)
{
    Jump jump;
    for (std::size_t a = 0; a < before.size(); ++a) {
        jump.largest = std::max(jump.largest, std::abs(after[a] - before[a]));
        jump.scale = std::max({jump.scale, std::abs(before[a]), std::abs(after[a])});
    }
    return jump;
}

/// The same of the derivatives as they are given.
Jump jump_of_slopes(const BasisCase& basis, int element)
{
    Column sides[2];
    for (int side = 0; side < 2; ++side) {
        sides[side].assign(static_cast<std::size_t>(basis.space.size()), 0.0);
        const Functions f = functions(basis, element + side, side == 0 ? 1 : 0);
        const std::size_t first = static_cast<std::size_t>(basis.space.first(element + side));
        std::copy(f.derivatives.begin(), f.derivatives.end(),
                  sides[side].begin() + static_cast<std::ptrdiff_t>(first));
    }
    return jump_between(sides[0], sides[1]);
}

}   // namespace

Failures check_basis_smoothness(const BasisCase& basis)
{
    Failures failures;
    const int n_inner = basis.space.n_elements() - 1;
    if (basis.smoothness.size() != static_cast<std::size_t>(n_inner))
        return {"smoothness is not known for every inner element end"};
    for (int e = 0; e < n_inner; ++e) {
        const int smoothness = basis.smoothness[static_cast<std::size_t>(e)];
        for (int k = 0; k <= smoothness + 1; ++k) {
            const OneSided before = one_sided(basis, e, true, k), after = one_sided(basis, e + 1, false, k);
            const Jump jump = jump_between(before.derivatives, after.derivatives);
            const double allowed = 64 * (before.rounding + after.rounding);
            const std::string what = "derivative " + std::to_string(k) + " after element " +
                                     std::to_string(e) + " jumps by " + number(jump.largest);
            if (k <= smoothness && !(jump.largest < allowed)) failures.push_back(what);
            if (k > smoothness && !(jump.largest > std::max(1e-3 * jump.scale, allowed)))
                failures.push_back(what + " only");
        }
        const Jump slopes = jump_of_slopes(basis, e);
        if (smoothness >= 1 && !(slopes.largest < 1e-13 * slopes.scale))
            failures.push_back("the given derivative jumps after element " + std::to_string(e));
    }
    if (basis.space.is_continuous() == (std::ranges::count(basis.smoothness, -1) > 0))
        failures.push_back("is_continuous() is wrong");
    return failures;
}

Failures check_basis_interpolation(const BasisCase& basis)
{
    if (!basis.space.is_continuous()) return {};
    Failures failures;
    const std::vector<double>& points = basis.points;
    if (points.size() != static_cast<std::size_t>(basis.space.size()))
        return {"there are " + std::to_string(points.size()) + " points for " +
                std::to_string(basis.space.size()) + " functions"};
    if (points.front() != basis.space.ends().front() || points.back() != basis.space.ends().back())
        failures.push_back("the points do not reach from end to end");
    if (std::ranges::adjacent_find(points, std::greater_equal<>()) != points.end())
        failures.push_back("the points do not ascend");
    std::vector<Sample> at;
    for (const double t : points) {
        const TimeSpace::Place place = basis.space.place(t);
        at.push_back({place.element, place.s});
    }
    std::vector<Column> columns = columns_at(basis, at, false);
    const double pivot = orthonormalise(columns);
    if (!(pivot > 1e-3)) failures.push_back("interpolation is singular: pivot " + number(pivot));
    return failures;
}

Failures check_basis_lower(const BasisCase& basis)
{
    if (!basis.lower) return {};
    Failures failures;
    const TimeSpace &space = basis.space, &lower = *basis.lower;
    if (lower.size() != space.size() - 1) failures.push_back("lower() has " + std::to_string(lower.size()));
    if (lower.degree() != space.degree() - 1) failures.push_back("lower() has not one degree less");
    if (lower.ends() != space.ends()) return {"lower() has other elements"};
    if (lower.is_rational()) failures.push_back("lower() has weights");
    const BasisCase below = basis_case("lower", "", lower, 0, {});
    for (const std::string& failure : check_basis_unity(below)) failures.push_back("lower(): " + failure);
    if (space.is_rational()) return failures;

    const std::vector<Sample> at = dense_samples(space);
    std::vector<Column> Q = columns_at(below, at, false);
    orthonormalise(Q);
    for (Column& slope : columns_at(basis, at, true)) {
        const double left = reduce(slope, Q);
        if (!(left < 1e-12)) failures.push_back("a derivative is not in lower(): " + number(left));
    }
    return failures;
}

Failures check_basis(const BasisCase& basis)
{
    Failures all;
    for (const auto check : {check_basis_unity, check_basis_exactness, check_basis_derivatives,
                             check_basis_smoothness, check_basis_interpolation, check_basis_lower})
        for (const std::string& failure : check(basis))
            all.push_back(basis.family + ", " + basis.what + ": " + failure);
    return all;
}

}   // namespace livens
