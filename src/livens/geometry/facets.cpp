// SPDX-License-Identifier: BSD-3-Clause
// A surface as half-edges: each edge of a closed one belongs to two faces that run along it in opposite
// directions. What does not is told by kind, first place and number (theory.md, "Bodies from meshes", Is it a
// solid?).
#include <algorithm>
#include <array>
#include <numeric>

#include "livens/base/text.h"
#include "livens/geometry/detail/facets.h"
#include "livens/geometry/detail/workers.h"

namespace livens::inline geometry_internal {

namespace {

/// One fault of each kind is told, with the number of them.
class Tally {
public:
    void add(std::string first)
    {
        if (n_++ == 0) first_ = std::move(first);
    }
    void report(std::vector<Complaint>& faults, const std::string& code, const Mesh& mesh,
                const std::string& what, const std::string& note, const std::string& help) const
    {
        if (n_ == 0) return;
        const std::string count = n_ == 1 ? "" : " (and " + std::to_string(n_ - 1) + " more)";
        faults.push_back({code, "", mesh.name + ": " + what + ": " + first_ + count, "", "", note, help});
    }

private:
    std::int64_t n_ = 0;
    std::string first_;
};

std::string text_of_edge(const Facets& f, std::int32_t face, std::int32_t h)
{
    return "the edge from " + text_of(f.at(h)) + " to " + text_of(f.at(f.next(face, h))) + " of " +
           name_of_face(*f.mesh, face);
}

struct Linker {
    const Facets& f;
    Links& links;
    Tally degenerate, open, manifold, turned, middle;

    struct End {
        std::int32_t high, h;   // the other end of the edge, the half-edge
    };

    bool is_forward(std::int32_t h) const { return f.corners[h] < f.corners[f.next(links.faces[h], h)]; }

