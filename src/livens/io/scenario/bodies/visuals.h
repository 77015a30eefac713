// SPDX-License-Identifier: BSD-3-Clause
// `visual`, `color` and `opacity`: how bodies and the world look, apart from what they weigh.
#pragma once

#include <vector>

#include "livens/io/scenario.h"
#include "livens/io/scenario/bodies/meshes.h"
#include "livens/io/scenario/schema/section.h"

namespace livens::inline io_internal {

Key visual_key(const char* doc);
/// `color`, `opacity`.
std::vector<Key> color_keys(const char* color, const char* opacity);

/// `visual`, `color` and `opacity` of a body, or of the world: reports what is wrong without looking into
/// meshes.
bool check_look(const Section& section);

/// Of what check_look() found right, into the outline. What is wrong with meshes is reported where they are
/// named.
void read_look(const Section& section, MeshStore& meshes, Outline& outline);

}   // namespace livens::inline io_internal
