// SPDX-License-Identifier: BSD-3-Clause
// The saddle system of one instant against a dense system in twelve coordinates a body, with multipliers of
// rigidity, made of values of rows and solved by Gaussian elimination.
#include "livens/dynamics/instant/instant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "livens/dynamics/rows/twist.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/model.h"
#include "workshop.h"

namespace livens::instant_test {
namespace {

constexpr Instant now{0.37};

/// x <- A^-1 x with row exchanges; A is made of rows.
Numbers solved(std::vector<Numbers> A, Numbers x)
{
    const std::size_t n = x.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < n; ++i)
            if (std::abs(A[i][k]) > std::abs(A[pivot][k])) pivot = i;
        std::swap(A[k], A[pivot]);
        std::swap(x[k], x[pivot]);
        for (std::size_t i = k + 1; i < n; ++i) {
            const double factor = A[i][k] / A[k][k];
            if (factor == 0) continue;
            for (std::size_t j = k; j < n; ++j) A[i][j] -= factor * A[k][j];
            x[i] -= factor * x[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = k + 1; j < n; ++j) x[k] -= A[k][j] * x[j];
        x[k] /= A[k][k];
    }
    return x;
}

/// Weight and loads, 12 numbers a body.
Numbers forces_on(const Model& model, Instant at, const Numbers& x, const Numbers& v)
{
    Numbers f(x.size(), 0.0);
    const auto add = [&](int body, const Matrix34& F) {
        for (int i = 0; i < 12; ++i) f[12 * body + i] += F.a[i];
    };
    for (int b = 0; b < model.n_bodies(); ++b) add(b, weight(model.bodies()[b], model.gravity()));
    for (const Load& load : model.loads()) {
        LoadForces forces{};
        LoadArguments asked;
        asked.at = at;
        for (std::size_t side = 0; side < 2; ++side) {
            if (load.bodies[side] == world) continue;
            std::copy_n(x.data() + 12 * load.bodies[side], 12, asked.X[side].a);
            std::copy_n(v.data() + 12 * load.bodies[side], 12, asked.V[side].a);
        }
        load.forces(asked, forces);
        for (int side = 0; side < 2; ++side)
            if (load.bodies[side] != world) add(load.bodies[side], forces[side]);
    }
    return f;
}

struct Accelerations {
    Numbers X;        ///< X'', 12 a body
    Numbers lambda;   ///< of the rows that were asked for
};

/// X'' m + G^T lambda = F and d2 Phi/dt2 = 0 for the given rows and rigidity; a point's directors stay zero.
Accelerations dense(const Model& model, const std::vector<int>& chosen, Instant at, const Numbers& x,
                    const Numbers& v)
{
    std::vector<ConstraintRow> rows;
    for (const int r : chosen) rows.push_back(model.row(r));
    for (int b = 0; b < model.n_bodies(); ++b)
        if (!model.bodies()[b].is_point)
            for (const ConstraintRow& row : rigidity_rows(b)) rows.push_back(row);
    const std::size_t n = x.size(), all = n + rows.size();
    std::vector<Numbers> A(all, Numbers(all, 0.0));
    Numbers right = forces_on(model, at, x, v);
    for (int b = 0; b < model.n_bodies(); ++b) {
        const Body& body = model.bodies()[b];
        for (int to = 0; to < 4; ++to)
            for (int from = 0; from < 4; ++from)
                for (int i = 0; i < 3; ++i)
                    A[12 * b + 3 * to + i][12 * b + 3 * from + i] =
                        body.is_point && to > 0 && to == from ? 1 : body.mass(from, to);
    }
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const Numbers g = gradient_of(rows[r], at, x);
        for (std::size_t i = 0; i < n; ++i) {
            const bool is_of_point = model.bodies()[i / 12].is_point && i % 12 > 2;
            A[n + r][i] = A[i][n + r] = is_of_point ? 0 : g[i];
        }
        right.push_back(-curvature_of(rows[r], at, x, v));
    }
    const Numbers solution = solved(std::move(A), std::move(right));
    return {
        {solution.begin(), solution.begin() + static_cast<long>(n)},
        {solution.begin() + static_cast<long>(n), solution.begin() + static_cast<long>(n + chosen.size())}};
}

