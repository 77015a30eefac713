// SPDX-License-Identifier: BSD-3-Clause
#include "livens/time/time_function.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "livens/base/error.h"

namespace livens::time_function_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double value(const TimeFunction& f, double t, Side side = Side::middle) { return f({t, side}).value; }

template <class Make>
Complaint complaint_of(Make make)
{
    try {
        make();
    } catch (const InputError& error) {
        return error.complaint();
    }
    return {};
}

void expect_value(const TimeValue& found, const TimeValue& exact, double tolerance)
{
    EXPECT_NEAR(found.value, exact.value, tolerance);
    EXPECT_NEAR(found.first, exact.first, tolerance * 10);
    EXPECT_NEAR(found.second, exact.second, tolerance * 100);
}

TEST(TimeFunction, ANumberIsTheConstantFunction)
{
    const TimeFunction f = 3.5;
    EXPECT_TRUE(f.is_constant());
    expect_value(f({-7, Side::left}), {3.5, 0, 0}, 0);
    EXPECT_THROW(TimeFunction{NAN}, InputError);
    EXPECT_THROW(TimeFunction{infinity}, InputError);
}

TEST(TimeFunction, MiddleIsTheRightHandSide)
{
    const TimeFunction f([](Instant at) { return TimeValue{static_cast<double>(at.side), 0, 0}; }, {});
    EXPECT_EQ(value(f, 0, Side::middle), 1);
    EXPECT_EQ(value(f, 0, Side::left), -1);
}

TEST(Window, OpensAndClosesOnTheRightSides)
{
    const TimeFunction f = window(2, 1, 3);
    EXPECT_FALSE(f.is_constant());
    EXPECT_EQ(f.breaks(), (std::vector<double>{1, 3}));
    EXPECT_EQ(value(f, 0.5), 0);
    EXPECT_EQ(value(f, 1, Side::left), 0);
    EXPECT_EQ(value(f, 1, Side::right), 2);
    EXPECT_EQ(value(f, 1), 2);
    EXPECT_EQ(value(f, 3, Side::left), 2);
    EXPECT_EQ(value(f, 3, Side::right), 0);
    EXPECT_EQ(value(f, 3), 0);
    EXPECT_EQ(value(f, 9), 0);
}

TEST(Window, KeepsTheBreaksOfWhatItShows)
{
    const TimeFunction table = linear_table({0, 1, 2, 3}, {0, 1, 0, 5});
    EXPECT_EQ(window(table, 0.5, 2).breaks(), (std::vector<double>{0.5, 1, 2}));
    EXPECT_EQ(value(window(table, 0.5, 2), 0.75), 0.75);
    EXPECT_TRUE(window(1, -infinity, infinity).breaks().empty());
    EXPECT_EQ(window(1, -infinity, 4).breaks(), (std::vector<double>{4}));
    EXPECT_EQ(value(window(1, -infinity, 4), -1e300), 1);
}

TEST(Window, RefusesToCloseBeforeItOpens)
{
    EXPECT_EQ(complaint_of([] { window(1, 2, 2); }).path, "load.until");
    EXPECT_THROW(window(1, 2, 1), InputError);
    EXPECT_THROW(window(1, NAN, 1), InputError);
    EXPECT_THROW(window(1, 0, NAN), InputError);
}

TEST(LinearTable, DrawsStraightLinesAndIsConstantOutside)
{
    const TimeFunction f = linear_table({1, 2, 4}, {10, 20, -20});
    EXPECT_EQ(f.breaks(), (std::vector<double>{1, 2, 4}));
    expect_value(f({0, Side::middle}), {10, 0, 0}, 0);
    expect_value(f({1.25, Side::middle}), {12.5, 10, 0}, 0);
    expect_value(f({3, Side::middle}), {0, -20, 0}, 0);
    expect_value(f({5, Side::middle}), {-20, 0, 0}, 0);
    // At a row the sides differ in slope alone.
    expect_value(f({2, Side::left}), {20, 10, 0}, 0);
    expect_value(f({2, Side::right}), {20, -20, 0}, 0);
    expect_value(f({1, Side::left}), {10, 0, 0}, 0);
    expect_value(f({4, Side::left}), {-20, -20, 0}, 0);
    expect_value(f({4, Side::middle}), {-20, 0, 0}, 0);
}

TEST(LinearTable, GivesItsRowsToTheBit)
{
    const std::vector<double> t{0.1, 0.3, 0.7}, v{0.1, 1e10 + 0.3, -0.7};
    const TimeFunction f = linear_table(t, v);
    for (std::size_t i = 0; i < t.size(); ++i) {
        EXPECT_EQ(value(f, t[i], Side::left), v[i]);
        EXPECT_EQ(value(f, t[i], Side::right), v[i]);
    }
}

TEST(LinearTable, JumpsWhereTwoRowsShareATime)
{
    const TimeFunction f = linear_table({0, 1, 1, 2, 2}, {0, 4, -4, -4, 8});
    EXPECT_EQ(f.breaks(), (std::vector<double>{0, 1, 2}));
    expect_value(f({1, Side::left}), {4, 4, 0}, 0);
    expect_value(f({1, Side::right}), {-4, 0, 0}, 0);
    EXPECT_EQ(value(f, 1), -4);
    EXPECT_EQ(value(f, 2, Side::left), -4);   // a jump in the last row too
    EXPECT_EQ(value(f, 2, Side::right), 8);
}

