// SPDX-License-Identifier: BSD-3-Clause
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
    const Facets facets = facets_of(mesh);
    const Links links = link(facets, faults);
    // What follows takes a closed surface for granted.
    if (faults.empty()) check_fans(facets, links, faults);
    if (faults.empty()) check_contacts(facets, faults);
    if (faults.empty()) check_pieces(facets, links, faults);
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
    const Facets facets = facets_of(mesh);
    std::vector<Complaint> ignored;
    std::int32_t n = 0;
    pieces_of(facets, link(facets, ignored), n);
    return n;
}

}   // namespace livens
