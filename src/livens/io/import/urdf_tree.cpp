// SPDX-License-Identifier: BSD-3-Clause
// Forward kinematics of a URDF, from its root outwards. Nothing recurses: a file may be one long chain.
#include "livens/io/import/urdf_tree.h"

#include <algorithm>
#include <map>
#include <string_view>

#include "livens/io/scenario/schema/schema.h"

namespace livens::inline io_internal {

namespace {

using Numbers = std::map<std::string_view, int>;

std::string named(std::string_view name) { return "'" + std::string(name) + "'"; }

class UrdfPlacing {
public:
    UrdfPlacing(const UrdfFile& file, const UrdfOptions& options, Losses& losses, Findings& findings)
        : file_(file), options_(options), losses_(losses), findings_(findings)
    {}

    UrdfTree tree();

private:
    template <class Parts>
    Numbers numbered(const Parts& parts, const char* what);
    bool look_up_links();
    bool find_root();
    bool follow_mimics();
    void follow(int joint);
    void give(const std::map<std::string, double>& given, std::vector<double>& values, const char* what);
    bool find_coordinates();
    void place_child(int joint, UrdfTree& tree);

    const UrdfFile& file_;
    const UrdfOptions& options_;
    Losses& losses_;
    Findings& findings_;
    Numbers links_, joints_;
    std::vector<int> parents_, children_;   // links of each joint
    std::vector<std::vector<int>> below_;   // joints of each link
    std::vector<int> leaders_;              // of each joint that follows; -1: of itself
    std::vector<int> order_;                // joints, leaders first
    std::vector<char> is_held_;
    std::vector<double> coordinates_, rates_;
    int root_ = -1;
};

template <class Parts>
Numbers UrdfPlacing::numbered(const Parts& parts, const char* what)
{
    Numbers numbers;
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (const auto [at, is_new] = numbers.try_emplace(parts[i].name, static_cast<int>(i)); !is_new)
            findings_.error(parts[i].place, "urdf-tree",
                            std::string("a second ") + what + " is called " + named(parts[i].name) +
                                ", as that in line " + std::to_string(parts[at->second].place.line));
    return numbers;
}

bool UrdfPlacing::look_up_links()
{
    const int before = findings_.n_errors();
    links_ = numbered(file_.links, "link");
    joints_ = numbered(file_.joints, "joint");
    std::vector<std::string_view> known;
    for (const UrdfLink& link : file_.links) known.push_back(link.name);
    const auto look_up = [&](const UrdfJoint& joint, const std::string& name, const char* what) {
        if (const auto found = links_.find(name); found != links_.end()) return found->second;
        findings_.error(joint.place, "urdf-tree",
                        std::string("the ") + what + " of joint " + named(joint.name) + " is " + named(name) +
                            ", and no link is called that",
                        {"", suggest(name, known)});
        return 0;
    };
    if (file_.links.size() > max_bodies)
        return findings_.error(file_.links[max_bodies].place, "resource-limit",
                               "the robot has more than " + std::to_string(max_bodies) + " links");
    if (file_.links.empty()) return findings_.error(file_.place, "urdf-tree", "the robot has no links");
    for (const UrdfJoint& joint : file_.joints) {
        parents_.push_back(look_up(joint, joint.parent, "parent"));
        children_.push_back(look_up(joint, joint.child, "child"));
    }
    return findings_.n_errors() == before;
}

/// Every link but one is the child of one joint, and all are reached from that one.
/// Links that no joint is above are counted first, then what hangs from the root: a circle of joints beside a
/// tree has no link without a joint above, and is seen by that alone.
bool UrdfPlacing::find_root()
{
    std::vector<int> joint_above(file_.links.size(), -1);
    below_.resize(file_.links.size());
    for (std::size_t j = 0; j < file_.joints.size(); ++j) {
        const UrdfJoint& joint = file_.joints[j];
        int& above = joint_above[children_[j]];
        if (above >= 0)
            return findings_.error(joint.place, "urdf-tree",
                                   "link " + named(joint.child) + " is the child of two joints, " +
                                       named(file_.joints[above].name) + " and " + named(joint.name),
                                   {"a URDF is a tree", "leave the second joint out and state it as a loop"});
        above = static_cast<int>(j);
        below_[parents_[j]].push_back(static_cast<int>(j));
    }
    for (std::size_t i = 0; i < joint_above.size(); ++i) {
        if (joint_above[i] >= 0) continue;
        if (root_ >= 0)
            return findings_.error(file_.links[i].place, "urdf-tree",
                                   "no joint leads to link " + named(file_.links[i].name) + ", nor to " +
                                       named(file_.links[root_].name),
                                   {"all links but one are children of joints", ""});
        root_ = static_cast<int>(i);
    }
    if (root_ < 0)
        return findings_.error(file_.links.front().place, "urdf-tree",
                               "every link is the child of a joint: they go round in a circle",
                               {"one link is the root, from which all others hang", ""});
    std::vector<int> reached{root_};
    for (std::size_t i = 0; i < reached.size(); ++i)
        for (const int j : below_[reached[i]]) reached.push_back(children_[j]);
    if (reached.size() == file_.links.size()) return true;
    std::vector<char> is_reached(file_.links.size());
    for (const int link : reached) is_reached[link] = 1;
    const auto lost = std::ranges::find(is_reached, 0) - is_reached.begin();
    return findings_.error(file_.links[lost].place, "urdf-tree",
                           "link " + named(file_.links[lost].name) + " hangs in a circle of joints",
                           {"a URDF is a tree", ""});
}

/// Behind its leader in `order_`; a circle of mimics is a finding.
/// Along the leaders to one that is done or follows none, then back: so each stands behind its own leader.
/// A joint that is met while its chain is open closes a circle.
void UrdfPlacing::follow(int joint)
{
    std::vector<int> chain;
    enum : char { unknown, open, done };
    std::vector<char>& state = is_held_;   // for now
    for (int j = joint; j >= 0 && state[j] != done; j = leaders_[j]) {
        if (state[j] == open) {
            findings_.error(file_.joints[j].place, "urdf-joint",
                            "joint " + named(file_.joints[j].name) + " mimics itself, by way of others");
            break;
        }
        state[j] = open;
        chain.push_back(j);
    }
    for (auto j = chain.rbegin(); j != chain.rend(); ++j) {
        state[*j] = done;
        order_.push_back(*j);
    }
}

/// A joint is held if it is fixed, or if what it follows is held or counts with the factor 0. In the order of
/// leaders one pass is enough.
bool UrdfPlacing::follow_mimics()
{
    const int before = findings_.n_errors();
    std::vector<std::string_view> known;
    for (const UrdfJoint& joint : file_.joints) known.push_back(joint.name);
    leaders_.assign(file_.joints.size(), -1);
    for (std::size_t j = 0; j < file_.joints.size(); ++j) {
        const UrdfJoint& joint = file_.joints[j];
        if (!joint.mimic || joint.type == UrdfJoint::Type::fixed) continue;
        const auto found = joints_.find(joint.mimic->joint);
        if (found == joints_.end())
            findings_.error(joint.mimic->place, "urdf-joint",
                            "joint " + named(joint.name) + " mimics " + named(joint.mimic->joint) +
                                ", and no joint is called that",
                            {"", suggest(joint.mimic->joint, known)});
        else if (!joint.has_coordinate() || (!file_.joints[found->second].has_coordinate() &&
                                             file_.joints[found->second].type != UrdfJoint::Type::fixed))
            findings_.error(joint.mimic->place, "urdf-joint",
                            "joint " + named(joint.name) + " mimics " + named(joint.mimic->joint) +
                                ", and one of them has no coordinate",
                            {"joints that turn about one axis or slide along one have one", ""});
        else
            leaders_[j] = found->second;
    }
    is_held_.assign(file_.joints.size(), 0);
    for (std::size_t j = 0; j < file_.joints.size(); ++j) follow(static_cast<int>(j));
    if (findings_.n_errors() > before) return false;
    for (const int j : order_) {
        const UrdfJoint& joint = file_.joints[j];
        const int leader = leaders_[j];
        is_held_[j] = leader < 0 ? joint.type == UrdfJoint::Type::fixed
                                 : is_held_[leader] != 0 || joint.mimic->multiplier == 0;
        if (leader >= 0 && is_held_[j] != 0) losses_.add(losses::held, joint.place, named(joint.name));
    }
    return true;
}

/// What the caller states of joints by name.
void UrdfPlacing::give(const std::map<std::string, double>& given, std::vector<double>& values,
                       const char* what)
{
    std::vector<std::string_view> known;
    for (std::size_t j = 0; j < file_.joints.size(); ++j)
        if (file_.joints[j].has_coordinate() && leaders_[j] < 0) known.push_back(file_.joints[j].name);
    for (const auto& [name, value] : given) {
        const auto found = joints_.find(name);
        if (found == joints_.end()) {
            findings_.error({}, "joint-unknown",
                            std::string("the ") + what + " of " + named(name) +
                                " is given, but there is no such joint",
                            {"", suggest(name, known)});
            continue;
        }
        const UrdfJoint& joint = file_.joints[found->second];
        const int leader = leaders_[found->second];
        if (!joint.has_coordinate() || leader >= 0)
            findings_.error(joint.place, "joint-coordinate",
                            std::string("the ") + what + " of joint " + named(name) + " cannot be given",
                            {leader >= 0 ? "it follows " + named(file_.joints[leader].name)
                                         : "only joints that turn about one axis or slide along one have one",
                             leader >= 0 ? "give that of " + named(file_.joints[leader].name) : ""});
        else if (!std::isfinite(value))
            findings_.error(joint.place, "not-finite",
                            std::string("the ") + what + " of joint " + named(name) + " is no finite number");
        else
            values[found->second] = value;
    }
}

bool UrdfPlacing::find_coordinates()
{
    const int before = findings_.n_errors();
    coordinates_.assign(file_.joints.size(), 0);
    rates_ = coordinates_;
    give(options_.at, coordinates_, "coordinate");
    give(options_.rates, rates_, "rate");
    for (const int j : order_) {
        const int leader = leaders_[j];
        if (leader < 0) continue;
        const UrdfMimic& mimic = *file_.joints[j].mimic;
        coordinates_[j] = mimic.multiplier * coordinates_[leader] + mimic.offset;
        rates_[j] = mimic.multiplier * rates_[leader];
    }
    return findings_.n_errors() == before;
}

/// v = v_p + w_p x (x - x_p) + q' a of what slides, w = w_p + q' a of what turns, with the axis a in the
/// world, which a turn about it leaves as it is. The parent was placed before.
void UrdfPlacing::place_child(int j, UrdfTree& tree)
{
    const UrdfJoint& joint = file_.joints[j];
    const PlacedLink& parent = tree.links[parents_[j]];
    PlacedLink& child = tree.links[children_[j]];
    child.pose = parent.pose * joint.pose;
    const Vector3 at = child.pose.origin, axis = child.pose.axes * joint.axis;
    const double q = coordinates_[j];
    if (joint.turns()) child.pose.axes = child.pose.axes * turn(joint.axis, q);
    if (joint.slides()) child.pose.origin += q * axis;
    child.angular_velocity = parent.angular_velocity + (joint.turns() ? rates_[j] * axis : Vector3{});
    child.velocity = parent.velocity +
                     cross(parent.angular_velocity, child.pose.origin - parent.pose.origin) +
                     (joint.slides() ? rates_[j] * axis : Vector3{});
    if (is_held_[j] != 0) {
        child.body = parent.body;
        if (child.body < 0)
            losses_.add(losses::grounded, file_.links[children_[j]].place, named(joint.child));
        else
            losses_.add(losses::merged, file_.links[children_[j]].place, named(joint.child));
        return;
    }
    child.body = static_cast<int>(tree.frames.size());
    tree.frames.push_back(children_[j]);
    if (joint.type == UrdfJoint::Type::floating)
        losses_.add(losses::free_joint, joint.place, named(joint.name));
    else
        tree.joints.push_back({j, parent.body, child.body, at, axis, q, rates_[j]});
}

/// The list grows while it is gone through: every link behind its parent.
UrdfTree UrdfPlacing::tree()
{
    UrdfTree tree;
    if (!look_up_links() || !find_root() || !follow_mimics() || !find_coordinates()) return tree;
    tree.links.resize(file_.links.size());
    if (options_.base == UrdfOptions::Base::free) {
        tree.links[root_].body = 0;
        tree.frames.push_back(root_);
    } else {
        losses_.add(losses::grounded, file_.links[root_].place, named(file_.links[root_].name));
    }
    std::vector<int> reached{root_};
    for (std::size_t i = 0; i < reached.size(); ++i)
        for (const int j : below_[reached[i]]) {
            place_child(j, tree);
            reached.push_back(children_[j]);
        }
    tree.is_held = is_held_;
    if (tree.frames.empty())
        findings_.error(file_.place, "urdf-tree", "nothing of the robot can move: all its joints are fixed",
                        {"", "with a free base it moves as one body"});
    return tree;
}

}   // namespace

UrdfTree place_links(const UrdfFile& file, const UrdfOptions& options, Losses& losses, Findings& findings)
{
    return UrdfPlacing(file, options, losses, findings).tree();
}

}   // namespace livens::inline io_internal
