// SPDX-License-Identifier: BSD-3-Clause
// The report as far as it needs no program; tests/system/report_test.py and report/test/browser.mjs have the
// rest.
#include "livens/io/report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/sample.h"
#include "livens/io/report/lines_of_action.h"
#include "livens/io/report/payload.h"
#include "livens/io/surface.h"
#include "livens/spacetime/solve.h"
#include "sanitized.h"

namespace livens::report_test {
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
    constexpr double numbers = 241 * 10;   // of 10 bytes on the page, rounded of 2
    EXPECT_EQ(found(page(10 * numbers), "pose\": {\"precision"), "double");
    EXPECT_EQ(found(page(10 * numbers - 1), "pose\": {\"precision"), "rounded");
    EXPECT_EQ(found(page(2 * numbers), "pose\": {\"precision"), "rounded");
    EXPECT_EQ(found(page(2 * numbers - 1), "pose\": {\"precision"), "thinned");
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
    EXPECT_GT(loss(3000, "orientation"), 2 * loss(15000, "orientation"));
    EXPECT_GT(loss(1000, "orientation"), loss(3000, "orientation"));
}

/// Numbers as whole multiples of a step come back to half a step; what is no number stays none.
TEST(Stepped, NumbersComeBackToHalfAStep)
{
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                     inf = std::numeric_limits<double>::infinity();
    const std::vector<double> values{7e6, 7e6 + 1,   7e6 + 0.3, 7e6 + 0.9, -2,  nan, inf,   1,
                                     5,   5 + 1e-12, 5,         5,         nan, nan, nan,   nan,
                                     0,   0,         0,         0,         -1,  1e9, 1e-12, 0.5};
    const Stepped stepped(values, 6, 23), least(values, 6, 23, 1e-6);
    const std::vector<double> back = stepped.values(), coarse = least.values();
    ASSERT_EQ(back.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_EQ(std::isnan(back[i]), !std::isfinite(values[i])) << i;
        if (std::isnan(back[i])) continue;
        EXPECT_LE(std::abs(back[i] - values[i]), 0.501 * stepped.steps[i / 4]);
    }
    EXPECT_NEAR(stepped.steps[0], std::ldexp(1, -23), 1e-12);
    EXPECT_EQ(coarse[9], coarse[8]) << "rounding of a constant is none of its range";
    EXPECT_NE(back[9], back[8]);
    Payload payload;
    payload.add("x", stepped, 2);
    EXPECT_EQ(payload.n_bytes(), 6 * 16 + 24 * 4);
}

/// Series have all instants that elements have; where they cannot, what that loses is told.
TEST_F(Report, SeriesSayWhatTheyLose)
{
    const auto loss = [&](double most_bytes) { return std::stod(found(page(most_bytes), "loss")); };
    EXPECT_EQ(loss(8e6), 0);
    const double some = loss(2e4), much = loss(500);
    EXPECT_GT(some, 1e-8);
    EXPECT_LT(some, 0.1);
    EXPECT_GT(much, some);
}

/// Where a law is steep, elements are divided for the series, as long as there is room; smooth ones are not.
TEST_F(Report, SeriesFollowSteepLaws)
{
    const auto n_ends = [](const std::string& page) {
        const std::string key = "\"curve_end\": [\"f8\", ";
        return std::stoul(page.substr(page.find(key) + key.size()));
    };
    EXPECT_EQ(n_ends(page(8e6)), run_.motion.mesh.ends.size());
    const Scenario ram = parse_scenario(R"toml(format = 1
[[body]]
name = "ram"
mass = 12
inertia = [1, 1, 1]
[[joint]]
name = "slide"
type = "prismatic"
between = ["world", "ram"]
at = [0, 0, 0]
axis = [1, 0, 0]
[[drive]]
type = "joint"
joint = "slide"
harmonic = { amplitude = 0.2, frequency = 1 }
[[load]]
type = "actuator"
joint = "slide"
expression = "-250*(1 + tanh(slide.displacement_rate/0.02))"
[time]
end = 1
elements = 6
)toml",
                                        "ram.toml")
                             .scenario.value();
    const Solution solution = solve(ram.model, {ram.conditions}, ram.time, ram.method, ram.options);
    const RunFile run = make_run(ram.model, solution, ram.method);
    const auto page_of = [&](double most_bytes) {
        return report_page(ReportInput{ram, run, "ram"}, nullptr, {most_bytes});
    };
    EXPECT_EQ(found(page_of(8e6), "loss"), "0");
    EXPECT_GT(n_ends(page_of(8e6)), 2 * run.motion.mesh.ends.size());
    EXPECT_EQ(n_ends(page_of(100)), run.motion.mesh.ends.size()) << "no room";
    EXPECT_GT(std::stod(found(page_of(100), "loss")), 0.01) << "and told";
}

