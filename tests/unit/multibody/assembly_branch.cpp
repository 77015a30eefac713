// SPDX-License-Identifier: BSD-3-Clause
// Rows a . b = 0 admit an axis turned end for end; assembly does not.
#include <gtest/gtest.h>

#include "livens/base/error.h"
#include "livens/multibody/closing.h"

namespace livens {
namespace {

TEST(ClosedStart, RefusesARevoluteWithItsAxesTurnedEndForEnd)
{
    for (const double sign : {1.0, -1.0}) {
        Model model;
        model.add_body(rigid_body("box", box(1, {1, 2, 3})));
        JointFrame f;
        f.axis_second = {0, 0, sign};
        model.add_joint(revolute("hinge", world, 0, f));
        if (sign > 0) {
            EXPECT_EQ(close_start(model, model.start(), StartPolicy::check).degrees_of_freedom, 1);
            continue;
        }
        try {
            close_start(model, model.start(), StartPolicy::project);
            FAIL() << "the opposite axis was accepted";
        } catch (const InputError& error) {
            EXPECT_EQ(error.complaint().code, "joint-branch");
            EXPECT_EQ(error.complaint().path, "joint[hinge].axes");
        }
    }
}

}   // namespace
}   // namespace livens
