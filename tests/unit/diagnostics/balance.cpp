// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "livens/diagnostics/diagnostics.h"
#include "unit/diagnostics/hand_made.h"

namespace livens::balance_test {
namespace {

using hand_made::largest;
using hand_made::mesh;
using hand_made::motion;
using hand_made::state_of_point;

void expect_near(const Vector3& found, const Vector3& exact, double tolerance)
{
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], exact[i], tolerance) << i;
}

/// All three drifts.
double worst_drift(const Balance& b)
{
    return std::max(
        {largest(b.energy_drift), largest(b.linear_momentum_drift), largest(b.angular_momentum_drift)});
}

// A free fall is a parabola: lobatto's polynomial of degree 2 is the motion.

struct Fall {
    Vector3 g{0.5, -1, -9.81};
    Model model{g};
    Motion fall;

    Fall()
    {
        Placement place;
        place.position = {1, 2, 3};
        place.velocity = {3, -1, 8};
        place.directors = directors_from_rotation_vector({0.3, 0.2, -0.7});
        model.add_body(rigid_body("stone", hand_made::skew_properties(), place));
        fall = motion(model, mesh(0.5, 2.5, 4), 2, [&](double t) {
            const double tau = t - 0.5;
            return state_of_point(t, place.position + tau * place.velocity + (0.5 * tau * tau) * g,
                                  place.velocity + tau * g, place.directors);
        });
    }
};

TEST(Balance, OfAFreeFallIsExact)
{
    const Fall f;
    const Balance b = balance(f.model, f.fall);
    ASSERT_EQ(b.t, f.fall.mesh.ends);
    EXPECT_LT(b.relative_energy_drift(), 1e-14);
    EXPECT_LT(b.relative_angular_momentum_drift(), 1e-14);
    EXPECT_LT(worst_drift(b), 1e-12);
    expect_near(b.linear_impulse.back(), (2.0 * 2.0) * f.g, 1e-13);   // mass 2 kg, 2 s
    EXPECT_GT(norm(b.angular_impulse.back()), 1);
    EXPECT_EQ(b.work.back(), 0);
    EXPECT_EQ(b.kinetic[2] + b.potential[2], b.energy[2]);
    EXPECT_NEAR(b.largest_kinetic, largest(b.kinetic), 1e-12);   // between the ends it is less
}

TEST(Balance, InPiecesIsThatOfTheWhole)
{
    Fall f;
    f.fall.velocities[2] *= 1.01;
    f.fall.momenta[3] *= 0.99;
    const Balance whole = balance(f.model, f.fall);
    for (const int n_ends : {1, 2, 4, 5, 100}) {
        std::vector<double> drift;
        std::vector<Vector3> momentum;
        int n_pieces = 0;
        const BalanceFigures figures = balance(f.model, f.fall, n_ends, [&](Balance& piece) {
            ++n_pieces;
            EXPECT_LE(piece.t.size(), static_cast<std::size_t>(n_ends));
            drift.insert(drift.end(), piece.energy_drift.begin(), piece.energy_drift.end());
            momentum.insert(momentum.end(), piece.angular_momentum.begin(), piece.angular_momentum.end());
        });
        EXPECT_EQ(n_pieces, (4 + n_ends) / n_ends);   // five ends
        EXPECT_EQ(drift, whole.energy_drift);
        EXPECT_EQ(momentum, whole.angular_momentum);
        EXPECT_EQ(figures.relative_energy_drift(), whole.relative_energy_drift());
        EXPECT_EQ(figures.relative_energy_rise(), whole.relative_energy_rise());
        EXPECT_EQ(figures.relative_energy_loss(), whole.relative_energy_loss());
        EXPECT_EQ(figures.relative_linear_momentum_drift(), whole.relative_linear_momentum_drift());
        EXPECT_EQ(figures.relative_angular_momentum_drift(), whole.relative_angular_momentum_drift());
        EXPECT_EQ(figures.reference_impulse, whole.reference_impulse);
    }
    EXPECT_EQ(whole.largest_energy_drift, largest(whole.energy_drift));
    double lowest = whole.energy[0], rise = 0;   // nothing is supplied
    for (const double energy : whole.energy) {
        lowest = std::min(lowest, energy);
        rise = std::max(rise, energy - lowest);
    }
    EXPECT_GT(rise, 0);
    EXPECT_NEAR(whole.largest_energy_rise, rise, 1e-12 * rise);
    EXPECT_NEAR(whole.energy_loss, whole.energy.front() - whole.energy.back(), 1e-12 * rise);
    EXPECT_EQ(whole.largest_change, std::abs(whole.potential.back() - whole.potential.front()));
}

