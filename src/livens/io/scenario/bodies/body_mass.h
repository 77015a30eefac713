// SPDX-License-Identifier: BSD-3-Clause
// What a body weighs, and where its shape lies in it.
#pragma once

#include <vector>

#include "livens/io/scenario/bodies/shapes.h"

namespace livens::inline io_internal {

/// The paper's M, S, E.
bool has_moments(const Section& body);
/// Reports what does not go together: mass and inertia must follow from exactly one set of keys.
void check_mass(const Section& body);

// Of a body that check_mass() found right.
Matrix4 read_moments(const Section& body);
MassProperties read_mass(const Section& body, const Solid& shape);
/// Surfaces are computed in the shape's own coordinates, and move with its centre.
std::vector<NamedSurface> surfaces_in_body(const Section& body, const Solid& shape);
/// Likewise, and with the body's mass where that is stated. What they weigh is unknown beside `inertia`.
std::vector<ShapePart> parts_in_body(const Section& body, const Solid& shape);
/// Outlines are drawn about the body's centre of mass, and those of shapes about their own.
Outline outline_in_body(const Section& body, const Solid& shape);

}   // namespace livens::inline io_internal
