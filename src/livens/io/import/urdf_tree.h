// SPDX-License-Identifier: BSD-3-Clause
// Links and joints of a URDF as bodies that are placed and move: which links are one body, where all stand at
// the coordinates that were asked for, and how fast.
#pragma once

#include <vector>

#include "livens/io/import.h"
#include "livens/io/import/urdf_file.h"

namespace livens::inline io_internal {

struct PlacedLink {
    int body = -1;                            ///< number of the body that it is part of; -1: the world
    Pose pose;                                ///< in the world
    Vector3 velocity{}, angular_velocity{};   ///< of its origin; world axes
};

/// A joint that moves.
struct PlacedJoint {
    int joint = 0;    ///< number in the file
    int first = -1;   ///< numbers of bodies; -1: the world
    int second = 0;
    Vector3 at{}, axis{};   ///< in the world
    double coordinate = 0, rate = 0;
};

struct UrdfTree {
    std::vector<PlacedLink> links;     ///< in the order of the file
    std::vector<int> frames;           ///< of each body the link whose frame it has
    std::vector<PlacedJoint> joints;   ///< from the root outwards, each below its parent
    std::vector<char> is_held;         ///< of the file's joints: fixed, or follows what does not move
};

/// Looks up all references. What is no tree, or asks for joints that are not there, is a finding.
UrdfTree place_links(const UrdfFile& file, const UrdfOptions& options, Losses& losses, Findings& findings);

}   // namespace livens::inline io_internal
