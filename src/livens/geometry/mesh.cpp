// SPDX-License-Identifier: BSD-3-Clause
// Meshes as files state them: points, blocks of elements and named regions, without any claim that they are
// sound. The ending of the name chooses the reader, since contents of STL and PLY may look alike at first.
#include "livens/geometry/mesh.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <memory>
#include <new>

#include "livens/base/error.h"
#include "livens/geometry/detail/cursor.h"
#include "livens/geometry/detail/workers.h"

namespace livens {

namespace {

struct KindInfo {
    int n_nodes, n_corners, dimension;
    const char* name;
};
constexpr KindInfo kinds[] = {{3, 3, 2, "triangle"},        {4, 4, 2, "quadrilateral"},
                              {6, 3, 2, "curved triangle"}, {4, 4, 3, "tetrahedron"},
                              {8, 8, 3, "hexahedron"},      {10, 4, 3, "curved tetrahedron"}};

const KindInfo& info(ElementKind kind) { return kinds[static_cast<int>(kind)]; }

std::string ending_of(const std::string& name)
{
    const std::size_t dot = name.rfind('.');
    std::string ending = dot == std::string::npos ? "" : name.substr(dot);
    for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return ending;
}

[[noreturn]] void refuse_file(const std::string& name, const std::string& why)
{
    throw InputError({"mesh-file", "", "the mesh '" + name + "' " + why, "", "", "", ""});
}

}   // namespace

int n_nodes(ElementKind kind) { return info(kind).n_nodes; }
int n_corners(ElementKind kind) { return info(kind).n_corners; }
int dimension(ElementKind kind) { return info(kind).dimension; }
const char* name_of(ElementKind kind) { return info(kind).name; }

const ElementBlock* Mesh::block(ElementKind kind) const
{
    const auto found = std::ranges::find(blocks, kind, &ElementBlock::kind);
    return found == blocks.end() ? nullptr : &*found;
}

bool Mesh::is_volume() const { return n_elements(3) > 0; }

std::int64_t Mesh::n_elements(int of_dimension) const
{
    std::int64_t n = 0;
    for (const ElementBlock& b : blocks)
        if (dimension(b.kind) == of_dimension) n += b.size();
    return n;
}

ElementBlock& MeshBuilder::block(ElementKind kind)
{
    // Elements of one kind share a block: loops over a block need no look at the kind of each element.
    for (ElementBlock& b : mesh_.blocks)
        if (b.kind == kind) return b;
    mesh_.blocks.push_back({kind, {}, {}});
    return mesh_.blocks.back();
}

void MeshBuilder::add(ElementKind kind, const std::int32_t* nodes, std::int32_t region)
{
    ElementBlock& b = block(kind);
    b.nodes.insert(b.nodes.end(), nodes, nodes + n_nodes(kind));
    b.regions.push_back(region);
}

std::int32_t MeshBuilder::region(int dimension, const std::string& name)
{
    return region(dimension, name.empty() ? std::vector<std::string>{} : std::vector{name});
}

std::int32_t MeshBuilder::region(int dimension, const std::vector<std::string>& names)
{
    const auto next = static_cast<std::int32_t>(mesh_.regions.size());
    const auto [known, is_new] = regions_.try_emplace({dimension, names}, next);
    if (is_new) mesh_.regions.push_back({dimension, names});
    return known->second;
}

void MeshBuilder::add_polygon(const std::vector<std::int32_t>& corners, std::int32_t region,
                              const Cursor& cursor)
{
    const std::vector<Vector3>& p = mesh_.points;
    if (corners.size() > 3) {
        Vector3 area{};
        double size = 0;
        for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
            const Vector3 a = p[corners[i]] - p[corners[0]], b = p[corners[i + 1]] - p[corners[0]];
            // The sum of the cross products of a fan is twice the vector area, whose direction is the mean
            // normal.
            area += cross(a, b);
            size = std::max({size, norm(a), norm(b)});
        }
        for (const std::int32_t corner : corners)
            // Inequality: distance of a corner from the mean plane <= 1e-6 of the polygon's size. Beyond, the
            // choice of triangles would change the solid.
            if (std::abs(dot(area, p[corner] - p[corners[0]])) > 1e-6 * size * norm(area))
                cursor.fail("a face with " + std::to_string(corners.size()) +
                            " corners is not flat; divide it into triangles");
    }
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        const std::int32_t triangle[] = {corners[0], corners[i], corners[i + 1]};
        add(ElementKind::triangle, triangle, region);
    }
}

Mesh read_mesh(std::string_view bytes, const std::string& name)
{
    Mesh mesh;
    mesh.name = name;
    const std::string ending = ending_of(name);
    if (bytes.empty()) refuse_file(name, "is empty");
    if (ending == ".stl")
        read_stl(bytes, mesh);
    else if (ending == ".obj")
        read_obj(bytes, mesh);
    else if (ending == ".ply")
        read_ply(bytes, mesh);
    else if (ending == ".msh")
        read_msh(bytes, mesh);
    else
        refuse_file(name, "ends in none of .stl, .obj, .ply, .msh, which say what it is");
    if (mesh.n_elements(2) + mesh.n_elements(3) == 0)
        throw InputError({"mesh-format", "", name + ": the file has no faces and no elements of volume", "",
                          "", "", "export the solid as triangles, or as elements of volume"});
    return mesh;
}

MeshBytes read_mesh_bytes(const std::filesystem::path& file, const std::string& name)
{
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) refuse_file(name, "does not exist");
    if (!std::filesystem::is_regular_file(status)) refuse_file(name, "is no file");
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error) refuse_file(name, "cannot be read");
    if (size > max_mesh_bytes)
        refuse_file(name,
                    "has " + std::to_string(size) + " bytes, more than " + std::to_string(max_mesh_bytes));
    MeshBytes bytes{std::make_unique_for_overwrite<char[]>(size), size};
    prefer_large_pages(bytes.begin.get(), size);
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    // Without memory for the buffer of a stream opening fails as well; that is no fault of the file.
    if (!stream.is_open() && errno == ENOMEM) throw std::bad_alloc();   // of the stream's own
    stream.read(bytes.begin.get(), static_cast<std::streamsize>(size));
    if (!stream) refuse_file(name, "cannot be read");
    return bytes;
}

Mesh read_mesh_file(const std::filesystem::path& file, std::string name)
{
    if (name.empty()) name = file.string();
    return read_mesh(read_mesh_bytes(file, name).text(), name);
}

}   // namespace livens
