// SPDX-License-Identifier: BSD-3-Clause
// What must hold for any text: it ends in a scenario or in an error, never in both or neither, every finding
// can be printed, and syntax errors have a place.
#pragma once

#include <algorithm>
#include <string>

#include "livens/io/scenario.h"

namespace livens::test {

/// What is found by whoever looks at the text alone.
inline bool is_syntax(std::string_view code)
{
    return code == "toml-syntax" || code == "not-text" || code == "too-deep" || code == "empty-file" ||
           code == "duplicate-key" || code == "number-overflow";
}

inline bool is_answered(const std::string& text)
{
    const ScenarioResult result = parse_scenario(text, "fuzz.toml");
    const bool has_error = std::any_of(result.diagnostics.begin(), result.diagnostics.end(),
                                       [](const Diagnostic& d) { return d.severity == Severity::error; });
    bool is_printed = true;
    for (const DiagnosticFormat format :
         {DiagnosticFormat::human, DiagnosticFormat::json, DiagnosticFormat::gnu})
        if (!result.diagnostics.empty() && render(result.diagnostics, result.text, format).empty())
            is_printed = false;
    for (const Diagnostic& d : result.diagnostics)
        if (explain(d.code).empty() || d.code == "internal" || (is_syntax(d.code) && d.line < 1))
            return false;
    return result.scenario.has_value() != has_error && result.text == text && is_printed;
}

}   // namespace livens::test
