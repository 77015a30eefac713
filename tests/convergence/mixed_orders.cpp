// SPDX-License-Identifier: BSD-3-Clause
// Orders of the paper's elements on the free box under a constant torque, pairing by pairing.
#include "mixed_problems.h"

namespace livens::tests::mixed_orders_test {
namespace {

struct Order {
    std::string name;
    Pairing pairing;
    double order;
    double tolerance;
};

void PrintTo(const Order& order, std::ostream* out) { *out << order.name; }

class MixedOrders : public ::testing::TestWithParam<Order> {};

/// Slope of the straight line through (log n, -log error) of errors between 1e-3 and 1e-9, by least squares.
double fitted_order(const std::vector<int>& n, const std::vector<double>& error)
{
    double k = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < n.size(); ++i) {
        if (error[i] > 1e-3 || error[i] < 1e-9) continue;
        const double u = std::log(n[i]), v = -std::log(error[i]);
        k += 1, x += u, y += v, xx += u * u, xy += u * v;
    }
    EXPECT_GE(k, 4) << "too few errors between 1e-3 and 1e-9";
    return (k * xy - x * y) / (k * xx - x * x);
}

/// Numbers of elements from where the error is about 1e-3.
std::vector<int> meshes(double order)
{
    if (order < 2.5) return {40, 50, 64, 80, 100, 128};
    if (order < 3.5) return {16, 20, 25, 32, 40, 50, 64};
    if (order > 6) return {3, 4, 5, 6, 7, 8, 9};
    return {8, 10, 12, 16, 20, 25, 32};
}

TEST_P(MixedOrders, AreThoseMeasured)
{
    const Order& wanted = GetParam();
    const std::vector<int> n = meshes(wanted.order);
    std::vector<double> error;
    for (const int elements : n) {
        const Model model = free_box();
        error.push_back(box_error(last(solve_mixed_evenly(model, 1, elements, mixed(wanted.pairing)))));
    }
    EXPECT_NEAR(fitted_order(n, error), wanted.order, wanted.tolerance)
        << error.front() << " " << error.back();
}

// The paper's three are linear 2, quadratic 3 and B-splines. An end multiplier of zero holds every degree
// down to order 4, which is its negative control.
INSTANTIATE_TEST_SUITE_P(
    FreeBox, MixedOrders,
    ::testing::Values(Order{"Linear", {lagrange, 1, natural, equal}, 2, 0.15},
                      Order{"Quadratic", {lagrange, 2, natural, equal}, 3, 0.15},
                      Order{"QuadraticSpline", {bspline, 2, natural, equal}, 3, 0.15},
                      Order{"Cubic", {lagrange, 3, natural, equal}, 4, 0.15},
                      Order{"Quartic", {lagrange, 4, natural, equal}, 5, 0.3},
                      Order{"Sextic", {lagrange, 6, natural, equal}, 7, 0.4},
                      Order{"QuadraticZero", {lagrange, 2, natural, equal, zero}, 3, 0.15},
                      Order{"QuadraticSplineZero", {bspline, 2, natural, equal, zero}, 3, 0.15},
                      Order{"QuarticZero", {lagrange, 4, natural, equal, zero}, 4, 0.3},
                      Order{"SexticZero", {lagrange, 6, natural, equal, zero}, 4, 0.3},
                      Order{"LinearLower", {lagrange, 1, natural, lower}, 2, 0.15},
                      Order{"QuadraticLower", {lagrange, 2, natural, lower}, 2, 0.15},
                      Order{"CubicLower", {lagrange, 3, natural, lower}, 4, 0.15},
                      Order{"QuadraticSplineLower", {bspline, 2, natural, lower}, 3, 0.15},
                      Order{"QuarticSplineLower", {bspline, 4, natural, lower}, 5, 0.3},
                      Order{"CubicStrong", {lagrange, 3, strong, equal}, 4, 0.15},
                      Order{"QuadraticSplineStrongLower", {bspline, 2, strong, lower}, 3, 0.15}),
    [](const auto& of) { return of.param.name; });

TEST(MixedQuadrature, WithAsManyPointsAsTheDegreeIsCollocationOfOrderTwo)
{
    for (const int p : {1, 2}) {
        Mixed method = mixed({lagrange, p, strong, equal});
        method.gauss_points = p;
        const std::vector<int> n{40, 50, 64, 80, 100, 128};
        std::vector<double> error;
        for (const int elements : n)
            error.push_back(box_error(last(solve_mixed_evenly(free_box(), 1, elements, method))));
        EXPECT_NEAR(fitted_order(n, error), 2, 0.15) << "degree " << p;
    }
}

TEST(MixedFreePoints, AreSuperconvergentWithTheNaturalStart)
{
    Model model({0, 0, -3});
    const int bob = model.add_body(point_mass("bob", 0.7, {1.2, 0.1, 0}, {0, 0.5, 0}));
    model.add_load(spring_damper("spring", world, {}, bob, {}, {20, 0, 0.8}));
    const State reference = last(solve_evenly(model, 1, 60, 10));
    struct {
        Pairing pairing;
        double order;
    } const cases[] = {{{lagrange, 1, natural, equal}, 4},
                       {{bspline, 2, natural, equal}, 6},
                       {{lagrange, 1, strong, equal}, 2},
                       {{bspline, 2, strong, equal}, 3}};
    for (const auto& c : cases) {
        Mixed method = mixed(c.pairing);
        method.gauss_points = c.pairing.degree + 4;   // the spring is no polynomial
        const std::vector<int> n = c.order < 4 ? std::vector<int>{100, 128, 160, 200, 256}
                                               : std::vector<int>{20, 24, 32, 40, 48, 64};
        std::vector<double> error;   // odd numbers of elements have errors of their own
        for (const int elements : n)
            error.push_back(distance(last(solve_mixed_evenly(model, 1, elements, method)), reference).X);
        EXPECT_NEAR(fitted_order(n, error), c.order, 0.25) << name_of(method);
    }
}

TEST(MixedNurbs, WithEqualWeightsAreTheirSplines)
{
    Mixed spline = mixed({bspline, 3, natural, equal});
    Mixed nurbs = spline;
    nurbs.basis = Mixed::Basis::nurbs;
    nurbs.weights.assign(11, 0.7);
    nurbs.gauss_points = spline.gauss_points = 7;
    const State a = last(solve_mixed_evenly(free_box(), 1, 8, spline));
    const State b = last(solve_mixed_evenly(free_box(), 1, 8, nurbs));
    EXPECT_LT(distance(a, b).X, 1e-13);
    nurbs.weights[5] = 0.71;
    const State c = last(solve_mixed_evenly(free_box(), 1, 8, nurbs));
    EXPECT_GT(distance(a, c).X, 1e-7) << "weights count";
    // Quotients with unequal weights do not hold the straight line of the box's flight.
    EXPECT_LT(box_error(c), 5e-3) << "and still solve the box";
}

TEST(MixedKnots, MayBeAnywhere)
{
    Mixed method = mixed({bspline, 2, natural, equal});
    method.knots = {0, 0, 0, 0.02, 0.1, 0.15, 0.3, 0.3, 0.45, 0.6, 0.65, 0.8, 0.95, 1, 1, 1};
    const TimeMesh mesh{{0, 0.02, 0.1, 0.15, 0.3, 0.45, 0.6, 0.65, 0.8, 0.95, 1}};
    const Model model = free_box();
    const Solution solution = solve(model, {model.start()}, mesh, method);
    ASSERT_TRUE(solution.report.converged()) << solution.report.message;
    EXPECT_LT(box_error(last(solution)), 2e-3);
}

}   // namespace
}   // namespace livens::tests::mixed_orders_test
