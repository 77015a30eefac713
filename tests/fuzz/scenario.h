// SPDX-License-Identifier: BSD-3-Clause
// What must hold for any text: it ends in a scenario or in an error, never in both or neither, and every
// finding can be printed.
#pragma once

#include <algorithm>
#include <string>

#include "livens/io/scenario.h"

namespace livens::test {

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
        if (explain(d.code).empty() || d.code == "internal") return false;
    return result.scenario.has_value() != has_error && result.text == text && is_printed;
}

}   // namespace livens::test
