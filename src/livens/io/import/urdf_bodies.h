// SPDX-License-Identifier: BSD-3-Clause
// Mass properties of the bodies that links become.
#pragma once

#include <vector>

#include "livens/io/import/urdf_tree.h"
#include "livens/multibody/mass_properties.h"

namespace livens::inline io_internal {

/// Mass of a body that has none, in the smallest mass of the others.
inline constexpr double massless = 1e-9;

/// Of each body in its own frame: the exact sum of its links. Inertias that belong to no body are mended by
/// the least change (unless they are to be left), bodies without mass get 1e-9 of the smallest.
std::vector<MassProperties> masses_of(const UrdfFile& file, const UrdfTree& tree,
                                      UrdfOptions::Inertias inertias, Losses& losses, Findings& findings);

/// The smallest mass that was stated.
double smallest_mass(const std::vector<MassProperties>& bodies);

}   // namespace livens::inline io_internal
