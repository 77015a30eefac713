// SPDX-License-Identifier: BSD-3-Clause
// Joints that depend on time, by the kit that every joint passes.
#include <gtest/gtest.h>

#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/model.h"
#include "properties/joint_kit.h"

namespace livens::driven_joints_test {
namespace {

/// mean + slope s + amplitude (1 - cos(rate s)), with s = t - kit_instant.
TimeFunction wave(double mean, double slope, double amplitude, double rate)
{
    return {[=](Instant at) {
                const double s = at.t - kit_instant.t;
                return TimeValue{mean + slope * s + amplitude * (1 - std::cos(rate * s)),
                                 slope + amplitude * rate * std::sin(rate * s),
                                 amplitude * rate * rate * std::cos(rate * s)};
            },
            {}};
}

Joint bare(const std::string& type, int first, int second, const JointFrame& frame)
{
    Joint joint = revolute("j", first, second, frame);
    joint.type = type;
    joint.rows.clear();
    joint.axis_first = joint.axis_second = {};
    return joint;
}

JointFrame anywhere(Random& random, const Matrix34& X_first, const Matrix34& X_second)
{
    return joint_frame(X_first, X_second, random.vector(), random.unit());
}

JointFrame with_points_apart(Random& random, const Matrix34&, const Matrix34&)
{
    return {random.vector(), random.vector(), random.unit(), random.unit()};
}

Joint driven_point(int first, int second, const JointFrame& frame, const Matrix34&, const Matrix34&)
{
    Joint joint = bare("driven point", first, second, frame);
    joint.rows =
        driven_point_rows(joint.first, point(joint.point_first), joint.second, point(joint.point_second),
                          {wave(0, 0.4, 0.3, 2), wave(0, 0, -0.5, 1.5), wave(0, -0.2, 0.7, 0.8)}, 1);
    return joint;
}

Joint driven_length(int first, int second, const JointFrame& frame, const Matrix34& X_first,
                    const Matrix34& X_second)
{
    Joint joint = bare("driven length", first, second, frame);
    const double length = norm(X_second * point(frame.point_second) - X_first * point(frame.point_first));
    joint.rows.push_back(driven_distance_row(joint.first, point(joint.point_first), joint.second,
                                             point(joint.point_second), wave(length, 0.1, 0.2, 3), length));
    return joint;
}

/// A revolute joint whose angle is driven; the sense changes with the order of the bodies.
Joint driven_angle(int first, int second, const JointFrame& frame, const Matrix34& X_first,
                   const Matrix34& X_second)
{
    Joint joint = revolute("j", first, second, frame);
    joint.type = "driven angle";
    const double sense = first > second ? -1 : 1, start = 0.9 * sense;
    const Vector3 axis = (1 / norm(frame.axis_first)) * frame.axis_first;
    Vector3 b1 = cross(axis, std::abs(axis[0]) < 0.7 ? Vector3{1, 0, 0} : Vector3{0, 1, 0});
    b1 *= 1 / norm(b1);
    const Vector3 b2 = cross(axis, b1);
    const Matrix3 to_second = transpose(directors(X_second)) * directors(X_first);
    const Vector4 a = direction(b1),
                  c1 = direction(to_second * (std::cos(start) * b1 + std::sin(start) * b2)),
                  c2 = direction(to_second * (std::cos(start) * b2 - std::sin(start) * b1));
    // the second turns forward, so that the first turns back against it
    const TimeFunction angle = wave(-start, -sense * 0.7, -sense * 0.2, 3);
    joint.rows.push_back(driven_angle_row(first, a, second, c1, c2, angle));
    joint.branches.push_back(driven_angle_branch(first, a, second, c1, c2, angle));
    return joint;
}

const JointCase point_case{"driven point", 3, anywhere, driven_point};
const JointCase length_case{"driven length", 1, with_points_apart, driven_length};
const JointCase angle_case{"driven angle", 6, anywhere, driven_angle};

TEST(DrivenJoints, APointALengthAndAnAnglePassTheKit)
{
    EXPECT_EQ(joined(check_joint(length_case)), "");
    EXPECT_EQ(joined(check_joint(angle_case)), "");
    // Exchanged, the path would be one in the axes of the other body: no order is checked.
    for (const auto check : {check_joint_labels, check_joint_closure, check_joint_gradient, check_joint_rates,
                             check_joint_rank, check_joint_objectivity, check_joint_world})
        EXPECT_EQ(joined(check(point_case)), "");
}

JointCase broken(JointCase joint, const std::function<void(Drive&)>& change)
{
    joint.make = [make = joint.make, change](int first, int second, const JointFrame& frame,
                                             const Matrix34& X, const Matrix34& Y) {
        Joint made = make(first, second, frame, X, Y);
        change(made.rows.back().drives.front());
        return made;
    };
    return joint;
}

TEST(DrivenJoints, AWrongDerivativeFailsTheRates)
{
    const auto wrong = [](double first, double second) {
        return [=](Drive& drive) {
            drive.factor = TimeFunction(
                [inner = drive.factor, first, second](Instant at) {
                    const TimeValue f = inner(at);
                    return TimeValue{f.value, first * f.first, second * f.second};
                },
                {});
        };
    };
    for (const JointCase& joint : {point_case, length_case, angle_case}) {
        EXPECT_EQ(joined(check_joint_rates(broken(joint, wrong(1, 1)))), "") << joint.type;
        EXPECT_NE(joined(check_joint_rates(broken(joint, wrong(1.01, 1)))), "") << joint.type;
        EXPECT_NE(joined(check_joint_rates(broken(joint, wrong(1, 1.01)))), "") << joint.type;
    }
}

/// What tables say of a row, against the row itself.
void expect_tables_agree(const ModelTables& tables, int r, const std::vector<Matrix34>& X,
                         const std::vector<Matrix34>& V)
{
    const ConstraintRow& row = tables.model->row(r);
    const double *x = X[0].data(), *v = V[0].data();
    const Instant at = kit_instant, before{0.1};
    EXPECT_NEAR(tables.rows.value(r, at, x), constraint_value(row, at, X), 1e-13);
    EXPECT_NEAR(tables.rows.rate(r, at, x), constraint_rate(row, at, X), 1e-13);
    EXPECT_NEAR(tables.rows.curvature(r, at, x, v), constraint_curvature(row, at, X, V), 1e-12);
    double g[RowTables::gradient_size] = {};
    tables.rows.gradient(r, at, x, g);
    std::vector<Matrix34> earlier = X;
    for (std::size_t b = 0; b < X.size(); ++b) earlier[b] -= V[b];
    EXPECT_NEAR(constraint_change(row, before, earlier, at, X, V),
                constraint_value(row, at, X) - constraint_value(row, before, earlier), 1e-12);
    const RowGradient expected = constraint_gradient(row, at, X);
    const auto& table = tables.rows[static_cast<std::size_t>(r)];
    double along = 0;   // V K V^T by the blocks of the Hessian
    for (int side = 0; side < table.n_sides; ++side) {
        const int body = table.bodies[side];
        for (int i = 0; i < 12; ++i) EXPECT_NEAR(g[12 * side + i], expected.of(body).a[i], 1e-13);
        for (int k = 0; k < table.n_sides; ++k) {
            const auto H = constraint_hessian(row, at, X, body, table.bodies[k]);
            for (int i = 0; i < 12; ++i)
                for (int j = 0; j < 12; ++j)
                    along += V[static_cast<std::size_t>(body)].a[i] * H(i, j) *
                             V[static_cast<std::size_t>(table.bodies[k])].a[j];
        }
    }
    EXPECT_NEAR(along, constraint_curvature(frozen(row, at), {}, X, V), 1e-12);
}

TEST(DrivenJoints, TablesSayWhatRowsSay)
{
    Random random(9);
    for (const JointCase& joint : {point_case, length_case, angle_case})
        for (const int first : {world, 0}) {
            const int second = first + 1;
            Model model;
            std::vector<Matrix34> X;
            for (int b = 0; b <= second; ++b) {
                X.push_back(random.rigid());
                model.add_body(
                    rigid_body("b" + std::to_string(b), box(1, {1, 2, 3}),
                               {.position = X.back().column(0), .directors = directors(X.back())}));
            }
            const Matrix34 X_first = first == world ? world_configuration : X[0], X_second = X.back();
            const JointFrame frame = joint.place(random, X_first, X_second);
            model.add_joint(joint.make(first, second, frame, X_first, X_second));
            EXPECT_TRUE(model.has_drives());
            EXPECT_FALSE(frozen(model, kit_instant).has_drives());
            const ModelTables tables(model, {});
            std::vector<Matrix34> V;
            for (Matrix34& x : X) {
                x = random.matrix<3, 4>();
                V.push_back(random.matrix<3, 4>());
            }
            for (int r = 0; r < model.n_rows(); ++r) expect_tables_agree(tables, r, X, V);
        }
}

TEST(DrivenJoints, ADriveThatJumpsIsRefused)
{
    Model model;
    model.add_body(point_mass("p", 1, {0, 0, -1}));
    const auto with = [](const TimeFunction& length) {
        Joint joint = rod("r", world, 0, {{0, 0, 0}, {0, 0, 0}}, 1);
        joint.rows = {driven_distance_row(world, point({0, 0, 0}), 0, point({0, 0, 0}), length, 1)};
        return joint;
    };
    expect_complaint([&] { model.add_joint(with(window(1, 0, 2))); }, "drive-jumps", "joint[r]");
    expect_complaint([&] { model.add_joint(with(linear_table({0, 1, 2}, {1, 2, 2}))); }, "drive-jumps");
    EXPECT_NO_THROW(model.add_joint(with(wave(1, 0, 0.1, 1))));
}

TEST(DrivenJoints, ARowWithDrivesWantsAnInstant)
{
    const ConstraintRow row = driven_distance_row(world, point({}), 0, point({}), 1, 1);
    const std::vector<Matrix34> X{Matrix34{}};
    EXPECT_THROW(constraint_value(row, X), std::logic_error);
    EXPECT_EQ(constraint_value(row, Instant{}, X), -0.5);
}

}   // namespace
}   // namespace livens::driven_joints_test