    /// All half-edges of one edge.
    void edge(const End* ends, std::size_t n)
    {
        const std::int32_t h = ends[0].h, face = links.faces[h];
        if (n == 1) return open.add(text_of_edge(f, face, h));
        const std::int32_t g = ends[1].h, other = links.faces[g];
        if (n > 2)
            return manifold.add(text_of_edge(f, face, h) + " belongs to " + std::to_string(n) +
                                " faces, also to " + name_of_face(*f.mesh, other));
        links.twins[h] = g;
        links.twins[g] = h;
        // Both run the same way: seen from outside, one of the faces goes round with the clock.
        if (is_forward(h) == is_forward(g))
            turned.add(text_of_edge(f, face, h) + " and of " + name_of_face(*f.mesh, other));
        if (!f.middles.empty() && f.middles[h] != f.middles[g])
            middle.add(text_of_edge(f, face, h) + " and of " + name_of_face(*f.mesh, other));
    }
};

}   // namespace

std::string text_of(const Vector3& p)
{
    return "(" + to_text(p[0]) + ", " + to_text(p[1]) + ", " + to_text(p[2]) + ")";
}

std::string name_of_face(const Mesh& mesh, std::int32_t face)
{
    std::int64_t at = face;
    for (const ElementBlock& b : mesh.blocks) {
        if (dimension(b.kind) != 2) continue;
        if (at < b.size()) {
            const Region& region = mesh.regions[b.regions[at]];
            return std::string(name_of(b.kind)) + " " + std::to_string(at + 1) +
                   (region.names.empty() ? "" : " of '" + region.names.front() + "'");
        }
        at -= b.size();
    }
    return "face " + std::to_string(face + 1);
}

Facets::Facets(const Mesh& of)
    : mesh(&of), are_triangles(of.n_elements(2) > 0 && of.block(ElementKind::triangle) != nullptr &&
                               of.n_elements(2) == of.block(ElementKind::triangle)->size())
{
    if (are_triangles) {
        // The usual mesh of triangles alone is looked at where it is, without a copy.
        corners = of.block(ElementKind::triangle)->nodes;
        return;
    }
    const bool is_curved = of.block(ElementKind::triangle6) != nullptr;
    begins.reserve(of.n_elements(2) + 1);
    begins.push_back(0);
    for (const ElementBlock& b : of.blocks) {
        if (dimension(b.kind) != 2) continue;
        const int n = n_corners(b.kind);
        copied_.reserve(copied_.size() + n * b.size());
        for (std::int64_t e = 0; e < b.size(); ++e) {
            const std::int32_t* nodes = b.element(e);
            copied_.insert(copied_.end(), nodes, nodes + n);
            begins.push_back(static_cast<std::int32_t>(copied_.size()));
            for (int k = 0; is_curved && k < n; ++k)
                // Curved neighbours must share the middle of their edge, or a gap opens between them.
                middles.push_back(b.kind == ElementKind::triangle6 ? nodes[n + k] : -1);
        }
    }
    corners = copied_;
}

Triangles::Triangles(const Facets& f)
{
    if (f.are_triangles) {
        corners = f.corners;
        return;
    }
    for (std::int32_t face = 0; face < f.n_faces(); ++face)
        for (std::int32_t h = f.begin(face) + 1; h + 1 < f.begin(face + 1); ++h) {
            copied_.insert(copied_.end(), {f.corners[f.begin(face)], f.corners[h], f.corners[h + 1]});
            faces.push_back(face);
        }
    corners = copied_;
}

/// Half-edges are put into buckets by the lower of their two points.
Links link(const Facets& f, std::vector<Complaint>& faults)
{
    const auto n = static_cast<std::int32_t>(f.corners.size());
    Links links{std::vector<std::int32_t>(n, -1), std::vector<std::int32_t>(n)};
    Linker linker{f, links, {}, {}, {}, {}, {}};
    std::vector<std::int32_t> begins(f.mesh->points.size() + 1, 0);
    for (std::int32_t face = 0; face < f.n_faces(); ++face)
        for (std::int32_t h = f.begin(face); h < f.begin(face + 1); ++h) {
            links.faces[h] = face;
            for (std::int32_t g = f.begin(face); g < h; ++g)
                if (f.corners[g] == f.corners[h])
                    linker.degenerate.add(name_of_face(*f.mesh, face) + " has the corner " +
                                          text_of(f.at(h)) + " twice");
            // A counting sort: two passes over half-edges, linear in their number.
            ++begins[std::min(f.corners[h], f.corners[f.next(face, h)]) + 1];
        }
    for (std::size_t i = 1; i < begins.size(); ++i) begins[i] += begins[i - 1];
    std::vector<Linker::End> ends(n);
    std::vector<std::int32_t> fill(begins.begin(), begins.end() - 1);
    for (std::int32_t h = 0; h < n; ++h) {
        const std::int32_t a = f.corners[h], b = f.corners[f.next(links.faces[h], h)];
        ends[fill[std::min(a, b)]++] = {std::max(a, b), h};
    }
    for (std::size_t p = 0; p + 1 < begins.size(); ++p) {
        const auto first = ends.begin() + begins[p], last = ends.begin() + begins[p + 1];
        std::sort(first, last, [](const auto& l, const auto& r) {
            return std::pair(l.high, l.h) < std::pair(r.high, r.h);
        });
        for (auto at = first; at != last;) {
            auto end = at;
            while (end != last && end->high == at->high) ++end;
            linker.edge(&*at, end - at);
            at = end;
        }
    }
    const std::string law = "mass and inertia follow from the surface alone: it must close";
    linker.degenerate.report(faults, "mesh-non-manifold", *f.mesh, "a face is no triangle", "",
                             "leave faces out whose corners fall together");
    linker.open.report(
        faults, "mesh-open", *f.mesh, "the surface is open", law,
        "close the hole, or let equal points be one: neighbours must share their corners to the bit");
    linker.manifold.report(faults, "mesh-non-manifold", *f.mesh, "more than two faces share an edge",
                           "each edge of a closed surface belongs to two faces",
                           "separate what touches there");
    linker.turned.report(faults, "mesh-inverted", *f.mesh, "neighbours face opposite sides",
                         "seen from outside the corners of every face go round against the clock",
                         "turn one of them; a scenario does with `turn = true`");
    linker.middle.report(faults, "mesh-open", *f.mesh, "curved neighbours have different nodes on one edge",
                         law, "");
    return links;
}

void check_fans(const Facets& f, const Links& links, std::vector<Complaint>& faults)
{
    std::vector<std::int32_t> n_at(f.mesh->points.size(), 0);
    for (const std::int32_t corner : f.corners) ++n_at[corner];
    Tally touching;
    std::vector<bool> is_seen(f.mesh->points.size(), false);
    for (std::int32_t first = 0; first < static_cast<std::int32_t>(f.corners.size()); ++first) {
        const std::int32_t corner = f.corners[first];
        if (is_seen[corner]) continue;
        is_seen[corner] = true;
        std::int32_t n = 0, h = first;
        do {   // round the corner: across the edge that comes in, to the one that goes out of it beyond
            h = links.twins[f.previous(links.faces[h], h)];
            ++n;
        // A ring that closes before all faces of the corner were met is one of several: the surface touches
        // itself there.
        } while (h != first && h >= 0 && n <= n_at[corner]);
        if (n != n_at[corner])
            touching.add("at " + text_of(f.mesh->points[corner]) + ", a corner of " +
                         name_of_face(*f.mesh, links.faces[first]));
    }
    touching.report(faults, "mesh-self-contact", *f.mesh, "parts of the surface touch at a point",
                    "around each point of a closed surface its faces form one ring",
                    "separate the parts, or give each its own points");
}

namespace {

/// The root of a tree, whose way there is halved.
std::int32_t root_of(std::vector<std::int32_t>& parents, std::int32_t at)
{
    while (parents[at] != at) at = parents[at] = parents[parents[at]];
    return at;
}
/// The lower root is that of both.
void unite(std::vector<std::int32_t>& parents, std::int32_t a, std::int32_t b)
{
    a = root_of(parents, a);
    b = root_of(parents, b);
    parents[std::max(a, b)] = std::min(a, b);
}

std::vector<std::int32_t> numbers_up_to(std::size_t n)
{
    std::vector<std::int32_t> numbers = filled<std::int32_t>(n, 0);
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
}

/// Numbers the roots that faces have.
template <class Root>
Pieces numbered(std::int32_t n_faces, std::size_t n_roots, Root root)
{
    Pieces pieces;
    bool is_one = true;
    // Most surfaces are one piece, for which no number need be kept for each face.
    const std::int32_t first = n_faces > 0 ? root(0) : 0;
    for (std::int32_t face = 1; face < n_faces && is_one; ++face) is_one = root(face) == first;
    if (is_one) {
        pieces.n = n_faces > 0 ? 1 : 0;
        return pieces;
    }
    std::vector<std::int32_t> numbers(n_roots, -1);
    pieces.of_face.resize(n_faces);
    for (std::int32_t face = 0; face < n_faces; ++face) {
        std::int32_t& number = numbers[root(face)];
        if (number < 0) number = pieces.n++;
        pieces.of_face[face] = number;
    }
    return pieces;
}

}   // namespace

Pieces pieces_of(const Facets& f, const Links& links)
{
    std::vector<std::int32_t> parents = numbers_up_to(f.n_faces());
    for (std::size_t h = 0; h < links.twins.size(); ++h)
        if (links.twins[h] >= 0) unite(parents, links.faces[h], links.faces[links.twins[h]]);
    return numbered(f.n_faces(), parents.size(), [&](std::int32_t face) { return root_of(parents, face); });
}

Pieces pieces_of(const Facets& f)
{
    std::vector<std::int32_t> parents = numbers_up_to(f.mesh->points.size());
    for (std::int32_t face = 0; face < f.n_faces(); ++face)
        for (std::int32_t h = f.begin(face); h + 1 < f.begin(face + 1); ++h)
            if (parents[f.corners[h]] != parents[f.corners[h + 1]])
                unite(parents, f.corners[h], f.corners[h + 1]);
    return numbered(f.n_faces(), parents.size(),
                    [&](std::int32_t face) { return root_of(parents, f.corners[f.begin(face)]); });
}

}   // namespace livens::inline geometry_internal
