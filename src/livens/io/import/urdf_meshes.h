// SPDX-License-Identifier: BSD-3-Clause
// What of a URDF's visuals can be drawn, and by which names a scenario finds the meshes.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "livens/io/import.h"
#include "livens/io/import/losses.h"
#include "livens/io/import/table_maker.h"
#include "livens/io/import/urdf_file.h"

namespace livens::inline io_internal {

/// The folder that scenario's meshes are named from, and those that it names.
class UrdfMeshes {
public:
    /// `file` is the URDF.
    UrdfMeshes(const std::filesystem::path& file, const UrdfOptions& options) : file_(file), options_(options)
    {}

    /// Finds the meshes of all links; those that cannot be drawn are told. None is opened.
    void find(const UrdfFile& file, Losses& losses);
    const std::filesystem::path& folder() const { return folder_; }

    /// Visuals of a link whose frame stands so in the body's; none of the lines in `refused`.
    void draw(const UrdfLink& link, const Pose& pose, const std::set<int>& refused,
              std::vector<TableMaker>& visuals) const;

private:
    bool locate(const UrdfVisual& visual, const std::string& link, std::filesystem::path& found,
                Losses& losses) const;
    bool expand(const UrdfVisual& visual, const std::string& link, std::filesystem::path& named,
                Losses& losses) const;
    bool is_named(const std::filesystem::path& mesh) const;

    const std::filesystem::path& file_;
    const UrdfOptions& options_;
    std::filesystem::path folder_;
    std::map<const UrdfVisual*, std::filesystem::path> meshes_;   ///< those that are drawn
};

}   // namespace livens::inline io_internal
