// SPDX-License-Identifier: BSD-3-Clause
// Every joint: order 2p at element ends of motion, coordinates and reactions; and what ideal joints do not
// do.
#include <functional>

#include "convergence/studies.h"
#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/sample.h"
#include "livens/multibody/joints/spline_curve.h"
#include "livens/multibody/model.h"

namespace livens::tests::joints_test {
namespace {

const Vector3 place{0.3, 0.1, -0.2}, along{0.48, 0.6, 0.64}, across{0.8, 0, -0.6};

using Make = std::function<Joint(const JointFrame&, const Matrix34&, const Matrix34&)>;

struct Case {
    const char* type;
    Make make;
    bool has_two_axes = false;   ///< perpendicular, at the start
};

const std::vector<Case>& cases()
{
    static const std::vector<Case> all{
        {"revolute", [](auto& f, auto&, auto&) { return revolute("j", 0, 1, f); }},
        {"prismatic", [](auto& f, auto& X, auto& Y) { return prismatic("j", 0, 1, f, X, Y); }},
        {"cylindrical", [](auto& f, auto&, auto&) { return cylindrical("j", 0, 1, f); }},
        {"screw", [](auto& f, auto& X, auto& Y) { return screw("j", 0, 1, f, X, Y, 0.4); }},
        {"planar", [](auto& f, auto&, auto&) { return planar("j", 0, 1, f); }},
        {"universal", [](auto& f, auto&, auto&) { return universal("j", 0, 1, f); }, true},
        {"constant_velocity", [](auto& f, auto& X, auto& Y) { return constant_velocity("j", 0, 1, f, X, Y); },
         true},
        {"spherical", [](auto& f, auto&, auto&) { return spherical("j", 0, 1, f); }},
        {"point_on_line", [](auto& f, auto&, auto&) { return point_on_line("j", 0, 1, f); }},
        {"point_in_plane", [](auto& f, auto&, auto&) { return point_in_plane("j", 0, 1, f); }},
        {"parallel_axes", [](auto& f, auto&, auto&) { return parallel_axes("j", 0, 1, f); }},
        {"perpendicular_axes", [](auto& f, auto&, auto&) { return perpendicular_axes("j", 0, 1, f); }, true},
        {"constant_angle", [](auto& f, auto&, auto&) { return constant_angle("j", 0, 1, f, std::acos(0.0)); },
         true},
        {"weld", [](auto& f, auto& X, auto& Y) { return weld("j", 0, 1, f, X, Y); }},
        {"rod",
         [](JointFrame f, auto& X, auto& Y) {
             f.point_second += Vector3{0.2, 0.1, -0.15};
             return rod("j", 0, 1, f, norm(X * point(f.point_first) - Y * point(f.point_second)));
         }},
        {"slot",
         [](auto& f, auto& X,
            auto& Y) {   // the point begins between two points of the curve, and stays there
             const Vector3& p = f.point_first;
             const Curve curve = spline_curve({p - Vector3{2, 1, 0}, p - Vector3{0.8, 0, 0.3},
                                               p + Vector3{0.9, 0.2, 0}, p + Vector3{2, 0.4, 1}},
                                              false);
             const Vector3 at = X * point(curve.at(0.5 * (curve.first + curve.last)).x);
             return slot("j", 0, 1, curve, transpose(directors(Y)) * (at - Y.column(0)), X, Y);
         }},
    };
    return all;
}

/// A body on a ball joint that carries another by the joint, both turning as one at the start; springs pull
/// the other along and aside, so that the joint moves.
Model carried(const Case& c)
{
    Model model({0, 0, -9.81});
    const Vector3 w{0.7, -0.4, 1.1};
    const auto body = [&](const char* name, const Vector3& at, const Vector3& turn) {
        Placement placement;
        placement.position = at;
        placement.directors = directors_from_rotation_vector(turn);
        placement.velocity = cross(w, at);
        placement.angular_velocity = w;
        return model.add_body(rigid_body(name, with_mass(box(1, {0.5, 0.3, 0.2}), 2), placement));
    };
    body("carrier", {0.4, 0, 0}, {0.2, 0.1, 0});
    body("carried", {0.9, 0.3, -0.1}, {0, -0.3, 0.4});
    const Matrix34 &X = model.bodies()[0].X, &Y = model.bodies()[1].X;
    model.add_joint(spherical("ball", world, 0, joint_frame(world_configuration, X, {})));
    JointFrame frame = joint_frame(X, Y, place, along);
    if (c.has_two_axes) frame.axis_second = joint_frame(X, Y, place, across).axis_second;
    model.add_joint(c.make(frame, X, Y));
    model.add_load(spring_damper("pull", world, {1.5, 1, 0.5}, 1, {0.2, 0, 0}, {15, 0.5, 0.4}));
    model.add_load(spring_damper("between", 0, {0, 0.2, 0}, 1, {0, 0, 0.1}, {20, 0, 0.3}));
    return model;
}

struct End {
    State state;
    std::vector<CoordinateValue> coordinates;
    std::vector<JointSample> joints;
};

End end_of(const Model& model, double end, int elements, int degree)
{
    const Solution s = solve_evenly(model, end, elements, degree);
    EXPECT_TRUE(s.report.converged()) << s.report.message;
    return {last(s), JointCoordinates(model, s.motion).at(end), sample_joints(model, s.motion, end)};
}

/// X and V, coordinates and rates, forces and torques, each as one number.
std::array<double, 3> gaps(const End& a, const End& b)
{
    const Distance d = distance(a.state, b.state);
    std::array<double, 3> all{std::max(d.X, d.V), 0, 0};
    for (std::size_t i = 0; i < a.coordinates.size(); ++i)
        all[1] = std::max({all[1], std::abs(a.coordinates[i].value - b.coordinates[i].value),
                           std::abs(a.coordinates[i].rate - b.coordinates[i].rate)});
    for (std::size_t j = 0; j < a.joints.size(); ++j)
        all[2] = std::max({all[2], norm(a.joints[j].right.force - b.joints[j].right.force),
                           norm(a.joints[j].right.torque - b.joints[j].right.torque)});
    return all;
}

/// Of the straight line through points.
double slope(const std::vector<double>& x, const std::vector<double>& y)
{
    const double n = static_cast<double>(x.size());
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        sx += x[i];
        sy += y[i];
        sxx += x[i] * x[i];
        sxy += x[i] * y[i];
    }
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

TEST(EveryJoint, HasOrder2pOfMotionCoordinatesAndReactions)
{
    constexpr double end = 0.4;
    constexpr const char* what[3] = {"motion", "coordinates", "reactions"};
    for (const Case& c : cases()) {
        const Model model = carried(c);
        const End fine = end_of(model, end, 60, 10);
        for (const auto& [degree, n] : {std::pair{1, 320}, std::pair{2, 48}, std::pair{3, 24}}) {
            const std::array<double, 3> coarse = gaps(end_of(model, end, n, degree), fine),
                                        finer = gaps(end_of(model, end, n * 5 / 4, degree), fine);
            for (int k = 0; k < 3; ++k) {
                if (coarse[k] == 0) continue;   // a joint without coordinates
                const double order = std::log(coarse[k] / finer[k]) / std::log(1.25);
                EXPECT_NEAR(order, 2 * degree, 0.3)
                    << c.type << " " << what[k] << " p = " << degree << ": " << coarse[k] << " " << finer[k];
            }
        }
    }
}

/// Errors of degree 4 are rounding soon: each is followed from where it is small until it is not much above.
/// So short a way is not quite straight: each is steeper than degree 3 has it, and in the mean they are
/// right.
TEST(EveryJoint, HasOrder8WithDegree4)
{
    constexpr double end = 0.4, small = 1e-6, rounding = 3e-12;
    constexpr const char* what[3] = {"motion", "coordinates", "reactions"};
    double mean = 0;
    int count = 0;
    for (const Case& c : cases()) {
        const Model model = carried(c);
        const End fine = end_of(model, end, 60, 10);
        std::array<std::vector<double>, 3> lengths, errors;   // logarithms
        for (int n = 4; n <= 48; n += n / 4) {
            const std::array<double, 3> gap = gaps(end_of(model, end, n, 4), fine);
            for (int k = 0; k < 3; ++k) {
                if (gap[k] > small || gap[k] < (k == 2 ? 10 : 1) * rounding) continue;
                lengths[k].push_back(-std::log(n));
                errors[k].push_back(std::log(gap[k]));
            }
        }
        for (int k = 0; k < 3; ++k) {
            if (k == 1 && fine.coordinates.empty()) continue;
            ASSERT_GE(errors[k].size(), 3U) << c.type << " " << what[k];
            const double order = slope(lengths[k], errors[k]);
            EXPECT_GT(order, 6.5) << c.type << " " << what[k];
            mean += order;
            ++count;
        }
    }
    EXPECT_NEAR(mean / count, 8, 0.25) << count << " orders";
}

/// Ideal joints do no work: what they exert on both bodies has no power on their velocities.
TEST(EveryJoint, OfThemNoneDoesWork)
{
    for (const Case& c : cases()) {
        const Model model = carried(c);
        const Solution s = solve_evenly(model, 0.4, 20, 6);
        const State state = last(s);
        const std::size_t n = static_cast<std::size_t>(model.n_rows());
        const double* lambda =
            s.motion.end_multipliers.data() + static_cast<std::size_t>(2 * s.motion.n_elements()) * n;
        double power = 0, size = 0;
        for (int r = model.first_row(1); r < model.n_rows(); ++r) {
            const RowGradient gradient = constraint_gradient(model.row(r), state.X);
            for (int b = 0; b < 2; ++b) {
                power += lambda[r] * dot(gradient.of(b), state.V[b]);
                size += std::abs(lambda[r]) * norm(gradient.of(b)) * norm(state.V[b]);
            }
        }
        EXPECT_LT(std::abs(power), 1e-13 * size) << c.type;
        EXPECT_LT(s.verdict.energy_drift, 1e-8) << c.type;
    }
}

}   // namespace
}   // namespace livens::tests::joints_test
