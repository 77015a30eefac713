// SPDX-License-Identifier: BSD-3-Clause
// Shapes that are stated by a few lengths.
#pragma once

#include "livens/geometry/primitive_solid.h"
#include "livens/io/scenario.h"
#include "livens/io/scenario/schema/section.h"

namespace livens::inline io_internal {

struct Primitive {
    Key key;
    MassProperties (*make)(double density, const Section& shape);
    Outline (*outline)(const Section& shape);
    PrimitiveSolid (*solid)(const Section& shape);
};
const std::vector<Primitive>& primitives();
const Primitive* find_primitive(std::string_view key);

}   // namespace livens::inline io_internal
