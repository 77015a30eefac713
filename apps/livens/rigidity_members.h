// SPDX-License-Identifier: BSD-3-Clause
// Triads and tensors in JSON.
#pragma once

#include "livens/diagnostics/rigidity.h"
#include "livens/io/json.h"
#include "livens/multibody/body.h"

namespace livens::program {

/// A list of the columns.
void add_triad(JsonWriter& json, const char* key, const Matrix3& d);
/// `rigidity`: the multipliers, N m; `mean_stress`: by the body's volume, Pa, null where nobody knows it.
void rigidity_members(JsonWriter& json, const Body& body, const RigiditySample& s);

}   // namespace livens::program
