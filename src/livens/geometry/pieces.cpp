// SPDX-License-Identifier: BSD-3-Clause
// Pieces of a surface: which of them lie in each other, and whether they are turned as that asks for.
// Volumes have the sign of their orientation: a piece outside of all others must be positive, a hollow in one
// of them negative (theory.md, "Bodies from meshes", Is it a solid?).
#include <algorithm>

#include "livens/geometry/detail/depths.h"
#include "livens/geometry/detail/volumes.h"
#include "livens/geometry/detail/workers.h"
#include "livens/geometry/soundness.h"

namespace livens {

namespace {

constexpr std::int32_t most_pieces = 20000;   // each is looked for in all others

struct Piece {
    std::int32_t first = -1, n_faces = 0;
    std::vector<std::int32_t> faces;   ///< none where there is one piece, which has all
    double volume = 0;
    Vector3 low{1, 1, 1}, high{-1, -1, -1};
    int depth = 0;   ///< in how many other pieces it lies, those that are inside out counted down
};

/// Calls work(a, b, c) with the corners of triangles that make up a face.
template <class Work>
void for_triangles(const Facets& f, std::int32_t face, Work work)
{
    for (std::int32_t h = f.begin(face) + 1; h + 1 < f.begin(face + 1); ++h)
        work(f.at(f.begin(face)), f.at(h), f.at(h + 1));
}

void widen(Piece& piece, const Vector3& p)
{
    for (int i = 0; i < 3; ++i) {
        piece.low[i] = std::min(piece.low[i], p[i]);
        piece.high[i] = std::max(piece.high[i], p[i]);
    }
}

/// Six times the volume between a point and a face.
double six_volumes(const Facets& f, std::int32_t face, const Vector3& about)
{
    double volume = 0;
    for_triangles(f, face, [&](const Vector3& a, const Vector3& b, const Vector3& c) {
        volume += dot(a - about, cross(b - about, c - about));
    });
    return volume;
}

/// The only one, which need not be found in others.
Piece whole_piece(const Facets& f)
{
    Piece piece;
    piece.first = 0;
    piece.n_faces = f.n_faces();
    constexpr std::size_t some = 65536;   // faces at a time, however many threads there are
    const std::size_t n = f.n_faces();
    std::vector<double> parts(n / some + 1, 0);
    in_parts(n, some, [&](std::size_t begin, std::size_t end, int part) {
        const Vector3 about = f.at(0);
        double sum = 0;
        if (f.are_triangles)
            for (std::size_t h = 3 * begin; h < 3 * end; h += 3) {
                const auto at = [&](std::size_t k) { return f.at(static_cast<std::int32_t>(h + k)) - about; };
                sum += dot(at(0), cross(at(1), at(2)));
            }
        else
            for (std::size_t k = begin; k < end; ++k)
                sum += six_volumes(f, static_cast<std::int32_t>(k), about);
        parts[part] = sum;
    });
    for (const double part : parts) piece.volume += part / 6;
    return piece;
}

std::vector<Piece> make_pieces(const Facets& f, const Pieces& numbers)
{
    if (numbers.n == 1) return {whole_piece(f)};
    std::vector<Piece> pieces(numbers.n);
    for (std::int32_t face = 0; face < f.n_faces(); ++face) {
        Piece& piece = pieces[numbers.of(face)];
        if (piece.n_faces++ == 0) {
            piece.first = face;
            piece.low = piece.high = f.at(f.begin(face));
        }
        piece.faces.push_back(face);
        for (std::int32_t h = f.begin(face); h < f.begin(face + 1); ++h) widen(piece, f.at(h));
    }
    for (Piece& piece : pieces) {
        // Each piece about its own middle: cones from far away would cancel, and the sign of a small piece
        // would be lost.
        const Vector3 middle = 0.5 * piece.low + 0.5 * piece.high;
        for (const std::int32_t face : piece.faces) piece.volume += six_volumes(f, face, middle) / 6;
    }
    return pieces;
}

/// A point of a face that is in line with no corner of another one but by chance.
Vector3 point_of(const Facets& f, std::int32_t face)
{
    const std::int32_t h = f.begin(face);
    // Numbers without a pattern: centroids of regular meshes lie in line with corners of others again and
    // again.
    return 0.4319 * f.at(h) + 0.3163 * f.at(h + 1) + 0.2518 * f.at(h + 2);
}

/// False where pieces lie about each other too often to be counted.
bool find_depths(const Facets& f, const Pieces& numbers, std::vector<Piece>& pieces, bool as_if_outwards)
{
    if (pieces.size() == 1) return true;
    const Triangles triangles(f);
    Depths depths(f, triangles, numbers);
    for (std::size_t k = 0; k < pieces.size() && !depths.is_beyond(); ++k)
        pieces[k].depth =
            depths.of(point_of(f, pieces[k].first), static_cast<std::int32_t>(k), as_if_outwards);
    return !depths.is_beyond();
}

/// Makes neighbours agree, beginning with the first face of each piece. Of surfaces with one side only
/// nothing could; the check says so afterwards.
void agree(const Facets& f, const Links& links, std::vector<bool>& is_turned)
{
    std::vector<bool> is_known(f.n_faces(), false);
    std::vector<std::int32_t> waiting;
    for (std::int32_t first = 0; first < f.n_faces(); ++first) {
        if (is_known[first]) continue;
        is_known[first] = true;
        waiting.assign(1, first);
        while (!waiting.empty()) {
            const std::int32_t face = waiting.back();
            waiting.pop_back();
            for (std::int32_t h = f.begin(face); h < f.begin(face + 1); ++h) {
                const std::int32_t g = links.twins[h];
                if (g < 0 || is_known[links.faces[g]]) continue;
                const std::int32_t other = links.faces[g];
                is_known[other] = true;
                // Half-edges that begin at one corner run the same way, so exactly one of the two faces has
                // to turn.
                is_turned[other] = is_turned[face] != (f.corners[h] == f.corners[g]);
                waiting.push_back(other);
            }
        }
    }
}

void turn_faces(Mesh& mesh, const std::vector<bool>& is_turned)
{
    std::size_t face = 0;
    for (ElementBlock& b : mesh.blocks)
        for (std::int64_t e = 0; dimension(b.kind) == 2 && e < b.size(); ++e)
            if (is_turned[face++]) turn_element(b.kind, b.nodes.data() + e * n_nodes(b.kind));
}

}   // namespace

void geometry_internal::turn_element(ElementKind kind, std::int32_t* nodes)
{
    switch (kind) {
    case ElementKind::triangle:
        std::swap(nodes[1], nodes[2]);
        break;
    case ElementKind::quadrilateral:
        std::swap(nodes[1], nodes[3]);
        break;
    case ElementKind::triangle6:
        std::swap(nodes[1], nodes[2]), std::swap(nodes[3], nodes[5]);
        break;
    case ElementKind::tetrahedron:
        std::swap(nodes[0], nodes[1]);
        break;
    case ElementKind::hexahedron:
        for (int k = 0; k < 4; ++k) std::swap(nodes[k], nodes[k + 4]);
        break;
    case ElementKind::tetrahedron10:
        std::swap(nodes[0], nodes[1]), std::swap(nodes[5], nodes[6]), std::swap(nodes[7], nodes[9]);
    }
}

void geometry_internal::check_pieces(const Facets& f, const Pieces& numbers, std::vector<Complaint>& faults)
{
    const std::string& name = f.mesh->name;
    if (numbers.n > most_pieces) {
        faults.push_back({"mesh-self-contact", "",
                          name + ": the surface has " + std::to_string(numbers.n) +
                              " separate pieces, too many to see whether they lie in each other",
                          "", std::to_string(most_pieces), "", "divide it into several meshes"});
        return;
    }
    std::vector<Piece> pieces = make_pieces(f, numbers);
    if (!find_depths(f, numbers, pieces, false)) {
        faults.push_back({"mesh-self-contact", "",
                          name + ": too many of the surface's " + std::to_string(numbers.n) +
                              " separate pieces lie about each other to see which of them are hollows",
                          "", "", "", "leave out what is inside, or divide it into several meshes"});
        return;
    }
    for (const Piece& piece : pieces) {
        const std::string which = "the piece of " + std::to_string(piece.n_faces) + " faces with " +
                                  name_of_face(*f.mesh, piece.first);
        if (!(piece.volume != 0)) {
            faults.push_back({"mesh-inverted", "", name + ": " + which + " holds no volume", "", "", "", ""});
            return;
        }
        // Inside-out pieces count down, so a part inside of a hollow lies at depth 0 again, as it should.
        if (piece.depth == (piece.volume > 0 ? 0 : 1)) continue;
        const bool is_in = piece.depth > 0;
        if (piece.volume < 0)
            faults.push_back({"mesh-inverted", "",
                              name + ": " + which + " is turned inside out, and is no hollow", "", "",
                              "seen from outside the corners of every face go round against the clock",
                              "turn it; a scenario does with `turn = true`"});
        else
            faults.push_back(
                {"mesh-self-contact", "",
                 name + ": " + which + " lies " +
                     (is_in ? "in another one, whose mass would count twice" : "in an invalid hollow"),
                 "", "", "", "turn it inside out if it is a hollow, or leave it out"});
        return;
    }
}

void turn_outwards(Mesh& mesh)
{
    if (mesh.is_volume()) return turn_volumes(mesh);
    std::vector<Complaint> ignored;
    {
        const Facets f(mesh);
        std::vector<bool> is_turned(f.n_faces(), false);
        agree(f, link(f, ignored), is_turned);
        turn_faces(mesh, is_turned);
    }
    const Facets f(mesh);
    std::vector<bool> is_turned(f.n_faces(), false);
    const Pieces numbers = pieces_of(f, link(f, ignored));
    if (numbers.n > most_pieces) return;
    std::vector<Piece> pieces = make_pieces(f, numbers);
    if (!find_depths(f, numbers, pieces, true)) return;
    for (std::int32_t face = 0; face < f.n_faces(); ++face) {
        const Piece& piece = pieces[numbers.of(face)];
        // Orientation is not known yet, so nesting counts without sign: even depths are solid, odd ones
        // hollows.
        is_turned[face] = (piece.volume > 0) != (piece.depth % 2 == 0);
    }
    turn_faces(mesh, is_turned);
}

}   // namespace livens
