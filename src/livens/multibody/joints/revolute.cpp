// SPDX-License-Identifier: BSD-3-Clause
// Five rows: three hold the point, two the axis (theory.md, "Joints are quadratic forms").
#include "livens/multibody/joints/joint_frame.h"

namespace livens {

Joint revolute(const std::string& name, int first, int second, const JointFrame& frame, double scale)
{
    JointFrame f = frame;
    Joint joint = start_joint(name, "revolute", first, second, f, scale);
    normalise_axes(joint, f);
    hold_point(joint, scale);
    hold_axis(joint, f);
    joint.coordinates = {angle_coordinate(joint, f)};
    return joint;
}

}   // namespace livens
