// SPDX-License-Identifier: BSD-3-Clause
// Rows that are functions of joint coordinates: a screw, a gear pair, a point on a curve, a rope and a cam.
#include <gtest/gtest.h>

#include <numbers>

#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/joint_coordinates.h"
#include "livens/multibody/joints.h"
#include "livens/multibody/joints/coordinate_laws.h"
#include "livens/multibody/model.h"
#include "properties/joint_kit.h"

namespace livens::coupled_joints_test {
namespace {

using Bodies = std::vector<Matrix34>;
using std::numbers::pi;

std::string joined(const Failures& failures)
{
    std::string text;
    for (const std::string& failure : failures) text += failure + "\n";
    return text;
}

JointFrame anywhere(Random& random, const Matrix34& X_first, const Matrix34& X_second)
{
    return joint_frame(X_first, X_second, random.vector(), random.unit());
}

/// A unit vector across another.
Vector3 across(const Vector3& axis)
{
    const Vector3 v = cross(axis, std::abs(axis[0]) < 0.7 ? Vector3{1, 0, 0} : Vector3{0, 1, 0});
    return (1 / norm(v)) * v;
}

/// Four rows that leave a turn about the axis and a slide along it, and one that couples them; closed as it
/// stands. Bodies exchanged, the screw stays right-handed.
Joint screw(int first, int second, const JointFrame& frame, const Matrix34& X_first, const Matrix34& X_second)
{
    constexpr double pitch = 2;
    Joint joint = revolute("j", first, second, frame);
    joint.type = "screw";
    joint.rows.erase(joint.rows.begin(), joint.rows.begin() + 3);
    const Vector3 n = (1 / norm(frame.axis_first)) * frame.axis_first, u = across(n), v = cross(n, u);
    const Vector4 a = point(frame.point_first), b = point(frame.point_second);
    joint.rows.push_back(plane_row(first, direction(u), a, second, b, 0, 1));
    joint.rows.push_back(plane_row(first, direction(v), a, second, b, 0, 1));
    joint.rows[2].label = "across 1";
    joint.rows[3].label = "across 2";
    const Vector3 u_second = transpose(directors(X_second)) * (directors(X_first) * u);
    joint.rows.push_back(coupling_row(
        {{1, displacement_along(first, direction(n), a, second, b)},
         {-pitch / (2 * pi), angle_between(first, direction(u), direction(v), second, direction(u_second))}},
        0, 1, "screw"));
    return joint;
}

/// A helix through the origin, whose normals do not turn about the tangent.
CurvePoint helix(double s)
{
    constexpr double r = 0.8, rise = 0.3;
    const double c = std::cos(s), d = std::sin(s), l = std::hypot(r, rise);
    CurvePoint at{{r * c - r, r * d, rise * s}, {-r * d, r * c, rise}, {-r * c, -r * d, 0}, {}};
    const Vector3 normal{-c, -d, 0}, binormal = (1 / l) * Vector3{rise * d, -rise * c, r};
    const double turn = -rise / l * s;   // torsion times length, with |gamma'| = l: -rise / l^2 * l s
    at.normals[0] = std::cos(turn) * normal + std::sin(turn) * binormal;
    at.normals[1] = std::cos(turn) * binormal - std::sin(turn) * normal;
    return at;
}

CurvePoint ellipse(double s)
{
    const double c = std::cos(s), d = std::sin(s);
    CurvePoint at{{1.5 * c, d, 0}, {-1.5 * d, c, 0}, {-1.5 * c, -d, 0}, {}};
    const double l = norm(at.first);
    at.normals = {Vector3{at.first[1] / l, -at.first[0] / l, 0}, Vector3{0, 0, 1}};
    return at;
}

/// The curve moved so that it passes the joint point where it stands at s = 0.4.
Joint slot(int first, int second, const JointFrame& frame, const Matrix34&, const Matrix34&)
{
    Joint joint = spherical("j", first, second, frame);
    joint.type = "slot";
    const Vector3 shift = joint.point_first - helix(0.4).x;
    Curve curve{[shift](double s) {
                    CurvePoint at = helix(s);
                    at.x += shift;
                    return at;
                },
                -2, 2, false};
    joint.rows = curve_rows(curve, joint.first, joint.second, point(joint.point_second), 1);
    return joint;
}

const JointCase screw_case{"screw", 5, anywhere, screw};
const JointCase slot_case{"slot", 2, anywhere, slot};

/// To and fro between two points of each body.
Joint rope(int first, int second, const JointFrame& frame, const Matrix34& X_first, const Matrix34& X_second)
{
    const Vector3 a = frame.point_first, b = frame.point_second;
    const std::vector<BodyPoint> over{{first, a + Vector3{0.3, 0.4, -0.2}},
                                      {second, b + Vector3{-0.5, 0.1, 0.3}},
                                      {second, b + Vector3{0.2, 0.6, 0.1}},
                                      {first, a + Vector3{-0.7, 0.2, 0.5}}};
    Bodies X(static_cast<std::size_t>(std::max(first, second) + 1));
    for (const auto& [body, place] : {std::pair{first, &X_first}, {second, &X_second}})
        if (body != world) X[static_cast<std::size_t>(body)] = *place;
    return rod("j", over, rope_length(over, X), X);
}

/// As a screw, but that it slides by a law of the angle.
Joint cam(int first, int second, const JointFrame& frame, const Matrix34& X_first, const Matrix34& X_second)
{
    Joint joint = screw(first, second, frame, X_first, X_second);
    joint.type = "cam";
    const std::vector<PairForm> forms = joint.rows.back().coordinates;   // displacement, cosine, sine
    CoupledLaw law{
        formula_law(Expression("0.7*sin(q) + 0.2*cos(3*q)", {"q"}), true), {{forms[1], forms[2]}}, 0.4, ""};
    joint.rows.back() = coupling_row({{1.5, {{forms[0]}}}}, -law.law.at({0.4}).value, 1, "law", &law);
    return joint;
}

const JointCase rope_case{"rod", 1, anywhere, rope};
const JointCase cam_case{"cam", 5, anywhere, cam, false};

TEST(CoupledJoints, ARopeAndACamPassTheKit)
{
    // Exchanged, the points of the rope would be others, and the cam would be led by the other body.
    for (const auto check : {check_joint_labels, check_joint_closure, check_joint_gradient, check_joint_rates,
                             check_joint_rank, check_joint_objectivity, check_joint_world}) {
        EXPECT_EQ(joined(check(rope_case)), "");
        EXPECT_EQ(joined(check(cam_case)), "");
    }
}

/// Steps are followed by what the values differ, and refused where a span would vanish on the way.
TEST(CoupledJoints, ASpanDoesNotPassThroughAPoint)
{
    Random random(16);
    const Bodies X{configuration({0, 0, 0}, identity<3>()), configuration({2, 1, 0}, identity<3>())};
    const Joint joint = rod("j", {{0, {}}, {1, {}}}, 1, X);
    const auto change = [&](const Vector3& to) {
        const Bodies moved{X[0], configuration(to, identity<3>())};
        Bodies step = moved;
        for (std::size_t b = 0; b < step.size(); ++b) step[b] -= X[b];
        return constraint_change(joint.rows[0], {}, X, {}, moved, step);
    };
    for (int n = 0; n < 100; ++n) {
        const Vector3 to = Vector3{2, 1, 0} + random.vector();
        EXPECT_NEAR(change(to), norm(to) - std::sqrt(5.0), 1e-15);
    }
    const double near = 2 + 1e-12;
    EXPECT_NEAR(change({near, 1, 0}), (near - 2) * 2 / std::sqrt(5.0), 1e-22);
    EXPECT_TRUE(std::isnan(change({-1, -0.5, 0})));
    EXPECT_TRUE(std::isnan(change({0, 0, 0})));
    EXPECT_FALSE(std::isnan(change({-1, 2, 0})));
}

TEST(CoupledJoints, AScrewAndASlotPassTheKit)
{
    EXPECT_EQ(joined(check_joint(screw_case)), "");
    // Exchanged, the curve would be one in the other body: no order is checked.
    for (const auto check : {check_joint_labels, check_joint_closure, check_joint_gradient, check_joint_rates,
                             check_joint_rank, check_joint_objectivity, check_joint_world})
        EXPECT_EQ(joined(check(slot_case)), "");
}

TEST(CoupledJoints, AWrongDerivativeFailsTheRates)
{
    const auto broken = [](JointCase joint, double gradient, double hessian) {
        joint.make = [=, make = joint.make](int first, int second, const JointFrame& frame, const Matrix34& X,
                                            const Matrix34& Y) {
            Joint made = make(first, second, frame, X, Y);
            SmoothFunction& f = made.rows.back().functions.back();
            f.at = [=, inner = f.at](const SmoothFunction::Point& q) {
                SmoothFunction::Value value = inner(q);
                value.gradient[1] *= gradient;
                value.hessian[1][1] *= hessian;
                return value;
            };
            return made;
        };
        return joint;
    };
    for (const JointCase& joint : {screw_case, slot_case, rope_case}) {
        EXPECT_EQ(joined(check_joint_rates(broken(joint, 1, 1))), "") << joint.type;
        EXPECT_NE(joined(check_joint_rates(broken(joint, 1.01, 1))), "") << joint.type;
        EXPECT_NE(joined(check_joint_rates(broken(joint, 1, 1.01))), "") << joint.type;
    }
}

/// Two wheels on a carrier: n_1 turns of one are n_2 of the other. Axes are those of the carrier.
ConstraintRow gear(double n_1, double n_2)
{
    const Vector4 u = direction({1, 0, 0}), v = direction({0, 1, 0});
    return coupling_row({{n_1, angle_between(0, u, v, 1, u)}, {n_2, angle_between(0, u, v, 2, u)}}, 0, 1,
                        "gear");
}

/// Carrier and wheels, turned by a and b about the carrier's third axis; moved together by `common`.
Bodies wheels(const Matrix3& common, double a, double b)
{
    const auto turned = [&](double angle) {
        return configuration({}, common * directors_from_rotation_vector({0, 0, angle}));
    };
    return {configuration({}, common), turned(a), turned(b)};
}

TEST(CoupledJoints, GearsKnowWholeTurns)
{
    Random random(11);
    const ConstraintRow row = gear(20, 35);   // 7 turns of the first are 4 of the second
    for (int n = 0; n < 200; ++n) {
        const double a = 40 * random.number();
        const Matrix3 common = random.rotation();
        EXPECT_NEAR(constraint_value(row, wheels(common, a, -a * 20 / 35)), 0, 1e-12);
        // off by a little, by a tooth, and by what the wheels reach by turning
        EXPECT_NEAR(constraint_value(row, wheels(common, a + 0.01, -a * 20 / 35)), 0.2, 1e-12);
        EXPECT_NEAR(constraint_value(row, wheels(common, a + 2 * pi / 20, -a * 20 / 35)), 2 * pi, 1e-12);
        EXPECT_NEAR(constraint_value(row, wheels(common, a + 2 * pi / 4, -a * 20 / 35)), 0, 1e-12);
    }
}

TEST(CoupledJoints, TheyFollowAMotionWithoutAJump)
{
    const ConstraintRow row = gear(20, 35);
    const Bodies from = wheels(identity<3>(), 3.1, 1),
                 to = wheels(identity<3>(), 3.3, 1);   // past half a turn
    Bodies step = to;
    for (std::size_t b = 0; b < to.size(); ++b) step[b] -= from[b];
    EXPECT_NEAR(constraint_change(row, {}, from, {}, to, step), 20 * 0.2, 1e-13);
}

TEST(CoupledJoints, TablesOfThreeBodiesAgreeWithDifferences)
{
    Random random(12);
    Model model;
    for (const char* name : {"carrier", "one", "two"})
        model.add_body(rigid_body(name, box(1, {1, 2, 3}), {}));
    Joint joint = revolute("gear", 1, 2, {});
    joint.rows = {gear(2, -3)};
    joint.axis_first = joint.axis_second = {};
    model.add_joint(joint);
    const ModelTables tables(model, {0});
    ASSERT_EQ(tables.rows[0].n_sides, 3);
    for (int n = 0; n < 20; ++n) {
        Bodies X = wheels(random.rotation(), 3 * random.number(), 3 * random.number()), V;
        for (Matrix34& x : X) {
            x += 0.1 * random.matrix<3, 4>();
            V.push_back(random.matrix<3, 4>());
        }
        const auto at = [&](double s) {
            Bodies moved = X;
            for (std::size_t b = 0; b < X.size(); ++b) moved[b] += s * V[b];
            return tables.rows.value(0, {}, moved[0].data());
        };
        constexpr double h = 0.005;
        const auto odd = [&](int k) { return std::remainder(at(k * h) - at(-k * h), 2 * pi); };
        double g[RowTables::gradient_size], rate = 0, curvature = 0;
        tables.rows.gradient(0, {}, X[0].data(), g);
        for (int side = 0; side < 3; ++side)
            for (const int a : tables.rows[0].columns[side])
                for (int i = a; i < a + 3; ++i)
                    rate += g[12 * side + i] * V[tables.rows[0].bodies[side]].a[i];
        EXPECT_NEAR(rate, (45 * odd(1) - 9 * odd(2) + odd(3)) / (60 * h), 1e-8);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const auto H = constraint_hessian(model.row(0), {}, X, i, j);
                for (int r = 0; r < 12; ++r)
                    for (int c = 0; c < 12; ++c) curvature += V[i].a[r] * H(r, c) * V[j].a[c];
            }
        EXPECT_NEAR(curvature, tables.rows.curvature(0, {}, X[0].data(), V[0].data()), 1e-11);
    }
}

TEST(CoupledJoints, WhatNoTeethCanDoIsRefused)
{
    expect_complaint([] { gear(1, pi); }, "gear-ratio");
    expect_complaint([] { gear(1, 1e-5); }, "gear-ratio");
    EXPECT_NO_THROW(gear(1, 1.0 / 3));
    EXPECT_NO_THROW(gear(0.1, 0.7));
    for (const double factor : {0.3333, 0.7777, 0.4321, 0.9871}) EXPECT_NO_THROW(gear(factor, 1)) << factor;
    expect_complaint([] { gear(0.99999, 1); }, "gear-ratio");
    expect_complaint([] { gear(0, 1); }, "joint-row");
    expect_complaint([] { coupling_row({}, 0, 1, "none"); }, "joint-row");
    const auto turn = angle_between(0, direction({1, 0, 0}), direction({0, 1, 0}), 1, direction({1, 0, 0}));
    EXPECT_NO_THROW(coupling_row({{1, turn}, {2, turn}, {3, turn}, {4, turn}}, 0, 1, "four"));
}

/// One wheel each on its carrier, the wheels turned by `angles` about it.
struct ManyWheels {
    static constexpr int n = RowBodies::most / 2;
    std::vector<CoupledCoordinate> terms;
    Bodies X, V;

