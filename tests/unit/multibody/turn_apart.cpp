// SPDX-License-Identifier: BSD-3-Clause
// The angle of a joint that does not always hold.
#include <gtest/gtest.h>

#include <limits>

#include "livens/multibody/model.h"
#include "unit/multibody/random_states.h"

namespace livens::turn_apart_test {
namespace {

/// A hinge between two bodies, whose directions across the axis are turned alike by `across`.
Model hinged(double across, double until)
{
    Model model;
    for (const char* name : {"one", "two"})
        model.add_body(rigid_body(name, {1, {}, {1, 0, 0, 0, 1, 0, 0, 0, 1}}));
    const Matrix3 turned = directors_from_rotation_vector({0, 0, across});
    JointFrame frame;
    frame.across_first = frame.across_second = turned.column(0);
    Joint hinge = revolute("hinge", 0, 1, frame);
    hinge.until = until;
    model.add_joint(hinge);
    return model;
}

TEST(Joints, AnAngleThatLetsGoNeedsNoDirectionsAcrossItsAxis)
{
    Random random(9);
    const double always = std::numeric_limits<double>::infinity();
    for (int n = 0; n < 100; ++n) {
        const double angle = 3 * random.number();
        const Vector3 tilt = 1.5 * Vector3{random.number(), random.number(), 0};   // across the axis
        const Matrix34 first = random.rigid();
        const auto value = [&](const Vector3& swing, double across, double until) {
            const Matrix3 turn =
                directors_from_rotation_vector(swing) * directors_from_rotation_vector({0, 0, angle});
            const std::vector<Matrix34> X{first, configuration(random.vector(), directors(first) * turn)};
            const Model model = hinged(across, until);
            return coordinate_value(model.joints()[0].coordinates[0].coordinate, X);
        };
        for (const double across : {0.0, 0.7, 2.0}) {
            EXPECT_NEAR(value({}, across, 1), angle, 1e-13) << "the axes are together";
            EXPECT_NEAR(value({}, across, always), angle, 1e-13);
            EXPECT_NEAR(value(tilt, across, 1), angle, 1e-12) << "the turn that is left";
        }
    }
}

}   // namespace
}   // namespace livens::turn_apart_test
