// SPDX-License-Identifier: BSD-3-Clause
// [[joint]]: one table of kinds, from which the schema, the reader and the documentation follow.
#include <cmath>

#include "livens/io/scenario/builder.h"

namespace livens {

namespace {

constexpr double perpendicular_slack = 1e-9;   // |a . b| of unit axes: what the check of the start allows
constexpr double coincidence_slack = 1e-9;     // of the model's length, likewise

/// All that a joint can be made of.
struct Parts {
    const Section& section;
    std::string name;
    int first, second;
    JointFrame frame;
    const Matrix34 &X_first, &X_second;   ///< at the start
    double scale;

    double distance() const
    {
        return norm(X_second * point(frame.point_second) - X_first * point(frame.point_first));
    }
};

struct JointKind : Kind {
    Joint (*make)(const Parts&);
};

const Key at{"at", types::vector3, "The joint's point at the start, in the world.", "m"};
const Key axis{"axis", types::vector3, "With `at`: the axis at the start, world axes, of any length."};
const Key points{"points", types::pair,
                 "The joint's point on each body, in its coordinates. A rod's default: the reference points, "
                 "for the world its origin.", "m"};
const Key axes{"axes", types::pair,
               "One direction for each body, of any length: the common axis (revolute, with `points`) or the "
               "two perpendicular axes (universal)."};

/// A kind that takes `axis` has one common axis, one that takes `axes` alone has two that are perpendicular;
/// one without `at` is placed by `points` or by nothing.
const std::vector<JointKind>& kinds()
{
    static const std::vector<JointKind> all{
        {{"weld", "nothing moves (6 rows)", {at, points}},
         [](const Parts& p) {
             return weld(p.name, p.first, p.second, p.frame, p.X_first, p.X_second, p.scale);
         }},
        {{"revolute", "turns about one axis (5)", {at, axis, points, axes}},
         [](const Parts& p) { return revolute(p.name, p.first, p.second, p.frame, p.scale); }},
        {{"universal", "turns about two perpendicular axes (4)", {at, points, axes}},
         [](const Parts& p) { return universal(p.name, p.first, p.second, p.frame, p.scale); }},
        {{"spherical", "one common point (3)", {at, points}},
         [](const Parts& p) { return spherical(p.name, p.first, p.second, p.frame, p.scale); }},
        {{"rod", "fixed distance (1)",
          {points, Key{"length", types::number, "Default: the distance of its points at the start.", "m"}
                       .within(positive)}},
         [](const Parts& p) {
             const double length = p.section.has("length") ? p.section.number("length") : p.distance();
             return rod(p.name, p.first, p.second, p.frame, length);
         }}};
    return all;
}

bool has_two_axes(const Section& joint) { return joint.takes("axes") && !joint.takes("axis"); }

/// The whole of what a joint of this kind needs to be placed, and nothing that contradicts it.
bool check_placement(const Section& joint)
{
    const auto complain = [&](std::string_view key, const std::string& message, const std::string& help) {
        return joint.error(key, "joint-placement", message, {"", help});
    };
    if (!joint.takes("at")) return true;
    if (!joint.at_most_one({"at", "points"}, "joint-placement")) return false;
    if (!joint.has("at") && !joint.has("points"))
        return complain(
            "", joint.label() + " lacks its place",
            "give 'at', the joint's point in the world at the start, or 'points', its point on each body");
    if (has_two_axes(joint) && !joint.has("axes"))
        return complain("", joint.label() + " lacks 'axes'",
                        "give two perpendicular axes, the first body's and the second's");
    if (!joint.takes("axis")) return true;
    const std::string wanted = joint.has("at") ? "axis" : "axes";
    const std::string other = joint.has("at") ? "axes" : "axis";
    const std::string help =
        joint.has("at") ? "with 'at' goes 'axis', one direction in the world"
                        : "with 'points' goes 'axes', one direction for each body in its coordinates";
    if (joint.has(other))
        return complain(other, "'" + other + "' of " + joint.label() + " does not fit to how it is placed",
                        help);
    return joint.has(wanted) || complain("", joint.label() + " lacks '" + wanted + "'", help);
}

bool check_axes(const Section& joint, Findings& findings)
{
    if (joint.find("axis") != nullptr && norm(joint.vector("axis")) == 0)
        return joint.error("axis", "axis-zero", "the axis of " + joint.label() + " is zero");
    const Value* given = joint.find("axes");
    if (given == nullptr) return true;
    const Vector3 a = joint.row("axes", 0), b = joint.row("axes", 1);
    for (std::size_t i = 0; i < 2; ++i)
        if (norm(i == 0 ? a : b) == 0)
            return findings.error(given->node->items()[i].place, "axis-zero",
                                  "an axis of " + joint.label() + " is zero");
    if (has_two_axes(joint) && joint.has("at") &&
        std::abs(dot(a, b)) > perpendicular_slack * norm(a) * norm(b))
        return joint.error("axes", "axes-not-perpendicular",
                           "the axes of " + joint.label() + " are not perpendicular",
                           {"a universal joint holds its two axes perpendicular", ""});
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
        return joint.error("at", "point-mass",
                           joint.label() + " is not at the point mass '" + builder.body_name(body) + "'",
                           {"a point mass has no other point than its own", ""});
    }
    return true;
}

JointFrame read_frame(const Section& joint, const Matrix34& X_first, const Matrix34& X_second)
{
    JointFrame frame;
    const Vector3 place = joint.vector("at");
    if (joint.has("axis")) return joint_frame(X_first, X_second, place, joint.vector("axis"));
    if (joint.has("at")) frame = joint_frame(X_first, X_second, place);
    else {
        frame.point_first = joint.row("points", 0);   // zero without points: a rod between reference points
        frame.point_second = joint.row("points", 1);
    }
    if (!joint.has("axes")) return frame;
    frame.axis_first = joint.row("axes", 0);
    frame.axis_second = joint.row("axes", 1);
    if (joint.has("at")) {   // directions of the world
        frame.axis_first = joint_frame(X_first, X_second, place, frame.axis_first).axis_first;
        frame.axis_second = joint_frame(X_first, X_second, place, frame.axis_second).axis_second;
    }
    return frame;
}

Joint make_joint(const Builder& builder, const Section& joint, const std::string& name, int first, int second)
{
    const Matrix34 &X_first = builder.start_configuration(first),
                   &X_second = builder.start_configuration(second);
    const JointFrame frame = read_frame(joint, X_first, X_second);
    return kinds()[static_cast<std::size_t>(joint.kind())].make(
        {joint, name, first, second, frame, X_first, X_second, builder.length()});
}

std::string claim_joint_name(const Section& joint, std::unordered_set<std::string>& taken)
{
    if (!joint.has("name") && (joint.find("between") == nullptr || joint.kind() == any_kind)) return {};
    const std::string name = joint.has("name") ? joint.text("name") : default_name(joint);
    const Advice advice = joint.has("name")
                              ? Advice{"results refer to joints by name", "rename one of them"}
                              : Advice{"a joint without name is called by its type and bodies",
                                       "give it a 'name'"};
    if (!name.empty()) claim_name(joint, "joint", name, taken, advice);
    return name;
}

}   // namespace

