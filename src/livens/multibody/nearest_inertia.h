// SPDX-License-Identifier: BSD-3-Clause
// What is the nearest body to numbers that belong to none.
#pragma once

#include "livens/base/linear.h"

namespace [[gnu::visibility("default")]] livens {

/// The inertia nearest to a symmetric one that a body can have: E = (tr J / 2) 1 - J without its negative
/// part, which is the least change in the norm of E. As it is where J1 + J2 >= J3 but for 5e-13 of the
/// largest.
Matrix3 nearest_inertia(const Matrix3& inertia);

}   // namespace gnu::visibility("default")]]livens
