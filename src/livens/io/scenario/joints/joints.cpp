// SPDX-License-Identifier: BSD-3-Clause
// [[joint]]: where it sits, and what may be wrong with that.
// Placed in the world (`at`), on the bodies (`points`) or by `frames`; see docs/joints.md.
#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "livens/base/text.h"
#include "livens/io/scenario/bodies/bodies.h"
#include "livens/io/scenario/joints/joint_kinds.h"
#include "livens/io/scenario/joints/joints.h"
#include "livens/multibody/joints/fit.h"

namespace livens::inline io_internal {

namespace {

constexpr double perpendicular_slack = 1e-9;   // |a . b| of unit axes: what the check of the start allows
constexpr double widest_fit = 1e-6;            // of the model's length, or rad
constexpr double closed_slack = 1e-14;         // likewise: rounding
constexpr double coincidence_slack = 1e-9;     // of the model's length, likewise

Location location_of(const Section& joint)
{
    return joint_kinds()[static_cast<std::size_t>(joint.kind())].location;
}

/// What a joint needs to be placed: one of these sets of keys, the first of which says which set.
struct Way {
    Location location;
    std::vector<std::string_view> keys;
    std::string_view help;
};

const std::vector<Way>& ways()
{
    using enum Location;
    static constexpr std::string_view one_axis = "with 'at' goes 'axis', one direction in the world",
                                      on_bodies =
                                          "with 'points' goes 'axes', one direction for each body in its "
                                          "coordinates",
                                      two = "give two axes, the first body's and the second's",
                                      a_line =
                                          "give 'axis', the direction of the line or the normal of the plane";
    static const std::vector<Way> all{{at_point, {"at"}, {}},
                                      {at_point, {"points"}, {}},
                                      {on_axis, {"at", "axis"}, one_axis},
                                      {on_axis, {"points", "axes"}, on_bodies},
                                      {on_two_axes, {"at", "axes"}, two},
                                      {on_two_axes, {"points", "axes"}, two},
                                      {on_line, {"at", "axis"}, a_line},
                                      {on_line, {"points", "axis"}, a_line},
                                      {along_axis, {"axis"}, {}},
                                      {along_axis, {"axes"}, {}},
                                      {along_two_axes, {"at", "axes"}, two},
                                      {along_two_axes, {"axes"}, {}}};
    return all;
}

/// The whole of what a joint of this kind needs to be placed, and nothing that contradicts it.
bool check_placement(const Section& joint)
{
    const Location location = location_of(joint);
    if (location == Location::at_points || location == Location::on_curve || location == Location::of_joints)
        return true;
    const auto complain = [&](std::string_view key, const std::string& message, std::string_view help) {
        return joint.error(key, "joint-placement", message, {"", std::string(help)});
    };
    if (joint.has("frames"))
        return joint.refuse({"at", "axis", "points", "axes"}, "joint-placement", "'frames' says it all");
    if (!joint.at_most_one({"at", "points"}, "joint-placement")) return false;
    if (location == Location::along_axis && !joint.at_most_one({"axis", "axes"}, "joint-placement"))
        return false;
    for (const Way& way : ways()) {
        if (way.location != location || !joint.has(way.keys[0])) continue;
        if (way.keys.size() == 1) return true;
        const std::string_view other = way.keys[1] == "axis" ? "axes" : "axis";
        if (joint.has(other))
            return complain(other,
                            "'" + std::string(other) + "' of " + joint.label() +
                                " does not fit to how it is placed",
                            way.help);
        return joint.has(way.keys[1]) ||
               complain("", joint.label() + " lacks '" + std::string(way.keys[1]) + "'", way.help);
    }
    if (location == Location::along_axis || location == Location::along_two_axes)
        return complain("", joint.label() + " lacks its axes",
                        "give 'axes', one direction for each body in its coordinates");
    return complain(
        "", joint.label() + " lacks its place",
        "give 'at', the joint's point in the world at the start, or 'points', its point on each body");
}

bool check_axes(const Section& joint, Findings& findings)
{
    if (joint.find("axis") != nullptr && joint.vector("axis") == Vector3{})
        return joint.error("axis", "axis-zero", "the axis of " + joint.label() + " is zero");
    const Value* given = joint.find("axes");
    if (given == nullptr) return true;
    const Vector3 a = joint.row("axes", 0), b = joint.row("axes", 1);
    for (std::size_t i = 0; i < 2; ++i)
        if ((i == 0 ? a : b) == Vector3{})
            return findings.error(given->node->items()[i].place, "axis-zero",
                                  "an axis of " + joint.label() + " is zero");
    const std::string_view word = joint_kinds()[static_cast<std::size_t>(joint.kind())].word;
    // Both are in the world with 'at' alone. In coordinates of two bodies a . b says nothing.
    if ((word == "universal" || word == "perpendicular_axes") && joint.has("at") &&
        std::abs(dot(a, b)) > perpendicular_slack * norm(a) * norm(b))
        return joint.error("axes", "axes-not-perpendicular",
                           "the axes of " + joint.label() + " are not perpendicular",
                           {"such a joint holds its two axes perpendicular", ""});
    return true;
}

/// A point mass can be held at its own point only, which `at` must be.
bool check_point_masses(const Builder& builder, const Section& joint, int first, int second)
{
    if (!joint.has("at")) return true;   // the model looks at 'points'
    const double slack = coincidence_slack * builder.length();
    for (const int body : {first, second}) {
        if (!builder.is_point(body)) continue;
        if (norm(joint.vector("at") - builder.start_configuration(body).column(0)) <= slack) continue;
        return joint.error(
            "at", "point-mass", joint.label() + " is not at the point mass '" + builder.body_name(body) + "'",
            {"a point mass has no other point than its own",
             "let 'at' be its place, or give 'points' instead: the place of a guide on the other "
             "body, and [0, 0, 0] on the point mass"});
    }
    return true;
}

/// What is stated in coordinates of a body is in its axes then.
/// Of `frames` the third axis is the joint's, and the first counts where turns about that are held.
JointFrame read_frame(const Builder& builder, const Section& joint, int first, int second)
{
    const Matrix34 &X_first = builder.start_configuration(first),
                   &X_second = builder.start_configuration(second);
    JointFrame frame;
    const std::span<const Section> frames = joint.sections("frames");
    if (frames.size() == 2) {
        const Matrix3 a = read_orientation(frames[0]), b = read_orientation(frames[1]);
        return {builder.in_axes(first, frames[0].vector("point")),
                builder.in_axes(second, frames[1].vector("point")),
                a.column(2),
                b.column(2),
                a.column(0),
                b.column(0)};
    }
    const Vector3 place = joint.vector("at");
    const bool is_in_world = joint.has("at") || location_of(joint) == Location::along_axis;
    if (joint.has("axis") && is_in_world)
        frame = joint_frame(X_first, X_second, place, joint.vector("axis"));
    else if (joint.has("at"))
        frame = joint_frame(X_first, X_second, place);
    if (joint.has("axis") && !is_in_world) frame.axis_first = builder.in_axes(first, joint.vector("axis"));
    if (!joint.has("at")) {   // zero without points: the reference points
        frame.point_first = builder.in_axes(first, joint.row("points", 0));
        frame.point_second = builder.in_axes(second, joint.row("points", 1));
    }
    if (!joint.has("axes")) return frame;
    const Vector3 a = joint.row("axes", 0), b = joint.row("axes", 1);
    const bool are_in_world = joint.has("at");
    frame.axis_first =
        are_in_world ? joint_frame(X_first, X_second, place, a).axis_first : builder.in_axes(first, a);
    frame.axis_second =
        are_in_world ? joint_frame(X_first, X_second, place, b).axis_second : builder.in_axes(second, b);
    return frame;
}

bool is_fitted(const Section& top)
{
    const Section* start = only_section(top, "start");
    return start != nullptr && start->text("joints") == "fit";
}

/// The joint as it closes best, if it closes by a move so small that nobody meant it.
Joint fitted(Builder& builder, const Section& joint, const std::function<Joint(const JointFrame&)>& make,
             const JointFrame& frame)
{
    const Section* time = only_section(builder.run(), "time");
    const std::vector<Matrix34> X = builder.start_configurations();
    const Instant at{time == nullptr ? 0 : time->number("start")};
    FittedJoint fit = fit_joint(make, frame, at, X, builder.length());
    if (fit.shift > widest_fit * builder.length() || fit.turn > widest_fit) return make(frame);
    if (fit.shift > closed_slack * builder.length() || fit.turn > closed_slack)
        builder.findings().warning(joint.place(), "joint-fitted",
                                   joint.label() + " was fitted: its point on the second body moved by " +
                                       to_text(fit.shift, 2) + " m, its axes by " + to_text(fit.turn, 2) +
                                       " rad",
                                   {"", ""});
    return std::move(fit.joint);
}

/// `rotor_inertia` of a joint with one coordinate, or of its table for each of two.
void read_rotors(const Section& joint, Joint& made)
{
    const bool is_one = joint.takes("rotor_inertia");
    for (NamedCoordinate& one : made.coordinates) {
        const std::span<const Section> tables =
            joint.takes(one.name) ? joint.sections(one.name) : std::span<const Section>{};
        const Section* keys = is_one ? &joint : tables.empty() ? nullptr : &tables.front();
        if (keys != nullptr && keys->has("rotor_inertia")) one.rotor_inertia = keys->number("rotor_inertia");
    }
}

Joint make_joint(Builder& builder, const Section& joint, const std::string& name, int first, int second)
{
    const Matrix34 &X_first = builder.start_configuration(first),
                   &X_second = builder.start_configuration(second);
    const JointFrame frame = read_frame(builder, joint, first, second);
    const auto make = [&](const JointFrame& at) {
        JointParts parts{joint, name, first, second, at, X_first, X_second, builder.length()};
        parts.has_point_mass = builder.is_point(first) || builder.is_point(second);
        parts.stretch_first = builder.stretch(first);
        parts.stretch_second = builder.stretch(second);
        return joint_kinds()[static_cast<std::size_t>(joint.kind())].make(parts);
    };
    Joint made = is_fitted(builder.run()) ? fitted(builder, joint, make, frame) : make(frame);
    read_times(builder, joint, made);
    read_rotors(joint, made);
    if (joint.has("coordinate")) made.coordinates.front().at_stated = joint.number("coordinate");
    return made;
}

std::string claim_joint_name(const Section& joint, std::unordered_set<std::string>& taken)
{
    const bool has_ends =
        std::ranges::any_of(std::initializer_list<std::string_view>{"between", "joints", "terms", "over"},
                            [&](std::string_view key) { return joint.find(key) != nullptr; });
    if (!joint.has("name") && (!has_ends || joint.kind() == any_kind)) return {};
    const std::string name = joint.has("name") ? joint.text("name") : default_name(joint);
    const Advice advice = joint.has("name") ? Advice{"results refer to joints by name", "rename one of them"}
                                            : Advice{"a joint without name is called by its type and bodies",
                                                     "give it a 'name'"};
    if (!name.empty()) claim_name(joint, "joint", name, taken, advice);
    return name;
}

}   // namespace

bool check_frames(const Section& joint)
{
    const Value* given = joint.find("frames");
    if (given == nullptr) return true;
    if (given->sections.size() != 2)
        return joint.error("frames", "joint-frames",
                           joint.label() + " has not two frames but " +
                               std::to_string(given->sections.size()),
                           {"", "give two, the first body's and the second's"});
    bool is_good = true;
    for (const Section& frame : given->sections) {
        is_good = check_orientation(frame) && is_good;
        if (frame.find("directors") == nullptr) continue;
        const Matrix3 D = frame.columns("directors");
        if (norm(transpose(D) * D - identity<3>()) > perpendicular_slack || determinant(D) < 0)
            is_good = frame.error("directors", "joint-frames",
                                  "the axes of " + frame.label() +
                                      " are not a right-handed set of perpendicular unit vectors");
    }
    return is_good;
}

Key coordinate_key()
{
    return {
        "coordinate",
        types::choice,
        "Which coordinate of the joint. Needed only if the joint has several, or if it is a component of "
        "the rotation vector of a spherical joint, from its first frame to its second, up to 175 degrees.",
        "",
        "",
        false,
        {"angle", "displacement", "angle_1", "angle_2", "angle_3", "rotation_vector_x", "rotation_vector_y",
         "rotation_vector_z"}};
}

JointReference find_coordinate(const Builder& builder, const Section& section, const std::string& path)
{
    const std::string wanted = section.text("joint");
    std::vector<std::string_view> known;
    const Joint* joint = nullptr;
    for (const Joint& one : builder.model().joints()) {
        if (one.name == wanted) joint = &one;
        known.push_back(one.name);
    }
    if (joint == nullptr) throw builder.unknown_name("joint", wanted, path, known);
    const bool is_said = section.has("coordinate");
    if (!is_said && joint->coordinates.size() > 1)
        throw InputError({"joint-coordinate", path + ".joint",
                          "joint '" + wanted + "' has more than one coordinate", "", "", "",
                          "say which by 'coordinate'"});
    const NamedCoordinate* of = is_said ? find_coordinate(*joint, section.text("coordinate"))
                                : joint->coordinates.empty() ? nullptr
                                                             : &joint->coordinates.front();
    if (of == nullptr)
        throw InputError(
            {"joint-coordinate", path + ".joint",
             "joint '" + wanted + "' (" + joint->type + ") has no " +
                 (is_said ? section.text("coordinate") : "coordinate"),
             "", "", "",
             "revolute, cylindrical, planar, screw and parallel_axes joints have an angle; universal joints "
             "angle_1 and angle_2, spherical ones with 'angles' angle_3 as well; spherical ones of bodies "
             "rotation_vector_x, _y and _z; prismatic, cylindrical, screw and point_on_line joints a "
             "displacement"});
    return {joint, of};
}

Table joint_table()
{
    std::vector<Kind> all{joint_kinds().begin(), joint_kinds().end()};
    for (std::size_t i = 0; i < all.size(); ++i) {
        std::vector<Key>& keys = all[i].keys;
        if (joint_kinds()[i].location == Location::of_joints)
            keys[0].required = true;   // `joints`, or `terms`
        else
            keys.insert(keys.begin(), Key{"between", types::names, two_bodies_or_points}.needed_without(
                                          std::string_view(all[i].word) == "rod" ? "points over" : "points"));
    }
    return Table{
        "[[joint]]",
        "A joint is placed in one of three ways. First, by `at`: one point in the world, where `[[body]]` "
        "places the bodies; `axis` and `axes` are then world directions. Second, by `points`: one point per "
        "body, in its coordinates; `axes` are then one direction per body, in the same coordinates. Third, "
        "by `frames`: one frame per body. Only the second and third way can describe bodies whose placement "
        "violates the joint. The reaction of a joint is the force and torque that it exerts on the second "
        "body of `between`, or on the only body of a joint to the world. Joint coordinates are those of the "
        "second body relative to the first, right-handed about the axis. They are zero where `[[body]]` "
        "places the bodies, unless `coordinate` gives another value; angles count full turns.",
        {Key{"name", types::text,
             "Name of the joint. Default: type and bodies, as in `rod world-upper`, if not taken."},
         Key{"type", types::choice, ""}.needed(),
         Key{"from", types::number_or_condition,
             "Time, or condition, from which the joint acts: bodies must be, and move, as it holds them "
             "then. "
             "Default: the initial time. lobatto and radau only.",
             "s"},
         Key{"until", types::number_or_condition,
             "Time of release, or a condition such as `\"latch.force > 80 N\"`: velocities continue, the "
             "reaction ends. Default: never. lobatto and radau only.",
             "s"},
         Key{"restitution", types::number,
             "0, nothing else: the joint may begin to act where bodies move otherwise than it lets them; "
             "velocities change "
             "at once, by an impact. Default: they have to meet.",
             ""}
             .within({0, 1})}}
        .with_kinds("type", std::move(all));
}

void read_joints(Builder& builder)
{
    Findings& findings = builder.findings();
    std::unordered_set<std::string> taken;   // by what is included
    for (const Joint& joint : builder.model().joints()) taken.insert(joint.name);
    // Couplings follow the joints that they couple, wherever they stand in the file.
    for (const bool is_coupling : {false, true})
        for (const Section& section : builder.top().sections("joint")) {
            if (is_coupling != (section.kind() != any_kind && location_of(section) == Location::of_joints))
                continue;
            const int before = findings.n_errors();
            const std::string name = claim_joint_name(section, taken);
            check_name(section);
            if (section.kind() != any_kind) {
                check_placement(section);
                check_axes(section, findings);
                check_frames(section);
            }
            const std::string path = "joint[" + name + "]";
            builder.remember(path, section);
            if (is_coupling) {
                if (findings.n_errors() == before) read_coupling(builder, section, name, path);
                continue;
            }
            if (section.has("over")) {
                if (findings.n_errors() == before) read_rope(builder, section, name, path);
                continue;
            }
            BodyReference first, second;
            const bool has_bodies = builder.find_pair(section, "joint-self", first, second);
            if (!has_bodies || !section.is_valid() || findings.n_errors() > before) continue;
            if (!check_point_masses(builder, section, first.index, second.index)) continue;
            builder.guard(path, [&] {
                builder.model().add_joint(make_joint(builder, section, name, first.index, second.index));
                warn_of_world_points(builder, section, {first.index, second.index});
            });
        }
}

}   // namespace livens::inline io_internal
