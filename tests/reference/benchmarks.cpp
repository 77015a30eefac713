// SPDX-License-Identifier: BSD-3-Clause
// examples/benchmarks as they stand, against the digits that were published: the figures of
// docs/validation.md.
#include <cstdio>

#include "livens/solvers/instructions.h"
#include "reference/published.h"

namespace livens::tests::benchmarks_test {
namespace {

/// Largest error over all instants of the table, of places in lengths of the model and of turns in rad.
double error_of(const Published& p)
{
    const Scenario& s = p.scenario;
    const Solution solution = solve(s.model, {s.model.start()}, s.time, s.method, s.options);
    EXPECT_TRUE(solution.report.converged()) << p.name << ": " << solution.report.message;
    EXPECT_TRUE(solution.verdict.reasons.empty()) << p.name << ": " << solution.verdict.reasons.front();
    double worst = 0;
    for (std::size_t i = 0; i < p.times.size(); ++i)
        worst = std::max(worst, p.error(s.model, solution.motion.at(p.times[i]), i));
    return worst;
}

TEST(Benchmarks, MeetThePublishedDigits)
{
    std::vector<Published> problems = published_problems();
    problems.pop_back();   // 81 bodies: with the slow tests, which take it to every accuracy
    for (const Published& problem : problems) {
        const double error = error_of(problem);
        std::printf("%-8s %.1e\n", problem.name, error);
        EXPECT_LT(error, problem.reached) << problem.name;
    }
}

/// Degree 12 has rounding of 1 to 3 e-10 there, which no shorter element of it takes off.
TEST(Benchmarks, ATryOfALowerDegreeHasLessRounding)
{
    const Published p = published_problems()[6];
    const Scenario& s = p.scenario;
    const Instructions before = instructions();
    for (const Instructions set : {Instructions::sse2, Instructions::avx2, Instructions::avx512}) {
        if (!use_instructions(set)) continue;
        for (const std::vector<double>& output : {std::vector<double>{}, p.times}) {
            const Span span{0, 5, 1e-10, output};
            const Solution solution = solve(s.model, {s.model.start()}, span, AutomaticFamily{}, s.options);
            EXPECT_TRUE(solution.report.converged()) << to_string(set) << ": " << solution.report.message;
            EXPECT_LE(solution.report.tries, 5) << to_string(set);
        }
    }
    use_instructions(before);
}

/// The lower brick's turn about its long axis is good to 1e-11 at best by 5 s, however short the elements.
TEST(Benchmarks, WhereRoundingDecidesTheRunSaysSo)
{
    const Scenario s = published_problems()[6].scenario;
    const Solution solution = solve(s.model, {s.model.start()}, Span{0, 5, 1e-12}, s.method, s.options);
    EXPECT_EQ(solution.report.status, SolveStatus::inaccurate);
    EXPECT_NE(solution.report.message.find("rounding"), std::string::npos) << solution.report.message;
}

TEST(Benchmarks, AnotherProblemDoesNotMeetThem)
{
    Published problem = published_problems()[4];
    Scenario& s = problem.scenario;
    Model heavier({0, 0, -9.82});
    for (const Body& body : s.model.bodies()) heavier.add_body(body);
    s.model = heavier;
    EXPECT_GT(error_of(problem), 1e-3);
}

}   // namespace
}   // namespace livens::tests::benchmarks_test
