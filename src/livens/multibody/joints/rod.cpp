// SPDX-License-Identifier: BSD-3-Clause
// One distance row, 1/2 (|x_j - x_i|^2 - l^2) = 0 (P27): theory.md, "Joints are quadratic forms".
#include "livens/base/error.h"
#include "livens/multibody/joints/joint_frame.h"
#include "livens/multibody/wording.h"

namespace livens {

Joint rod(const std::string& name, int first, int second, const JointFrame& frame, double length)
{
    if (!(length > 0) || !std::isfinite(length))
        throw InputError({"rod-length", "joint[" + name + "]", "the length of a rod must be positive",
                          to_text(length), "> 0", "", "points that coincide are a spherical joint"});
    JointFrame f = frame;
    Joint joint = start_joint(name, "rod", first, second, f, length);
    joint.rows.push_back(
        distance_row(joint.first, point(joint.point_first), joint.second, point(joint.point_second), length));
    return joint;
}

}   // namespace livens
