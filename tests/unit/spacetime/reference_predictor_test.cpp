// SPDX-License-Identifier: BSD-3-Clause
// Places of nodes as a motion nearby has them.
#include "livens/spacetime/nodal/kernel/reference_predictor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "livens/multibody/model.h"

namespace livens::reference_predictor_test {
namespace {

using Turn = std::function<Matrix3(double)>;

/// About a fixed axis, by an angle that is not steady, up to `most` rad at the end of two units of time.
Turn about(const Vector3& axis, double most)
{
    return [=](double t) {
        const double share = t / 2;
        return directors_from_rotation_vector(most * share * (1.2 - 0.2 * share) * axis);
    };
}

Vector3 shift(double t) { return {std::sin(t), 1 + t * t, -3 * t}; }

/// A body whose centre of mass is off its reference point, and a point mass.
Model two_bodies()
{
    Model model;
    model.add_body(rigid_body("slab", {2, {0.3, -0.1, 0.2}, identity<3>()}));
    model.add_body(point_mass("bob", 1, {}));
    return model;
}

/// Of two elements, [0, 1] and [1, 2]; the slab turns from an orientation of its own.
Motion motion_of(const Turn& turn, int degree)
{
    Motion motion;
    motion.n_bodies = 2;
    motion.mesh.ends = {0, 1, 2};
    motion.X = {24, degree, true, std::vector<double>(24 * (2 * static_cast<std::size_t>(degree) + 1))};
    const ElementRule rule = lobatto_rule(degree);
    const Matrix3 first = directors_from_rotation_vector({0.4, -1, 0.7});
    for (int e = 0; e < 2; ++e)
        for (int a = 0; a <= degree; ++a) {
            const double t = e + rule.nodes[a];
            const std::span<double> X = motion.X.coefficient(e, a);
            const Matrix34 slab = configuration(shift(t), first * turn(t)),
                           bob = configuration(-2.0 * shift(t), Matrix3{});
            std::copy_n(slab.a, 12, X.begin());
            std::copy_n(bob.a, 12, X.begin() + 12);
        }
    return motion;
}

WindowLayout stretch_of(double from, double to, int degree)
{
    WindowLayout stretch;
    stretch.times = {from, to};
    stretch.degree = degree;
    return stretch;
}

/// Largest difference between where the found places have the slab and the bob and where they are.
double error_of(const Turn& turn, const WindowLayout& stretch, int of_motion)
{
    const Model model = two_bodies();
    const ModelTables tables(model, {});
    const ElementRule rule = lobatto_rule(stretch.degree);
    const lanes::Functions& functions = *lanes::sse2(stretch.degree);
    const int W = functions.width;
    const Motion motion = motion_of(turn, of_motion);
    ReferencePredictor following(motion, tables, rule, functions);
    std::vector<double> place(static_cast<std::size_t>(14 * W), 0.25);
    EXPECT_TRUE(following.place(stretch, place.data()));
    const Matrix3 first = directors_from_rotation_vector({0.4, -1, 0.7});
    const double start = stretch.times[0];
    const auto centre = [&](double t) { return shift(t) + first * turn(t) * Vector3{0.3, -0.1, 0.2}; };
    double error = 0;
    const auto compare = [&](double found, double exact) {
        error = std::max(error, std::abs(found - exact));
    };
    for (int l = 0; l < stretch.degree; ++l) {
        const double t = stretch.time(rule, l == 0 ? stretch.degree : l);
        const auto at = [&](int i) { return place[static_cast<std::size_t>(i * W + l)]; };
        const double s = at(3), v[3] = {at(4), at(5), at(6)};
        const Matrix3 exact = transpose(turn(start)) * turn(t);
        for (int i = 0; i < 3; ++i) {
            compare(at(i), (centre(t) - centre(start))[i]);
            compare(at(7 + i), -2 * (shift(t) - shift(start))[i]);
            for (int j = 0; j < 3; ++j) {   // R = (s^2 - v.v) 1 + 2 v v^T + 2 s v~
                const int k = 3 - i - j;
                const double cross = i == j ? 0 : ((j - i + 3) % 3 == 1 ? -1 : 1) * v[k];
                const double square = s * s - v[0] * v[0] - v[1] * v[1] - v[2] * v[2];
                compare((i == j ? square : 0) + 2 * v[i] * v[j] + 2 * s * cross, exact(i, j));
            }
        }
        compare(s * s + v[0] * v[0] + v[1] * v[1] + v[2] * v[2], 1);
    }
    return error;
}

TEST(ReferencePredictor, HasThePlacesOfTheMotion)
{
    // from small turns to more than a whole one in an element, about axes that each make another number the
    // largest of the quaternion
    for (const Vector3& axis : {Vector3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.48, -0.6, 0.64}, {-1, 0, 0}})
        for (const double most : {1e-6, 0.5, 5.0, 9.0}) {
            const double allowed = most < 1 ? 1e-11 : 2e-5;   // degree 12, by its own polynomial
            EXPECT_LT(error_of(about(axis, most), stretch_of(0, 1, 14), 12), allowed) << most;
            EXPECT_LT(error_of(about(axis, most), stretch_of(1, 2, 14), 12), allowed) << most;
            EXPECT_LT(error_of(about(axis, most), stretch_of(2, 1, 13), 12), allowed) << "against time";
        }
    // of the same degree its own nodes, as many as there are lanes
    for (const int degree : {4, 7, 8, 12}) {
        EXPECT_LT(error_of(about({0.48, -0.6, 0.64}, 5), stretch_of(1, 2, degree), degree), 1e-14) << degree;
        EXPECT_LT(error_of(about({0, 1, 0}, 0.5), stretch_of(2, 1, degree), degree), 1e-14) << degree;
    }
    // a control: of a low degree it is a guess
    EXPECT_GT(error_of(about({0, 0, 1}, 5), stretch_of(0, 1, 5), 3), 1e-3);
}

TEST(ReferencePredictor, RefusesWhatItHasNoElementFor)
{
    const Model model = two_bodies();
    const ModelTables tables(model, {});
    const ElementRule rule = lobatto_rule(6);
    const lanes::Functions& functions = *lanes::sse2(6);
    std::vector<double> place(static_cast<std::size_t>(14 * functions.width));
    const auto follows = [&](const Motion& motion, double from, double to) {
        return ReferencePredictor(motion, tables, rule, functions)
            .place(stretch_of(from, to, 6), place.data());
    };
    const Turn turn = about({0, 0, 1}, 1);
    const Motion motion = motion_of(turn, 4);
    EXPECT_TRUE(follows(motion, 1, 2));
    for (const auto& [from, to] : {std::pair{0.0, 2.0}, {0.0, 0.5}, {0.5, 1.0}, {2.0, 3.0}, {-1.0, 0.0}})
        EXPECT_FALSE(follows(motion, from, to)) << from << ' ' << to;
    EXPECT_FALSE(follows(motion_of(turn, 2), 0, 1)) << "series say more";
    EXPECT_FALSE(follows(motion_of(turn, functions.width + 1), 0, 1)) << "more nodes than lanes";
    Motion other = motion;
    other.X.points = Points::radau;
    EXPECT_FALSE(follows(other, 0, 1));
    other = motion;
    other.X.denominators.assign(9, 1.0);
    EXPECT_FALSE(follows(other, 0, 1));
    Model alone;
    alone.add_body(point_mass("bob", 1, {}));
    const ModelTables fewer(alone, {});
    EXPECT_FALSE(ReferencePredictor(motion, fewer, rule, functions).place(stretch_of(0, 1, 6), place.data()));
    EXPECT_FALSE(ReferencePredictor().place(stretch_of(0, 1, 6), place.data())) << "nothing to follow";
}

}   // namespace
}   // namespace livens::reference_predictor_test
