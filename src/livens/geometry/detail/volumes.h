// SPDX-License-Identifier: BSD-3-Clause
// What soundness asks of elements of volume.
#pragma once

#include <vector>

#include "livens/base/error.h"
#include "livens/geometry/mesh.h"

namespace livens::inline geometry_internal {

/// Adds what is wrong to `faults`: Jacobians, faces of more than two elements or of two on one side.
void check_volumes(const Mesh& mesh, std::vector<Complaint>& faults);
void turn_volumes(Mesh& mesh);
int n_pieces_of_volume(const Mesh& mesh);
/// The order of an element's nodes seen in a mirror; of a face, from its other side.
void turn_element(ElementKind kind, std::int32_t* nodes);

}   // namespace livens::inline geometry_internal
