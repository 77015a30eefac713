// SPDX-License-Identifier: BSD-3-Clause
// The twist reduction against plain rotation matrices.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "livens/base/linear.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/body.h"

namespace livens::twist_test {
namespace {

class Dice {
public:
    explicit Dice(unsigned seed) : engine_(seed) {}
    double operator()() { return 2 * (static_cast<double>(engine_() >> 11) * 0x1p-53) - 1; }
    Vector3 vector() { return {(*this)(), (*this)(), (*this)()}; }
    Matrix34 rigid() { return configuration(vector(), directors_from_rotation_vector(3.0 * vector())); }
    Matrix34 any()
    {
        return configuration(vector(), {(*this)(), (*this)(), (*this)(), (*this)(), (*this)(), (*this)(),
                                        (*this)(), (*this)(), (*this)()});
    }

private:
    std::mt19937_64 engine_;
};

TEST(Twist, DisplacementIsTheRotatedConfigurationLessTheStart)
{
    Dice dice(1);
    for (int trial = 0; trial < 100; ++trial) {
        const Matrix34 X0 = dice.rigid();
        const Vector3 u = dice.vector(), turn = 2.0 * dice.vector();
        Matrix34 dX{};
        const double move[6] = {u[0], u[1], u[2], turn[0], turn[1], turn[2]};
        twist::displacement(move, X0.data(), dX.data());
        const Matrix34 X =
            configuration(X0.column(0) + u, directors_from_rotation_vector(turn) * directors(X0));
        EXPECT_LT(norm(X0 + dX - X), 1e-14);
    }
}

TEST(Twist, SmallIncrementsKeepTheirDigits)
{
    // a turn of 1e-9: the director moves by 1e-9 to 16 digits of that, which a difference of directors cannot
    // show
    const Matrix34 X0 = configuration({5, 5, 5}, identity<3>());
    const double move[6] = {1e-9, 0, 0, 0, 0, 1e-9};
    Matrix34 dX{};
    twist::displacement(move, X0.data(), dX.data());
    EXPECT_NEAR(dX(1, 1) / 1e-9, 1, 1e-15);
    EXPECT_NEAR(dX(0, 1) / -5e-19, 1, 1e-9);
    EXPECT_EQ(dX(2, 1), 0.0);
}

TEST(Twist, QuaternionsAreReadOffDisplacements)
{
    Dice dice(2);
    for (const double size : {1.5, 1e-3, 1e-9}) {
        const Matrix34 X0 = dice.rigid();
        const Vector3 w = size * dice.vector();
        const double move[6] = {0.1, 0.2, 0.3, w[0], w[1], w[2]};
        Matrix34 dX{}, again{};
        twist::displacement(move, X0.data(), dX.data());
        double q[4];
        twist::quaternion_of(X0.data(), dX.data(), q);
        EXPECT_NEAR(q[0], std::cos(0.5 * norm(w)), 1e-14);
        twist::displacement(move, q, X0.data(), again.data());
        EXPECT_LT(norm(again - dX), 1e-14 * (size + 1e-3));
    }
}

TEST(Twist, TurnsBetweenTriadsLeadFromOneToTheOther)
{
    Dice dice(7);
    for (int trial = 0; trial < 20; ++trial) {
        const Matrix34 from = dice.rigid(), to = dice.rigid();
        const Vector3 turn = twist::turn_between(from, to);
        EXPECT_LE(norm(turn), 3.1415926535897936);
        EXPECT_LT(norm(directors(twist::moved(from, {1, 2, 3}, turn)) - directors(to)), 1e-14);
    }
}

TEST(Twist, PlanarIncrementsStayPlanarToTheBit)
{
    Matrix34 X0 = configuration({1, 0, 2}, directors_from_rotation_vector({0, 0.3, 0})), dX{};
    for (int step = 0; step < 50; ++step) {
        const double move[6] = {0.1, 0, -0.2, 0, 0.37, 0};
        twist::displacement(move, X0.data(), dX.data());
        X0 += dX;
    }
    for (int column : {0, 1, 3}) EXPECT_EQ(dX(1, column), 0.0);
    EXPECT_EQ(dX(0, 2), 0.0);
    EXPECT_EQ(dX(1, 2), 0.0);
    EXPECT_EQ(dX(2, 2), 0.0);
}

TEST(Twist, RowsAreTheTransposeOfColumns)
{
    Dice dice(3);
    for (int trial = 0; trial < 50; ++trial) {
        const Matrix34 X = dice.any(), r = dice.any();
        const double xi[6] = {dice(), dice(), dice(), dice(), dice(), dice()};
        Matrix34 dX{};
        twist::columns(X.data(), xi, dX.data());
        double rows[6] = {};
        twist::rows(X.data(), r.data(), rows);
        double sum = 0;
        for (int i = 0; i < 6; ++i) sum += rows[i] * xi[i];
        EXPECT_NEAR(sum, dot(r, dX), 1e-14);
    }
}

TEST(Twist, RowsLoseTheRigidityMultipliers)
{
    Dice dice(4);
    const Matrix34 X = dice.rigid();
    Matrix3 lambda{};
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b <= a; ++b) lambda(a, b) = lambda(b, a) = dice();
    const Matrix34 r = configuration({0, 0, 0}, directors(X) * lambda);
    double rows[6] = {};
    twist::rows(X.data(), r.data(), rows);
    for (double v : rows) EXPECT_NEAR(v, 0, 1e-15);
    // negative control: a matrix that is not symmetric is no rigidity multiplier
    lambda(0, 1) += 1;
    const Matrix34 wrong = configuration({0, 0, 0}, directors(X) * lambda);
    double seen[6] = {};
    twist::rows(X.data(), wrong.data(), seen);
    EXPECT_GT(std::abs(seen[3]) + std::abs(seen[4]) + std::abs(seen[5]), 0.5);
}

TEST(Twist, BlockIsTheBilinearFormBetweenColumns)
{
    Dice dice(5);
    for (int trial = 0; trial < 20; ++trial) {
        const Matrix34 X = dice.any(), Y = dice.any();
        Matrix4 c{};
        for (double& v : c.a) v = dice();
        double block[36] = {};
        twist::add_block(c.data(), X.data(), Y.data(), 0.7, block, 6);
        for (int i = 0; i < 6; ++i) {
            for (int j = 0; j < 6; ++j) {
                double ei[6] = {}, ej[6] = {};
                ei[i] = ej[j] = 1;
                Matrix34 dX{}, dY{};
                twist::columns(X.data(), ei, dX.data());
                twist::columns(Y.data(), ej, dY.data());
                EXPECT_NEAR(block[6 * i + j], 0.7 * dot(dX * c, dY), 1e-14) << i << " " << j;
            }
        }
    }
}

TEST(Twist, GeometricTermIsTheDerivativeOfTheRows)
{
    Dice dice(6);
    const Matrix34 X = dice.rigid(), r = dice.any();
    double block[36] = {};
    twist::add_geometric(X.data(), r.data(), block, 6);
    const double eps = 1e-6;
    for (int j = 0; j < 6; ++j) {
        double rows[2][6] = {};
        for (int side = 0; side < 2; ++side) {
            double move[6] = {};
            move[j] = side == 0 ? -eps : eps;
            Matrix34 dX{};
            twist::displacement(move, X.data(), dX.data());
            const Matrix34 moved = X + dX;
            twist::rows(moved.data(), r.data(), rows[side]);
        }
        for (int i = 0; i < 6; ++i)
            EXPECT_NEAR(block[6 * i + j], (rows[1][i] - rows[0][i]) / (2 * eps), 1e-9);
    }
}

}   // namespace
}   // namespace livens::twist_test