Table joint_table()
{
    return Table{
        "[[joint]]",
        "A joint is placed in one of two ways. With `at`, by one point in the world, where the bodies are at "
        "the start; `axis` or `axes` are then directions in the world, too. Or with `points`, one point for "
        "each body in that body's coordinates (world coordinates for the world); `axes` are then one "
        "direction for each body in the same coordinates. Only the second way can describe a start that does "
        "not fit. Reactions are what the joint exerts on the second body of `between`, or on the only one of "
        "a joint to the world.",
        {Key{"name", types::text,
             "Default: type and bodies, as in `rod world-upper`, where no other joint is called that."},
         Key{"type", types::choice, ""}.needed(),
         Key{"between", types::names, "Two different bodies, or one and `\"world\"`."}.needed()}}
        .with_kinds("type", {kinds().begin(), kinds().end()});
}

void read_joints(Builder& builder)
{
    Findings& findings = builder.findings();
    std::unordered_set<std::string> taken;
    for (const Section& section : builder.top().sections("joint")) {
        const int before = findings.n_errors();
        const std::string name = claim_joint_name(section, taken);
        check_name(section);
        if (section.kind() != any_kind) {
            check_placement(section);
            check_axes(section, findings);
        }
        BodyReference first, second;
        const bool has_bodies = builder.find_pair(section, "joint-self", first, second);
        const std::string path = "joint[" + name + "]";
        builder.remember(path, section);
        if (!has_bodies || !section.is_valid() || findings.n_errors() > before) continue;
        if (!check_point_masses(builder, section, first.index, second.index)) continue;
        builder.guard(path, [&] {
            builder.model().add_joint(make_joint(builder, section, name, first.index, second.index));
        });
    }
}

}   // namespace livens