/// A closed mechanism at the instant, with a velocity that its rows allow.
struct Scene {
    explicit Scene(Model the_model, unsigned seed = 1)
        : model(std::move(the_model)), closed(consistent_start(model, at_rest(model), StartPolicy::project)),
          tables(model, closed.independent), system(tables), random(seed)
    {
        state.resize(tables);
        state.t = now.t;
        state.X = flat(closed.start.X);
        is_prepared = system.prepare(state, tables.independent);
        lambda.assign(static_cast<std::size_t>(model.n_rows()), 0.0);
    }

    static State at_rest(const Model& model)
    {
        State start = model.start();
        start.t = now.t;
        for (Matrix34& V : start.V) V = {};
        return start;
    }

    Numbers any_momentum()
    {
        Numbers p(static_cast<std::size_t>(tables.n_twists));
        for (double& entry : p) entry = random.number();
        return p;
    }
    void move() { system.from_momentum(state, any_momentum().data(), 1.0, lambda.data()); }
    Numbers rates() const
    {
        Numbers V(state.X.size());
        tables.bodies.rates_of(state.X.data(), state.velocity.data(), V.data());
        return V;
    }
    /// X'' of the twist acceleration.
    Numbers second_rates(int side) const
    {
        Numbers A(state.X.size()), turning(A.size(), 0.0);
        tables.bodies.rates_of(state.X.data(), state.acceleration[side].data(), A.data());
        for (int b = 0; b < model.n_bodies(); ++b) {
            if (model.bodies()[b].is_point) continue;
            const double* w = &state.velocity[tables.bodies[b].first + 3];
            const Matrix34 X = body_of(state.X, b);
            for (int a = 1; a < 4; ++a) {
                const Vector3 spin{w[0], w[1], w[2]}, d = cross(spin, cross(spin, X.column(a)));
                for (int i = 0; i < 3; ++i) A[12 * b + 3 * a + i] += d[i];
            }
        }
        return A;
    }
    Numbers chosen(const Numbers& all) const
    {
        Numbers some;
        for (const int r : tables.independent) some.push_back(all[r]);
        return some;
    }
    /// The forces of multipliers, in rows of central twists.
    Numbers pushes(const Numbers& all) const
    {
        Numbers sum(state.X.size(), 0.0), q(static_cast<std::size_t>(tables.n_twists));
        for (int r = 0; r < model.n_rows(); ++r) {
            const Numbers g = gradient_of(model.row(r), now, state.X);
            for (std::size_t i = 0; i < g.size(); ++i) sum[i] += all[r] * g[i];
        }
        tables.bodies.twist_rows(state.X.data(), state.maps.data(), sum.data(), q.data());
        return q;
    }

    Model model;
    ConsistentStart closed;
    ModelTables tables;
    InstantSystem system;
    Random random;
    InstantState state;
    Numbers lambda;
    bool is_prepared = false;
};

double size(const Numbers& v) { return std::sqrt(inner(v, v)); }

