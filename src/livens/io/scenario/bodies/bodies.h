// SPDX-License-Identifier: BSD-3-Clause
// [[body]]: bodies, their places, and how both are read wherever a scenario has a place.
#pragma once

#include <string>
#include <vector>

#include "livens/io/scenario/builder.h"

namespace livens::inline io_internal {

/// `directors`, `quaternion`, `rotation_vector`: of a body or a joint's frame.
std::vector<Key> orientation_keys();
bool check_orientation(const Section& section);
Matrix3 read_orientation(const Section& section);

// Position, orientation and velocities of a body, at the start ([[body]]) or at the end ([body.end]).
bool check_pose(const Section& body);
/// Throws InputError. Of `director_rates` it knows nothing.
/// `stretch`: of a body whose orientation may be told by others than its directors.
Placement read_placement(const Section& body, const Matrix3& stretch = identity<3>());

/// Whether loads ask for surfaces of bodies, whose moments cost a quadrature.
bool has_surface_loads(const Section& top);
/// Reports all it finds.
void read_bodies(Builder& builder, bool with_surfaces);
/// What is drawn of the world, behind the outlines of all bodies.
void read_world(Builder& builder);

}   // namespace livens::inline io_internal
