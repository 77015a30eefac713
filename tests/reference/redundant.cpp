// SPDX-License-Identifier: BSD-3-Clause
// Reactions in a loop of joints that hold more than they need: they do not depend on the rows that were
// chosen.
#include "livens/diagnostics/sample.h"
#include "shipped.h"

namespace livens::tests::redundant_test {
namespace {

Model under(const Model& model, const Vector3& gravity)
{
    Model other(gravity);
    for (const Body& body : model.bodies()) other.add_body(body);
    for (const Joint& joint : model.joints()) other.add_joint(joint);
    return other;
}

/// Forces of all joints at all element ends.
std::vector<std::vector<Vector3>> forces(const Model& model, const Motion& motion)
{
    std::vector<std::vector<Vector3>> all;
    for (const double t : motion.mesh.ends) {
        all.emplace_back();
        for (const JointSample& joint : sample_joints(model, motion, t))
            all.back().push_back(joint.right.force);
    }
    return all;
}

/// Gravity across the plane of the linkage is carried by redundant rows alone. A choice of rows that changes
/// on the way makes forces jump by tens of newtons; the least ones are smooth.
TEST(Redundant, ReactionsOfAFourBarAcrossItsPlaneAreSmoothAndFlagged)
{
    const Shipped shipped = solve_example("four_bar");
    const Model model = under(shipped.model, {0, -5, -9.81});
    const TimeMesh mesh = make_time_mesh(0, 2, 100);
    const Solution s = solve(model, {model.start()}, mesh, Lobatto{4});
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_EQ(s.motion.redundant_rows.size(), 3u);
    const std::vector<std::vector<Vector3>> f = forces(model, s.motion);
    double bend = 0, weight = 0;
    for (const Body& body : model.bodies()) weight += 5 * body.mass(0, 0);
    for (std::size_t e = 1; e + 1 < f.size(); ++e) {
        double held = 0;
        for (std::size_t j = 0; j < f[e].size(); ++j) {
            bend = std::max(bend, std::abs((f[e + 1][j] - 2.0 * f[e][j] + f[e - 1][j])[1]));
            held += model.joints()[j].first == world ? f[e][j][1] : 0;
        }
        EXPECT_NEAR(held, weight, 1e-9 * weight) << "the world holds what gravity pulls across";
    }
    EXPECT_LT(bend, 6) << "second differences of forces across the plane, N";
    for (const JointSample& joint : sample_joints(model, s.motion, 1.0)) EXPECT_FALSE(joint.is_unique);
    // negative control: the multipliers of the chosen rows alone are another distribution
    const State state = s.motion.at_end(50);
    const std::span<const double> chosen(s.motion.end_multipliers.data() + 2 * 50 * model.n_rows(),
                                         model.n_rows());
    double apart = 0;
    for (int j = 0; j < 4; ++j)
        apart = std::max(apart, largest(joint_reaction(model, j, state.X, chosen).force - f[50][j]));
    EXPECT_GT(apart, 1e-3);
}

/// Doubled ball joints share their load in halves; a pendulum beside them is no part of the loop.
TEST(Redundant, DoubledJointsShareTheirLoad)
{
    Model model({0, 0, -9.81});
    const MassProperties rod = with_center(with_mass(box(1, {1, 0.1, 0.1}), 2.0), {0.5, 0, 0});
    Placement beside;
    beside.position = {0, 3, 0};
    model.add_body(rigid_body("door", rod));
    model.add_body(rigid_body("pendulum", rod, beside));
    model.add_joint(spherical("one", world, 0, {}));
    model.add_joint(spherical("two", world, 0, {}));
    JointFrame pivot;
    pivot.point_first = {0, 3, 0};
    model.add_joint(spherical("pivot", world, 1, pivot));
    const Solution s = solve(model, {model.start()}, make_time_mesh(0, 1, 40), Lobatto{4});
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    for (const double t : {0.0, 0.5, 1.0, 0.513}) {
        const std::vector<JointSample> joints = sample_joints(model, s.motion, t);
        EXPECT_LT(largest(joints[0].right.force - joints[1].right.force), 1e-9) << t;
        EXPECT_LT(largest(2.0 * joints[0].right.force - joints[2].right.force), 1e-6) << t;
        EXPECT_FALSE(joints[0].is_unique);
        EXPECT_FALSE(joints[1].is_unique);
        EXPECT_TRUE(joints[2].is_unique);
    }
}

}   // namespace
}   // namespace livens::tests::redundant_test
