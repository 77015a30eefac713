// SPDX-License-Identifier: BSD-3-Clause
// Two rows: axes stay parallel, wherever the bodies are (theory.md, "Joints are quadratic forms").
#include "livens/multibody/joints/joint_frame.h"

namespace livens {

Joint parallel_axes(const std::string& name, int first, int second, const JointFrame& frame, double scale)
{
    JointFrame f = frame;
    Joint joint = start_joint(name, "parallel_axes", first, second, f, scale);
    normalise_axes(joint, f);
    hold_axis(joint, f);
    joint.coordinates = {angle_coordinate(joint, f)};
    return joint;
}

}   // namespace livens
