// SPDX-License-Identifier: BSD-3-Clause
// Words of other programs for what is called differently here (docs/coming_from has whole pages on that). An
// unknown word that is one of them gets the right one as help, which a distance of letters would not find.
#include "livens/io/scenario/schema/other_words.h"

#include <algorithm>

#include "livens/io/scenario/schema/other_keys.h"

namespace livens::inline io_internal {

namespace {

struct OtherWord {
    std::string_view word, choice, with = {};
};

// Beside the nearest method; with a semicolon it is only that.
constexpr std::string_view by_itself = "; leave [method] out and livens chooses";
constexpr std::string_view for_stiff = ", for stiff models; leave [method] out and livens chooses";
constexpr std::string_view reference = ", a reference of low order; leave [method] out and livens chooses";

// Spelled as without_case() has them. A word of several kinds stands once for each.
constexpr OtherWord other_words[] = {
    // joints
    {"hinge", "revolute"},
    {"hingejoint", "revolute"},
    {"pin", "revolute"},
    {"pinjoint", "revolute"},
    {"pivot", "revolute"},
    {"bearing", "revolute"},
    {"rotational", "revolute"},
    {"rotary", "revolute"},
    {"rotation", "revolute"},
    {"revolutejoint", "revolute"},
    {"continuous", "revolute"},
    {"r", "revolute"},
    {"ball", "spherical"},
    {"balljoint", "spherical"},
    {"socket", "spherical"},
    {"ballandsocket", "spherical"},
    {"sphericaljoint", "spherical"},
    {"s", "spherical"},
    {"gimbal", "spherical"},
    {"slider", "prismatic"},
    {"slide", "prismatic"},
    {"sliding", "prismatic"},
    {"linear", "prismatic"},
    {"translation", "prismatic"},
    {"translational", "prismatic"},
    {"prismaticjoint", "prismatic"},
    {"p", "prismatic"},
    {"fixed", "weld"},
    {"fixedjoint", "weld"},
    {"rigid", "weld"},
    {"lock", "weld"},
    {"cardan", "universal"},
    {"hooke", "universal"},
    {"universaljoint", "universal"},
    {"helical", "screw"},
    {"leadscrew", "screw"},
    {"ballscrew", "screw"},
    {"plane", "planar"},
    {"distance", "rod"},
    {"link", "rod"},
    {"bar", "rod"},
    {"rope", "rod", "which pulls and pushes; a rope that may go slack is a spring with a law \"table\""},
    {"cable", "rod", "which pulls and pushes; a rope that may go slack is a spring with a law \"table\""},
    {"homokinetic", "constant_velocity"},
    {"cv", "constant_velocity"},
    {"constantvelocityjoint", "constant_velocity"},
    {"rack", "rack_and_pinion"},
    {"rackpinion", "rack_and_pinion"},
    {"inline", "point_on_line"},
    {"inplane", "point_in_plane"},
    {"parallelaxis", "parallel_axes"},
    {"perpendicular", "perpendicular_axes"},
    {"belt", "gear"},
    {"coupler", "coupling"},
    {"coordinatecoupler", "coupling"},
    {"mimic", "coupling"},
    {"tendon", "coupling"},
    {"differential", "coupling"},
    {"planetary", "coupling"},
    {"pulley", "coupling"},
    {"equality", "coupling"},
    // loads
    {"moment", "torque"},
    {"pointforce", "force"},
    {"sforce", "actuator", "with 'joint'; at a point of a body, \"force\""},
    {"damper", "spring", "with 'damping' alone"},
    {"dashpot", "spring", "with 'damping' alone"},
    {"viscousdamper", "spring", "with 'damping' alone"},
    {"springdamper", "spring", "with 'damping'"},
    {"tsda", "spring", "with 'damping'"},
    {"linearspring", "spring"},
    {"torsionspring", "spring", "with 'joint', the revolute joint that it is wound about"},
    {"torsionalspring", "spring", "with 'joint', the revolute joint that it is wound about"},
    {"rotationalspring", "spring", "with 'joint', the revolute joint that it is wound about"},
    {"rotaryspring", "spring", "with 'joint', the revolute joint that it is wound about"},
    {"rotarydamper", "rotational_damper"},
    {"torsionaldamper", "rotational_damper"},
    {"angulardamper", "rotational_damper"},
    {"balldamper", "rotational_damper"},
    {"rsda", "spring", "with 'joint', the revolute joint that it is wound about"},
    {"motor", "actuator", "with 'joint', if its torque is known; if its motion is, a [[drive]]"},
    {"servo", "actuator", "with 'joint', 'inputs' and an 'expression' of the controller"},
    {"controller", "actuator", "with 'joint', 'inputs' and an 'expression' of the controller"},
    {"friction", "actuator", "with 'joint' and an expression such as \"-0.1*tanh(w/0.01)\""},
    {"wind", "drag"},
    {"aerodynamic", "drag"},
    {"airdrag", "drag"},
    {"gravitation", "attraction", "of a point; the weight is `gravity` at the top of the file"},
    {"gravity", "attraction", "of a point; the weight is `gravity` at the top of the file"},
    {"field", "bushing"},
    {"flexiblejoint", "bushing"},
    // drives
    {"motor", "joint", "with 'joint', the joint that it moves"},
    {"motion", "joint", "with 'joint', the joint that it moves"},
    {"revolute", "joint", "with 'joint', the joint that it moves"},
    {"prismatic", "joint", "with 'joint', the joint that it moves"},
    {"rotational", "joint", "with 'joint', the joint that it moves"},
    {"translational", "joint", "with 'joint', the joint that it moves"},
    {"angle", "joint", "with 'joint', the joint that it moves"},
    {"path", "point", "with 'body'"},
    // sensors
    {"marker", "point"},
    {"position", "point", "with 'body'"},
    {"velocity", "point", "with 'body': it reads vx, vy, vz as well"},
    {"angle", "joint", "with 'joint'"},
    {"encoder", "joint", "with 'joint'"},
    {"distance", "relative", "with 'between'"},
    {"force", "load", "with 'load'; a joint's reactions are in the results anyway"},
    {"reaction", "load", "with 'load'; a joint's reactions are in the results anyway"},
    // methods
    {"rk4", "lobatto", by_itself},
    {"rk45", "lobatto", by_itself},
    {"rungekutta", "lobatto", by_itself},
    {"rkf45", "lobatto", by_itself},
    {"dopri", "lobatto", by_itself},
    {"dopri5", "lobatto", by_itself},
    {"dop853", "lobatto", by_itself},
    {"ode45", "lobatto", by_itself},
    {"ode113", "lobatto", by_itself},
    {"adams", "lobatto", by_itself},
    {"lsoda", "auto", "which changes between the two by itself"},
    {"automatic", "auto"},
    {"ode15s", "radau", for_stiff},
    {"ode23t", "radau", for_stiff},
    {"bdf", "radau", for_stiff},
    {"ida", "radau", for_stiff},
    {"dassl", "radau", for_stiff},
    {"gstiff", "radau", for_stiff},
    {"wstiff", "radau", for_stiff},
    {"hht", "radau", for_stiff},
    {"newmark", "radau", for_stiff},
    {"generalizedalpha", "radau", for_stiff},
    {"generalisedalpha", "radau", for_stiff},
    {"stiff", "radau", for_stiff},
    {"implicit", "radau", for_stiff},
    {"radau5", "radau", "with degree = 3"},
    {"radauiia", "radau"},
    {"gauss", "lobatto"},
    {"collocation", "lobatto"},
    {"euler", "endpoint", reference},
    {"impliciteuler", "endpoint", reference},
    {"eulerimplicit", "endpoint", reference},
    {"semiimpliciteuler", "midpoint", reference},
    {"trapezoidal", "midpoint", reference},
    {"rattle", "midpoint", reference},
    {"verlet", "midpoint", reference},
};

}   // namespace

std::string_view in_other_words(std::string_view word, const Words& choices, std::string_view& with)
{
    const std::string plain = without_case(word);
    // A word that differs in case and underscores alone.
    for (const std::string_view choice : choices)
        if (without_case(choice) == plain) return choice;
    for (const OtherWord& other : other_words)
        // Only where the other word is a choice of this key: "fixed" means a weld among joints alone.
        if (other.word == plain && index_of(choices, other.choice) >= 0) {
            with = other.with;
            return other.choice;
        }
    return {};
}

std::string in_other_words(std::string_view word, const Words& choices)
{
    std::string_view with;
    const std::string_view choice = in_other_words(word, choices, with);
    if (choice.empty()) return {};
    const bool is_nearest = with.starts_with(';') || with.starts_with(',');
    return (is_nearest ? "nearest here is \"" : "livens calls it \"") + std::string(choice) + "\"" +
           (with.empty() || is_nearest ? "" : " ") + std::string(with);
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
