// SPDX-License-Identifier: BSD-3-Clause
// A cylindrical joint whose displacement follows its angle by the pitch: the fifth row is a coupling of both
// coordinates (theory.md, "Coordinates of joints").
#include <cmath>
#include <numbers>
#include <utility>

#include "livens/base/error.h"
#include "livens/multibody/joints/joint_frame.h"
#include "livens/multibody/wording.h"

namespace livens {

/// displacement - pitch / (2 pi) angle = 0, the angle counted from where the bodies stand.
Joint screw(const std::string& name, int first, int second, const JointFrame& frame, const Matrix34& X_first,
            const Matrix34& X_second, double pitch, double scale)
{
    if (pitch == 0 || !std::isfinite(pitch))
        throw InputError({"joint-pitch", "joint[" + name + "].pitch", "the pitch of a screw must not be zero",
                          to_text(pitch), "", "", "a screw without pitch is a revolute joint"});
    JointFrame f = frame;
    fix_across(f, first, second, X_first, X_second, name);
    Joint joint = start_joint(name, "screw", first, second, f, scale);
    normalise_axes(joint, f);
    const Slide slide = slide_of(joint, f);
    hold_axis(joint, f);
    hold_on_line(joint, slide, scale);
    joint.coordinates = {angle_coordinate(joint, f), displacement_coordinate(slide)};
    joint.rows.push_back(coupling_row({{-pitch / (2 * std::numbers::pi), joint.coordinates[0].coordinate},
                                       {1, joint.coordinates[1].coordinate}},
                                      0, scale, "thread"));
    return joint;
}

}   // namespace livens
