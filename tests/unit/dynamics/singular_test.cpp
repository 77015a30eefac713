// SPDX-License-Identifier: BSD-3-Clause
// Positions in which joints hold less than beside them: what is free to second order, and what is said of it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "livens/base/error.h"
#include "livens/dynamics/rows/projection.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/dynamics/start/singular.h"
#include "parallelograms.h"

namespace livens::singular_test {
namespace {

using tests::Parallelograms;

constexpr double flat = std::numbers::pi / 2;

Mobility mobility_of(const Model& model, const State& start)
{
    return mobility(model, consistent_start(model, start, StartPolicy::check));
}
Mobility mobility_of(const Model& model) { return mobility_of(model, model.start()); }

/// How far the bodies move when the joints are closed after a step along some rates.
double way_back(const Model& model, const std::vector<Matrix34>& rates, double step)
{
    std::vector<Matrix34> X = model.start().X;
    for (std::size_t b = 0; b < X.size(); ++b)
        X[b] = twist::moved(X[b], step * rates[b].column(0), step * angular_velocity(X[b], rates[b]));
    const Closing closing = close_rows(model, X, all_rows(model), true);
    EXPECT_TRUE(closing.closed);
    double way = 0;
    for (std::size_t b = 0; b < X.size(); ++b) way = std::max(way, norm(closing.X[b] - X[b]));
    return way;
}

TEST(Mobility, IsThatOfTheFirstOrderWhereTheJointsKeepTheirRank)
{
    for (const int n : {1, 2, 3}) {
        const Model model = Parallelograms{n, 0.3}.model();
        const Mobility m = mobility_of(model);
        EXPECT_EQ(m.first_order, 1);
        EXPECT_FALSE(m.is_singular()) << "redundant in all positions";
        EXPECT_NO_THROW(
            refuse_singular_start(model, consistent_start(model, model.start(), StartPolicy::check)));
    }
}

TEST(Mobility, CountsWhatTheSecondOrderLeaves)
{
    for (const int n : {1, 2, 3}) {
        const Mobility m = mobility_of(Parallelograms{n, flat}.model());
        EXPECT_EQ(m.first_order, n + 1);
        EXPECT_EQ(m.conditions, n);
        EXPECT_TRUE(m.are_possible);
        EXPECT_TRUE(m.choose_branch) << "the links turn together";
        EXPECT_FALSE(m.is_locked);
    }
}

TEST(Mobility, FindsTheTwoBranchesOfAFlatParallelogram)
{
    const Model model = Parallelograms{1, flat, 0}.model();
    const Mobility m = mobility_of(model);
    ASSERT_EQ(m.branches.size(), 2u);
    EXPECT_FALSE(m.choose_branch) << "at rest";
    const State start = model.start();
    int parallel = 0, folded = 0;
    for (const auto& rates : m.branches) {
        const double first = angular_velocity(start.X[0], rates[0])[2],
                     second = angular_velocity(start.X[1], rates[1])[2];
        const double bar = angular_velocity(start.X[2], rates[2])[2];
        parallel += std::abs(first - second) < 1e-9 && std::abs(bar) < 1e-9;
        folded += std::abs(first) < 1e-9 && std::abs(second - bar) < 1e-9;
    }
    EXPECT_EQ(parallel, 1);
    EXPECT_EQ(folded, 1) << "the last link lies on the base, and the bar on the link that turns";
}

/// The two branches are motions of the first order together, but no motion of the second.
TEST(Mobility, SumsOfBranchesAreNone)
{
    const Model model = Parallelograms{1, flat, 0}.model();
    const Mobility m = mobility_of(model);
    ASSERT_EQ(m.branches.size(), 2u);
    State start = model.start();
    for (const double share : {0.0, 1.0}) {
        for (std::size_t b = 0; b < start.V.size(); ++b)
            start.V[b] = m.branches[0][b] + share * m.branches[1][b];
        const Mobility along = mobility_of(model, start);
        EXPECT_EQ(along.are_possible, share == 0);
        EXPECT_EQ(along.choose_branch, share == 0);
    }
    // a witness: from a step along a branch the closed positions are a step's square away, else a step
    EXPECT_LT(way_back(model, m.branches[0], 1e-3), 1e-5);
    EXPECT_LT(way_back(model, m.branches[1], 1e-3), 1e-5);
    EXPECT_GT(way_back(model, start.V, 1e-3), 1e-4);
}

TEST(Mobility, NamesARowOfTheLoopThatIsSingular)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("apart", 1, {0, 0, 5}));
    model.add_joint(rod("of its own", world, 0, {}, 5));
    model.add_body(point_mass("bead", 1, {1, 0, 0}));
    JointFrame frame;
    model.add_joint(rod("left", world, 1, frame, 1));
    frame.point_first = {2.5, 0, 0};
    model.add_joint(rod("right", world, 1, frame, 1.5));
    const Mobility m = mobility_of(model);
    EXPECT_TRUE(m.is_singular());
    EXPECT_NE(model.row_joint(m.row), 0);
}

