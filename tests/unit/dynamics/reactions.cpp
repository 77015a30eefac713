// SPDX-License-Identifier: BSD-3-Clause
// Reactions of redundant joints depend neither on the rows that were chosen nor on the axes of space.
#include "livens/dynamics/instant/reactions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "linkages.h"
#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/motion.h"
#include "livens/solvers/dense.h"

namespace livens::reactions_test {
namespace {

std::vector<Matrix34> places(const Model& model) { return model.start().X; }

/// G^T lambda in twists of reference points, six numbers a body.
std::vector<double> pushes(const Model& model, const std::vector<double>& lambda)
{
    const std::vector<Matrix34> X = places(model);
    const RowWrenches wrenches = row_wrenches(model, X);
    std::vector<double> push(6 * X.size(), 0.0);
    for (int r = 0; r < model.n_rows(); ++r) {
        for (const Wrench& w : wrenches[r]) {
            if (w.body == world) continue;
            const Vector3 moment = moment_about(w, X[w.body], {});
            for (int i = 0; i < 3; ++i) {
                push[6 * w.body + i] += lambda[r] * w.force[i];
                push[6 * w.body + 3 + i] += lambda[r] * moment[i];
            }
        }
    }
    return push;
}

/// The multipliers on the given independent rows that push so.
std::vector<double> multipliers_on(const Model& model, const std::vector<int>& rows, std::vector<double> push)
{
    const int rank = static_cast<int>(rows.size());
    OrthogonalBasis basis;
    basis.resize(static_cast<int>(push.size()), rank);
    for (int k = 0; k < rank; ++k) {
        std::vector<double> unit(model.n_rows(), 0.0);
        unit[rows[k]] = 1;
        std::ranges::copy(pushes(model, unit), basis.column(k));
    }
    basis.factorise(rank);
    basis.apply_transposed(push.data());
    basis.solve_R(push.data());
    std::vector<double> lambda(model.n_rows(), 0.0);
    for (int k = 0; k < rank; ++k) lambda[rows[k]] = push[k];
    return lambda;
}

/// Independent rows: those that come first are preferred, or those that come last.
std::vector<int> choice(const Model& model, bool last)
{
    std::vector<int> rows(model.n_rows());
    std::iota(rows.begin(), rows.end(), 0);
    if (last) std::ranges::reverse(rows);
    return row_rank(model, places(model), rows, 1e-9).independent;
}

std::vector<Reaction> reactions(const Model& model, const std::vector<double>& lambda)
{
    std::vector<Reaction> all;
    for (int j = 0; j < static_cast<int>(model.joints().size()); ++j)
        all.push_back(joint_reaction(model, j, places(model), lambda));
    return all;
}

double size_of(const Model& model, const std::vector<double>& lambda)
{
    double sum = 0;
    for (const Reaction& r : reactions(model, lambda))
        sum += dot(r.force, r.force) + dot(r.torque, r.torque) / (model.length() * model.length());
    return sum;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b)
{
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
    return worst;
}

/// The mechanism of examples/four_bar.toml, turned in space.
Model four_bar(const Matrix3& Q)
{
    Model model;
    const Vector3 points[4] = {{0, 0, 0}, {0, 0, 0.42}, {0.72, 0, 0.96}, {1, 0, 0}};
    const Vector3 along[3] = {{0, 0, 1}, {0.8, 0, 0.6}, {-0.28, 0, 0.96}};
    const Vector3 from[3] = {points[0], points[1], points[3]};
    const double lengths[3] = {0.42, 0.9, 1};
    for (int b = 0; b < 3; ++b) {
        Placement placement;
        placement.position = Q * from[b];
        placement.directors.set_column(0, Q * along[b]);
        placement.directors.set_column(1, Q * Vector3{0, 1, 0});
        placement.directors.set_column(2, Q * cross(along[b], {0, 1, 0}));
        model.add_body(rigid_body("b" + std::to_string(b),
                                  with_center(box(7850, {lengths[b], 0.04, 0.02}), {0.5 * lengths[b], 0, 0}),
                                  placement));
    }
    const int pairs[4][2] = {{world, 0}, {0, 1}, {1, 2}, {world, 2}};
    for (int k = 0; k < 4; ++k) {
        const auto [first, second] = pairs[k];
        const Matrix34& X = first == world ? world_configuration : model.bodies()[first].X;
        model.add_joint(
            revolute("j" + std::to_string(k), first, second,
                     joint_frame(X, model.bodies()[second].X, Q * points[k], Q * Vector3{0, 1, 0})));
    }
    return model;
}

std::vector<double> random_multipliers(const Model& model, unsigned seed)
{
    Random random(seed);
    std::vector<double> lambda(model.n_rows());
    for (double& l : lambda) l = 10 * random.number();
    return lambda;
}

TEST(LeastReactions, DoNotDependOnTheChosenRows)
{
    const Model model = four_bar(identity<3>());
    const std::vector<int> one = choice(model, false), other = choice(model, true);
    ASSERT_EQ(one.size(), 17u);
    ASSERT_EQ(other.size(), 17u);
    ASSERT_NE(one, other);
    const std::vector<double> push = pushes(model, random_multipliers(model, 1));
    const std::vector<double> on_one = multipliers_on(model, one, push);
    const std::vector<double> on_other = multipliers_on(model, other, push);
    const UniqueReactions a = least_reactions(model, places(model), on_one, one);
    const UniqueReactions b = least_reactions(model, places(model), on_other, other);
    EXPECT_GT(largest_difference(on_one, on_other), 1);   // negative control
    EXPECT_LT(largest_difference(a.multipliers, b.multipliers), 1e-12);
    EXPECT_LT(largest_difference(pushes(model, a.multipliers), push), 1e-12);
    EXPECT_EQ(a.joint_is_unique, std::vector<bool>(4, false));
    for (const SharedComponents& shared : a.shared)   // what is across the plane
        EXPECT_EQ(in_words(shared), "force y, torque x, torque z");
    EXPECT_GT(a.largest_null, 0.1);
}

TEST(LeastReactions, AreLeast)
{
    const Model model = four_bar(identity<3>());
    const std::vector<double> given = random_multipliers(model, 2);
    const std::vector<double> least =
        least_reactions(model, places(model), given, choice(model, false)).multipliers;
    // The other multipliers of the same push lie along given - least.
    const double size = size_of(model, least);
    EXPECT_GT(size_of(model, given), size * 1.01);
    for (const double step : {1e-3, -1e-3}) {
        std::vector<double> beside = least;
        for (std::size_t r = 0; r < beside.size(); ++r) beside[r] += step * (given[r] - least[r]);
        EXPECT_LT(largest_difference(pushes(model, beside), pushes(model, least)), 1e-12);
        EXPECT_GT(size_of(model, beside), size);
    }
}

TEST(LeastReactions, OfALongRingAreLeast)
{
    const int n = 100;
    const Model model = ring(1, n, {}, true);
    const std::vector<double> given = random_multipliers(model, 2);
    const std::vector<int> independent = choice(model, false);
    ASSERT_EQ(independent.size(), static_cast<std::size_t>(5 * n + 2));
    const std::vector<double> least = least_reactions(model, places(model), given, independent).multipliers;
    const double push = std::ranges::max(pushes(model, given));
    EXPECT_LT(largest_difference(pushes(model, given), pushes(model, least)), 1e-10 * push);
    const double size = size_of(model, least);
    for (const unsigned seed : {3u, 4u, 5u}) {   // any multipliers of no push lead away from them
        const std::vector<double> other = random_multipliers(model, seed);
        const std::vector<double> moved =
            least_reactions(model, places(model), other, independent).multipliers;
        for (const double step : {1e-2, -1e-2}) {
            std::vector<double> beside = least;
            for (std::size_t r = 0; r < beside.size(); ++r) beside[r] += step * (other[r] - moved[r]);
            EXPECT_GT(size_of(model, beside), size);
        }
    }
}

TEST(LeastReactions, TurnWithTheModel)
{
    const Model flat = four_bar(identity<3>());
    const std::vector<double> push = pushes(flat, random_multipliers(flat, 3));
    const std::vector<int> rows = choice(flat, false);
    const std::vector<Reaction> expected = reactions(
        flat, least_reactions(flat, places(flat), multipliers_on(flat, rows, push), rows).multipliers);
    Random random(4);
    for (int i = 0; i < 20; ++i) {
        const Matrix3 Q = random.rotation();
        const Model model = four_bar(Q);
        std::vector<double> turned;
        for (std::size_t k = 0; k < push.size(); k += 3) {
            const Vector3 v = Q * Vector3{push[k], push[k + 1], push[k + 2]};
            turned.insert(turned.end(), v.a, v.a + 3);
        }
        const std::vector<int> there = choice(model, false);
        ASSERT_EQ(there.size(), 17u);
        const std::vector<double> given = multipliers_on(model, there, turned);
        const UniqueReactions least = least_reactions(model, places(model), given, there);
        const std::vector<Reaction> found = reactions(model, least.multipliers);
        for (int j = 0; j < 4; ++j) {
            EXPECT_LT(norm(found[j].force - Q * expected[j].force), 1e-11);
            EXPECT_LT(norm(found[j].torque - Q * expected[j].torque), 1e-11);
        }
    }
}

TEST(LeastReactions, TwoEqualJointsCarryHalfEachAndLeaveTheOthersAlone)
{
    Linkage l(5, {.largest_power = 15});
    l.add_link({0, 0, 0});
    l.add_link({1, 0, 0});
    l.ball(world, 0, {-0.5, 0.1, 0});
    l.ball(0, 1, {0.5, 0.1, 0.3});
    l.ball(0, 1, {0.5, 0.1, 0.3});
    const std::vector<double> given{1.1, -2.2, 3.3, 4, 5, 6, 0, 0, 0};
    const UniqueReactions least =
        least_reactions(l.model, places(l.model), given, std::vector{0, 1, 2, 3, 4, 5});
    EXPECT_EQ(least.joint_is_unique, (std::vector{true, false, false}));
    EXPECT_EQ(in_words(least.shared[0]), "");
    EXPECT_EQ(in_words(least.shared[1]), "force x, force y, force z");
    EXPECT_NEAR(least.largest_null, std::sqrt(3 * 0.5), 1e-9);   // of three null vectors
    for (int r = 0; r < 3; ++r) {
        EXPECT_EQ(least.multipliers[r], given[r]);
        EXPECT_NEAR(least.multipliers[3 + r], 0.5 * given[3 + r], 1e-13);
        EXPECT_NEAR(least.multipliers[6 + r], 0.5 * given[3 + r], 1e-13);
    }
}

TEST(LeastReactions, OfOpenChainsAreTheGivenOnesToTheBit)
{
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Model model = open_chain(seed, 4, {.largest_power = 15});
        const std::vector<double> given = random_multipliers(model, seed);
        const UniqueReactions least = least_reactions(model, places(model), given, choice(model, false));
        EXPECT_EQ(least.multipliers, given);
        EXPECT_EQ(least.joint_is_unique, std::vector<bool>(model.joints().size(), true));
        EXPECT_EQ(least.largest_null, 0);
    }
}

TEST(LeastReactions, RowsOfOneJointThatSayTheSameLeaveItUnique)
{
    Linkage l(6, {});
    l.add_link({0, 0, 0});
    Joint joint = spherical("j", world, 0, l.frame(world, 0, {0.1, 0.2, 0.3}, {0, 0, 1}));
    joint.rows.push_back(joint.rows[1]);
    l.model.add_joint(joint);
    const UniqueReactions least =
        least_reactions(l.model, places(l.model), std::vector{1.0, 2.0, 3.0, 0.0}, std::vector{0, 1, 2});
    EXPECT_EQ(least.joint_is_unique, std::vector{true});
    EXPECT_LT(least.largest_null, 1e-9);
}

}   // namespace
}   // namespace livens::reactions_test