TEST(LinearTable, RefusesWhatIsNoTable)
{
    EXPECT_EQ(complaint_of([] { linear_table({0}, {1}); }).path, "load.table");
    EXPECT_EQ(complaint_of([] { linear_table({}, {}); }).code, "table-size");
    EXPECT_EQ(complaint_of([] { linear_table({0, 1}, {1}); }).code, "table-size");
    EXPECT_EQ(complaint_of([] { linear_table({0, -1}, {1, 1}); }).code, "table-order");
    EXPECT_EQ(complaint_of([] { linear_table({0, 1, 1, 1}, {1, 2, 3, 4}); }).code, "table-order");
    EXPECT_EQ(complaint_of([] { linear_table({0, NAN}, {1, 1}); }).code, "not-finite");
    EXPECT_EQ(complaint_of([] { linear_table({0, 1}, {1, infinity}); }).code, "not-finite");
    EXPECT_EQ(complaint_of([] { linear_table({0, 1e-310}, {0, 1}); }).code, "table-slope");
}

TimeValue cubic(double t) { return {1 - 2 * t + 3 * t * t - t * t * t, -2 + 6 * t - 3 * t * t, 6 - 6 * t}; }

TEST(SplineTable, ReproducesCubicsFromFourRowsOn)
{
    const std::vector<double> all{-1, -0.7, 0.2, 0.25, 1, 1.9, 2};   // uneven on purpose
    for (std::size_t n = 4; n <= all.size(); ++n) {
        const std::vector<double> t(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n));
        std::vector<double> v;
        for (const double ti : t) v.push_back(cubic(ti).value);
        const TimeFunction f = spline_table(t, v);
        for (double x = t.front(); x < t.back(); x += 0.01)
            expect_value(f({x, Side::right}), cubic(x), 1e-13);
        expect_value(f({t.back(), Side::left}), cubic(t.back()), 1e-13);
    }
}

TEST(SplineTable, DoesNotReproduceQuartics)
{
    std::vector<double> t, v;
    for (int i = 0; i <= 6; ++i) t.push_back(i), v.push_back(std::pow(i, 4));
    EXPECT_GT(std::fabs(value(spline_table(t, v), 2.5) - std::pow(2.5, 4)), 1e-3);
}

TEST(SplineTable, IsTwiceContinuouslyDifferentiableAtInnerRowsOnly)
{
    const std::vector<double> t{0, 0.4, 1, 1.1, 3, 3.5}, v{1, -2, 4, 4, 0, 7};
    const TimeFunction f = spline_table(t, v);
    EXPECT_EQ(f.breaks(), (std::vector<double>{0, 3.5}));
    for (std::size_t i = 1; i + 1 < t.size(); ++i) {
        expect_value(f({t[i], Side::left}), f({t[i], Side::right}), 1e-12);
        EXPECT_EQ(value(f, t[i]), v[i]);
    }
    expect_value(f({-1, Side::middle}), {1, 0, 0}, 0);
    expect_value(f({0, Side::left}), {1, 0, 0}, 0);
    expect_value(f({3.5, Side::right}), {7, 0, 0}, 0);
    EXPECT_NEAR(value(f, 3.5, Side::left), 7, 1e-13);
    EXPECT_GT(std::fabs(f({3.5, Side::left}).first), 1);   // constant outside: the slope jumps at the ends
}

TEST(SplineTable, DerivativesAreDerivatives)
{
    const TimeFunction f = spline_table({0, 1, 2.5, 3, 4}, {0, 2, -1, 5, 5});
    const double d = 1e-5;
    for (const double t : {0.3, 1.7, 2.8, 3.9}) {
        const TimeValue at = f({t, Side::middle});
        EXPECT_NEAR((value(f, t + d) - value(f, t - d)) / (2 * d), at.first, 1e-7);
        EXPECT_NEAR((f({t + d, Side::middle}).first - f({t - d, Side::middle}).first) / (2 * d), at.second,
                    1e-7);
    }
}

TEST(SplineTable, IsNaturalBelowFourRows)
{
    const TimeFunction two = spline_table({0, 2}, {1, 5});
    expect_value(two({0.5, Side::middle}), {2, 2, 0}, 1e-15);
    const TimeFunction three = spline_table({0, 1, 3}, {0, 1, 0});
    EXPECT_NEAR(three({0, Side::right}).second, 0, 1e-14);
    EXPECT_NEAR(three({3, Side::left}).second, 0, 1e-14);
    EXPECT_LT(three({1, Side::middle}).second, -0.1);
}

TEST(SplineTable, RefusesRepeatedTimes)
{
    EXPECT_EQ(complaint_of([] { spline_table({0, 1, 1, 2}, {0, 1, 2, 3}); }).code, "table-order");
    EXPECT_EQ(complaint_of([] { spline_table({0, 1, 0.5, 2}, {0, 1, 2, 3}); }).code, "table-order");
    EXPECT_EQ(complaint_of([] { spline_table({0}, {0}); }).code, "table-size");
}

}   // namespace
}   // namespace livens::time_function_test
