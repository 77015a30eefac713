// SPDX-License-Identifier: BSD-3-Clause
// The order of tests of a mesh: theory.md, "Bodies from meshes", Is it a solid? Each test takes for granted
// what the ones before have shown, so the first kind of fault that is found ends the search.
#include "livens/geometry/soundness.h"

#include "livens/geometry/detail/facets.h"
#include "livens/geometry/detail/volumes.h"

namespace livens {

std::vector<Complaint> faults_of(const Mesh& mesh)
{
    std::vector<Complaint> faults;
    if (mesh.is_volume()) {
        check_volumes(mesh, faults);
        return faults;
    }
    const Facets facets(mesh);
    const Triangles triangles(facets);
    const Rings rings = rings_of(mesh.points, triangles.corners);
    const bool is_plain = facets.are_triangles && rings.are_closed;   // no edge need be looked at
    const Links links = is_plain ? Links{} : link(facets, faults);
    // What follows takes a closed surface for granted.
    if (!is_plain && faults.empty()) check_fans(facets, links, faults);
    if (faults.empty()) check_contacts(facets, triangles, rings, faults);
    if (faults.empty()) check_pieces(facets, is_plain ? pieces_of(facets) : pieces_of(facets, links), faults);
    return faults;
}

void require_sound(const Mesh& mesh)
{
    const std::vector<Complaint> faults = faults_of(mesh);
    if (!faults.empty()) throw InputError(faults.front());
}

int n_pieces(const Mesh& mesh)
{
    if (mesh.is_volume()) return n_pieces_of_volume(mesh);
    const Facets facets(mesh);
    std::vector<Complaint> ignored;
    return pieces_of(facets, link(facets, ignored)).n;
}

}   // namespace livens
