// SPDX-License-Identifier: BSD-3-Clause
// The face of importing: files, and scenarios as texts with what was lost in comments at their heads.
#include "livens/io/import.h"

#include "livens/io/import/table_maker.h"
#include "livens/io/import/urdf_scenario.h"
#include "livens/io/scenario/text/reading.h"

namespace livens {

namespace {

/// Of what was told, a comment each.
/// Messages quote the file, and control characters are not allowed in comments of TOML.
std::string head_of(const std::filesystem::path& file, const std::vector<Diagnostic>& told)
{
    std::string text = "# From " + file.filename().string() + ", by livens import.\n";
    for (const Diagnostic& d : told) {
        text += "# " + d.code;
        if (d.line > 0) text += ", line " + std::to_string(d.line);
        text += ": " + d.message + "\n";
    }
    std::string safe;
    for (const char c : text) safe += static_cast<unsigned char>(c) < 0x20 && c != '\n' ? ' ' : c;
    return safe;
}

}   // namespace

UrdfResult parse_urdf(std::string text, const std::filesystem::path& file, const UrdfOptions& options)
{
    UrdfResult result;
    ImportedTree tree = import_urdf(text, file, options, true);
    result.text = std::move(text);
    result.diagnostics = std::move(tree.diagnostics);
    result.folder = std::move(tree.folder);
    if (!tree.scenario) return result;
    result.toml = head_of(file, result.diagnostics) + toml_of(*tree.root);
    result.scenario = std::move(tree.scenario);
    result.scenario->text = result.toml;
    return result;
}

UrdfResult read_urdf(const std::filesystem::path& file, const UrdfOptions& options)
{
    Findings findings;
    UrdfResult result;
    std::string text;
    bool is_read = false;
    shield(findings, [&] { is_read = read_text(file, text, findings); });
    if (is_read) return parse_urdf(std::move(text), file, options);
    result.diagnostics = findings.take(file.string());
    return result;
}

}   // namespace livens
