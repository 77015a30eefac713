// SPDX-License-Identifier: BSD-3-Clause
// [[point]]: places with names.
#pragma once

#include "livens/io/scenario/builder.h"

namespace livens::inline io_internal {

/// After the bodies. Reports all it finds.
void read_points(Builder& builder);
/// Where names of points stand for coordinates, puts these there, and the bodies that they tell, so that what
/// reads joints, drives, loads and sensors sees no names.
void tell_points(Builder& builder);

}   // namespace livens::inline io_internal
