// SPDX-License-Identifier: BSD-3-Clause
// Four rows: three hold the point, one keeps the two axes of the cross perpendicular (theory.md, "Joints are
// quadratic forms"). The cross is where both axes are, so that each angle is one of the other body's axis
// across its own: theory.md, "Coordinates of joints", Universal and ball joints.
#include <utility>

#include "livens/multibody/joints/joint_frame.h"

namespace livens {

Joint universal(const std::string& name, int first, int second, const JointFrame& frame, double scale)
{
    JointFrame f = frame;
    Joint joint = start_joint(name, "universal", first, second, f, scale);
    normalise_axes(joint, f);
    hold_point(joint, scale);
    hold_perpendicular(joint, f.axis_first, f.axis_second, "axis 1");
    const Vector4 a = direction(f.axis_first), b = direction(f.axis_second);
    const AxisPair at_a = across_axis(f.axis_first), at_b = across_axis(f.axis_second);
    JointCoordinate of_cross =
        angle_between(joint.first, direction(at_a.u), direction(at_a.v), joint.second, b);
    // How far the cross, where a is, is turned against the second body: its angle the other way round.
    JointCoordinate of_second{{inner_product_row(joint.first, a, joint.second, direction(at_b.u), 0, 1),
                               inner_product_row(joint.first, a, joint.second, direction(-at_b.v), 0, 1)}};
    if (second == world) std::swap(of_cross, of_second);   // as the maker was told, see start_joint()
    joint.coordinates = {{"angle_1", std::move(of_cross)}, {"angle_2", std::move(of_second)}};
    return joint;
}

}   // namespace livens
