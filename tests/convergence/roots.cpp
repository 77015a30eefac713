// SPDX-License-Identifier: BSD-3-Clause
// Several motions for the same conditions, by guesses that turn more often or the other way.
#include <numbers>
#include <set>

#include "convergence/studies.h"
#include "livens/base/error.h"
#include "livens/multibody/state_quantities.h"

namespace livens::tests::roots_test {
namespace {

constexpr double pi = std::numbers::pi;

/// A bar on a hinge, hanging.
Model hanging_bar()
{
    Model model({0, -9.81, 0});
    const Matrix3 down = directors_from_rotation_vector({0, 0, -pi / 2});
    const int bar = model.add_body(rigid_body("bar", brick({}), {{}, down, {}, {}}));
    model.add_joint(revolute("pivot", world, bar, {}));
    return model;
}

Solution look(const Model& model, const livens::Problem& problem, double end, int roots)
{
    SolveOptions options;
    options.roots = roots;
    return solve(model, problem, make_time_mesh(0, end, 24), Lobatto{6, 0}, options);
}

/// Rounds of the bar about z.
double rounds(const Model& model, const Motion& motion)
{
    const JointCoordinate& q = model.joints()[0].coordinates[0].coordinate;
    const std::vector<Matrix34> X{model.bodies()[0].X};
    double now = coordinate_change(q, X, motion.at_end(0).X);
    const double first = now;
    for (int i = 1; i <= 480; ++i)
        now = turned_to(
            coordinate_change(q, X, motion.at(motion.start() + (motion.end() - motion.start()) * i / 480).X),
            now);
    return (now - first) / (2 * pi);
}

TEST(Roots, HaveOtherTurnsAndAreOrderedByEffort)
{
    const Model model = hanging_bar();
    const livens::Problem problem{{model.start(), Known::positions, model.start(), Known::positions}};
    const Solution s = look(model, problem, 1, 7);   // rest, two swings, and one or two rounds either way
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    ASSERT_EQ(s.roots.size(), 6u);
    std::set<long> turns;
    double before = -1;
    for (std::size_t i = 0; i <= s.roots.size(); ++i) {
        const Solution& one = i == 0 ? s : s.roots[i - 1];
        EXPECT_TRUE(one.report.converged()) << one.report.message;
        const double effort = effort_of(model, one.motion);
        EXPECT_GE(effort, before);
        before = effort;
        const double n = rounds(model, one.motion);
        EXPECT_NEAR(n, std::round(n), 1e-9);
        turns.insert(std::lround(n));
        // each is a motion: a march from its start arrives where it does
        const Solution march = solve(model, {{one.motion.at_end(0)}}, make_time_mesh(0, 1, 48), Lobatto{8});
        EXPECT_LE(distance(march.motion.at_end(48), one.motion.at_end(24)).X, 1e-6);
    }
    EXPECT_EQ(turns, (std::set<long>{-2, -1, 0, 1, 2}));
    EXPECT_EQ(std::lround(rounds(model, s.motion)), 0);   // at rest it has no effort
}

/// A ball between two places has one way: nothing is found twice, and nobody says that all were found.
TEST(Roots, AreDistinct)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("ball", 1, {}, {1, 0, 5}));
    State there = model.start();
    there.X[0].set_column(0, {2, 0, 1});
    const Solution s = look(model, {{model.start(), Known::positions, there, Known::positions}}, 0.8, 4);
    ASSERT_TRUE(s.report.converged()) << s.report.message;
    EXPECT_TRUE(s.roots.empty());
    const auto told = [&](const std::string& words) {
        return std::ranges::any_of(s.report.notes,
                                   [&](const std::string& note) { return note.find(words) != note.npos; });
    };
    EXPECT_TRUE(told("that there are no others is not known"));
    EXPECT_TRUE(told("effort"));
}

TEST(Roots, AreRefusedFromAState)
{
    const Model model = hanging_bar();
    for (const int n : {0, 3}) try {
            look(model, {{model.start()}}, 1, n);
            ADD_FAILURE() << n;
        } catch (const InputError& error) {
            EXPECT_EQ(error.complaint().code, "roots-unused");
        }
}

}   // namespace
}   // namespace livens::tests::roots_test
