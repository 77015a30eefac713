// SPDX-License-Identifier: BSD-3-Clause
// A joint of constant velocity as one quadratic row: theory.md, "Joints are quadratic forms", Equal turns.
#include "livens/multibody/joints/joint_frame.h"

namespace livens {

/// Both shafts have turned by the same angle if and only if one follows from the other by a bend alone, a
/// turn about an axis across both. In terms of its quaternion (s, q) from triad x1, y1, z1 = axis to
/// x2, y2, z2: x1 . y2 - y1 . x2 = -4 s q_z, and a bend is less than half a turn.
Joint constant_velocity(const std::string& name, int first, int second, const JointFrame& frame,
                        const Matrix34& X_first, const Matrix34& X_second, double scale)
{
    JointFrame f = frame;
    fix_across(f, first, second, X_first, X_second, name);
    Joint joint = start_joint(name, "constant_velocity", first, second, f, scale);
    normalise_axes(joint, f);
    hold_point(joint, scale);
    const Vector3 x1 = f.across_first, x2 = f.across_second;
    const Vector3 y1 = cross(f.axis_first, x1), y2 = cross(f.axis_second, x2);
    ConstraintRow row = inner_product_row(joint.first, direction(x1), joint.second, direction(y2), 0, 1);
    const ConstraintRow other =
        inner_product_row(joint.first, direction(y1), joint.second, direction(x2), 0, 1);
    // The difference of two forms of the same pair is a form again, so the row stays quadratic.
    row.c_ij -= other.c_ij;
    row.b_j -= other.b_j;
    row.label = "turn";
    joint.rows.push_back(row);
    return joint;
}

}   // namespace livens
