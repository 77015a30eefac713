// SPDX-License-Identifier: BSD-3-Clause
// Three rows hold a point, linear in X: theory.md, "Joints are quadratic forms". How it is turned:
// "Coordinates of joints", Universal and ball joints.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "livens/base/error.h"
#include "livens/multibody/joints/joint_frame.h"

namespace livens {

namespace {

std::array<int, 3> sequence_of(const std::string& name, const std::string& angles)
{
    static const std::string axes = "xyz";
    std::string sorted = angles;
    std::ranges::sort(sorted);
    if (sorted != axes)
        throw InputError({"joint-angles", "joint[" + name + "].angles",
                          "the angles of a ball joint are about three different axes", angles,
                          "x, y and z in any order", "others are not unique where all angles are zero",
                          "take \"xyz\", or \"zyx\" for yaw, pitch and roll"});
    std::array<int, 3> sequence{};
    for (std::size_t k = 0; k < 3; ++k) sequence[k] = static_cast<int>(axes.find(angles[k]));
    return sequence;
}

/// With what it is where the bodies are placed.
NamedCoordinate named(const std::string& name, JointCoordinate coordinate, int first,
                      const std::vector<Matrix34>& placed)
{
    JointCoordinate here = coordinate;
    for (PairForm& form : here.forms) {
        form.body_j = form.body_j == first ? 0 : 1;
        form.body_i = form.body_i == world ? world : 1 - form.body_j;
    }
    const double now = coordinate_value(here, placed);
    return {name, std::move(coordinate), now};
}

}   // namespace

Joint spherical(const std::string& name, int first, int second, const JointFrame& frame, double scale)
{
    JointFrame f = frame;
    Joint joint = start_joint(name, "spherical", first, second, f, scale);
    hold_point(joint, scale);
    return joint;
}

Joint spherical(const std::string& name, int first, int second, const JointFrame& frame, const BallTurn& turn,
                const Matrix34& X_first, const Matrix34& X_second, double scale)
{
    Joint joint = spherical(name, first, second, frame, scale);
    joint.triads = turn.triads;
    if (second == world) std::swap(joint.triads.first, joint.triads.second);   // see start_joint()
    const std::vector<Matrix34> placed{X_first, X_second};
    for (int k = 0; k < 3; ++k)
        joint.readings.push_back(named(std::string("rotation_vector_") + "xyz"[k],
                                       rotation_component(first, second, turn.triads, k), first, placed));
    joint.readings.push_back(
        named("rotation_angle", rotation_angle(first, second, turn.triads), first, placed));
    if (turn.angles.empty()) return joint;
    std::array<JointCoordinate, 3> angles =
        angles_of_turn(first, second, turn.triads, sequence_of(name, turn.angles));
    for (std::size_t k = 0; k < 3; ++k)
        joint.coordinates.push_back(
            named("angle_" + std::to_string(k + 1), std::move(angles[k]), first, placed));
    return joint;
}

}   // namespace livens
