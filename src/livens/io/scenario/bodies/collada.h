// SPDX-License-Identifier: BSD-3-Clause
// Collada (DAE): pictures of robots come in it.
#pragma once

#include <string>
#include <string_view>

#include "livens/geometry/mesh.h"

namespace livens::inline io_internal {

/// By the ending of a file's name.
bool is_collada(const std::string& name);
/// Faces of the scene as triangles, in metres by the unit of the file; of a file without a scene those of all
/// its geometries. Placed by the nodes of the scene, in the axes of the file: `up_axis` is not applied, as in
/// other readers of robots. Skins, colours and textures are passed over. Throws InputError `mesh-format` with
/// the line.
Mesh read_collada(std::string_view bytes, const std::string& name);

}   // namespace livens::inline io_internal
