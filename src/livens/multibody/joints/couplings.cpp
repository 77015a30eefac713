// SPDX-License-Identifier: BSD-3-Clause
// Joints between coordinates of other joints: sum_k c_k q_k stays what it is where the bodies stand, or
// follows a law of one more. Gears, racks and pinions are couplings of two. theory.md, "Coordinates of
// joints"; turns are counted in differences from node to node, so that a coupling holds for any number of
// turns.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/base/error.h"
#include "livens/multibody/joints.h"
#include "livens/multibody/wording.h"

namespace livens {

const NamedCoordinate* find_coordinate(const Joint& joint, std::string_view name)
{
    for (const auto* all : {&joint.coordinates, &joint.readings})
        for (const NamedCoordinate& one : *all)
            if (one.name == name && one.coordinate.kind != CoordinateKind::rotation_angle) return &one;
    return nullptr;
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
    refuse_terms(
        "joint-coordinate", path, "joint '" + joint.name + "' (" + joint.type + ") has no " + term.coordinate,
        "", has.empty() ? "it has no coordinate" : "it has: " + has,
        "revolute, cylindrical, screw, planar and parallel_axes joints have an angle; universal "
        "joints angle_1 and angle_2, spherical ones with 'angles' angle_3 as well; spherical ones of "
        "bodies rotation_vector_x, _y and _z; prismatic, cylindrical, screw and point_on_line "
        "joints a displacement");
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

std::string spoken(const CoupledJoint& term) { return "'" + term.joint->name + "." + term.coordinate + "'"; }

bool is_same(const CoupledJoint& one, const CoupledJoint& other)
{
    return one.joint->name == other.joint->name && one.coordinate == other.coordinate;
}

/// Throws for what is no factor, twice there, or on too many bodies; what violations are measured by.
double check_terms(const std::string& path, const std::vector<CoupledJoint>& terms, const CoupledJoint* of,
                   double length)
{
    double scale = 0;
    std::vector<int> bodies;
    const auto touch = [&](const Joint& joint) {
        for (const int body : {joint.first, joint.second})
            if (body != world && std::ranges::find(bodies, body) == bodies.end()) bodies.push_back(body);
    };
    for (auto term = terms.begin(); term != terms.end(); ++term) {
        const bool is_angle = coordinate_of(path, *term).coordinate.is_angle();
        if (term->factor == 0 || !std::isfinite(term->factor))
            refuse_terms("joint-factor", path, "the factor of " + spoken(*term) + " must not be zero",
                         to_text(term->factor), "", "leave the coordinate out");
        if (std::any_of(terms.begin(), term,
                        [&](const CoupledJoint& other) { return is_same(other, *term); }))
            refuse_terms("coupling-terms", path, spoken(*term) + " is named twice", "", "",
                         "give it once, with the sum of the factors");
        if (of != nullptr && is_same(*of, *term))
            refuse_terms("coupling-terms", path, spoken(*term) + " is on both sides: in 'terms' and 'law'",
                         "", "",
                         "a coordinate that follows itself would be locked; leave it out of one of them");
        scale = std::max(scale, std::abs(term->factor) * (is_angle ? 1 : length));
        touch(*term->joint);
    }
    if (of != nullptr) touch(*of->joint);
    if (std::ssize(bodies) > RowBodies::most)
        refuse_terms("coupling-terms", path,
                     "a coupling touches at most " + std::to_string(RowBodies::most) + " bodies",
                     std::to_string(bodies.size()), "each joint touches two, or one beside the world",
                     "divide it into two couplings: a light body on a slide of its own carries the sum of "
                     "one to the other");
    return scale;
}

/// What a coordinate is called less what its forms say, without turns.
double shift_of(const NamedCoordinate& q, const Configurations& X)
{
    return q.at_stated - coordinate_value(q.coordinate, X);
}

/// Positions tell an angle up to turns: a law has to be the same after each, or known for less than one.
void fit_to_turns(const std::string& path, const std::string& of, double now, bool has_angles,
                  CoordinateLaw& law)
{
    constexpr double turn = 2 * std::numbers::pi, widest = 3.05;   // short of half a turn
    if (law.period > 0) {
        const double rounds = turn / law.period;
        if (std::abs(rounds - std::round(rounds)) > 1e-9 * rounds || rounds < 0.5)
            refuse_terms("coupling-law", path,
                         "the period of the law must be a turn of " + of + ", or a whole part of it",
                         to_text(law.period) + " rad", "positions do not tell turns",
                         "couple a wheel that turns once in a period by a gear, and take its angle");
        if (law.rise != 0 && !has_angles)
            refuse_terms("coupling-law", path, "the law rises by " + to_text(law.rise) + " with each period",
                         "", "the first value of a periodic table is its last again",
                         "let it end with the value that it begins with");
        return;
    }
    if (!std::isfinite(law.high - law.low)) law.low = now - widest, law.high = now + widest;
    if (law.high - law.low > turn - 1e-6)
        refuse_terms("coupling-law", path,
                     "the law of an angle goes over a turn or more, and does not repeat",
                     to_text(law.high - law.low) + " rad", "positions do not tell turns",
                     "give less than a turn, or a periodic table");
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
    const double scale = check_terms(path, terms, nullptr, length);
    if (terms.size() < 2)
        refuse_terms(
            "coupling-terms", path,
            terms.empty() ? "a coupling needs coordinates" : "a coupling of one coordinate would lock it", "",
            "",
            terms.empty()
                ? "give two or more coordinates of joints"
                : "a coordinate is held by a drive with a constant value, bodies by a weld; one that "
                  "follows another by a law needs 'law'");
    return coupled(name, "coupling", terms, path, X, scale);
}

Joint coupling(const std::string& name, const std::vector<CoupledJoint>& terms, const CoupledJoint& of,
               const CoordinateLaw& given, const Configurations& X, double length)
{
    const std::string path = "joint[" + name + "].terms", at_law = "joint[" + name + "].law";
    if (terms.empty())
        refuse_terms("coupling-terms", path, "a coupling needs coordinates", "", "",
                     "give one or more of joints");
    const double scale = check_terms(path, terms, &of, length);
    const NamedCoordinate& leader = coordinate_of(at_law, of);
    CoupledLaw law{given, leader.coordinate, shift_of(leader, X), ""};
    Joint joint;
    joint.name = name;
    joint.type = "coupling";
    std::vector<CoupledJoint> all{of};
    all.insert(all.end(), terms.begin(), terms.end());
    place_between(joint, all);
    std::vector<CoupledCoordinate> coordinates;
    double shift = 0;
    bool has_angles = false;
    for (const CoupledJoint& term : terms) {
        const NamedCoordinate& q = coordinate_of(path, term);
        coordinates.push_back({term.factor, q.coordinate});
        shift += term.factor * shift_of(q, X);
        has_angles = has_angles || q.coordinate.counts_turns();
    }
    const bool is_angle = leader.coordinate.is_angle();
    if (is_angle && !leader.coordinate.counts_turns())
        refuse_terms("coupling-law", at_law, "a law cannot follow " + spoken(of), "",
                     "an angle of a ball joint that ends at a quarter turn, or its rotation vector",
                     "let it follow an angle of a revolute or universal joint, or a displacement");
    if (is_angle) fit_to_turns(at_law, spoken(of), leader.at_stated, has_angles, law.law);
    const std::string unit = is_angle ? " rad" : " m";
    law.what = spoken(of) + " leaves the law of '" + name + "', which is known from " +
               to_text(law.law.low, 6) + " to " + to_text(law.law.high, 6) + unit;
    joint.rows.push_back(coupling_row(coordinates, -shift, scale, "coupling", &law));
    return joint;
}

}   // namespace livens
