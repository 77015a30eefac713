// SPDX-License-Identifier: BSD-3-Clause
// Joints between coordinates of other joints: sum_k c_k q_k stays what it is where the bodies stand.
// Gears, racks and pinions are couplings of two. theory.md, "Coordinates of joints"; turns are counted in
// differences from node to node, so that a coupling holds for any number of turns.
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

[[noreturn]] void refuse_terms(const char* code, const std::string& path, const std::string& message,
                               const std::string& value, const std::string& note, const std::string& help)
{
    throw InputError({code, path, message, value, "", note, help});
}

const NamedCoordinate& coordinate_of(const std::string& path, const CoupledJoint& term)
{
    const Joint& joint = *term.joint;
    if (const NamedCoordinate* found = find_coordinate(joint, term.coordinate)) return *found;
    std::string has;
    for (const NamedCoordinate& one : joint.coordinates) has += (has.empty() ? "" : ", ") + one.name;
    refuse_terms("joint-coordinate", path,
                 "joint '" + joint.name + "' (" + joint.type + ") has no " + term.coordinate, "",
                 has.empty() ? "it has no coordinate" : "it has: " + has,
                 "revolute, cylindrical, screw, planar and parallel_axes joints have an angle; universal "
                 "joints angle_1 and angle_2, spherical ones with 'angles' angle_3 as well; prismatic, "
                 "cylindrical, screw and point_on_line joints a displacement");
}

/// The reaction is that on the second body of the last joint. The other one is the first of those that move
/// which is not the same body.
void place_between(Joint& joint, const std::vector<CoupledJoint>& terms)
{
    const Joint& last = *terms.back().joint;
    joint.second = last.second;
    joint.point_second = last.point_second;
    for (const CoupledJoint& term : terms) {
        const Joint& one = *term.joint;
        joint.first = one.second == joint.second ? one.first : one.second;
        joint.point_first = one.second == joint.second ? one.point_first : one.point_second;
        if (joint.first != joint.second) return;
    }
}

/// The sum of the terms stays what it is in the configuration X. `path`: of the key that names them.
Joint coupled(const std::string& name, const char* type, const std::vector<CoupledJoint>& terms,
              const std::string& path, const Configurations& X, double scale)
{
    Joint joint;
    joint.name = name;
    joint.type = type;
    place_between(joint, terms);
    std::vector<CoupledCoordinate> coordinates;
    for (const CoupledJoint& term : terms)
        coordinates.push_back({term.factor, coordinate_of(path, term).coordinate});
    // The constant is what the coordinates are where the bodies stand: teeth mesh there by definition.
    const double now = constraint_value(coupling_row(coordinates, 0, scale, type), X);
    joint.rows.push_back(coupling_row(coordinates, now, scale, type));
    return joint;
}

/// Of two joints, which cannot be those of the same bodies: a wheel does not mesh with itself.
Joint meshed(const std::string& name, const char* type, const CoupledJoint& first, const CoupledJoint& second,
             const Configurations& X, double scale)
{
    const std::string path = "joint[" + name + "].joints";
    const auto joins = [](const Joint& of, int a, int b) { return of.first == a && of.second == b; };
    const Joint &one = *first.joint, &other = *second.joint;
    if (joins(one, other.first, other.second) || joins(one, other.second, other.first))
        refuse_terms("joint-self", path,
                     "the joints '" + one.name + "' and '" + other.name + "' join the same bodies", "", "",
                     "a coupling needs two joints that move different bodies");
    return coupled(name, type, {first, second}, path, X, scale);
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
    return meshed(name, "gear", {-ratio, &first, "angle"}, {1, &second, "angle"}, X, 1);
}

Joint rack_and_pinion(const std::string& name, const Joint& pinion, const Joint& rack, double radius,
                      const Configurations& X, double scale)
{
    require_factor(name, "radius", radius);
    return meshed(name, "rack_and_pinion", {-radius, &pinion, "angle"}, {1, &rack, "displacement"}, X, scale);
}

Joint coupling(const std::string& name, const std::vector<CoupledJoint>& terms, const Configurations& X,
               double length)
{
    const std::string path = "joint[" + name + "].terms";
    double scale = 0;
    std::vector<int> bodies;
    for (auto term = terms.begin(); term != terms.end(); ++term) {
        const std::string label = term->joint->name + "." + term->coordinate;
        const bool is_angle = coordinate_of(path, *term).coordinate.is_angle();
        if (term->factor == 0 || !std::isfinite(term->factor))
            refuse_terms("joint-factor", path, "the factor of '" + label + "' must not be zero",
                         to_text(term->factor), "", "leave the coordinate out");
        const auto is_same = [&](const CoupledJoint& other) {
            return other.joint->name == term->joint->name && other.coordinate == term->coordinate;
        };
        if (std::any_of(terms.begin(), term, is_same))
            refuse_terms("coupling-terms", path, "'" + label + "' is named twice", "", "",
                         "give it once, with the sum of the factors");
        scale = std::max(scale, std::abs(term->factor) * (is_angle ? 1 : length));
        for (const int body : {term->joint->first, term->joint->second})
            if (body != world && std::ranges::find(bodies, body) == bodies.end()) bodies.push_back(body);
    }
    if (terms.size() < 2)
        refuse_terms(
            "coupling-terms", path,
            terms.empty() ? "a coupling needs coordinates" : "a coupling of one coordinate would lock it", "",
            "",
            terms.empty() ? "give two or more coordinates of joints"
                          : "a coordinate is held by a drive with a constant value, bodies by a weld");
    if (std::ssize(bodies) > RowBodies::most)
        refuse_terms("coupling-terms", path,
                     "a coupling touches at most " + std::to_string(RowBodies::most) + " bodies",
                     std::to_string(bodies.size()), "each joint touches two, or one beside the world",
                     "divide it into two couplings: a light body on a slide of its own carries the sum of "
                     "one to the other");
    return coupled(name, "coupling", terms, path, X, scale);
}

}   // namespace livens
