// SPDX-License-Identifier: BSD-3-Clause
// Meshes of a scenario, each reduced to what a run needs of it: moments, surfaces and a thinned picture
// (theory.md, Bodies from meshes). The reduced form is kept in the run's file, so that a run can be read
// again without its meshes. Paths never leave the scenario's folder (docs/program.md, Untrusted files).
#include "livens/io/scenario/bodies/meshes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/geometry/soundness.h"
#include "livens/io/scenario/bodies/collada.h"
#include "livens/io/scenario/bodies/density_fields.h"
#include "livens/io/scenario/text/findings.h"

namespace livens::inline io_internal {

namespace {

[[noreturn]] void refuse(const std::string& code, const std::string& path, const std::string& why,
                         const std::string& help = "")
{
    const std::string what = code.substr(0, code.find('-'));
    throw InputError({code, "", "the " + (what == "include" ? "file" : what) + " '" + path + "' " + why, "",
                      "", "", help});
}

/// The surface of a mesh about a point; quadrilaterals as two triangles, curved faces by their corners.
Surface picture_of(const Mesh& surface, const Vector3& about)
{
    Surface picture;
    std::vector<int> indices(surface.points.size(), -1);
    const auto index = [&](std::int32_t point) {
        if (indices[point] < 0) {
            indices[point] = static_cast<int>(picture.points.size());
            picture.points.push_back(surface.points[point] - about);
        }
        return indices[point];
    };
    for (const ElementBlock& b : surface.blocks)
        for (std::int64_t e = 0; dimension(b.kind) == 2 && e < b.size(); ++e)
            for (int k = 1; k + 1 < n_corners(b.kind); ++k)
                picture.triangles.push_back(
                    {index(b.element(e)[0]), index(b.element(e)[k]), index(b.element(e)[k + 1])});
    return thinned(std::move(picture), most_shown);
}

/// One line of numbers, then what is left.
class Line {
public:
    explicit Line(std::string_view text) : text_(text) {}

    template <class Number>
    bool read(Number& x)
    {
        const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), x);
        if (error != std::errc{}) return false;
        text_.remove_prefix(end - text_.data());
        if (text_.starts_with(' ')) text_.remove_prefix(1);
        return true;
    }
    bool read(Vector3& v) { return read(v[0]) && read(v[1]) && read(v[2]) && std::isfinite(norm(v)); }
    bool read(Moments& m)
    {
        Vector3 diagonal, off;
        if (!(read(m.volume) && std::isfinite(m.volume) && read(m.centroid) && read(diagonal) && read(off)))
            return false;
        for (int i = 0; i < 3; ++i) {
            // Six numbers of a symmetric matrix: the diagonal, then (1,2), (2,3), (3,1).
            m.second(i, i) = diagonal[i];
            m.second(i, (i + 1) % 3) = m.second((i + 1) % 3, i) = off[i];
        }
        return true;
    }
    template <int R, int C>
    bool read_all(Matrix<R, C>& m)
    {
        for (double& x : m.a)
            if (!read(x) || !std::isfinite(x)) return false;
        return true;
    }
    /// A name, as in_line() wrote it.
    std::string rest() const { return out_of_line(text_); }

private:
    std::string_view text_;
};

template <int R, int C>
std::string numbers_of(const Matrix<R, C>& m)
{
    std::string text;
    for (const double x : m.a) text += to_text(x) + " ";
    return text;
}

std::string numbers_of(const Moments& m)
{
    const Matrix3& E = m.second;
    return to_text(m.volume) + " " + numbers_of(m.centroid) + numbers_of(Vector3{E(0, 0), E(1, 1), E(2, 2)}) +
           numbers_of(Vector3{E(0, 1), E(1, 2), E(2, 0)});
}

std::string lines_of(const Surface& picture)
{
    std::string text;
    if (picture.n_left_out > 0)
        text = "thinned " + std::to_string(picture.n_left_out) + " " + to_text(picture.moved) + "\n";
    for (const Vector3& p : picture.points) text += "point " + numbers_of(p) + "\n";
    for (const auto& t : picture.triangles)
        text +=
            "face " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
    return text;
}

