// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/joints/fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/multibody/random_states.h"

namespace livens::fit_test {
namespace {

/// Two bodies that stand anywhere, and a frame that both share but for a small miss.
struct Pair {
    std::vector<Matrix34> X;
    JointFrame frame;

    Pair(Random& random, double miss) : X{random.rigid(), random.rigid()}
    {
        const Vector3 axis = random.unit();
        frame = joint_frame(X[0], X[1], random.vector(), axis);
        const Vector3 across = cross(axis, random.unit());
        frame.across_first = transpose(directors(X[0])) * across;
        frame.across_second = transpose(directors(X[1])) * across;
        frame.point_second += miss * random.vector();
        frame.axis_second = directors_from_rotation_vector(miss * random.vector()) * frame.axis_second;
    }

    double violation(const Joint& joint) const
    {
        double worst = 0;
        for (const ConstraintRow& row : joint.rows)
            worst = std::max(worst, std::abs(constraint_value(row, Configurations(X))));
        return worst;
    }
};

using Maker = Joint (*)(const std::string&, int, int, const JointFrame&, double);

TEST(Fit, ClosesJointsThatMissByALittle)
{
    Random random(1);
    for (const auto& [make, name] : {std::pair<Maker, const char*>{revolute, "revolute"},
                                     {cylindrical, "cylindrical"},
                                     {planar, "planar"},
                                     {spherical, "spherical"}})
        for (int n = 0; n < 50; ++n) {
            const Pair pair(random, 1e-7);
            const auto build = [make = make](const JointFrame& frame) { return make("j", 0, 1, frame, 1); };
            EXPECT_GT(pair.violation(build(pair.frame)), 1e-10) << name << ": negative control";
            const FittedJoint fitted = fit_joint(build, pair.frame, {}, Configurations(pair.X), 1);
            EXPECT_LT(pair.violation(fitted.joint), 3e-15) << name;
            EXPECT_LT(fitted.shift, 4e-7) << name;
            EXPECT_LT(fitted.turn, 4e-7) << name;
        }
}

/// The point of a pipe slides along it: how far it stands along is no miss.
TEST(Fit, LeavesWhatIsFree)
{
    Random random(2);
    Pair pair(random, 0);
    pair.frame.point_second += 0.3 * pair.frame.axis_second;
    const auto build = [](const JointFrame& frame) { return cylindrical("j", 0, 1, frame, 1); };
    const FittedJoint fitted = fit_joint(build, pair.frame, {}, Configurations(pair.X), 1);
    EXPECT_LT(fitted.shift, 1e-15);
    EXPECT_LT(fitted.turn, 1e-15);
}

/// Shift and turn together are the least: of a hinge that is off along its axis the shift is that alone.
TEST(Fit, MovesByTheLeast)
{
    Random random(3);
    Pair pair(random, 0);
    pair.frame.point_second += 1e-6 * pair.frame.axis_second;
    const auto build = [](const JointFrame& frame) { return revolute("j", 0, 1, frame, 1); };
    const FittedJoint fitted = fit_joint(build, pair.frame, {}, Configurations(pair.X), 1);
    EXPECT_NEAR(fitted.shift, 1e-6, 1e-13);
    EXPECT_LT(fitted.turn, 1e-13);
}

}   // namespace
}   // namespace livens::fit_test
