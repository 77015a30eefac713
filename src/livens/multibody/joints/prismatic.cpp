// SPDX-License-Identifier: BSD-3-Clause
// Five rows: no turn, and the point on a line (theory.md, "Joints are quadratic forms").
#include "livens/multibody/joints/joint_frame.h"

namespace livens {

/// The three rotations are held one by one: two by the axis, the third about it.
Joint prismatic(const std::string& name, int first, int second, const JointFrame& frame,
                const Matrix34& X_first, const Matrix34& X_second, double scale)
{
    JointFrame f = frame;
    fix_across(f, first, second, X_first, X_second, name);
    Joint joint = start_joint(name, "prismatic", first, second, f, scale);
    normalise_axes(joint, f);
    const Slide slide = slide_of(joint, f);
    hold_axis(joint, f);
    hold_spin(joint, f);
    hold_on_line(joint, slide, scale);
    joint.coordinates = {displacement_coordinate(slide)};
    return joint;
}

}   // namespace livens
