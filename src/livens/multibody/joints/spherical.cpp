// SPDX-License-Identifier: BSD-3-Clause
// Three rows hold a point, linear in X: theory.md, "Joints are quadratic forms".
#include "livens/multibody/joints/joint_frame.h"

namespace livens {

Joint spherical(const std::string& name, int first, int second, const JointFrame& frame, double scale)
{
    JointFrame f = frame;
    Joint joint = start_joint(name, "spherical", first, second, f, scale);
    hold_point(joint, scale);
    return joint;
}

}   // namespace livens
