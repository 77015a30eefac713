// SPDX-License-Identifier: BSD-3-Clause
// The lengths of elements for elements whose error is known: no mechanics.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "livens/diagnostics/diagnostics.h"
#include "livens/spacetime/pace.h"

namespace livens {
namespace {

TEST(Pace, TheErrorAndItsJumpAreInverse)
{
    for (int p = 1; p <= 8; ++p)
        for (const double error : {1e-16, 1e-9, 1e-3})
            for (const Points points : {Points::lobatto, Points::radau})
                EXPECT_NEAR(local_error(points, p, velocity_jump_of(points, p, error)) / error, 1, 1e-12)
                    << p;
}

/// Marches over elements whose jump is (h / scale(t, t + h))^(p + 1).
template <class Scale>
std::vector<double> march(Pace& pace, int p, const Scale& scale, int& refused)
{
    std::vector<double> ends{0};
    refused = 0;
    while (ends.back() < pace.end()) {
        const double t = ends.back(), end = pace.next_end(t), h = end - t;
        const double jump = std::pow(h / scale(t, end), p + 1);
        if (jump > pace.largest_jump()) {
            ++refused;
            if (!pace.refused(h, jump)) break;
            continue;
        }
        pace.accepted(h, jump, false);
        ends.push_back(end);
    }
    return ends;
}

TEST(Pace, FindsTheLengthThatTheToleranceAllows)
{
    int refused = 0;
    for (const double first : {1e-6, 0.1, 90.0}) {
        Pace pace(Points::lobatto, 4, 1e-8, first, {0, 100});
        const std::vector<double> ends = march(
            pace, 4, [](double, double) { return 2.0; }, refused);
        const double expected = 0.8 * 2 * std::pow(1e-8 / 0.04, 1.0 / 9);
        const std::size_t middle = ends.size() / 2;
        EXPECT_NEAR(ends[middle + 1] - ends[middle], expected, 1e-3 * expected) << first;
        EXPECT_NEAR(pace.mean_length(), expected, 1e-6 * expected);
        // and what elements of another degree would be allowed
        EXPECT_NEAR(pace.mean_length(7, 1e-8), 1.6 * std::pow(1e-8 / 0.04, 1.0 / 15), 1e-6);
        EXPECT_LE(refused, first > 2 ? 12 : 0);
    }
}

/// Elements that lose next to nothing up to a length at which they see nothing of the motion; how many there
/// are, and how many were refused.
std::pair<int, int> blind_beyond(double first, double then)
{
    Pace pace(Points::lobatto, 12, 1e-6, 0.5 * first, {0, 10, 100});
    int accepted = 0, refused = 0;
    for (double t = 0; t < pace.end();) {
        const double end = pace.next_end(t), h = end - t;
        if (h > (t < 10 ? first : then)) {
            ++refused;
            if (!pace.refused(h, std::numeric_limits<double>::infinity())) break;
            continue;
        }
        pace.accepted(h, 1e-9, false);
        ++accepted;
        t = end;
    }
    return {accepted, refused};
}

TEST(Pace, DoesNotTryAgainAtOnceWhatSawNothing)
{
    const auto [accepted, refused] = blind_beyond(0.3, 0.3);
    EXPECT_LT(refused, 0.3 * accepted) << accepted;
    EXPECT_LT(accepted, 1.4 * 100 / 0.3) << "nor are elements much shorter than they may be";
    // and what was seen once is not held against elements for ever
    const auto [after_burst, refused_in_all] = blind_beyond(0.01, 30);
    EXPECT_LT(after_burst, 1.4 * 10 / 0.01 + 40);
    EXPECT_LT(refused_in_all, 0.3 * after_burst);
}

TEST(Pace, StopsAreElementEndsToTheBitAndShortWaysCostNoLength)
{
    Pace pace(Points::lobatto, 4, 1e-8, 0.1, {0, 1.0 / 3, 1.0 / 3 + 1e-7, 10});
    int refused = 0;
    const std::vector<double> ends = march(
        pace, 4, [](double, double) { return 1.0; }, refused);
    EXPECT_EQ(ends[1] > 0, true);
    const auto stop = std::find(ends.begin(), ends.end(), 1.0 / 3);
    ASSERT_NE(stop, ends.end());
    EXPECT_EQ(*(stop + 1), 1.0 / 3 + 1e-7);
    EXPECT_GT(*(stop + 2) - *(stop + 1), 0.05) << "it does not begin again from the shortest";
    EXPECT_EQ(ends.back(), 10);
}

TEST(Pace, ABurstCostsElementsWhereItIs)
{
    Pace pace(Points::lobatto, 4, 1e-8, 0.1, {0, 10});
    int refused = 0;
    const std::vector<double> ends = march(
        pace, 4, [](double t, double end) { return end > 5 && t < 5.1 ? 0.01 : 1.0; }, refused);
    const auto inside = std::count_if(ends.begin(), ends.end(), [](double t) { return t >= 5 && t <= 5.1; });
    EXPECT_GT(inside, 40);
    EXPECT_LT(static_cast<long>(ends.size()) - inside, 150);
    EXPECT_LT(refused, 10);
}

TEST(Pace, ElementsVanishAtLast)
{
    Pace pace(Points::lobatto, 4, 1e-8, 0.1, {0, 10});
    int n = 0;
    while (pace.refused(pace.next_end(0), std::numeric_limits<double>::infinity())) ++n;
    EXPECT_NEAR(n, std::log2(0.1 / 1e-8), 1);
}

}   // namespace
}   // namespace livens
