// SPDX-License-Identifier: BSD-3-Clause
// Rows a . b = 0 admit an axis turned end for end; assembly does not.
#include <gtest/gtest.h>

#include <numbers>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/joints/drives.h"
#include "livens/multibody/model.h"
#include "unit/multibody/random_states.h"

namespace livens::assembly_branch_test {
namespace {

TEST(ConsistentStart, RefusesARevoluteWithItsAxesTurnedEndForEnd)
{
    for (const double sign : {1.0, -1.0}) {
        Model model;
        model.add_body(rigid_body("box", box(1, {1, 2, 3})));
        JointFrame f;
        f.axis_second = {0, 0, sign};
        model.add_joint(revolute("hinge", world, 0, f));
        if (sign > 0) {
            EXPECT_EQ(consistent_start(model, model.start(), StartPolicy::check).degrees_of_freedom, 1);
            continue;
        }
        try {
            consistent_start(model, model.start(), StartPolicy::project);
            FAIL() << "the opposite axis was accepted";
        } catch (const InputError& error) {
            EXPECT_EQ(error.complaint().code, "joint-branch");
            EXPECT_EQ(error.complaint().path, "joint[hinge].axes");
        }
    }
}

/// A crank that stands at zero and is told to be at `stated`, driven from zero on.
Model driven_crank(double stated)
{
    Model model;
    model.add_body(rigid_body("crank", box(1, {1, 0.1, 0.1}), {{0.5, 0, 0}}));
    Joint hinge = revolute("hinge", world, 0, joint_frame(world_configuration, model.bodies()[0].X, {}));
    hinge.coordinates[0].at_stated = stated;
    const std::vector<Matrix34> X{model.bodies()[0].X};
    const Joint motor = driven_coordinate("motor", hinge, hinge.coordinates[0], 0.0, X);
    model.add_joint(hinge);
    model.add_joint(motor);
    return model;
}

std::string refusal(const Model& model, StartPolicy policy, const std::string& code)
{
    try {
        consistent_start(model, model.start(), policy);
        ADD_FAILURE() << "no " << code;
    } catch (const InputError& error) {
        EXPECT_EQ(error.complaint().code, code);
        return error.complaint().message + "; " + error.complaint().note + "; " + error.complaint().help;
    }
    return "";
}

TEST(ConsistentStart, LeadsADrivenAngleBackFromAnywhere)
{
    for (int degrees = -180; degrees <= 180; degrees += 5) {
        const double stated = degrees * std::numbers::pi / 180;
        const Model model = driven_crank(stated);
        const ConsistentStart closed = consistent_start(model, model.start(), StartPolicy::project);
        for (const std::string& note : closed.notes)
            EXPECT_EQ(note.find("disturbed"), std::string::npos) << "not by chance: " << note;
        const Vector3 along = closed.start.X[0].column(1);
        EXPECT_NEAR(along[0], std::cos(stated), 1e-12) << degrees;   // turned back by what was stated
        EXPECT_NEAR(along[1], -std::sin(stated), 1e-12) << degrees;
        if (degrees == 0) continue;
        const bool is_half = std::abs(degrees) == 180;
        const std::string words =
            refusal(model, StartPolicy::check, is_half ? "joint-branch" : "start-position");
        EXPECT_NE(words.find("coordinates of the start"), std::string::npos) << words;
        const std::size_t at = words.find("add ");
        ASSERT_NE(at, std::string::npos) << words;
        EXPECT_NEAR(std::remainder(std::stod(words.substr(at + 4)) - stated, 2 * std::numbers::pi), 0, 1e-12);
    }
}

/// A closed chain of bars, joined by hinges about y or by balls, all of which stand at the origin.
Model heap(int n, bool is_planar, double last)
{
    Model model;
    const auto at = [](double x) { return Vector3{x, 0, 0}; };
    for (int b = 0; b < n; ++b) model.add_body(rigid_body("bar" + std::to_string(b), box(1, {1, 0.1, 0.1})));
    for (int b = 0; b <= n; ++b) {
        JointFrame frame{at(b == 0 ? 0 : 0.5), at(b == n ? 0 : -0.5), {0, 1, 0}, {0, 1, 0}};
        if (b == n) frame = {at(0.5), at(last), {0, 1, 0}, {0, 1, 0}};
        const int first = b == 0 ? world : b - 1, second = b == n ? world : b;
        const std::string name = "joint" + std::to_string(b);
        model.add_joint(is_planar ? revolute(name, first, second, frame)
                                  : spherical(name, first, second, frame));
    }
    return model;
}

TEST(ConsistentStart, ClosesBodiesThatStandAtOnePlace)
{
    for (const bool is_planar : {true, false}) {
        for (const int n : {2, 3, 5}) {
            const Model model = heap(n, is_planar, 0.7 * n);
            const ConsistentStart closed = consistent_start(model, model.start(), StartPolicy::project),
                                  again = consistent_start(heap(n, is_planar, 0.7 * n), model.start(),
                                                           StartPolicy::project);
            EXPECT_EQ(closed.start.X, again.start.X) << "always the same";
            EXPECT_NEAR(norm(closed.start.X[n - 1] * point({0.5, 0, 0}) - Vector3{0.7 * n, 0, 0}), 0, 1e-12);
            EXPECT_NEAR(norm(closed.start.X[0] * point({-0.5, 0, 0})), 0, 1e-12);
        }
        // A little more than the bars reach is nowhere, and told as what was looked for and not found.
        const std::string words =
            refusal(heap(3, is_planar, 3.01), StartPolicy::project, "joint-contradiction");
        EXPECT_NE(words.find("no position was found"), std::string::npos) << words;
        EXPECT_NE(words.find("12 that were disturbed"), std::string::npos) << words;
        EXPECT_EQ(words.find("cannot"), std::string::npos) << words;
    }
}

/// Axes by more than a quarter of a turn apart close end for end where Newton's way leads there.
TEST(ConsistentStart, TurnsAxesThatAreFarFromEachOther)
{
    Random random(3);
    for (int k = 0; k < 50; ++k) {
        Model model;
        model.add_body(rigid_body("box", box(1, {1, 2, 3}), {random.vector(), random.rotation()}));
        JointFrame frame{random.vector(), random.vector(), random.unit(), random.unit()};
        model.add_joint(revolute("hinge", world, 0, frame));
        const ConsistentStart closed = consistent_start(model, model.start(), StartPolicy::project);
        EXPECT_GT(dot(frame.axis_first, closed.start.X[0] * direction(frame.axis_second)), 1 - 1e-12);
    }
}

}   // namespace
}   // namespace livens::assembly_branch_test
