// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/accuracy/perturbations.h"

#include <gtest/gtest.h>

#include <numeric>

#include "livens/multibody/body.h"
#include "livens/multibody/joints.h"

namespace livens::tests::perturbations_test {
namespace {

/// Two rods on a wall, nearly in line, and a ball of 1e6 times their mass at their end.
Model bent_row()
{
    constexpr double bend = 1e-3;
    const Matrix3 J{1e-3, 0, 0, 0, 1e-2, 0, 0, 0, 1e-2};
    const Vector3 middle{std::cos(bend), 0, std::sin(bend)}, end{2 * std::cos(bend), 0, 0};
    Model model;
    model.add_body(
        rigid_body("inner", {1, {}, J}, {0.5 * middle, directors_from_rotation_vector({0, -bend, 0})}));
    model.add_body(rigid_body("outer", {1, {}, J},
                              {0.5 * (middle + end), directors_from_rotation_vector({0, bend, 0})}));
    model.add_body(point_mass("ball", 1e6, end));
    for (int i = 0; i < 3; ++i) {
        JointFrame frame;
        frame.point_first = {i > 0 ? 0.5 : 0, 0, 0};
        frame.point_second = {i < 2 ? -0.5 : 0, 0, 0};
        model.add_joint(spherical("joint " + std::to_string(i), i > 0 ? i - 1 : world, i, frame));
    }
    return model;
}

/// Places are rounded whatever weighs on them: none of them by more than its own numbers are.
TEST(Perturbations, RoundingOfAHeavyBodyDoesNotBendWhatHoldsIt)
{
    const Model model = bent_row();
    const State state = model.start();
    std::vector<int> rows(static_cast<std::size_t>(model.n_rows()));
    std::iota(rows.begin(), rows.end(), 0);
    Kicks kicks(3);
    kicks[2].shift = {1, 0, 0};   // along the row
    const double factor = 1e-9;
    const auto size = [&](bool are_roundings) {
        return Difference(KickedStates(model, rows).beside(state, kicks, factor, are_roundings), state, 1)
            .size_of_places(model);
    };
    EXPECT_LT(size(true), 3 * factor);
    EXPECT_GT(size(false), 100 * factor);   // a negative control: by masses rods turn, that the ball stays
}

}   // namespace
}   // namespace livens::tests::perturbations_test
