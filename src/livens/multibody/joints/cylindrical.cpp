// SPDX-License-Identifier: BSD-3-Clause
// Four rows: two hold the direction of the axis, two the point on the line (theory.md, "Joints are quadratic
// forms").
#include "livens/multibody/joints/joint_frame.h"

namespace livens {

Joint cylindrical(const std::string& name, int first, int second, const JointFrame& frame, double scale)
{
    JointFrame f = frame;
    Joint joint = start_joint(name, "cylindrical", first, second, f, scale);
    normalise_axes(joint, f);
    const Slide slide = slide_of(joint, f);
    hold_axis(joint, f);
    hold_on_line(joint, slide, scale);
    joint.coordinates = {angle_coordinate(joint, f), displacement_coordinate(slide)};
    return joint;
}

}   // namespace livens
