// SPDX-License-Identifier: BSD-3-Clause
// Three rows: two hold the axis, one keeps the point in the plane across it (theory.md, "Joints are quadratic
// forms").
#include "livens/multibody/joints/joint_frame.h"

namespace livens {

Joint planar(const std::string& name, int first, int second, const JointFrame& frame, double scale)
{
    JointFrame f = frame;
    Joint joint = start_joint(name, "planar", first, second, f, scale);
    normalise_axes(joint, f);
    const Slide slide = slide_of(joint, f);
    hold_axis(joint, f);
    hold_in_plane(joint, slide, slide.axis, "across", scale);
    joint.coordinates = {angle_coordinate(joint, f)};
    return joint;
}

}   // namespace livens
