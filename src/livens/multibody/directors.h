// SPDX-License-Identifier: BSD-3-Clause
// What body and model ask of directors.
#pragma once

#include <string>

#include "livens/base/linear.h"

namespace livens::inline multibody_internal {

/// Throws InputError unless |D^T D - I| <= 1e-10 in every entry and det D > 0.
void check_directors(const Matrix3& directors, const std::string& path);

}   // namespace livens::inline multibody_internal
