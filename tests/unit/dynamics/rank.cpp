// SPDX-License-Identifier: BSD-3-Clause
// The rank of joint rows is geometry: masses, units, the place and reference points do not matter.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "linkages.h"
#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/dynamics/start/singular.h"

namespace livens::rank_test {
namespace {

/// Of 60 linkages with 2 to 6 bodies, how many are refused or get another number of independent rows.
int wrong_ranks(const std::function<Model(unsigned, int)>& make,
                const std::function<int(const Model&, int)>& rank)
{
    int wrong = 0;
    for (unsigned seed = 0; seed < 60; ++seed) {
        const int n = 2 + static_cast<int>(seed % 5);
        const Model model = make(seed, n);
        try {
            const ConsistentStart a = consistent_start(model, model.start(), StartPolicy::check);
            const int independent = static_cast<int>(a.independent.size());
            const int redundant = static_cast<int>(a.redundant.size());
            if (independent != rank(model, n) || independent + redundant != model.n_rows()) ++wrong;
        } catch (const InputError& error) {
            if (wrong++ == 0) std::printf("%s\n", error.what());
        }
    }
    return wrong;
}

void expect_ranks(const Surroundings& how)
{
    EXPECT_EQ(wrong_ranks([&](unsigned s, int n) { return open_chain(s, n, how); },
                          [](const Model& m, int) { return m.n_rows(); }),
              0)
        << "open chains";
    EXPECT_EQ(wrong_ranks([&](unsigned s, int n) { return open_chain(s, n, how, true); },
                          [](const Model& m, int) { return m.n_rows() / 2; }),
              0)
        << "chains of doubled joints";
    EXPECT_EQ(wrong_ranks([&](unsigned s, int n) { return ring(s, n, how, true); },
                          [](const Model&, int n) { return 5 * n + 2; }),
              0)
        << "planar rings";
    EXPECT_EQ(wrong_ranks([&](unsigned s, int n) { return ring(s, n, how, false); },
                          [](const Model&, int n) { return std::min(5 * (n + 1), 6 * n); }),
              0)
        << "rings in space";
}

TEST(Rank, OfLinkagesIsAsCounted) { expect_ranks({}); }

TEST(Rank, DoesNotDependOnMasses) { expect_ranks({.largest_power = 15}); }

TEST(Rank, DoesNotDependOnTheUnitOfLength)
{
    for (const double unit : {1e-6, 1e6}) expect_ranks({.unit = unit, .largest_power = 15});
}

TEST(Rank, DoesNotDependOnThePlaceInSpace)
{
    for (const double unit : {1e-6, 1.0, 1e6})
        expect_ranks({.unit = unit, .shift = 1e6, .largest_power = 15});
}

TEST(Rank, DoesNotDependOnReferencePoints)
{
    for (const double unit : {1e-6, 1.0, 1e6})
        expect_ranks({.unit = unit, .reference = 1e6, .largest_power = 15});
}

TEST(Rank, BearsBodiesOfVeryDifferentSize)
{
    // Doors on two balls, or on a hinge and a ball on its axis, have five independent rows.
    for (unsigned seed = 0; seed < 200; ++seed) {
        Linkage l(seed, {.largest_power = 15});
        Vector3 at{};
        const int n = 2 + static_cast<int>(seed % 5);
        for (int b = 0; b < n; ++b) {
            const double size = std::pow(10.0, std::round(3 * l.random.number()));
            const Vector3 axis = l.random.unit();
            l.add_link(at + 0.5 * size * l.random.unit());
            if (l.random.number() > 0) {
                l.hinge(b - 1, b, at, axis);
            } else {
                l.ball(b - 1, b, at);
            }
            l.ball(b - 1, b, at + 0.3 * size * axis);
            at += size * l.random.unit();
        }
        const ConsistentStart a = consistent_start(l.model, l.model.start(), StartPolicy::check);
        EXPECT_EQ(static_cast<int>(a.independent.size()), 5 * n) << seed;
    }
}

// At the cost of dense matrices this takes minutes.
TEST(Rank, OfLongChainsAndRingsIsFoundAlongTheJoints)
{
    const int n = 400;
    const auto closed = [](const Model& model) {
        return consistent_start(model, model.start(), StartPolicy::check);
    };
    const Model chain = open_chain(1, n, {});
    EXPECT_EQ(closed(chain).redundant, std::vector<int>{});
    const Model flat = ring(2, n, {}, true);
    const ConsistentStart start = closed(flat);
    EXPECT_EQ(static_cast<int>(start.independent.size()), 5 * n + 2);
    for (const int row : start.redundant)
        EXPECT_EQ(flat.row_joint(row), n) << "the joint that closes the ring";
    EXPECT_FALSE(mobility(flat, start).is_singular());
    EXPECT_EQ(static_cast<int>(closed(ring(2, n, {}, false)).independent.size()), 5 * n + 5);
}

// A ball holds a point: its forces have no moment about that point, on either body.
TEST(Rows, WrenchesAreAboutTheJointPoints)
{
    Linkage l(7, {});
    l.add_link({0, 0, 0});
    l.add_link({2, 1, 0});
    l.ball(0, 1, {0.7, -0.4, 0.9});
    const std::vector<Matrix34> X = l.model.start().X;
    const Joint& ball = l.model.joints()[0];
    for (const auto& row : row_wrenches(l.model, X)) {
        ASSERT_EQ(row.size(), 2u);
        for (const Wrench& w : row) {
            EXPECT_EQ(w.at, w.body == 0 ? ball.point_first : ball.point_second);
            EXPECT_EQ(norm(w.moment), 0);
            EXPECT_GT(norm(w.force), 0.1);
        }
    }
}

/// By elimination with complete pivoting; -1 where a pivot is neither large nor rounding.
int rank_by_elimination(const Model& model, std::span<const Matrix34> X)
{
    std::vector<std::vector<long double>> G;
    for (const BodyRow& row : twist_rows(model, X, all_rows(model)).rows) {
        std::vector<long double>& line = G.emplace_back(6 * X.size(), 0);
        for (const auto& part : row.parts)
            for (std::size_t i = 0; i < 6; ++i)
                line[6 * static_cast<std::size_t>(part.body) + i] = part.entries[i];
    }
    for (std::size_t k = 0; k < G.size(); ++k) {
        std::size_t at = k, column = 0;
        for (std::size_t r = k; r < G.size(); ++r)
            for (std::size_t c = 0; c < G[r].size(); ++c)
                if (std::abs(G[r][c]) > std::abs(G[at][column])) at = r, column = c;
        const long double pivot = std::abs(G[at][column]);
        if (pivot < 1e-11L) return static_cast<int>(k);
        if (pivot < 1e-4L) return -1;
        std::swap(G[k], G[at]);
        for (std::size_t r = k + 1; r < G.size(); ++r) {
            const long double factor = G[r][column] / G[k][column];
            for (std::size_t c = 0; c < G[r].size(); ++c) G[r][c] -= factor * G[k][c];
        }
    }
    return static_cast<int>(G.size());
}

// Any graph of joints of any kind: trees, loops, joints side by side.
TEST(Rank, AgreesWithCompletePivotingOnRandomGraphs)
{
    int compared = 0, redundant = 0;
    for (unsigned seed = 0; seed < 300; ++seed) {
        Linkage l(seed, {.unit = std::pow(10.0, static_cast<double>(seed % 7) - 3)});
        const int n = 2 + static_cast<int>(seed % 5);
        const auto any = [&](int most) {
            return static_cast<int>(std::floor(0.5 * (l.random.number() + 1) * most));
        };
        for (int b = 0; b < n; ++b) {
            l.add_link(l.random.vector());
            l.any_joint(any(b + 1) - 1, b, any(4) == 0);
        }
        for (int k = any(3); k > 0; --k) l.any_joint(any(n) - 1, n - 1, false);
        const std::vector<Matrix34> X = l.model.start().X;
        const int expected = rank_by_elimination(l.model, X);
        if (expected < 0) continue;
        ++compared;
        redundant += expected < l.model.n_rows();
        const RowRank rank = row_rank(l.model, X, all_rows(l.model));
        EXPECT_EQ(static_cast<int>(rank.independent.size()), expected) << seed;
        EXPECT_EQ(static_cast<int>(rank.dependent.size()), l.model.n_rows() - expected) << seed;
    }
    EXPECT_GT(compared, 270);
    EXPECT_GT(redundant, 50);
}

TEST(Rank, SeesWhatOneAxisOutOfParallelTakesAway)
{
    // Negative control: the count must be able to fail.
    const auto tilted = [](unsigned seed, double tilt) {
        Linkage l(seed, {.largest_power = 15});
        for (int b = 0; b < 3; ++b) l.add_link(l.random.vector());
        for (int k = 0; k <= 3; ++k)
            l.hinge(k == 0 ? world : k - 1, k == 3 ? world : k, {1.0 * k, 0.3 * k * k, 0},
                    {k == 2 ? tilt : 0, 0, 1});
        return consistent_start(l.model, l.model.start(), StartPolicy::check).independent.size();
    };
    EXPECT_EQ(tilted(3, 0), 17u);
    EXPECT_EQ(tilted(3, 1e-3), 18u);
}

}   // namespace
}   // namespace livens::rank_test
