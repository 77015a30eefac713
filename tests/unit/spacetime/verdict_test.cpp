// SPDX-License-Identifier: BSD-3-Clause
// solve() judges what it hands back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "livens/multibody/model.h"
#include "livens/spacetime/solve.h"

namespace livens::verdict_test {
namespace {

/// A pendulum of length 2: a box on a rod, let go at the given angle from straight down.
Model pendulum(double angle)
{
    Model model({0, 0, -9.81});
    Placement placement;
    placement.position = {2 * std::sin(angle), 0, -2 * std::cos(angle)};
    model.add_body(rigid_body("bob", box(1000, {0.1, 0.2, 0.3}), placement));
    model.add_joint(rod("rod", world, 0, {}, 2));
    return model;
}

Solution solved(const Model& model, const Method& method, double end, int elements)
{
    return solve(model, {model.start()}, make_time_mesh(0, end, elements), method);
}

bool speaks_of(const std::vector<std::string>& texts, const std::string& word)
{
    return std::ranges::any_of(texts,
                               [&](const std::string& text) { return text.find(word) != std::string::npos; });
}

const Method every_method[] = {Lobatto{1}, Lobatto{4}, Radau{2}, Radau{5}, Mixed{}, Midpoint{}, Endpoint{}};

TEST(Verdict, OfAGoodRunHasFiguresAndNoReason)
{
    const Model model = pendulum(1);
    for (const Method& method : every_method) {
        const bool is_coarse = std::holds_alternative<Endpoint>(method);
        const Solution s = solved(model, method, 1, is_coarse ? 1000 : 50);
        EXPECT_TRUE(s.report.converged()) << s.report.message;
        EXPECT_TRUE(s.verdict.reasons.empty());
        EXPECT_LT(s.verdict.energy_drift, is_coarse ? 0.05 : 0.01);
        EXPECT_LT(s.verdict.zigzag_positions, 0.01);
        EXPECT_GT(s.verdict.balance.largest_kinetic, 0);
    }
}

TEST(Verdict, TakesFiguresThatWereMeasuredOnTheWayOfThatMotionAlone)
{
    const Model model = pendulum(1);
    const Solution s = solved(model, Lobatto{4}, 1, 50), coarse = solved(model, Lobatto{4}, 1, 5);
    const auto judged = [](const Model& of, const Solution& solution, const Measured* measured) {
        return judge(of, solution.motion, solution.report, {}, {}, {}, {}, {}, measured);
    };
    const Measured own(model, s.motion), other(model, coarse.motion);
    ASSERT_NE(s.verdict.energy_drift, coarse.verdict.energy_drift);
    EXPECT_TRUE(own.is_of(model, s.motion));
    EXPECT_EQ(judged(model, s, &own).energy_drift, s.verdict.energy_drift);
    EXPECT_EQ(judged(model, s, &other).energy_drift, s.verdict.energy_drift);
    Model changed = model;
    changed.add_load(point_force("push", 0, {}, {1, 0, 0}, Frame::inertial));
    const Solution copy = s;
    EXPECT_FALSE(own.is_of(changed, s.motion)) << "another model";
    EXPECT_FALSE(own.is_of(model, copy.motion)) << "another motion, which may have been written to";
}

TEST(Verdict, OfASwingWhoseElementsEndAtRestHasNoReason)
{
    // from turning point to turning point of a pendulum let go from the horizontal: nothing moves at the ends
    Model model({0, -9.81, 0});
    model.add_body(point_mass("bob", 1, {-1, 0, 0}));
    model.add_joint(rod("rod", world, 0, {}, 1));
    const Solution s = solved(model, Lobatto{12}, 10 * 2.36784194757623745, 20);
    EXPECT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_EQ(s.motion.n_elements(), 20);
    EXPECT_LT(std::ranges::max(balance(model, s.motion).kinetic), 1e-6) << "else it shows nothing";
    EXPECT_GT(s.verdict.balance.largest_kinetic, 0.9 * 9.81) << "of which 9.81 J are reached in between";
    EXPECT_LT(s.verdict.balance.largest_kinetic, 9.82);
    EXPECT_LT(s.verdict.energy_drift, 1e-6);
}

TEST(Verdict, OfAMechanismAtRestHasNoReasonWithAnyMethod)
{
    const Model model = pendulum(0);   // every scale of the motion itself is zero or rounding
    for (const Method& method : every_method) {
        const Solution s = solved(model, method, 10, 200);
        EXPECT_TRUE(s.report.converged()) << name_of(method) << ": " << s.report.message;
        EXPECT_EQ(s.verdict.energy_drift, 0) << name_of(method);
    }
}

TEST(Verdict, OfRestOnAStiffSpringHasNoReason)
{
    // A spacing of numbers in the position is 2e-10 N, a million of those in the weight.
    const double stiffness = 1e6, mass = 2;
    Model model({0, 0, -9.81});
    const int body = model.add_body(point_mass("load", mass, {0, 0, 0}));
    model.add_load(
        spring_damper("spring", world, {0, 0, 1}, body, {}, {stiffness, 0, 1 - mass * 9.81 / stiffness}));
    for (const Method& method : {Method(Midpoint{}), Method(Endpoint{}), Method(Mixed{})}) {
        const Solution s = solved(model, method, 1, 200);
        EXPECT_TRUE(s.report.converged()) << name_of(method) << ": " << s.report.message;
        EXPECT_LT(s.verdict.balance.largest_kinetic, 1e-20) << "nothing but rounding moves";
        EXPECT_EQ(s.verdict.linear_momentum_drift, 0);
    }
}

TEST(Verdict, OfLostEnergyIsSuspectAndSaysWhatIsLostFirst)
{
    const Model model = pendulum(1);
    const Solution s = solved(model, Endpoint{}, 2, 20);
    EXPECT_EQ(s.report.status, SolveStatus::suspect);
    EXPECT_FALSE(s.report.converged());
    EXPECT_TRUE(s.report.reached_end());
    EXPECT_NE(s.report.message.find("estimated error"), std::string::npos) << s.report.message;
    EXPECT_EQ(s.report.message, s.verdict.reasons.front());
    EXPECT_TRUE(speaks_of(s.verdict.reasons, "energy"));
}

TEST(Verdict, OfEnergyThatRadauDampsIsARemark)
{
    // a spring that vibrates by 1e-5 m, 300 rad an element
    Model model;
    model.add_body(point_mass("mass", 1, {1 + 1e-5, 0, 0}));
    model.add_load(spring_damper("spring", world, {}, 0, {}, {1e8, 0, 1}));
    const Solution s = solved(model, Radau{4}, 1, 33);
    EXPECT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_EQ(s.verdict.energy_drift, 0);
    EXPECT_NEAR(s.verdict.balance.relative_energy_loss(), 1, 1e-6);
    EXPECT_TRUE(speaks_of(s.verdict.remarks, "has damped"));
}

/// What the second solution tells of a mass that hangs on a spring, and is pulled down, by long elements.
double told_of_hanging(double stiffness, double pulled)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("mass", 0.7, {0.3, 0.1, -(1 + 0.7 * 9.81 / stiffness) - pulled}));
    model.add_load(spring_damper("spring", world, {0.3, 0.1, 0}, 0, {}, {stiffness, 0, 1}));
    const TimeMesh mesh = make_time_mesh(0, 20, 20);
    SolveOptions options;
    options.estimate = SolveOptions::Estimate::second;
    return solve(model, {model.start()}, mesh, Radau{5}, options).estimate.largest;
}

