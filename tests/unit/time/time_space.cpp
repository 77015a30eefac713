// SPDX-License-Identifier: BSD-3-Clause
#include "livens/time/time_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "livens/base/error.h"
#include "livens/time/time_mesh.h"

namespace livens::time_space_test {
namespace {

using Numbers = std::vector<double>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Functions {
    Numbers values, slopes;
};

Functions functions(const TimeSpace& space, int element, double s)
{
    const std::size_t n = static_cast<std::size_t>(space.degree()) + 1;
    Functions f{Numbers(n), Numbers(n)};
    space.evaluate(element, s, f.values, f.slopes);
    return f;
}

void expect_near(const Numbers& is, const Numbers& should, double tolerance)
{
    ASSERT_EQ(is.size(), should.size());
    for (std::size_t a = 0; a < is.size(); ++a) EXPECT_NEAR(is[a], should[a], tolerance) << a;
}

Complaint complaint_of(const std::function<void()>& call)
{
    try {
        call();
    } catch (const InputError& error) {
        return error.complaint();
    }
    return {"none", "", "", "", "", "", ""};
}

void expect_refused(const std::function<void()>& call, const std::string& code, const std::string& path,
                    const std::string& value, const std::string& bound)
{
    const Complaint complaint = complaint_of(call);
    EXPECT_EQ(complaint.code, code);
    EXPECT_EQ(complaint.path, path) << code;
    EXPECT_EQ(complaint.value, value) << code;
    EXPECT_EQ(complaint.bound, bound) << code;
    EXPECT_FALSE(complaint.message.empty()) << code;
}

void expect_knots_refused(int degree, const Numbers& knots, const std::string& code, const std::string& value,
                          const std::string& bound)
{
    expect_refused([&] { TimeSpace::bspline(degree, knots); }, code, "method.knots", value, bound);
    expect_refused([&] { TimeSpace::nurbs(degree, knots, {}); }, code, "method.knots", value, bound);
}

TEST(TimeSpace, LagrangeOfDegreeOneIsHats)
{
    const TimeSpace space = TimeSpace::lagrange({1, 1.5, 3.5}, 1);
    EXPECT_EQ(space.size(), 3);
    EXPECT_EQ(space.degree(), 1);
    EXPECT_EQ(space.n_elements(), 2);
    EXPECT_EQ(space.first(0), 0);
    EXPECT_EQ(space.first(1), 1);
    EXPECT_EQ(space.length(1), 2);
    EXPECT_FALSE(space.is_rational());
    EXPECT_TRUE(space.is_continuous());
    EXPECT_EQ(space.denominator(1, 0.3), 1);
    expect_near(functions(space, 0, 0.25).values, {0.75, 0.25}, 1e-16);
    expect_near(functions(space, 0, 0.25).slopes, {-2, 2}, 1e-15);   // 1/s: the element is half a second
    expect_near(functions(space, 1, 0.25).slopes, {-0.5, 0.5}, 1e-15);
}

TEST(TimeSpace, LagrangeOfDegreeTwoHasItsNodeInTheMiddle)
{
    const TimeSpace space = TimeSpace::lagrange({0, 2, 3, 7}, 2);
    EXPECT_EQ(space.size(), 7);
    EXPECT_EQ(space.first(2), 4);
    EXPECT_EQ(functions(space, 2, 0.5).values, (Numbers{0, 1, 0}));   // to the bit
    expect_near(functions(space, 2, 0.5).slopes, {-0.25, 0, 0.25}, 1e-15);
    expect_near(functions(space, 0, 0.25).values, {0.375, 0.75, -0.125}, 1e-15);
    EXPECT_EQ(space.interpolation_points(), (Numbers{0, 1, 2, 2.5, 3, 5, 7}));
}

TEST(TimeSpace, LowerOfLagrangeIsDiscontinuousWithNodesInside)
{
    for (int p = 1; p <= 8; ++p) {
        const TimeSpace space = TimeSpace::lagrange({0, 2, 3}, p), lower = space.lower();
        EXPECT_EQ(lower.size(), 2 * p);
        EXPECT_EQ(lower.degree(), p - 1);
        EXPECT_EQ(lower.first(1), p);
        EXPECT_EQ(lower.ends(), space.ends());
        EXPECT_FALSE(lower.is_continuous());
        for (int a = 0; a < p; ++a) {
            Numbers one(static_cast<std::size_t>(p), 0.0);
            one[static_cast<std::size_t>(a)] = 1;
            EXPECT_EQ(functions(lower, 1, (a + 0.5) / p).values, one);
        }
    }
    // A single element has no end to tear apart, but its functions still do not meet its ends.
    EXPECT_FALSE(TimeSpace::lagrange({0, 1}, 3).lower().is_continuous());
}

TEST(TimeSpace, DegreeZeroIsPiecewiseConstant)
{
    const Numbers ends{0, 1, 3, 4};
    const TimeSpace spline = TimeSpace::bspline(1, clamped_knots(1, ends));
    for (const TimeSpace& space : {TimeSpace::lagrange(ends, 1).lower(), spline.lower()}) {
        EXPECT_EQ(space.size(), 3);
        EXPECT_EQ(space.degree(), 0);
        EXPECT_FALSE(space.is_continuous());
        for (int e = 0; e < 3; ++e) {
            EXPECT_EQ(space.first(e), e);
            EXPECT_EQ(functions(space, e, 0.3).values, Numbers{1});
            EXPECT_EQ(functions(space, e, 0.3).slopes, Numbers{0});
        }
    }
    // A constant can be met at one end only.
    EXPECT_FALSE(TimeSpace::bspline(1, {0, 0, 1, 1}).lower().is_continuous());
}

TEST(TimeSpace, UniformSplinesHaveTheValuesOfTheTextbook)
{
    // An element far from both ends, of length 1/2.
    Numbers ends;
    for (int i = 0; i <= 9; ++i) ends.push_back(0.5 * i);
    const TimeSpace quadratic = TimeSpace::bspline(2, clamped_knots(2, ends));
    EXPECT_EQ(quadratic.size(), 11);
    EXPECT_EQ(quadratic.first(4), 4);
    expect_near(functions(quadratic, 4, 0.5).values, {1.0 / 8, 3.0 / 4, 1.0 / 8}, 1e-16);
    expect_near(functions(quadratic, 4, 0.5).slopes, {-1, 0, 1}, 1e-15);
    const TimeSpace cubic = TimeSpace::bspline(3, clamped_knots(3, ends));
    expect_near(functions(cubic, 4, 0).values, {1.0 / 6, 2.0 / 3, 1.0 / 6, 0}, 1e-16);
    expect_near(functions(cubic, 4, 0).slopes, {-1, 0, 1, 0}, 1e-15);
    expect_near(functions(cubic, 4, 1).values, {0, 1.0 / 6, 2.0 / 3, 1.0 / 6}, 1e-16);
    EXPECT_TRUE(cubic.lower().is_continuous());
}

TEST(TimeSpace, SplinesWithKinksEverywhereAreBernsteinPolynomials)
{
    const int p = 4;
    const Numbers ends{-1, 0, 0.5, 3, 5};
    const TimeSpace space = TimeSpace::bspline(p, clamped_knots(p, ends, ends));
    EXPECT_EQ(space.size(), 4 * p + 1);
    const double binomial[5] = {1, 4, 6, 4, 1};
    for (int e = 0; e < 4; ++e) {
        EXPECT_EQ(space.first(e), e * p);
        for (const double s : {0.0, 0.2, 0.7, 1.0}) {
            Numbers bernstein;
            for (int a = 0; a <= p; ++a)
                bernstein.push_back(binomial[a] * std::pow(s, a) * std::pow(1 - s, p - a));
            expect_near(functions(space, e, s).values, bernstein, 1e-15);
        }
    }
}

TEST(TimeSpace, SplinesAreZeroAndOneAtBothEndsToTheBit)
{
    // 49 (1 / 49) is not 1 in doubles.
    const Numbers ends{0, 49, 98, 147};
    const Numbers knots = clamped_knots(3, ends), weights{0.1, 0.7, 0.3, 1.1, 2.3, 0.9};
    for (const TimeSpace& space : {TimeSpace::bspline(3, knots), TimeSpace::nurbs(3, knots, weights)}) {
        EXPECT_EQ(functions(space, 0, 0).values, (Numbers{1, 0, 0, 0}));
        EXPECT_EQ(functions(space, 2, 1).values, (Numbers{0, 0, 0, 1}));
    }
}

TEST(TimeSpace, ElementsAreTheKnotSpansThatAreNotEmpty)
{
    const TimeSpace space = TimeSpace::bspline(2, {0, 0, 0, 1, 1, 2.5, 4, 4, 4});
    EXPECT_EQ(space.ends(), (Numbers{0, 1, 2.5, 4}));
    EXPECT_EQ(space.size(), 6);
    EXPECT_EQ(space.first(0), 0);
    EXPECT_EQ(space.first(1), 2);   // the double knot moves on by two
    EXPECT_EQ(space.first(2), 3);
    EXPECT_TRUE(space.is_continuous());
    EXPECT_FALSE(space.lower().is_continuous());
}

TEST(TimeSpace, RationalQuadraticsDrawAHalfCircle)
{
    // Two quarters, the classical example [Piegl1997, section 7.5]; no polynomial does this.
    const double w = std::sqrt(0.5), x[5] = {1, 1, 0, -1, -1}, y[5] = {0, 1, 1, 1, 0};
    const TimeSpace space = TimeSpace::nurbs(2, {0, 0, 0, 3, 3, 4, 4, 4}, {1, w, 1, w, 1});
    EXPECT_TRUE(space.is_rational());
    for (int e = 0; e < 2; ++e) {
        for (const double s : {0.0, 0.1, 0.5, 0.8, 1.0}) {
            const Functions f = functions(space, e, s);
            double px = 0, py = 0, vx = 0, vy = 0;
            for (std::size_t a = 0; a < 3; ++a) {
                const std::size_t A = static_cast<std::size_t>(space.first(e)) + a;
                px += f.values[a] * x[A], py += f.values[a] * y[A];
                vx += f.slopes[a] * x[A], vy += f.slopes[a] * y[A];
            }
            EXPECT_NEAR(px * px + py * py, 1, 1e-15);
            EXPECT_NEAR(px * vx + py * vy, 0, 1e-15);   // along the circle
            EXPECT_GT(px * vy - py * vx, 0.3);
            const double W = (1 - s) * (1 - s) + 2 * w * s * (1 - s) + s * s;
            EXPECT_NEAR(space.denominator(e, s), W, 1e-15);
        }
    }
}

TEST(TimeSpace, EveryElementTakesItsOwnWeights)
{
    // Degree 1: in element e only the weights e and e + 1 matter.
    const double w[4] = {1, 4, 2, 0.5};
    const TimeSpace space = TimeSpace::nurbs(1, {0, 0, 1, 2, 3, 3}, {w[0], w[1], w[2], w[3]});
    for (int e = 0; e < 3; ++e) {
        const double W = 0.75 * w[e] + 0.25 * w[e + 1];
        EXPECT_NEAR(space.denominator(e, 0.25), W, 1e-15);
        expect_near(functions(space, e, 0.25).values, {0.75 * w[e] / W, 0.25 * w[e + 1] / W}, 1e-15);
        const double slope = w[e] * w[e + 1] / (W * W);
        expect_near(functions(space, e, 0.25).slopes, {-slope, slope}, 1e-15);
    }
}

TEST(TimeSpace, OnlyRatiosOfWeightsMatter)
{
    const Numbers knots{0, 0, 0, 1, 2, 4, 4, 4};
    const TimeSpace space = TimeSpace::nurbs(2, knots, {1, 3, 0.5, 2, 1});
    for (const double scale : {0x1p-150, 0x1p150}) {   // powers of two: nothing is rounded
        Numbers weights{1, 3, 0.5, 2, 1};
        for (double& weight : weights) weight *= scale;
        const TimeSpace scaled = TimeSpace::nurbs(2, knots, weights);
        for (const double s : {0.0, 0.3, 1.0}) {
            EXPECT_EQ(functions(scaled, 1, s).values, functions(space, 1, s).values);
            EXPECT_EQ(functions(scaled, 1, s).slopes, functions(space, 1, s).slopes);
        }
    }
}

TEST(TimeSpace, WeightsAndKnotsAtTheirBoundsGiveNumbers)
{
    const TimeSpace space =
        TimeSpace::nurbs(2, {0, 0, 0, 1e-150, 1e150, 1e150, 1e150}, {1e-50, 1e50, 1e-50, 1e50});
    for (int e = 0; e < 2; ++e) {
        for (const double s : {0.0, 1e-12, 0.5, 1.0}) {
            const Functions f = functions(space, e, s);
            double sum = 0;
            for (std::size_t a = 0; a < 3; ++a) {
                EXPECT_TRUE(std::isfinite(f.slopes[a])) << e << " " << s;
                sum += f.values[a];
            }
            EXPECT_NEAR(sum, 1, 1e-15);
        }
    }
}

TEST(TimeSpace, LowerForgetsWeights)
{
    const TimeSpace space = TimeSpace::nurbs(2, {0, 0, 0, 1, 2, 2, 2}, {1, 2, 3, 4}), lower = space.lower();
    EXPECT_FALSE(lower.is_rational());
    EXPECT_EQ(lower.size(), 3);
    expect_near(functions(lower, 0, 0.25).values, {0.75, 0.25}, 1e-16);
    EXPECT_EQ(lower.denominator(0, 0.25), 1);
}

TEST(TimeSpace, IsAsAccurateFarFromZeroAsNearToIt)
{
    // 2^30 s away and with elements of 2^-8 s all knots are numbers of the machine: not one bit may differ.
    Numbers here, far;
    for (int i = 0; i <= 12; ++i) {
        here.push_back(0x1p-8 * (i + i / 3));
        far.push_back(0x1p30 + here.back());
    }
    const double shared[] = {0, 0.1, 0.37, 1 - 0x1p-40, 1};
    for (int p = 1; p <= 8; ++p) {
        const Numbers weights(static_cast<std::size_t>(12 + p), 1.5);
        const std::pair<TimeSpace, TimeSpace> pairs[] = {
            {TimeSpace::lagrange(here, p), TimeSpace::lagrange(far, p)},
            {TimeSpace::bspline(p, clamped_knots(p, here)), TimeSpace::bspline(p, clamped_knots(p, far))},
            {TimeSpace::nurbs(p, clamped_knots(p, here), weights),
             TimeSpace::nurbs(p, clamped_knots(p, far), weights)},
        };
        for (const auto& [near, away] : pairs) {
            for (int e = 0; e < 12; ++e) {
                for (const double s : shared) {
                    EXPECT_EQ(functions(near, e, s).values, functions(away, e, s).values);
                    EXPECT_EQ(functions(near, e, s).slopes, functions(away, e, s).slopes);
                }
            }
        }
    }
}

TEST(TimeSpace, KeepsTheRelativeAccuracyOfSmallValues)
{
    // The first function is (1 - s)^8 in the first element, the last one s^8 in the last.
    Numbers ends;
    for (int i = 0; i <= 8; ++i) ends.push_back(i);
    const TimeSpace space = TimeSpace::bspline(8, clamped_knots(8, ends));
    const double s = 0x1p-20;
    EXPECT_NEAR(functions(space, 7, s).values[8] / std::pow(s, 8), 1, 1e-14);
    EXPECT_NEAR(functions(space, 7, s).slopes[8] / (8 * std::pow(s, 7)), 1, 1e-14);
    EXPECT_NEAR(functions(space, 0, 1 - s).values[0] / std::pow(s, 8), 1, 1e-14);
}

TEST(TimeSpace, GrevilleAbscissaeAreMeansOfKnots)
{
    const TimeSpace space = TimeSpace::bspline(3, {0, 0, 0, 0, 1, 2, 2, 2, 5, 5, 5, 5});
    expect_near(space.interpolation_points(), {0, 1.0 / 3, 1, 5.0 / 3, 2, 3, 4, 5}, 1e-15);
    // At clamped knots and kinks they are these to the bit, whatever the mean of p equal numbers rounds to.
    const double start = 0.1, kink = 0.7, end = 1.1;
    for (int p = 3; p <= 8; ++p) {
        const Numbers ends{start, 0.15, 0.2, 0.3, 0.4, kink, 0.9, 1, end}, kinks{kink};
        const TimeSpace kinked = TimeSpace::bspline(p, clamped_knots(p, ends, kinks));
        const Numbers points = kinked.interpolation_points();
        EXPECT_EQ(points.front(), start);
        EXPECT_EQ(points.back(), end);
        EXPECT_EQ(std::count(points.begin(), points.end(), kink), 1);
    }
}

TEST(TimeSpace, PlacesAnInstant)
{
    const TimeSpace space = TimeSpace::lagrange({-1, 0, 0.5, 4}, 2);
    const auto expect_place = [&](double t, int element, double s) {
        EXPECT_EQ(space.place(t).element, element) << t;
        EXPECT_EQ(space.place(t).s, s) << t;
    };
    expect_place(-1, 0, 0);
    expect_place(-0.75, 0, 0.25);
    expect_place(0, 1, 0);   // the element that starts there
    expect_place(0.25, 1, 0.5);
    expect_place(0.5, 2, 0);
    expect_place(4, 2, 1);   // the end of the last belongs to it
    expect_place(-1.5, 0, 0);
    expect_place(infinity, 2, 1);
    // Just before an end: never beyond 1, whatever is rounded.
    const Numbers ends{0, 0.1, 0.30000000000000004, 0.7};
    const TimeSpace odd = TimeSpace::lagrange(ends, 1);
    for (std::size_t e = 0; e < 3; ++e) {
        const TimeSpace::Place place = odd.place(std::nextafter(ends[e + 1], 0.0));
        EXPECT_EQ(place.element, static_cast<int>(e));
        EXPECT_LE(place.s, 1);
        EXPECT_GT(place.s, 1 - 1e-15);
    }
}

TEST(TimeSpace, ManyElementsAreNoBurden)
{
    // A search from the first element on, or a copy of the space at a call, would take minutes.
    const int n = 100'000;
    const Numbers ends = make_time_mesh(0, 1000, n).ends;
    for (const TimeSpace& space :
         {TimeSpace::lagrange(ends, 3), TimeSpace::bspline(3, clamped_knots(3, ends)),
          TimeSpace::nurbs(3, clamped_knots(3, ends), Numbers(static_cast<std::size_t>(n + 3), 2.0))}) {
        ASSERT_EQ(space.n_elements(), n);
        double values[4], slopes[4], sum = 0;
        for (int e = 0; e < n; ++e) {
            const TimeSpace::Place place = space.place(ends[static_cast<std::size_t>(e)] + 0.004);
            ASSERT_EQ(place.element, e);
            space.evaluate(e, place.s, values, slopes);
            sum += values[0] + values[1] + values[2] + values[3];
        }
        EXPECT_NEAR(sum, n, 1e-7);
    }
}

TEST(TimeSpace, RefusesDegreesThatThereAreNot)
{
    for (const int degree : {-1, 0, 9}) {
        const std::string value = std::to_string(degree);
        expect_refused(
            [&] {
                TimeSpace::lagrange({0, 1}, degree);
            },
            "degree", "method.degree", value, "1 .. 8");
        expect_refused(
            [&] {
                TimeSpace::bspline(degree, {0, 0, 1, 1});
            },
            "degree", "method.degree", value, "1 .. 8");
        const Numbers ends{0, 1};
        expect_refused([&] { clamped_knots(degree, ends); }, "degree", "method.degree", value, "1 .. 8");
    }
    EXPECT_NO_THROW(TimeSpace::lagrange({0, 1}, 8));   // above the number of elements: no matter here
}

TEST(TimeSpace, RefusesEndsThatDoNotAscend)
{
    const auto expect_ends_refused = [](const Numbers& ends, const std::string& code,
                                        const std::string& value, const std::string& bound) {
        expect_refused([&] { TimeSpace::lagrange(ends, 2); }, code, "time.elements", value, bound);
        expect_refused([&] { clamped_knots(2, ends); }, code, "time.elements", value, bound);
    };
    expect_ends_refused({}, "time-elements", "0", "1 .. 1e+08");
    expect_ends_refused({3}, "time-elements", "0", "1 .. 1e+08");
    expect_ends_refused({0, 1, 1}, "time-resolution", "1", "> 1");
    expect_ends_refused({0, 1, 0.5}, "time-resolution", "0.5", "> 1");
    expect_ends_refused({0, 1e-200}, "time-resolution", "1e-200", "> 0");
    expect_ends_refused({0, nan}, "not-finite", "nan", "-1e+150 .. 1e+150");
    expect_ends_refused({-infinity, 1}, "not-finite", "-inf", "-1e+150 .. 1e+150");
    expect_ends_refused({0, 1e200}, "not-finite", "1e+200", "-1e+150 .. 1e+150");
}

TEST(TimeSpace, RefusesKnotsThatAreNoNumbers)
{
    for (const auto& [knot, text] : {std::pair{nan, "nan"}, {infinity, "inf"}, {1e151, "1e+151"}}) {
        expect_knots_refused(1, {0, 0, knot, 2, 2}, "knots-not-finite", text, "-1e+150 .. 1e+150");
        expect_knots_refused(1, {0, 0, 1, knot, knot}, "knots-not-finite", text, "-1e+150 .. 1e+150");
    }
    expect_knots_refused(1, {0, 0, 1e-160, 2, 2}, "knots-not-finite", "1e-160", ">= 1e-150");
}

TEST(TimeSpace, RefusesKnotsThatDecrease)
{
    expect_knots_refused(2, {0, 0, 0, 2, 1.5, 3, 3, 3}, "knots-decreasing", "1.5", ">= 2");
    // Told before anything that follows from it.
    expect_knots_refused(2, {1, 0}, "knots-decreasing", "0", ">= 1");
}

TEST(TimeSpace, RefusesTooFewKnots)
{
    expect_knots_refused(2, {}, "knots-few", "0", ">= 6");
    expect_knots_refused(2, {0, 0, 0, 1, 1}, "knots-few", "5", ">= 6");
    EXPECT_NO_THROW(TimeSpace::bspline(1, {0, 0, 1, 1}));   // as few as there may be
}

TEST(TimeSpace, RefusesKnotsThatAreNotClamped)
{
    expect_knots_refused(2, {0, 0, 1, 2, 3, 3, 3}, "knots-not-clamped", "2 times", "3 times");
    expect_knots_refused(2, {0, 1, 2, 3, 4, 5, 6}, "knots-not-clamped", "1 time", "3 times");
    expect_knots_refused(2, {0, 0, 0, 1, 2, 3, 3}, "knots-not-clamped", "2 times", "3 times");
    expect_knots_refused(2, {0, 0, 0, 0, 1, 2, 2, 2}, "knots-not-clamped", "4 times", "3 times");
    expect_knots_refused(1, {0, 0, 0, 0}, "knots-not-clamped", "4 times", "2 times");
}

TEST(TimeSpace, RefusesAKnotThatTearsTheMotion)
{
    expect_knots_refused(2, {0, 0, 0, 1, 1, 1, 2, 2, 2}, "knots-multiplicity", "3 times", "<= 2 times");
    expect_knots_refused(1, {0, 0, 1, 2, 2, 3, 3}, "knots-multiplicity", "2 times", "<= 1 times");
    EXPECT_NO_THROW(TimeSpace::bspline(2, {0, 0, 0, 1, 1, 2, 2, 2}));
}

TEST(TimeSpace, RefusesASplineDegreeAboveTheNumberOfElements)
{
    for (int p = 2; p <= 8; ++p) {
        Numbers ends;
        for (int e = 0; e < p; ++e) ends.push_back(e);   // p - 1 elements
        const Numbers knots = clamped_knots(p, ends);
        const std::string bound = "<= " + std::to_string(p - 1);
        expect_refused([&] { TimeSpace::bspline(p, knots); }, "spline-degree", "method.degree",
                       std::to_string(p), bound);
        expect_refused([&] { TimeSpace::nurbs(p, knots, {1}); }, "spline-degree", "method.degree",
                       std::to_string(p), bound);
        ends.push_back(p);
        EXPECT_NO_THROW(TimeSpace::bspline(p, clamped_knots(p, ends)));
    }
}

TEST(TimeSpace, RefusesWeightsThatAreNotPositive)
{
    const Numbers knots{0, 0, 1, 2, 2};
    const auto expect_weights_refused = [&](const Numbers& weights, const std::string& code,
                                            const std::string& value, const std::string& bound) {
        expect_refused([&] { TimeSpace::nurbs(1, knots, weights); }, code, "method.weights", value, bound);
    };
    expect_weights_refused({1, 0, 1}, "weights-not-positive", "0", "> 0");
    expect_weights_refused({1, 1, -2.5}, "weights-not-positive", "-2.5", "> 0");
    expect_weights_refused({nan, 1, 1}, "weights-not-positive", "nan", "> 0");
    expect_weights_refused({1, infinity, 1}, "weights-not-positive", "inf", "> 0");
    expect_weights_refused({1, 1e60, 1}, "weights-not-positive", "1e+60", "1e-50 .. 1e+50");
    expect_weights_refused({1, 1e-60, 1}, "weights-not-positive", "1e-60", "1e-50 .. 1e+50");
    expect_weights_refused({}, "weights-count", "0", "3");
    expect_weights_refused({1, 1}, "weights-count", "2", "3");
    expect_weights_refused({1, 1, 1, 1}, "weights-count", "4", "3");
}

TEST(TimeSpace, NamesTheKnotOrWeightThatIsWrong)
{
    const auto message = [](const std::function<void()>& call) { return complaint_of(call).message; };
    EXPECT_NE(message([] { TimeSpace::bspline(1, {0, 0, 2, 1, 3, 3}); }).find("knot 4"), std::string::npos);
    EXPECT_NE(message([] {
                  TimeSpace::bspline(1, {0, 0, 1, 2, 2, 3, 3});
              }).find("knot 4"),
              std::string::npos);
    EXPECT_NE(message([] {
                  TimeSpace::nurbs(1, {0, 0, 1, 2, 2}, {1, -1, 1});
              }).find("weight 2"),
              std::string::npos);
}

TEST(ClampedKnots, StandOnceInsideAndMoreOftenAtEndsAndKinks)
{
    const Numbers ends{0, 1, 2, 4};
    EXPECT_EQ(clamped_knots(1, ends), (Numbers{0, 0, 1, 2, 4, 4}));
    EXPECT_EQ(clamped_knots(2, ends), (Numbers{0, 0, 0, 1, 2, 4, 4, 4}));
    const Numbers kinks{2};
    EXPECT_EQ(clamped_knots(1, ends, kinks), (Numbers{0, 0, 1, 2, 4, 4}));   // hats have a kink anyway
    EXPECT_EQ(clamped_knots(3, ends, kinks), (Numbers{0, 0, 0, 0, 1, 2, 2, 2, 4, 4, 4, 4}));
    const TimeSpace space = TimeSpace::bspline(3, clamped_knots(3, ends, kinks));
    EXPECT_TRUE(space.is_continuous());
    EXPECT_EQ(space.ends(), ends);
}

TEST(ClampedKnots, FindTheEndOfAKinkAsTheMeshMergedIt)
{
    const Numbers output{0.5};
    const TimeMesh mesh = make_time_mesh(0, 1, 4, output);
    const Numbers plain = clamped_knots(2, mesh.ends), expected{0, 0, 0, 0.25, 0.5, 0.5, 0.75, 1, 1, 1};
    for (const double kink : {0.5, 0.5 - 1e-10, 0.5 + 1e-10}) {
        const Numbers kinks{kink, kink};   // twice is once
        EXPECT_EQ(clamped_knots(2, mesh.ends, kinks), expected);
    }
    // No kink inside an element, at an end of the time or outside; nan is nowhere.
    const Numbers kinks{0.6, 0.5 + 1e-8, 0, 1e-12, 1, 1 - 1e-12, -2, 7, nan, infinity};
    EXPECT_EQ(clamped_knots(2, mesh.ends, kinks), plain);
}

}   // namespace
}   // namespace livens::time_space_test