/// In a free fall joints bear nothing but last digits, which no polynomial follows and nobody wants to see.
TEST_F(Report, SeriesOfRoundingAreNotFollowed)
{
    std::string text = "format = 1\ngravity = [0, 0, -9.81]\n";
    const auto number = [](double x) { return std::to_string(x); };
    for (int k = 0; k < 6; ++k)
        text += "[[body]]\nname = \"b" + std::to_string(k) + "\"\nmass = " + number(1.0 / (k + 1)) +
                "\ninertia = [0.01, 0.02, 0.03]\ncenter_of_mass = [0.1, 0.02, 0]\nposition = [" +
                number(0.3 * k) + ", " + number(0.1 * k * k) + ", 0]\nrotation_vector = [0.3, " +
                number(0.2 * k) + ", 1]\n";
    for (int k = 0; k < 5; ++k)
        text += "[[joint]]\ntype = \"revolute\"\nbetween = [\"b" + std::to_string(k) + "\", \"b" +
                std::to_string(k + 1) + "\"]\nat = [" + number(0.3 * k + 0.3) + ", 0, 0]\naxis = [" +
                std::to_string(k % 2) + ", 1, 0.5]\nstiffness = 1e3\ndamping = 10\n";
    text += "[time]\nend = 0.3\nelements = 6\n[method]\nfamily = \"radau\"\ndegree = 5\n";
    const Scenario fall = parse_scenario(text, "fall.toml").scenario.value();
    const Solution solution = solve(fall.model, {fall.conditions}, fall.time, fall.method, fall.options);
    const RunFile run = make_run(fall.model, solution, fall.method);
    const std::string page = report_page(ReportInput{fall, run, "fall"}, nullptr, {8e6}),
                      key = "\"curve_end\": [\"f8\", ";
    EXPECT_EQ(std::stoul(page.substr(page.find(key) + key.size())), run.motion.mesh.ends.size());
    EXPECT_EQ(found(page, "loss"), "0");
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

/// A torque is told at the joint that its body turns about, a bushing where it sits; together with the force
/// it is what the load does on the body, whatever the place.
TEST(ReportLoads, WithoutAPointArePlacedWhereTorquesAreLeast)
{
    const ScenarioResult read = parse_scenario(R"(format = 1
[[body]]
name = "wheel"
shape = { sphere = 0.1 }
mass = 1
position = [1, 0, 0]
[[body]]
name = "block"
shape = { box = [0.2, 0.1, 0.1] }
mass = 1
position = [3, 0, 0]
velocity = [0.4, 0.3, -0.2]
angular_velocity = [0.5, 1, -0.7]
[[joint]]
name = "axle"
type = "revolute"
between = ["world", "wheel"]
at = [1.5, 0, 0]
axis = [0, 0, 1]
[[load]]
name = "motor"
type = "torque"
body = "wheel"
expression = ["0", "0", "2*t"]
[[load]]
name = "rubber"
type = "bushing"
between = ["block", "world"]
at = [3.1, 0.02, 0]
stiffness = [900, 800, 700, 0.01, 0.01, 0.01]
[time]
end = 0.5
elements = 20
)",
                                               "loads.toml");
    ASSERT_TRUE(read.scenario.has_value());
    const Scenario& s = *read.scenario;
    const Solution solution = solve(s.model, {s.conditions}, s.time, s.method, s.options);
    const std::vector<LineOfAction> lines = lines_of_action(s.model, solution.motion);
    ASSERT_TRUE(lines[0].place && lines[1].place && !lines[0].points[0] && !lines[1].points[0]);
    EXPECT_LT(norm(*lines[0].place - Vector3{0.5, 0, 0}), 1e-12);
    EXPECT_LT(norm(*lines[1].place - Vector3{0.1, 0.02, 0}), 0.02);
    const State state = sample_state(solution.motion, 0.3);
    const LoadTurns turns(s.model, solution.motion);
    const std::vector<Reaction> given = load_reactions(s.model, lines, state, turns.at(state), Side::right);
    EXPECT_LT(norm(given[0].torque - Vector3{0, 0, 0.6}), 1e-12);
    EXPECT_LT(norm(given[0].force), 1e-12);
    EXPECT_GT(norm(given[1].force), 1);
    EXPECT_LT(norm(given[1].torque), 0.1 * norm(given[1].force) * 0.1);
}

