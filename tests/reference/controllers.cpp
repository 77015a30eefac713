// SPDX-License-Identifier: BSD-3-Clause
// Controllers of the examples against their equations, solved without livens: the numbers are those of
// Dormand and Prince's 8(5,3) with tolerances of 1e-13, piece by piece where a law bends.
#include <gtest/gtest.h>

#include <cmath>

#include "livens/multibody/controllers.h"
#include "reference/shipped.h"

namespace livens::tests::controllers_test {
namespace {

/// States by their names' order, at an end of the motion.
std::vector<double> states_at(const Shipped& s, double t)
{
    std::vector<double> values;
    for (const NamedState& one : states_in(s.model, s.at(t).V)) values.push_back(one.value);
    return values;
}

double angle(const Shipped& s, double t)
{
    const State state = s.at(t);
    return coordinate_value(s.model.joints()[0].coordinates[0].coordinate, state.X);
}

TEST(ControllerExamples, MotorControl)
{
    const Shipped s = solve_example("motor_control");
    EXPECT_NEAR(angle(s, 2), 0.416244215716469, 1e-10);
    const std::vector<double> z = states_at(s, 2);
    ASSERT_EQ(z.size(), 3u);
    EXPECT_NEAR(z[0], 0.265993022070594, 1e-10);
    EXPECT_NEAR(z[1], 0.0834517580457937, 1e-10);
    EXPECT_NEAR(z[2], 7.80900567157475, 1e-9);
}

TEST(ControllerExamples, HydraulicCylinder)
{
    const Shipped s = solve_example("hydraulic_cylinder");
    EXPECT_NEAR(s.at(1).X[0](2, 0), 0.18030323708116, 1e-10);
    EXPECT_NEAR(s.at(1).V[0](2, 0), 0.225933507496695, 1e-9);
    const std::vector<double> z = states_at(s, 1);
    ASSERT_EQ(z.size(), 2u);
    EXPECT_NEAR(z[0], 6925164.47131097, 0.1);
    EXPECT_NEAR(z[1], 3366940.79034796, 0.1);
}

TEST(ControllerExamples, TyreRelaxation)
{
    const Shipped s = solve_example("tyre_relaxation");
    EXPECT_LT(norm(s.at(4).X[0].column(0) - Vector3{99.2999399319588, 6.60738310777793, 0}), 1e-8);
    const std::vector<double> z = states_at(s, 4);
    ASSERT_EQ(z.size(), 2u);
    EXPECT_NEAR(z[0], -1993.48399230287, 1e-5);
    EXPECT_NEAR(z[1], -2736.08881966681, 1e-5);
}

/// 200 intervals, and the recursion between them.
TEST(ControllerExamples, SampledControl)
{
    const Shipped s = solve_example("sampled_control");
    EXPECT_NEAR(angle(s, 2), 0.462283234829552, 1e-12);
    const std::vector<double> z = states_at(s, 2);
    ASSERT_EQ(z.size(), 3u);
    EXPECT_NEAR(z[0], 0.187571949391334, 1e-12);
    EXPECT_NEAR(z[1], 0.0377167651704476, 1e-12);
    EXPECT_NEAR(z[2], 3.49502253169681, 1e-9);
}

}   // namespace
}   // namespace livens::tests::controllers_test
