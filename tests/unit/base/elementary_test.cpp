// SPDX-License-Identifier: BSD-3-Clause
#include "livens/base/elementary.h"

#include <gtest/gtest.h>

#include <limits>

namespace livens::elementary_test {

namespace {

/// Of the last place of a number.
double unit(double x) { return std::nextafter(std::abs(x), 1e300) - std::abs(x); }

TEST(Elementary, SineAndCosineAreRightToAUnitInTheLastPlace)
{
    for (int i = -200000; i <= 200000; ++i) {
        const double x = 0.85 * i / 200000;
        const auto [s, c] = sine_cosine(x);
        const long double wide = x;   // what the series beneath 0.8 knows nothing of
        ASSERT_LE(std::abs(static_cast<double>(s - std::sin(wide))), unit(s)) << x;
        ASSERT_LE(std::abs(static_cast<double>(c - std::cos(wide))), unit(c)) << x;
    }
    EXPECT_EQ(sine_cosine(0).sine, 0);
    EXPECT_EQ(sine_cosine(0).cosine, 1);
    EXPECT_EQ(sine_cosine(1e-200).sine, 1e-200);
}

TEST(Elementary, LargeAnglesKeepTheirDigits)
{
    // To 20 digits: 0.90929742682568169540, -0.41614683654714238700; the others by another program.
    EXPECT_NEAR(sine_cosine(2).sine, 0.9092974268256817, 2e-16);
    EXPECT_NEAR(sine_cosine(2).cosine, -0.4161468365471424, 1e-16);
    EXPECT_NEAR(sine_cosine(1e5).sine, 0.03574879797201651, 1e-17);
    EXPECT_NEAR(sine_cosine(-1e5).cosine, -0.9993608074382124, 2e-16);
    EXPECT_TRUE(std::isnan(sine_cosine(std::numeric_limits<double>::infinity()).sine));
    EXPECT_TRUE(std::isnan(sine_cosine(std::numeric_limits<double>::quiet_NaN()).cosine));
}

/// Beside zeros of both, where digits cancel, and on both sides of the last angle that is reduced here.
TEST(Elementary, TurnsAreTakenOffWithoutLosingDigits)
{
    const auto look = [](double x) {
        const auto [s, c] = sine_cosine(x);
        const long double wide = x;
        ASSERT_LE(std::abs(static_cast<double>(s - std::sin(wide))), unit(s)) << x;
        ASSERT_LE(std::abs(static_cast<double>(c - std::cos(wide))), unit(c)) << x;
    };
    for (int k = 1; k < 640000; k += 1 + k / 1000) {
        const double zero = k * 1.5707963267948966;
        for (const double x : {zero, std::nextafter(zero, 0), -zero, zero + 0.7853981633974483, zero - 0.3})
            look(x);
    }
    for (const double x : {0.8, 0.80000001, -0.80000001, 999999.9, 1e6, -1e6, 1000000.1, 1e15, -1e300})
        look(x);
}

TEST(Elementary, InversesUndoThem)
{
    for (const double angle : {-3.1, -1.5, -1e-9, 0.3, 0.75, 2.9}) {
        const auto [s, c] = sine_cosine(angle);
        EXPECT_NEAR(arc_tangent(s, c), angle, 5e-16);
        if (std::abs(angle) < 1) {
            EXPECT_NEAR(arc_sine(s), angle, 3e-16);
        }
    }
    EXPECT_DOUBLE_EQ(hypotenuse(3e-200, -4e-200, 12e-200), 13e-200);
    EXPECT_EQ(hypotenuse(3e300, 4e300, 0), 5e300);
    EXPECT_NEAR(logarithm(10), 2.302585092994046, 5e-16);
    EXPECT_NEAR(exponential(-1), 0.36787944117144233, 1e-16);
    EXPECT_NEAR(power(2, 0.5), 1.4142135623730951, 3e-16);
    EXPECT_EQ(power(10, -3), 1e-3);
    EXPECT_EQ(power(0, 0.7), 0);
}

}   // namespace

}   // namespace livens::elementary_test