/// A bumpy sheet of 2 n^2 triangles: every corner is drawn within what is said, which is about a cell.
TEST(ReportSurface, IsThinnedWithinWhatIsSaid)
{
    constexpr int n = 200;
    Surface sheet;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
            const double x = i / double(n), y = j / double(n);
            sheet.points.push_back({x, y, 0.1 * std::sin(9 * x) * std::cos(7 * y)});
            sheet.normals.push_back({0, 0, 1});
        }
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const int a = i * (n + 1) + j, b = a + n + 1;
            sheet.triangles.push_back({a, b, b + 1});
            sheet.triangles.push_back({a, b + 1, a + 1});
        }
    const Surface same = thinned(sheet, sheet.triangles.size());
    EXPECT_EQ(same.n_left_out, 0u);
    EXPECT_EQ(same.points.size(), sheet.points.size());
    const Surface thin = thinned(sheet, 5000);
    EXPECT_EQ(thin.n_left_out + thin.triangles.size(), sheet.triangles.size());
    EXPECT_LE(thin.triangles.size(), 5000u);
    EXPECT_GT(thin.triangles.size(), 2000u);
    double farthest = 0;
    for (const Vector3& p : sheet.points) {
        double nearest = 1;
        for (const Vector3& q : thin.points) nearest = std::min(nearest, norm(p - q));
        farthest = std::max(farthest, nearest);
    }
    EXPECT_LE(farthest, thin.moved);
    EXPECT_LT(thin.moved, 0.05);
    EXPECT_GT(thin.moved, 0.005);
    for (const auto& t : thin.triangles)
        for (const int corner : t) ASSERT_LT(corner, static_cast<int>(thin.points.size()));
}

/// A body of 400,000 triangles makes a page of a few MB, which says what was taken away.
TEST_F(Report, OfALargeSurfaceIsSmall)
{
    if (is_sanitized) GTEST_SKIP() << study;
    constexpr int n = 500, m = 400;
    Outline& outline = scenario_.outlines[0];
    outline = {};
    for (int i = 0; i <= m; ++i)
        for (int j = 0; j < n; ++j) {
            const double u = 3.14159265 * i / m, v = 6.2831853 * j / n,
                         r = 1 + 0.03 * std::sin(40 * u) * std::cos(31 * v);
            outline.points.push_back(
                {r * std::sin(u) * std::cos(v), r * std::sin(u) * std::sin(v), r * std::cos(u)});
        }
    for (int i = 0; i < m; ++i)
        for (int j = 0; j < n; ++j) {
            const int a = i * n + j, b = i * n + (j + 1) % n;
            outline.triangles.push_back({a, a + n, b + n});
            outline.triangles.push_back({a, b + n, b});
        }
    const std::string page = report_page({scenario_, run_, "run"});
    EXPECT_LT(page.size(), 5'000'000u);
    const std::size_t at = page.find("\"thinned\": [");
    ASSERT_NE(at, std::string::npos);
    EXPECT_NE(page.find("\"thinned\": null"), std::string::npos) << "the other body is whole";
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
}   // namespace livens::report_test