/// One line of what kept() writes. False if it is none: a run's file is a stranger.
bool read_line(std::string_view text, std::map<std::pair<std::string, bool>, ReducedMesh>& meshes,
               std::map<std::string, ReducedMesh>& seen, ReducedMesh*& mesh)
{
    const std::string_view word = text.substr(0, text.find(' '));
    Line line(text.substr(std::min(text.size(), word.size() + 1)));
    if (word == "mesh") {
        int is_turned = 0;
        Moments whole;
        if (!line.read(is_turned) || !line.read(whole)) return false;
        mesh = &meshes[{line.rest(), is_turned != 0}];
        mesh->whole = whole;
        return true;
    }
    if (word == "picture") {
        mesh = &seen[line.rest()];
        return true;
    }
    if (mesh == nullptr) return false;
    if (word == "region") {
        Moments m;
        if (!line.read(m)) return false;
        mesh->regions.emplace_back(line.rest(), m);
        return true;
    }
    if (word == "surface") {
        SurfaceMoments m;
        if (!line.read_all(m.area)) return false;
        for (Matrix4& of : m.normal)
            if (!line.read_all(of)) return false;
        mesh->surfaces.push_back({line.rest(), m});
        return true;
    }
    if (word == "weighted") {
        Moments m;
        double unit = 0;
        if (!line.read(m) || !line.read(unit) || !std::isfinite(unit)) return false;
        mesh->weighted[{unit, line.rest()}] = m;
        return true;
    }
    Surface& picture = mesh->picture;
    if (word == "thinned")
        return line.read(picture.n_left_out) && line.read(picture.moved) &&
               picture.n_left_out <= max_mesh_bytes && picture.moved >= 0 && std::isfinite(picture.moved);
    if (word == "point") return line.read(picture.points.emplace_back());
    std::array<int, 3> t;
    if (word != "face" || !line.read(t[0]) || !line.read(t[1]) || !line.read(t[2])) return false;
    // Indices of a stranger's file are checked before the picture is drawn with them.
    for (const int i : t)
        if (i < 0 || i >= static_cast<int>(picture.points.size())) return false;
    picture.triangles.push_back(t);
    return true;
}

bool is_inside(const std::filesystem::path& file, const std::filesystem::path& folder)
{
    const auto [at, end] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    return at == folder.end();
}

}   // namespace

/// Names and densities end their lines, and may have breaks of lines in them.
std::string in_line(const std::string& text)
{
    std::string line;
    for (const char c : text) line += c == '\n' ? "\\n" : c == '\\' ? "\\\\" : std::string(1, c);
    return line + "\n";
}

std::string out_of_line(std::string_view line)
{
    std::string text;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char next = line[i] == '\\' && i + 1 < line.size() ? line[i + 1] : ' ';
        const bool is_escaped = next == 'n' || next == '\\';
        text += !is_escaped ? line[i] : next == 'n' ? '\n' : '\\';
        i += is_escaped ? 1 : 0;
    }
    return text;
}

ReducedMesh reduced(const Mesh& mesh)
{
    ReducedMesh r;
    r.whole = moments(mesh);
    r.surfaces = surface_moments(mesh);
    if (!mesh.is_volume()) {
        r.picture = picture_of(mesh, r.whole.centroid);
        return r;
    }
    const std::vector<Moments> of = region_moments(mesh);
    for (std::size_t k = 0; k < of.size(); ++k)
        // Regions without elements of volume, such as named surfaces, have no mass.
        if (of[k].volume > 0)
            r.regions.emplace_back(mesh.regions[k].names.empty() ? "" : mesh.regions[k].names.front(), of[k]);
    // A picture needs the outside only, about the centroid, where bodies are drawn.
    r.picture = picture_of(boundary_of(mesh), r.whole.centroid);
    return r;
}

MeshStore::MeshStore(MeshSource source) : source_(std::move(source))
{
    ReducedMesh* mesh = nullptr;
    for (std::string_view text = source_.kept; !text.empty();) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const bool is_of_include = text.starts_with("include ") || text.starts_with("content ");
        if (!is_of_include && !read_line(text.substr(0, end), kept_, kept_seen_, mesh)) {
            kept_.clear();   // damaged: nothing of it can be trusted
            kept_seen_.clear();
            return;
        }
        text.remove_prefix(std::min(end + 1, text.size()));
    }
}

ReducedMesh& MeshStore::entry(const std::string& own_path, bool is_turned)
{
    const std::string path = folder_ + own_path;
    const auto known = known_.find({path, is_turned});
    if (known != known_.end()) return known->second;
    // What the run has kept wins over the file, which may have changed since.
    const auto kept = kept_.find({path, is_turned});
    ReducedMesh mesh = kept != kept_.end() ? kept->second : reduced(read(path, is_turned));
    return known_.emplace(Key{path, is_turned}, std::move(mesh)).first->second;
}

