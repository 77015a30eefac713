// SPDX-License-Identifier: BSD-3-Clause
// What becomes of a [[load]]: checks beyond single values, and makers, of the loads that have much to read.
// Short ones stand in load_kinds.cpp.
#pragma once

#include "livens/io/scenario/loads/load_kinds.h"

namespace livens::inline io_internal {

/// `point`, in axes of the body.
Vector3 point_of(const LoadSources& p);
/// Of a load along a joint: what `joint` and `coordinate` say, with the units of a length or an angle.
const NamedCoordinate& coordinate_of(const LoadSources& p);
/// X of all bodies at the start.
std::vector<Matrix34> places(const Builder& builder);

// False after an error.
bool check_value(const Section& load);
bool check_field(const Section& load);
bool check_spring(const Section& load);
bool check_bushing(const Section& load);

// Each throws InputError.
Load make_force(const LoadSources& p);
Load make_torque(const LoadSources& p);
Load make_actuator(const LoadSources& p);
Load make_spring(const LoadSources& p);
Load make_bushing(const LoadSources& p);
Load make_traction(const LoadSources& p);
Load make_pressure(const LoadSources& p);
Load make_body_force(const LoadSources& p);

}   // namespace livens::inline io_internal
