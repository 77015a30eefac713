// SPDX-License-Identifier: BSD-3-Clause
// The tables that the engine reads against the model that they are made of.
#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "workshop.h"

namespace livens::tables_test {
namespace {

constexpr Instant now{0.37};

std::vector<int> every_row(const Model& model)
{
    std::vector<int> rows(static_cast<std::size_t>(model.n_rows()));
    std::iota(rows.begin(), rows.end(), 0);
    return rows;
}

/// Tables of a workshop, and a random state.
struct Bench {
    explicit Bench(unsigned seed, bool rigid = false)
        : random(seed + 50), model(driven_workshop(seed)), tables(model, every_row(model), true),
          x(random_places(model, random, rigid)), maps(x.size(), 0.0)
    {
        tables.bodies.map_twists(x.data(), maps.data());
    }

    Numbers any(std::size_t n)
    {
        Numbers v(n);
        for (double& entry : v) entry = random.number();
        return v;
    }
    Numbers any_twist() { return any(static_cast<std::size_t>(tables.n_twists)); }
    Numbers any_rates()
    {
        Numbers v = any(x.size());
        for (int b = 0; b < model.n_bodies(); ++b)
            if (model.bodies()[b].is_point) std::fill_n(v.begin() + 12 * b + 3, 9, 0.0);
        return v;
    }
    /// dX of scaled twists.
    Numbers rates(const Numbers& y) const
    {
        Numbers xi(y.size()), dX(x.size());
        tables.bodies.to_twist(maps.data(), y.data(), xi.data());
        tables.bodies.rates_of(x.data(), xi.data(), dX.data());
        return dX;
    }
    Numbers momenta(const Numbers& dX) const
    {
        Numbers P(x.size());
        tables.bodies.times_mass(dX.data(), 1.0, P.data());
        return P;
    }

