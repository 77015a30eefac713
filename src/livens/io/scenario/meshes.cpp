// SPDX-License-Identifier: BSD-3-Clause
#include "livens/io/scenario/meshes.h"

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
#include "livens/time/expression.h"

namespace livens {

namespace {

[[noreturn]] void refuse(const char* code, const std::string& path, const std::string& why,
                         const char* help = "")
{
    throw InputError({code, "", "the mesh '" + path + "' " + why, "", "", "", help});
}

/// The surface of a mesh about its centroid; quadrilaterals as two triangles, curved faces by their corners.
void add_picture(const Mesh& surface, ReducedMesh& to)
{
    if (surface.n_elements(2) > most_shown) return;
    std::vector<int> indices(surface.points.size(), -1);
    const auto index = [&](std::int32_t point) {
        if (indices[point] < 0) {
            indices[point] = static_cast<int>(to.points.size());
            to.points.push_back(surface.points[point] - to.whole.centroid);
        }
        return indices[point];
    };
    for (const ElementBlock& b : surface.blocks)
        for (std::int64_t e = 0; dimension(b.kind) == 2 && e < b.size(); ++e)
            for (int k = 1; k + 1 < n_corners(b.kind); ++k)
                to.triangles.push_back(
                    {index(b.element(e)[0]), index(b.element(e)[k]), index(b.element(e)[k + 1])});
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
    std::string rest() const { return std::string(text_); }

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

/// One line of what kept() writes. False if it is none: a run's file is a stranger.
bool read_line(std::string_view text, std::map<std::pair<std::string, bool>, ReducedMesh>& meshes,
               ReducedMesh*& mesh)
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
        if (!line.read(m) || !line.read(unit)) return false;
        mesh->weighted[{unit, line.rest()}] = m;
        return true;
    }
    if (word == "point") return line.read(mesh->points.emplace_back());
    std::array<int, 3> t;
    if (word != "face" || !line.read(t[0]) || !line.read(t[1]) || !line.read(t[2])) return false;
    for (const int i : t)
        if (i < 0 || i >= static_cast<int>(mesh->points.size())) return false;
    mesh->triangles.push_back(t);
    return true;
}

/// A word of its own in the text: letters, digits and _ are one.
bool has_word(std::string_view text, std::string_view word)
{
    const auto is_part = [&](std::size_t at) {
        if (at >= text.size()) return false;
        const char c = text[at];
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    };
    for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1))
        if (!(at > 0 && is_part(at - 1)) && !is_part(at + word.size())) return true;
    return false;
}

/// The density of a surface, whose inside has no points to ask at: slopes that are the same at many places,
/// of an expression without bends, are those of a linear one.
LinearDensity linear(const Expression& density, const Mesh& mesh, double unit)
{
    const auto refuse_field = [&](const std::string& why) {
        throw InputError({"density-field", "", "'" + mesh.name + "' is a surface, and its density " + why,
                          "'" + density.text() + "'", "",
                          "what a closed surface says of its inside is enough for linear densities",
                          "give a mesh with elements of volume"});
    };
    if (!density.kink_by_symbols().empty()) refuse_field("bends or jumps");
    LinearDensity found;
    std::array<double, 3> first{};
    const std::size_t n = mesh.points.size(), step = std::max<std::size_t>(1, n / 16);
    for (std::size_t k = 0; k + step < n + step; k += step) {
        const Vector3 p = unit * (0.7 * mesh.points[k] + 0.3 * mesh.points[n - 1 - k]);
        std::array<double, 3> slopes{};
        const std::array<double, 3> at{p[0], p[1], p[2]};
        const double value = density(0, at, slopes);
        if (k == 0) first = slopes;
        double size = 0, gap = 0;
        for (int i = 0; i < 3; ++i) {
            size = std::max(size, std::abs(first[i]));
            gap = std::max(gap, std::abs(slopes[i] - first[i]));
        }
        if (!(gap <= 1e-12 * size)) refuse_field("is not linear");
        if (k > 0) continue;
        for (int i = 0; i < 3; ++i) found.gradient[i] = unit * slopes[i];
        found.at_origin = value - dot({slopes[0], slopes[1], slopes[2]}, p);
    }
    return found;
}

Moments integrated(const Mesh& mesh, double unit, const std::string& text)
{
    const Expression density(text, {"x", "y", "z"});
    if (has_word(text, "t") || text.find('\n') != std::string::npos)
        throw InputError({"density-field", "", "a density does not change with time", "'" + text + "'", "",
                          "it is an expression in x, y and z, on one line", ""});
    if (!mesh.is_volume()) return scaled(weighted_moments(mesh, linear(density, mesh, unit)), unit);
    const auto value = [&](const Vector3& p) {
        const std::array<double, 3> at{unit * p[0], unit * p[1], unit * p[2]};
        return density(0, at);
    };
    return scaled(weighted_moments(mesh, value), unit);
}

