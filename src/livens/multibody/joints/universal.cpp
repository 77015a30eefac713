// SPDX-License-Identifier: BSD-3-Clause
// Four rows: three hold the point, one keeps the two axes of the cross perpendicular (theory.md, "Joints are
// quadratic forms").
#include "livens/multibody/joints/joint_frame.h"

namespace livens {

Joint universal(const std::string& name, int first, int second, const JointFrame& frame, double scale)
{
    JointFrame f = frame;
    Joint joint = start_joint(name, "universal", first, second, f, scale);
    normalise_axes(joint, f);
    hold_point(joint, scale);
    hold_perpendicular(joint, f.axis_first, f.axis_second, "axis 1");
    return joint;
}

}   // namespace livens
