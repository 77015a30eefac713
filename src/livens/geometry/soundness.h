// SPDX-License-Identifier: BSD-3-Clause
// Whether a mesh is that of a solid.
#pragma once

#include <vector>

#include "livens/base/error.h"
#include "livens/geometry/mesh.h"

namespace [[gnu::visibility("default")]] livens {

/// What is wrong with a mesh, one complaint a kind of fault, which names the first place and the number of
/// them; empty: it bounds or fills a solid, and the integrals over it are those of the solid.
///
/// A surface must be closed (`mesh-open`), with two faces at each edge (`mesh-non-manifold`) which turn it
/// opposite ways, outside out, hollows inside out (`mesh-inverted`), in one ring around each point, and no
/// face may touch or cross another where they share no corner (`mesh-self-contact`). Of a volume each element
/// must have a positive Jacobian at all points of its quadrature and its corners (`mesh-inverted`), and each
/// face belong to one element or to two that lie on its two sides (`mesh-non-manifold`).
std::vector<Complaint> faults_of(const Mesh& mesh);

/// Throws the first of faults_of() as InputError.
void require_sound(const Mesh& mesh);

/// Turns faces that look inwards, and elements of volume with negative Jacobians. What cannot be told stays
/// as it is: faults_of() finds it.
void turn_outwards(Mesh& mesh);

/// The boundary of a volume, its faces seen from outside; flat ones as triangles and quadrilaterals, curved
/// ones as curved triangles. Regions: those of `mesh` that have a face of the same corners, else one without
/// a name.
Mesh boundary_of(const Mesh& mesh);

/// Pieces that hang together along edges (of a surface) or faces (of a volume).
int n_pieces(const Mesh& mesh);

}   // namespace livens
