// SPDX-License-Identifier: BSD-3-Clause
// STL: triangles without indices. Equal corners, to the bit but for the sign of zero, become one point.
// The solid is what counts, so normals of the file are not read: the order of corners tells outside from
// inside. Equal corners must be one point, or no edge would have a second face.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "livens/geometry/detail/cursor.h"
#include "livens/geometry/detail/workers.h"

namespace livens::inline geometry_internal {

namespace {

constexpr std::size_t header_bytes = 84, triangle_bytes = 50;

/// Points by their coordinates: a table with open addressing, at most half full.
class Welder {
public:
    Welder(std::vector<Vector3>& points, std::size_t n_corners) : points_(points)
    {
        // A closed surface of triangles has half as many points as faces.
        slots_ = filled(std::bit_ceil(n_corners / 2 + 16), -1);
        reserve(points_, n_corners / 6 + 16);
    }

    std::int32_t index(const Vector3& point)
    {
        const Vector3 p = without_signs(point);
        return index(p, hash(p));
    }

    /// Of many at a time: so the table's memory need not be waited for.
    void index(std::span<const Vector3> points, std::int32_t* indices)
    {
        hashes_.resize(points.size());
        for (std::size_t k = 0; k < points.size(); ++k) {
            hashes_[k] = hash(without_signs(points[k]));
            __builtin_prefetch(&slots_[hashes_[k] & (slots_.size() - 1)]);
        }
        for (std::size_t k = 0; k < points.size(); ++k)
            indices[k] = index(without_signs(points[k]), hashes_[k]);
    }

private:
    static Vector3 without_signs(Vector3 p)
    {
        for (int i = 0; i < 3; ++i) p[i] += 0.0;   // -0 is 0
        return p;
    }
    std::int32_t index(const Vector3& p, std::uint64_t hash)
    {
        // At most half full: linear probing then looks at few slots.
        if (2 * points_.size() >= slots_.size()) grow();
        std::int32_t& slot = find(p, hash);
        if (slot < 0) {
            slot = static_cast<std::int32_t>(points_.size());
            points_.push_back(p);
        }
        return slot;
    }
    static std::uint64_t hash(const Vector3& p)
    {
        std::uint64_t h = 0;
        for (int i = 0; i < 3; ++i)
            h = (h ^ std::bit_cast<std::uint64_t>(p[i])) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
        return h ^ (h >> 32);
    }
    std::int32_t& find(const Vector3& p, std::uint64_t hash)
    {
        const std::size_t mask = slots_.size() - 1;
        std::size_t at = hash & mask;
        while (slots_[at] >= 0 && !(points_[slots_[at]] == p)) at = (at + 1) & mask;
        return slots_[at];
    }
    void grow()
    {
        slots_ = filled(2 * slots_.size(), -1);
        for (std::size_t i = 0; i < points_.size(); ++i)
            find(points_[i], hash(points_[i])) = static_cast<std::int32_t>(i);
    }

    std::vector<Vector3>& points_;
    std::vector<std::int32_t> slots_;
    std::vector<std::uint64_t> hashes_;
};

template <bool swap>
float float_at(const char* bytes)
{
    std::uint32_t bits;
    std::memcpy(&bits, bytes, sizeof bits);
    if (swap) bits = bits >> 24 | (bits >> 8 & 0xff00) | (bits << 8 & 0xff0000) | bits << 24;
    return std::bit_cast<float>(bits);
}

void read_binary(Cursor& cursor, std::uint32_t n, Mesh& mesh)
{
    constexpr bool swap = std::endian::native != std::endian::little;
    mesh.format = "STL, binary";
    MeshBuilder builder(mesh);
    builder.region(2, "");
    ElementBlock& block = builder.block(ElementKind::triangle);
    block.nodes = filled(3 * std::size_t{n}, 0);
    block.regions = filled(n, 0);
    Welder welder(mesh.points, 3 * std::size_t{n});
    constexpr std::size_t some = 64;   // triangles at a time
    std::vector<Vector3> corners;
    for (std::size_t first = 0; first < n; first += some) {
        corners.clear();
        for (std::size_t f = first; f < std::min<std::size_t>(first + some, n); ++f) {
            cursor.skip(12);   // the normal: what counts is the order of the corners
            const char* at = cursor.ahead().data();
            cursor.skip(triangle_bytes - 12);   // that all are there is known
            for (int k = 0; k < 3; ++k) {
                Vector3 p;
                for (int i = 0; i < 3; ++i, at += 4) p[i] = float_at<swap>(at);
                if (!std::isfinite(p[0] + p[1] + p[2]))   // doubles that are floats do not overflow
                    cursor.fail("a coordinate of triangle " + std::to_string(f + 1) + " is not finite");
                corners.push_back(p);
            }
        }
        welder.index(corners, block.nodes.data() + 3 * first);
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

}   // namespace livens::inline geometry_internal
