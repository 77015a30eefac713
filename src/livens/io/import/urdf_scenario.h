// SPDX-License-Identifier: BSD-3-Clause
// A URDF as the tree of a scenario, whose places are lines of the URDF.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "livens/io/import.h"
#include "livens/io/scenario/text/document.h"

namespace livens::inline io_internal {

/// A tree and what was told on the way to it.
struct ImportedTree {
    std::optional<Node> root;              ///< empty after an error
    std::optional<Scenario> scenario;      ///< that was read of it, where it has a time
    std::vector<Diagnostic> diagnostics;   ///< up to 20
    std::filesystem::path folder;          ///< where its meshes begin
};

/// Of a text; nothing is thrown. The tree has been read as a scenario, so that what that complains of is told
/// with lines of the URDF. `with_time`: it gets a table `[time]`, as files need it.
ImportedTree import_urdf(std::string_view text, const std::filesystem::path& file, const UrdfOptions& options,
                         bool with_time);

}   // namespace livens::inline io_internal