const ReducedMesh& MeshStore::find(const std::string& path, bool is_turned) { return entry(path, is_turned); }

/// Kept by the unit and the text of the density, as a run has no points to integrate over.
const Moments& MeshStore::weighted(const std::string& path, bool is_turned, double unit,
                                   const std::string& density)
{
    std::map<std::pair<double, std::string>, Moments>& weighted = entry(path, is_turned).weighted;
    const auto known = weighted.find({unit, density});
    if (known != weighted.end()) return known->second;
    return weighted
        .emplace(std::pair(unit, density), weighted_by_field(read(folder_ + path, is_turned), unit, density))
        .first->second;
}

const Surface& MeshStore::picture(const std::string& own_path)
{
    const std::string path = folder_ + own_path;
    const auto known = seen_.find(path);
    if (known != seen_.end()) return known->second.picture;
    ReducedMesh seen;
    if (const auto kept = kept_seen_.find(path); kept != kept_seen_.end()) {
        seen = kept->second;
    } else {
        const Mesh mesh = open(path);
        seen.picture = picture_of(mesh.is_volume() ? boundary_of(mesh) : mesh, {});
        if (seen.picture.triangles.empty()) refuse("mesh-file", path, "has no faces to show");
    }
    return seen_.emplace(path, std::move(seen)).first->second.picture;
}

Mesh MeshStore::read(const std::string& path, bool is_turned)
{
    Mesh mesh = open(path);
    if (is_turned) turn_outwards(mesh);
    require_sound(mesh);
    return mesh;
}

std::filesystem::path find_file(const MeshSource& source, const std::string& path, const std::string& what)
{
    namespace fs = std::filesystem;
    const std::string wrong_path = what + "-path", wrong_file = what + "-file";
    const fs::path relative(path);
    if (path.empty() || relative.is_absolute())
        refuse(wrong_path, path, "must be a path from the scenario's folder on");
    if (const std::string culprit = first_invisible(path); !culprit.empty())
        refuse(wrong_path, path, "must not contain " + culprit, "give the file a name without it");
    for (const fs::path& part : relative)
        // Refused by its letters, before anything is asked of the file system.
        if (part == "..")
            refuse(wrong_path, path, "leaves the scenario's folder",
                   what == "mesh" ? "put the mesh beside the scenario" : "put it beside the scenario");
    if (!source.folder) refuse(wrong_file, path, "cannot be read: this scenario has no folder");
    std::error_code error;
    const fs::path folder =
        fs::weakly_canonical(source.folder->empty() ? fs::path(".") : *source.folder, error);
    // Links are followed before the comparison; a link inside of the folder may point out of it.
    const fs::path file = error ? fs::path() : fs::weakly_canonical(folder / relative, error);
    if (error) refuse(wrong_file, path, "cannot be read: " + error.message());
    if (!is_inside(file, folder)) refuse(wrong_path, path, "leaves the scenario's folder by a link");
    return file;
}

Mesh MeshStore::open(const std::string& path)
{
    const auto named = source_.named.find(path);
    const std::filesystem::path file =
        named != source_.named.end() ? named->second : find_file(source_, path, "mesh");
    files_.push_back(file);
    if (is_collada(path)) return read_collada(read_mesh_bytes(file, path).text(), path);
    return read_mesh_file(file, path);
}

/// A line for each thing, which begins with what it is: numbers, then a name, which may have blanks.
/// Lines behind `mesh` or `picture` belong to that one. read_line() reads them again.
std::string MeshStore::kept() const
{
    std::string text;
    for (const auto& [key, mesh] : known_) {
        text +=
            "mesh " + std::to_string(key.second ? 1 : 0) + " " + numbers_of(mesh.whole) + in_line(key.first);
        for (const auto& [name, m] : mesh.regions) text += "region " + numbers_of(m) + in_line(name);
        for (const NamedSurface& s : mesh.surfaces) {
            text += "surface " + numbers_of(s.moments.area);
            for (const Matrix4& of : s.moments.normal) text += numbers_of(of);
            text += in_line(s.name);
        }
        for (const auto& [field, m] : mesh.weighted)
            text += "weighted " + numbers_of(m) + to_text(field.first) + " " + in_line(field.second);
        text += lines_of(mesh.picture);
    }
    for (const auto& [path, mesh] : seen_) text += "picture " + in_line(path) + lines_of(mesh.picture);
    return text;
}

}   // namespace livens::inline io_internal
