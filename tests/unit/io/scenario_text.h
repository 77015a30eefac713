// SPDX-License-Identifier: BSD-3-Clause
// What the tests of scenarios share: a small valid scenario, and looking for a finding.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>

#include <vector>

#include "livens/io/scenario.h"

namespace livens::test {

/// A text that leads to a code, and where the finding points.
struct Case {
    const char* code;
    std::string text;
    std::string where;   ///< empty: the whole file
};

/// Of the family mixed and of conditions at the end; mixed_scenario_test.cpp.
std::vector<Case> cases_of_mixed();
std::vector<Case> cases_of_joint_loads();
std::vector<Case> cases_of_mechanisms();
std::vector<Case> cases_of_laws();

inline const std::string valid_scenario = R"(format = 1
gravity = [0, 0, -9.81]

[[body]]
name = "upper"
shape = { box = [1, 0.2, 0.1] }
density = 1000
position = [0.5, 0, 0]

[[body]]
name = "lower"
mass = 2
inertia = [0.2, 0.3, 0.4]
position = [1.5, 0, 0]

[[joint]]
name = "shoulder"
type = "revolute"
between = ["world", "upper"]
at = [0, 0, 0]
axis = [0, 1, 0]

[[joint]]
name = "elbow"
type = "spherical"
between = ["upper", "lower"]
at = [1, 0, 0]

[[load]]
name = "push"
type = "force"
body = "lower"
value = [0, 1, 0]

[time]
end = 1
elements = 10

[method]
degree = 4
)";

/// `text` with the first `from` replaced by `to`.
inline std::string replaced(std::string text, std::string_view from, std::string_view to)
{
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << "the test's own text lacks: " << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

inline ScenarioResult read(const std::string& text) { return parse_scenario(text, "test.toml"); }

inline const Diagnostic* find(const ScenarioResult& result, std::string_view code)
{
    const auto found = std::find_if(result.diagnostics.begin(), result.diagnostics.end(),
                                    [&](const Diagnostic& d) { return d.code == code; });
    return found == result.diagnostics.end() ? nullptr : &*found;
}

inline std::string shown(const ScenarioResult& result)
{
    return render(result.diagnostics, result.text, DiagnosticFormat::human);
}

/// Line and column of the first character of `where`.
struct Spot {
    int line = 0;
    int column = 0;
};
inline Spot spot(std::string_view text, std::string_view where)
{
    const std::size_t at = text.find(where);
    EXPECT_NE(at, std::string_view::npos) << where;
    const std::string_view before = text.substr(0, at);
    const std::size_t begin = before.rfind('\n') + 1;   // npos + 1 = 0
    return {static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1,
            static_cast<int>(before.size() - begin) + 1};
}

/// The scenario is refused with this code at the first place of `where` (a whole-file finding: where empty).
inline void expect_error(const std::string& text, std::string_view code, std::string_view where)
{
    const ScenarioResult result = read(text);
    EXPECT_FALSE(result.scenario.has_value());
    const Diagnostic* d = find(result, code);
    ASSERT_NE(d, nullptr) << "no " << code << " in\n" << shown(result);
    EXPECT_EQ(d->severity, Severity::error);
    const Spot expected = where.empty() ? Spot{} : spot(text, where);
    EXPECT_EQ(d->line, expected.line) << shown(result);
    EXPECT_EQ(d->column, expected.column) << shown(result);
}

}   // namespace livens::test