/// A crank on a hinge whose angle is driven, and a link whose end a ram leads.
Model driven_crank(double stroke = 0.2)
{
    Model model({0, 0, -9.81});
    const int crank =
        model.add_body(rigid_body("crank", {1.3, {0.2, 0.1, 0}, {0.1, 0, 0, 0, 0.2, 0, 0, 0, 0.25}}));
    const int link = model.add_body(
        rigid_body("link", {0.7, {0.4, 0, 0.1}, {0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.12}}, {{1, 0, 0}}));
    model.add_joint(revolute("shaft", world, crank, {}));
    model.add_joint(
        only_rows("motor", {driven_angle_row(world, direction({0, 1, 0}), crank, direction({0, 1, 0}),
                                             direction({-1, 0, 0}), swing(0.1, 0.4, 2, -0.74))}));
    JointFrame pin;
    pin.point_first = {1, 0, 0};
    model.add_joint(spherical("pin", crank, link, pin));
    const TimeFunction reach = swing(1.2 + 0.2 * std::sin(3 * now.t), stroke, 3, -3 * now.t);
    model.add_joint(only_rows(
        "ram", {driven_distance_row(world, point({1.5, 1, 0.5}), link, point({1, 0, 0}), reach, 1)}));
    return model;
}

std::vector<Model> mechanisms()
{
    std::vector<Model> models;
    for (unsigned seed = 1; seed <= 6; ++seed) models.push_back(workshop(seed));
    models.push_back(driven_crank());
    return models;
}

TEST(Instant, VelocityTakesWhatTheRowsAllowOfAMomentum)
{
    for (const Model& model : mechanisms()) {
        Scene s(model);
        ASSERT_TRUE(s.is_prepared);
        const Numbers p = s.any_momentum();
        const double element = 0.7;
        s.system.from_momentum(s.state, p.data(), element, s.lambda.data());
        const Numbers V = s.rates();
        for (int r = 0; r < model.n_rows(); ++r) {
            const ConstraintRow& row = model.row(r);
            const auto standing = [&](double d) { return phi_of(row, {now.t + d}, s.state.X); };
            EXPECT_NEAR(inner(gradient_of(row, now, s.state.X), V), -derivative(standing, 1), 1e-7) << r;
        }
        // what is left of the momentum is that of the velocity, and the rows took the rest
        Numbers P(V.size()), of_velocity(p.size()), rest = p, wrong = p;
        s.tables.bodies.times_mass(V.data(), 1.0, P.data());
        s.tables.bodies.twist_rows(s.state.X.data(), s.state.maps.data(), P.data(), of_velocity.data());
        EXPECT_LT(furthest(s.state.p, of_velocity), 1e-11);
        const Numbers push = s.pushes(s.lambda);
        for (std::size_t i = 0; i < p.size(); ++i) {
            rest[i] -= of_velocity[i] + element * push[i];
            wrong[i] -= of_velocity[i] - element * push[i];
        }
        EXPECT_LT(size(rest), 1e-11);
        EXPECT_GT(size(wrong), 1e-2) << "negative control: multipliers of the other sign";
    }
}

TEST(Instant, MomentumAndVelocityAreInverse)
{
    for (const Model& model : mechanisms()) {
        Scene s(model);
        s.move();
        const Numbers velocity = s.state.velocity, p = s.state.p, scaled = s.state.momentum;
        s.system.from_velocity(s.state);
        EXPECT_LT(furthest(s.state.p, p), 1e-12);
        EXPECT_LT(furthest(s.state.momentum, scaled), 1e-12);
        s.system.from_momentum(s.state, Numbers(s.state.p).data(), 1.0, s.lambda.data());
        EXPECT_LT(furthest(s.state.velocity, velocity), 1e-11);
        if (!model.has_drives()) {
            EXPECT_LT(size(s.lambda), 1e-11) << "nothing is left to take";
        }
        Numbers other = s.state.p;
        other[0] += 1e-6;
        s.system.from_momentum(s.state, other.data(), 1.0, s.lambda.data());
        EXPECT_GT(furthest(s.state.velocity, velocity) + size(s.lambda), 1e-8) << "negative control";
    }
}

