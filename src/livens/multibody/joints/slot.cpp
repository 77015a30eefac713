// SPDX-License-Identifier: BSD-3-Clause
// A point on a curve of another body: two rows across the curve, its parameter eliminated inside of them
// (theory.md, "Coordinates of joints", Curves).
#include "livens/multibody/joints/joint_frame.h"

namespace livens {

Joint slot(const std::string& name, int first, int second, const Curve& curve, const Vector3& point_second,
           const Matrix34& X_first, const Matrix34& X_second, double scale)
{
    const Vector3 here = X_second * point(point_second) - X_first.column(0);
    JointFrame frame;
    frame.point_first = transpose(directors(X_first)) * here;
    frame.point_second = point_second;
    Joint joint = start_joint(name, "slot", first, second, frame, scale);
    joint.rows = curve_rows(curve, first, second, point(point_second), scale);
    constexpr int pieces = 240;
    const auto& place = curve.without_normals ? curve.without_normals : curve.at;
    for (int k = 0; k <= pieces; ++k)
        joint.path.push_back(place(curve.first + (curve.last - curve.first) * k / pieces).x);
    return joint;
}

}   // namespace livens
