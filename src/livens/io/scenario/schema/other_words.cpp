// SPDX-License-Identifier: BSD-3-Clause
// Words of other programs for what is called differently here (docs/coming_from has whole pages on that). An
// unknown word that is one of them gets the right one as help, which a distance of letters would not find.
#include "livens/io/scenario/schema/other_words.h"

#include <algorithm>

namespace livens::inline io_internal {

namespace {

struct OtherWord {
    std::string_view word, choice, with = {};
};

constexpr OtherWord other_words[] = {
    // joints
    {"hinge", "revolute"},
    {"pin", "revolute"},
    {"ball", "spherical"},
    {"ball_joint", "spherical"},
    {"slider", "prismatic"},
    {"translational", "prismatic"},
    {"fixed", "weld"},
    {"rigid", "weld"},
    {"cardan", "universal"},
    {"hooke", "universal"},
    {"helical", "screw"},
    {"plane", "planar"},
    {"distance", "rod"},
    {"link", "rod"},
    {"homokinetic", "constant_velocity"},
    {"rack", "rack_and_pinion"},
    // loads
    {"moment", "torque"},
    {"point_force", "force"},
    {"damper", "spring", "with 'damping' alone"},
    {"dashpot", "spring", "with 'damping' alone"},
    {"spring_damper", "spring", "with 'damping'"},
    {"torsion_spring", "spring", "with 'joint', the hinge that it is wound about"},
    {"torsional_spring", "spring", "with 'joint', the hinge that it is wound about"},
    {"rotational_spring", "spring", "with 'joint', the hinge that it is wound about"},
    {"rotary_spring", "spring", "with 'joint', the hinge that it is wound about"},
    {"motor", "actuator", "with 'joint', if its torque is known; if its motion is, a [[drive]]"},
    {"wind", "drag"},
};

struct OtherKey {
    std::string_view kind, key, help;
};

constexpr std::string_view straight_slot = "a straight slot along an axis is \"point_on_line\"; "
                                           "\"point_in_plane\", where nothing has to hold the pin "
                                           "sideways";
constexpr std::string_view two_points =
    "its ends are 'points', one on each body in that body's own coordinates (on the world: in the world)";
constexpr std::string_view along_a_joint =
    "along a joint, between its bodies, acts type = \"actuator\": one number of 'value', 'table' or "
    "'expression'";
constexpr OtherKey other_keys[] = {
    {"rod", "at", two_points},
    {"spring", "at", two_points},
    {"torque", "joint", along_a_joint},
    {"force", "joint", along_a_joint},
    {"torque", "between", along_a_joint},
    {"force", "between", along_a_joint},
    {"force", "points", "one body, one 'point' in its coordinates"},
    {"spring", "length", "its length without force is 'free_length'"},
    {"spring", "rest_length", "its length without force is 'free_length'"},
    {"spring", "natural_length", "its length without force is 'free_length'"},
    {"spring", "k", "'stiffness'"},
    {"spring", "c", "'damping'"},
    {"slot", "at", straight_slot},
    {"slot", "axis", straight_slot},
    {"spherical", "axis", "a ball joint has no axis; what turns about one is \"revolute\""},
};

}   // namespace

std::string in_other_words(std::string_view word, const Words& choices)
{
    for (const OtherWord& other : other_words)
        // Only where the other word is a choice of this key: "fixed" means a weld among joints alone.
        if (other.word == word && index_of(choices, other.choice) >= 0)
            return "here it is \"" + std::string(other.choice) + "\"" + (other.with.empty() ? "" : " ") +
                   std::string(other.with);
    return {};
}

std::string instead_of_key(std::string_view kind, std::string_view key)
{
    for (const OtherKey& other : other_keys)
        if (other.kind == kind && other.key == key) return std::string(other.help);
    return {};
}

std::string type_told_by_keys(const Node& node, const Table& table)
{
    const Kind* only = nullptr;
    for (const Kind& kind : table.kinds) {
        const std::vector<const Key*> keys = table.keys_of(static_cast<int>(&kind - table.kinds.data()));
        const bool has_all = std::ranges::all_of(
            node.entries(), [&](const Entry& entry) { return find_key(keys, entry.key) != nullptr; });
        if (!has_all) continue;
        // Two types fit: to name one of them would be a guess.
        if (only != nullptr) return {};
        only = &kind;
    }
    return only == nullptr ? std::string()
                           : "write " + std::string(table.chooser) + " = \"" + std::string(only->word) + "\"";
}

}   // namespace livens::inline io_internal