bool is_inside(const std::filesystem::path& file, const std::filesystem::path& folder)
{
    const auto [at, end] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    return at == folder.end();
}

}   // namespace

ReducedMesh reduced(const Mesh& mesh)
{
    ReducedMesh r;
    r.whole = moments(mesh);
    r.surfaces = surface_moments(mesh);
    if (!mesh.is_volume()) {
        add_picture(mesh, r);
        return r;
    }
    const std::vector<Moments> of = region_moments(mesh);
    for (std::size_t k = 0; k < of.size(); ++k)
        if (of[k].volume > 0)
            r.regions.emplace_back(mesh.regions[k].names.empty() ? "" : mesh.regions[k].names.front(), of[k]);
    add_picture(boundary_of(mesh), r);
    return r;
}

MeshStore::MeshStore(MeshSource source) : source_(std::move(source))
{
    ReducedMesh* mesh = nullptr;
    for (std::string_view text = source_.kept; !text.empty();) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        if (!read_line(text.substr(0, end), kept_, mesh)) {
            kept_.clear();   // damaged: nothing of it can be trusted
            return;
        }
        text.remove_prefix(std::min(end + 1, text.size()));
    }
}

ReducedMesh& MeshStore::entry(const std::string& path, bool is_turned)
{
    const auto known = known_.find({path, is_turned});
    if (known != known_.end()) return known->second;
    const auto kept = kept_.find({path, is_turned});
    ReducedMesh mesh = kept != kept_.end() ? kept->second : reduced(read(path, is_turned));
    return known_.emplace(Key{path, is_turned}, std::move(mesh)).first->second;
}

const ReducedMesh& MeshStore::find(const std::string& path, bool is_turned) { return entry(path, is_turned); }

const Moments& MeshStore::weighted(const std::string& path, bool is_turned, double unit,
                                   const std::string& density)
{
    std::map<std::pair<double, std::string>, Moments>& weighted = entry(path, is_turned).weighted;
    const auto known = weighted.find({unit, density});
    if (known != weighted.end()) return known->second;
    return weighted.emplace(std::pair(unit, density), integrated(read(path, is_turned), unit, density))
        .first->second;
}

Mesh MeshStore::read(const std::string& path, bool is_turned) const
{
    namespace fs = std::filesystem;
    const fs::path relative(path);
    if (path.empty() || relative.is_absolute())
        refuse("mesh-path", path, "must be a path from the scenario's folder on");
    for (const fs::path& part : relative)
        if (part == "..")
            refuse("mesh-path", path, "leaves the scenario's folder", "put the mesh beside the scenario");
    if (!source_.folder) refuse("mesh-file", path, "cannot be read: this scenario stands in no folder");
    std::error_code error;
    const fs::path folder =
        fs::weakly_canonical(source_.folder->empty() ? fs::path(".") : *source_.folder, error);
    const fs::path file = error ? fs::path() : fs::weakly_canonical(folder / relative, error);
    if (error) refuse("mesh-file", path, "cannot be read: " + error.message());
    if (!is_inside(file, folder)) refuse("mesh-path", path, "leaves the scenario's folder by a link");
    Mesh mesh = read_mesh_file(file, path);
    if (is_turned) turn_outwards(mesh);
    require_sound(mesh);
    return mesh;
}

std::string MeshStore::kept() const
{
    std::string text;
    for (const auto& [key, mesh] : known_) {
        text +=
            "mesh " + std::to_string(key.second ? 1 : 0) + " " + numbers_of(mesh.whole) + key.first + "\n";
        for (const auto& [name, m] : mesh.regions) text += "region " + numbers_of(m) + name + "\n";
        for (const NamedSurface& s : mesh.surfaces) {
            text += "surface " + numbers_of(s.moments.area);
            for (const Matrix4& of : s.moments.normal) text += numbers_of(of);
            text += s.name + "\n";
        }
        for (const auto& [field, m] : mesh.weighted)
            text += "weighted " + numbers_of(m) + to_text(field.first) + " " + field.second + "\n";
        for (const Vector3& p : mesh.points) text += "point " + numbers_of(p) + "\n";
        for (const auto& t : mesh.triangles)
            text += "face " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) +
                    "\n";
    }
    return text;
}

}   // namespace livens
