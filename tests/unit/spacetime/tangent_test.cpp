// The element's tangent against differences of its rows, and what it does for Newton.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "livens/multibody/assembly.h"
#include "livens/spacetime/lobatto/element.h"
#include "livens/spacetime/solve.h"
#include "unit/spacetime/mechanisms.h"

namespace livens {
namespace {

using testing_models::everything;
using testing_models::two_bricks;

class TangentOf : public ::testing::TestWithParam<int> {};

InstantState moving_start(const Model& model, const Assembly& assembly, const Tables& tables,
                      InstantSystem& ends)
{
    InstantState state;
    state.resize(tables);
    std::mt19937_64 engine(3);
    for (int b = 0; b < model.n_bodies(); ++b)
        std::copy_n(assembly.start.X[b].a, 12, state.X.begin() + 12 * b);
    EXPECT_TRUE(ends.prepare(state));
    std::vector<double> p(static_cast<std::size_t>(tables.n_twists)), lambda(tables.rows.size());
    for (double& v : p) v = 3 * (static_cast<double>(engine() >> 11) * 0x1p-53) - 1.5;
    ends.from_momentum(state, p.data(), 1.0, lambda.data());
    ends.accelerate(state, Side::right);
    return state;
}

/// Largest difference between tangent and central differences, relative to the largest entry.
double tangent_error(const Model& model, int degree)
{
    const Assembly assembly = assemble(model, model.start(), StartPolicy::check);
    const LobattoRule rule = lobatto_rule(degree);
    const Tables tables(model, static_cast<int>(assembly.independent.size()));
    InstantSystem ends(tables);
    const InstantState start = moving_start(model, assembly, tables, ends);
    Element element(tables, rule);
    element.begin(start, 0.1);
    const int n = tables.n_twists, N = degree * n;
    std::mt19937_64 engine(degree);
    std::vector<double> xi(static_cast<std::size_t>(n));
    auto move = [&](int B, double size) {
        for (double& v : xi) v = size * (2 * (static_cast<double>(engine() >> 11) * 0x1p-53) - 1);
        element.move(B, xi.data());
    };
    for (int B = 1; B <= degree; ++B) move(B, 0.1);
    EXPECT_TRUE(element.evaluate());
    std::vector<std::vector<double>> lambda(static_cast<std::size_t>(degree),
                                            std::vector<double>(tables.rows.size()));
    for (int A = 0; A < degree; ++A) element.multipliers(A, lambda[static_cast<std::size_t>(A)].data());
    const std::vector<double> J = element.tangent();
    std::vector<std::vector<double>> maps;
    for (int A = 0; A <= degree; ++A)
        maps.emplace_back(element.maps(A), element.maps(A) + 12 * model.n_bodies());
    std::vector<double> unit(static_cast<std::size_t>(n));
    double worst = 0, largest = 0;
    for (int B = 1; B <= degree; ++B) {
        for (int j = 0; j < n; ++j) {
            // four points: error eps^4 / 30 of the fifth derivative, rounding 1e-16 / eps
            const double eps = 2e-4, weight[4] = {1, -8, 8, -1};
            auto move_along = [&](double size) {
                std::fill(unit.begin(), unit.end(), 0.0);
                unit[static_cast<std::size_t>(j)] = size;
                tables.to_twist(maps[static_cast<std::size_t>(B)].data(), unit.data(), xi.data());
                element.move(B, xi.data());
            };
            std::vector<double> rows[4];
            for (int side = 0; side < 4; ++side) {
                move_along(side == 0 ? -2 * eps : (side == 2 ? 2 * eps : eps));   // from place to place
                EXPECT_TRUE(element.evaluate());
                for (int A = 0; A < degree; ++A) {
                    const auto at = static_cast<std::size_t>(A);
                    const auto r = element.rows_with(A, lambda[at], maps[at].data());
                    rows[side].insert(rows[side].end(), r.begin(), r.end());
                }
            }
            move_along(-2 * eps);
            for (int r = 0; r < N; ++r) {
                const auto at = static_cast<std::size_t>(r);
                double difference = 0;
                for (int side = 0; side < 4; ++side) difference += weight[side] * rows[side][at] / (12 * eps);
                const double entry = J[static_cast<std::size_t>(r * N + (B - 1) * n + j)];
                worst = std::max(worst, std::abs(difference - entry));
                largest = std::max(largest, std::abs(entry));
            }
        }
    }
    return worst / largest;
}

TEST_P(TangentOf, MatchesDifferencesWithEveryKindOfTerm)
{
    EXPECT_LT(tangent_error(everything(), GetParam()), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Lobatto, TangentOf, ::testing::Values(1, 2, 3, 5));

TEST(Newton, ConvergesQuadraticallyOnceClose)
{
    // one tangent an element and about two iterations, as the guess is of half the degree
    const Model model = two_bricks();
    const Solution s = solve(model, {model.start()}, make_time_mesh(0, 1, 20), Lobatto{6});
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_LE(s.report.most_iterations, 5);
    EXPECT_LE(static_cast<double>(s.report.newton_iterations) / s.report.n_elements, 3.5);
    EXPECT_LE(static_cast<double>(s.report.factorisations) / s.report.n_elements, 1.1);
}

TEST(Newton, HighDegreesConvergeOnLongElements)
{
    const Model model = two_bricks();
    for (int degree : {8, 12, 16}) {
        const Solution s = solve(model, {model.start()}, make_time_mesh(0, 2, 20), Lobatto{degree});
        ASSERT_TRUE(s.report.converged()) << s.report.message;
        EXPECT_LE(s.report.most_iterations, 10) << "degree " << degree;
    }
}

}   // namespace
}   // namespace livens