TEST(Verdict, OfRestOnSpringsIsNotTheRootOfRounding)
{
    for (double stiffness = 50; stiffness < 2000; stiffness *= 1.2)
        EXPECT_LT(told_of_hanging(stiffness, 0), 1e-11) << stiffness;
}

TEST(Verdict, OfVibrationsWhoseEnergyIsRoundingIsNoLessThanTheyAre)
{
    for (const double pulled : {1e-6, 1e-8, 1e-9, 1e-10, 1e-11}) {
        EXPECT_GT(told_of_hanging(1000, pulled), 0.9 * pulled);
        EXPECT_LT(told_of_hanging(1000, pulled), 1000 * pulled);
    }
}

// The same motion, but that its energy rises from its lowest by a tenth of the largest: no balance with the
// start tells.
TEST(Verdict, OfEnergyThatRadauGainsIsSuspect)
{
    Model model;
    model.add_body(point_mass("mass", 1, {1, 0, 0}, {1, 0, 0}));
    model.add_load(spring_damper("damper", world, {}, 0, {}, {0, 1e4, 0}));
    Solution s = solved(model, Radau{3}, 1, 20);
    EXPECT_TRUE(s.report.converged()) << s.report.message;
    for (std::size_t end = 15; end < s.motion.velocities.size(); ++end) {
        s.motion.velocities[end] = s.motion.velocities[0];
        s.motion.velocities[end] *= std::sqrt(0.1);
        s.motion.momenta[end] = s.motion.velocities[end] * model.bodies()[0].mass;
    }
    judge(model, {{model.start()}}, {}, s);
    EXPECT_EQ(s.report.status, SolveStatus::suspect);
    EXPECT_NEAR(s.verdict.energy_drift, 0.1, 1e-6);
    EXPECT_GT(s.verdict.balance.relative_energy_loss(), 0.5);
    EXPECT_TRUE(speaks_of(s.verdict.reasons, "energy"));
}

