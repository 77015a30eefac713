// SPDX-License-Identifier: BSD-3-Clause
// Products of null spaces at two nodes are those of the mass between them, body by body.
#include "livens/multibody/model.h"
#include "livens/spacetime/nodal/mass_products.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "livens/dynamics/rows/twist.h"
#include "livens/solvers/instructions.h"

namespace livens::mass_products_test {
namespace {

/// A body with skew axes and one with its own, both with centres beside their points, and a point mass; and
/// more of these.
Model bodies(int n_more)
{
    Model model({0, 0, 0});
    Placement turned;
    turned.directors = Matrix3{0.8, 0.6, 0, -0.6, 0.8, 0, 0, 0, 1};
    const MassProperties brick = with_center(with_mass(box(1, {1, 0.2, 0.1}), 1.5), {0.5, 0, 0});
    MassProperties skew = brick;
    skew.inertia(0, 1) += 0.003;
    skew.inertia(1, 0) += 0.003;
    skew.inertia(1, 2) -= 0.002;
    skew.inertia(2, 1) -= 0.002;
    model.add_body(rigid_body("skew", skew, turned));
    model.add_body(point_mass("point", 0.4, {0.3, 1.2, 0.9}));
    model.add_body(rigid_body("brick", brick));
    for (int i = 0; i < n_more; ++i)
        model.add_body(point_mass("more " + std::to_string(i), 0.1 * (i + 1), {0.1 * i, 0, 0}));
    return model;
}

/// Of two columns of null spaces, body by body.
double product(const ModelTables& tables, const std::array<std::vector<double>, 2>& X,
               std::array<const double*, 2> z)
{
    const int f = tables.freedoms();
    double sum = 0;
    for (int body = 0; body < tables.n_bodies(); ++body) {
        const int first = tables.bodies[body].first * f;
        const double *left = z[0] + first, *right = z[1] + first;
        for (int r = 0; r < 3; ++r) sum += left[r * f] * right[r * f];
        if (tables.bodies[body].dofs == 3) continue;
        double H[9];
        tables.bodies.spin_mass(body, X[0].data(), X[1].data(), H);
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) sum += left[(3 + r) * f] * H[r + 3 * c] * right[(3 + c) * f];
    }
    return sum;
}

void expect_masses(int n_nodes, int n_more)
{
    const Model model = bodies(n_more);
    const ModelTables tables(model, {}, false);
    ASSERT_FALSE(tables.bodies[0].principal);
    ASSERT_TRUE(tables.bodies[2].principal);
    const int n = tables.n_twists, f = tables.freedoms(), size = 12 * model.n_bodies();
    std::mt19937 engine(7);
    const auto dice = [&engine] { return 2 * (static_cast<double>(engine()) * 0x1p-32) - 1; };
    std::vector<std::vector<double>> X, maps, Z;
    MassProducts products(tables, n_nodes);
    for (int a = 0; a < n_nodes; ++a) {
        X.emplace_back(static_cast<std::size_t>(size));
        maps.emplace_back(X[a]);
        Z.emplace_back(static_cast<std::size_t>(n * f));
        for (int b = 0; b < model.n_bodies(); ++b) {
            const double twist[6] = {dice(), dice(), dice(), dice(), dice(), dice()};
            double by[12] = {};
            const Matrix34& from = model.bodies()[b].X;
            if (!model.bodies()[b].is_point) twist::displacement(twist, from.a, by);
            for (int i = 0; i < 12; ++i) X[a][12 * b + i] = from.a[i] + by[i];
        }
        for (double& z : Z[a]) z = dice();
        tables.bodies.map_twists(X[a].data(), maps[a].data());
    }
    // of all pairs a <= b, f x f each
    std::vector<std::vector<double>> sums(static_cast<std::size_t>(n_nodes * n_nodes),
                                          std::vector<double>(static_cast<std::size_t>(f * f), 0.0));
    EXPECT_EQ(products.n_parts(), n_more < 6 ? 1 : 2);
    for (int part = 0; part < products.n_parts(); ++part) {
        for (int a = 0; a < n_nodes; ++a) products.place(part, a, X[a].data(), maps[a].data(), Z[a].data());
        for (int a = 0; a < n_nodes; ++a) {
            products.multiply(a);
            for (int b = a; b < n_nodes; ++b)
                for (int i = 0; i < f; ++i)
                    for (int j = 0; j < f; ++j)
                        sums[a * n_nodes + b][i * f + j] +=
                            products.product()[i * products.stride() + (b - a) * f + j];
        }
    }
    for (int a = 0; a < n_nodes; ++a) {
        for (int b = a; b < n_nodes; ++b)
            for (int i = 0; i < f; ++i)
                for (int j = 0; j < f; ++j) {
                    const double expected = product(tables, {X[a], X[b]}, {Z[a].data() + i, Z[b].data() + j});
                    EXPECT_NEAR(sums[a * n_nodes + b][i * f + j], expected, 1e-13)
                        << a << ", " << b << ": " << i << ", " << j;
                }
    }
}

TEST(MassProducts, AreThoseOfTheMassBetweenNodes)
{
    const Instructions before = instructions();
    for (const Instructions set : {Instructions::sse2, Instructions::avx2}) {
        if (!use_instructions(set)) continue;
        for (const int n_nodes : {2, 3, 4, 7}) expect_masses(n_nodes, 0);
        for (const int n_more : {1, 5, 6, 9}) expect_masses(3, n_more);
    }
    use_instructions(before);
}

}   // namespace
}   // namespace livens::mass_products_test
