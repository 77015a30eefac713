// SPDX-License-Identifier: BSD-3-Clause
// Joints that say twice what others say, in axes that turn: the rows that are left out change on the way.
#include <cmath>

#include "livens/multibody/joints/drives.h"
#include "livens/time/time_laws.h"
#include "mechanisms.h"

namespace livens::tests::redundant_test {
namespace {

/// An arm that turns about a world axis carries a bob on a hinge: one joint, or a plane and a ball, which
/// hold the same and one row more than is needed, that of the normal.
Model carried_bob(bool is_hinge, double spin)
{
    Model model({0, 0, -9.81});
    const Vector3 place{0, 0.5, 0}, normal{0, 0.1, 1};
    const auto body = [](const char* name, const Vector3& center, const Matrix3& inertia, const Vector3& at,
                         const Vector3& w) {
        return rigid_body(name, {1, center, inertia},
                          {.position = at, .velocity = cross(w, at), .angular_velocity = w});
    };
    const Vector3 w{spin, 0, 0};
    model.add_body(body("arm", {0, 0.2, 0}, Matrix3{0.03, 0, 0, 0, 0.01, 0, 0, 0, 0.03}, {0, 0, 0}, w));
    model.add_body(body("bob", {0.2, 0.1, 0}, Matrix3{0.01, 0, 0, 0, 0.02, 0, 0, 0, 0.015}, place, w));
    model.add_joint(revolute("axle", world, 0, {.axis_first = {1, 0, 0}, .axis_second = {1, 0, 0}}));
    const JointFrame pin{.point_first = place, .axis_first = normal, .axis_second = normal};
    if (is_hinge) {
        model.add_joint(revolute("pin", 0, 1, pin));
        return model;
    }
    model.add_joint(planar("plane", 0, 1,
                           {.point_first = place + Vector3{0, 0, 0.4},
                            .point_second = {0, 0, 0.4},
                            .axis_first = normal,
                            .axis_second = normal}));
    model.add_joint(spherical("ball", 0, 1, {.point_first = place}));
    return model;
}

double distance(const Solution& a, const Solution& b)
{
    const State x = a.motion.at_end(a.motion.n_elements()), y = b.motion.at_end(b.motion.n_elements());
    double far = 0;
    for (std::size_t i = 0; i < x.X.size(); ++i) far = std::max(far, norm(x.X[i] - y.X[i]));
    return far;
}

TEST(RedundantRows, ThatTurnAreChosenAgain)
{
    for (const double spin : {0.5, 1.0, 3.0, 7.0, 14.0}) {
        const Model once = carried_bob(true, spin), twice = carried_bob(false, spin);
        for (const double accuracy : {1e-3, 1e-6, 1e-9}) {
            const Span span{.start = 0, .end = 2, .accuracy = accuracy};
            const Solution a = solve(once, {once.start()}, span, Lobatto{0}),
                           b = solve(twice, {twice.start()}, span, Lobatto{0});
            ASSERT_TRUE(b.report.converged()) << spin << " rad/s to " << accuracy << ": " << b.report.message;
            EXPECT_LT(distance(a, b), 4 * accuracy) << spin;
        }
        for (const int n : {11, 30, 150}) {
            const TimeMesh mesh = make_time_mesh(0, 2, n);
            const Solution a = solve(once, {once.start()}, mesh, Lobatto{6});
            const Solution b = solve(twice, {twice.start()}, mesh, Lobatto{6});
            ASSERT_TRUE(b.motion.end() == 2) << spin << " rad/s, " << n << ": " << b.report.message;
            const double told = a.estimate.largest + b.estimate.largest;
            EXPECT_LT(distance(a, b), 5 * told + 1e-9) << spin << " rad/s, " << n;
        }
    }
}

/// Two rods between the same points, of which one begins to grow.
TEST(RedundantRows, ThatDoContradictAreTold)
{
    Model model({0, 0, -9.81});
    model.add_body(point_mass("bead", 1, {1, 0, 0}, {0, 0, -1}));
    const std::vector<Matrix34> X = model.start().X;
    const Configurations at_start(X.front().a);
    for (const double growth : {0.0, 0.1})
        model.add_joint(driven_distance("rod" + std::to_string(model.joints().size()), world, {}, 0, {},
                                        polynomial({1, 0, 0, growth}), at_start));
    const auto expect_told = [&](const Time& time) {
        const Solution s =
            solve(model, {model.start()}, time, Lobatto{std::holds_alternative<Span>(time) ? 0 : 6});
        EXPECT_EQ(s.report.status, SolveStatus::singular);
        EXPECT_NE(s.report.message.find("contradicts the other joints"), std::string::npos)
            << s.report.message;
        EXPECT_LT(s.report.failed_at, 0.01) << "0.1 t^3 is 1e-7 there";
        EXPECT_LT(s.report.evaluations, 20000) << "soon";
    };
    expect_told(Span{.start = 0, .end = 1, .accuracy = 1e-6});
    expect_told(make_time_mesh(0, 1, 20));
}

}   // namespace
}   // namespace livens::tests::redundant_test
