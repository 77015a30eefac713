// SPDX-License-Identifier: BSD-3-Clause
// Rows and twists at one configuration in the coordinates of another, for factors that were made there.
#pragma once

#include "livens/dynamics/rows/body_tables.h"

namespace livens::inline spacetime_internal {

/// y, scaled rows (scaled twists) of all bodies by the maps of one configuration, to those by the maps of
/// another: in world axes forces and moments about the reference points (velocities and spins) stay what they
/// are (docs/theory.md, "Newton's iteration").
void carry_rows(const BodyTables& bodies, const double* maps_from, const double* maps_to, double* y);
void carry_twists(const BodyTables& bodies, const double* maps_from, const double* maps_to, double* y);

}   // namespace livens::inline spacetime_internal
