// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/body.h"
#include "livens/multibody/detail/joint_frame.h"

namespace livens {

/// Triads a of the first body (its own axes) and b of the second coincide at assembly. Then a1.b2, a2.b3 and
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
    const Matrix3 b = project_directors(transpose(directors(X_b)) * directors(X_a));
    static constexpr const char* labels[3] = {"axis 1", "axis 2", "axis 3"};
    for (int k = 0; k < 3; ++k) {
        Vector3 a{};
        a[k] = 1;
        hold_perpendicular(joint, a, b.column((k + 1) % 3), labels[k]);
    }
    return joint;
}

}   // namespace livens
