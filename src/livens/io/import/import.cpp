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
    // Names of a stranger's file may hold line ends: what follows one would be no comment any more.
    const auto comment = [](std::string text) {
        for (char& c : text)
            if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
        return "# " + text + "\n";
    };
    std::string text = comment("From " + file.filename().string() + ", by livens import.");
    for (const Diagnostic& d : told)
        text += comment(d.code + (d.line > 0 ? ", line " + std::to_string(d.line) : "") + ": " + d.message);
    return text;
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