TEST(Verdict, IsNotAskedForWhereTheCallerDoesNotWantIt)
{
    const Model model = pendulum(1);
    SolveOptions options;
    options.judge = options.divide = false;
    Solution s = solve(model, {model.start()}, make_time_mesh(0, 2, 20), Endpoint{}, options);
    EXPECT_EQ(s.report.status, SolveStatus::converged);
    EXPECT_TRUE(std::isnan(s.verdict.energy_drift));
    EXPECT_EQ(s.verdict.balance.largest_kinetic, 0);
    judge(model, {{model.start()}}, options, s);
    EXPECT_EQ(s.report.status, SolveStatus::suspect) << "asked later, it says the same";
}

TEST(Verdict, LONG_OfElementsTooLongForTheMotionIsSuspect)
{
    // A steady spin by 3 rad an element keeps its energy and momenta, and turns the other way to the eye.
    Model model;
    Placement placement;
    placement.angular_velocity = {0, 0, 15};
    model.add_body(rigid_body("top", box(1000, {0.1, 0.2, 0.3}), placement));
    const Solution s = solved(model, Midpoint{}, 20, 100);
    EXPECT_EQ(s.report.status, SolveStatus::suspect) << s.verdict.zigzag_positions;
    EXPECT_LT(s.verdict.energy_drift, 1e-9);
    EXPECT_TRUE(speaks_of(s.verdict.reasons, "velocities alternate from node to node near"));
    EXPECT_FALSE(speaks_of(s.verdict.reasons, "blocks")) << "it has none";
    EXPECT_FALSE(speaks_of(s.verdict.reasons, "natural"));
    // 0.75 rad a step keep all of this too, and have lost most of a turn behind the fiftieth
    const Solution better = solved(model, Midpoint{}, 20, 400);
    EXPECT_EQ(better.report.status, SolveStatus::suspect);
    EXPECT_FALSE(speaks_of(better.verdict.reasons, "alternate"));
    EXPECT_TRUE(speaks_of(better.verdict.reasons, "estimated error is"));
    EXPECT_NEAR(better.verdict.estimated_error, 3.14, 0.05);   // 20 w^3 h^2 / 12 = 14 rad, up to whole turns
    const Solution fine = solved(model, Midpoint{}, 20, 20000);
    EXPECT_TRUE(fine.report.converged()) << fine.report.message;
}

TEST(Verdict, OfFiguresThatAreNoNumbersIsSuspect)
{
    const Model model = pendulum(1);
    Solution s = solved(model, Lobatto{2}, 1, 10);
    ASSERT_TRUE(judge(model, s.motion, s.report).reasons.empty());
    s.motion.velocities[3](0, 0) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(speaks_of(judge(model, s.motion, s.report).reasons, "energy is not a number"));
    s.motion.X.values[24] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(speaks_of(judge(model, s.motion, s.report).reasons, "violated by nan"));
}

TEST(Verdict, RemarksOnPivotsRefuseNothing)
{
    const Model model = pendulum(1);
    Solution s = solved(model, Lobatto{4}, 1, 10);
    s.report.smallest_pivot = 1e-8;
    const Verdict v = judge(model, s.motion, s.report);
    EXPECT_TRUE(v.reasons.empty());
    EXPECT_TRUE(speaks_of(v.remarks, "singular position"));
}

