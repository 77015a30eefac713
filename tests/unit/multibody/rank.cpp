// SPDX-License-Identifier: BSD-3-Clause
// The rank of joint rows is geometry: masses, units, the place and reference points do not matter.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "linkages.h"
#include "livens/multibody/closing.h"
#include "livens/multibody/singular.h"

namespace livens {
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
            const ClosedStart a = close_start(model, model.start(), StartPolicy::check);
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
        const ClosedStart a = close_start(l.model, l.model.start(), StartPolicy::check);
        EXPECT_EQ(static_cast<int>(a.independent.size()), 5 * n) << seed;
    }
}

// At the cost of dense matrices this takes minutes.
TEST(Rank, OfLongChainsAndRingsIsFoundAlongTheJoints)
{
    const int n = 400;
    const auto closed = [](const Model& model) {
        return close_start(model, model.start(), StartPolicy::check);
    };
    const Model chain = open_chain(1, n, {});
    EXPECT_EQ(closed(chain).redundant, std::vector<int>{});
    const Model flat = ring(2, n, {}, true);
    const ClosedStart start = closed(flat);
    EXPECT_EQ(static_cast<int>(start.independent.size()), 5 * n + 2);
    for (const int row : start.redundant)
        EXPECT_EQ(flat.row_joint(row), n) << "the joint that closes the ring";
    EXPECT_FALSE(mobility(flat, start).is_singular());
    EXPECT_EQ(static_cast<int>(closed(ring(2, n, {}, false)).independent.size()), 5 * n + 5);
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
        return close_start(l.model, l.model.start(), StartPolicy::check).independent.size();
    };
    EXPECT_EQ(tilted(3, 0), 17u);
    EXPECT_EQ(tilted(3, 1e-3), 18u);
}

}   // namespace
}   // namespace livens
