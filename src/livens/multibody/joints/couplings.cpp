// SPDX-License-Identifier: BSD-3-Clause
// Joints between coordinates of other joints.
// Gears, racks and pinions are rows of smooth functions of coordinates: theory.md, "Coordinates of joints".
// Turns are counted in differences from node to node, so that a gear holds for any number of turns.
#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/base/error.h"
#include "livens/multibody/joints.h"
#include "livens/multibody/wording.h"

namespace livens {

const NamedCoordinate* find_coordinate(const Joint& joint, std::string_view name)
{
    const auto found = std::ranges::find(joint.coordinates, name, &NamedCoordinate::name);
    return found == joint.coordinates.end() ? nullptr : &*found;
}

namespace {

const JointCoordinate& coordinate_of(const std::string& name, const Joint& joint, const char* wanted)
{
    if (const NamedCoordinate* found = find_coordinate(joint, wanted)) return found->coordinate;
    std::string has;
    for (const NamedCoordinate& one : joint.coordinates) has += (has.empty() ? "" : ", ") + one.name;
    throw InputError(
        {"joint-coordinate", "joint[" + name + "].joints",
         "joint '" + joint.name + "' (" + joint.type + ") has no " + wanted, "", "",
         has.empty() ? "it has no coordinate" : "it has: " + has,
         "revolute, cylindrical, screw, planar and parallel_axes joints have an angle; prismatic, "
         "cylindrical, screw and point_on_line joints a displacement"});
}

/// second - factor * first stays what it is in the configuration X.
Joint coupled(const std::string& name, const char* type, const Joint& first, const JointCoordinate& of_first,
              const Joint& second, const JointCoordinate& of_second, double factor, const Configurations& X,
              double scale)
{
    Joint joint;
    joint.name = name;
    joint.type = type;
    // The coupling is between the bodies that move; where both joints move one body, between it and the first
    // body of the first joint.
    const bool has_one_body = first.second == second.second;
    joint.first = has_one_body ? first.first : first.second;
    joint.point_first = has_one_body ? first.point_first : first.point_second;
    joint.second = second.second;
    joint.point_second = second.point_second;
    const auto joins = [](const Joint& of, int a, int b) { return of.first == a && of.second == b; };
    if (joins(first, second.first, second.second) || joins(first, second.second, second.first))
        throw InputError({"joint-self", "joint[" + name + "].joints",
                          "the joints '" + first.name + "' and '" + second.name + "' join the same bodies",
                          "", "", "", "a coupling needs two joints that move different bodies"});
    const std::vector<CoupledCoordinate> terms{{-factor, of_first}, {1, of_second}};
    // The constant is what the coordinates are where the bodies stand: teeth mesh there by definition.
    const double now = constraint_value(coupling_row(terms, 0, scale, type), X);
    joint.rows.push_back(coupling_row(terms, now, scale, type));
    return joint;
}

void require_factor(const std::string& name, const char* key, double factor)
{
    if (factor != 0 && std::isfinite(factor)) return;
    throw InputError({"joint-factor", "joint[" + name + "]." + key,
                      std::string("the ") + key + " must not be zero", to_text(factor), "", "", ""});
}

}   // namespace

Joint gear(const std::string& name, const Joint& first, const Joint& second, double ratio,
           const Configurations& X)
{
    require_factor(name, "ratio", ratio);
    return coupled(name, "gear", first, coordinate_of(name, first, "angle"), second,
                   coordinate_of(name, second, "angle"), ratio, X, 1);
}

Joint rack_and_pinion(const std::string& name, const Joint& pinion, const Joint& rack, double radius,
                      const Configurations& X, double scale)
{
    require_factor(name, "radius", radius);
    return coupled(name, "rack_and_pinion", pinion, coordinate_of(name, pinion, "angle"), rack,
                   coordinate_of(name, rack, "displacement"), radius, X, scale);
}

}   // namespace livens
