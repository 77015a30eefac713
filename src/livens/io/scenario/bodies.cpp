// SPDX-License-Identifier: BSD-3-Clause
// [[body]], its shape, and where bodies are at both ends of time.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "livens/base/elementary.h"
#include "livens/base/text.h"
#include "livens/io/scenario/builder.h"

namespace livens {

namespace {

constexpr double quaternion_slack = 1e-6;   // | |q| - 1 |: more than printed digits lose

struct Shape {
    Key key;
    MassProperties (*make)(double density, const Section& shape);
    Outline (*outline)(const Section& shape);
};

/// From one angle above the equator to another, in rad, of radius 1 about a height.
std::vector<std::array<double, 2>> arc(double from, double to, double radius, double height)
{
    constexpr int steps = 6;   // a quarter of the way round has as many as the equator
    std::vector<std::array<double, 2>> points;
    for (int i = 0; i <= steps; ++i) {
        const auto [sine, cosine] = sine_cosine(from + (to - from) * i / steps);
        points.push_back({cosine > 1e-9 ? radius * cosine : 0, height + radius * sine});
    }
    return points;
}

Outline capsule_outline(double radius, double length)
{
    constexpr double pole = std::numbers::pi / 2;
    Outline outline{arc(-pole, 0, radius, -0.5 * length), 24, {1, 1, 1}};
    const auto upper = arc(0, pole, radius, 0.5 * length);
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

const std::vector<Shape>& shapes()
{
    static const std::vector<Shape> all{
        {Key{"box", types::vector3, "Edges along d1, d2, d3.", "m"}.within(positive),
         [](double density, const Section& shape) { return box(density, shape.vector("box")); },
         [](const Section& shape) { return box_outline(shape.vector("box")); }},
        {Key{"sphere", types::number_or_table, "Radius, or a table with it.", "m"}.within(positive).holding(
             {"sphere of shape", "", {length("radius", "Of the sphere.")}}),
         [](double density, const Section& shape) { return sphere(density, radius_of_sphere(shape)); },
         [](const Section& shape) {
             const double r = radius_of_sphere(shape);
             return stretched(ball_outline(), {r, r, r});
         }},
        {Key{"cylinder", types::table, "Solid or tube."}.holding(
             {"cylinder of shape",
              "",
              {length("radius", "Outer radius."), length("length", "Along d3."),
               Key{"inner_radius", types::number, "Of the bore of a tube.", "m", "0"}.within(not_negative)}}),
         [](double density, const Section& shape) {
             const Section& c = *only_section(shape, "cylinder");
             return cylinder(density, c.number("radius"), c.number("length"), c.number("inner_radius"));
         },
         [](const Section& shape) {
             const Section& c = *only_section(shape, "cylinder");
             return cylinder_outline(c.number("radius"), c.number("length"), c.number("inner_radius"));
         }},
        {Key{"capsule", types::table, "Cylinder between two half spheres."}.holding(
             {"capsule of shape",
              "",
              {length("radius", "Of cylinder and half spheres."),
               length("length", "Of the cylindrical part, along d3.")}}),
         [](double density, const Section& shape) {
             const Section& c = *only_section(shape, "capsule");
             return capsule(density, c.number("radius"), c.number("length"));
         },
         [](const Section& shape) {
             const Section& c = *only_section(shape, "capsule");
             return capsule_outline(c.number("radius"), c.number("length"));
         }},
        {Key{"ellipsoid", types::vector3, "Semi-axes along d1, d2, d3.", "m"}.within(positive),
         [](double density, const Section& shape) { return ellipsoid(density, shape.vector("ellipsoid")); },
         [](const Section& shape) { return stretched(ball_outline(), shape.vector("ellipsoid")); }},
        {Key{"cone", types::table, "Solid cone, apex along +d3, origin at its centre of mass."}.holding(
             {"cone of shape",
              "",
              {length("radius", "Of the base."), length("height", "From base to apex, along d3.")}}),
         [](double density, const Section& shape) {
             const Section& c = *only_section(shape, "cone");
             return cone(density, c.number("radius"), c.number("height"));
         },
         [](const Section& shape) {
             const Section& c = *only_section(shape, "cone");
             return cone_outline(c.number("radius"), c.number("height"));
         }},
        {Key{"point", types::flag, "A point mass: no orientation, no inertia; needs `mass`."}, nullptr,
         nullptr},
        {Key{"mesh", types::later, "A solid bounded by triangles."}, nullptr, nullptr}};
    return all;
}

/// Keys of the start and of the end alike.
std::vector<Key> pose_keys()
{
    std::vector<Key> keys{
        {"position", types::vector3, "Of the reference point, in the world.", "m", "[0, 0, 0]"}};
    for (const Key& key : orientation_keys()) keys.push_back(key);
    keys.push_back({"velocity", types::vector3, "Of the reference point, world axes.", "m/s", "[0, 0, 0]"});
    keys.push_back({"angular_velocity", types::vector3, "World axes.", "rad/s"});
    keys.push_back({"angular_velocity_body", types::vector3, "Body axes.", "rad/s"});
    return keys;
}

bool is_point_mass(const Section& body)
{
    const Section* shape = only_section(body, "shape");
    return shape != nullptr && shape->has("point");
}

bool check_shape(const Section& body)
{
    const Section* shape = only_section(body, "shape");
    if (shape == nullptr) return true;
    const std::vector<Value>& given = shape->values();
    if (given.size() > 1)
        return shape->at_most_one({given[0].key->name, given[1].key->name}, "shape");
    if (!shape->is_valid()) return false;   // told already
    if (given.empty()) {
        std::string known;
        for (const Shape& s : shapes())
            if (s.key.type != types::later)
                known += (known.empty() ? "give one of " : ", ") + std::string(s.key.name);
        return shape->error("", "shape", shape->label() + " is empty", {"", known});
    }
    const Section* tube = only_section(*shape, "cylinder");
    return tube == nullptr || tube->number("inner_radius") < tube->number("radius") ||
           tube->error("inner_radius", "size-inner-radius",
                       "'inner_radius' of " + tube->label() + " must be smaller than its radius");
}

void check_point_mass(const Section& body)
{
    body.refuse({"density", "center_of_mass", "inertia", "directors", "quaternion", "rotation_vector",
                 "angular_velocity", "angular_velocity_body", "director_rates"},
                "point-mass", "a point mass has a mass, a position and a velocity, nothing else");
    if (!body.has("mass"))
        body.error("shape", "mass-missing", body.label() + " is a point mass without 'mass'");
}

/// Mass and inertia must follow from exactly one set of keys.
void check_mass(const Section& body)
{
    if (body.has("shape")) {
        body.at_most_one({"density", "mass"}, "mass-conflict");
        body.refuse({"inertia"}, "mass-conflict", "it follows from the shape");
        if (!body.has("density") && !body.has("mass"))
            body.error("shape", "mass-missing",
                       body.label() + " has a shape, but neither 'density' nor 'mass'");
        return;
    }
    body.refuse({"density"}, "mass-conflict", "the body has no shape");
    for (const std::string key : {"mass", "inertia"})
        if (!body.has(key))
            body.error("", "mass-missing", body.label() + " has no shape and no '" + key + "'",
                       {"without a shape a body needs both 'mass' and 'inertia'",
                        "add 'shape' with 'density' or 'mass', or 'mass' and 'inertia'"});
}

bool check_quaternion(const Section& body)
{
    const Value* given = body.find("quaternion");
    if (given == nullptr) return true;
    const std::vector<double>& q = given->numbers;
    const double size = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    if (std::abs(size - 1) <= quaternion_slack) return true;
    std::string help;
    if (size > 0 && std::isfinite(size)) {
        for (const double x : q)
            help += (help.empty() ? "to keep its direction write [" : ", ") + to_text(x / size);
        help += "]";
    }
    return body.error("quaternion", "quaternion-norm",
                      "the quaternion of " + body.label() + " has norm " + to_text(size) + ", not 1",
                      {"rotations are quaternions (w, x, y, z) of norm 1", help});
}

bool check_body(const Section& body, Findings& findings)
{
    const int before = findings.n_errors();
    check_name(body);
    check_shape(body);
    if (is_point_mass(body)) check_point_mass(body);
    else check_mass(body);
    check_pose(body);
    return findings.n_errors() == before && body.is_valid();
}

const Shape& shape_of(const Section& shape)
{
    const std::string_view word = shape.values().front().key->name;
    return *std::ranges::find(shapes(), word, [](const Shape& s) { return s.key.name; });
}

Outline read_outline(const Section& body)
{
    const Section* shape = only_section(body, "shape");
    return shape == nullptr || is_point_mass(body) ? Outline{} : shape_of(*shape).outline(*shape);
}

MassProperties read_mass(const Section& body)
{
    const Vector3 center = body.vector("center_of_mass");
    if (const Section* shape = only_section(body, "shape")) {
        const MassProperties solid =
            shape_of(*shape).make(body.has("density") ? body.number("density") : 1, *shape);
        return with_center(body.has("mass") ? with_mass(solid, body.number("mass")) : solid, center);
    }
    MassProperties properties{body.number("mass"), center, {}};
    if (body.find("inertia")->n_rows == 1)
        for (int i = 0; i < 3; ++i) properties.inertia(i, i) = body.vector("inertia")[i];
    else properties.inertia = body.columns("inertia");   // rows or columns: it must be symmetric
    return properties;
}

Body build_body(const Section& section, const std::string& name)
{
    const Placement placement = read_placement(section);
    if (is_point_mass(section))
        return point_mass(name, section.number("mass"), placement.position, placement.velocity);
    Body body = rigid_body(name, read_mass(section), placement);
    if (section.has("director_rates"))
        for (int i = 0; i < 3; ++i) body.V.set_column(i + 1, section.row("director_rates", i));
    return body;
}

}   // namespace

Outline ball_outline() { return capsule_outline(1, 0); }

Table body_table()
{
    Table shape{"shape of [[body]]", "Exactly one of these. Axes of revolution lie along d3.", {}};
    for (const Shape& s : shapes()) shape.keys.push_back(s.key);
    Table end{"[body.end]",
              "The body at the end of time, below its `[[body]]`; needed for all bodies if `given` of "
              "`[end]` is not `nothing`. Momenta are those of the positions and velocities stated here.",
              pose_keys()};
    Table body{
        "[[body]]",
        "A rigid body or a point mass. Body coordinates have their origin at the reference point and their "
        "axes along the three directors. Mass comes from `shape` with `density` or `mass`, or from `mass` "
        "and `inertia` without a shape. Orientation is given by one of `directors`, `quaternion`, "
        "`rotation_vector`; without any the axes are those of the world. Position, orientation and "
        "velocities are those at the start.",
        {Key{"name", types::text, "How joints, loads and results call the body; not `world`."}.needed(),
         Key{"shape", types::table, "Solid of constant density, for mass and inertia."}.holding(shape),
         Key{"density", types::number, "Of the shape; instead of `mass`.", "kg/m^3"}.within(positive),
         Key{"mass", types::number, "Of the body; instead of `density`.", "kg"}.within(positive),
         Key{"center_of_mass", types::vector3,
             "In body coordinates. With a shape: where its centre of mass lies.", "m", "[0, 0, 0]"},
         Key{"inertia", types::principal_or_full,
             "About the centre of mass, in body axes: three principal moments or the matrix. Without a shape "
             "only.",
             "kg m^2"},
         Key{"director_rates", types::triple,
             "Time derivatives of the directors, [d1', d2', d3'], as they are. Rates that deform the triad "
             "need `initial = \"project\"`.",
             "1/s"},
         Key{"end", types::table, "The body at the end of time."}.holding(end)}};
    body.keys.insert(body.keys.begin() + 6, end.keys.begin(), end.keys.end());
    return body;
}

std::vector<Key> orientation_keys()
{
    return {{"directors", types::triple,
             "Axes of the body or frame, [d1, d2, d3], each in those of the world or "
             "body."},
            {"quaternion", types::vector4, "Orientation (w, x, y, z) in the world or body, of norm 1."},
            {"rotation_vector", types::vector3, "Orientation: axis times angle.", "rad"}};
}

bool check_orientation(const Section& section)
{
    const bool is_one =
        section.at_most_one({"directors", "quaternion", "rotation_vector"}, "orientation-conflict");
    return check_quaternion(section) && is_one;
}

Matrix3 read_orientation(const Section& body)
{
    if (body.has("directors")) return body.columns("directors");
    if (const Value* q = body.find("quaternion"))
        return directors_from_quaternion({q->numbers[0], q->numbers[1], q->numbers[2], q->numbers[3]});
    if (body.has("rotation_vector")) return directors_from_rotation_vector(body.vector("rotation_vector"));
    return identity<3>();
}

bool check_pose(const Section& body)
{
    const bool is_one_spin = body.at_most_one({"angular_velocity", "angular_velocity_body", "director_rates"},
                                              "rates-conflict");
    return check_orientation(body) && is_one_spin;
}

Placement read_placement(const Section& body)
{
    Placement placement;
    placement.position = body.vector("position");
    placement.velocity = body.vector("velocity");
    placement.directors = read_orientation(body);
    placement.angular_velocity = body.has("angular_velocity_body")
                                     ? placement.directors * body.vector("angular_velocity_body")
                                     : body.vector("angular_velocity");
    return placement;
}

void read_bodies(Builder& builder)
{
    std::unordered_set<std::string> taken;
    for (const Section& section : builder.top().sections("body")) {
        const bool is_good = check_body(section, builder.findings());
        const Value* named = section.find("name");
        if (named == nullptr || !claim_name(section, "body", named->text, taken,
                                            {"joints, loads and results refer to bodies by name",
                                             "rename one of them"}))
            continue;
        BodyReference& body = builder.bodies()[named->text];
        const std::string path = "body[" + named->text + "]";
        builder.remember(path, section);
        body.is_usable = is_good && builder.guard(path, [&] {
            body.index = builder.model().add_body(build_body(section, named->text));
            builder.outlines().push_back(read_outline(section));
        });
    }
    builder.close_bodies();
}

}   // namespace livens
