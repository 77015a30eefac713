// SPDX-License-Identifier: BSD-3-Clause
// Elements with stiff loads, and elements on Radau points, by the march kernel against Newton's iteration.
#include <gtest/gtest.h>

#include <cmath>

#include "livens/multibody/joints.h"
#include "livens/multibody/loads.h"
#include "sanitized.h"
#include "unit/spacetime/kernel_comparison.h"

namespace livens::stiff_loads_test {
namespace {

/// Springs so stiff that steps of free bodies do not shrink: at coordinates of joints, between any two bodies
/// and to the world, where they are at rest.
void add_stiff_loads(Random& random, Model& model, bool have_slopes)
{
    const auto add = [&](Load load) {
        if (!have_slopes) load.tangent = [](const LoadArguments&, LoadTangent&) {};
        model.add_load(load);
    };
    const std::vector<Matrix34> X = model.start().X;
    for (std::size_t j = 0; j < model.joints().size(); ++j)
        for (const NamedCoordinate& q : model.joints()[j].coordinates)
            if (random.number() > -0.5)
                add(joint_spring("at " + q.name + std::to_string(j), q, {3e4, 2, q.at_stated, 0.1}, X));
    const int n = static_cast<int>(model.bodies().size());
    for (const int other : {world, 0}) {
        if (other == n - 1) continue;
        const Vector3 from = 3.0 * random.unit();
        const Vector3 way = X[static_cast<std::size_t>(n - 1)].column(0) -
                            (other == world ? world_configuration : X[0]) * point(from);
        add(spring_damper("from " + std::to_string(other), other,
                          other != world && model.bodies()[0].is_point ? Vector3{} : from, n - 1, {},
                          {5e4, 1, norm(way)}));
    }
}

/// How many elements with stiff loads are solved, of n that Newton solves; `found`: their differences.
int solved_with_stiff_loads(int n, bool have_slopes, std::vector<double>& found,
                            Points points = Points::lobatto)
{
    Random random(11);
    for (int tried = 0; tried < n;) {
        Model model = any_mechanism(random);
        const int degree = 2 + static_cast<int>(3.5 * (1 + random.number()));
        const double h = (random.number() > -0.7 ? 1 : -1) * (0.02 + 0.015 * random.number());
        try {
            Model blunt = model;
            Random same = random;
            add_stiff_loads(same, blunt, false);
            add_stiff_loads(random, model, true);
            const Comparison comparison =
                compare(model, degree, h, 0, have_slopes ? nullptr : &blunt, points);
            tried += comparison.has_reference ? 1 : 0;
            if (comparison.is_solved) found.push_back(comparison.worst());
        } catch (const InputError&) {   // overdetermined: no start
        }
    }
    std::sort(found.begin(), found.end());
    return static_cast<int>(found.size());
}

TEST(MarchKernel, StiffLoadsAreSolvedWithTheirSlopes)
{
    constexpr int n = is_sanitized ? 30 : 150;
    with_all_instructions([] {
        std::vector<double> found, without;
        EXPECT_GT(solved_with_stiff_loads(n, true, found), n * 5 / 6);
        EXPECT_LT(found[found.size() / 2], 5e-13);   // forces of 5e4 N a metre, of which digits are left
        EXPECT_LT(found.back(), 1e-11);
        EXPECT_LT(solved_with_stiff_loads(n, false, without), n / 2) << "negative control";
    });
}

/// Steps that have met rounding shrink no more, and say nothing of the factor.
TEST(MarchKernel, AFactorServesElementsOfTheSameLength)
{
    Random random(5);
    int by_slopes = 0, made_again = 0;
    while (by_slopes < 60) {
        Model model = any_mechanism(random);
        try {
            add_stiff_loads(random, model, true);
            const Comparison found = compare(model, 5, 0.02, 0, nullptr, Points::radau);
            if (!found.is_solved || !found.took_slopes) continue;
            ++by_slopes;
            made_again += found.factors_again > 0 ? 1 : 0;
        } catch (const InputError&) {   // overdetermined: no start
        }
    }
    EXPECT_LE(made_again, 15);
}

/// A heavy mass that hangs on light links and swings: what draws them stiffens them.
Model heavy_on_light(Random& random)
{
    Model model({0, 0, -9.81});
    const int n = 3 + static_cast<int>(1.5 * (1 + random.number()));
    const double tilt = 0.5 * random.number();
    const Vector3 along{std::sin(tilt), 0, -std::cos(tilt)};
    const auto X = [&](int b) { return b == world ? world_configuration : model.bodies()[b].X; };
    for (int b = 0; b < n; ++b) {
        model.add_body(rigid_body("link " + std::to_string(b), with_mass(box(1, {0.1, 0.1, 0.3}), 1),
                                  {(0.3 * b + 0.15) * along, random.rotation()}));
        const JointFrame frame = joint_frame(X(b - 1), X(b), 0.3 * b * along, random.unit());
        model.add_joint(random.number() > -0.5 ? spherical("ball " + std::to_string(b), b - 1, b, frame)
                                               : revolute("hinge " + std::to_string(b), b - 1, b, frame));
    }
    model.add_body(point_mass("heavy", 1e5, 0.3 * n * along, {0, random.number(), 0}));
    const JointFrame frame = joint_frame(X(n - 1), X(n), 0.3 * n * along, {1, 0, 0});
    model.add_joint(spherical("hook", n - 1, n, frame));
    return model;
}

TEST(MarchKernel, LinksThatAHeavyMassDrawsNeedNoNewton)
{
    with_all_instructions([] {
        Random random(3);
        int solved = 0, tried = 0;
        std::vector<double> found;
        while (tried < 60) {
            const Model model = heavy_on_light(random);
            const int degree = 3 + static_cast<int>(3 * (1 + random.number()));
            const Comparison comparison = compare(model, degree, 0.0008 + 0.0004 * random.number());
            tried += comparison.has_reference ? 1 : 0;
            solved += comparison.is_solved ? 1 : 0;
            if (comparison.is_solved) found.push_back(std::max(comparison.X, comparison.momentum / 1e5));
        }
        EXPECT_GT(solved, 40);
        EXPECT_LT(*std::ranges::max_element(found), 1e-11);
    });
}

TEST(MarchKernel, AgreesWithNewtonOnRadauPoints)
{
    with_all_instructions([] {
        int unsolved = 0;
        const std::vector<double> found = differences(is_sanitized ? 50 : 200, 0, unsolved, Points::radau);
        EXPECT_LT(unsolved, 20);
        EXPECT_LT(found[found.size() / 2], 1e-14);
        EXPECT_LT(found.back(), 1e-13);
        std::vector<double> stiff;
        constexpr int n = is_sanitized ? 20 : 100;
        EXPECT_GT(solved_with_stiff_loads(n, true, stiff, Points::radau), 0.85 * n);
        EXPECT_LT(stiff[stiff.size() / 2], 5e-13);
        EXPECT_LT(stiff.back(), 1e-11);
        unsolved = 0;
        const std::vector<double> faulty = differences(50, 1e-9, unsolved, Points::radau);
        EXPECT_GT(faulty[faulty.size() / 2], 1e-13) << "negative control";
    });
}

}   // namespace
}   // namespace livens::stiff_loads_test