    Random random;
    Model model;
    ModelTables tables;
    Numbers x, maps;
};

int n_rows(const Bench& bench) { return static_cast<int>(bench.tables.rows.size()); }

TEST(ModelTables, ValuesAreThoseOfTheRows)
{
    for (unsigned seed = 1; seed <= 10; ++seed) {
        const Bench bench(seed);
        for (int r = 0; r < n_rows(bench); ++r) {
            const double phi = phi_of(*bench.tables.rows[r].row, now, bench.x);
            EXPECT_NEAR(bench.tables.rows.value(r, now, bench.x.data()), phi, 2e-13) << r;
            Numbers g = untouched();
            bench.tables.rows.gradient(r, now, bench.x.data(), g.data());
            EXPECT_NEAR(bench.tables.rows.value(r, now, bench.x.data(), g.data()), phi, 2e-13) << r;
        }
    }
}

TEST(ModelTables, GradientsAreDifferencesOfValues)
{
    double least_control = 1;
    for (unsigned seed = 1; seed <= 10; ++seed) {
        const Bench bench(seed);
        for (int r = 0; r < n_rows(bench); ++r) {
            const Numbers g = table_gradient(bench.tables, r, now, bench.x);
            const Numbers differences = gradient_of(*bench.tables.rows[r].row, now, bench.x);
            EXPECT_LT(furthest(g, differences), 1e-12) << r;
            // negative control: one side with the other sign
            const int body = bench.tables.rows[r].bodies[0];
            Numbers wrong = g;
            for (int i = 12 * body; i < 12 * body + 12; ++i) wrong[i] *= -1;
            least_control = std::min(least_control, furthest(wrong, differences));
        }
    }
    EXPECT_GT(least_control, 0.02);
}

TEST(ModelTables, HessiansAreDifferencesOfGradients)
{
    for (unsigned seed = 1; seed <= 5; ++seed) {
        Bench bench(seed);
        const Numbers step = bench.any(bench.x.size());
        for (int r = 0; r < n_rows(bench); ++r) {
            const RowTable& row = bench.tables.rows[r];
            for (int moving = 0; moving < row.n_sides; ++moving) {
                Numbers there = bench.x;
                for (int i = 0; i < 12; ++i) {
                    const int at = 12 * row.bodies[moving] + i;
                    there[at] += step[at];
                }
                const Numbers before = table_gradient(bench.tables, r, now, bench.x),
                              after = table_gradient(bench.tables, r, now, there);
                for (int side = 0; side < row.n_sides; ++side) {
                    const int body = row.bodies[side];
                    const auto H = constraint_hessian(*row.row, now, Configurations(bench.x.data()), body,
                                                      row.bodies[moving]);
                    Matrix<12, 1> moved{}, change{};
                    std::copy_n(step.data() + 12 * row.bodies[moving], 12, moved.a);
                    for (int i = 0; i < 12; ++i) change[i] = after[12 * body + i] - before[12 * body + i];
                    EXPECT_LT(norm(H * moved - change), 1e-12) << r << ", " << moving << side;
                }
            }
        }
    }
}

TEST(ModelTables, RatesAreDerivativesInTime)
{
    for (unsigned seed = 1; seed <= 5; ++seed) {
        const Bench bench(seed);
        const double* X = bench.x.data();
        int driven = 0;
        for (int r = 0; r < n_rows(bench); ++r) {
            const auto standing = [&](double s) { return bench.tables.rows.value(r, {now.t + s}, X); };
            const double rate = bench.tables.rows.rate(r, now, X);
            EXPECT_NEAR(rate, derivative(standing, 1), 1e-8);
            const Instant later{1.9};
            const Numbers none(bench.x.size(), 0.0);
            EXPECT_NEAR(constraint_change(*bench.tables.rows[r].row, now, Configurations(X), later,
                                          Configurations(X), Configurations(none.data())),
                        standing(later.t - now.t) - standing(0), 1e-13);
            const bool is_driven = !bench.tables.rows[r].is_quadratic;
            EXPECT_EQ(is_driven, rate != 0) << r;
            if (!is_driven) continue;
            ++driven;
            EXPECT_GT(std::abs(-rate - derivative(standing, 1)), 1e-4) << "negative control";
        }
        EXPECT_EQ(driven, 5);
    }
}

TEST(ModelTables, CurvatureIsTheSecondDerivativeOnAStraightLine)
{
    for (unsigned seed = 1; seed <= 5; ++seed) {
        Bench bench(seed);
        const Numbers v = bench.any_rates(), rest(v.size(), 0.0);
        std::vector<int> coupled;
        for (int r = 0; r < n_rows(bench); ++r) {
            const double wanted = curvature_of(*bench.tables.rows[r].row, now, bench.x, v);
            EXPECT_NEAR(bench.tables.rows.curvature(r, now, bench.x.data(), v.data()), wanted, 1e-6) << r;
            // negative control: the angle's drive turns with the bodies, which adds 2 f' <gradient, V>
            const double standing = bench.tables.rows.curvature(r, now, bench.x.data(), rest.data());
            const double moving = curvature_of(frozen(*bench.tables.rows[r].row, now), now, bench.x, v);
            if (std::abs(standing + moving - wanted) > 1e-3) coupled.push_back(r);
        }
        EXPECT_EQ(coupled, std::vector<int>{bench.model.n_rows() - 1});
    }
}

TEST(ModelTables, RowsOfTheWorldHaveOneSide)
{
    const Bench bench(3);
    int held = 0;
    for (const RowTable& row : bench.tables.rows) {
        EXPECT_EQ(row.n_sides, row.row->body_i == world ? 1 : 2);
        EXPECT_EQ(row.bodies[row.n_sides - 1], row.row->body_j);
        held += row.row->body_i == world;
        for (int side = 0; side < row.n_sides; ++side)
            if (bench.model.bodies()[row.bodies[side]].is_point) {
                EXPECT_EQ(std::vector<int>(row.columns[side].begin(), row.columns[side].end()),
                          std::vector<int>{0})
                    << "a point has no directors";
            }
    }
    EXPECT_GT(held, 1);
}

TEST(ModelTables, RigidityFollowsTheJointsWhereItIsAskedFor)
{
    const Bench bench(4, true);
    const int n = bench.model.n_rows();
    EXPECT_EQ(n_rows(bench), n + 6 * 5) << "a point has none";
    for (int r = n; r < n_rows(bench); ++r)
        EXPECT_NEAR(bench.tables.rows.value(r, now, bench.x.data()), 0, 1e-15);
    const ModelTables without(bench.model, every_row(bench.model));
    EXPECT_EQ(static_cast<int>(without.rows.size()), n);
    EXPECT_EQ(without.freedoms(), without.n_twists - n);
    EXPECT_EQ(without.n_twists, 6 * 5 + 3);
}

TEST(ModelTables, ScaledTwistsMeasureKineticEnergy)
{
    for (unsigned seed = 1; seed <= 10; ++seed) {
        Bench bench(seed, true);
        ASSERT_TRUE(bench.tables.bodies.are_regular());
        const Numbers y = bench.any_twist(), dX = bench.rates(y);
        double energy = 0;
        for (int b = 0; b < bench.model.n_bodies(); ++b) {
            const Matrix34 V = body_of(dX, b);
            energy += 0.5 * dot(V * bench.model.bodies()[b].mass, V);
        }
        EXPECT_NEAR(energy, 0.5 * inner(y, y), 1e-12 * energy);
        // negative control: twists of reference points that are meant of centres
        Numbers maps = bench.maps, xi(y.size()), wrong(dX.size());
        for (int b = 0; b < bench.model.n_bodies(); ++b) std::fill_n(maps.begin() + 12 * b + 9, 3, 0.0);
        bench.tables.bodies.to_twist(maps.data(), y.data(), xi.data());
        bench.tables.bodies.rates_of(bench.x.data(), xi.data(), wrong.data());
        EXPECT_GT(std::abs(0.5 * inner(wrong, bench.momenta(wrong)) - energy), 1e-3 * energy);
    }
}

TEST(ModelTables, ScaledGradientsTakeScaledTwists)
{
    for (unsigned seed = 1; seed <= 10; ++seed) {
        Bench bench(seed, true);
        const Numbers y = bench.any_twist(), dX = bench.rates(y);
        for (int r = 0; r < bench.model.n_rows(); ++r) {
            Numbers g = untouched(), row(y.size());
            bench.tables.rows.gradient(r, now, bench.x.data(), g.data());
            bench.tables.scaled_gradient(r, bench.x.data(), bench.maps.data(), g.data(), row.data());
            const double wanted = inner(gradient_of(*bench.tables.rows[r].row, now, bench.x), dX);
            EXPECT_NEAR(inner(row, y), wanted, 1e-12 * (1 + std::sqrt(inner(row, row)))) << r;
        }
    }
}

TEST(ModelTables, WrenchesAreForcesAndMomentsAboutTheCentre)
{
    Bench bench(2, true);
    for (int r = 0; r < bench.model.n_rows(); ++r) {
        Numbers g = untouched();
        bench.tables.rows.gradient(r, now, bench.x.data(), g.data());
        const Numbers full = table_gradient(bench.tables, r, now, bench.x);
        for (int side = 0; side < bench.tables.rows[r].n_sides; ++side) {
            const int body = bench.tables.rows[r].bodies[side];
            if (bench.model.bodies()[body].is_point) continue;
            double q[6];
            bench.tables.wrench(r, side, bench.x.data(), bench.maps.data(), g.data(), q);
            const Matrix34 X = body_of(bench.x, body), G = body_of(full, body);
            const Vector3 c = mass_properties(bench.model.bodies()[body].mass).center_of_mass;
            Vector3 moment = -1.0 * cross(directors(X) * c, G.column(0));
            for (int a = 1; a < 4; ++a) moment += cross(X.column(a), G.column(a));
            EXPECT_LT(norm(Vector3{q[0], q[1], q[2]} - G.column(0)), 1e-14);
            EXPECT_LT(norm(Vector3{q[3], q[4], q[5]} - moment), 1e-13);
            Numbers sum(static_cast<std::size_t>(bench.tables.n_twists), 1.0);
            bench.tables.add_wrenches(r, bench.x.data(), bench.maps.data(), g.data(), 2, sum.data());
            for (int i = 0; i < 6; ++i) EXPECT_EQ(sum[bench.tables.bodies[body].first + i], 1 + 2 * q[i]);
        }
    }
}

TEST(ModelTables, ScaledRowsAreTheTransposeOfScaledTwists)
{
    for (unsigned seed = 1; seed <= 10; ++seed) {
        Bench bench(seed, true);
        const Numbers y = bench.any_twist(), dX = bench.rates(y), raw = bench.any_rates();
        Numbers q(y.size()), rows(y.size());
        bench.tables.bodies.twist_rows(bench.x.data(), bench.maps.data(), raw.data(), q.data());
        bench.tables.bodies.to_scaled_rows(bench.maps.data(), q.data(), rows.data());
        EXPECT_NEAR(inner(rows, y), inner(raw, dX), 1e-12);
    }
}

/// The lower right 3 x 3 part of D_A^T N_A^T M N_B D_B of one body, column by column.
std::vector<double> spin_mass_by_columns(const Bench& from, const Bench& to, int body)
{
    const ModelTables& tables = from.tables;
    std::vector<double> block;
    for (int j = 0; j < 3; ++j) {
        Numbers y(static_cast<std::size_t>(tables.n_twists), 0.0), q(y.size()), rows(y.size());
        y[tables.bodies[body].first + 3 + j] = 1;
        const Numbers P = to.momenta(to.rates(y));
        tables.bodies.twist_rows(from.x.data(), from.maps.data(), P.data(), q.data());
        tables.bodies.to_scaled_rows(from.maps.data(), q.data(), rows.data());
        for (int i = 0; i < 3; ++i) block.push_back(rows[tables.bodies[body].first + 3 + i]);
    }
    return block;
}

TEST(ModelTables, SpinMassIsTheMassBetweenTwoConfigurations)
{
    for (unsigned seed = 1; seed <= 5; ++seed) {
        Bench A(seed, true), B(seed, true);
        B.x = random_places(B.model, B.random, true);
        B.tables.bodies.map_twists(B.x.data(), B.maps.data());
        for (int b = 0; b < A.model.n_bodies(); ++b) {
            if (A.model.bodies()[b].is_point) continue;
            Numbers H(9), exchanged(9), same(9);
            A.tables.bodies.spin_mass(b, A.x.data(), B.x.data(), H.data());
            EXPECT_LT(furthest(H, spin_mass_by_columns(A, B, b)), 1e-13);
            A.tables.bodies.spin_mass(b, A.x.data(), A.x.data(), same.data());
            EXPECT_LT(furthest(same, {1, 0, 0, 0, 1, 0, 0, 0, 1}), 1e-13);
            // negative control: from the second to the first it is the transpose
            A.tables.bodies.spin_mass(b, B.x.data(), A.x.data(), exchanged.data());
            EXPECT_GT(furthest(H, exchanged), 1e-3);
        }
    }
}

TEST(ModelTables, MassesAreThoseOfTheBodies)
{
    Bench bench(6);
    const Numbers Y = bench.any_rates();
    Numbers out(Y.size(), 7.0);
    bench.tables.bodies.times_mass(Y.data(), -1.5, out.data());
    for (int b = 0; b < bench.model.n_bodies(); ++b) {
        const Matrix4& m = bench.model.bodies()[b].mass;
        EXPECT_LT(norm(body_of(out, b) - -1.5 * (body_of(Y, b) * m)), 1e-12 * norm(m));
    }
}

TEST(ModelTables, WeightPullsAtTheCentresOfMass)
{
    Bench bench(7, true);
    const Numbers dX = bench.rates(bench.any_twist());
    Numbers raw(dX.size(), 0.0);
    bench.tables.bodies.add_weight(2.0, raw.data());
    double power = 0;
    for (int b = 0; b < bench.model.n_bodies(); ++b) {
        const MassProperties p = mass_properties(bench.model.bodies()[b].mass);
        const Vector4 c = bench.model.bodies()[b].is_point ? point({}) : point(p.center_of_mass);
        power += 2 * p.mass * dot(bench.model.gravity(), body_of(dX, b) * c);
    }
    EXPECT_NEAR(inner(raw, dX), power, 1e-11 * std::abs(power));
}

TEST(ModelTables, LoadsAreThoseOfTheModel)
{
    Bench bench(8);
    const Numbers V = bench.any_rates();
    Numbers sum(V.size(), 0.0), wanted(V.size(), 0.0);
    bench.tables.loads.add(now, bench.x.data(), V.data(), -3.0, sum.data());
    for (int l = 0; l < static_cast<int>(bench.model.loads().size()); ++l) {
        const Load& load = bench.model.loads()[l];
        LoadArguments asked;
        asked.at = now;
        LoadForces forces{};
        for (int side = 0; side < 2; ++side) {
            if (load.bodies[side] == world) continue;
            asked.X[side] = body_of(bench.x, load.bodies[side]);
            asked.V[side] = body_of(V, load.bodies[side]);
        }
        const LoadArguments given = bench.tables.loads.arguments(l, now, bench.x.data(), V.data());
        for (int side = 0; side < 2; ++side) {
            EXPECT_EQ(given.X[side], asked.X[side]);
            EXPECT_EQ(given.V[side], asked.V[side]);
        }
        load.forces(asked, forces);
        for (int side = 0; side < 2; ++side)
            for (int i = 0; load.bodies[side] != world && i < 12; ++i)
                wanted[12 * load.bodies[side] + i] -= 3 * forces[side].a[i];
    }
    EXPECT_LT(furthest(sum, wanted), 1e-12);
    EXPECT_GT(inner(sum, sum), 1) << "negative control: there are loads";
    EXPECT_EQ(bench.tables.loads.with_tangent, (std::vector<int>{0, 1, 2}));
}

TEST(ModelTables, TheFirstLoadThatIsNotFiniteIsNamed)
{
    Model model = workshop(9);
    Random random(1);
    const Numbers x = random_places(model, random, true), V(x.size(), 0.0);
    Load bad = point_force("bad", 3, {}, {1, 0, 0}, Frame::inertial);
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), 1e308 * 10}) {
        Model with = model;
        bad.forces = [value](const LoadArguments& a, LoadForces& F) { F[0].a[0] = a.at.t > 1 ? value : 1; };
        const int index = with.add_load(bad);
        with.add_load(point_force("good", 3, {}, {1, 0, 0}, Frame::inertial));
        const ModelTables tables(with, {});
        EXPECT_EQ(tables.loads.bad({2.0}, x.data(), V.data()), index);
        EXPECT_EQ(tables.loads.bad({0.5}, x.data(), V.data()), -1);
    }
}

