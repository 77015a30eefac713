// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/detail/joint_frame.h"

namespace livens {

/// The axis of the second body is held perpendicular to two axes across the axis of the first. The rows also
/// admit the axis turned end for end; close_start() refuses that.
Joint revolute(const std::string& name, int first, int second, const JointFrame& frame, double scale)
{
    JointFrame f = frame;
    Joint joint = start_joint(name, "revolute", first, second, f, scale);
    normalise_axes(joint, f);
    joint.axis_first = f.axis_first;
    joint.axis_second = f.axis_second;
    hold_point(joint, scale);
    const AxisPair across = perpendicular_axes(f.axis_first);
    hold_perpendicular(joint, across.u, f.axis_second, "axis 1");
    hold_perpendicular(joint, across.v, f.axis_second, "axis 2");
    return joint;
}

}   // namespace livens
