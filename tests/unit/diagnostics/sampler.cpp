// SPDX-License-Identifier: BSD-3-Clause
#include "livens/diagnostics/detail/sampler.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/diagnostics/hand_made.h"

namespace livens::sampler_test {
namespace {

using hand_made::stacked;
using hand_made::torn_field;

Matrix34 wave(double t, double phase)
{
    Matrix34 X{};
    for (int i = 0; i < 12; ++i) X[i] = i + std::sin((1 + 0.1 * i) * t + phase);
    return X;
}

/// Two bodies, fields that jump, elements of unequal lengths.
Motion two_bodies(int degree, int degree_of_momenta, bool rational)
{
    Motion m;
    m.n_bodies = 2;
    m.mesh.ends = {-1, 0.5, 0.75, 2};
    const auto both = [](int e, double t) {
        std::vector<double> all = stacked(wave(t, e));
        const std::vector<double> other = stacked(wave(t, 7 - e));
        all.insert(all.end(), other.begin(), other.end());
        return all;
    };
    m.X = torn_field(m.mesh, 24, degree, both);
    m.P = torn_field(m.mesh, 24, degree_of_momenta, [&](int e, double t) { return both(e + 20, 2 * t); });
    for (Field* field : {&m.X, &m.P}) {
        if (!rational) continue;
        for (std::size_t i = 0; i < field->values.size() / 24; ++i)
            field->denominators.push_back(1.5 + std::cos(static_cast<double>(i)));
    }
    return m;
}

double difference(const std::vector<Matrix34>& bodies, const std::vector<double>& numbers)
{
    double most = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i)
        most = std::max(most, std::abs(bodies[i / 12][static_cast<int>(i % 12)] - numbers[i]));
    return most;
}

TEST(Sampler, AgreesWithTheFields)
{
    const std::vector<double> points{0, 0.1, 0.5, 0.8, 1};
    for (const bool rational : {false, true})
        for (const int degree : {1, 2, 5})
            for (const int degree_of_momenta : {0, 2, 3}) {
                const Motion m = two_bodies(degree, degree_of_momenta, rational);
                const ElementSampler sampler(m, points);
                ASSERT_TRUE(sampler.has_momenta());
                std::vector<Matrix34> bodies(2);
                std::vector<double> exact(24);
                for (int e = 0; e < 3; ++e)
                    for (int k = 0; k < sampler.size(); ++k) {
                        const double s = points[static_cast<std::size_t>(k)];
                        sampler.positions(e, k, bodies);
                        m.X.evaluate(e, s, 0, exact);
                        EXPECT_LT(difference(bodies, exact), 1e-14);
                        sampler.velocities(e, k, bodies);
                        m.X.evaluate(e, s, 1, exact);
                        for (double& x : exact) x /= m.mesh.length(e);
                        EXPECT_LT(difference(bodies, exact), 1e-13);
                        sampler.momenta(e, k, bodies);
                        m.P.evaluate(e, s, 0, exact);
                        EXPECT_LT(difference(bodies, exact), 1e-14);
                    }
            }
}

TEST(Sampler, HonoursDenominators)
{
    // One element, x = 0 and 1 at its ends with denominators 1 and 3: 3 s / (1 + 2 s).
    Motion m;
    m.n_bodies = 1;
    m.mesh.ends = {0, 0.5};
    m.X = {12, 1, true, std::vector<double>(24, 0.0), {1, 3}};
    m.X.coefficient(0, 1)[4] = 1;
    const ElementSampler sampler(m, {0.25});
    std::vector<Matrix34> X(1);
    sampler.positions(0, 0, X);
    EXPECT_DOUBLE_EQ(X[0][4], 0.5);
    sampler.velocities(0, 0, X);
    EXPECT_DOUBLE_EQ(X[0][4], 3 / (1.5 * 1.5) / 0.5);
    EXPECT_EQ(X[0][3], 0);
}

TEST(Sampler, GivesNodesToTheBit)
{
    const Motion m = two_bodies(4, 3, true);
    const ElementSampler sampler(m, gauss_lobatto(5).points);
    std::vector<Matrix34> X(2);
    for (int e = 0; e < 3; ++e)
        for (int k = 0; k < 5; ++k) {
            sampler.positions(e, k, X);
            const std::span<const double> c = m.X.coefficient(e, k);
            EXPECT_EQ(difference(X, {c.begin(), c.end()}), 0);
        }
    EXPECT_EQ(sampler.instant(1, 4).t, 0.75);
    EXPECT_EQ(sampler.instant(1, 4).side, Side::left);
    EXPECT_EQ(sampler.instant(2, 0).side, Side::right);
}

TEST(Sampler, KnowsBothSidesOfAnElementEnd)
{
    const Motion m = two_bodies(2, 1, false);
    std::vector<Matrix34> X(2);
    positions_at_end(m, 1, X);
    EXPECT_EQ(X[0], wave(0.5, 1));
    positions_before_end(m, 1, X);
    EXPECT_EQ(X[0], wave(0.5, 0));
    positions_at_end(m, 3, X);
    EXPECT_EQ(X[0], wave(2, 2)) << "no element starts there";
    Motion without = m;
    without.P = {};
    EXPECT_FALSE(ElementSampler(without, {0.5}).has_momenta());
}

}   // namespace
}   // namespace livens::sampler_test
