// SPDX-License-Identifier: BSD-3-Clause
#include "livens/stepping/step_equations.h"

#include <gtest/gtest.h>

#include <random>

#include "stepping_models.h"

namespace livens {

static void PrintTo(SteppingRule rule, std::ostream* out)
{
    *out << (rule == SteppingRule::midpoint ? "midpoint" : "endpoint");
}

namespace step_equations_test {
namespace {

using namespace stepping_test;

/// Two bricks on a ball and a universal joint with a spring and damper, a torque in each frame, and a point
/// mass on a rod.
Model loaded_model()
{
    Model model = two_bricks();
    const Matrix34 X1 = model.bodies()[0].X, X2 = model.bodies()[1].X;
    JointFrame cross = joint_frame(X1, X2, {1, 0, 0}, {1, 0, 0});
    cross.axis_second = {
        0.6, 0, 0.8};   // perpendicular to the first axis in the world: both turned, C_ij not symmetric
    model.add_joint(universal("cross", 0, 1, cross));
    model.add_body(point_mass("dot", 0.7, {1, 1.5, 0.2}));
    model.add_joint(rod("rod", 1, 2, {}, std::sqrt(1.5 * 1.5 + 0.04)));
    model.add_load(spring_damper("spring", 0, {0.2, 0.1, 0}, 1, {0.3, 0, 0.1}, {40, 3, 0.5}));
    model.add_load(spring_damper("cord", 2, {0, 0, 0}, world, {2, 2, 2}, {10, 1, 0.3}));
    model.add_load(torque("twist", 0, {0.3, -0.2, 0.9}, Frame::inertial));
    model.add_load(torque("motor", 1, {0.5, 0.1, -0.4}, Frame::body_fixed));
    model.add_load(point_force("push", 1, {0.4, 0.2, 0.1}, {1.0, 2.0, -1.0}, Frame::body_fixed));
    return model;
}

class StepTangent : public testing::TestWithParam<SteppingRule> {};

TEST_P(StepTangent, MatchesDifferences)
{
    const Model model = loaded_model();
    const ConsistentStart assembly = consistent_start(model, model.start(), StartPolicy::check);
    const StepEquations equations(model, assembly, GetParam());
    StepStart start{0.1, 0.3, assembly.start.X, assembly.start.V};
    std::mt19937 random(7);
    std::uniform_real_distribution<double> some(-0.3, 0.3);
    std::vector<double> x(equations.size());
    for (double& value : x) value = some(random);

    const int n = equations.size();
    std::vector<double> tangent(n * n, 0.0);
    for (const SparseEntry& e : equations.evaluate(start, x).tangent)
        tangent[e.row + n * e.column] += e.value;
    double largest = 0;
    for (int c = 0; c < n; ++c) {
        const double step = 1e-4;
        std::vector<double> up = x, down = x, up2 = x, down2 = x;
        up[c] += step;
        down[c] -= step;
        up2[c] += 2 * step;
        down2[c] -= 2 * step;
        const auto f = [&](const std::vector<double>& at) { return equations.evaluate(start, at).residual; };
        const auto a = f(up), b = f(down), a2 = f(up2), b2 = f(down2);
        for (int r = 0; r < n; ++r) {
            const double difference = (8 * (a[r] - b[r]) - (a2[r] - b2[r])) / (12 * step);
            EXPECT_NEAR(tangent[r + n * c], difference, 1e-8) << r << ' ' << c;
            largest = std::max(largest, std::abs(difference));
        }
    }
    EXPECT_GT(largest, 0.5);
}

INSTANTIATE_TEST_SUITE_P(Rules, StepTangent, testing::Values(SteppingRule::midpoint, SteppingRule::endpoint));

TEST(StepEquations, NamesTheRowThatIsWorst)
{
    const Model model = two_bricks();
    const ConsistentStart assembly = consistent_start(model, model.start(), StartPolicy::check);
    const StepEquations equations(model, assembly, SteppingRule::midpoint);
    ASSERT_EQ(equations.size(), 24 + 6 + 12);
    std::vector<double> residual(equations.size(), 0.0);
    EXPECT_EQ(equations.worst_residual(residual).name, "");
    residual[24 + 4] = -3;
    EXPECT_EQ(equations.worst_residual(residual).name, "joint 'lower' (row 'y')");
    EXPECT_EQ(equations.worst_residual(residual).value, 3);
    residual[12] = 1e3;
    EXPECT_EQ(equations.worst_residual(residual).name, "the momentum of body 'two'");
    residual[24 + 6 + 7] = 1e6;
    EXPECT_EQ(equations.worst_residual(residual).name, "the rigidity of body 'two'");
}

}   // namespace
}   // namespace step_equations_test
}   // namespace livens
