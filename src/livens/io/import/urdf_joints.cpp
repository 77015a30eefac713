// SPDX-License-Identifier: BSD-3-Clause
// Joints are stated where the bodies stand, by a point and an axis of the world, and with the coordinate that
// they have there: coordinates are those of the file.
#include "livens/io/import/urdf_joints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "livens/base/text.h"

namespace livens::inline io_internal {

namespace {

std::string_view word_of(UrdfJoint::Type type)
{
    using enum UrdfJoint::Type;
    if (type == prismatic) return "prismatic";
    if (type == spherical) return "spherical";
    if (type == planar) return "planar";
    return "revolute";
}

TableMaker joint_table(const SourceLocation& place, const std::string& name, std::string_view type)
{
    TableMaker table(place);
    table.text("name", name).text("type", std::string(type));
    return table;
}

std::vector<Vector3> triad(const Matrix3& axes) { return {axes.column(0), axes.column(1), axes.column(2)}; }

TableMaker frame_table(const Pose& pose)
{
    TableMaker table({});
    table.vector("point", pose.origin).rows("directors", triad(pose.axes));
    return table;
}

/// The nearest ratio of whole numbers up to 10000, which two angles that may turn round and round must have;
/// the multiplier itself if it is one, or near none.
/// Angles are told up to whole turns: a coupling whose factors have no common measure is refused (theory.md,
/// "Coordinates of joints", Angles).
double ratio_of_angles(double multiplier)
{
    constexpr int most = 10000;
    constexpr double rounding = 1e-11;   // of decimals
    const double size = std::abs(multiplier);
    double nearest = size, least = std::numeric_limits<double>::infinity();
    for (int q = 1; q <= most; ++q) {
        const double p = std::round(size * q), off = std::abs(p / q - size);
        if (p < 1 || p > most || off >= least) continue;
        if (off <= rounding * size) return multiplier;
        least = off;
        nearest = p / q;
    }
    return std::copysign(nearest, multiplier);
}

}   // namespace

void place_in(TableMaker& table, const Pose& pose)
{
    if (!(pose.origin == Vector3{})) table.vector("position", pose.origin);
    if (!(pose.axes == identity<3>())) table.rows("directors", triad(pose.axes));
}

UrdfJoints::UrdfJoints(const UrdfFile& file, const UrdfTree& tree, const UrdfOptions& options, Losses& losses)
    : file_(file), tree_(tree), options_(options), losses_(losses), body_names_{"world"}, taken_{"world"}
{
    for (const int link : tree.frames) {
        const std::string& name = file.links[link].name;
        body_names_.push_back(name == "world" ? "world link" : name);
        taken_.insert(body_names_.back());
    }
    point_names_.resize(file.links.size());
    for (std::size_t i = 0; i < file.links.size(); ++i) {
        const int body = tree.links[i].body;
        if (file.links[i].name == "world" || (body >= 0 && tree.frames[body] == static_cast<int>(i)))
            continue;
        // joints keep their names: a link that only rides on another is asked for less
        std::string& name = point_names_[i] = file.links[i].name;
        const auto is_joint = [&](const auto& joint) { return joint.name == name; };
        while (std::ranges::any_of(file.joints, is_joint) || !taken_.insert(name).second) name += " link";
    }
}

/// Bodies, joints and loads are asked for by name, so that each has one of its own.
std::string UrdfJoints::unused(std::string name)
{
    while (!taken_.insert(name).second) name += " joint";
    return name;
}

Pose UrdfJoints::in_body(const PlacedLink& link) const
{
    if (link.body < 0) return link.pose;
    const Pose& frame = tree_.links[tree_.frames[link.body]].pose;
    const Matrix3 back = transpose(frame.axes);
    return {back * link.pose.axes, back * (link.pose.origin - frame.origin)};
}

std::vector<TableMaker> UrdfJoints::points() const
{
    std::vector<TableMaker> all;
    for (std::size_t i = 0; i < point_names_.size(); ++i) {
        if (point_names_[i].empty()) continue;
        const PlacedLink& link = tree_.links[i];
        TableMaker& point = all.emplace_back(file_.links[i].place);
        point.text("name", point_names_[i]).text("body", body_name(link.body));
        if (const Vector3 at = in_body(link).origin; !(at == Vector3{})) point.vector("position", at);
    }
    return all;
}

TableMaker UrdfJoints::joint(const PlacedJoint& placed)
{
    const UrdfJoint& joint = file_.joints[placed.joint];
    const std::string name = unused(joint.name);
    if (name != joint.name) losses_.add(losses::renamed, joint.place, "'" + joint.name + "'");
    names_[joint.name] = name;
    TableMaker table = joint_table(joint.place, name, word_of(joint.type));
    table.texts("between", {body_name(placed.first), body_name(placed.second)}).vector("at", placed.at);
    if (joint.type != UrdfJoint::Type::spherical) table.vector("axis", placed.axis);
    if (joint.has_coordinate() && placed.coordinate != 0) table.number("coordinate", placed.coordinate);
    add_loads(table, placed);
    return table;
}

/// What no joint keeps, and what joints without a coordinate have no place for.
void UrdfJoints::tell_lost(const UrdfJoint& joint)
{
    using enum UrdfJoint::Type;
    const std::string name = "'" + joint.name + "'";
    if (joint.damping > 0 && (joint.type == planar || joint.type == floating))
        losses_.add(losses::damping, joint.place, name);
    if (!joint.limit) return;
    const UrdfLimit& limit = *joint.limit;
    if (limit.effort > 0 || limit.velocity > 0) losses_.add(losses::bounds, limit.place, name);
    if (limit.lower && joint.type != revolute && joint.type != prismatic)
        losses_.add(losses::limits_of_others, limit.place, name);
}

/// What the joint does along its coordinate.
void UrdfJoints::add_loads(TableMaker& table, const PlacedJoint& placed)
{
    const UrdfJoint& joint = file_.joints[placed.joint];
    tell_lost(joint);
    if (joint.damping > 0 && joint.type != UrdfJoint::Type::planar) table.number("damping", joint.damping);
    if (joint.limit && joint.limit->lower && joint.has_coordinate() &&
        joint.type != UrdfJoint::Type::continuous)
        add_limits(table, *joint.limit, "'" + joint.name + "'", placed.coordinate);
}

/// A start beyond a limit would be thrown back: such an end is told instead. Springs, as every family of
/// methods and every command knows them.
void UrdfJoints::add_limits(TableMaker& table, const UrdfLimit& limit, const std::string& name,
                            double coordinate)
{
    if (options_.limits == UrdfOptions::Limits::ignore) return losses_.add(losses::limits, limit.place, name);
    if (!(*limit.lower < *limit.upper)) return losses_.add(losses::limits_order, limit.place, name);
    constexpr double slack = 1e-9;   // rad or m, as a scenario has it for a start at a limit
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double low = coordinate >= *limit.lower - slack ? *limit.lower : -infinity;
    const double high = coordinate <= *limit.upper + slack ? *limit.upper : infinity;
    if (low == -infinity || high == infinity) losses_.add(losses::limits_at_start, limit.place, name);
    if (!(low > -infinity || high < infinity)) return;
    table.numbers("limits", std::array{low, high});
    table.text("limit_law", "penalty");
}

/// A joint that follows another one: coordinate - multiplier times the leader's stays what it is at the
/// start.
TableMaker UrdfJoints::coupling(const UrdfJoint& joint)
{
    const UrdfMimic& mimic = *joint.mimic;
    const auto leader = std::ranges::find(file_.joints, mimic.joint, &UrdfJoint::name);
    double multiplier = mimic.multiplier;
    if (leader->turns() && joint.turns()) multiplier = ratio_of_angles(multiplier);
    if (multiplier != mimic.multiplier)
        losses_.add(losses::multiplier, mimic.place,
                    "'" + joint.name + "' by " + to_text(std::abs(multiplier - mimic.multiplier), 2));
    const auto coordinate = [&](const UrdfJoint& of) {
        return names_.at(of.name) + (of.turns() ? ".angle" : ".displacement");
    };
    TableMaker terms(mimic.place);
    terms.number(coordinate(*leader), -multiplier).number(coordinate(joint), 1);
    TableMaker table = joint_table(mimic.place, unused("mimic " + joint.name), "coupling");
    table.table("terms", std::move(terms));
    return table;
}

std::vector<TableMaker> UrdfJoints::joints()
{
    std::vector<TableMaker> all;
    for (const PlacedJoint& placed : tree_.joints) all.push_back(joint(placed));
    for (const UrdfJoint& free : file_.joints)
        if (free.type == UrdfJoint::Type::floating) tell_lost(free);
    for (const PlacedJoint& placed : tree_.joints)
        if (file_.joints[placed.joint].mimic) all.push_back(coupling(file_.joints[placed.joint]));
    return all;
}

const PlacedLink* UrdfJoints::find_link(const std::string& name, Findings& findings) const
{
    const auto found = std::ranges::find(file_.links, name, &UrdfLink::name);
    if (found != file_.links.end()) return &tree_.links[found - file_.links.begin()];
    std::vector<std::string_view> known;
    for (const UrdfLink& link : file_.links) known.push_back(link.name);
    findings.error({}, "body-unknown", "a loop names the link '" + name + "', and there is no such link",
                   {"", suggest(name, known)});
    return nullptr;
}

/// By the frames of both links, which the loop holds together: welded, or a revolute one about their z axes,
/// as the third axis of a frame is that of the joint. Of a spherical one their origins are enough.
void UrdfJoints::add_loops(std::vector<TableMaker>& joints, Findings& findings)
{
    for (const UrdfLoop& loop : options_.loops) {
        const PlacedLink* first = find_link(loop.first, findings);
        const PlacedLink* second = find_link(loop.second, findings);
        if (first == nullptr || second == nullptr) continue;
        const std::string label = "the loop of '" + loop.first + "' and '" + loop.second + "'";
        if (first->body == second->body) {
            findings.error({}, "joint-self", label + " holds two parts of one body");
            continue;
        }
        if (loop.type != "weld" && loop.type != "spherical" && loop.type != "revolute") {
            findings.error({}, "unknown-choice", label + " is of the type '" + loop.type + "'",
                           {"", "known are weld, spherical and revolute"});
            continue;
        }
        const Pose one = in_body(*first), other = in_body(*second);
        TableMaker table = joint_table({}, unused("loop " + loop.first + " " + loop.second), loop.type);
        table.texts("between", {body_name(first->body), body_name(second->body)});
        if (loop.type == "spherical") {
            table.rows("points", {one.origin, other.origin});
        } else {
            std::vector<TableMaker> frames;
            frames.push_back(frame_table(one));
            frames.push_back(frame_table(other));
            table.tables("frames", std::move(frames));
        }
        joints.push_back(std::move(table));
    }
}

}   // namespace livens::inline io_internal
