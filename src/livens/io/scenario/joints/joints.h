// SPDX-License-Identifier: BSD-3-Clause
// [[joint]], [[drive]], [[sensor]], and what refers to joints, their frames and coordinates.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "livens/io/scenario/builder.h"

namespace livens::inline io_internal {

/// `from` and `until` of a joint or drive, as far as they are inside the time.
void read_times(Builder& builder, const Section& section, Joint& joint);

/// Strings with units, here and in tables inside, must have those of the coordinate: of an angle the key's
/// other unit. Throws InputError (`unit`).
void check_units(const Section& section, bool is_angle, const std::string& path);

/// `coordinate`: which of a joint's, for drives and loads.
Key coordinate_key();
/// What `joint` and `coordinate` of a section refer to; valid until a joint is added.
struct JointReference {
    const Joint* joint;
    const NamedCoordinate* coordinate;
};
/// Of a ball joint, while it is driven (from, until): the second of three angles goes no farther than a
/// quarter turn, a component of the rotation vector no farther than 175 degrees. Throws InputError
/// (`drive-angle`).
void check_driven_angle(const JointReference& of, const TimeFunction& law,
                        const std::array<double, 2>& during, const std::string& path);
/// Throws InputError (`joint-unknown`, `joint-coordinate`) at path.joint.
JointReference find_coordinate(const Builder& builder, const Section& section, const std::string& path);

/// `over`: the points of a rope.
Key over_key();
/// What `over` of a section says, in axes of the bodies; none where something is wrong, which is told.
std::optional<std::vector<BodyPoint>> read_over(Builder& builder, const Section& section);

/// `frames`: one for each of two bodies.
Key frames_key(const std::string& heading, const std::string& doc);
bool check_frames(const Section& section);

/// Where `points` of a joint or load lie outside of a body's shape, and as places in the world would not.
void warn_of_world_points(Builder& builder, const Section& section, const std::array<int, 2>& bodies);

/// A joint between coordinates of others, which are in the model already.
void read_coupling(Builder& builder, const Section& section, const std::string& name,
                   const std::string& path);

/// A rod over several points.
void read_rope(Builder& builder, const Section& section, const std::string& name, const std::string& path);

// Each reports all it finds.
void read_joints(Builder& builder);
void read_drives(Builder& builder);   ///< after the joints
void read_stops(Builder& builder);    ///< after both; also `limits` of joints
/// Whether `limits` in a joint, or its table for a coordinate, are stops; else springs, or there are none.
bool are_rigid_limits(const Section& keys);
/// Those of loads follow the loads, whose expressions may read the others.
void read_sensors(Builder& builder, bool of_loads);

}   // namespace livens::inline io_internal
