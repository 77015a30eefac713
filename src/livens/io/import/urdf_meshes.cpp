// SPDX-License-Identifier: BSD-3-Clause
// Paths of meshes: package://, file:// and plain ones. What lies outside of the folders that the caller named
// is not looked at, wherever a stranger's file points to.
#include "livens/io/import/urdf_meshes.h"

#include <algorithm>
#include <cctype>

namespace livens::inline io_internal {

namespace {

namespace fs = std::filesystem;

/// Without links and dots; as it is where that cannot be told.
fs::path plain_path(const fs::path& path)
{
    std::error_code error;
    const fs::path plain = fs::weakly_canonical(path.empty() ? fs::path(".") : path, error);
    return error ? path.lexically_normal() : plain;
}

bool is_below(const fs::path& file, const fs::path& folder)
{
    const auto [at, end] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    return at == folder.end() || (at->empty() && std::next(at) == folder.end());
}

/// The deepest folder above both.
fs::path common(const fs::path& a, const fs::path& b)
{
    fs::path both;
    const auto [end, other] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
    for (auto step = a.begin(); step != end; ++step) both /= *step;
    return both;
}

std::string ending_of(const fs::path& file)
{
    std::string ending = file.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
    return ending;
}

}   // namespace

/// The path that is meant; packages are looked up.
bool UrdfMeshes::expand(const UrdfVisual& visual, const std::string& link, fs::path& named,
                        Losses& losses) const
{
    const std::string& text = visual.mesh;
    const std::size_t scheme_end = text.find("://");
    if (scheme_end == std::string::npos) {
        named = file_.parent_path() / text;
        return true;
    }
    const std::string scheme = text.substr(0, scheme_end), rest = text.substr(scheme_end + 3);
    if (scheme == "file") {
        named = rest;
        return true;
    }
    if (scheme != "package" && scheme != "model") {
        losses.add(losses::mesh_outside, visual.place, link);
        return false;
    }
    // Some files write package:///NAME/..
    const std::size_t begin = std::min(rest.find_first_not_of('/'), rest.size());
    const std::size_t slash = std::min(rest.find('/', begin), rest.size());
    const std::string package = rest.substr(begin, slash - begin);
    const auto found = options_.packages.find(package);
    if (found == options_.packages.end()) {
        losses.add(losses::mesh_package, visual.place, link, package);
        return false;
    }
    named = found->second / fs::path(rest.substr(std::min(slash + 1, rest.size())));
    return true;
}

bool UrdfMeshes::is_named(const fs::path& mesh) const
{
    if (is_below(mesh, plain_path(file_.parent_path()))) return true;
    return std::ranges::any_of(options_.packages,
                               [&](const auto& p) { return is_below(mesh, plain_path(p.second)); });
}

/// Whether the file is there is asked last: of files outside of the named folders nothing is to be learnt.
bool UrdfMeshes::locate(const UrdfVisual& visual, const std::string& link, fs::path& found,
                        Losses& losses) const
{
    fs::path named;
    const Vector3& scale = visual.size;
    const auto lose = [&](const LossKind& kind, const std::string& word = {}) {
        losses.add(kind, visual.place, link, word);
        return false;
    };
    if (!expand(visual, link, named, losses)) return false;
    if (!(scale[0] > 0 && scale[0] == scale[1] && scale[0] == scale[2])) return lose(losses::mesh_scale);
    const std::string ending = ending_of(named);
    if (ending != ".stl" && ending != ".obj" && ending != ".ply" && ending != ".msh" && ending != ".dae")
        return lose(losses::mesh_format, ending.empty() ? "without an ending" : ending.substr(0, 10));
    found = plain_path(named);
    if (!is_named(found)) return lose(losses::mesh_outside);
    std::error_code error;
    if (!fs::is_regular_file(found, error)) return lose(losses::mesh_missing);
    return true;
}

/// A scenario names meshes from its folder on, downwards: that is the one which the caller wants, if all lie
/// below it, else the deepest above the URDF and all of them.
void UrdfMeshes::find(const UrdfFile& file, Losses& losses)
{
    folder_ = plain_path(file_.parent_path());
    const fs::path wanted = options_.folder ? plain_path(*options_.folder) : folder_;
    bool are_below = options_.folder.has_value();
    if (options_.meshes == UrdfOptions::Meshes::none) return;
    for (const UrdfLink& link : file.links)
        for (const UrdfVisual& visual : link.visuals) {
            fs::path found;
            const std::string name = "'" + link.name + "'";
            if (visual.shape != UrdfVisual::Shape::mesh || !locate(visual, name, found, losses)) continue;
            are_below = are_below && is_below(found, wanted);
            folder_ = common(folder_, found);
            meshes_[&visual] = found;
        }
    if (are_below) folder_ = wanted;
}

void UrdfMeshes::draw(const UrdfLink& link, const Pose& pose, const std::set<int>& refused,
                      std::vector<TableMaker>& visuals) const
{
    using Shape = UrdfVisual::Shape;
    if (options_.meshes == UrdfOptions::Meshes::none) return;
    for (const UrdfVisual& visual : link.visuals) {
        const auto mesh = meshes_.find(&visual);
        if (visual.shape == Shape::mesh && (mesh == meshes_.end() || refused.contains(visual.place.line)))
            continue;
        TableMaker table(visual.place);
        const Vector3& size = visual.size;
        if (visual.shape == Shape::box) table.vector("box", size);
        if (visual.shape == Shape::sphere) table.number("sphere", size[0]);
        if (visual.shape == Shape::cylinder || visual.shape == Shape::capsule) {
            TableMaker round(visual.place);
            round.number("radius", size[0]).number("length", size[1]);
            table.table(visual.shape == Shape::capsule ? "capsule" : "cylinder", std::move(round));
        }
        if (visual.shape == Shape::mesh) {
            table.text("mesh", mesh->second.lexically_relative(folder_).generic_string()).text("unit", "m");
            if (size[0] != 1) table.number("scale", size[0]);
        }
        place_in(table, pose * visual.pose);
        if (visual.color) {
            const auto& [red, green, blue, opacity] = *visual.color;
            table.vector("color", {red, green, blue});
            if (opacity != 1) table.number("opacity", opacity);
        }
        visuals.push_back(std::move(table));
    }
}

}   // namespace livens::inline io_internal
