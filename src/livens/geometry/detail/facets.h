// SPDX-License-Identifier: BSD-3-Clause
// The faces of a mesh and how they hang together along their edges.
#pragma once

#include <cstdint>
#include <vector>

#include "livens/base/error.h"
#include "livens/geometry/mesh.h"

namespace livens {

/// Faces by their corners. The half-edge h goes from corner h to the next one of its face.
struct Facets {
    const Mesh* mesh = nullptr;
    std::vector<std::int32_t> corners;
    std::vector<std::int32_t> begins;   ///< of each face in `corners`, and the end
    std::vector<std::int32_t>
        middles;   ///< of each half-edge where faces are curved: its node, or -1; else empty

    std::int32_t n_faces() const { return static_cast<std::int32_t>(begins.size()) - 1; }
    std::int32_t next(std::int32_t face, std::int32_t h) const
    {
        return h + 1 < begins[face + 1] ? h + 1 : begins[face];
    }
    std::int32_t previous(std::int32_t face, std::int32_t h) const
    {
        return h > begins[face] ? h - 1 : begins[face + 1] - 1;
    }
    const Vector3& at(std::int32_t h) const { return mesh->points[corners[h]]; }
};

/// All faces of a mesh, block by block.
Facets facets_of(const Mesh& mesh);
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
/// Likewise: pieces that are turned inside out, or lie in each other.
void check_pieces(const Facets& facets, const Links& links, std::vector<Complaint>& faults);
/// Likewise: faces that meet where they share no corner. Curved faces count as their corners' triangles.
void check_contacts(const Facets& facets, std::vector<Complaint>& faults);

/// Of each face the number of its piece, connected along edges.
std::vector<std::int32_t> pieces_of(const Facets& facets, const Links& links, std::int32_t& n_pieces);

}   // namespace livens
