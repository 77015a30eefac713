// SPDX-License-Identifier: BSD-3-Clause
// STL: triangles without indices. Equal corners, to the bit but for the sign of zero, become one point.
#include <array>
#include <cmath>

#include "livens/geometry/detail/cursor.h"

namespace livens {

namespace {

constexpr std::size_t header_bytes = 84, triangle_bytes = 50;

/// Points by their coordinates: a table with open addressing, at most half full.
class Welder {
public:
    Welder(std::vector<Vector3>& points, std::size_t n_corners) : points_(points)
    {
        // A closed surface of triangles has half as many points as faces.
        slots_.assign(std::bit_ceil(n_corners / 2 + 16), -1);
        points_.reserve(n_corners / 6 + 16);
    }

    std::int32_t index(Vector3 p)
    {
        for (int i = 0; i < 3; ++i) p[i] += 0.0;   // -0 is 0
        if (2 * points_.size() >= slots_.size()) grow();
        std::int32_t& slot = find(p);
        if (slot < 0) {
            slot = static_cast<std::int32_t>(points_.size());
            points_.push_back(p);
        }
        return slot;
    }

private:
    static std::uint64_t hash(const Vector3& p)
    {
        std::uint64_t h = 0;
        for (int i = 0; i < 3; ++i)
            h = (h ^ std::bit_cast<std::uint64_t>(p[i])) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
        return h ^ (h >> 32);
    }
    std::int32_t& find(const Vector3& p)
    {
        const std::size_t mask = slots_.size() - 1;
        std::size_t at = hash(p) & mask;
        while (slots_[at] >= 0 && !(points_[slots_[at]] == p)) at = (at + 1) & mask;
        return slots_[at];
    }
    void grow()
    {
        slots_.assign(2 * slots_.size(), -1);
        for (std::size_t i = 0; i < points_.size(); ++i) find(points_[i]) = static_cast<std::int32_t>(i);
    }

    std::vector<Vector3>& points_;
    std::vector<std::int32_t> slots_;
};

void read_binary(Cursor& cursor, std::uint32_t n, Mesh& mesh)
{
    constexpr bool swap = std::endian::native != std::endian::little;
    mesh.format = "STL, binary";
    MeshBuilder builder(mesh);
    builder.region(2, "");
    ElementBlock& block = builder.block(ElementKind::triangle);
    block.nodes.resize(3 * std::size_t{n});
    block.regions.assign(n, 0);
    Welder welder(mesh.points, 3 * std::size_t{n});
    for (std::uint32_t f = 0; f < n; ++f) {
        cursor.raw_bytes(12);   // the normal: what counts is the order of the corners
        for (int k = 0; k < 3; ++k) {
            Vector3 p;
            for (int i = 0; i < 3; ++i) {
                p[i] = cursor.raw<float>(swap);
                if (!std::isfinite(p[i]))
                    cursor.fail("a coordinate of triangle " + std::to_string(f + 1) + " is not finite");
            }
            block.nodes[3 * std::size_t{f} + k] = welder.index(p);
        }
        cursor.raw_bytes(2);
    }
}

void read_text(Cursor& cursor, std::size_t n_bytes, Mesh& mesh)
{
    mesh.format = "STL, ASCII";
    MeshBuilder builder(mesh);
    Welder welder(mesh.points, n_bytes / 80);
    while (!cursor.is_at_end()) {
        cursor.expect("solid");
        const std::int32_t region = builder.region(2, std::string(cursor.line()));
        while (true) {
            const std::string_view word = cursor.word();
            if (word == "endsolid") break;
            if (word != "facet") cursor.fail("'facet' or 'endsolid' is expected");
            cursor.expect("normal");
            for (int i = 0; i < 3; ++i) cursor.word();   // some write nan for that of a needle
            cursor.expect("outer");
            cursor.expect("loop");
            std::array<std::int32_t, 3> corners;
            for (std::int32_t& corner : corners) {
                cursor.expect("vertex");
                Vector3 p;
                for (int i = 0; i < 3; ++i) p[i] = cursor.number("a coordinate");
                corner = welder.index(p);
            }
            cursor.expect("endloop");
            cursor.expect("endfacet");
            builder.add(ElementKind::triangle, corners.data(), region);
        }
        cursor.line();   // the name again
    }
}

}   // namespace

void read_stl(std::string_view bytes, Mesh& mesh)
{
    Cursor cursor(bytes, mesh.name);
    // Headers of binary files may begin with "solid", too: the size decides.
    if (bytes.size() >= header_bytes) {
        Cursor binary(bytes, mesh.name);
        binary.go_binary();
        binary.raw_bytes(header_bytes - 4);
        const auto n = binary.raw<std::uint32_t>(std::endian::native != std::endian::little);
        if (bytes.size() == header_bytes + triangle_bytes * std::size_t{n})
            return read_binary(binary, n, mesh);
        if (!bytes.starts_with("solid"))
            binary.fail("a binary STL of " + std::to_string(n) + " triangles has " +
                        std::to_string(header_bytes + triangle_bytes * std::size_t{n}) + " bytes, not " +
                        std::to_string(bytes.size()));
    }
    read_text(cursor, bytes.size(), mesh);
}

}   // namespace livens