TEST(Balance, ShowsAWrongVelocity)
{
    Fall f;
    f.fall.velocities[2] *= 1 + 1e-8;
    EXPECT_GT(balance(f.model, f.fall).relative_energy_drift(), 1e-9);
}

TEST(Balance, ShowsAWrongMomentum)
{
    Fall f;
    f.fall.momenta[2] *= 1 + 1e-8;
    const Balance b = balance(f.model, f.fall);
    EXPECT_GT(b.relative_angular_momentum_drift(), 1e-9);
    EXPECT_GT(largest(b.linear_momentum_drift), 1e-8);
}

TEST(Balance, ShowsANumberThatIsNone)
{
    Fall f;
    f.fall.velocities[1](0, 0) = NAN;
    EXPECT_TRUE(std::isnan(balance(f.model, f.fall).relative_energy_drift()));
}

// A body that turns about a fixed principal axis, without any force.

struct Spin {
    Model model;
    Vector3 w{0, 0, 3};
    Placement place;

    Spin()
    {
        place.position = {1, -2, 0};
        place.velocity = {0.2, 0.3, 0.1};
        model.add_body(rigid_body("top", box(1, {0.3, 0.5, 0.9}), place));
    }
    Motion turn(int degree) const
    {
        return motion(model, mesh(0, 2, 10), degree, [this](double t) {
            const Matrix34 X =
                configuration(place.position + t * place.velocity, directors_from_rotation_vector(t * w));
            return State{t, {X}, {rate(X, place.velocity, w)}};
        });
    }
};

TEST(Balance, OfAFreeSpinIsExact)
{
    const Spin s;
    const Motion turn = s.turn(4);
    EXPECT_LT(worst_drift(balance(s.model, turn)), 1e-15);
    EXPECT_LT(violations(s.model, turn).rigidity_at_nodes, 1e-15);

    Motion wrong = turn;
    wrong.momenta[5](0, 1) += 1e-6;   // of the first director
    EXPECT_GT(largest(balance(s.model, wrong).angular_momentum_drift), 1e-7);
}

// A point mass on a rod goes round as a conical pendulum: gravity and the rod's reaction, both known.

struct ConicalPendulum {
    static constexpr double mass = 1.5, radius = 0.6, depth = 0.8, g = 9.81;
    double spin = std::sqrt(g / depth);
    Vector3 anchor{0.4, -0.3, 2};
    Model model{{0, 0, -g}};

    ConicalPendulum()
    {
        const State s = at(0);
        model.add_body(point_mass("bob", mass, s.X[0].column(0), s.V[0].column(0)));
        model.add_joint(rod("rod", world, 0, {anchor, {}, {0, 0, 1}, {0, 0, 1}}, 1));
    }
    State at(double t) const
    {
        const double c = std::cos(spin * t), s = std::sin(spin * t);
        return state_of_point(t, anchor + Vector3{radius * c, radius * s, -depth},
                              {-radius * spin * s, radius * spin * c, 0});
    }
    /// m x'' = m g - lambda (x - anchor) along z.
    double multiplier() const { return mass * g / depth; }
    Motion turn(int degree, int n) const
    {
        return motion(
            model, mesh(0, 3, n), degree, [this](double t) { return at(t); },
            [this](double) { return std::vector<double>{multiplier()}; });
    }
};

TEST(Balance, HoldsWithTheReactionsImpulse)
{
    const ConicalPendulum p;
    const Balance b = balance(p.model, p.turn(8, 20));
    EXPECT_LT(worst_drift(b), 1e-12);
    EXPECT_LT(b.relative_angular_momentum_drift(), 1e-13);
    expect_near(b.linear_impulse.back(), b.linear_momentum.back() - b.linear_momentum.front(), 1e-12);
    EXPECT_GT(norm(b.linear_impulse.back()), 0.1);
    EXPECT_GT(norm(b.angular_impulse.back()), 0.1);
}

