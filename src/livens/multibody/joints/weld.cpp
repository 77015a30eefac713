// SPDX-License-Identifier: BSD-3-Clause
// Six rows: no motion between two bodies. The three of the rotation also hold at half turns about the axes;
// the branch, the trace of the turn, tells these apart (theory.md, "Joints are quadratic forms").
#include "livens/multibody/body.h"
#include "livens/multibody/joints/joint_frame.h"

namespace livens {

namespace {

/// Columns across, axis x across, axis.
Matrix3 triad(const Vector3& axis, const Vector3& across)
{
    Matrix3 columns;
    columns.set_column(0, across);
    columns.set_column(1, cross(axis, across));
    columns.set_column(2, axis);
    return columns;
}

}   // namespace

/// Triads a of the first body (its own axes) and b of the second coincide at assembly, or where those of the
/// frame do. Then a1.b2, a2.b3 and
/// a3.b1 hold the three rotations independently: a turn w of the second body changes them by -w.b3, -w.b1 and
/// -w.b2.
Joint weld(const std::string& name, int first, int second, const JointFrame& frame, const Matrix34& X_first,
           const Matrix34& X_second, double scale)
{
    JointFrame f = frame;
    Joint joint = start_joint(name, "weld", first, second, f, scale);
    const bool exchanged = joint.second != second;
    const Matrix34& X_a = joint.first == world ? world_configuration : X_first;
    const Matrix34& X_b = exchanged ? X_first : X_second;
    hold_point(joint, scale);
    Matrix3 b = project_directors(transpose(directors(X_b)) * directors(X_a));
    if (dot(f.across_first, f.across_first) > 0 && dot(f.across_second, f.across_second) > 0) {
        normalise_axes(joint, f);
        // A stated frame holds instead of the present orientation, which may miss it by a little.
        b = triad(f.axis_second, f.across_second) * transpose(triad(f.axis_first, f.across_first));
    }
    static constexpr const char* labels[3] = {"axis 1", "axis 2", "axis 3"};
    for (int k = 0; k < 3; ++k) {
        Vector3 a{};
        a[k] = 1;
        hold_perpendicular(joint, a, b.column((k + 1) % 3), labels[k]);
    }
    ConstraintRow trace =
        inner_product_row(joint.first, {}, joint.second, {}, 0, 1);   // of the turn from a to b
    for (int k = 0; k < 3; ++k) {
        Vector3 a{};
        a[k] = 1;
        const ConstraintRow part =
            inner_product_row(joint.first, direction(a), joint.second, direction(b.column(k)), 0, 1);
        trace.c_ij += part.c_ij;
        trace.b_j += part.b_j;
    }
    trace.label = "turn";
    joint.branches = {trace};
    return joint;
}

}   // namespace livens
