// SPDX-License-Identifier: BSD-3-Clause
// What becomes of a [[load]]: its checks beyond single values, and the loads.
#pragma once

#include "livens/io/scenario/loads/load_kinds.h"

namespace livens {

// False after an error.
bool check_value(const Section& load);
bool check_field(const Section& load);
bool check_spring(const Section& load);
bool check_bushing(const Section& load);
bool check_drag(const Section& load);

// Each throws InputError.
Load make_force(const LoadSources& p);
Load make_torque(const LoadSources& p);
Load make_actuator(const LoadSources& p);
Load make_spring(const LoadSources& p);
Load make_bushing(const LoadSources& p);
Load make_drag(const LoadSources& p);
Load make_attraction(const LoadSources& p);
Load make_traction(const LoadSources& p);
Load make_pressure(const LoadSources& p);
Load make_body_force(const LoadSources& p);

}   // namespace livens
