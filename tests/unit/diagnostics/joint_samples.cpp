// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <span>

#include "livens/diagnostics/rigidity.h"
#include "livens/diagnostics/sample.h"
#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "unit/diagnostics/hand_made.h"
#include "unit/multibody/random_states.h"

namespace livens::joint_samples_test {
namespace {

/// A door on two hinges, and a lamp that hangs from it: hinges with rows too many and multipliers of any
/// size.
struct Door {
    Model model{{0, 0, -9.81}};
    Motion motion;

    explicit Door(bool is_redundant)
    {
        model.add_body(rigid_body("door", hand_made::skew_properties()));
        Placement below;
        below.position = {0.5, 0, -0.4};
        model.add_body(rigid_body("lamp", hand_made::skew_properties(), below));
        const auto at = [&](int first, int second, const Vector3& place) {
            const Matrix34 X = first == world ? world_configuration : model.bodies()[first].X;
            return joint_frame(X, model.bodies()[second].X, place, {0, 0, 1});
        };
        model.add_joint(revolute("low", world, 0, at(world, 0, {0, 0, 0})));
        if (is_redundant) model.add_joint(revolute("high", world, 0, at(world, 0, {0, 0, 1})));
        model.add_joint(revolute("chain", 0, 1, at(0, 1, {0.5, 0, 0})));
        Random random(7);
        motion = hand_made::motion(
            model, hand_made::mesh(0, 1, 5), 3,
            [&](double t) {
                const Matrix3 turn = directors_from_rotation_vector({0, 0, t});
                const Vector3 w{0, 0, 1}, x = turn * Vector3{0.5, 0, -0.4};
                const Matrix34 door = configuration({}, turn), lamp = configuration(x, turn);
                return State{t, {door, lamp}, {rate(door, {}, w), rate(lamp, cross(w, x), w)}};
            },
            [&](double) {
                std::vector<double> lambda(static_cast<std::size_t>(model.n_rows()));
                for (double& x : lambda) x = random.number();
                return lambda;
            });
        for (std::size_t i = 0; i < 2 * motion.mesh.ends.size(); ++i) {
            for (int r = 0; r < model.n_rows(); ++r) motion.end_multipliers.push_back(random.number());
            for (int b = 0; b < 2; ++b) motion.accelerations.push_back(random.matrix<3, 4>());
        }
        motion.redundant_rows = row_rank(model, model.start().X, all_rows(model)).dependent;
    }
};

void expect_near(const Reaction& a, const Reaction& b)
{
    EXPECT_LT(norm(a.force - b.force), 1e-12);
    EXPECT_LT(norm(a.torque - b.torque), 1e-12);
}

TEST(JointSampler, IsSampleJointsAtOneInstantAfterTheOther)
{
    for (const bool is_redundant : {false, true}) {
        const Door door(is_redundant);
        EXPECT_EQ(door.motion.redundant_rows.empty(), !is_redundant);
        const JointSampler joints(door.model, door.motion);
        for (const double t : {0.0, 0.2, 0.25, 0.4, 0.4, 1.0, 0.2}) {
            const State state = sample_state(door.motion, t);
            const std::vector<JointSample> found = joints.at(state),
                                           one = sample_joints(door.model, door.motion, t);
            ASSERT_EQ(found.size(), one.size());
            for (std::size_t j = 0; j < one.size(); ++j) {
                expect_near(found[j].left, one[j].left);
                expect_near(found[j].right, one[j].right);
                EXPECT_EQ(found[j].is_unique, one[j].is_unique);
                EXPECT_EQ(found[j].is_bounded, one[j].is_bounded);
                EXPECT_EQ(found[j].shared, one[j].shared);
                EXPECT_EQ(found[j].is_acceleration_level, one[j].is_acceleration_level);
                EXPECT_GT(norm(found[j].left.force), 1e-3);
            }
        }
    }
}

// Of redundant hinges by another way, which asks for no null vector. The control: what the multipliers say as
// they are is not the least.
TEST(JointSampler, ForcesAloneAreTheSame)
{
    for (const bool is_redundant : {false, true}) {
        const Door door(is_redundant);
        const JointSampler joints(door.model, door.motion);
        for (const double t : {0.0, 0.2, 0.25, 0.4, 1.0}) {
            const State state = sample_state(door.motion, t);
            const int end = element_end_at(door.motion.mesh, t);
            const std::vector<JointSample> all = joints.at(state);
            std::vector<JointSample> forces;
            joints.forces_at(end, state, forces);
            ASSERT_EQ(forces.size(), all.size());
            for (std::size_t j = 0; j < all.size(); ++j) {
                expect_near(forces[j].left, all[j].left);
                expect_near(forces[j].right, all[j].right);
                EXPECT_EQ(forces[j].is_acceleration_level, all[j].is_acceleration_level);
            }
            if (end < 0 || !is_redundant) continue;
            const std::size_t n = static_cast<std::size_t>(door.model.n_rows());
            const auto given =
                std::span(door.motion.end_multipliers).subspan(2 * static_cast<std::size_t>(end) * n, n);
            const Reaction as_given = joint_reaction(door.model, 0, state.X, given);
            EXPECT_GT(norm(as_given.force - forces[0].left.force), 1e-3);
        }
    }
}

TEST(JointSampler, ServesRigidity)
{
    for (const bool is_redundant : {false, true}) {
        const Door door(is_redundant);
        const JointSampler joints(door.model, door.motion);
        const Rigidity rigidity(door.model, door.motion);
        for (const double t : {0.0, 0.4, 0.2}) {
            joints.at(sample_state(door.motion, t));
            const std::vector<RigiditySample> one = rigidity.at(t),
                                              found =
                                                  rigidity.at_sample(sample_state(door.motion, t), &joints);
            for (std::size_t b = 0; b < one.size(); ++b) {
                EXPECT_LT(largest(found[b].left - one[b].left), 1e-12);
                EXPECT_LT(largest(found[b].right - one[b].right), 1e-12);
                EXPECT_EQ(found[b].is_unique, one[b].is_unique);
                EXPECT_GT(largest(one[b].left - one[b].right), 1e-3) << "both sides differ";
            }
        }
    }
}

}   // namespace
}   // namespace livens::joint_samples_test