TEST(Mobility, KnowsWhatIsLocked)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bead", 1, {1, 0, 0}));
    JointFrame frame;
    model.add_joint(rod("left", world, 0, frame, 1));
    frame.point_first = {2.5, 0, 0};
    model.add_joint(rod("right", world, 0, frame, 1.5));
    const Mobility m = mobility_of(model);
    EXPECT_EQ(m.first_order, 2);
    EXPECT_EQ(m.conditions, 1);
    EXPECT_TRUE(m.is_locked);
    EXPECT_TRUE(m.branches.empty());
}

/// Where nothing can turn, what the second order asks is rounding, however the axes lie.
TEST(Mobility, SlidesOnParallelRailsInAnyDirection)
{
    for (const Vector3& axis : {Vector3{1, 0, 0}, Vector3{1, 0.2, -0.3}, Vector3{-0.7, 0.9, 0.31}}) {
        for (const double length : {1e-3, 1.0, 1e4}) {
            Model model({0, 0, -9.81});
            const Matrix3 inertia{0.1, 0, 0, 0, 0.2, 0, 0, 0, 0.3};
            model.add_body(rigid_body("carriage", {1, {}, length * length * inertia}, Placement{}));
            const auto rail = [&](const char* name, const Vector3& at) {
                model.add_joint(prismatic(name, world, 0,
                                          {.point_first = length * at,
                                           .point_second = length * at,
                                           .axis_first = axis,
                                           .axis_second = axis},
                                          configuration({}, identity<3>()), model.bodies()[0].X));
            };
            rail("left", {0, 0.3, 0});
            rail("right", {0.1, -0.3, 0.2});
            const Mobility m = mobility_of(model);
            EXPECT_EQ(m.first_order, 1);
            EXPECT_FALSE(m.is_singular()) << axis[0] << " " << length;
            EXPECT_NO_THROW(
                refuse_singular_start(model, consistent_start(model, model.start(), StartPolicy::check)));
        }
    }
}

TEST(SingularStart, IsRefusedWithWhatToGive)
{
    const Model model = Parallelograms{1, flat, 0}.model();
    try {
        refuse_singular_start(model, consistent_start(model, model.start(), StartPolicy::check));
        ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
        const Complaint& c = error.complaint();
        EXPECT_EQ(c.code, "start-singular");
        EXPECT_EQ(c.path.find("joint["), 0u) << c.path;
        EXPECT_NE(c.value.find("2 motions in first order under 1 condition"), std::string::npos) << c.value;
        EXPECT_NE(c.value.find("2 branches"), std::string::npos) << c.value;
        EXPECT_NE(c.help.find("'link0' turns by [0, 0, "), std::string::npos) << c.help;
    }
}

}   // namespace
}   // namespace livens::singular_test
