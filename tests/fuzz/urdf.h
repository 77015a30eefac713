// SPDX-License-Identifier: BSD-3-Clause
// What must hold for any text that is read as a URDF: it ends in a scenario or in an error, every finding has
// a page and can be printed, and the scenario's text reads back.
#pragma once

#include <algorithm>
#include <string>

#include "livens/io/import.h"

namespace livens::test {

inline bool is_answered_as_urdf(const std::string& text)
{
    UrdfOptions options;
    options.meshes = UrdfOptions::Meshes::none;
    options.base = text.size() % 2 == 0 ? UrdfOptions::Base::fixed : UrdfOptions::Base::free;
    const UrdfResult result = parse_urdf(text, "fuzz.urdf", options);
    const bool has_error = std::ranges::any_of(
        result.diagnostics, [](const Diagnostic& d) { return d.severity == Severity::error; });
    for (const Diagnostic& d : result.diagnostics)
        if (explain(d.code).empty() || d.code == "internal") return false;
    for (const DiagnosticFormat format :
         {DiagnosticFormat::human, DiagnosticFormat::json, DiagnosticFormat::gnu})
        if (!result.diagnostics.empty() && render(result.diagnostics, result.text, format).empty())
            return false;
    if (result.scenario.has_value() == has_error || result.text != text) return false;
    return has_error || parse_scenario(result.toml, "fuzz.toml").scenario.has_value();
}

}   // namespace livens::test
