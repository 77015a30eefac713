// SPDX-License-Identifier: BSD-3-Clause
// Two rows: a point of one body stays on a line of the other (theory.md, "Joints are quadratic forms").
#include "livens/multibody/joints/joint_frame.h"

namespace livens {

Joint point_on_line(const std::string& name, int first, int second, const JointFrame& frame, double scale)
{
    JointFrame f = frame;
    f.axis_second = {0, 0, 1};   // may be a point mass, which has none
    Joint joint = start_joint(name, "point_on_line", first, second, f, scale);
    normalise_axes(joint, f);
    const Slide slide = slide_of(joint, f, joint.second != second);
    hold_on_line(joint, slide, scale);
    joint.coordinates = {displacement_coordinate(slide)};
    return joint;
}

}   // namespace livens
