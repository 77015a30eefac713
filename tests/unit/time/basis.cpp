// SPDX-License-Identifier: BSD-3-Clause
#include "livens/time/basis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "livens/base/error.h"
#include "livens/time/quadrature.h"

namespace livens::basis_test {
namespace {

// Where long double is double, differentiation matrices and the references here round more.
constexpr double slack = std::numeric_limits<long double>::digits > 53 ? 1 : 64;

constexpr double s_samples[] = {0.0, 1e-12, 0.013, 0.25, 0.4999999, 0.5, 0.77, 1 - 1e-9, 1.0};

/// Shifted Legendre polynomial and its derivative.
struct Sample {
    double value, derivative;
};
Sample legendre(int degree, double s)
{
    long double x = 2 * static_cast<long double>(s) - 1, p = 1, before = 0, d = 0, d_before = 0;
    for (int k = 0; k < degree; ++k) {
        const long double next = ((2 * k + 1) * x * p - k * before) / (k + 1);
        const long double d_next = ((2 * k + 1) * (p + x * d) - k * d_before) / (k + 1);
        before = p, p = next, d_before = d, d = d_next;
    }
    return {static_cast<double>(p), static_cast<double>(2 * d)};
}

Sample interpolate(const LagrangeBasis& basis, int degree, double s)
{
    std::vector<double> m(static_cast<std::size_t>(basis.size()));
    Sample sum{0, 0};
    basis.values(s, m);
    for (std::size_t a = 0; a < m.size(); ++a) sum.value += m[a] * legendre(degree, basis.nodes()[a]).value;
    basis.derivatives(s, m);
    for (std::size_t a = 0; a < m.size(); ++a)
        sum.derivative += m[a] * legendre(degree, basis.nodes()[a]).value;
    return sum;
}

TEST(LagrangeBasis, IsOneAtItsNodeAndZeroAtTheOthersToTheBit)
{
    for (int p = 1; p <= 32; ++p) {
        const LagrangeBasis basis = lobatto_basis(p);
        std::vector<double> m(static_cast<std::size_t>(basis.size()));
        for (std::size_t c = 0; c < m.size(); ++c) {
            basis.values(basis.nodes()[c], m);
            for (std::size_t a = 0; a < m.size(); ++a) EXPECT_EQ(m[a], a == c ? 1 : 0);
        }
    }
}

TEST(LagrangeBasis, IsAPartitionOfUnity)
{
    for (int p = 1; p <= 32; ++p) {
        const LagrangeBasis basis = lobatto_basis(p);
        std::vector<double> m(static_cast<std::size_t>(basis.size()));
        for (const double s : s_samples) {
            double sum = 0, slope = 0;
            basis.values(s, m);
            for (const double v : m) sum += v;
            basis.derivatives(s, m);
            for (const double v : m) slope += v;
            EXPECT_NEAR(sum, 1, 2e-15) << p << " " << s;
            EXPECT_NEAR(slope, 0, 1e-15 * p * p * 4) << p << " " << s;
        }
    }
}

TEST(LagrangeBasis, ReproducesPolynomialsAndDerivativesToItsDegree)
{
    for (const int p : {1, 2, 3, 5, 8, 16, 32}) {
        const LagrangeBasis basis = lobatto_basis(p);
        for (int degree = 0; degree <= p; ++degree) {
            for (const double s : s_samples) {
                const Sample exact = legendre(degree, s), found = interpolate(basis, degree, s);
                EXPECT_NEAR(found.value, exact.value, slack * 1e-14) << p << " " << degree << " " << s;
                EXPECT_NEAR(found.derivative, exact.derivative, slack * 1e-14 * p * p)
                    << p << " " << degree << " " << s;
            }
        }
    }
}

TEST(LagrangeBasis, DoesNotReproduceOneDegreeMore)
{
    for (const int p : {1, 2, 3, 5, 8, 16, 32}) {
        const LagrangeBasis basis = lobatto_basis(p);
        double worst = 0;
        for (const double s : s_samples) {
            worst = std::max(worst, std::fabs(interpolate(basis, p + 1, s).value - legendre(p + 1, s).value));
        }
        EXPECT_GT(worst, 0.01) << p;
    }
}

TEST(LagrangeBasis, ExtrapolatesStably)
{
    const LagrangeBasis basis = lobatto_basis(16);
    for (const double s : {-0.5, -1e-6, 1 + 1e-12, 1.3, 2.0}) {
        const Sample exact = legendre(16, s), found = interpolate(basis, 16, s);
        EXPECT_NEAR(found.value, exact.value, 1e-12 * (std::fabs(exact.value) + 1)) << s;
        EXPECT_NEAR(found.derivative, exact.derivative, 1e-12 * (std::fabs(exact.derivative) + 1)) << s;
    }
}

TEST(LagrangeBasis, DifferentiationMatrixHoldsTheDerivativesAtNodes)
{
    for (int p = 1; p <= 32; ++p) {
        const LagrangeBasis basis = lobatto_basis(p);
        const std::size_t n = static_cast<std::size_t>(basis.size());
        std::vector<double> m(n);
        for (std::size_t c = 0; c < n; ++c) {
            basis.derivatives(basis.nodes()[c], m);
            long double row = 0;
            double product_rule_worst = 0;
            for (std::size_t a = 0; a < n; ++a) {
                EXPECT_EQ(m[a], basis.differentiation()[c * n + a]);
                row += m[a];
                // Independent of the barycentric weights: M_A' = sum_k 1/(x_A - x_k) prod_{j != A, k} (x -
                // x_j)/(x_A - x_j).
                long double exact = 0;
                for (std::size_t k = 0; k < n; ++k) {
                    if (k == a) continue;
                    long double term = 1 / (static_cast<long double>(basis.nodes()[a]) - basis.nodes()[k]);
                    for (std::size_t j = 0; j < n; ++j) {
                        if (j == a || j == k) continue;
                        term *= (static_cast<long double>(basis.nodes()[c]) - basis.nodes()[j]) /
                                (static_cast<long double>(basis.nodes()[a]) - basis.nodes()[j]);
                    }
                    exact += term;
                }
                product_rule_worst =
                    std::max(product_rule_worst, std::fabs(static_cast<double>(exact) - m[a]));
            }
            EXPECT_LT(product_rule_worst, slack * (1e-15 * p * p + 1e-15)) << p;
            EXPECT_NEAR(static_cast<double>(row), 0, slack * 1e-16 * (2 * p * p + 1)) << p;
        }
    }
}

TEST(LagrangeBasis, TakesAnyAscendingNodes)
{
    const LagrangeBasis basis({-2, 0.5, 7});   // squares are reproduced
    std::vector<double> m(3);
    basis.values(3, m);
    EXPECT_NEAR(4 * m[0] + 0.25 * m[1] + 49 * m[2], 9, 1e-13);
    basis.derivatives(3, m);
    EXPECT_NEAR(4 * m[0] + 0.25 * m[1] + 49 * m[2], 6, 1e-13);

    std::vector<double> one(1);
    const LagrangeBasis constant({0.5});
    constant.values(0.1, one);
    EXPECT_EQ(one[0], 1);
    constant.values(0.9, one);
    EXPECT_EQ(one[0], 1);
    constant.derivatives(0.1, one);
    EXPECT_EQ(one[0], 0);
}

TEST(LagrangeBasis, SurvivesManyNodes)
{
    const LagrangeBasis basis(gauss_lobatto(64).points);
    const Sample exact = legendre(63, 0.123), found = interpolate(basis, 63, 0.123);
    EXPECT_NEAR(found.value, exact.value, 1e-13);
    EXPECT_NEAR(found.derivative, exact.derivative, 1e-10);
}

TEST(LagrangeBasis, StandsOnTheStartAndRadauPointsIfAsked)
{
    for (int p = 1; p <= 32; ++p) {
        const LagrangeBasis basis = basis_on(Points::radau, p);
        ASSERT_EQ(basis.degree(), p);
        EXPECT_EQ(basis.nodes().front(), 0.0);
        const std::vector<double> rest(basis.nodes().begin() + 1, basis.nodes().end());
        EXPECT_EQ(rest, radau(p).points);
        EXPECT_EQ(basis_on(Points::lobatto, p).nodes(), gauss_lobatto(p + 1).points);
    }
    EXPECT_THROW(basis_on(Points::radau, 0), InputError);
    EXPECT_THROW(basis_on(Points::radau, 33), InputError);
}

TEST(LagrangeBasis, RefusesBadNodesAndDegrees)
{
    EXPECT_THROW(LagrangeBasis({}), InputError);
    EXPECT_THROW(LagrangeBasis({0, 0}), InputError);
    EXPECT_THROW(LagrangeBasis({1, 0}), InputError);
    EXPECT_THROW(LagrangeBasis({0, NAN, 1}), InputError);
    EXPECT_THROW(lobatto_basis(0), InputError);
    EXPECT_THROW(lobatto_basis(33), InputError);
}

}   // namespace
}   // namespace livens::basis_test
