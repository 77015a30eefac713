// SPDX-License-Identifier: BSD-3-Clause
// The velocity jump of motions whose polynomial is known, and the error that it stands for.
#include <gtest/gtest.h>

#include <cmath>

#include "livens/diagnostics/diagnostics.h"
#include "unit/diagnostics/hand_made.h"

namespace livens::velocity_jump_test {
namespace {

Model two_particles()
{
    Model model;
    model.add_body(point_mass("one", 1, {0, 0, 0}));
    model.add_body(point_mass("two", 1, {2, 0, 0}));
    return model;   // of length 2: centres are 1 from their mean
}

/// x = t^2 for the second particle, on one straight piece from 0 to h: its slope is h, its velocities 0 and
/// 2h.
Motion bent(double h)
{
    return hand_made::motion(two_particles(), {{0, h}}, 1, [](double t) {
        State s{t, {}, {}};
        for (const double x : {0.0, 2 + t * t}) s.X.push_back({{x, 0, 0}});
        for (const double v : {0.0, 2 * t}) s.V.push_back({{v, 0, 0}});
        return s;
    });
}

TEST(VelocityJump, IsThatAtTheEndAndWithRadauPointsAtTheStart)
{
    const double h = 0.3;
    Motion motion = bent(h);
    motion.velocities[3].set_column(0, {5 * h, 0, 0});   // the end of the second: 4 h from the slope
    EXPECT_NEAR(velocity_jump(two_particles(), motion).largest, h * 4 * h / 2, 1e-15);
    motion.X.points = Points::radau;   // of degree 1: the same nodes
    EXPECT_NEAR(velocity_jump(two_particles(), motion).largest, h * h / 2, 1e-15);
    EXPECT_EQ(velocity_jump(two_particles(), motion).time, h);
}

TEST(LocalError, HasTheOrderOfTheElement)
{
    // J is of order h^(p + 1): half of h makes the error 2^(2p + 1) or 2^(2p) times smaller
    for (int p = 1; p <= 16; ++p) {
        const double finer = 1e-3, coarser = std::ldexp(finer, p + 1);
        EXPECT_NEAR(local_error(Points::lobatto, p, coarser) / local_error(Points::lobatto, p, finer),
                    std::pow(2, 2 * p + 1), 1e-9 * std::pow(2, 2 * p + 1));
        EXPECT_NEAR(local_error(Points::radau, p, coarser) / local_error(Points::radau, p, finer),
                    std::pow(2, 2 * p), 1e-9 * std::pow(2, 2 * p));
    }
    EXPECT_EQ(local_error(Points::lobatto, 4, 1), 0.04);
    EXPECT_EQ(local_error(Points::lobatto, 16, 1), 0.04);
    EXPECT_EQ(local_error(Points::radau, 8, 1), 0.15);
    EXPECT_EQ(local_error(Points::radau, 3, 0), 0);
}

}   // namespace
}   // namespace livens::velocity_jump_test
