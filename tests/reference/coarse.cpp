// SPDX-License-Identifier: BSD-3-Clause
// An example on far fewer elements than it is shipped with.
#include <regex>
#include <sstream>

#include "reference/shipped.h"

namespace livens::tests::coarse_test {
namespace {

// x(t) = 1 + 0.2 exp(-t) (cos 10 t + 0.1 sin 10 t), in elements of 8 rad each.
TEST(Coarse, SpringMassConvergesWithFiveElements)
{
    std::ifstream file(root / "examples/spring_mass.toml");
    std::stringstream shipped;
    shipped << file.rdbuf();
    std::string text = std::regex_replace(shipped.str(), std::regex("\noutput = [^\n]*"), "");
    text = std::regex_replace(text, std::regex("\nelements = [^\n]*"), "\nelements = 5");
    const ScenarioResult read = parse_scenario(text, "spring_mass.toml");
    ASSERT_TRUE(read.scenario) << render(read.diagnostics, read.text, DiagnosticFormat::human);
    const Scenario& s = *read.scenario;
    ASSERT_EQ(std::get<TimeMesh>(s.time).n_elements(), 5);
    const Solution solution = solve(s.model, {s.conditions}, s.time, s.method, s.options);
    ASSERT_TRUE(solution.report.converged()) << solution.report.message;
    for (int e = 0; e <= 5; ++e) {
        const double t = std::get<TimeMesh>(s.time).ends[e];
        const double exact = 1 + 0.2 * std::exp(-t) * (std::cos(10 * t) + 0.1 * std::sin(10 * t));
        EXPECT_NEAR(solution.motion.at_end(e).X[0](0, 0), exact, 5e-5) << t;
    }
}

}   // namespace
}   // namespace livens::tests::coarse_test
