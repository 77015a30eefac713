// SPDX-License-Identifier: BSD-3-Clause
// Elements of volume: their Jacobians, how they hang together by faces, and their boundary.
// A Jacobian has to be positive wherever it is probed: moments by quadrature take its sign for granted
// (theory.md, "Bodies from meshes").
#include <algorithm>
#include <array>
#include <map>

#include "livens/geometry/detail/elements.h"
#include "livens/geometry/detail/facets.h"
#include "livens/geometry/detail/volumes.h"
#include "livens/geometry/soundness.h"

namespace livens {

namespace {

/// Nodes of the faces of elements, seen from outside: corners, then middles.
struct Faces {
    ElementKind kind;
    std::vector<std::array<int, 6>> nodes;
};
const Faces& faces_of(ElementKind kind)
{
    // Corners go round anticlockwise as seen from outside, in the order of nodes of Gmsh.
    static const Faces tetrahedron{ElementKind::triangle, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
    static const Faces curved{
        ElementKind::triangle6,
        {{0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 9, 7}, {1, 2, 3, 5, 8, 9}, {0, 3, 2, 7, 8, 6}}};
    static const Faces hexahedron{
        ElementKind::quadrilateral,
        {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
    return kind == ElementKind::tetrahedron     ? tetrahedron
           : kind == ElementKind::tetrahedron10 ? curved
                                                : hexahedron;
}

using Corners = std::array<std::int32_t, 4>;   // ascending; a triangle's first is -1

/// One face of one element.
struct Side {
    Corners key;
    bool is_even = true;   ///< how its corners must be swapped to ascend; meaningless for quadrilaterals
    std::int32_t block, element, face;
};

Corners sorted(const std::int32_t* nodes, int n, bool& is_even)
{
    Corners key{-1, -1, -1, -1};
    std::copy(nodes, nodes + n, key.begin());
    is_even = true;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j + 1 < n - i; ++j)
            // Each swap of bubble sort changes the parity of the permutation.
            if (key[j] > key[j + 1]) std::swap(key[j], key[j + 1]), is_even = !is_even;
    if (n == 3) key = {-1, key[0], key[1], key[2]};
    return key;
}

/// Of a quadrilateral: the corner that follows its lowest one is lower than the one before.
bool goes_up(const std::int32_t* nodes)
{
    const auto low = std::min_element(nodes, nodes + 4) - nodes;
    return nodes[(low + 1) % 4] < nodes[(low + 3) % 4];
}

std::vector<Side> sides_of(const Mesh& mesh)
{
    std::vector<Side> sides;
    for (std::int32_t b = 0; b < static_cast<std::int32_t>(mesh.blocks.size()); ++b) {
        const ElementBlock& block = mesh.blocks[b];
        if (dimension(block.kind) != 3) continue;
        const Faces& faces = faces_of(block.kind);
        const int n = n_corners(faces.kind);
        sides.reserve(sides.size() + faces.nodes.size() * block.size());
        for (std::int32_t e = 0; e < block.size(); ++e)
            for (std::int32_t k = 0; k < static_cast<std::int32_t>(faces.nodes.size()); ++k) {
                std::int32_t nodes[4];
                for (int i = 0; i < n; ++i) nodes[i] = block.element(e)[faces.nodes[k][i]];
                Side side{{}, true, b, e, k};
                side.key = sorted(nodes, n, side.is_even);
                if (n == 4) side.is_even = goes_up(nodes);
                sides.push_back(side);
            }
    }
    // Equal faces stand side by side after sorting, which takes less memory than a table of faces.
    std::sort(sides.begin(), sides.end(), [](const Side& l, const Side& r) {
        return std::tie(l.key, l.block, l.element) < std::tie(r.key, r.block, r.element);
    });
    return sides;
}

std::string name_of_element(const Mesh& mesh, const ElementBlock& block, std::int64_t e)
{
    const Region& region = mesh.regions[block.regions[e]];
    return std::string(name_of(block.kind)) + " " + std::to_string(e + 1) +
           (region.names.empty() ? "" : " of '" + region.names.front() + "'");
}

/// The smallest and the largest Jacobian of an element.
std::pair<double, double> jacobians(const Mesh& mesh, const ElementBlock& block, std::int64_t e)
{
    double low = 0, high = 0;
    bool is_first = true;
    const Vector3 about = mesh.points[block.element(e)[0]];
    for (const ShapeValues& probe : probes_of(block.kind)) {
        const double J = determinant(element_point(probe, mesh, block.kind, block.element(e), about).F);
        low = is_first ? J : std::min(low, J);
        high = is_first ? J : std::max(high, J);
        is_first = false;
    }
    return {low, high};
}

void check_jacobians(const Mesh& mesh, std::vector<Complaint>& faults)
{
    std::int64_t n = 0;
    std::string first;
    for (const ElementBlock& block : mesh.blocks) {
        if (dimension(block.kind) != 3) continue;
        for (std::int64_t e = 0; e < block.size(); ++e) {
            const auto [low, high] = jacobians(mesh, block, e);
            if (low > 0) continue;
            if (n++ == 0)
                first = name_of_element(mesh, block, e) +
                        (high > 0 ? " is folded" : " is turned inside out") + ", at " +
                        text_of(mesh.points[block.element(e)[0]]);
        }
    }
    if (n > 0)
        faults.push_back(
            {"mesh-inverted", "",
             mesh.name + ": " + first + (n > 1 ? " (and " + std::to_string(n - 1) + " more)" : ""), "", "",
             "the Jacobian of each element must be positive everywhere",
             "order the nodes as the format asks for; a scenario turns elements with `turn = true`"});
}

}   // namespace

void geometry_internal::check_volumes(const Mesh& mesh, std::vector<Complaint>& faults)
{
    check_jacobians(mesh, faults);
    const std::vector<Side> sides = sides_of(mesh);
    for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
        while (end < sides.size() && sides[end].key == sides[i].key) ++end;
        // Two elements see their common face from opposite sides, so their corners are permuted by opposite
        // parities.
        if (end - i == 1 || (end - i == 2 && sides[i].is_even != sides[i + 1].is_even)) continue;
        const auto name = [&](const Side& s) {
            return name_of_element(mesh, mesh.blocks[s.block], s.element);
        };
        faults.push_back(
            {"mesh-non-manifold", "",
             mesh.name + ": " + name(sides[i]) + " and " + name(sides[i + 1]) +
                 (end - i > 2 ? " and others share one face" : " lie on the same side of one face"),
             "", "", "a face belongs to one element, or to two on its two sides",
             "leave out elements that are given twice"});
        return;
    }
}

Mesh boundary_of(const Mesh& mesh)
{
    Mesh boundary;
    boundary.name = mesh.name;
    boundary.format = mesh.format;
    boundary.points = mesh.points;
    boundary.regions = mesh.regions;
    std::map<Corners, std::int32_t> named;
    bool is_even = true;
    for (const ElementBlock& b : mesh.blocks)
        for (std::int64_t e = 0; dimension(b.kind) == 2 && e < b.size(); ++e)
            // Elements of surface in the file give faces of the boundary their names, whatever their
            // orientation.
            named.emplace(sorted(b.element(e), n_corners(b.kind), is_even), b.regions[e]);
    const auto nameless = static_cast<std::int32_t>(boundary.regions.size());
    boundary.regions.push_back({2, {}});
    const std::vector<Side> sides = sides_of(mesh);
    for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
        while (end < sides.size() && sides[end].key == sides[i].key) ++end;
        // A face that one element has alone is part of the boundary.
        if (end - i != 1) continue;
        const ElementBlock& block = mesh.blocks[sides[i].block];
        const Faces& faces = faces_of(block.kind);
        auto to = std::ranges::find(boundary.blocks, faces.kind, &ElementBlock::kind);
        if (to == boundary.blocks.end())
            to = boundary.blocks.insert(boundary.blocks.end(), ElementBlock{faces.kind, {}, {}});
        for (int k = 0; k < n_nodes(faces.kind); ++k)
            to->nodes.push_back(block.element(sides[i].element)[faces.nodes[sides[i].face][k]]);
        const auto name = named.find(sides[i].key);
        to->regions.push_back(name == named.end() ? nameless : name->second);
    }
    return boundary;
}

int geometry_internal::n_pieces_of_volume(const Mesh& mesh)
{
    std::vector<std::int32_t> firsts, parents;   // of each block: the number of its first element
    std::int32_t n = 0;
    for (const ElementBlock& b : mesh.blocks) {
        firsts.push_back(n);
        n += dimension(b.kind) == 3 ? static_cast<std::int32_t>(b.size()) : 0;
    }
    for (std::int32_t e = 0; e < n; ++e) parents.push_back(e);
    const auto root = [&](std::int32_t e) {
        // Union-find with path halving: pieces are sets of elements that share faces.
        while (parents[e] != e) e = parents[e] = parents[parents[e]];
        return e;
    };
    const std::vector<Side> sides = sides_of(mesh);
    std::int32_t pieces = n;
    for (std::size_t i = 1; i < sides.size(); ++i) {
        if (sides[i].key != sides[i - 1].key) continue;
        const std::int32_t a = root(firsts[sides[i].block] + sides[i].element),
                           b = root(firsts[sides[i - 1].block] + sides[i - 1].element);
        if (a != b) parents[a] = b, --pieces;
    }
    return pieces;
}

void geometry_internal::turn_volumes(Mesh& mesh)
{
    for (ElementBlock& block : mesh.blocks)
        for (std::int64_t e = 0; dimension(block.kind) == 3 && e < block.size(); ++e)
            if (jacobians(mesh, block, e).second < 0)
                turn_element(block.kind, block.nodes.data() + e * n_nodes(block.kind));
}

}   // namespace livens