TEST(Balance, ShowsAMissingImpulse)
{
    const ConicalPendulum p;
    Motion without = p.turn(8, 20);
    without.multipliers.values.clear();
    EXPECT_GT(balance(p.model, without).relative_angular_momentum_drift(), 0.1);

    Motion wrong = p.turn(8, 20);
    wrong.multipliers.coefficient(7, 3)[0] *= 1 + 1e-6;   // one multiplier at one node
    EXPECT_GT(largest(balance(p.model, wrong).angular_momentum_drift), 1e-9);
}

TEST(Balance, TakesMultipliersOfAnotherDegree)
{
    const ConicalPendulum p;
    Motion turn = p.turn(8, 20);
    turn.multipliers = {1, 2, false, std::vector<double>(20 * 3, p.multiplier())};
    EXPECT_LT(worst_drift(balance(p.model, turn)), 1e-12);
}

TEST(Balance, ConvergesWithTheQuadrature)
{
    const ConicalPendulum p;
    const double coarse = largest(balance(p.model, p.turn(2, 40)).linear_momentum_drift);
    const double fine = largest(balance(p.model, p.turn(2, 80)).linear_momentum_drift);
    EXPECT_NEAR(std::log2(coarse / fine), 4, 0.3);
}

TEST(Balance, OfAJointBetweenBodiesNeedsNoSupply)
{
    // Two masses on a rod turn about their centre.
    Model model;
    const double spin = 2, m1 = 1, m2 = 3, r1 = 0.75, r2 = 0.25;
    const auto at = [&](double t) {
        const Vector3 e{std::cos(spin * t), std::sin(spin * t), 0}, de{-spin * e[1], spin * e[0], 0};
        const Vector3 center = Vector3{5, 1, 0} + t * Vector3{0.3, 0.1, 1}, v{0.3, 0.1, 1};
        State s = state_of_point(t, center + r1 * e, v + r1 * de);
        const State other = state_of_point(t, center - r2 * e, v - r2 * de);
        s.X.push_back(other.X[0]);
        s.V.push_back(other.V[0]);
        return s;
    };
    model.add_body(point_mass("a", m1, at(0).X[0].column(0)));
    model.add_body(point_mass("b", m2, at(0).X[1].column(0)));
    model.add_joint(rod("rod", 0, 1, {}, 1));
    const double lambda = m1 * r1 * spin * spin;
    const Motion turn =
        motion(model, mesh(0, 1, 10), 5, at, [&](double) { return std::vector<double>{lambda}; });
    const Balance b = balance(model, turn);
    EXPECT_LT(worst_drift(b), 1e-13);
    EXPECT_LT(norm(b.linear_impulse.back()), 1e-14);
    EXPECT_LT(norm(b.angular_impulse.back()), 1e-14);
}

// Loads with and without potential.

TEST(Balance, TakesLoadsFromTheElementsSide)
{
    // A force along x from 1 s to 2 s: position and velocity are exact piecewise parabolas.
    Model model;
    model.add_body(point_mass("cart", 2, {0, 1, 0}));
    model.add_load(point_force("push", 0, {}, window({6.0, 0.0, 0.0}, 1, 2), Frame::inertial));
    const TimeMesh m = make_time_mesh(0, 3, 3, model.load_breaks());
    ASSERT_EQ(m.n_elements(), 3);
    const Motion push = motion(model, m, 2, [](double t) {
        const double tau = std::clamp(t - 1, 0.0, 1.0);
        return state_of_point(t, {1.5 * tau * tau + 3 * std::max(t - 2, 0.0), 1, 0}, {3 * tau, 0, 0});
    });
    const Balance b = balance(model, push);
    EXPECT_LT(worst_drift(b), 1e-14);
    expect_near(b.linear_impulse[1], {0, 0, 0}, 0);
    expect_near(b.linear_impulse[2], {6, 0, 0}, 1e-14);
    expect_near(b.linear_impulse[3], {6, 0, 0}, 1e-14);
    expect_near(b.angular_impulse[3], {0, 0, -6}, 1e-14);
    EXPECT_NEAR(b.work[3], 9, 1e-14);
}

