// SPDX-License-Identifier: BSD-3-Clause
#include "livens/time/time_laws.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "livens/base/error.h"

namespace livens::time_laws_test {
namespace {

/// Rates are central differences of values, and accelerations of rates.
void expect_rates(const TimeFunction& law, double t)
{
    constexpr double h = 1e-5;
    const TimeValue here = law({t}), before = law({t - h}), after = law({t + h});
    EXPECT_NEAR(here.first, (after.value - before.value) / (2 * h), 1e-7) << t;
    EXPECT_NEAR(here.second, (after.first - before.first) / (2 * h), 1e-6) << t;
}

TEST(TimeLaws, HaveTheRatesOfTheirValues)
{
    for (const TimeFunction& law : {ramp(1, 3, 0.5), harmonic(2, 0.7, 0.3), smooth_step(0.2, 1.7, 3),
                                    polynomial({1, -2, 0.5, 3}), shifted(smooth_step(0, 1, 1), 4)})
        for (const double t : {-0.4, 0.21, 0.7, 1.2, 1.69, 2.5}) expect_rates(law, t);
}

TEST(TimeLaws, BeginAndEndWhereTheySay)
{
    EXPECT_EQ(ramp(1, 3, 0.5)({0.5}).value, 1);
    EXPECT_EQ(ramp(1, 3, 0.5)({2.5}).value, 7);
    EXPECT_NEAR(harmonic(2, 0.25, 0)({1}).value, 2, 1e-15);
    EXPECT_EQ(polynomial({1, -2, 0.5})({2}).value, -1);
    EXPECT_EQ(polynomial({})({2}).value, 0);
    const TimeFunction step = smooth_step(1, 3, 5);
    for (const double t : {0.0, 1.0}) EXPECT_EQ(step({t}).value, 0);
    EXPECT_EQ(step({2}).value, 2.5);
    for (const double t : {3.0, 9.0}) {
        EXPECT_EQ(step({t}).value, 5);
        EXPECT_EQ(step({t}).first, 0);
    }
    EXPECT_EQ(step.breaks(), (std::vector<double>{1, 3}));
    EXPECT_NEAR(step({1 + 1e-6, Side::left}).second, 0, 1e-4) << "two continuous derivatives";
    EXPECT_EQ(shifted(step, 1)({9}).value, 6);
}

TEST(TimeLaws, GoStraightOnBeforeAndAfterATable)
{
    const TimeFunction table = spline_table({0, 1, 2, 3}, {0, 1, 8, 27}), law = straight_on(table, 0, 3);
    EXPECT_NEAR(law({1.5}).value, table({1.5}).value, 0);
    for (const double t : {-1.0, -1e-9, 0.0}) EXPECT_NEAR(law({t}).value, 0, 1e-12) << "its slope is 0 there";
    EXPECT_NEAR(law({4}).value, 27 + 27, 1e-12);
    for (const double t : {0.0, 3.0}) {
        const TimeValue before = law({t, Side::left}), after = law({t, Side::right});
        EXPECT_NEAR(before.value, after.value, 1e-14);
        EXPECT_NEAR(before.first, after.first, 1e-13);
    }
    EXPECT_EQ(law({4}).second, 0);
}

TEST(TimeLaws, AddUpWithTheirBreaks)
{
    const TimeFunction table = linear_table({0, 1, 2}, {1, 3, 0}), wave = harmonic(2, 0.7, 0.3);
    const TimeFunction sum = combination({2, -3, 0}, {table, wave, smooth_step(0.1, 0.3, 1)});
    EXPECT_EQ(sum.breaks(), (std::vector<double>{0, 1, 2})) << "what is not in it has no breaks in it";
    for (const double t : {0.2, 1.3}) {
        const TimeValue a = table({t}), b = wave({t}), all = sum({t});
        EXPECT_EQ(all.value, 2 * a.value - 3 * b.value);
        EXPECT_EQ(all.first, 2 * a.first - 3 * b.first);
        EXPECT_EQ(all.second, 2 * a.second - 3 * b.second);
    }
    EXPECT_TRUE(combination({2, 0}, {TimeFunction(1.5), wave}).is_constant());
    EXPECT_EQ(combination({2, 0}, {TimeFunction(1.5), wave})({0}).value, 3);
}

TEST(TimeLaws, RefuseWhatIsNoLaw)
{
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(ramp(nan, 0, 0), InputError);
    EXPECT_THROW(harmonic(1, nan, 0), InputError);
    EXPECT_THROW(harmonic(1e308, 1e308, 0), InputError) << "no number can be its acceleration";
    EXPECT_THROW(polynomial({0, nan}), InputError);
    EXPECT_THROW(smooth_step(1, 1, 2), InputError);
    EXPECT_THROW(shifted(ramp(0, 1, 0), nan), InputError);
}

}   // namespace
}   // namespace livens::time_laws_test
