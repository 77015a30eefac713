// SPDX-License-Identifier: BSD-3-Clause
#include "livens/time/quadrature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "livens/base/error.h"

namespace livens::quadrature_test {
namespace {

// Where long double is double, the computation itself rounds.
constexpr double slack = std::numeric_limits<long double>::digits > 53 ? 1 : 64;
constexpr double eps = slack * std::numeric_limits<double>::epsilon();

/// Error of the rule for the shifted Legendre polynomial of the given degree, whose integral over [0, 1] is 0
/// (1 for degree 0). Legendre polynomials stay within 1, so that errors are not hidden by the size of high
/// powers.
double legendre_error(const Quadrature& rule, int degree)
{
    long double sum = 0;
    for (std::size_t i = 0; i < rule.points.size(); ++i) {
        const long double x = 2 * static_cast<long double>(rule.points[i]) - 1;
        long double p = 1, next = x;
        for (int k = 0; k < degree; ++k) {
            const long double after = ((2 * k + 3) * x * next - (k + 1) * p) / (k + 2);
            p = next;
            next = after;
        }
        sum += rule.weights[i] * p;
    }
    return static_cast<double>(std::fabs(sum - (degree == 0 ? 1 : 0)));
}

void expect_symmetric_and_ascending(const Quadrature& rule)
{
    const std::size_t n = rule.points.size();
    ASSERT_EQ(rule.weights.size(), n);
    for (std::size_t i = 0; i < n; ++i) {
        if (i > 0) {
            EXPECT_LT(rule.points[i - 1], rule.points[i]);
        }
        if (2 * i < n) {
            EXPECT_EQ(rule.points[n - 1 - i], 1 - rule.points[i]);
        }
        EXPECT_EQ(rule.weights[i], rule.weights[n - 1 - i]);
        EXPECT_GT(rule.weights[i], 0);
    }
}

struct Known {
    int n, i;
    double point, weight;
};

void expect_close(const Quadrature& rule, const Known& known)
{
    const std::size_t i = static_cast<std::size_t>(known.i);
    EXPECT_NEAR(rule.points[i], known.point, 2 * eps * known.point) << known.n;
    EXPECT_NEAR(rule.weights[i], known.weight, 2 * eps * known.weight) << known.n;
}

TEST(Gauss, IsExactToItsDegreeAndNoFurther)
{
    for (int n = 1; n <= 64; ++n) {
        const Quadrature rule = gauss(n);
        for (int degree = 0; degree <= 2 * n - 1; ++degree) {
            EXPECT_LT(legendre_error(rule, degree), 4 * eps) << n << " points, degree " << degree;
        }
        EXPECT_GT(legendre_error(rule, 2 * n), 0.05) << n;
    }
}

TEST(Gauss, IsSymmetricToTheBit)
{
    for (int n = 1; n <= 64; ++n) expect_symmetric_and_ascending(gauss(n));
    EXPECT_EQ(gauss(5).points[2], 0.5);
}

// Computed with 40 digits.
TEST(Gauss, PointsAndWeightsAreRightToTheLastBits)
{
    expect_close(gauss(2), {2, 0, 0.5 - std::sqrt(3) / 6, 0.5});
    for (const Known& k : {Known{7, 0, 0.025446043828620736, 0.064742483084434851},
                           Known{7, 2, 0.29707742431130141, 0.19091502525255946},
                           Known{20, 3, 0.080441514088890595, 0.041638370788352377},
                           Known{33, 15, 0.45318446707263332, 0.046678213032798059},
                           Known{64, 0, 0.00034747913211393029, 0.00089164036084821651},
                           Known{64, 31, 0.48782485366828776, 0.024345478504569862}}) {
        expect_close(gauss(k.n), k);
    }
}

TEST(GaussLobatto, IsExactToItsDegreeAndNoFurther)
{
    for (int n = 2; n <= 64; ++n) {
        const Quadrature rule = gauss_lobatto(n);
        for (int degree = 0; degree <= 2 * n - 3; ++degree) {
            EXPECT_LT(legendre_error(rule, degree), 4 * eps) << n << " points, degree " << degree;
        }
        EXPECT_GT(legendre_error(rule, 2 * n - 2), 0.05) << n;
    }
}

TEST(GaussLobatto, IsSymmetricToTheBitWithBothEnds)
{
    for (int n = 2; n <= 64; ++n) {
        const Quadrature rule = gauss_lobatto(n);
        expect_symmetric_and_ascending(rule);
        EXPECT_EQ(rule.points.front(), 0);
        EXPECT_EQ(rule.points.back(), 1);
    }
}

TEST(GaussLobatto, PointsAndWeightsAreRightToTheLastBits)
{
    expect_close(gauss_lobatto(4), {4, 1, 0.5 - 0.5 / std::sqrt(5), 5.0 / 12});
    expect_close(gauss_lobatto(5), {5, 0, 0, 1.0 / 20});
    expect_close(gauss_lobatto(5), {5, 1, 0.5 - 0.5 * std::sqrt(3.0 / 7), 49.0 / 180});
    for (const Known& k : {Known{6, 1, 0.11747233803526766, 0.1892374781489235},
                           Known{9, 3, 0.31844126808691092, 0.17321425548652317},
                           Known{17, 1, 0.013433911684290843, 0.022460970271627106},
                           Known{33, 7, 0.11770649910323569, 0.031177683926232654},
                           Known{33, 15, 0.4517259059119465, 0.048123642486492729},
                           Known{64, 1, 0.00091006424891839244, 0.0015280041224562451},
                           Known{64, 31, 0.48763163618902061, 0.024731681810388324}}) {
        expect_close(gauss_lobatto(k.n), k);
    }
}

TEST(Radau, IsExactToItsDegreeAndNoFurther)
{
    for (int n = 1; n <= 64; ++n) {
        const Quadrature rule = radau(n);
        for (int degree = 0; degree <= 2 * n - 2; ++degree) {
            EXPECT_LT(legendre_error(rule, degree), 4 * eps) << n << " points, degree " << degree;
        }
        EXPECT_GT(legendre_error(rule, 2 * n - 1), 0.01 / n) << n;
    }
}

TEST(Radau, EndsWithOneToTheBit)
{
    for (int n = 1; n <= 64; ++n) {
        const Quadrature rule = radau(n);
        EXPECT_EQ(rule.points.back(), 1.0);
        EXPECT_GT(rule.points.front(), 0.0);
        for (int i = 1; i < n; ++i) EXPECT_LT(rule.points[i - 1], rule.points[i]) << n;
        for (const double w : rule.weights) EXPECT_GT(w, 0) << n;
    }
}

TEST(Radau, PointsAndWeightsAreRightToTheLastBits)
{
    const double root = std::sqrt(6.0);   // n = 3: (4 -+ root 6) / 10, (16 -+ root 6) / 36
    expect_close(radau(2), {2, 0, 1.0 / 3, 0.75});
    expect_close(radau(2), {2, 1, 1, 0.25});
    expect_close(radau(3), {3, 0, (4 - root) / 10, (16 - root) / 36});
    expect_close(radau(3), {3, 1, (4 + root) / 10, (16 + root) / 36});
    expect_close(radau(3), {3, 2, 1, 1.0 / 9});
}

TEST(Quadrature, RefusesRulesThatDoNotExist)
{
    EXPECT_THROW(gauss(0), InputError);
    EXPECT_THROW(gauss(65), InputError);
    EXPECT_THROW(gauss_lobatto(1), InputError);
    EXPECT_THROW(gauss_lobatto(-3), InputError);
    EXPECT_THROW(radau(0), InputError);
    EXPECT_THROW(radau(65), InputError);
}

}   // namespace
}   // namespace livens::quadrature_test