TEST(Balance, CountsTheWorkOfADamperAndTheEnergyOfASpring)
{
    // m x'' = -k x - c x' along a line: the spring is anchored far enough to keep its direction.
    const double m = 1, k = 9, c = 0.4, x0 = 0.2, rest_length = 2;
    const double decay = c / (2 * m), w = std::sqrt(k / m - decay * decay);
    Model model;
    model.add_body(point_mass("bob", m, {x0, 0, 0}));
    model.add_load(spring_damper("strut", world, {-rest_length, 0, 0}, 0, {}, {k, c, rest_length}));
    const Motion swing = motion(model, mesh(0, 4, 40), 8, [&](double t) {
        const double e = x0 * std::exp(-decay * t), co = std::cos(w * t), si = std::sin(w * t);
        return state_of_point(t, {e * (co + decay / w * si), 0, 0},
                              {-e * (w + decay * decay / w) * si, 0, 0});
    });
    const Balance b = balance(model, swing);
    EXPECT_LT(worst_drift(b), 1e-12);
    EXPECT_LT(b.relative_energy_drift(), 1e-12);
    EXPECT_NEAR(b.potential.front(), 0.5 * k * x0 * x0, 1e-15);
    EXPECT_LT(b.work.back(), -0.1);   // a damper takes

    Model undamped;   // the same motion does not fit another law
    undamped.add_body(point_mass("bob", m, {x0, 0, 0}));
    undamped.add_load(spring_damper("strut", world, {-rest_length, 0, 0}, 0, {}, {k, 0, rest_length}));
    EXPECT_GT(balance(undamped, swing).relative_energy_drift(), 0.1);
}

// Stepping rules, carried out by hand for a spring with free length, whose force is not linear in x.

struct Orbit {
    Model model{{0, -1, -2}};
    Vector3 anchor{0.3, 0, 0};
    double mass = 1.3;

    Orbit()
    {
        model.add_body(point_mass("bob", mass, {1.5, 0, 0}, {0, 1, 0.2}));
        model.add_load(spring_damper("spring", world, anchor, 0, {}, {20, 0, 0.7}));
    }
    Vector3 force(const Vector3& x) const
    {
        const Vector3 r = x - anchor;
        const double l = norm(r);
        return (-20 * (l - 0.7) / l) * r + mass * model.gravity();
    }
    /// theta = 1/2: midpoint, x_1 = x_0 + h (v_0 + v_1) / 2; theta = 1: endpoint, x_1 = x_0 + h v_1.
    Motion march(double theta, int n) const
    {
        const double h = 1.0 / n;
        std::vector<State> states{model.start()};
        for (int i = 0; i < n; ++i) {
            const Vector3 x0 = states.back().X[0].column(0), v0 = states.back().V[0].column(0);
            Vector3 x = x0, v = v0;
            for (int k = 0; k < 100; ++k) {
                v = v0 + (h / mass) * force((1 - theta) * x0 + theta * x);
                x = x0 + h * ((1 - theta) * v0 + theta * v);
            }
            states.push_back(state_of_point((i + 1) * h, x, v));
        }
        Motion m = motion(model, mesh(0, 1, n), 1, [&](double t) { return states[std::lround(t * n)]; });
        m.multipliers = {0, 0, false, {}};
        m.order_at_ends = theta == 1 ? 1 : 2;
        return m;
    }
};

TEST(Balance, OfMidpointIsExactInMomenta)
{
    const Orbit o;
    Motion march = o.march(0.5, 20);
    const Balance b = balance(o.model, march);
    EXPECT_LT(largest(b.linear_momentum_drift), 1e-13);
    EXPECT_LT(largest(b.angular_momentum_drift), 1e-13);
    march.order_at_ends = 1;
    EXPECT_GT(largest(balance(o.model, march).linear_momentum_drift), 1e-3);
    march.order_at_ends = 2;
    march.multipliers.degree = 1;   // the trapezoid of lobatto(1)
    EXPECT_GT(largest(balance(o.model, march).linear_momentum_drift), 1e-3);
}

TEST(Balance, OfEndpointIsExactInLinearMomentumOnly)
{
    const Orbit o;
    const Balance b = balance(o.model, o.march(1, 40));
    EXPECT_LT(largest(b.linear_momentum_drift), 1e-13);
    EXPECT_GT(largest(b.angular_momentum_drift), 1e-3);
}

// Motions whose method says how many Gauss points it had.

TEST(Balance, TakesSuppliesAtTheGaussPointsOfTheMethod)
{
    // One Gauss point is midpoint's rule, which is exact for its march; any other is not.
    const Orbit o;
    Motion march = o.march(0.5, 20);
    march.multipliers.degree = 1;
    march.multipliers.continuous = false;
    for (const int points : {1, 2, 5}) {
        march.gauss_points = points;
        const Balance b = balance(o.model, march);
        if (points == 1)
            EXPECT_LT(largest(b.angular_momentum_drift), 1e-13);
        else
            EXPECT_GT(largest(b.angular_momentum_drift), 1e-4) << points;
    }
}

