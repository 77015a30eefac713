// SPDX-License-Identifier: BSD-3-Clause
// Keys of loads that joints bring themselves: what read_joint_loads() reads.
#include <string>
#include <utility>
#include <vector>

#include "livens/io/scenario/joints/joint_kinds.h"

namespace livens::inline io_internal {

namespace {

Key limit_law()
{
    return choice(
        "limit_law", {"rigid", "penalty"},
        "rigid: nothing passes the limits, which are stops of the names `JOINT.low` and `JOINT.high`; "
        "penalty: springs act beyond them. Where limit_stiffness or limit_damping stands: penalty.");
}

Key limit_restitution()
{
    return Key{"limit_restitution", types::number,
               "Of rigid limits: speed with which they are left, over that with which they were met.", "",
               "0"}
        .within({0, 1});
}

/// Loads along a coordinate, which the joint brings itself: what read_joint_loads() makes of them.
std::vector<Key> keys_along_angle()
{
    return {
        Key{"damping", types::number, "Damping torque per rad/s of the rate.", "N m s/rad", "0"}.within(
            not_negative),
        Key{"stiffness", types::number, "Restoring torque per radian from `rest`.", "N m/rad", "0"}.within(
            not_negative),
        Key{"rest", types::number, "Unloaded angle of the stiffness.", "rad", "0"},
        Key{"rotor_inertia", types::number,
            "Inertia along the angle, as of a geared rotor: adds half of it times the square of the rate to "
            "the kinetic energy. lobatto and radau only.",
            "kg m^2"}
            .within(positive),
        Key{"limits", types::interval,
            "Smallest and largest angle; `-inf` or `inf` means no limit. Of limits that are springs a torque "
            "limit_stiffness d (1 + limit_damping d') pushes back, beyond by d; it never pulls.",
            "rad"}
            .or_infinite(),
        limit_law(),
        limit_restitution(),
        Key{"limit_stiffness", types::number,
            "Stiffness of the limits. Default: such that a contact, half a period of the inertia on the "
            "joint, lasts 0.03 T with T = sqrt(model length / gravity), or 0.3 s without gravity.",
            "N m/rad"}
            .within(positive),
        Key{"limit_damping", types::number, "Damping of the limits. Default: T; 0 makes bounces lossless.",
            "s/rad"}
            .within(not_negative)};
}
std::vector<Key> keys_along_displacement()
{
    return {
        Key{"damping", types::number, "Damping force per m/s of the rate.", "N s/m", "0"}.within(
            not_negative),
        Key{"stiffness", types::number, "Restoring force per metre from `rest`.", "N/m", "0"}.within(
            not_negative),
        Key{"rest", types::number, "Unloaded displacement of the stiffness.", "m", "0"},
        Key{"rotor_inertia", types::number,
            "Inertia along the displacement, as of a geared rotor: adds half of it times the square of "
            "the rate to the kinetic energy. lobatto and radau only.",
            "kg"}
            .within(positive),
        Key{"limits", types::interval,
            "Smallest and largest displacement; `-inf` or `inf` means no limit. Of limits that are springs "
            "a force limit_stiffness d (1 + limit_damping d') pushes back, beyond by d; it never pulls.",
            "m"}
            .or_infinite(),
        limit_law(),
        limit_restitution(),
        Key{"limit_stiffness", types::number,
            "Stiffness of the limits. Default: such that a contact, half a period of the mass on the "
            "joint, lasts 0.03 T with T = sqrt(model length / gravity), or 0.3 s without gravity.",
            "N/m"}
            .within(positive),
        Key{"limit_damping", types::number,
            "Damping of the limits. Default: T / model length; 0 makes bounces lossless.", "s/m"}
            .within(not_negative)};
}

}   // namespace

std::vector<Key> and_along_angle(std::vector<Key> keys)
{
    for (Key& key : keys_along_angle()) keys.push_back(std::move(key));
    return keys;
}
std::vector<Key> and_along_displacement(std::vector<Key> keys)
{
    for (Key& key : keys_along_displacement()) keys.push_back(std::move(key));
    return keys;
}

Key table_along_angle(std::string_view word, const std::string& of)
{
    return Key{word, types::table, "Damping, spring, rotor and limits along " + of + "."}.holding(
        {"angle of a joint", "Loads along the angle.", keys_along_angle()});
}
std::vector<Key> and_along_both(std::vector<Key> keys)
{
    keys.push_back(table_along_angle("angle", "the angle"));
    keys.push_back(
        Key{"displacement", types::table, "Damping, spring, rotor and limits along the displacement."}
            .holding(
                {"displacement of a joint", "Loads along the displacement.", keys_along_displacement()}));
    return keys;
}

std::vector<Key> and_against_turns(std::vector<Key> keys)
{
    for (const Key& key :
         {Key{"damping", types::number, "Damping torque per rad/s of relative angular velocity.", "N m s/rad",
              "0"}
              .within(not_negative),
          Key{"stiffness", types::number,
              "Restoring torque per radian, against the rotation vector; up to 175 degrees.", "N m/rad", "0"}
              .within(not_negative),
          Key{"limit", types::number,
              "Largest angle of the rotation, about whatever axis. Beyond it by d, a torque limit_stiffness "
              "d "
              "(1 + limit_damping d') pushes back; it never pulls.",
              "rad"}
              .within(positive),
          Key{"limit_stiffness", types::number,
              "Stiffness of the limit. Default: as for the limits of a revolute joint, with the largest "
              "inertia about any axis.",
              "N m/rad"}
              .within(positive),
          Key{"limit_damping", types::number,
              "Damping of the limit. Default: sqrt(model length / gravity), or 0.3 s; 0 makes bounces "
              "lossless.",
              "s/rad"}
              .within(not_negative),
          table_along_angle("angle_1", "the first angle"), table_along_angle("angle_2", "the second angle"),
          table_along_angle("angle_3", "the third angle")})
        keys.push_back(key);
    return keys;
}

}   // namespace livens::inline io_internal
