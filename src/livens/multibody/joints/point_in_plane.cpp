// SPDX-License-Identifier: BSD-3-Clause
// One row: a point of one body stays in a plane of the other (theory.md, "Joints are quadratic forms").
#include "livens/multibody/joints/joint_frame.h"

namespace livens {

Joint point_in_plane(const std::string& name, int first, int second, const JointFrame& frame, double scale)
{
    JointFrame f = frame;
    f.axis_second = {0, 0, 1};   // may be a point mass, which has none
    Joint joint = start_joint(name, "point_in_plane", first, second, f, scale);
    normalise_axes(joint, f);
    const Slide slide = slide_of(joint, f, joint.second != second);
    hold_in_plane(joint, slide, slide.axis, "across", scale);
    return joint;
}

}   // namespace livens
