// SPDX-License-Identifier: BSD-3-Clause
// [[body]], its shape, and where bodies are at both ends of time.
// A body is stated by mass, centre and inertia, by a shape, or by the paper's $M$, $S$, $E$ of (P7)
// (theory.md, Bodies without rotation parameters). All become one 4 x 4 matrix and a first configuration.
#include <algorithm>
#include <cmath>

#include "livens/base/text.h"
#include "livens/io/scenario/bodies/bodies.h"
#include "livens/io/scenario/bodies/body_mass.h"
#include "livens/io/scenario/bodies/visuals.h"

namespace livens::inline io_internal {

namespace {

constexpr double quaternion_slack = 1e-6;   // | |q| - 1 |: more than printed digits lose

/// Keys of a body as it is stated, at the start and at the end alike.
std::vector<Key> pose_keys(std::string_view otherwise)
{
    std::vector<Key> keys{
        {"position", types::vector3, "Position of the reference point in the world.", "m", otherwise}};
    for (const Key& key : orientation_keys()) keys.push_back(key);
    keys.push_back(
        {"velocity", types::vector3, "Velocity of the reference point, world axes.", "m/s", otherwise});
    keys.push_back({"angular_velocity", types::vector3, "Angular velocity, world axes.", "rad/s"});
    keys.push_back({"angular_velocity_body", types::vector3, "Angular velocity, body axes.", "rad/s"});
    return keys;
}

void check_point_mass(const Section& body)
{
    body.refuse({"density", "center_of_mass", "inertia", "first_moment", "second_moment", "directors",
                 "quaternion", "rotation_vector", "angular_velocity", "angular_velocity_body",
                 "director_rates"},
                "point-mass", "a point mass has a mass, a position and a velocity, nothing else");
    if (!body.has("mass"))
        body.error("shape", "mass-missing", body.label() + " is a point mass without 'mass'");
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
        // The help is the quaternion divided by its norm, ready to be copied.
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
    if (const Section* shape = only_section(body, "shape")) check_shape(*shape);
    if (is_point_mass(body))
        check_point_mass(body);
    else
        check_mass(body);
    check_pose(body);
    check_look(body);
    return findings.n_errors() == before && body.is_valid();
}

/// Directors that are skew by so little were meant perpendicular, and rounded.
void warn_of_rounded_directors(Builder& builder, const Section& body)
{
    if (!has_moments(body) || !body.has("directors")) return;
    const double gap = skewness(body.columns("directors"));
    // Below 1e-10 the gap is rounding, above 1e-3 the triad was meant skew.
    if (gap <= 1e-10 || gap > 1e-3) return;
    builder.findings().warning(
        body.place("directors"), "directors-nearly-orthonormal",
        "the directors of " + body.label() + " are perpendicular unit vectors but for " + to_text(gap, 2),
        {"they are taken as they are, with 'first_moment' and 'second_moment' in components along them",
         "give more digits, or a quaternion"});
}

Body build_body(const Section& section, const std::string& name, const Solid& shape)
{
    const Placement placement = read_placement(section);
    if (is_point_mass(section))
        return point_mass(name, section.number("mass"), placement.position, placement.velocity);
    Body body = has_moments(section) ? skew_body(name, read_moments(section), placement)
                                     : rigid_body(name, read_mass(section, shape), placement);
    body.volume = shape.volume;
    if (section.has("director_rates")) {
        // The model keeps the rates of the orthonormal triad, those of the directors times U^-1 (Skew
        // directors).
        const Matrix3 rates = section.columns("director_rates") * inverse(body.stretch);
        for (int i = 0; i < 3; ++i) body.V.set_column(i + 1, rates.column(i));
    }
    return body;
}

Table placement_at_start()
{
    return {
        "[body.start]",
        "Placement at the initial time, if it differs from `[[body]]`; the table follows its `[[body]]`. "
        "Keys left out keep their values from `[[body]]`. Joints, `at`, default rod lengths and the zero of "
        "joint coordinates still refer to the placement in `[[body]]`. Joint angles change to the new "
        "placement by the shorter way, less than half a turn; `[[start.coordinates]]` applies afterwards.",
        pose_keys({})};
}

}   // namespace

Table body_table()
{
    Table end{"[body.end]",
              "Placement at the final time, below its `[[body]]`. Every body needs one if `given` of `[end]` "
              "is not `nothing`. Keys left out are zero, and an orientation that is left out is that of the "
              "world axes, not that of `[[body]]`. Prescribed momenta are computed from these positions and "
              "velocities.",
              pose_keys("[0, 0, 0]")};
    Table body{
        "[[body]]",
        "A rigid body or a point mass. The body frame has its origin at the reference point and its axes "
        "along the three directors d1, d2, d3; body coordinates are coordinates in this frame. Mass "
        "properties come either from a `shape` with `density` or `mass`, or from `mass` and `inertia`; a "
        "`shape` beside `inertia` is drawn and gives surfaces for loads. Orientation is given by one of "
        "`directors`, `quaternion` and `rotation_vector`; by "
        "default the body axes are the world axes. Position, orientation and velocities are initial values.",
        {Key{"name", types::text, "Name by which joints, loads and results refer to the body; not `world`."}
             .needed(),
         Key{"shape", types::table, "Solid from which mass and inertia are computed."}.holding(shape_table()),
         Key{"density", types::number, "Density of the shape. Excludes `mass`.", "kg/m^3"}.within(positive),
         Key{"mass", types::number, "Mass of the body. Excludes `density`.", "kg"}.within(positive),
         Key{"center_of_mass", types::vector3,
             "Centre of mass in body coordinates. A shape is moved so that its centre of mass lies here; "
             "without this key, or beside `inertia`, meshes and unions keep their own coordinates.",
             "m", "[0, 0, 0]"},
         Key{"inertia", types::principal_or_full,
             "Inertia about the centre of mass, in body axes: three principal moments or the full matrix. "
             "Needs `mass`, and beside a mesh or union `center_of_mass`.",
             "kg m^2"},
         {"first_moment", types::vector3,
          "First moment of mass S: mass times the position of the centre of mass relative to the reference "
          "point, in body coordinates. Given together with `mass` (M) and `second_moment` (E), instead of a "
          "shape or `inertia`.",
          "kg m"},
         {"second_moment", types::principal_or_full,
          "Second moment of mass E about the reference point: the integral of density times x x^T, as a "
          "matrix or its diagonal. It is not the inertia tensor, which is tr(E) I - E. With this key the "
          "directors may be oblique and of any length: body coordinates are then components along the "
          "directors, but axes of frames are given along the nearest orthonormal triad.",
          "kg m^2"},
         Key{"director_rates", types::triple,
             "Time derivatives of the directors, [d1', d2', d3'], used as given. Rates that deform the triad "
             "need `initial = \"project\"`.",
             "1/s"},
         visual_key("Appearance of the body, independent of its mass: one shape or a list of shapes, drawn "
                    "instead of `shape`."),
         Key{"start", types::table, "Placement at the initial time, if it differs from the one given here."}
             .holding(placement_at_start()),
         Key{"end", types::table, "Placement at the final time."}.holding(end)}};
    for (const Key& key : color_keys("Colour in pictures: a CSS colour name, `\"#rrggbb\"`, or red, green "
                                     "and blue. Default: a colour that no other body has.",
                                     "Opacity in pictures. Default: 1, opaque."))
        body.keys.push_back(key);
    body.keys.insert(body.keys.begin() + 6, end.keys.begin(), end.keys.end());
    return body;
}

std::vector<Key> orientation_keys()
{
    return {{"directors", types::triple,
             "Orientation as three axis vectors [d1, d2, d3], in world coordinates (of a frame, part or "
             "visual: in body coordinates)."},
            {"quaternion", types::vector4,
             "Orientation as a unit quaternion (w, x, y, z): it rotates the axes of the body into world axes "
             "(of a frame, part or visual: its axes into body axes)."},
            {"rotation_vector", types::vector3, "Orientation as a rotation vector: unit axis times angle.",
             "rad"}};
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
    const bool is_one_spin =
        body.at_most_one({"angular_velocity", "angular_velocity_body", "director_rates"}, "rates-conflict");
    return check_orientation(body) && is_one_spin;
}

Placement read_placement(const Section& body, const Matrix3& stretch)
{
    Placement placement;
    placement.position = body.vector("position");
    placement.velocity = body.vector("velocity");
    placement.directors = read_orientation(body);
    // Rotations turn the orthonormal triad; the skew directors are that triad times their stretch U.
    if (!body.has("directors")) placement.directors = placement.directors * stretch;
    placement.angular_velocity = body.has("angular_velocity_body")
                                     ? placement.directors * body.vector("angular_velocity_body")
                                     : body.vector("angular_velocity");
    return placement;
}

bool has_surface_loads(const Section& top)
{
    return std::ranges::any_of(top.sections("load"),
                               [](const Section& load) { return load.takes("surface"); });
}

void read_bodies(Builder& builder, bool with_surfaces)
{
    std::unordered_set<std::string> taken;
    for (const Section& section : builder.top().sections("body")) {
        const bool is_good = check_body(section, builder.findings());
        const Value* named = section.find("name");
        if (named == nullptr ||
            !claim_name(section, "body", named->text, taken,
                        {"joints, loads and results refer to bodies by name", "rename one of them"}))
            continue;
        BodyReference& body = builder.bodies()[named->text];
        const std::string path = "body[" + named->text + "]";
        builder.remember(path, section);
        body.is_usable = is_good && builder.guard(path, [&] {
            const Solid shape = read_shape(section, builder.meshes(), with_surfaces);
            body.index = builder.model().add_body(build_body(section, named->text, shape));
            warn_of_rounded_directors(builder, section);
            Outline outline = outline_in_body(section, shape);
            read_look(section, builder.meshes(), outline);
            builder.outlines().push_back(std::move(outline));
            builder.parts().push_back(parts_in_body(section, shape));
            builder.surfaces().push_back(surfaces_in_body(section, shape));
        });
    }
}

void read_world(Builder& builder)
{
    Outline world;
    if (const Section* ground = only_section(builder.top(), "world");
        ground != nullptr && check_look(*ground))
        read_look(*ground, builder.meshes(), world);
    builder.outlines().push_back(std::move(world));
}

}   // namespace livens::inline io_internal
