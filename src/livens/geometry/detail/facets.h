// SPDX-License-Identifier: BSD-3-Clause
// The faces of a mesh and how they hang together along their edges.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "livens/base/error.h"
#include "livens/geometry/detail/rings.h"
#include "livens/geometry/mesh.h"

namespace livens::inline geometry_internal {

/// Faces by their corners. The half-edge h goes from corner h to the next one of its face.
struct Facets {
    /// All faces of a mesh, block by block. The mesh must stay.
    explicit Facets(const Mesh& mesh);
    Facets(const Facets&) = delete;
    Facets& operator=(const Facets&) = delete;

    const Mesh* mesh;
    bool are_triangles;   ///< flat ones, all of them: then nothing is copied
    std::span<const std::int32_t> corners;
    std::vector<std::int32_t> begins;   ///< of each face in `corners`, and the end; none where are_triangles
    std::vector<std::int32_t>
        middles;   ///< of each half-edge where faces are curved: its node, or -1; else empty

    std::int32_t n_faces() const
    {
        return static_cast<std::int32_t>(are_triangles ? corners.size() / 3 : begins.size() - 1);
    }
    std::int32_t begin(std::int32_t face) const { return are_triangles ? 3 * face : begins[face]; }
    std::int32_t next(std::int32_t face, std::int32_t h) const
    {
        return h + 1 < begin(face + 1) ? h + 1 : begin(face);
    }
    std::int32_t previous(std::int32_t face, std::int32_t h) const
    {
        return h > begin(face) ? h - 1 : begin(face + 1) - 1;
    }
    const Vector3& at(std::int32_t h) const { return mesh->points[corners[h]]; }

private:
    std::vector<std::int32_t> copied_;
};
/// "triangle 12", as the file counts its kind.
std::string name_of_face(const Mesh& mesh, std::int32_t face);
std::string text_of(const Vector3& point);

/// For each half-edge the one of the face beside it; -1 where there is no one or no clear one.
struct Links {
    std::vector<std::int32_t> twins;
    std::vector<std::int32_t> faces;   ///< of each half-edge
};
/// Adds what is wrong to `faults`: a face with a corner twice, open edges, edges of more than two faces,
/// neighbours that turn one edge the same way, curved neighbours with different middles.
Links link(const Facets& facets, std::vector<Complaint>& faults);
/// Likewise: points at which two fans of faces touch.
void check_fans(const Facets& facets, const Links& links, std::vector<Complaint>& faults);

/// Of each face the number of its piece, in the order of their first faces.
struct Pieces {
    std::vector<std::int32_t> of_face;   ///< none where there is one piece
    std::int32_t n = 0;

    std::int32_t of(std::int32_t face) const { return of_face.empty() ? 0 : of_face[face]; }
};
/// Connected along edges.
Pieces pieces_of(const Facets& facets, const Links& links);
/// Connected by points: the same where the rings are closed.
Pieces pieces_of(const Facets& facets);
/// Adds to `faults`: pieces that are turned inside out, or lie in each other.
void check_pieces(const Facets& facets, const Pieces& pieces, std::vector<Complaint>& faults);

/// Faces as triangles around their first corners.
struct Triangles {
    explicit Triangles(const Facets& facets);
    Triangles(const Triangles&) = delete;
    Triangles& operator=(const Triangles&) = delete;

    std::span<const std::int32_t> corners;
    std::vector<std::int32_t> faces;   ///< of each triangle; none where are_triangles

    std::int32_t face(std::size_t triangle) const
    {
        return faces.empty() ? static_cast<std::int32_t>(triangle) : faces[triangle];
    }

private:
    std::vector<std::int32_t> copied_;
};
/// Adds to `faults`: faces that meet where they share no corner. Curved faces count as their corners'
/// triangles.
void check_contacts(const Facets& facets, const Triangles& triangles, const Rings& rings,
                    std::vector<Complaint>& faults);

}   // namespace livens::inline geometry_internal
