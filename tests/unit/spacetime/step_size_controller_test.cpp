// SPDX-License-Identifier: BSD-3-Clause
// The lengths of elements for elements whose error is known: no mechanics.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "livens/diagnostics/diagnostics.h"
#include "livens/spacetime/march/step_size_controller.h"

namespace livens::step_size_controller_test {
namespace {

TEST(StepSizeController, TheErrorAndItsJumpAreInverse)
{
    for (int p = 1; p <= 8; ++p)
        for (const double error : {1e-16, 1e-9, 1e-3})
            for (const Points points : {Points::lobatto, Points::radau})
                EXPECT_NEAR(local_error(points, p, velocity_jump_of(points, p, error)) / error, 1, 1e-12)
                    << p;
}

/// Marches over elements whose jump is (h / scale(t, t + h))^(p + 1).
template <class Scale>
std::vector<double> march(StepSizeController& controller, int p, const Scale& scale, int& refused)
{
    std::vector<double> ends{0};
    refused = 0;
    while (ends.back() < controller.end()) {
        const double t = ends.back(), end = controller.next_end(t), h = end - t;
        const double jump = std::pow(h / scale(t, end), p + 1);
        if (jump > controller.largest_jump()) {
            ++refused;
            if (!controller.rejected(h, jump)) break;
            continue;
        }
        controller.accepted(h, jump, 1);
        ends.push_back(end);
    }
    return ends;
}

TEST(StepSizeController, FindsTheLengthThatTheToleranceAllows)
{
    int refused = 0;
    for (const double first : {1e-6, 0.1, 90.0}) {
        StepSizeController controller(Points::lobatto, 4, 1e-8, first, {0, 100});
        const std::vector<double> ends = march(
            controller, 4, [](double, double) { return 2.0; }, refused);
        const double expected = 0.8 * 2 * std::pow(1e-8 / 0.04, 1.0 / 9);
        const std::size_t middle = ends.size() / 2;
        EXPECT_NEAR(ends[middle + 1] - ends[middle], expected, 1e-3 * expected) << first;
        EXPECT_NEAR(controller.mean_length(), expected, 1e-6 * expected);
        // and what elements of another degree would be allowed
        EXPECT_NEAR(controller.mean_length(7, 1e-8), 1.6 * std::pow(1e-8 / 0.04, 1.0 / 15), 1e-6);
        EXPECT_LE(refused, first > 2 ? 12 : 0);
    }
}

TEST(StepSizeController, TellsWhatElementsLoseThatSomethingElseKeepsShort)
{
    constexpr double scale = 2, expected = 1e-13;   // of the tolerance
    const double longest = 1.6 * std::pow(1e-8 / 0.04, 1.0 / 9),
                 length = longest * std::pow(expected, 1.0 / 9);
    const auto lost = [&](double h, std::vector<double> stops) {
        StepSizeController controller(Points::lobatto, 4, 1e-8, h, std::move(stops));
        TimeMesh mesh{{0}};
        while (mesh.end() < 10) {
            mesh.ends.push_back(mesh.end() + h);
            controller.shorten(h);
            controller.accepted(h, std::pow(h / scale, 5), 1);
        }
        return controller.lost(mesh);
    };
    EXPECT_NEAR(lost(length, {0, 100}), expected, 1e-2 * expected);
    EXPECT_EQ(lost(longest, {0, 100}), 1);         // the tolerance rules
    EXPECT_EQ(lost(0.5 * longest, {0, 100}), 1);   // or nearly so
    std::vector<double> stops;
    for (double t = 0; t < 100; t += length) stops.push_back(t);
    EXPECT_EQ(lost(length, stops), 1);   // stops do, which shorter elements have as well
}

TEST(StepSizeController, LengthsStayWhereAFactorServesTheNext)
{
    const double right = 0.8 * 2 * std::pow(1e-8 / 0.04, 1.0 / 9);   // as above
    const auto next_to = [&](double first, bool has_factor) {
        StepSizeController controller(Points::lobatto, 4, 1e-8, first, {0, 100});
        for (int i = 0; i < 3; ++i)   // so that there is no trend
            controller.accepted(first, std::pow(first / 2, 5), 1, has_factor);
        return controller.next_end(0);
    };
    EXPECT_DOUBLE_EQ(next_to(0.8 * right, true), 0.8 * right);
    EXPECT_NEAR(next_to(0.8 * right, false), right, 1e-3 * right);
    EXPECT_NEAR(next_to(0.6 * right, true), right, 1e-3 * right);   // worth another
    EXPECT_NEAR(next_to(1.2 * right, true), right, 1e-3 * right);
}

/// Elements that lose next to nothing up to a length at which they see nothing of the motion; how many there
/// are, and how many were refused.
std::pair<int, int> blind_beyond(double first, double then)
{
    StepSizeController controller(Points::lobatto, 12, 1e-6, 0.5 * first, {0, 10, 100});
    int accepted = 0, refused = 0;
    for (double t = 0; t < controller.end();) {
        const double end = controller.next_end(t), h = end - t;
        if (h > (t < 10 ? first : then)) {
            ++refused;
            if (!controller.rejected(h, std::numeric_limits<double>::infinity())) break;
            continue;
        }
        controller.accepted(h, 1e-9, 1);
        ++accepted;
        t = end;
    }
    return {accepted, refused};
}

TEST(StepSizeController, DoesNotTryAgainAtOnceWhatSawNothing)
{
    const auto [accepted, refused] = blind_beyond(0.3, 0.3);
    EXPECT_LT(refused, 0.3 * accepted) << accepted;
    EXPECT_LT(accepted, 1.4 * 100 / 0.3) << "nor are elements much shorter than they may be";
    // and what was seen once is not held against elements for ever
    const auto [after_burst, refused_in_all] = blind_beyond(0.01, 30);
    EXPECT_LT(after_burst, 1.4 * 10 / 0.01 + 40);
    EXPECT_LT(refused_in_all, 0.3 * after_burst);
}

TEST(StepSizeController, StopsAreElementEndsToTheBitAndShortWaysCostNoLength)
{
    StepSizeController controller(Points::lobatto, 4, 1e-8, 0.1, {0, 1.0 / 3, 1.0 / 3 + 1e-7, 10});
    int refused = 0;
    const std::vector<double> ends = march(
        controller, 4, [](double, double) { return 1.0; }, refused);
    EXPECT_EQ(ends[1] > 0, true);
    const auto stop = std::find(ends.begin(), ends.end(), 1.0 / 3);
    ASSERT_NE(stop, ends.end());
    EXPECT_EQ(*(stop + 1), 1.0 / 3 + 1e-7);
    EXPECT_GT(*(stop + 2) - *(stop + 1), 0.05) << "it does not begin again from the shortest";
    EXPECT_EQ(ends.back(), 10);
}

TEST(StepSizeController, ABurstCostsElementsWhereItIs)
{
    StepSizeController controller(Points::lobatto, 4, 1e-8, 0.1, {0, 10});
    int refused = 0;
    const std::vector<double> ends = march(
        controller, 4, [](double t, double end) { return end > 5 && t < 5.1 ? 0.01 : 1.0; }, refused);
    const auto inside = std::count_if(ends.begin(), ends.end(), [](double t) { return t >= 5 && t <= 5.1; });
    EXPECT_GT(inside, 40);
    EXPECT_LT(static_cast<long>(ends.size()) - inside, 150);
    EXPECT_LT(refused, 10);
}

/// A motion that is rough again and again, as the turns of a crank: what grows into the rough is refused, and
/// what was refused once is not tried again at once. (Lengths by the last element
/// alone: 348 of 1134 refused.)
TEST(StepSizeController, SeesRoughPlacesComing)
{
    int refused = 0;
    StepSizeController controller(Points::lobatto, 12, 1e-12, 0.1, {0, 100});
    const auto scale = [](double t, double end) {   // the smallest in the element
        double least = 10;
        for (int i = 0; i <= 20; ++i)
            least = std::min(least, 1 - 0.9 * std::cos(5 * (t + 0.05 * i * (end - t))));
        return least;
    };
    const std::vector<double> ends = march(controller, 12, scale, refused);
    EXPECT_LT(refused, 0.15 * static_cast<double>(ends.size()));
    EXPECT_LT(ends.size(), 1200);
}

/// A velocity jump that passes through zero says nothing of the next elements: they are as long as without.
TEST(StepSizeController, IsNotShyOfSingleSmallJumps)
{
    std::size_t n[2];
    for (const bool dips : {false, true}) {
        int refused = 0, k = 0;
        StepSizeController controller(Points::lobatto, 7, 1e-10, 0.1, {0, 100});
        n[dips] =
            march(
                controller, 7, [&](double, double) { return dips && k++ % 7 == 0 ? 1.5 : 1.0; }, refused)
                .size();
    }
    EXPECT_LT(static_cast<double>(n[1]), 1.03 * static_cast<double>(n[0]));
}

/// Behind an element that was refused the next are no longer than what was found to do in it.
TEST(StepSizeController, RemembersWhatWasRefused)
{
    StepSizeController controller(Points::lobatto, 4, 1e-8, 1, {0, 10});
    const auto jump = [](double h) { return std::pow(h / 2, 5); };
    ASSERT_TRUE(controller.rejected(1, jump(1)));
    const double first = controller.next_end(0);
    controller.accepted(first, jump(0.5 * first), 1);   // the rough lies behind it
    EXPECT_LE(controller.next_end(first) - first, first * (1 + 1e-12));
    for (double t = first; t < 1;) {
        const double end = controller.next_end(t);
        controller.accepted(end - t, jump(0.5 * (end - t)), 1);
        t = end;
    }
    EXPECT_GT(controller.next_end(1.5) - 1.5, 1.3 * first) << "only there";
}

/// A stop at which joints lose rank is left; the element around it is as accurate inside as asked for.
TEST(StepSizeController, LeavesAStopThatIsSampledInside)
{
    StepSizeController controller(Points::lobatto, 4, 1e-8, 0.5, {0, 1, 2, 10});
    controller.sample_at({0, 1, 10}, 1e-7);
    EXPECT_EQ(controller.next_end(0.9), 1);
    EXPECT_EQ(controller.largest_jump(0.9, 1.1), controller.largest_jump());
    EXPECT_TRUE(controller.may_leave(1));
    for (const double t : {0.0, 0.5, 2.0, 10.0}) EXPECT_FALSE(controller.may_leave(t)) << t;
    controller.leave(1);
    EXPECT_EQ(controller.left(), std::vector<double>{1});
    EXPECT_FALSE(controller.is_stop(1));
    EXPECT_TRUE(controller.is_stop(0) && controller.is_stop(2) && controller.is_stop(10));
    EXPECT_GT(controller.next_end(0.9), 1.1);
    EXPECT_EQ(controller.largest_jump(0.9, 1.1), 1e-7);
    EXPECT_EQ(controller.largest_jump(1, 1.1), controller.largest_jump());
    // what is refused for that is as short as it needs to be at the next trial
    ASSERT_TRUE(controller.rejected(0.5, 1e-5, 1e-7));
    const double h = controller.next_end(0.9) - 0.9, then = 1e-5 * std::pow(h / 0.5, 5);
    EXPECT_LT(then, 1e-7);
    EXPECT_GT(then, 1e-8);
}

TEST(StepSizeController, ElementsVanishAtLast)
{
    StepSizeController controller(Points::lobatto, 4, 1e-8, 0.1, {0, 10});
    int n = 0;
    while (controller.rejected(controller.next_end(0), std::numeric_limits<double>::infinity())) ++n;
    EXPECT_NEAR(n, std::log2(0.1 / 1e-8), 1);
}

}   // namespace
}   // namespace livens::step_size_controller_test