    explicit ManyWheels(Random& random)
    {
        const Vector4 u = direction({1, 0, 0}), v = direction({0, 1, 0}), w = direction({0, 0, 1});
        for (int k = 0; k < n; ++k) {
            const Bodies pair = wheels(random.rotation(), 2 * random.number(), 0);
            for (int i = 0; i < 2; ++i) {
                X.push_back(pair[static_cast<std::size_t>(i)] + 0.1 * random.matrix<3, 4>());
                V.push_back(random.matrix<3, 4>());
            }
            terms.push_back({(k % 2 == 0 ? 1.0 : -1.5) * (1 + k % 3),
                             k % 4 == 0 ? displacement_along(2 * k, w, point({}), 2 * k + 1, point({}))
                                        : angle_between(2 * k, u, v, 2 * k + 1, u)});
        }
    }
};

/// The value on the straight way through X is the sum of its terms, each of which has a row of its own, and
/// so are its gradient and curvature.
TEST(CoupledJoints, ARowOfManyTermsIsTheSumOfThem)
{
    Random random(13);
    const ManyWheels many(random);
    const ConstraintRow row = coupling_row(many.terms, 0.3, 1, "many");
    EXPECT_EQ(row_bodies(row).size, RowBodies::most);
    double value = -0.3, curvature = 0, change = 0;
    Bodies step = many.V;
    for (Matrix34& v : step) v = 0.1 * v;
    Bodies moved = many.X;
    for (std::size_t b = 0; b < moved.size(); ++b) moved[b] += step[b];
    const RowGradient g = constraint_gradient(row, many.X);
    for (const CoupledCoordinate& term : many.terms) {
        const ConstraintRow alone = coupling_row({term}, 0, 1, "one");
        value += term.factor * coordinate_value(term.coordinate, many.X);
        curvature += constraint_curvature(alone, {}, many.X, many.V);
        change += constraint_change(alone, {}, many.X, {}, moved, step);
        const RowGradient h = constraint_gradient(alone, many.X);
        for (const int b : h.bodies) EXPECT_LT(norm(g.of(b) - h.of(b)), 1e-15);
        for (const int b : h.bodies)
            for (const int c : {0, RowBodies::most - 1}) {
                const Matrix<12, 12> H = constraint_hessian(row, {}, many.X, b, c);
                EXPECT_LT(norm(H - constraint_hessian(alone, {}, many.X, b, c)), 1e-15) << b << " " << c;
            }
    }
    EXPECT_NEAR(std::remainder(value - constraint_value(row, many.X), row.period), 0, 1e-12);
    EXPECT_LE(std::abs(constraint_value(row, many.X)), row.period / 2);
    EXPECT_NEAR(constraint_curvature(row, {}, many.X, many.V), curvature, 1e-11);
    EXPECT_NEAR(constraint_change(row, {}, many.X, {}, moved, step), change, 1e-12);

    double rate = 0;
    for (const int b : g.bodies) rate += dot(g.of(b), many.V[static_cast<std::size_t>(b)]);
    constexpr double h = 0.002;
    const auto at = [&](int k) {
        Bodies there = many.X, by = many.V;
        for (std::size_t b = 0; b < by.size(); ++b) by[b] = k * h * by[b], there[b] += by[b];
        return constraint_change(row, {}, many.X, {}, there, by);
    };
    EXPECT_NEAR(rate, (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h), 1e-7 * (1 + std::abs(rate)));
    EXPECT_NEAR(curvature, (16 * (at(1) + at(-1)) - (at(2) + at(-2))) / (12 * h * h),
                1e-5 * (1 + std::abs(curvature)));
}

TEST(CoupledJoints, OneBodyTooManyIsRefused)
{
    Random random(14);
    ManyWheels many(random);
    const Vector4 z = direction({0, 0, 1});
    many.terms.push_back({1, displacement_along(world, z, point({}), 2 * ManyWheels::n, point({}))});
    const ConstraintRow row = coupling_row(many.terms, 0, 1, "many");
    expect_complaint([&] { row_bodies(row); }, "joint-row");
}

struct TwoHinges {
    Bodies X{configuration({}, identity<3>()), configuration({}, identity<3>())};
    Joint left = at("left", 0), right = at("right", 1), slide = sliding();

