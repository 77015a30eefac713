// SPDX-License-Identifier: BSD-3-Clause
// Loads that a [[joint]] states itself, along its coordinate or, of two, in a table for each: one load of the
// model for each coordinate, made like a [[load]] of type spring on the joint, so that energies, sensors and
// results know it.
#include <algorithm>
#include <cstdint>

#include "livens/dynamics/instant/inertia_along.h"
#include "livens/io/scenario/joints/joints.h"
#include "livens/io/scenario/loads/load_makers.h"

namespace livens::inline io_internal {

namespace {

/// What a joint states of its coordinate, or a ball joint of all its turns together.
enum class Against : std::uint8_t { motion, turns, far_turns };

/// What stands along one coordinate of a joint.
struct AlongCoordinate {
    const Section* keys;      ///< of the joint, or of its table for the coordinate
    std::string load;         ///< name of what is made of them
    std::string_view which;   ///< coordinate; empty: the joint has but one
    Against against = Against::motion;
    int joint = -1;
    double inertia = 0;   ///< that a force along the coordinate moves, where somebody wants to know

    /// Null: the joint lacks it.
    const NamedCoordinate* coordinate(const Joint& of) const
    {
        if (against == Against::far_turns) return of.readings.empty() ? nullptr : &of.readings.back();
        return which.empty() ? &of.coordinates.front() : find_coordinate(of, which);
    }
    /// That are springs.
    bool has_limits() const
    {
        return against == Against::motion ? keys->has("limits") && !are_rigid_limits(*keys)
                                          : keys->has("limit");
    }
    bool acts() const
    {
        const bool is_held = keys->number("damping") > 0 || keys->number("stiffness") > 0;
        return against == Against::motion  ? is_held || has_limits()
               : against == Against::turns ? is_held
                                           : has_limits();
    }
};

std::string name_of_joint(const Section& joint)
{
    return joint.has("name") ? joint.text("name") : default_name(joint);
}

/// The parts of a joint that may hold loads.
std::vector<AlongCoordinate> loaded_parts(const Section& joint)
{
    if (joint.kind() == any_kind) return {};
    if (joint.takes("limits")) return {{&joint, name_of_joint(joint), ""}};
    std::vector<AlongCoordinate> parts;
    if (joint.takes("limit")) {
        parts.push_back({&joint, name_of_joint(joint), "", Against::turns});
        parts.push_back({&joint, name_of_joint(joint) + " limit", "rotation_angle", Against::far_turns});
    }
    for (const std::string_view which : {"angle", "displacement", "angle_1", "angle_2", "angle_3"}) {
        const std::span<const Section> tables = joint.sections(which);
        if (!tables.empty())
            parts.push_back({&tables.front(), name_of_joint(joint) + " " + std::string(which), which});
    }
    return parts;
}

bool check_joint_loads(const Section& joint, const AlongCoordinate& part)
{
    const Section& keys = *part.keys;
    if (joint.takes("angles") && !joint.has("angles") && part.against == Against::motion)
        return joint.error(part.which, "joint-loads",
                           joint.label() + " has no angles for '" + std::string(part.which) + "' to be along",
                           {"", "give 'angles', such as angles = \"xyz\""});
    if (part.against == Against::far_turns && !keys.has("limit") &&
        !keys.refuse({"limit_stiffness", "limit_damping"}, "joint-loads", "there is no 'limit'"))
        return false;
    if (keys.takes("rest") && !keys.has("stiffness") &&
        !keys.refuse({"rest"}, "joint-loads",
                     "it is where a spring has no force, and there is no 'stiffness'"))
        return false;
    if (keys.takes("limits") && !keys.has("limits") &&
        !keys.refuse({"limit_law", "limit_restitution", "limit_stiffness", "limit_damping"}, "joint-loads",
                     "there are no 'limits'"))
        return false;
    const bool is_rigid = are_rigid_limits(keys);
    if (is_rigid &&
        !keys.refuse({"limit_stiffness", "limit_damping"}, "joint-loads",
                     "limits that are rigid have none; limit_law = \"penalty\" makes them springs"))
        return false;
    if (keys.takes("limits") && keys.has("limits") && !is_rigid &&
        !keys.refuse({"limit_restitution"}, "joint-loads",
                     "limits that are springs have 'limit_damping'; limit_law = \"rigid\" makes them stops"))
        return false;
    if ((!part.acts() && !is_rigid) || !joint.has("until")) return true;
    return keys.error("", "joint-loads", joint.label() + " is released, but its loads would continue to act",
                      {"loads along a coordinate have no end",
                       "leave out 'until', or let a [[load]] of type \"actuator\" with 'until' act, by a "
                       "formula of the coordinate and its rate"});
}

/// Of a ball joint, against all turns.
Load make_ball_load(const Builder& builder, const AlongCoordinate& part, const Joint& joint)
{
    const double stiffness = part.keys->number("stiffness"), damping = part.keys->number("damping");
    const std::vector<Matrix34> X = places(builder);
    if (stiffness == 0) return rotational_damper(part.load, joint.first, joint.second, damping, X);
    return ball_spring(part.load, joint, stiffness, damping, X);
}

Load make_joint_load(Builder& builder, const AlongCoordinate& part, const Joint& joint,
                     const std::string& path)
{
    const Section& keys = *part.keys;
    if (part.against == Against::turns) return make_ball_load(builder, part, joint);
    if (part.coordinate(joint) == nullptr)
        throw InputError({"joint-angles", path, "a point mass has no axes, and a ball joint on it no limit",
                          "", "", "", "leave 'limit' out, or give the body a shape or an inertia"});
    const NamedCoordinate& coordinate = *part.coordinate(joint);
    JointSpring law;
    if (part.against == Against::motion)
        law = {keys.number("stiffness"), keys.number("damping"), keys.number("rest")};
    JointLimits limits;
    if (part.has_limits()) limits = read_limits(builder, keys, joint, coordinate, part.inertia, path);
    if (part.has_limits() && !ends_at_bends(builder))
        builder.findings().warning(
            keys.place(keys.takes("limits") ? "limits" : "limit"), "spring-kink",
            "the springs at the limits of '" + joint.name + "' begin to act where it gets there",
            {"no element ends there but of lobatto and radau, forwards one after the other, so that the "
             "estimated error may miss it as well",
             "take the family lobatto"});
    return joint_spring(part.load, coordinate, law, limits, places(builder));
}

/// Of limits whose stiffness is to follow from the bodies; of far turns the largest about any axis.
void find_inertias(const Model& model, std::vector<AlongCoordinate>& parts)
{
    std::vector<JointCoordinate> wanted;
    std::vector<AlongCoordinate*> owners;
    for (AlongCoordinate& part : parts) {
        if (!part.has_limits() || part.against == Against::turns || part.keys->has("limit_stiffness"))
            continue;
        const Joint& joint = model.joints()[static_cast<std::size_t>(part.joint)];
        std::vector<const NamedCoordinate*> along{part.coordinate(joint)};
        if (part.against == Against::far_turns) {   // all readings but the angle itself
            along.clear();
            for (std::size_t k = 0; k + 1 < joint.readings.size(); ++k) along.push_back(&joint.readings[k]);
        }
        for (const NamedCoordinate* one : along) {
            wanted.push_back(one->coordinate);
            owners.push_back(&part);
        }
    }
    if (wanted.empty()) return;
    const std::vector<double> inertias = inertias_along(model, wanted);
    for (std::size_t k = 0; k < owners.size(); ++k)
        owners[k]->inertia = std::max(owners[k]->inertia, inertias[k]);
}

}   // namespace

std::vector<std::string> names_of_joint_loads(const Builder& builder)
{
    std::vector<std::string> names;
    for (const Section& joint : builder.top().sections("joint"))
        for (const AlongCoordinate& part : loaded_parts(joint))
            if (part.acts()) names.push_back(part.load);
    return names;
}

void read_joint_loads(Builder& builder)
{
    const std::vector<Joint>& joints = builder.model().joints();
    std::vector<AlongCoordinate> parts;
    for (const Section& section : builder.top().sections("joint"))
        for (AlongCoordinate& part : loaded_parts(section)) {
            if (!check_joint_loads(section, part) || !part.acts()) continue;
            part.joint = builder.model().find_joint(name_of_joint(section));
            if (part.joint >= 0) parts.push_back(std::move(part));   // else told already
        }
    find_inertias(builder.model(), parts);
    for (const AlongCoordinate& part : parts) {
        const std::string path = "load[" + part.load + "]";
        builder.remember(path, *part.keys);
        builder.guard(path, [&] {
            Load load = make_joint_load(builder, part, joints[static_cast<std::size_t>(part.joint)], path);
            load.type = "joint";
            builder.model().add_load(std::move(load));
        });
    }
}

}   // namespace livens::inline io_internal
