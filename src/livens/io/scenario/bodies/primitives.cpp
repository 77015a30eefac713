// SPDX-License-Identifier: BSD-3-Clause
// The primitive shapes: for each its keys, its mass properties in closed form, its outline for pictures and
// its solid for quadrature (theory.md, Bodies from meshes). Outlines are profiles (radius, height) that turn
// about d3, in a given number of sides.
#include "livens/io/scenario/bodies/primitives.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "livens/base/elementary.h"

namespace livens {

namespace {

/// From one angle above the equator to another, in rad, of radius 1 about a height.
std::vector<std::array<double, 2>> arc(double from, double to, double radius, double height)
{
    constexpr int steps = 6;   // a quarter of the way round has as many as the equator
    std::vector<std::array<double, 2>> points;
    for (int i = 0; i <= steps; ++i) {
        const auto [sine, cosine] = sine_cosine(from + (to - from) * i / steps);
        // The cosine of a rounded pi/2 is 6e-17: at the pole the radius has to be zero for the profile to
        // close.
        points.push_back({cosine > 1e-9 ? radius * cosine : 0, height + radius * sine});
    }
    return points;
}

Outline capsule_outline(double radius, double length)
{
    constexpr double pole = std::numbers::pi / 2;
    Outline outline{arc(-pole, 0, radius, -0.5 * length), 24, {1, 1, 1}};
    const auto upper = arc(0, pole, radius, 0.5 * length);
    // Without a cylinder between them both halves share the equator, which stands once then.
    outline.profile.insert(outline.profile.end(), upper.begin() + (length > 0 ? 0 : 1), upper.end());
    return outline;
}

Outline stretched(Outline outline, const Vector3& stretch)
{
    outline.stretch = stretch;
    return outline;
}

Outline box_outline(const Vector3& edges)
{
    // A profile of radius sqrt(1/2) on four sides is a square with edges of 1, which is stretched.
    const double r = std::numbers::sqrt2 / 2;
    return {{{0, -0.5}, {r, -0.5}, {r, 0.5}, {0, 0.5}}, 4, edges};
}

/// The centre of mass is a quarter of the height above the base.
Outline cone_outline(double radius, double height)
{
    return {{{0, -0.25 * height}, {radius, -0.25 * height}, {0, 0.75 * height}}, 24, {1, 1, 1}};
}

Outline cylinder_outline(double radius, double length, double bore)
{
    const double h = 0.5 * length;
    Outline outline{{{bore, -h}, {radius, -h}, {radius, h}, {bore, h}}, 24, {1, 1, 1}};
    // A tube closes along its bore; a solid cylinder begins and ends on the axis.
    if (bore > 0) outline.profile.push_back({bore, -h});
    return outline;
}

Key length(std::string_view name, const std::string& doc)
{
    return Key{name, types::number, doc, "m"}.needed().within(positive);
}

double radius_of_sphere(const Section& shape)
{
    const Section* table = only_section(shape, "sphere");
    return table != nullptr ? table->number("radius") : shape.number("sphere");
}

Outline outline_of_cylinder(const Section& shape)
{
    const Section& c = *only_section(shape, "cylinder");
    return cylinder_outline(c.number("radius"), c.number("length"), c.number("inner_radius"));
}

PrimitiveSolid solid_of_cylinder(const Section& shape)
{
    const Section& c = *only_section(shape, "cylinder");
    return cylinder_solid(c.number("radius"), c.number("length"), c.number("inner_radius"));
}

Outline outline_of_capsule(const Section& shape)
{
    const Section& c = *only_section(shape, "capsule");
    return capsule_outline(c.number("radius"), c.number("length"));
}

PrimitiveSolid solid_of_capsule(const Section& shape)
{
    const Section& c = *only_section(shape, "capsule");
    return capsule_solid(c.number("radius"), c.number("length"));
}

Outline outline_of_cone(const Section& shape)
{
    const Section& c = *only_section(shape, "cone");
    return cone_outline(c.number("radius"), c.number("height"));
}

PrimitiveSolid solid_of_cone(const Section& shape)
{
    const Section& c = *only_section(shape, "cone");
    return cone_solid(c.number("radius"), c.number("height"));
}

}   // namespace

const std::vector<Primitive>& io_internal::primitives()
{
    static const std::vector<Primitive> all{
        {Key{"box", types::vector3, "Edge lengths along d1, d2, d3.", "m"}.within(positive),
         [](double density, const Section& shape) { return box(density, shape.vector("box")); },
         [](const Section& shape) { return box_outline(shape.vector("box")); },
         [](const Section& shape) { return box_solid(shape.vector("box")); }},
        {Key{"sphere", types::number_or_table, "Radius, or a table with `radius`.", "m"}
             .within(positive)
             .holding({"sphere of shape", "", {length("radius", "Radius.")}}),
         [](double density, const Section& shape) { return sphere(density, radius_of_sphere(shape)); },
         [](const Section& shape) {
             const double r = radius_of_sphere(shape);
             return stretched(ball_outline(), {r, r, r});
         },
         [](const Section& shape) {
             const double r = radius_of_sphere(shape);
             return ellipsoid_solid({r, r, r});
         }},
        {Key{"cylinder", types::table, "Solid cylinder or tube."}.holding(
             {"cylinder of shape",
              "",
              {length("radius", "Outer radius."), length("length", "Length along d3."),
               Key{"inner_radius", types::number, "Inner radius of a tube.", "m", "0"}.within(
                   not_negative)}}),
         [](double density, const Section& shape) {
             const Section& c = *only_section(shape, "cylinder");
             return cylinder(density, c.number("radius"), c.number("length"), c.number("inner_radius"));
         },
         outline_of_cylinder, solid_of_cylinder},
        {Key{"capsule", types::table, "Cylinder with hemispherical ends."}.holding(
             {"capsule of shape",
              "",
              {length("radius", "Radius of the cylinder and of its hemispherical ends."),
               length("length", "Length of the cylindrical part, along d3.")}}),
         [](double density, const Section& shape) {
             const Section& c = *only_section(shape, "capsule");
             return capsule(density, c.number("radius"), c.number("length"));
         },
         outline_of_capsule, solid_of_capsule},
        {Key{"ellipsoid", types::vector3, "Semi-axes along d1, d2, d3.", "m"}.within(positive),
         [](double density, const Section& shape) { return ellipsoid(density, shape.vector("ellipsoid")); },
         [](const Section& shape) { return stretched(ball_outline(), shape.vector("ellipsoid")); },
         [](const Section& shape) { return ellipsoid_solid(shape.vector("ellipsoid")); }},
        {Key{"cone", types::table,
             "Solid cone with its apex toward +d3 and its origin at the centre of mass."}
             .holding({"cone of shape",
                       "",
                       {length("radius", "Radius of the base."),
                        length("height", "Height from base to apex, along d3.")}}),
         [](double density, const Section& shape) {
             const Section& c = *only_section(shape, "cone");
             return cone(density, c.number("radius"), c.number("height"));
         },
         outline_of_cone, solid_of_cone},
    };
    return all;
}

const Primitive* io_internal::find_primitive(std::string_view key)
{
    const auto found = std::ranges::find(primitives(), key, [](const Primitive& p) { return p.key.name; });
    return found == primitives().end() ? nullptr : &*found;
}

Outline ball_outline() { return capsule_outline(1, 0); }

}   // namespace livens
