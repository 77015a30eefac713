// SPDX-License-Identifier: BSD-3-Clause
// What becomes of a [[load]]: checks beyond single values, and makers, of the loads that have much to read.
// Short ones stand in load_kinds.cpp.
#pragma once

#include "livens/io/scenario/builder.h"
#include "livens/io/scenario/loads/load_kinds.h"

namespace livens::inline io_internal {

/// `point`, in axes of the body.
Vector3 point_of(const LoadSources& p);
/// Of a load along a joint: what `joint` and `coordinate` say, with the units of a length or an angle.
const NamedCoordinate& coordinate_of(const LoadSources& p);
/// X of all bodies at the start.
std::vector<Matrix34> places(const Builder& builder);

/// Whether elements end where laws bend: not those of other families, nor of those that are solved together
/// or against time.
bool ends_at_bends(const Builder& builder);

/// Names of loads that joints state themselves.
std::vector<std::string> names_of_joint_loads(const Builder& builder);
/// Adds these to the model; reports all it finds.
void read_joint_loads(Builder& builder);

/// `limits` of a joint, with what their springs are by default where a force along the coordinate moves this
/// inertia. Throws InputError `joint-limits` at path.
JointLimits read_limits(const Builder& builder, const Section& keys, const Joint& joint,
                        const NamedCoordinate& coordinate, double inertia, const std::string& path);

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
