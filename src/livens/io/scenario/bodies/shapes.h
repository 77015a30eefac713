// SPDX-License-Identifier: BSD-3-Clause
// `shape` of a body: primitives, meshes and unions of both.
#pragma once

#include "livens/io/scenario/bodies/meshes.h"
#include "livens/io/scenario/schema/section.h"
#include "livens/multibody/solid.h"

namespace livens::inline io_internal {

/// Who states the densities in kg/m^3: the body; the shape; or the body, but for those parts of a union that
/// have fields.
enum class DensityBy { body, shape, both };

/// What a shape comes to.
struct Solid {
    MassProperties properties;     ///< with the body's density, 1 kg/m^3 without one
    bool has_own_origin = false;   ///< its centre of mass is where it lies, not at the origin
    Outline outline;
    std::vector<NamedSurface> surfaces;   ///< in the coordinates of the shape
    std::vector<ShapePart> parts;         ///< of a union, likewise
    double volume = 0;                    ///< m^3
};

Table shape_table();
bool is_point_mass(const Section& body);
/// Reports what is wrong with a shape without looking into its meshes.
bool check_shape(const Section& shape);
/// Of the mesh's numbers, m.
double mesh_unit(const Section& shape);
/// Of one that check_shape() found right.
DensityBy density_by(const Section& shape);
/// Of a body; empty without a shape and for point masses. Surfaces of primitives are known if they are
/// wanted. Throws InputError.
Solid read_shape(const Section& body, MeshStore& meshes, bool with_surfaces);

}   // namespace livens::inline io_internal