TEST(Balance, EvaluatesMultipliersAtTheGaussPoints)
{
    // A cart is pushed along a rail by lambda = -m x'' that is a parabola in time; x is a quartic.
    const double m = 2;
    Model model;
    model.add_body(point_mass("cart", m, {0, 1, 0}));
    model.add_joint(spherical("hand", world, 0, {}, 1));
    const auto x = [](double t) { return t * t / 2 + t * t * t * t; };
    Motion push = motion(model, mesh(0, 1, 2), 4, [&](double t) {
        return state_of_point(t, {x(t), 1, 0}, {t + 4 * t * t * t, 0, 0});
    });
    for (const int degree : {2, 3, 4})
        for (const int points : {3, 4, 5, 7}) {   // as many as nodes too: points are not nodes
            push.multipliers = hand_made::torn_field(push.mesh, 3, degree, [&](int, double t) {
                return std::vector<double>{-m * (1 + 12 * t * t), 0, 0};
            });
            push.gauss_points = points;
            const Balance b = balance(model, push);
            EXPECT_LT(largest(b.linear_momentum_drift), 1e-13) << degree << points;
            EXPECT_LT(largest(b.angular_momentum_drift), 1e-13) << degree << points;
            expect_near(b.linear_impulse.back(), {m * 5, 0, 0}, 1e-13);
        }
}

TEST(Balance, TakesForcesOnTheElementsSideOfAJump)
{
    // Positions jump by 1 m along y between the elements, as when blocks are brought onto constraints.
    Model model{{0, 0, -10}};
    model.add_body(point_mass("stone", 1, {}));
    Motion fall = motion(model, mesh(0, 2, 2), 2, [](double t) {
        return state_of_point(t, {0, t >= 1 ? 1.0 : 0.0, -5 * t * t}, {0, 0, -10 * t});
    });
    fall.X = hand_made::torn_field(fall.mesh, 12, 2, [](int e, double t) {
        return hand_made::stacked(configuration({0, static_cast<double>(e), -5 * t * t}, {}));
    });
    for (const int points : {0, 3}) {
        fall.gauss_points = points;
        const Balance b = balance(model, fall);
        EXPECT_LT(largest(b.linear_momentum_drift), 1e-14);
        expect_near(b.angular_impulse[1], {0, 0, 0}, 1e-14);
        expect_near(b.angular_impulse[2], {-10, 0, 0}, 1e-13);
        expect_near(b.angular_momentum[1], {-10, 0, 0}, 1e-14);   // of the element that starts there
        EXPECT_NEAR(b.angular_momentum_drift[1], 10, 1e-13) << "a jump is no motion: it shows";
    }
}

// What is relative to what.

TEST(Balance, OfABodyAtRestIsRelativeToWhatHoldsIt)
{
    Model model{{0, 0, -9.81}};
    model.add_body(point_mass("lamp", 3, {4, 0, 1}));
    model.add_joint(rod("chain", world, 0, {{4, 0, 3}, {}, {0, 0, 1}, {0, 0, 1}}, 2));
    // What rounding makes of rest.
    const auto still = [](double t) {
        return t < 0.5 ? state_of_point(t, {4, 0, 1}, {})
                       : state_of_point(t, {4, 0, 1 + 4e-16}, {1e-14, 0, -1e-15});
    };
    const double lambda = -3 * 9.81 / -2;   // m g = -lambda (x - anchor)
    const Motion rest =
        motion(model, mesh(0, 1, 10), 3, still, [&](double) { return std::vector<double>{lambda}; });
    const Balance b = balance(model, rest);
    EXPECT_LT(b.relative_energy_drift(), 1e-13);
    EXPECT_LT(b.relative_angular_momentum_drift(), 1e-13);

    const Motion slack =
        motion(model, mesh(0, 1, 10), 3, still, [](double) { return std::vector<double>{0.0}; });
    EXPECT_GT(balance(model, slack).relative_angular_momentum_drift(), 0.1);
}

