// SPDX-License-Identifier: BSD-3-Clause
// URDF element by element, as wiki.ros.org/urdf/XML has it.
#include "livens/io/import/urdf_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <span>

#include "livens/base/elementary.h"
#include "livens/io/import/urdf_elements.h"

namespace livens::inline io_internal {

namespace {

class UrdfReader : UrdfElements {
public:
    using UrdfElements::UrdfElements;

    UrdfFile file(const XmlElement& root);

private:
    UrdfLink link(const XmlElement& e);
    UrdfInertial inertial(const XmlElement& e, const std::string& owner);
    void visual(const XmlElement& e, const std::string& owner, std::vector<UrdfVisual>& all);
    bool geometry(const XmlElement& e, const std::string& owner, UrdfVisual& visual);
    std::optional<std::array<double, 4>> color_of(const XmlElement& material, const std::string& owner);
    UrdfJoint joint(const XmlElement& e);
    void motion_of_joint(const XmlElement& e, UrdfJoint& joint);
    void terms_of_joint(const XmlElement& e, UrdfJoint& joint);

    std::map<std::string, std::optional<std::array<double, 4>>> materials_;
};

// Links.

UrdfInertial UrdfReader::inertial(const XmlElement& e, const std::string& owner)
{
    check(e, {{}, {"origin", "mass", "inertia"}}, owner);
    UrdfInertial of;
    of.place = e.place;
    const Pose frame = pose(e, owner);
    of.center = frame.origin;
    if (const XmlElement* mass = only(e, "mass")) {
        check(*mass, {{"value"}, {}}, owner);
        text(*mass, "value");
        of.mass = bounded(*mass, "value", 0);
    }
    if (const XmlElement* inertia = only(e, "inertia")) {
        static constexpr std::string_view names[3][3] = {
            {"ixx", "ixy", "ixz"}, {"ixy", "iyy", "iyz"}, {"ixz", "iyz", "izz"}};
        check(*inertia, {{"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}, {}}, owner);
        Matrix3 J{};
        bool has_products = true;
        for (int i = 0; i < 3; ++i)
            for (int j = i; j < 3; ++j) {
                J(i, j) = J(j, i) = number(*inertia, names[i][j], 0);
                if (inertia->find(names[i][j]) != nullptr) continue;
                if (i == j)   // 0 would be another body
                    findings_.error(inertia->place, "urdf-tag",
                                    "<inertia> of " + owner + " needs the attribute '" +
                                        std::string(names[i][j]) + "'");
                has_products = false;
            }
        if (!has_products) losses_.add(losses::products, inertia->place, owner);
        // Stated along the axes of <origin>, wanted along those of the link.
        of.inertia = frame.axes * J * transpose(frame.axes);
        of.place = inertia->place;
    }
    return of;
}

bool UrdfReader::geometry(const XmlElement& e, const std::string& owner, UrdfVisual& visual)
{
    const XmlElement* all = only(e, "geometry");
    if (all == nullptr || all->children.empty())
        return findings_.error(e.place, "urdf-tag", "<" + e.name + "> needs a shape in <geometry>");
    check(*all, {{}, {"box", "cylinder", "sphere", "capsule", "mesh"}}, owner);
    const XmlElement& shape = all->children.front();
    using Shape = UrdfVisual::Shape;
    if (shape.name == "box") {
        check(shape, {{"size"}, {}}, owner);
        text(shape, "size");
        visual.shape = Shape::box;
        numbers(shape, "size", visual.size.a);
    } else if (shape.name == "sphere") {
        check(shape, {{"radius"}, {}}, owner);
        visual.shape = Shape::sphere;
        visual.size[0] = size(shape, "radius");
    } else if (shape.name == "cylinder" || shape.name == "capsule") {
        check(shape, {{"radius", "length"}, {}}, owner);
        visual.shape = shape.name == "capsule" ? Shape::capsule : Shape::cylinder;
        visual.size = {size(shape, "radius"), size(shape, "length"), 0};
    } else if (shape.name == "mesh") {
        check(shape, {{"filename", "scale"}, {}}, owner);
        visual.shape = Shape::mesh;
        visual.mesh = text(shape, "filename");
        numbers(shape, "scale", visual.size.a);
    } else {
        return false;   // told by check()
    }
    const int n_sizes = visual.shape == Shape::sphere ? 1 : visual.shape == Shape::box ? 3 : 2;
    if (visual.shape == Shape::mesh || *std::min_element(visual.size.a, visual.size.a + n_sizes) > 0)
        return true;
    losses_.add(losses::shape_size, shape.place, owner);
    return false;
}

std::optional<std::array<double, 4>> UrdfReader::color_of(const XmlElement& material,
                                                          const std::string& owner)
{
    check(material, {{"name"}, {"color"}, {{"texture", &losses::texture}}}, owner);
    const XmlElement* color = only(material, "color");
    if (color == nullptr) return {};
    check(*color, {{"rgba"}, {}}, owner);
    std::array<double, 4> rgba{};
    if (!numbers(*color, "rgba", rgba)) return {};
    if (std::ranges::all_of(rgba, [](double x) { return x >= 0 && x <= 1; })) return rgba;
    losses_.add(losses::color, color->place, owner);
    return {};
}

void UrdfReader::visual(const XmlElement& e, const std::string& owner, std::vector<UrdfVisual>& all)
{
    check(e, {{"name"}, {"origin", "geometry", "material"}}, owner);
    UrdfVisual visual;
    visual.place = e.place;
    visual.pose = pose(e, owner);
    if (const XmlElement* material = only(e, "material")) {
        visual.color = color_of(*material, owner);
        if (const std::string* name = material->find("name")) visual.material = *name;
        // What is defined at one link may be named at others.
        if (visual.color && !visual.material.empty()) materials_.try_emplace(visual.material, visual.color);
    }
    if (geometry(e, owner, visual)) all.push_back(std::move(visual));
}

UrdfLink UrdfReader::link(const XmlElement& e)
{
    UrdfLink link;
    link.name = name_of(e);
    link.place = e.place;
    const std::string owner = in_marks(link.name);
    check(e,
          {{"name", "type"},
           {"inertial", "visual"},
           {{"collision", &losses::collision},
            {"collision_checking", &losses::no_motion},
            {"self_collision_checking", &losses::no_motion},
            {"contact", &losses::extension},
            {"sensor", &losses::no_motion}}},
          owner);
    if (const XmlElement* inertial_tag = only(e, "inertial")) link.inertial = inertial(*inertial_tag, owner);
    for (const XmlElement& child : e.children)
        if (child.name == "visual") visual(child, owner, link.visuals);
    return link;
}

// Joints.

std::optional<UrdfJoint::Type> type_of(std::string_view word)
{
    using enum UrdfJoint::Type;
    static constexpr std::pair<std::string_view, UrdfJoint::Type> types[] = {
        {"fixed", fixed},         {"revolute", revolute},   {"continuous", continuous},
        {"prismatic", prismatic}, {"spherical", spherical}, {"planar", planar},
        {"floating", floating}};
    for (const auto& [name, type] : types)
        if (name == word) return type;
    return {};
}

void UrdfReader::motion_of_joint(const XmlElement& e, UrdfJoint& joint)
{
    const std::string owner = in_marks(joint.name);
    const std::string type = text(e, "type");
    if (const auto found = type_of(type))
        joint.type = *found;
    else if (!type.empty())
        findings_.error(
            e.place, "urdf-joint", "joint " + owner + " is of the type '" + type.substr(0, 40) + "'",
            {"", "known are fixed, revolute, continuous, prismatic, spherical, planar, floating"});
    joint.pose = pose(e, owner);
    for (const auto& [tag, link] : {std::pair{"parent", &joint.parent}, std::pair{"child", &joint.child}}) {
        if (const XmlElement* found = only(e, tag)) {
            check(*found, {{"link"}, {}}, owner);
            *link = text(*found, "link");
        } else {
            findings_.error(e.place, "urdf-tag", "joint " + owner + " has no <" + tag + " link=\"..\"/>");
        }
    }
    const XmlElement* axis = only(e, "axis");
    if (axis == nullptr) return;
    check(*axis, {{"xyz"}, {}}, owner);
    numbers(*axis, "xyz", joint.axis.a);
    const double length = norm(joint.axis);
    constexpr double rounded = 1e-3;   // of digits that were printed
    if (!(length > 1e-100) || !std::isfinite(length)) {
        joint.axis = {1, 0, 0};
        if (joint.has_coordinate() || joint.type == UrdfJoint::Type::planar)
            findings_.error(axis->place, "urdf-value", "the axis of joint " + owner + " has no direction");
        return;
    }
    if (std::abs(length - 1) > rounded) losses_.add(losses::axis, axis->place, owner);
    joint.axis *= 1 / length;
}

void UrdfReader::terms_of_joint(const XmlElement& e, UrdfJoint& joint)
{
    const std::string owner = in_marks(joint.name);
    if (const XmlElement* dynamics = only(e, "dynamics")) {
        check(*dynamics, {{"damping", "friction"}, {}}, owner);
        joint.damping = bounded(*dynamics, "damping", 0);
        joint.friction = bounded(*dynamics, "friction", 0);
        if (joint.friction > 0 && joint.type != UrdfJoint::Type::fixed)
            losses_.add(losses::friction, dynamics->place, owner);
    }
    if (const XmlElement* limit = only(e, "limit")) {
        check(*limit, {{"lower", "upper", "effort", "velocity"}, {}}, owner);
        UrdfLimit& of = joint.limit.emplace();
        of.place = limit->place;
        double value = 0;
        // The format's own defaults are 0 where one of them is left out, and none where both are.
        if (limit->find("lower") != nullptr || limit->find("upper") != nullptr) {
            of.lower = number(*limit, "lower", 0);
            of.upper = number(*limit, "upper", 0);
        }
        if (numbers(*limit, "effort", {&value, 1})) of.effort = value;
        if (numbers(*limit, "velocity", {&value, 1})) of.velocity = value;
    }
    if (const XmlElement* mimic = only(e, "mimic")) {
        check(*mimic, {{"joint", "multiplier", "offset"}, {}}, owner);
        UrdfMimic& of = joint.mimic.emplace();
        of.joint = text(*mimic, "joint");
        of.multiplier = number(*mimic, "multiplier", 1);
        of.offset = number(*mimic, "offset", 0);
        of.place = mimic->place;
    }
}

UrdfJoint UrdfReader::joint(const XmlElement& e)
{
    UrdfJoint joint;
    joint.name = name_of(e);
    joint.place = e.place;
    check(e,
          {{"name", "type"},
           {"origin", "parent", "child", "axis", "dynamics", "limit", "mimic"},
           {{"calibration", &losses::no_motion}, {"safety_controller", &losses::no_motion}}},
          in_marks(joint.name));
    motion_of_joint(e, joint);
    terms_of_joint(e, joint);
    return joint;
}

/// Materials of the robot are read first, those that links define as links are read; names are looked up
/// when all are known, since a link may name what a later one defines.
UrdfFile UrdfReader::file(const XmlElement& root)
{
    UrdfFile file;
    file.place = root.place;
    if (root.name != "robot") {
        std::string_view help;
        if (root.name == "mujoco") help = "lv.from_mjcf(file) of the Python package reads models of MuJoCo";
        if (root.name == "sdf") help = "this is no URDF but a file of another format";
        findings_.error(root.place, "urdf-tag", "the file begins with <" + root.name + ">, not <robot>",
                        {"", std::string(help)});
        return file;
    }
    check(
        root,
        {{"name", "version"},
         {"link", "joint", "material"},
         {{"transmission", &losses::no_motion}, {"gazebo", &losses::gazebo}, {"sensor", &losses::no_motion}},
         true},
        "<robot>");
    if (const std::string* name = root.find("name")) file.name = *name;
    for (const XmlElement& e : root.children)
        if (e.name == "material")
            if (const auto color = color_of(e, "<robot>")) materials_[name_of(e)] = color;
    for (const XmlElement& e : root.children)
        if (e.name == "link")
            file.links.push_back(link(e));
        else if (e.name == "joint")
            file.joints.push_back(joint(e));
    for (UrdfLink& one : file.links)
        for (UrdfVisual& visual : one.visuals)
            if (const auto found = materials_.find(visual.material);
                !visual.color && found != materials_.end())
                visual.color = found->second;
    return file;
}

}   // namespace

/// Rodrigues' formula: R = 1 + sin(angle) K + (1 - cos(angle)) K^2, K v = axis x v.
Matrix3 turn(const Vector3& axis, double angle)
{
    const auto [sine, cosine] = sine_cosine(angle);
    const Matrix3 K = cross_matrix(axis);
    return identity<3>() + sine * K + (1 - cosine) * (K * K);
}

UrdfFile read_urdf_file(const XmlElement& root, Losses& losses, Findings& findings)
{
    return UrdfReader(losses, findings).file(root);
}

}   // namespace livens::inline io_internal