    Joint at(const char* name, int body) const
    {
        return revolute(name, world, body, joint_frame(world_configuration, X[0], {}, {0, 0, 1}));
    }
    Joint sliding() const
    {
        return prismatic("slide", world, 1, joint_frame(world_configuration, X[1], {}, {0, 0, 1}),
                         world_configuration, X[1]);
    }
    Joint coupled(const std::vector<CoupledJoint>& terms) const { return coupling("both", terms, X, 2); }
};

TEST(CoupledJoints, ACouplingSaysWhatIsWrongWithItsTerms)
{
    const TwoHinges of;
    expect_complaint([&] { of.coupled({}); }, "coupling-terms");
    expect_complaint([&] { of.coupled({{1, &of.left, "angle"}}); }, "coupling-terms");
    expect_complaint([&] { of.coupled({{1, &of.left, "angle"}, {2, &of.left, "angle"}}); }, "coupling-terms");
    expect_complaint([&] { of.coupled({{1, &of.left, "angle"}, {0, &of.right, "angle"}}); }, "joint-factor");
    expect_complaint(
        [&] {
            of.coupled({{1, &of.left, "angle"}, {1, &of.right, "displacement"}});
        },
        "joint-coordinate");
    const Joint ball = spherical("ball", world, 0, {});
    expect_complaint([&] { of.coupled({{1, &of.left, "angle"}, {1, &ball, "angle"}}); }, "joint-coordinate");
    expect_complaint([&] { of.coupled({{1, &of.left, "angle"}, {pi, &of.right, "angle"}}); }, "gear-ratio");
    const Joint made = of.coupled({{1, &of.left, "angle"}, {-pi, &of.slide, "displacement"}});
    EXPECT_EQ(made.first, 0);
    EXPECT_EQ(made.second, 1);
    EXPECT_NEAR(made.rows[0].scale, 2 * pi, 1e-14);
}

TEST(CoupledJoints, ACouplingTouchesAsManyBodiesAsARow)
{
    const Bodies X(RowBodies::most + 1, configuration({}, identity<3>()));
    std::vector<Joint> hinges;
    for (int b = 0; b <= RowBodies::most; ++b)
        hinges.push_back(revolute("hinge " + std::to_string(b), world, b,
                                  joint_frame(world_configuration, X[0], {}, {0, 0, 1})));
    std::vector<CoupledJoint> terms;
    for (const Joint& hinge : hinges) terms.push_back({1, &hinge, "angle"});
    expect_complaint([&] { coupling("many", terms, X); }, "coupling-terms");
    terms.pop_back();
    EXPECT_EQ(row_bodies(coupling("many", terms, X).rows[0]).size, RowBodies::most);
}

TEST(CoupledJoints, GearsAndRacksAreCouplingsOfTwo)
{
    Random random(15);
    const TwoHinges of;
    const ConstraintRow rows[][2] = {
        {gear("g", of.left, of.right, 1.5, of.X).rows[0],
         of.coupled({{-1.5, &of.left, "angle"}, {1, &of.right, "angle"}}).rows[0]},
        {rack_and_pinion("r", of.left, of.slide, 0.3, of.X).rows[0],
         of.coupled({{-0.3, &of.left, "angle"}, {1, &of.slide, "displacement"}}).rows[0]}};
    for (const auto& [one, other] : rows)
        for (int n = 0; n < 20; ++n) {
            const Bodies X{configuration(random.vector(), random.rotation()),
                           configuration(random.vector(), random.rotation())};
            EXPECT_EQ(constraint_value(one, X), constraint_value(other, X));
        }
}

TEST(CoupledJoints, ACurveThatCrossesItselfIsRefused)
{
    const auto eight = [](double s) {
        CurvePoint at{{std::sin(2 * s), std::sin(s), 0},
                      {2 * std::cos(2 * s), std::cos(s), 0},
                      {-4 * std::sin(2 * s), -std::sin(s), 0},
                      {}};
        const double l = norm(at.first);
        at.normals = {Vector3{at.first[1] / l, -at.first[0] / l, 0}, Vector3{0, 0, 1}};
        return at;
    };
    expect_complaint(
        [&] {
            curve_rows({eight, 0, 2 * pi, true}, world, 0, point({}), 1);
        },
        "curve-crosses-itself");
    EXPECT_NO_THROW(curve_rows({ellipse, 0, 2 * pi, true}, world, 0, point({}), 1));
}

TEST(CoupledJoints, AnEllipseHoldsAllRound)
{
    const auto rows = curve_rows({ellipse, 0, 2 * pi, true}, world, 0, point({}), 1);
    for (int n = 0; n < 100; ++n) {
        const CurvePoint at = ellipse(0.1 * n);
        const double off = n % 2 ? 0 : 0.05;
        const Bodies X{configuration(at.x + off * at.normals[0], identity<3>())};
        EXPECT_NEAR(constraint_value(rows[0], X), off, 1e-14) << n;
        EXPECT_NEAR(constraint_value(rows[1], X), 0, 1e-15) << n;
    }
}

}   // namespace
}   // namespace livens::coupled_joints_test