TEST(ModelTables, BodiesWithoutInertiaKeepTheirMassAndLoseTheMetric)
{
    Model model;
    model.add_body(rigid_body("needle", {2, {0.3, 0, 0}, {0, 0, 0, 0, 0.5, 0, 0, 0, 0.5}}));
    const ModelTables tables(model, {});
    EXPECT_FALSE(tables.bodies.are_regular());
    Random random(2);
    const Numbers x = flat({random.rigid()});
    Numbers maps(12, 0.0), y{0, 0, 0, 1, 0, 0}, xi(6), dX(12), P(12);
    tables.bodies.map_twists(x.data(), maps.data());
    tables.bodies.to_twist(maps.data(), y.data(), xi.data());
    tables.bodies.rates_of(x.data(), xi.data(), dX.data());
    tables.bodies.times_mass(dX.data(), 1.0, P.data());
    EXPECT_TRUE(std::isfinite(inner(dX, dX)));
    EXPECT_NEAR(inner(dX, P), 0, 1e-13) << "the spin about its axis carries no energy";
    EXPECT_GT(inner(dX, dX), 1e-3);
}

/// A row that is closed stays so hundreds of kilometres away: squares of places would leave 1e-5 there.
TEST(Tables, ValuesKeepTheirDigitsFarFromTheOrigin)
{
    for (const double away : {0.0, 1e6 / 3}) {
        Model model;
        model.add_body(point_mass("one", 1, {away, away, 0}));
        model.add_body(point_mass("other", 1, {away + 0.75, away + 1, 0}));
        model.add_joint(rod("rod", 0, 1, {}, 1.25));
        const ModelTables tables(model, every_row(model));
        std::vector<double> X;
        for (const Body& body : model.bodies()) X.insert(X.end(), std::begin(body.X.a), std::end(body.X.a));
        EXPECT_LT(std::abs(tables.rows.value(0, now, X.data())), 1e-9) << away;
        X[12] += 1e-3;
        EXPECT_GT(std::abs(tables.rows.value(0, now, X.data())), 1e-5) << away;
    }
}

}   // namespace
}   // namespace livens::tables_test
