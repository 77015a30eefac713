// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/motion.h"

#include <gtest/gtest.h>

#include <functional>

#include "livens/multibody/model.h"
#include "livens/time/basis.h"
#include "livens/time/quadrature.h"
#include "unit/multibody/random_states.h"

namespace livens::motion_test {
namespace {

/// A field of one body that samples X(t) at its nodes.
template <typename Function>
Field sampled(const TimeMesh& mesh, int degree, bool continuous, Function X)
{
    Field field{12, degree, continuous, {}};
    const int per_element = continuous ? degree : degree + 1;
    field.values.resize(12 *
                        static_cast<std::size_t>(mesh.n_elements() * per_element + (continuous ? 1 : 0)));
    const std::vector<double> nodes =
        degree == 0 ? std::vector<double>{0.5} : gauss_lobatto(degree + 1).points;
    for (int e = 0; e < mesh.n_elements(); ++e)
        for (int a = 0; a <= degree; ++a) {
            const Matrix34 x = X(mesh.ends[e] + nodes[a] * mesh.length(e));
            std::copy_n(x.data(), 12, field.coefficient(e, a).begin());
        }
    return field;
}

/// A cubic motion: polynomials of degree 3 and more hold it exactly.
Matrix34 cubic(double t)
{
    Matrix34 X{};
    for (int i = 0; i < 12; ++i) X[i] = i + (1 + t) * t - 0.1 * i * t * t * t;
    return X;
}
Matrix34 cubic_rate(double t)
{
    Matrix34 V{};
    for (int i = 0; i < 12; ++i) V[i] = 1 + 2 * t - 0.3 * i * t * t;
    return V;
}

TEST(Field, ContinuousNeighboursShareTheirEnd)
{
    Field shared{1, 2, true, {0, 1, 2, 3, 4}}, apart{1, 2, false, {0, 1, 2, 3, 4, 5}},
        flat{1, 0, false, {7, 8}};
    EXPECT_EQ(shared.coefficient(0, 2)[0], 2);
    EXPECT_EQ(shared.coefficient(1, 0)[0], 2);
    EXPECT_EQ(apart.coefficient(0, 2)[0], 2);
    EXPECT_EQ(apart.coefficient(1, 0)[0], 3);
    EXPECT_EQ(flat.coefficient(1, 0)[0], 8);
    apart.coefficient(1, 2)[0] = 9;
    EXPECT_EQ(apart.values[5], 9);
}

TEST(Field, ReproducesPolynomialsAndTheirDerivatives)
{
    const TimeMesh mesh{{-1, 0.5, 0.75, 2}};
    for (const int degree : {3, 4, 8, 16, 32})
        for (const bool continuous : {true, false}) {
            const Field field = sampled(mesh, degree, continuous, cubic);
            for (int e = 0; e < 3; ++e)
                for (const double s : {0.0, 0.1, 0.5, 0.77, 1.0}) {
                    const double h = mesh.length(e), t = mesh.ends[e] + s * h;
                    Matrix34 X{}, V{};
                    field.evaluate(e, s, 0, X.a);
                    field.evaluate(e, s, 1, V.a);
                    EXPECT_LT(largest(X - cubic(t)), 5e-14) << degree;
                    EXPECT_LT(largest((1 / h) * V - cubic_rate(t)), 1e-14 * degree * degree / h) << degree;
                }
        }
}

TEST(Field, OfConstantsIsConstantToTheBitAndAtRest)
{
    const Field field{1, 5, true, std::vector<double>(6, 0.1)};
    const Field flat{1, 0, false, {0.1, 0.2}};
    for (const double s : {0.0, 0.3, 0.9999}) {
        double x = 0, v = 1;
        field.evaluate(0, s, 0, {&x, 1});
        field.evaluate(0, s, 1, {&v, 1});
        EXPECT_TRUE(x == 0.1 && v == 0);
        flat.evaluate(1, s, 0, {&x, 1});
        flat.evaluate(1, s, 1, {&v, 1});
        EXPECT_TRUE(x == 0.2 && v == 0);
    }
}

/// A field of one number over one element [0, 1] by its nodal values and denominators.
Field rational(int degree, const std::function<double(double)>& numerator,
               const std::function<double(double)>& denominator)
{
    Field field{1, degree, true, {}, {}};
    for (const double s : gauss_lobatto(degree + 1).points) {
        field.denominators.push_back(denominator(s));
        field.values.push_back(numerator(s) / denominator(s));
    }
    return field;
}

TEST(Field, WithDenominatorsIsTheQuotientOfTwoPolynomials)
{
    // A quarter of a circle, which no polynomial is: x = (1 - s^2) / (1 + s^2) and y = 2 s / (1 + s^2).
    const auto W = [](double s) { return 1 + s * s; };
    for (const int degree : {2, 3, 8}) {
        const Field x = rational(degree, [](double s) { return 1 - s * s; }, W);
        const Field y = rational(degree, [](double s) { return 2 * s; }, W);
        for (const double s : {0.0, 0.2, 0.5, 0.9, 1.0}) {
            double a = 0, b = 0, da = 0, db = 0;
            x.evaluate(0, s, 0, {&a, 1});
            y.evaluate(0, s, 0, {&b, 1});
            x.evaluate(0, s, 1, {&da, 1});
            y.evaluate(0, s, 1, {&db, 1});
            EXPECT_NEAR(a, (1 - s * s) / W(s), 1e-15);
            EXPECT_NEAR(a * a + b * b, 1, 2e-15) << "on the circle";
            EXPECT_NEAR(da, -4 * s / (W(s) * W(s)), 1e-15 * degree * degree);
            EXPECT_NEAR(db, 2 * (1 - s * s) / (W(s) * W(s)), 2e-15 * degree * degree);
        }
    }
}

TEST(Field, TakesTheDenominatorsOfItsOwnElement)
{
    // Two elements with different denominators; discontinuous fields have one more of them each.
    const Field shared{1, 1, true, {0, 1, 5}, {1, 3, 2}};
    const Field apart{1, 1, false, {0, 1, 1, 5}, {1, 3, 3, 2}};
    for (const Field* field : {&shared, &apart}) {
        double x = 0;
        field->evaluate(0, 0.5, 0, {&x, 1});
        EXPECT_DOUBLE_EQ(x, (0 * 1 + 1 * 3) / 4.0);
        field->evaluate(1, 0.5, 0, {&x, 1});
        EXPECT_DOUBLE_EQ(x, (1 * 3 + 5 * 2) / 5.0);
    }
}

TEST(Field, WithEqualDenominatorsIsThePolynomialAndConstantsStayConstant)
{
    const TimeMesh mesh{{-1, 0.5, 2}};
    const Field plain = sampled(mesh, 5, true, cubic);
    Field ones = plain;
    ones.denominators.assign(plain.values.size() / 12, 1.0);
    Field constant = ones;
    std::ranges::fill(constant.values, 0.1);
    constant.denominators = {0.3, 1, 2, 5, 1, 7, 0.1, 2, 3, 4, 5};
    for (const double s : {0.0, 0.3, 0.77, 1.0})
        for (const int derivative : {0, 1}) {
            Matrix34 a{}, b{}, c{};
            plain.evaluate(1, s, derivative, a.a);
            ones.evaluate(1, s, derivative, b.a);
            EXPECT_LT(largest(a - b), 1e-13) << "the denominators add up to one within rounding";
            constant.evaluate(1, s, derivative, c.a);
            for (const double entry : c.a) EXPECT_EQ(entry, derivative == 0 ? 0.1 : 0) << "to the bit";
        }
}

Motion cubic_motion()
{
    Motion motion;
    motion.n_bodies = 1;
    motion.mesh.ends = {0, 0.5, 2};
    motion.X = sampled(motion.mesh, 3, true, cubic);
    for (const double t : motion.mesh.ends) motion.velocities.push_back(cubic_rate(t));
    return motion;
}

TEST(Motion, IsThePolynomialInsideElements)
{
    const Motion motion = cubic_motion();
    for (const double t : {0.1, 0.4999, 0.51, 1.7}) {
        const State state = motion.at(t);
        EXPECT_EQ(state.t, t);
        EXPECT_LT(largest(state.X[0] - cubic(t)), 1e-13);
        EXPECT_LT(largest(state.V[0] - cubic_rate(t)), 1e-13);
    }
}

TEST(Motion, LetsTheEndValuesWinAtElementEnds)
{
    Motion motion = cubic_motion();
    for (int end = 0; end < 3; ++end) motion.velocities[end](1, 2) = 100 + end;
    for (int end = 0; end < 3; ++end) {
        const State state = motion.at(motion.mesh.ends[end]);
        EXPECT_EQ(state.V[0](1, 2), 100 + end);
        EXPECT_EQ(state.X[0], cubic(motion.mesh.ends[end]));
        EXPECT_EQ(motion.at_end(end).V[0], state.V[0]);
    }
    EXPECT_LT(motion.at(0.4999999).V[0](1, 2), 10) << "and only there";
}

TEST(Motion, IsNotKnownOutsideItsTimes)
{
    const Motion motion = cubic_motion();
    expect_complaint([&] { motion.at(-1e-9); }, "time-outside");
    expect_complaint([&] { motion.at(2.1); }, "time-outside");
    expect_complaint([&] { motion.at(std::nan("")); }, "time-outside");
}

TEST(Reaction, OfAHangingBodyCarriesItsWeight)
{
    Random random(1);
    for (const bool world_first : {true, false}) {
        Model model({0, 0, -10});
        const Vector3 at{0.3, -0.2, 0.9};
        const Body body = rigid_body("b", with_mass(box(1, {1, 2, 3}), 2),
                                     {.position = {1, 2, 3}, .directors = random.rotation()});
        model.add_body(body);
        const JointFrame frame = joint_frame(world_configuration, body.X, at);
        const JointFrame back = joint_frame(body.X, world_configuration, at);
        model.add_joint(world_first ? spherical("j", world, 0, frame) : spherical("j", 0, world, back));
        // The rows of a ball joint are second minus first, so -G^T lambda is the force -lambda at the joint
        // point.
        const std::vector<double> lambda{-3, 4, -20};
        const Reaction reaction = joint_reaction(model, 0, std::vector{body.X}, lambda);
        EXPECT_EQ(reaction.force, (Vector3{3, -4, 20}));
        EXPECT_LT(largest(reaction.torque), 1e-13) << "a ball joint holds no torque about its point";
    }
}

TEST(Reaction, DoesTheVirtualWorkOfTheMultipliers)
{
    // For every rigid virtual motion of the second body: -lambda . dPhi = f . dx + torque . dw at the joint
    // point.
    Random random(2);
    for (int n = 0; n < 200; ++n) {
        Model model;
        const Matrix34 X = random.rigid(), Y = random.rigid();
        model.add_body(
            rigid_body("a", box(1, {1, 2, 3}), {.position = X.column(0), .directors = directors(X)}));
        model.add_body(
            rigid_body("b", box(1, {1, 2, 3}), {.position = Y.column(0), .directors = directors(Y)}));
        const JointFrame frame = joint_frame(X, Y, random.vector(), random.unit());
        model.add_joint(revolute("one", 0, 1, frame));
        model.add_joint(n % 2 ? weld("two", 0, 1, frame, X, Y)
                              : weld("two", 1, 0, joint_frame(Y, X, {}, {}), Y, X));
        std::vector<double> lambda(model.n_rows());
        for (double& l : lambda) l = random.number();
        const std::vector<Matrix34> all{X, Y};
        for (int j = 0; j < 2; ++j) {
            const Joint& joint = model.joints()[j];
            const Matrix34& S = all[joint.second];
            const Vector3 v = random.vector(), w = random.vector();
            const Matrix34 dS = rate(S, v, w);
            double work = 0;
            for (int k = 0; k < static_cast<int>(joint.rows.size()); ++k) {
                const double step = 0.5;   // rows are quadratic: no error of truncation
                const auto phi = [&](double h) {
                    std::vector<Matrix34> moved = all;
                    moved[joint.second] = S + h * dS;
                    return constraint_value(joint.rows[k], moved);
                };
                work -= lambda[model.first_row(j) + k] * (phi(step) - phi(-step)) / (2 * step);
            }
            const Reaction reaction = joint_reaction(model, j, all, lambda);
            const Vector3 dx = v + cross(w, S * point(joint.point_second) - S.column(0));
            EXPECT_NEAR(dot(reaction.force, dx) + dot(reaction.torque, w), work, 1e-13);
        }
    }
}

TEST(Reaction, ReadsTheBodiesOfTheRowsNotOfTheirOrder)
{
    // The same rod, its row stored the other way round by hand.
    Model model;
    model.add_body(rigid_body("a", box(1, {1, 1, 1})));
    model.add_body(rigid_body("b", box(1, {1, 1, 1}), {.position = {0, 0, 3}}));
    Joint joint = rod("r", 0, 1, {}, 3);
    Joint swapped = rod("s", 1, 0, {}, 3);
    std::swap(swapped.first, swapped.second);
    model.add_joint(joint);
    model.add_joint(swapped);
    const std::vector<Matrix34> X{model.bodies()[0].X, model.bodies()[1].X};
    const std::vector<double> lambda{2, 2};
    const Vector3 force = joint_reaction(model, 0, X, lambda).force;
    EXPECT_EQ(force, (Vector3{0, 0, -6})) << "lambda times the rod, pulling the second body to the first";
    EXPECT_EQ(joint_reaction(model, 1, X, lambda).force, force);
}

}   // namespace
}   // namespace livens::motion_test