TEST(Verdict, OfARunThatFailedIsNoneButItsFigures)
{
    const Model model = pendulum(1);
    Solution s = solved(model, Endpoint{}, 2, 20);
    s.report.status = SolveStatus::not_converged;
    const Verdict v = judge(model, s.motion, s.report);
    EXPECT_TRUE(v.reasons.empty());
    EXPECT_GT(v.energy_drift, 0.05);
}

// --- elements that hold constraints weakly

/// A motion that was solved and is then bent: violations at nodes and in the mean cannot be had at will.
struct Bent {
    Model model = pendulum(1);
    Solution solution;
    Bent()
    {
        Mixed method;
        method.degree = 1;
        solution = solved(model, method, 1, 50);
    }
    Verdict verdict() const { return judge(model, solution.motion, solution.report); }
};

TEST(Verdict, OfWeakConstraintsIsAboutTheirMean)
{
    Bent b;
    const Verdict good = b.verdict();
    EXPECT_TRUE(good.reasons.empty()) << good.reasons.front();
    EXPECT_GT(good.max_constraint_violation, 1e-6) << "at nodes they are off, by the discretisation";
    EXPECT_GT(good.max_weak_violation, 0);
    EXPECT_LT(good.max_weak_violation, 1e-3);
    for (double& x : b.solution.motion.X.values) x *= 1.002;   // |d| = 1.002: off by 2e-3 everywhere
    const Verdict stretched = b.verdict();
    EXPECT_TRUE(speaks_of(stretched.reasons, "in the mean over an element"));
    EXPECT_FALSE(speaks_of(stretched.reasons, "at element nodes")) << "2e-3 is below 0.05";
}

TEST(Verdict, OfNodesFarOffTheirConstraintsIsSuspect)
{
    Bent b;
    for (double& x : b.solution.motion.X.values) x *= 1.06;
    EXPECT_TRUE(speaks_of(b.verdict().reasons, "at element nodes"));
}

/// The nodes of X of degree 1 to and fro along y, so that the velocity alternates by +-speed.
void shake(Motion& motion, double speed)
{
    const double amplitude = speed * motion.mesh.length(0) / 2;
    for (std::size_t node = 0; 12 * node < motion.X.values.size(); ++node)
        motion.X.values[12 * node + 1] += node % 2 == 0 ? amplitude : -amplitude;
}

TEST(Verdict, OfMotionsThatZigzagIsSuspectForEveryFamily)
{
    const Model model = pendulum(1);
    Mixed linear;
    linear.degree = 1;
    for (const Method& method : {Method(linear), Method(Lobatto{1}), Method(Midpoint{})}) {
        Solution s = solved(model, method, 1, 50);
        const Motion sound = s.motion;
        shake(s.motion, 0.1);
        const Verdict slightly = judge(model, s.motion, s.report);
        EXPECT_FALSE(speaks_of(slightly.reasons, "alternate")) << slightly.zigzag_positions;
        EXPECT_GT(slightly.zigzag_positions, 0.005);
        s.motion = sound;
        shake(s.motion, 10);
        const Verdict badly = judge(model, s.motion, s.report);
        EXPECT_TRUE(speaks_of(badly.reasons, "velocities alternate from node to node near"));
        EXPECT_GT(badly.zigzag_positions, 0.9);
        EXPECT_EQ(speaks_of(badly.reasons, "smaller blocks"), std::holds_alternative<Mixed>(method));
    }
}

TEST(Verdict, OfASpuriousMotionIsNeverConverged)
{
    // The strong start on the double pendulum of the paper for 5 s: Newton converges, energy is off by less
    // than one percent, and the bodies are metres from where they belong.
    Model model({0, 0, -9.81});
    Placement upper, lower;
    upper.position = {std::sqrt(8), 0, std::sqrt(8)};
    lower.position = {std::sqrt(32), 0, std::sqrt(32)};
    model.add_body(rigid_body("upper", box(1.5, {1, 1, 1}), upper));
    model.add_body(rigid_body("lower", box(1.5, {0.8, 0.8, 0.8}), lower));
    model.add_joint(rod("one", world, 0, {}, 4));
    model.add_joint(rod("two", 0, 1, {}, 4));
    Mixed method;
    method.degree = 1;
    method.start = Mixed::Start::strong;
    EXPECT_FALSE(solved(model, method, 10, 200).report.converged());
}

}   // namespace
}   // namespace livens::verdict_test
