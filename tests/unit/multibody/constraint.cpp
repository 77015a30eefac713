// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/constraint.h"

#include <gtest/gtest.h>

#include <functional>

#include "unit/multibody/random_states.h"

namespace livens::constraint_test {
namespace {

using Bodies = std::vector<Matrix34>;

/// A row and the formula it stands for, written out in points and directions.
struct RowCase {
    ConstraintRow row;
    std::function<double(const Matrix34& X_i, const Matrix34& X_j)> formula;
};

/// Every maker with random data, for the bodies i and j.
std::vector<RowCase> row_cases(Random& random, int i, int j)
{
    const Vector4 p = point(random.vector()), q = point(random.vector());
    const Vector4 a = direction(random.unit()), b = direction(random.unit());
    std::vector<RowCase> cases;
    cases.push_back({inner_product_row(i, a, j, b, 0.3, 1),
                     [=](const Matrix34& X, const Matrix34& Y) { return dot(X * a, Y * b) - 0.3; }});
    cases.push_back({distance_row(i, p, j, q, 0.7), [=](const Matrix34& X, const Matrix34& Y) {
                         const Vector3 r = Y * q - X * p;
                         return 0.5 * (dot(r, r) - 0.49);
                     }});
    cases.push_back({plane_row(i, a, p, j, q, 0.2, 1),
                     [=](const Matrix34& X, const Matrix34& Y) { return dot(X * a, Y * q - X * p) - 0.2; }});
    const std::vector<ConstraintRow> coincidence = coincidence_rows(i, p, j, q, 1);
    for (int k = 0; k < 3; ++k)
        cases.push_back(
            {coincidence[k], [=](const Matrix34& X, const Matrix34& Y) { return (Y * q - X * p)[k]; }});
    return cases;
}

TEST(ConstraintRow, MakersMeanTheirFormulas)
{
    Random random(1);
    for (int n = 0; n < 200; ++n)
        for (const RowCase& c : row_cases(random, 0, 1)) {
            const Matrix34 X = random.matrix<3, 4>(), Y = random.matrix<3, 4>();
            EXPECT_EQ(c.row.body_i, 0);
            EXPECT_EQ(c.row.body_j, 1);
            EXPECT_NEAR(constraint_value(c.row, Bodies{X, Y}), c.formula(X, Y), 1e-14) << c.row.label;
        }
}

TEST(ConstraintRow, WorldIsFoldedIntoTheLinearPart)
{
    Random random(2);
    for (int n = 0; n < 200; ++n) {
        const Matrix34 X = random.matrix<3, 4>(), W = world_configuration, junk = random.matrix<3, 4>();
        const Bodies bodies{junk, junk, junk, junk, X};
        for (const RowCase& c : row_cases(random, world, 4)) {
            EXPECT_EQ(c.row.body_i, world);
            EXPECT_EQ(c.row.body_j, 4);
            EXPECT_NEAR(constraint_value(c.row, bodies), c.formula(W, X), 1e-14) << c.row.label;
        }
        // The world as the second body: stored the other way round, the same function with the same sign.
        for (const RowCase& c : row_cases(random, 4, world)) {
            EXPECT_EQ(c.row.body_i, world);
            EXPECT_EQ(c.row.body_j, 4);
            EXPECT_NEAR(constraint_value(c.row, bodies), c.formula(X, W), 1e-14) << c.row.label;
            EXPECT_TRUE(c.row.c_ii == Matrix4{} && c.row.c_ij == Matrix4{} && c.row.b_i == Matrix34{});
        }
    }
}

TEST(ConstraintRow, GradientAndCurvatureAreThoseOfAQuadraticForm)
{
    Random random(3);
    for (int n = 0; n < 100; ++n)
        for (const int i : {world, 0})
            for (const RowCase& c : row_cases(random, i, 1)) {
                const Matrix34 X = random.matrix<3, 4>(), Y = random.matrix<3, 4>();
                const Matrix34 U = random.matrix<3, 4>(), V = random.matrix<3, 4>();
                const double here = constraint_value(c.row, Bodies{X, Y});
                const double ahead = constraint_value(c.row, Bodies{X + U, Y + V});
                const double behind = constraint_value(c.row, Bodies{X - U, Y - V});
                const RowGradient g = constraint_gradient(c.row, Bodies{X, Y});
                // A quadratic: central differences have no error of truncation, whatever the step.
                EXPECT_NEAR(dot(g.of(0), U) + dot(g.of(1), V), 0.5 * (ahead - behind), 1e-13) << c.row.label;
                EXPECT_NEAR(constraint_curvature(c.row, {}, Bodies{X, Y}, Bodies{U, V}),
                            ahead - 2 * here + behind, 1e-13)
                    << c.row.label;
            }
}

TEST(ConstraintRow, CoincidenceOfTwoBodiesHasNoConstantAndNoQuadraticPart)
{
    for (const ConstraintRow& row : coincidence_rows(0, point({1, 2, 3}), 1, point({4, 5, 6}), 2)) {
        EXPECT_EQ(row.c, 0);
        EXPECT_TRUE(row.c_ii == Matrix4{} && row.c_ij == Matrix4{} && row.c_jj == Matrix4{});
        EXPECT_EQ(row.scale, 2);
    }
}

TEST(ConstraintRow, RigidityRowsAreHalfTheMetric)
{
    Random random(4);
    const std::vector<ConstraintRow> rows = rigidity_rows(2);
    ASSERT_EQ(rows.size(), 6u);
    const int pairs[6][2] = {{1, 1}, {2, 2}, {3, 3}, {1, 2}, {1, 3}, {2, 3}};
    for (int n = 0; n < 50; ++n) {
        const Matrix34 X = random.matrix<3, 4>();
        for (int r = 0; r < 6; ++r) {
            const int a = pairs[r][0], b = pairs[r][1];
            const double want = 0.5 * (dot(X.column(a), X.column(b)) - (a == b ? 1 : 0));
            const Bodies bodies{{}, {}, X};
            EXPECT_NEAR(constraint_value(rows[r], bodies), want, 1e-15);
            Matrix34 expected{};
            expected.set_column(a, (a == b ? 1.0 : 0.5) * X.column(b));
            if (a != b) expected.set_column(b, 0.5 * X.column(a));
            EXPECT_LT(largest(constraint_gradient(rows[r], bodies).of(2) - expected), 1e-15);
        }
    }
    for (const ConstraintRow& row : rows) EXPECT_TRUE(row.body_i == world && row.body_j == 2);
}

TEST(ConstraintRow, PlanarDataGiveExactZerosOutOfThePlane)
{
    // Two bodies in the x-z plane that turn about y; points and normals in the plane.
    const Matrix34 X = configuration({0.3, 0, 0.7}, directors_from_rotation_vector({0, 0.4, 0}));
    const Matrix34 Y = configuration({1.1, 0, -0.2}, directors_from_rotation_vector({0, -1.9, 0}));
    const Vector4 p = point({0.1, 0, 0.9}), q = point({-0.6, 0, 0.35}), a = direction({0.6, 0, 0.8});
    const Bodies both{X, Y};
    EXPECT_EQ(constraint_value(coincidence_rows(0, p, 1, q, 1)[1], both), 0);
    EXPECT_EQ(constraint_value(inner_product_row(0, a, 1, direction({0, 1, 0}), 0, 1), both), 0);
    for (const ConstraintRow& row : {distance_row(0, p, 1, q, 1), plane_row(0, a, p, 1, q, 0, 1)}) {
        const RowGradient g = constraint_gradient(row, both);
        for (const int column : {0, 1, 3})
            EXPECT_TRUE(g.of(0)(1, column) == 0 && g.of(1)(1, column) == 0) << row.label;
    }
}

TEST(ConstraintRow, NeedsTwoBodies)
{
    const Vector4 p = point({});
    expect_complaint([&] { distance_row(1, p, 1, p, 1); }, "joint-self");
    expect_complaint([&] { coincidence_rows(world, p, world, p, 1); }, "joint-self");
}

}   // namespace
}   // namespace livens::constraint_test
