// SPDX-License-Identifier: BSD-3-Clause
// Down to the last digits, and beside a witness that shares nothing with the elements.
#include <array>

#include "mechanisms.h"

namespace livens::tests::precision_test {
namespace {

using Tips = std::array<Vector3, 2>;

/// Tips of two bricks at 2 s, computed in axes that are turned by `turn` and turned back.
Tips tips_at_2(int degree, int n, const Matrix3& turn)
{
    const State end = last(solve_evenly(two_bricks({turn, 1}), 2, n, degree));
    return {transpose(turn) * tip(end, 0), transpose(turn) * tip(end, 1)};
}

double worst_entry(const Tips& l, const Tips& r)
{
    double worst = 0;
    for (int k = 0; k < 2; ++k)
        for (int i = 0; i < 3; ++i) worst = std::max(worst, std::abs(l[k][i] - r[k][i]));
    return worst;
}

std::vector<Matrix3> turns()
{
    std::vector<Matrix3> all{identity<3>()};
    for (int k = 1; k <= 8; ++k) {
        const double a = 0.7 * k;
        all.push_back(directors_from_rotation_vector(
            {2 * std::sin(a), 2 * std::cos(2 * a), 1.5 * std::sin(3 * a + 1)}));
    }
    return all;
}

// Turned axes change nothing but rounding: nine runs show its spread, and that the nominal run was no stroke
// of luck. Two codes agree on the published digits to 3e-12.
TEST(Lobatto, ReachesTwelveDigitsOnTwoBricks)
{
    const Tips published{Vector3{0.111833021129, 0.506986576949, -0.854668348647},
                         Vector3{0.644182606655, -0.291228917392, -1.136547655061}};
    std::vector<double> errors;
    for (const Matrix3& turn : turns()) errors.push_back(worst_entry(tips_at_2(8, 80, turn), published));
    EXPECT_LE(errors.front(), 1e-12) << "axes as published";
    std::sort(errors.begin(), errors.end());
    EXPECT_LE(errors[4], 1e-12) << "median";
    EXPECT_LE(errors[8], 1e-12) << "largest";

    const Tips finer = tips_at_2(11, 100, identity<3>());
    EXPECT_LE(worst_entry(finer, published), 3e-12);
    EXPECT_LE(worst_entry(finer, tips_at_2(8, 80, identity<3>())), 3e-12);
}

/// The midpoint rule with n, 2n and 4n steps, its errors of orders h^2 and h^4 taken out.
struct Extrapolated {
    State limit;
    State finest;

    Extrapolated(const Model& model, double end, int n)
    {
        std::vector<State> steps;
        for (int refinement : {1, 2, 4}) {
            const TimeMesh mesh = make_time_mesh(0, end, refinement * n);
            const Solution s = solve(model, {model.start()}, mesh, Midpoint{});
            EXPECT_TRUE(s.report.converged()) << s.report.message;
            steps.push_back(last(s));
        }
        finest = limit = steps[2];
        for (std::size_t b = 0; b < limit.X.size(); ++b) {
            limit.X[b] = (1.0 / 45) * (steps[0].X[b] - 20 * steps[1].X[b] + 64 * steps[2].X[b]);
            limit.V[b] = (1.0 / 45) * (steps[0].V[b] - 20 * steps[1].V[b] + 64 * steps[2].V[b]);
        }
    }
};

/// `n` elements of degree 8 against the midpoint rule.
void expect_agreement(const Model& model, double end, int n, int n_steps, double tolerance)
{
    const Extrapolated midpoint(model, end, n_steps);
    const State lobatto = last(solve_evenly(model, end, n, 8));
    EXPECT_LE(distance(lobatto, midpoint.limit).X, tolerance);
    EXPECT_LE(distance(lobatto, midpoint.limit).V, 10 * tolerance);
    EXPECT_GE(distance(lobatto, midpoint.finest).X, tolerance)
        << "the witness needed no extrapolation: is it one?";
}

TEST(Lobatto, AgreesWithTheExtrapolatedMidpointRule) { expect_agreement(two_bricks(), 1, 40, 1000, 1e-7); }

// No motion of the four-bar is published; the witness drops redundant rows and solves the rest by itself.
TEST(Lobatto, AgreesWithTheExtrapolatedMidpointRuleOnARedundantLoop)
{
    expect_agreement(four_bar(), 0.5, 10, 100, 1e-8);
}

}   // namespace
}   // namespace livens::tests::precision_test
