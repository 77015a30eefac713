// SPDX-License-Identifier: BSD-3-Clause
// What the polynomial of an element says of the one behind it.
#include "livens/spacetime/nodal/kernel/extrapolation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "livens/base/linear.h"

namespace livens::extrapolation_test {
namespace {

using Place = std::array<double, 7>;

Vector4 product(const Vector4& p, const Vector4& q)
{
    return {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
            p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
            p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
            p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
}

/// A motion by its place at an instant: a shift, and a turn that is not steady.
struct Course {
    std::function<Vector3(double)> shift;
    std::function<Vector4(double)> turn;

    /// As an element from `start` sees it: in the axes that the body has there.
    Place seen_from(double start, double t) const
    {
        const Vector3 u = shift(t) - shift(start);
        Vector4 back = turn(start);
        for (int i = 1; i < 4; ++i) back[i] = -back[i];
        const Vector4 q = product(back, turn(t));
        return {u[0], u[1], u[2], q[0], q[1], q[2], q[3]};
    }
};

/// Two bodies on a course of their own each, in lanes: lane 0 is the end.
std::vector<double> lanes_of(const std::vector<Course>& courses, const ElementRule& rule, int width,
                             double start, double h)
{
    std::vector<double> lanes(7 * courses.size() * static_cast<std::size_t>(width));
    for (std::size_t b = 0; b < courses.size(); ++b)
        for (int l = 0; l < width; ++l) {   // those that stand for no node: at the start
            const double s = l == 0 ? 1 : l < rule.degree ? rule.nodes[l] : 0;
            const Place place = courses[b].seen_from(start, start + h * s);
            for (std::size_t c = 0; c < 7; ++c)
                lanes[(7 * b + c) * static_cast<std::size_t>(width) + l] = place[c];
        }
    return lanes;
}

double error_of(const Course& a, const Course& b, int degree, double ratio, double h)
{
    const ElementRule rule = element_rule(Points::lobatto, degree);
    const lanes::Functions* functions = lanes::sse2(degree);
    const int width = functions->width;   // the last lane of odd degrees stands for no node
    Extrapolation extrapolation(rule, *functions);
    const double start = 0.3;
    const std::vector<double> before = lanes_of({a, b}, rule, width, start, h);
    extrapolation.remember(before.data(), 2, start, start + h);
    EXPECT_TRUE(extrapolation.follows(start + h, ratio * h));
    EXPECT_FALSE(extrapolation.follows(start, h));
    EXPECT_FALSE(extrapolation.follows(start + h, 4 * h)) << "much longer";
    const std::vector<double> exact = lanes_of({a, b}, rule, width, start + h, ratio * h);
    std::vector<double> found(exact.size(), 0.25);
    extrapolation.place(ratio * h, found.data());
    double error = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) error = std::max(error, std::abs(found[i] - exact[i]));
    return error;
}

const Course rolling{[](double t) {
                         return Vector3{std::sin(t), t * t, std::cos(2 * t)};
                     },
                     [](double t) {
                         const Vector4 p{std::cos(t), std::sin(t), 0, 0},
                             q{std::cos(0.3 + t * t), 0, 0, std::sin(0.3 + t * t)};
                         return product(p, q);
                     }};
const Course flying{[](double t) {
                        return Vector3{1 + t, -3 * t, t * t * t};
                    },
                    [](double) {
                        return Vector4{0.5, 0.5, -0.5, 0.5};
                    }};

TEST(Extrapolation, GoesOnAlongTheMotion)
{
    for (const double ratio : {1.0, 0.37, 1.5}) {
        EXPECT_LT(error_of(rolling, flying, 4, ratio, 0.1), 1e-3) << ratio;
        EXPECT_LT(error_of(rolling, flying, 8, ratio, 0.1), 1e-7) << ratio;
        EXPECT_LT(error_of(flying, rolling, 8, ratio, -0.1), 1e-7) << "against time";
        // half as long: an order of p + 1
        EXPECT_LT(error_of(rolling, flying, 6, ratio, 0.2) / error_of(rolling, flying, 6, ratio, 0.4),
                  1.0 / 64);
    }
}

/// Rounding of nodes is magnified by 6^degree if all of them are used.
TEST(Extrapolation, OfHighDegreesIsNotDrownedInRounding)
{
    for (const int degree : {11, 12, 15, 16, 18})
        EXPECT_LT(error_of(rolling, flying, degree, 1, 0.1), 1e-6) << degree;
}

TEST(Extrapolation, ServesFromDegreeFourOn)
{
    EXPECT_FALSE(Extrapolation().serves());
    EXPECT_FALSE(Extrapolation(element_rule(Points::lobatto, 3), *lanes::sse2(3)).serves());
    Extrapolation four(element_rule(Points::lobatto, 4), *lanes::sse2(4));
    EXPECT_TRUE(four.serves());
    EXPECT_FALSE(four.follows(0, 1)) << "nothing is remembered";
}

}   // namespace
}   // namespace livens::extrapolation_test
