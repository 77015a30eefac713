// SPDX-License-Identifier: BSD-3-Clause
// The meshes that a scenario names: each is read, checked and integrated once.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "livens/geometry/moments.h"
#include "livens/io/scenario.h"
#include "livens/io/surface.h"

namespace livens::inline io_internal {

/// What a scenario takes of a mesh, in the mesh's unit. Bodies need no more, so that a run can do without the
/// file.
struct ReducedMesh {
    Moments whole;
    std::vector<std::pair<std::string, Moments>> regions;   ///< of volume, by name
    std::vector<NamedSurface> surfaces;                     ///< the whole first, if it is known
    /// Weighted by densities that are fields, in m and kg, by the unit and the text that stated them.
    std::map<std::pair<double, std::string>, Moments> weighted;
    Surface picture;   ///< about the centroid, without normals, thinned to most_shown triangles
};
inline constexpr std::size_t most_shown = 10'000;

/// What is left of a sound mesh.
ReducedMesh reduced(const Mesh& mesh);

/// A text as one line, and back.
std::string in_line(const std::string& text);
std::string out_of_line(std::string_view text);
/// The file of a path from the scenario's folder on. `what`: "mesh", which begins the codes that are thrown:
/// `mesh-path`, `mesh-file`.
std::filesystem::path find_file(const MeshSource& source, const std::string& path, const std::string& what);

class MeshStore {
public:
    explicit MeshStore(MeshSource source);

    /// Paths are those of a file in this folder from now on: "" or "parts/".
    void enter(const std::string& folder) { folder_ = folder; }

    /// Of a path as the scenario has it; with `is_turned` what faces inwards is turned. Throws InputError:
    /// `mesh-path`, `mesh-file`, and what the mesh is refused for.
    const ReducedMesh& find(const std::string& path, bool is_turned);

    /// Weighted by a density in kg/m^3 at the place x, y, z in m; of the mesh's numbers one is so many m.
    /// Also throws what Expression does, and `density-field`.
    const Moments& weighted(const std::string& path, bool is_turned, double unit, const std::string& density);

    /// Triangles of a mesh that is looked at alone, in its own coordinates: it need not be closed or sound.
    /// Throws InputError: `mesh-path`, `mesh-file`.
    const Surface& picture(const std::string& path);

    /// All that was asked for, as MeshSource::kept.
    std::string kept() const;
    /// That were read.
    const std::vector<std::filesystem::path>& files() const { return files_; }

private:
    using Key = std::pair<std::string, bool>;
    Mesh open(const std::string& path);
    Mesh read(const std::string& path, bool is_turned);
    ReducedMesh& entry(const std::string& path, bool is_turned);

    MeshSource source_;
    std::string folder_;
    std::map<Key, ReducedMesh> known_;
    std::map<Key, ReducedMesh> kept_;   ///< of a run
    // Likewise, of those that are looked at alone: their pictures.
    std::map<std::string, ReducedMesh> seen_, kept_seen_;
    std::vector<std::filesystem::path> files_;
};

}   // namespace livens::inline io_internal
