// SPDX-License-Identifier: BSD-3-Clause
// Between integrals over meshes and mass properties.
#pragma once

#include "livens/geometry/moments.h"
#include "livens/multibody/mass_properties.h"

namespace [[gnu::visibility("default")]] livens {

/// A solid of constant density, kg/m^3 (P19); with 1 a solid whose moments are weighted by density already.
MassProperties solid(double density, const Moments& moments);
/// The moments that a solid of density 1 kg/m^3 would have; those of laminae and needles have no volume to
/// speak of.
Moments moments(const MassProperties& properties);

/// Principal moments of inertia, ascending, and their directions as columns of a rotation matrix.
struct PrincipalAxes {
    Vector3 moments{};
    Matrix3 axes = identity<3>();
};
PrincipalAxes principal_axes(const Matrix3& inertia);

}   // namespace livens
