// SPDX-License-Identifier: BSD-3-Clause
// Runs for other programs: one table of formats.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "livens/io/results.h"
#include "livens/io/scenario.h"

namespace [[gnu::visibility("default")]] livens {

/// What an export is made of.
struct ExportInput {
    std::filesystem::path result;   ///< the file that `run` was read from
    const Scenario& scenario;       ///< that of its text
    const Run& run;
    bool force = false;   ///< whatever stands where further files go, beside the one that is named
};

struct ExportFormat {
    const char* word;        ///< of the option: "gltf" is --gltf
    const char* extension;   ///< by which readers know the file: ".glb"
    const char* what;
    /// Whether a file that begins so is an older export, which may be replaced; see is_occupied().
    bool (*is_own)(std::string_view head);
    /// Written whole or not at all, as replace_file() does. Throws IoError.
    void (*write)(const std::filesystem::path& file, const ExportInput& input);
};

/// docs/results.md has the same table.
std::span<const ExportFormat> export_formats();

/// CSV of the samples at the output times: t, then per body position, quaternion (w, x, y, z), velocity,
/// angular velocity; then energies. Names that spreadsheets would take for formulas begin with an apostrophe.
void write_csv(const std::filesystem::path& file, const Model& model, const Run& run);

}   // namespace gnu::visibility("default")]]livens
