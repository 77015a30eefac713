// SPDX-License-Identifier: BSD-3-Clause
#include "livens/diagnostics/sample.h"

#include <gtest/gtest.h>

#include <cmath>

#include "livens/base/error.h"
#include "unit/diagnostics/hand_made.h"

namespace livens::sample_test {
namespace {

/// A body that turns about its third axis with 2 rad/s and flies along x with 3 m/s.
struct Flight {
    Model model;
    Motion motion;
    Flight()
    {
        model.add_body(rigid_body("body", box(1, {0.3, 0.5, 0.9})));
        motion = hand_made::motion(model, hand_made::mesh(0, 1, 5), 6, [](double t) {
            const Vector3 w{0, 0, 2}, v{3, 0, 0};
            const Matrix34 X = configuration(t * v, directors_from_rotation_vector(t * w));
            Matrix34 V{};
            V.set_column(0, v);
            for (int i = 1; i < 4; ++i) V.set_column(i, cross(w, X.column(i)));
            return State{t, {X}, {V}};
        });
    }
};

TEST(Sample, IsTheMotionAtEndsAndBetweenThem)
{
    const Flight f;
    for (const double t : {0.0, 0.2, 0.33, 1.0}) {
        const BodySample s = sample_bodies(f.model, f.motion, t).front();
        EXPECT_NEAR(s.position[0], 3 * t, 1e-14);
        EXPECT_NEAR(s.angular_velocity[2], 2, 1e-7) << t;
        EXPECT_NEAR(s.quaternion[3], std::sin(t), 1e-9) << t;
        EXPECT_NEAR(s.linear_momentum[0], 3 * f.model.bodies()[0].mass(0, 0), 1e-13);
    }
    EXPECT_TRUE(sample_joints(f.model, f.motion, 0.2).empty()) << "it has no multipliers";
}

TEST(Sample, TakesTheElementEndThatDecimalsMean)
{
    const Flight f;
    EXPECT_EQ(snap_to_element_end(f.motion.mesh, std::nextafter(0.4, 1)), f.motion.mesh.ends[2]);
    EXPECT_EQ(snap_to_element_end(f.motion.mesh, 0.4 + 1e-12), 0.4 + 1e-12);
    EXPECT_EQ(element_end_at(f.motion.mesh, 0.4 + 1e-12), -1);
    for (const double t : {-0.1, 1.1, std::nan("")})
        EXPECT_THROW(sample_bodies(f.model, f.motion, t), InputError);
}

}   // namespace
}   // namespace livens::sample_test
