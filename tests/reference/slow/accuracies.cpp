// SPDX-License-Identifier: BSD-3-Clause
// Every published problem to every accuracy, by its end and its output times alone: no mesh, no degree, no
// method.
#include "reference/published.h"

namespace livens::tests::accuracies_test {
namespace {

class EveryAccuracy : public ::testing::TestWithParam<double> {};

/// True error at most three times the accuracy, by defaults.
void expect_reached(const Published& p, double accuracy)
{
    const Span span{0, p.times.back(), accuracy, p.times};
    const Solution s = solve(p.scenario.model, {p.scenario.model.start()}, span, AutomaticFamily{});
    if (accuracy < p.finest) {
        EXPECT_EQ(s.report.status, SolveStatus::inaccurate) << p.name;
        EXPECT_NE(s.report.message.find("rounding"), std::string::npos) << s.report.message;
        return;
    }
    ASSERT_TRUE(s.report.converged()) << p.name << ": " << s.report.message;
    EXPECT_TRUE(s.verdict.reasons.empty()) << p.name << ": " << s.verdict.reasons.front();
    EXPECT_LE(s.verdict.estimated_error, accuracy) << p.name;
    double worst = 0;
    for (std::size_t i = 0; i < p.times.size(); ++i)
        worst = std::max(worst, p.error(p.scenario.model, s.motion.at(p.times[i]), i));
    EXPECT_LE(worst, 3 * accuracy + p.digits) << p.name;
    std::printf("%s  accuracy %.0e  estimated %.1e  true at %zu instants %.1e  %d elements\n", p.name,
                accuracy, s.verdict.estimated_error, p.times.size(), worst, s.motion.n_elements());
}

TEST_P(EveryAccuracy, IsReachedOnPublishedProblems)
{
    for (const Published& problem : published_problems()) expect_reached(problem, GetParam());
}

INSTANTIATE_TEST_SUITE_P(From, EveryAccuracy,
                         ::testing::Values(1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10));

}   // namespace
}   // namespace livens::tests::accuracies_test
