// SPDX-License-Identifier: BSD-3-Clause
// Rows and twists at one configuration in the coordinates of another, for factors that were made there.
#pragma once

#include "livens/dynamics/rows/body_tables.h"

namespace livens::inline spacetime_internal {

/// Where twists and rows are scaled: bodies, and their maps at a configuration.
struct Scaling {
    const BodyTables& bodies;
    const double* maps;
};

/// y, scaled rows (scaled twists) of all bodies at one configuration, to those at another: in world axes
/// forces and moments about the reference points (velocities and spins) stay what they are (docs/theory.md,
/// "Newton's iteration").
void carry_rows(const Scaling& from, const Scaling& to, double* y);
void carry_twists(const Scaling& from, const Scaling& to, double* y);

}   // namespace livens::inline spacetime_internal
