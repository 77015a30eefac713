// SPDX-License-Identifier: BSD-3-Clause
// One row a . b = 0: two axes stay perpendicular (theory.md, "Joints are quadratic forms").
#include "livens/multibody/joints/joint_frame.h"

namespace livens {

Joint perpendicular_axes(const std::string& name, int first, int second, const JointFrame& frame,
                         double scale)
{
    JointFrame f = frame;
    Joint joint = start_joint(name, "perpendicular_axes", first, second, f, scale);
    normalise_axes(joint, f);
    hold_perpendicular(joint, f.axis_first, f.axis_second, "axis 1");
    return joint;
}

}   // namespace livens
