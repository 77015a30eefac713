// SPDX-License-Identifier: BSD-3-Clause
// [[controller]]: states with rates of their own, and what is said of them.
#pragma once

#include "livens/io/scenario/builder.h"
#include "livens/multibody/relocation.h"

namespace livens::inline io_internal {

/// Makes states, what changes them, and formulas that others may read; joints and sensors must be there.
/// Reports all it finds.
void read_controllers(Builder& builder);
/// Sensors of them, once loads are there.
void add_controller_sensors(Builder& builder);
/// What a part has beside loads and sensors joins the model around it. Throws InputError.
void take_controllers(const Builder& part, const Relocation& to, Builder& builder);

}   // namespace livens::inline io_internal
