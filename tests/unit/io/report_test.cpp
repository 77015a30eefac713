// SPDX-License-Identifier: BSD-3-Clause
// The report as far as it needs no program; tests/system/report_test.py and report/test/browser.mjs have the
// rest.
#include "livens/io/report.h"

#include <gtest/gtest.h>

#include "livens/io/report/lines_of_action.h"
#include "livens/io/report/payload.h"
#include "livens/spacetime/solve.h"

namespace livens {
namespace {

using RunFile = Run;   // testing::Test has a Run of its own

constexpr const char* pendulum = R"(format = 1
title = "pendulum"
gravity = [0, 0, -9.81]
[[body]]
name = "rod"
shape = { box = [0.02, 0.02, 1] }
mass = 2
center_of_mass = [0, 0, -0.5]
rotation_vector = [0, 1, 0]
[[body]]
name = "bob"
shape = { point = true }
mass = 1
position = [3, 0, 0]
velocity = [0, 1, 0]
[[joint]]
name = "pivot"
type = "revolute"
between = ["world", "rod"]
at = [0, 0, 0]
axis = [0, 1, 0]
[[load]]
name = "drag"
type = "drag"
body = "bob"
linear = 0.1
[time]
end = 4
elements = 40
[method]
degree = 6
estimate = "none"
)";

class Report : public testing::Test {
protected:
    Report()
        : scenario_(parse_scenario(pendulum, "pendulum.toml").scenario.value()),
          run_(make_run(scenario_.model,
                        solve(scenario_.model, {scenario_.conditions}, scenario_.time, scenario_.method,
                              scenario_.options),
                        scenario_.method))
    {
        run_.title = scenario_.title;
        run_.scenario_text = scenario_.text;
        run_.resolved = scenario_.resolved;
    }
    std::string page(double most_bytes) const
    {
        const ReportInput input{scenario_, run_, "pendulum"};
        return report_page(input, nullptr, {most_bytes});
    }
    /// A number or word that the page has behind a key, or behind several of them.
    static std::string found(const std::string& page, const std::string& key)
    {
        const std::size_t start = page.find("\"" + key + "\":");
        if (start == std::string::npos) return "";
        const std::size_t value = page.find_first_not_of("\" ", start + key.size() + 3);
        return page.substr(value, page.find_first_of("\",}", value) - value);
    }

    Scenario scenario_;
    RunFile run_;
};

/// 241 nodes of 7 and 3 numbers.
TEST_F(Report, PrecisionGoesByWhatPosesTake)
{
    constexpr double in_doubles = 241 * 10 * 8;
    EXPECT_EQ(found(page(in_doubles), "pose\": {\"precision"), "double");
    EXPECT_EQ(found(page(in_doubles - 1), "pose\": {\"precision"), "single");
    EXPECT_EQ(found(page(in_doubles / 2), "pose\": {\"precision"), "single");
    EXPECT_EQ(found(page(in_doubles / 2 - 1), "pose\": {\"precision"), "thinned");
}

/// What is lost is measured: the less room, the more.
TEST_F(Report, LossesAreStatedAndGrow)
{
    const auto loss = [&](double most_bytes, const char* of) {
        return std::stod(found(page(most_bytes), std::string(of) + "_loss"));
    };
    EXPECT_LT(loss(1e6, "orientation"), 4e-15);
    EXPECT_EQ(loss(1e6, "position"), 0);
    EXPECT_GT(loss(15000, "orientation"), 1e-9);
    EXPECT_LT(loss(15000, "orientation"), 2e-7);
    EXPECT_GT(loss(3000, "orientation"), 1e-6);
    EXPECT_GT(loss(1000, "orientation"), loss(3000, "orientation"));
}

TEST_F(Report, OneOrTwoRuns)
{
    const ReportInput input{scenario_, run_, "pendulum"};
    const auto n_runs = [](const std::string& page) {
        int n = 0;
        for (std::size_t at = page.find("class=\"numbers\""); at != std::string::npos;
             at = page.find("class=\"numbers\"", at + 1))
            ++n;
        return n;
    };
    EXPECT_EQ(n_runs(report_page(input)), 1);
    EXPECT_EQ(n_runs(report_page(input, &input)), 2);
}

/// A drag acts at its point; what exerts nothing has none.
TEST_F(Report, LinesOfActionAreReadFromForces)
{
    const std::vector<LineOfAction> lines = lines_of_action(scenario_.model, run_.motion);
    ASSERT_EQ(lines.size(), 1u);
    ASSERT_TRUE(lines[0].points[0].has_value());
    EXPECT_LT(norm(*lines[0].points[0]), 1e-12);
    EXPECT_FALSE(lines[0].points[1].has_value());
}

/// [RFC 4648, section 10]
TEST(ReportText, Base64)
{
    const std::pair<const char*, const char*> known[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
    for (const auto& [plain, encoded] : known) EXPECT_EQ(base64(plain), encoded);
    EXPECT_EQ(base64(std::string_view("\xfb\xff\x00", 3)), "+/8A");
}

}   // namespace
}   // namespace livens