/// Bodies a little off where joints have them, each by a step and a turn of its own.
void push_off(Scene& s, double by)
{
    const auto any = [&] { return by * Vector3{s.random.number(), s.random.number(), s.random.number()}; };
    for (int b = 0; b < s.model.n_bodies(); ++b) {
        const Vector3 step = any(), turn = s.model.bodies()[b].is_point ? Vector3{} : any();
        const Matrix34 X = twist::moved(body_of(s.state.X, b), step, turn);
        std::copy_n(X.a, 12, s.state.X.begin() + 12 * b);
    }
}

double widest(const Scene& s)
{
    double open = 0;
    for (const int r : s.state.held.rows)
        open = std::max(open, std::abs(phi_of(s.model.row(r), now, s.state.X)) / s.model.row(r).scale);
    return open;
}

TEST(Instant, ClosesWhatIsALittleOpen)
{
    int n_open = 0;
    for (const Model& model : mechanisms()) {
        Scene s(model);
        const Numbers closed = s.state.X;
        push_off(s, 1e-4);
        ASSERT_TRUE(s.system.prepare(s.state, s.tables.independent));
        n_open += widest(s) > 1e-6;
        EXPECT_TRUE(s.system.close(s.state));
        EXPECT_LT(widest(s), 1e-12);
        EXPECT_LT(furthest(s.state.X, closed), 1e-2) << "it stays near";
        for (int b = 0; b < model.n_bodies(); ++b) {
            if (model.bodies()[b].is_point) continue;
            const Matrix3 D = directors(body_of(s.state.X, b));
            EXPECT_LT(norm(transpose(D) * D - identity<3>()), 1e-13) << "turned, not bent";
        }
        // What is closed stays to the bit.
        const Numbers once = s.state.X;
        EXPECT_TRUE(s.system.close(s.state));
        EXPECT_EQ(s.state.X, once);
    }
    EXPECT_GE(n_open, 6) << "negative control";
}

TEST(Instant, WhatCannotBeClosedStaysAsItWas)
{
    Scene s(driven_crank(30));   // the law of the ram, which asks for 31 m half a second later
    s.state.t = now.t + 0.5;
    ASSERT_TRUE(s.system.prepare(s.state, s.tables.independent));
    const Numbers given = s.state.X;
    EXPECT_FALSE(s.system.close(s.state));
    EXPECT_EQ(s.state.X, given);
}

TEST(Instant, WithoutJointsMomentumStaysToTheBit)
{
    Model model;
    model.add_body(workshop(1).bodies()[0]);
    Scene s(std::move(model));
    const Numbers p = s.any_momentum();
    s.system.from_momentum(s.state, p.data(), 1.0, s.lambda.data());
    EXPECT_EQ(s.state.p, p);
}

TEST(Instant, AccelerationsSolveTheDenseSystem)
{
    for (const Model& model : mechanisms()) {
        Scene s(model);
        s.move();
        s.system.accelerate(s.state, Side::right);
        const Accelerations wanted = dense(model, s.tables.independent, now, s.state.X, s.rates());
        const Numbers X = s.second_rates(1), lambda = s.chosen(s.state.multipliers[1]);
        EXPECT_LT(furthest(X, wanted.X), 1e-7 * (1 + size(wanted.X)));
        EXPECT_LT(furthest(lambda, wanted.lambda), 1e-7 * (1 + size(wanted.lambda)));
        // negative controls: multipliers of the other sign; another velocity
        Numbers wrong = lambda;
        for (double& l : wrong) l *= -1;
        EXPECT_GT(furthest(wrong, wanted.lambda), 1e-2 * size(wanted.lambda));
        Numbers faster = s.rates();
        for (double& v : faster) v *= 1.001;
        EXPECT_GT(furthest(X, dense(model, s.tables.independent, now, s.state.X, faster).X), 1e-6);
    }
}

