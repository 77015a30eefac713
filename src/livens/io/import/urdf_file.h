// SPDX-License-Identifier: BSD-3-Clause
// What a URDF says: links and joints, with numbers that are numbers and references that are not yet looked
// up.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "livens/base/linear.h"
#include "livens/io/import/losses.h"
#include "livens/io/scenario/text/xml.h"

namespace livens::inline io_internal {

/// Axes (in columns) and origin of a frame in another one.
struct Pose {
    Matrix3 axes = identity<3>();
    Vector3 origin{};
};
inline Pose operator*(const Pose& outer, const Pose& inner)
{
    return {outer.axes * inner.axes, outer.origin + outer.axes * inner.origin};
}
/// About a unit axis by an angle in rad.
Matrix3 turn(const Vector3& axis, double angle);

struct UrdfInertial {
    double mass = 0;
    Vector3 center{};    ///< in the link's frame
    Matrix3 inertia{};   ///< about the centre, in axes of the link
    SourceLocation place;
};

struct UrdfVisual {
    enum class Shape { box, cylinder, sphere, capsule, mesh };
    Shape shape = Shape::box;
    Pose pose;
    Vector3 size{1, 1, 1};   ///< edges, scale of a mesh, or (radius, length)
    std::string mesh;
    std::string material;
    std::optional<std::array<double, 4>> color;   ///< red, green, blue, opacity from 0 to 1
    SourceLocation place;
};

struct UrdfLink {
    std::string name;
    UrdfInertial inertial;
    std::vector<UrdfVisual> visuals;
    SourceLocation place;
};

struct UrdfMimic {
    std::string joint;
    double multiplier = 1, offset = 0;
    SourceLocation place;
};

struct UrdfLimit {
    std::optional<double> lower, upper;
    double effort = 0, velocity = 0;   ///< 0: none stated
    SourceLocation place;
};

struct UrdfJoint {
    enum class Type { fixed, revolute, continuous, prismatic, spherical, planar, floating };
    std::string name;
    Type type = Type::fixed;
    Pose pose;   ///< of the child's frame in the parent's at coordinate 0
    std::string parent, child;
    Vector3 axis{1, 0, 0};   ///< |axis| = 1
    double damping = 0, friction = 0;
    std::optional<UrdfLimit> limit;
    std::optional<UrdfMimic> mimic;
    SourceLocation place;

    bool turns() const { return type == Type::revolute || type == Type::continuous; }
    bool slides() const { return type == Type::prismatic; }
    bool has_coordinate() const { return turns() || slides(); }
};

struct UrdfFile {
    std::string name;
    std::vector<UrdfLink> links;
    std::vector<UrdfJoint> joints;
    SourceLocation place;
};

/// What is unknown or does not count goes to `losses`. Wrong tags, attributes and numbers are findings.
UrdfFile read_urdf_file(const XmlElement& root, Losses& losses, Findings& findings);

}   // namespace livens::inline io_internal
