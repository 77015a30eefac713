#include <cmath>

#include "livens/io/detail/builder.h"

namespace livens {

namespace {

constexpr double perpendicular_slack = 1e-9;   // |a . b| of unit axes: what the check of the start allows
constexpr double coincidence_slack = 1e-9;     // of the model's length, likewise

/// The whole of what a joint of this type needs to be placed, and nothing that contradicts it.
bool check_placement(const Section& joint, const std::string& type, Findings& findings)
{
    if (type == "rod") return true;
    const auto complain = [&](std::string_view key, const std::string& message, const std::string& help) {
        findings.error(joint.place(key), "joint-placement", message, {"", help});
        return false;
    };
    if (!at_most_one(joint, {"at", "points"}, "joint-placement", findings)) return false;
    if (!joint.has("at") && !joint.has("points"))
        return complain(
            "", joint.label() + " lacks its place",
            "give 'at', the joint's point in the world at the start, or 'points', its point on each body");
    if (type == "universal" && !joint.has("axes"))
        return complain("", joint.label() + " lacks 'axes'",
                        "give two perpendicular axes, the first body's and the second's");
    if (type != "revolute") return true;
    const std::string wanted = joint.has("at") ? "axis" : "axes";
    const std::string other = joint.has("at") ? "axes" : "axis";
    const std::string help =
        joint.has("at") ? "with 'at' goes 'axis', one direction in the world"
                        : "with 'points' goes 'axes', one direction for each body in its coordinates";
    if (joint.has(other))
        return complain(other, "'" + other + "' of " + joint.label() + " does not fit to how it is placed",
                        help);
    if (!joint.has(wanted)) return complain("", joint.label() + " lacks '" + wanted + "'", help);
    return true;
}

bool check_axes(const Section& joint, const std::string& type, Findings& findings)
{
    const auto complain = [&](const Node& node, std::string code, const std::string& message,
                              const std::string& note) {
        findings.error(node.place, code, message, {note, ""});
        return false;
    };
    if (const Value* axis = joint.find("axis"))
        if (norm(joint.vector("axis")) == 0)
            return complain(*axis->node, "axis-zero", "the axis of " + joint.label() + " is zero", "");
    const Value* axes = joint.find("axes");
    if (axes == nullptr) return true;
    const Vector3 a = joint.row("axes", 0), b = joint.row("axes", 1);
    for (int i = 0; i < 2; ++i)
        if (norm(i == 0 ? a : b) == 0)
            return complain(axes->node->items()[static_cast<std::size_t>(i)], "axis-zero",
                            "an axis of " + joint.label() + " is zero", "");
    if (type == "universal" && joint.has("at") &&
        std::abs(dot(a, b)) > perpendicular_slack * norm(a) * norm(b))
        return complain(*axes->node, "axes-not-perpendicular",
                        "the axes of " + joint.label() + " are not perpendicular",
                        "a universal joint holds its two axes perpendicular");
    return true;
}

/// A point mass can be held at its own point only, which `at` must be.
bool check_point_masses(const Builder& builder, const Section& joint, int first, int second,
                        Findings& findings)
{
    if (!joint.has("at")) return true;   // the model looks at 'points'
    const double slack = coincidence_slack * builder.length();
    for (const int body : {first, second}) {
        if (!builder.is_point(body)) continue;
        if (norm(joint.vector("at") - builder.start_configuration(body).column(0)) <= slack) continue;
        findings.error(joint.place("at"), "point-mass",
                       joint.label() + " is not at the point mass '" + builder.body_name(body) + "'",
                       {"a point mass has no other point than its own", ""});
        return false;
    }
    return true;
}

JointFrame read_frame(const Builder& builder, const Section& joint, int first, int second)
{
    const Matrix34 &X_first = builder.start_configuration(first),
                   &X_second = builder.start_configuration(second);
    if (joint.has("at")) {
        const Vector3 at = joint.vector("at");
        if (joint.has("axis")) return joint_frame(X_first, X_second, at, joint.vector("axis"));
        JointFrame frame = joint_frame(X_first, X_second, at);
        if (!joint.has("axes")) return frame;
        frame.axis_first = joint_frame(X_first, X_second, at, joint.row("axes", 0)).axis_first;
        frame.axis_second = joint_frame(X_first, X_second, at, joint.row("axes", 1)).axis_second;
        return frame;
    }
    JointFrame frame;
    frame.point_first = joint.row("points", 0);   // zero without points: a rod between reference points
    frame.point_second = joint.row("points", 1);
    if (joint.has("axes")) {
        frame.axis_first = joint.row("axes", 0);
        frame.axis_second = joint.row("axes", 1);
    }
    return frame;
}

Joint build_joint(const Builder& builder, const Section& section, const std::string& name, int first,
                  int second)
{
    const std::string type = section.text("type");
    const JointFrame frame = read_frame(builder, section, first, second);
    const Matrix34 &X_first = builder.start_configuration(first),
                   &X_second = builder.start_configuration(second);
    const double scale = builder.length();
    if (type == "weld") return weld(name, first, second, frame, X_first, X_second, scale);
    if (type == "revolute") return revolute(name, first, second, frame, scale);
    if (type == "universal") return universal(name, first, second, frame, scale);
    if (type == "spherical") return spherical(name, first, second, frame, scale);
    const double distance = norm(X_second * point(frame.point_second) - X_first * point(frame.point_first));
    return rod(name, first, second, frame, section.has("length") ? section.number("length") : distance);
}

std::string joint_name(const Section& joint)
{
    if (joint.has("name")) return joint.text("name");
    const Value* between = joint.find("between");
    if (between == nullptr || joint.find("type") == nullptr) return {};
    return joint.text("type") + " " + between->texts[0] + "-" + between->texts[1];
}

/// False if another joint is called that.
bool claim_name(const Section& joint, const std::string& name, std::unordered_set<std::string>& taken,
                Findings& findings)
{
    if (name.empty() || taken.insert(name).second) return true;
    const bool is_given = joint.has("name");
    findings.error(is_given ? joint.place("name") : joint.place(), "name-duplicate",
                   "a joint called '" + name + "' exists already",
                   {is_given ? "results refer to joints by name"
                             : "a joint without name is called by its type and bodies",
                    is_given ? "rename one of them" : "give it a 'name'"});
    return false;
}

}   // namespace

void read_joints(Builder& builder)
{
    Findings& findings = builder.findings();
    std::unordered_set<std::string> taken;
    for (const Section& section : builder.top().sections("joint")) {
        const int before = findings.n_errors();
        const std::string name = joint_name(section), type = section.text("type");
        check_name(section, findings);
        claim_name(section, name, taken, findings);
        if (section.find("type") != nullptr) {
            check_placement(section, type, findings);
            check_axes(section, type, findings);
        }
        BodyReference first, second;
        const bool has_bodies = builder.find_pair(section, first, second);
        const std::string path = "joint[" + name + "]";
        builder.remember(path, section);
        if (!has_bodies || !section.is_valid() || findings.n_errors() > before) continue;
        if (!check_point_masses(builder, section, first.index, second.index, findings)) continue;
        builder.guard(path, [&] {
            builder.model().add_joint(build_joint(builder, section, name, first.index, second.index));
        });
    }
}

}   // namespace livens
