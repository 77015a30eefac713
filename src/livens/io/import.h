// SPDX-License-Identifier: BSD-3-Clause
// Models out of other programs' files: they become scenarios, and what a scenario cannot say is listed.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "livens/io/diagnostic.h"
#include "livens/io/scenario.h"

namespace [[gnu::visibility("default")]] livens {

/// Two links that the file leaves apart, and how their frames are held together.
struct UrdfLoop {
    std::string first, second;   ///< names of links
    std::string type;   ///< "weld", "spherical" (common origin) or "revolute" (about the common third axis)
};

struct UrdfOptions {
    enum class Base { fixed, free };
    enum class Meshes { draw, none };
    enum class Limits { ignore, stop };
    enum class Inertias { mend, strict };

    std::map<std::string, double> at;      ///< coordinates of joints at the start, rad or m; others: 0
    std::map<std::string, double> rates;   ///< likewise, rad/s or m/s
    Base base = Base::fixed;               ///< whether the first link stands still in the world
    std::map<std::string, std::filesystem::path> packages;   ///< where `package://NAME/..` is
    Meshes meshes = Meshes::draw;
    Limits limits = Limits::stop;         ///< springs at limits of joints, or none
    Inertias inertias = Inertias::mend;   ///< strict: what belongs to no body is an error
    std::vector<UrdfLoop> loops;
    bool is_strict = false;   ///< what is lost and changes the motion is an error
    double end = 1;           ///< s; `end` of the scenario's `[time]`
    /// Where the scenario will lie. If not all its meshes are at or below it, or none is given, paths begin
    /// in the nearest folder above the file and all of them.
    std::optional<std::filesystem::path> folder;
};

struct UrdfResult : ScenarioResult {
    std::string toml;               ///< the scenario as a file; empty after an error
    std::filesystem::path folder;   ///< where paths of its meshes begin: they go with it from there
};

/// Reads a URDF strictly: each tag is taken, refused, or listed with the codes `import-lost` (not kept),
/// `import-mended` (changed so that it can be solved) or `import-merged` (kept as part of something else),
/// once for each kind, with how often and where first. `diagnostics` has all of them; those of errors stop
/// it. Throws nothing. No file is read but this one and, of meshes that are drawn, those at or below its
/// folder or in a stated package.
UrdfResult read_urdf(const std::filesystem::path& file, const UrdfOptions& options = {});
/// Likewise of a text; `file` need not exist, its folder is where paths of meshes begin.
UrdfResult parse_urdf(std::string text, const std::filesystem::path& file, const UrdfOptions& options = {});

}   // namespace gnu::visibility("default")]]livens
