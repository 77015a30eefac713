// SPDX-License-Identifier: BSD-3-Clause
// What is made of estimated errors: digits, what holds until when, and errors between element ends.
#include "livens/diagnostics/estimate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/diagnostics/hand_made.h"

namespace livens::estimate_test {
namespace {

/// Of two bodies on elements of 1 s: `errors` of the first, the second ten times better.
ErrorEstimate estimate_of(const std::vector<double>& errors)
{
    ErrorEstimate e;
    e.n_bodies = 2;
    for (const double error : errors) {
        e.position.insert(e.position.end(), {error, error / 10});
        e.orientation.insert(e.orientation.end(), {0, error / 10});
        e.velocity.insert(e.velocity.end(), {error, error});
    }
    e.find_largest(
        hand_made::mesh(0, static_cast<double>(errors.size()) - 1, static_cast<int>(errors.size()) - 1));
    return e;
}

TEST(Estimate, SaysTheDigitsThatHoldLongest)
{
    const TimeMesh four = hand_made::mesh(0, 4, 4);
    const auto good = [&](const std::vector<double>& errors) { return estimate_of(errors).good(four); };
    // the same digits all over, however small the error of the start
    EXPECT_EQ(good({0, 2e-8, 9e-8, 2e-8, 9e-8}).digits, 7);
    EXPECT_EQ(good({0, 2e-8, 9e-8, 2e-8, 9e-8}).until, 4);
    // lost at once: 12 * 3 > 2 * 4, and what is good again afterwards does not count
    EXPECT_EQ(good({0, 2e-13, 2e-13, 9e-13, 5e-3}).digits, 12);
    EXPECT_EQ(good({0, 2e-13, 2e-13, 9e-13, 5e-3}).until, 3);
    EXPECT_EQ(good({0, 2e-13, 0.2, 2e-13, 2e-13}).until, 1);
    // 8, 7, 6, 5: 5 * 4 is most
    EXPECT_EQ(good({0, 5e-9, 5e-8, 5e-7, 5e-6}).until, 4);
    EXPECT_EQ(good({0, 0, 0, 0, 0}).digits, 16) << "as many as a double has";
    EXPECT_EQ(good({0, 2, 2, 2, 2}).digits, 0);
    EXPECT_EQ(good({0, 1e-8, NAN, 1e-8, 1e-8}).until, 1) << "what is not known is not good";
}

TEST(Estimate, FindsTheLargest)
{
    const ErrorEstimate e = estimate_of({0, 1e-3, 1e-7});
    EXPECT_EQ(e.largest, 1e-3);
    EXPECT_EQ(e.time, 1);
    EXPECT_EQ(e.body, 0);
    EXPECT_NEAR(e.digits(), 3, 1e-15);
}

TEST(Estimate, BetweenEndsIsTheLargerOfBoth)
{
    const TimeMesh mesh = hand_made::mesh(0, 3, 3);
    const std::vector<double> errors{0, 0, 1, 10, 5, 50, NAN, 7};
    const auto at = [&](int index, double t) { return ErrorEstimate::at(errors, 2, index, mesh, t); };
    EXPECT_EQ(at(1, 1), 10);
    EXPECT_EQ(at(0, 0.5), 1);
    EXPECT_EQ(at(1, 1.25), 50);
    EXPECT_EQ(at(1, 2.5), 50);
    EXPECT_EQ(at(1, 3), 7);
    EXPECT_TRUE(std::isnan(at(0, 2.5)));
    EXPECT_TRUE(std::isnan(ErrorEstimate::at({}, 2, 0, mesh, 1)));
}

TEST(Estimate, GapsAreThoseOfCentresAndTurns)
{
    const Body body = rigid_body("body", {2, {0.5, 0, 0}, identity<3>()});
    State a{0, {configuration({1, 2, 3}, identity<3>())}, {Matrix34{}}}, b = a;
    const double angle = 1e-3;
    b.X[0] = configuration({1, 2, 3}, directors_from_rotation_vector({0, 0, angle}));
    b.V[0] = rate(b.X[0], {0, 0, 3}, {0, 4, 0});
    const BodyGap gap = gap_between(a, b, body, 0, 2);
    EXPECT_NEAR(gap.orientation, angle, 1e-12);
    EXPECT_NEAR(gap.position, 2 * 0.5 * std::sin(angle / 2) / 2, 1e-15);   // of the centre, by the length
    EXPECT_NEAR(gap.velocity, std::abs(3 - 4 * 0.5 * std::cos(angle)), 1e-12);
    EXPECT_NEAR(gap.rate, 4, 1e-12);

    JointSample one, other;
    one.left.force = one.right.force = {3, 0, 0};
    other.left.torque = other.right.torque = {0, 8, 0};
    EXPECT_NEAR(gap_between(one, other, 2), 5, 1e-15);   // 3 N and 8 N m / 2 m
    EXPECT_NEAR(size_of(other, 2), 4, 1e-15);
}

}   // namespace
}   // namespace livens::estimate_test
