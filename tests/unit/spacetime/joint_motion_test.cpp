// SPDX-License-Identifier: BSD-3-Clause
// What joints let bodies do, at the nodes of an element side by side.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "livens/spacetime/elements/kernel_functions.h"
#include "unit/spacetime/kernel_comparison.h"

namespace livens::joint_motion_test {
namespace {

constexpr double least = 1e-6;

/// Rows of a joint (m, d; A) and (m, n; A), and what move_joint() makes of them.
struct Joint {
    lanes::JointSize size;
    std::vector<double> own, above, z, T;

    Joint(lanes::JointSize of, Random& random)
        : size(of), own(of.m * of.d * of.p), above(of.m * of.n * of.p), z(of.d * (of.d - of.m) * of.p),
          T(of.d * of.n * of.p)
    {
        for (auto* rows : {&own, &above})
            for (double& entry : *rows) entry = random.number();
        for (int i = 0; i < of.m * of.d; ++i)   // of nodes, which differ by little
            for (int A = 1; A < of.p; ++A) own[i * of.p + A] = own[i * of.p] + 0.05 * random.number();
    }
    bool move() { return functions().move_joint(own.data(), above.data(), size, least, z.data(), T.data()); }
    static const lanes::BlockFunctions& functions() { return *lanes::functions(8)->blocks; }
    double at(const std::vector<double>& M, int i, int j, int columns, int A) const
    {
        return M[(i * columns + j) * size.p + A];
    }
    /// The largest entry of G z, G_c T + G_p and z^T z - 1 at a node.
    double error(int A) const
    {
        const int f = size.d - size.m;
        double largest = 0;
        const auto add = [&](double entry) { largest = std::max(largest, std::abs(entry)); };
        for (int r = 0; r < size.m; ++r) {
            for (int k = 0; k < f; ++k) {
                double sum = 0;
                for (int i = 0; i < size.d; ++i) sum += at(own, r, i, size.d, A) * at(z, i, k, f, A);
                add(sum);
            }
            for (int j = 0; j < size.n; ++j) {
                double sum = at(above, r, j, size.n, A);
                for (int i = 0; i < size.d; ++i) sum += at(own, r, i, size.d, A) * at(T, i, j, size.n, A);
                add(sum);
            }
        }
        for (int k = 0; k < f; ++k)
            for (int l = 0; l < f; ++l) {
                double sum = k == l ? -1 : 0;
                for (int i = 0; i < size.d; ++i) sum += at(z, i, k, f, A) * at(z, i, l, f, A);
                add(sum);
            }
        return largest;
    }
};

TEST(JointMotion, KeepsRowsAtAllNodesAtOnce)
{
    with_all_instructions([] {
        Random random(7);
        int moved = 0, all = 0;
        for (const int d : {3, 6})
            for (int m = 0; m < d; ++m)
                for (const int n : {0, 3, 6})
                    for (int p = 4; p <= 9; ++p) {
                        Joint joint({m, d, n, p}, random);
                        ++all;
                        if (!joint.move()) continue;   // rows that nearly hang together by chance
                        ++moved;
                        for (int A = 0; A < p; ++A)
                            EXPECT_LT(joint.error(A), 1e-10) << m << ' ' << d << ' ' << n << ' ' << p;
                    }
        EXPECT_GT(moved, 9 * all / 10);
    });
}

TEST(JointMotion, LeavesRowsThatHangTogetherAndFewNodesToOthers)
{
    with_all_instructions([] {
        Random random(8);
        Joint joint({3, 6, 6, 5}, random);
        ASSERT_TRUE(joint.move());
        EXPECT_LT(joint.error(4), 1e-10);
        for (int i = 0; i < 6; ++i)   // at one node the last row is the sum of the others
            joint.own[(12 + i) * 5 + 4] = joint.own[i * 5 + 4] + joint.own[(6 + i) * 5 + 4];
        EXPECT_FALSE(joint.move());
        Joint one({3, 6, 6, 1}, random);
        EXPECT_FALSE(one.move());
    });
}

}   // namespace
}   // namespace livens::joint_motion_test
