// Down to the last digits, and beside a witness that shares nothing with the elements.
#include <array>

#include "mechanisms.h"

namespace livens::tests {
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
        all.push_back(directors_from_rotation_vector({2 * std::sin(a), 2 * std::cos(2 * a), 1.5 * std::sin(3 * a + 1)}));
    }
    return all;
}

// Turned axes change nothing but rounding: nine runs show its spread, and that the nominal run was no stroke of luck.
// Two codes agree on the published digits to 3e-12.
TEST(Lobatto, ReachesTwelveDigitsOnTwoBricks)
{
    const Tips published{Vector3{0.111833021129, 0.506986576949, -0.854668348647},
                         Vector3{0.644182606655, -0.291228917392, -1.136547655061}};
    std::vector<double> errors;
    for (const Matrix3& turn : turns()) errors.push_back(worst_entry(tips_at_2(8, 80, turn), published));
    EXPECT_LE(errors.front(), 1.5e-12) << "axes as published";
    std::sort(errors.begin(), errors.end());
    EXPECT_LE(errors[4], 1e-12) << "median";
    EXPECT_LE(errors[8], 2e-12) << "largest";

    const Tips finer = tips_at_2(11, 100, identity<3>());
    EXPECT_LE(worst_entry(finer, published), 3e-12);
    EXPECT_LE(worst_entry(finer, tips_at_2(8, 80, identity<3>())), 3e-12);
}

TEST(Lobatto, AgreesWithTheExtrapolatedMidpointRule)
{
    const Model model = two_bricks();
    std::vector<State> steps;
    for (int n : {1000, 2000, 4000}) {
        const Solution s = solve(model, {model.start()}, make_time_mesh(0, 1, n), Midpoint{});
        ASSERT_TRUE(s.report.converged()) << s.report.message;
        steps.push_back(last(s));
    }
    // errors of orders h^2 and h^4 are taken out: (e(h) - 20 e(h/2) + 64 e(h/4)) / 45
    State limit = steps[0];
    for (std::size_t b = 0; b < 2; ++b) {
        limit.X[b] = (1.0 / 45) * (steps[0].X[b] - 20 * steps[1].X[b] + 64 * steps[2].X[b]);
        limit.V[b] = (1.0 / 45) * (steps[0].V[b] - 20 * steps[1].V[b] + 64 * steps[2].V[b]);
    }
    const State lobatto = last(solve_evenly(model, 1, 40, 8));
    EXPECT_LE(distance(lobatto, limit).X, 1e-7);
    EXPECT_LE(distance(lobatto, limit).V, 1e-6);
    EXPECT_GE(distance(lobatto, steps[2]).X, 1e-7) << "the witness needed no extrapolation: is it one?";
}

}   // namespace
}   // namespace livens::tests