TEST(Instant, ASingularMassThatJointsHoldIsSolvedToo)
{
    // a needle on a hinge along itself, which holds nothing of its place but its spin through a bracket
    Model model({0, 0, -9.81});
    const Matrix3 thin{0, 0, 0, 0, 0.5, 0, 0, 0, 0.5};
    const int needle = model.add_body(rigid_body("needle", {2, {0.3, 0, 0}, thin}));
    JointFrame frame;
    frame.axis_first = frame.axis_second = {0, 1, 0};
    model.add_joint(revolute("hinge", world, needle, frame));
    Scene s(model);
    EXPECT_FALSE(s.tables.bodies.are_regular());
    ASSERT_TRUE(s.is_prepared);
    s.move();
    s.system.accelerate(s.state, Side::right);
    // about the hinge: 0.5 + 2 * 0.09
    const double wanted = 2 * 9.81 * 0.3 / (0.5 + 2 * 0.3 * 0.3);
    EXPECT_NEAR(s.state.acceleration[1][4], wanted, 1e-12 * wanted);
    const Accelerations direct = dense(model, s.tables.independent, now, s.state.X, s.rates());
    EXPECT_LT(furthest(s.second_rates(1), direct.X), 1e-8);
    EXPECT_LT(furthest(s.chosen(s.state.multipliers[1]), direct.lambda), 1e-7);
}

TEST(Instant, AMotionWithoutInertiaIsReported)
{
    const Matrix3 thin{0, 0, 0, 0, 0.5, 0, 0, 0, 0.5};
    Model model;
    model.add_body(rigid_body("needle", {2, {}, thin}));
    const ModelTables tables(model, {});
    InstantSystem system(tables);
    InstantState state;
    state.resize(tables);
    state.X = flat(model.start().X);
    EXPECT_FALSE(system.prepare(state, {}));
    Model solid;
    solid.add_body(rigid_body("solid", {2, {}, {0.5, 0, 0, 0, 0.5, 0, 0, 0, 0.5}}));
    const ModelTables definite(solid, {});
    InstantSystem regular(definite);
    state.resize(definite);
    state.X = flat(solid.start().X);
    EXPECT_TRUE(regular.prepare(state, {})) << "negative control";
    EXPECT_EQ(state.held.smallest_pivot, 1);
}

TEST(Instant, RedundantRowsHaveNoMultiplierAndPushAlikeWhateverIsChosen)
{
    for (unsigned seed = 1; seed <= 4; ++seed) {
        Model model = ring(seed, 3, {}, true);
        Model heavy({0.3, -9.81, 2});
        for (const Body& body : model.bodies()) heavy.add_body(body);
        for (const Joint& joint : model.joints()) heavy.add_joint(joint);
        Scene first(heavy);
        ASSERT_FALSE(first.closed.redundant.empty());
        first.move();
        first.system.accelerate(first.state, Side::right);
        for (const int r : first.closed.redundant) EXPECT_EQ(first.state.multipliers[1][r], 0.0);
        EXPECT_GT(size(first.state.multipliers[1]), 0.1);
        const Accelerations wanted =
            dense(heavy, first.tables.independent, now, first.state.X, first.rates());
        EXPECT_LT(furthest(first.second_rates(1), wanted.X), 1e-7 * (1 + size(wanted.X)));
        // rows given that depend on each other: others are chosen, and nothing that moves knows
        Scene second(heavy);
        std::vector<int> unfit = second.tables.independent;
        unfit.front() = unfit.back();
        ASSERT_TRUE(second.system.prepare(second.state, unfit));
        EXPECT_TRUE(second.state.held.are_new);
        EXPECT_FALSE(first.state.held.are_new);
        second.move();
        second.system.accelerate(second.state, Side::right);
        EXPECT_LT(furthest(second.state.acceleration[1], first.state.acceleration[1]), 1e-9);
        EXPECT_LT(
            furthest(second.pushes(second.state.multipliers[1]), first.pushes(first.state.multipliers[1])),
            1e-8);
    }
}

