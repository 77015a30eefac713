// SPDX-License-Identifier: BSD-3-Clause
// One row a . b = cos(angle): two axes keep their angle, and nothing else is held. Its gradient is the cross
// product of the axes (theory.md, "Joints are quadratic forms").
#include <cmath>
#include <numbers>

#include "livens/base/elementary.h"
#include "livens/base/error.h"
#include "livens/multibody/joints/joint_frame.h"
#include "livens/multibody/wording.h"

namespace livens {

/// Where the axes are parallel the cosine has no slope, and the row would hold nothing.
Joint constant_angle(const std::string& name, int first, int second, const JointFrame& frame, double angle,
                     double scale)
{
    constexpr double smallest = 1e-6;
    if (!(angle >= smallest && angle <= std::numbers::pi - smallest))
        throw InputError({"joint-angle", "joint[" + name + "].angle",
                          "the angle between two axes must be between 0 and 180 degrees", to_text(angle),
                          "> 0 and < pi", "at its ends one constraint does not hold it",
                          "axes that stay parallel are a joint of type parallel_axes"});
    JointFrame f = frame;
    Joint joint = start_joint(name, "constant_angle", first, second, f, scale);
    normalise_axes(joint, f);
    joint.rows.push_back(inner_product_row(joint.first, direction(f.axis_first), joint.second,
                                           direction(f.axis_second), sine_cosine(angle).cosine, 1));
    joint.rows.back().label = "angle";
    return joint;
}

}   // namespace livens