TEST(Balance, OfRestIsThatOfTheLengthsThatHoldIt)
{
    // At a height of zero the potential energy is nothing but rounding, of the chain's length.
    Model model({0, 0, -9.81});
    model.add_body(point_mass("lamp", 3, {0, 0, 0}));
    model.add_joint(rod("chain", world, 0, {{0, 0, 2}, {}, {0, 0, 1}, {0, 0, 1}}, 2));
    const auto rest = [&](double speed) {
        const auto still = [=](double t) {
            return t < 0.5 ? state_of_point(t, {}, {}) : state_of_point(t, {0, 0, 4e-16}, {speed, 0, 0});
        };
        const double lambda = 3 * 9.81 / 2;
        return balance(model, motion(model, mesh(0, 1, 10), 3, still,
                                     [&](double) { return std::vector<double>{lambda}; }));
    };
    EXPECT_EQ(rest(1e-14).relative_energy_drift(), 0);
    EXPECT_EQ(rest(1e-14).relative_linear_momentum_drift(), 0);
    EXPECT_EQ(rest(1e-14).relative_angular_momentum_drift(), 0);
    EXPECT_NEAR(rest(1e-3).relative_energy_drift(), 1, 1e-6) << "it began to move by itself";
    EXPECT_NEAR(rest(1e-3).relative_linear_momentum_drift(), 1, 1e-6);
}

TEST(Balance, IsRelativeToWhatMovesHoweverLongARodIs)
{
    // A slide, modelled by a rod of 3e9 m across it: the speed grows from 1 to 2 m/s by itself.
    Model model({0, 0, -9.81});
    model.add_body(point_mass("sledge", 3, {0, 0, 0}, {1, 0, 0}));
    model.add_joint(rod("slide", world, 0, {{0, 0, 3e9}, {}, {0, 0, 1}, {0, 0, 1}}, 3e9));
    const double lambda = 3 * 9.81 / 3e9;
    const auto faster = [&](double speed) {
        return balance(model, motion(
                                  model, mesh(0, 1, 10), 3,
                                  [=](double t) {
                                      const double v = t < 0.5 ? 1 : speed;
                                      return state_of_point(t, {0.5 + v * (t - 0.5), 0, 0}, {v, 0, 0});
                                  },
                                  [&](double) { return std::vector<double>{lambda}; }));
    };
    EXPECT_NEAR(faster(2).relative_energy_drift(), 0.75, 1e-12);
    EXPECT_NEAR(faster(2).relative_linear_momentum_drift(), 0.5, 1e-6);
    EXPECT_EQ(faster(1).relative_energy_drift(), 0);
}

TEST(Balance, OfEnergyIsRelativeToTheChangeOfPotential)
{
    // A stone is lifted by 3 m without work, and slowly: 4.5 J move, 30 J are stored.
    Model model({0, 0, -10});
    model.add_body(point_mass("stone", 1, {0, 0, 1e3}));
    const Balance b = balance(model, motion(model, mesh(0, 1, 10), 3, [](double t) {
                                  return state_of_point(t, {0, 0, 1e3 + 3 * t}, {1e-3, 0, 0});
                              }));
    EXPECT_NEAR(b.relative_energy_drift(), 1, 1e-12);
}

TEST(Balance, OfNothingIsZero)
{
    Model model;
    model.add_body(point_mass("dust", 1, {0, 0, 0}));
    const Motion rest = motion(model, mesh(0, 1, 1), 2, [](double t) { return state_of_point(t, {}, {}); });
    EXPECT_EQ(balance(model, rest).relative_energy_drift(), 0);
    EXPECT_EQ(balance(model, rest).relative_angular_momentum_drift(), 0);
}

TEST(Balance, OfAMotionThatFailedAtItsStartHasOneEntry)
{
    Model model{{0, 0, -1}};
    model.add_body(point_mass("dust", 1, {0, 0, 2}, {1, 0, 0}));
    const Motion start = motion(model, {{0.0}}, 3, [](double t) {
        return state_of_point(t, {0, 0, 2}, {1, 0, 0});
    });
    const Balance b = balance(model, start);
    ASSERT_EQ(b.energy.size(), 1u);
    EXPECT_EQ(b.energy[0], 2.5);
    EXPECT_EQ(b.relative_energy_drift(), 0);
    EXPECT_EQ(violations(model, start).velocity_level, 0);
    EXPECT_TRUE(action(model, start).lagrangian.empty());
}

}   // namespace
}   // namespace livens::balance_test
