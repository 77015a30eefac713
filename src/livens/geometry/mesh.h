// SPDX-License-Identifier: BSD-3-Clause
// Meshes of solids, as files state them: points, elements and the names of regions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "livens/base/linear.h"

namespace [[gnu::visibility("default")]] livens {

/// Faces, then solids. Nodes in Gmsh's order: corners first, then middles of edges.
enum class ElementKind : std::uint8_t {
    triangle,
    quadrilateral,
    triangle6,
    tetrahedron,
    hexahedron,
    tetrahedron10
};
int n_nodes(ElementKind kind);
int n_corners(ElementKind kind);
int dimension(ElementKind kind);   ///< 2 or 3
const char* name_of(ElementKind kind);

/// All elements of one kind, in the order of the file.
struct ElementBlock {
    ElementKind kind = ElementKind::triangle;
    std::vector<std::int32_t> nodes;     ///< n_nodes(kind) of each element: indices of points
    std::vector<std::int32_t> regions;   ///< of each element: index of a region

    std::int64_t size() const { return static_cast<std::int64_t>(regions.size()); }
    const std::int32_t* element(std::int64_t e) const { return nodes.data() + e * n_nodes(kind); }
};

/// What a file calls a part of the mesh: a physical group (MSH), a solid (STL), a group or an object (OBJ).
struct Region {
    int dimension = 2;
    std::vector<std::string> names;   ///< none, or several
};

struct Mesh {
    std::string name;                   ///< of the file, for messages
    std::string format;                 ///< "STL, binary"
    std::vector<Vector3> points;        ///< in the file's unit; elements need not use all of them
    std::vector<ElementBlock> blocks;   ///< at most one of a kind
    std::vector<Region> regions;

    const ElementBlock* block(ElementKind kind) const;
    /// It has elements of volume; else it is the surface of a solid.
    bool is_volume() const;
    std::int64_t n_elements(int of_dimension) const;
};

/// Longest file that is read, bytes.
inline constexpr std::uintmax_t max_mesh_bytes = std::uintmax_t{1} << 30;

/// Reads STL (ASCII, binary), OBJ, PLY (ASCII, binary in both orders of bytes), Gmsh's MSH 2.2 and 4.1
/// (ASCII, binary); the ending of `name` says which. Counts are held against the bytes that are there before
/// anything is allocated, indices before they are stored. Equal corners of STL become one point, indices of
/// the other formats stay as they are; polygons of OBJ and PLY become triangles.
///
/// throws   InputError (`mesh-format`) with line or byte
Mesh read_mesh(std::string_view bytes, const std::string& name);
/// A file, which is as long as it may be.
struct MeshBytes {
    std::unique_ptr<char[]> begin;
    std::size_t size = 0;

    std::string_view text() const { return {begin.get(), size}; }
};
/// `name`: what messages call the file. Throws InputError `mesh-file` for what cannot be read or is larger
/// than max_mesh_bytes.
MeshBytes read_mesh_bytes(const std::filesystem::path& file, const std::string& name);
/// Both. `name`: with the same ending; empty: its path.
Mesh read_mesh_file(const std::filesystem::path& file, std::string name = {});

}   // namespace gnu::visibility("default")]]livens