TEST(Instant, AJumpOfALoadGivesTwoAccelerations)
{
    Model model = workshop(3);
    const Model before = model;
    const TimeVector kick = window({0.0, 3.0, -1.0}, now.t, std::numeric_limits<double>::infinity());
    model.add_load(point_force("kick", 1, {0.2, 0, 0.1}, kick, Frame::inertial));
    Scene s(model), without(before);
    s.move();
    without.move();
    s.system.accelerate(s.state, Side::left);
    s.system.accelerate(s.state, Side::right);
    without.system.accelerate(without.state, Side::right);
    EXPECT_LT(furthest(s.state.acceleration[0], without.state.acceleration[1]), 1e-12);
    EXPECT_LT(furthest(s.state.multipliers[0], without.state.multipliers[1]), 1e-11);
    EXPECT_GT(furthest(s.state.acceleration[1], s.state.acceleration[0]), 0.1);
    const Accelerations wanted =
        dense(model, s.tables.independent, {now.t, Side::right}, s.state.X, s.rates());
    EXPECT_LT(furthest(s.second_rates(1), wanted.X), 1e-7 * (1 + size(wanted.X)));
}

/// Two rods to one body's centre, at an angle to each other.
double pivot_of_rods(double angle)
{
    Model model;
    const int body = model.add_body(rigid_body("body", {1, {}, {1, 0, 0, 0, 1, 0, 0, 0, 1}}));
    JointFrame a, b;
    a.point_first = {1, 0, 0};
    b.point_first = {std::cos(angle), std::sin(angle), 0};
    model.add_joint(rod("a", world, body, a, 1));
    model.add_joint(rod("b", world, body, b, 1));
    const ModelTables tables(model, {0, 1});
    InstantSystem system(tables);
    InstantState state;
    state.resize(tables);
    state.X = flat(model.start().X);
    EXPECT_TRUE(system.prepare(state, {0, 1}));
    return state.held.smallest_pivot;
}

TEST(Instant, ThePivotIsTheSineBetweenTwoRows)
{
    for (const double angle : {1.5, 0.1, 1e-3, 1e-8})
        EXPECT_NEAR(pivot_of_rods(angle), std::sin(angle), 1e-15 + 1e-12 * angle);
    EXPECT_LT(pivot_of_rods(0), 1e-15);
}

TEST(Instant, ABasisAtHandServesAsWellAsItsOwn)
{
    Scene s(workshop(5)), other(workshop(5));
    ConstraintBasis known = s.state.held.basis;
    ASSERT_TRUE(other.system.prepare(other.state, other.tables.independent, &known));
    s.move();
    other.move();
    EXPECT_EQ(other.state.velocity, s.state.velocity);
}

TEST(Instant, LookingBackFitsTheCubicThroughTwoEnds)
{
    Model model;
    model.add_body(workshop(1).bodies()[0]);
    const ModelTables tables(model, {});
    InstantState early, late;
    early.resize(tables);
    late.resize(tables);
    early.t = 0.4;
    late.t = 1.1;
    // velocity 1 - 2 t + 3 t^2 - 4 t^3 in every component
    for (InstantState* state : {&early, &late}) {
        const double t = state->t;
        std::ranges::fill(state->velocity, 1 - 2 * t + 3 * t * t - 4 * t * t * t);
        for (Numbers& a : state->acceleration) std::ranges::fill(a, -2 + 6 * t - 12 * t * t);
    }
    late.look_back(early, true);
    EXPECT_TRUE(late.has_past);
    for (const double j : late.jerk) EXPECT_NEAR(j, 6 - 24 * late.t, 1e-12);
    for (const double s : late.snap) EXPECT_NEAR(s, -24, 1e-11);
    early.look_back(late, false);
    for (const double j : early.jerk) EXPECT_NEAR(j, 6 - 24 * early.t, 1e-12);
    late.forget_past();
    EXPECT_FALSE(late.has_past);
    EXPECT_EQ(size(late.jerk) + size(late.snap), 0);
}

}   // namespace
}   // namespace livens::instant_test
