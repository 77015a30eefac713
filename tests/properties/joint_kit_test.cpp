// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "livens/multibody/model.h"
#include "properties/joint_kit.h"

namespace livens::joint_kit_test {
namespace {

TEST(JointKit, EveryJointPasses)
{
    for (const JointCase& joint : joint_cases()) EXPECT_EQ(joined(check_joint(joint)), "");
}

TEST(JointKit, EveryFileOfAJointIsInTheRegistry)
{
    expect_sources_in(joint_cases(), "src/livens/multibody/joints", {"frame", "couplings"}, 15);
}

/// A slider, by rows alone: the library has no such joint. The point of the second body stays on a line of
/// the first, and the triads keep their angles.
Joint prismatic(int first, int second, const JointFrame& frame, const Matrix34& X_first,
                const Matrix34& X_second)
{
    Joint joint;
    joint.name = "slider";
    joint.type = "prismatic";
    joint.first = first;
    joint.second = second;
    if (second == world) std::swap(joint.first, joint.second);
    const Vector3 axis = (1 / norm(frame.axis_first)) * frame.axis_first;
    Vector3 u = cross(axis, std::abs(axis[0]) < 0.7 ? Vector3{1, 0, 0} : Vector3{0, 1, 0});
    u *= 1 / norm(u);
    const Vector3 v = cross(axis, u);
    const Vector4 a = point(frame.point_first), b = point(frame.point_second);
    joint.rows.push_back(plane_row(first, direction(u), a, second, b, 0, 1));
    joint.rows.push_back(plane_row(first, direction(v), a, second, b, 0, 1));
    const Matrix3 triad = transpose(directors(X_second)) * directors(X_first);
    for (int k = 0; k < 3; ++k) {
        Vector3 e{};
        e[k] = 1;
        const Vector4 across = direction(triad.column((k + 1) % 3));
        joint.rows.push_back(inner_product_row(first, direction(e), second, across, 0, 1));
    }
    const char* labels[5] = {"across 1", "across 2", "axis 1", "axis 2", "axis 3"};
    for (int r = 0; r < 5; ++r) joint.rows[r].label = labels[r];
    return joint;
}

JointFrame anywhere(Random& random, const Matrix34& X_first, const Matrix34& X_second)
{
    return joint_frame(X_first, X_second, random.vector(), random.unit());
}

JointCase prismatic_case() { return {"prismatic", 5, anywhere, prismatic}; }

TEST(JointKit, AJointMadeOfRowsAlonePasses)
{
    EXPECT_EQ(joined(check_joint(prismatic_case())), "");

    Random random(1);
    Model model;
    const Matrix34 X = random.rigid();
    model.add_body(rigid_body("b", box(1, {1, 2, 3}), {.position = X.column(0), .directors = directors(X)}));
    const JointFrame frame = anywhere(random, world_configuration, X);
    EXPECT_NO_THROW(model.add_joint(prismatic(world, 0, frame, world_configuration, X)));
    EXPECT_EQ(model.n_rows(), 5);
}

/// The slider with its rows changed after it is made.
JointCase broken(const std::function<void(std::vector<ConstraintRow>&)>& change)
{
    JointCase joint = prismatic_case();
    joint.make = [change](int first, int second, const JointFrame& frame, const Matrix34& X,
                          const Matrix34& Y) {
        Joint made = prismatic(first, second, frame, X, Y);
        change(made.rows);
        return made;
    };
    return joint;
}

using Rows = std::vector<ConstraintRow>;

TEST(JointKit, OneWrongSignFailsIt)
{
    const auto sign = [](Rows& rows) { rows[0].c_ii *= -1.0; };
    EXPECT_FALSE(check_joint_closure(broken(sign)).empty());
    EXPECT_FALSE(check_joint_closure(broken([](Rows& rows) { rows[2].c_ij(1, 2) *= -1; })).empty());
    EXPECT_FALSE(check_joint(broken(sign)).empty());
}

TEST(JointKit, AnAsymmetricCoefficientFailsTheGradient)
{
    // Phi does not see the antisymmetric part; the gradient does.
    EXPECT_FALSE(check_joint_gradient(broken([](Rows& rows) { rows[1].c_jj(1, 2) += 0.1; })).empty());
}

TEST(JointKit, ADoubledRowFailsTheRank)
{
    EXPECT_FALSE(check_joint_rank(broken([](Rows& rows) { rows[1] = rows[0]; })).empty());
}

TEST(JointKit, ARowTiedToTheWorldFailsObjectivity)
{
    JointCase joint = broken([](Rows& rows) { rows[0].b_j(0, 0) += 0.5; });
    EXPECT_FALSE(check_joint_objectivity(joint).empty());
}

TEST(JointKit, AForgottenWorldFails)
{
    JointCase joint = prismatic_case();
    joint.make = [](int first, int second, const JointFrame& frame, const Matrix34& X, const Matrix34& Y) {
        Joint made = prismatic(first, second, frame, X, Y);
        if (first == world) made.rows[0].c = 0;   // the folded constant
        return made;
    };
    EXPECT_FALSE(check_joint_world(joint).empty());
}

TEST(JointKit, ARepeatedLabelFails)
{
    EXPECT_FALSE(check_joint_labels(broken([](Rows& rows) { rows[1].label = rows[0].label; })).empty());
    EXPECT_FALSE(check_joint_labels(broken([](Rows& rows) { rows.pop_back(); })).empty());
}

TEST(JointKit, AnotherJointForExchangedBodiesFails)
{
    JointCase joint = prismatic_case();
    joint.make = [](int first, int second, const JointFrame& frame, const Matrix34& X, const Matrix34& Y) {
        JointFrame turned = frame;
        if (first > second)
            turned.axis_first = cross(frame.axis_first, {1, 0, 0});   // slides along another line
        return prismatic(first, second, turned, X, Y);
    };
    EXPECT_FALSE(check_joint_order(joint).empty());
}

}   // namespace
}   // namespace livens::joint_kit_test
