// SPDX-License-Identifier: BSD-3-Clause
// Joints whose frames miss each other by a little, as rounded drawings have it.
#pragma once

#include <functional>

#include "livens/multibody/joints.h"

namespace [[gnu::visibility("default")]] livens {

/// A joint brought to where its bodies stand.
struct FittedJoint {
    Joint joint;
    JointFrame frame;
    double shift = 0;   ///< of the point on the second body, m
    double turn = 0;    ///< of the axes on the second body, rad
};

/// The joint whose point and axes on the second body are moved by the least that closes its rows in X at an
/// instant; `make` builds it from a frame. Turns count by `length`. What no such move closes, as rows that
/// contradict each other or hold something else, stays open and is for consistent_start() to judge.
FittedJoint fit_joint(const std::function<Joint(const JointFrame&)>& make, const JointFrame& frame,
                      Instant at, const Configurations& X, double length);

}   // namespace livens
