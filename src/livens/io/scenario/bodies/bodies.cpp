// SPDX-License-Identifier: BSD-3-Clause
// [[body]], its shape, and where bodies are at both ends of time.
// A body is stated by mass, centre and inertia, by a shape, or by the paper's $M$, $S$, $E$ of (P7)
// (theory.md, Bodies without rotation parameters). All become one 4 x 4 matrix and a first configuration.
#include <algorithm>
#include <cmath>

#include "livens/base/text.h"
#include "livens/io/scenario/bodies/bodies.h"
#include "livens/io/scenario/bodies/shapes.h"
#include "livens/io/scenario/bodies/visuals.h"

namespace livens::inline io_internal {

namespace {

constexpr double quaternion_slack = 1e-6;   // | |q| - 1 |: more than printed digits lose
constexpr double symmetry_slack = 1e-12;    // of the size of a matrix: what rounding loses

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

/// The paper's M, S, E.
bool has_moments(const Section& body) { return body.has("first_moment") || body.has("second_moment"); }

void check_moments(const Section& body)
{
    body.refuse({"shape", "density", "center_of_mass", "inertia"}, "mass-conflict",
                "'first_moment' and 'second_moment' say it already");
    for (const std::string key : {"mass", "first_moment", "second_moment"})
        if (!body.has(key))
            body.error("", "mass-missing", body.label() + " has no '" + key + "'",
                       {"give M, S and E together: 'mass', 'first_moment' and 'second_moment'", ""});
    const Value* E = body.find("second_moment");
    if (E == nullptr || E->n_rows != 3) return;
    const Matrix3 m = body.columns("second_moment");
    // The inequality is |E - E^T| <= 1e-12 |E|: one digit mistyped in one half fails it.
    if (norm(m - transpose(m)) > symmetry_slack * norm(m))
        body.error("second_moment", "inertia-not-symmetric",
                   "'second_moment' of " + body.label() + " must be symmetric");
}

/// Of a body whose shape says how it looks, and `mass` and `inertia` how it moves. Parts of it that may weigh
/// differently would say the mass a second time.
void check_shape_beside_inertia(const Section& body)
{
    const Section* shape = only_section(body, "shape");
    body.refuse({"density"}, "mass-conflict", "'mass' and 'inertia' are stated");
    if (shape != nullptr && density_by(*shape) != DensityBy::body)
        body.error("inertia", "mass-conflict",
                   "'inertia' of " + body.label() + " has no meaning: its shape has a density of its own",
                   {"a shape beside 'inertia' has no effect on mass and inertia",
                    "leave out 'inertia', or the densities of the shape"});
    if (!body.has("mass"))
        body.error("inertia", "mass-missing", body.label() + " has an inertia, but no 'mass'",
                   {"beside 'inertia' a shape has no effect on mass and inertia", "add mass = 3 (kg)"});
    // A mesh has a centre of mass of its own: that of the body would move away from it without a word.
    if (shape != nullptr && (shape->has("mesh") || shape->has("parts")) && !body.has("center_of_mass"))
        body.error("inertia", "mass-missing",
                   body.label() + " has a shape beside its inertia, but no 'center_of_mass'",
                   {"beside 'inertia' the shape stays in its own coordinates and does not say where the "
                    "centre of mass is",
                    "add center_of_mass = [..], in m, in the coordinates of the shape"});
}

void check_density(const Section& body)
{
    body.at_most_one({"density", "mass"}, "mass-conflict");
    const Section* shape = only_section(body, "shape");
    const DensityBy by = shape != nullptr ? density_by(*shape) : DensityBy::body;
    if (by == DensityBy::shape)
        body.refuse({"density", "mass"}, "mass-conflict",
                    shape->has("densities") ? "the regions of the mesh have their own densities"
                                            : "'density_field' of the shape gives it already");
    else if (by == DensityBy::both && body.has("mass"))
        body.refuse({"mass"}, "mass-conflict", "'density_field' says what parts weigh");
    else if (by == DensityBy::both && !body.has("density"))
        body.error("shape", "mass-missing",
                   body.label() + " has no 'density', and parts of its shape have no 'density_field'");
    else if (!body.has("density") && !body.has("mass"))
        body.error("shape", "mass-missing", body.label() + " has a shape, but neither 'density' nor 'mass'",
                   {"", "give one of them: density = 7850 (kg/m^3, steel) or mass = 3 (kg)"});
}

/// Mass and inertia must follow from exactly one set of keys.
void check_mass(const Section& body)
{
    if (has_moments(body)) return check_moments(body);
    if (body.has("shape"))
        return body.has("inertia") ? check_shape_beside_inertia(body) : check_density(body);
    body.refuse({"density"}, "mass-conflict", "the body has no shape");
    for (const std::string key : {"mass", "inertia"})
        if (!body.has(key))
            body.error("", "mass-missing", body.label() + " has no shape and no '" + key + "'",
                       {"without a shape a body needs both 'mass' and 'inertia'",
                        "add 'shape' with 'density' or 'mass', 'shape = { point = true }' for a point mass, "
                        "or 'mass' and 'inertia'"});
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

/// A matrix, or its diagonal.
Matrix3 read_symmetric(const Section& body, const char* key)
{
    if (body.find(key)->n_rows != 1) return body.columns(key);   // rows or columns: it must be symmetric
    Matrix3 m{};
    for (int i = 0; i < 3; ++i) m(i, i) = body.vector(key)[i];
    return m;
}

Matrix4 read_moments(const Section& body)
{
    Matrix4 m{};
    m(0, 0) = body.number("mass");
    const Vector3 S = body.vector("first_moment");
    const Matrix3 E = read_symmetric(body, "second_moment");
    for (int i = 0; i < 3; ++i) {
        m(0, i + 1) = m(i + 1, 0) = S[i];
        for (int j = 0; j < 3; ++j) m(i + 1, j + 1) = 0.5 * (E(i, j) + E(j, i));
    }
    return m;
}

MassProperties read_mass(const Section& body, const Solid& shape)
{
    if (!body.has("inertia")) {
        const MassProperties all =
            body.has("mass") ? with_mass(shape.properties, body.number("mass")) : shape.properties;
        return shape.has_own_origin && !body.has("center_of_mass")
                   ? all
                   : with_center(all, body.vector("center_of_mass"));
    }
    return {body.number("mass"), body.vector("center_of_mass"), read_symmetric(body, "inertia")};
}

/// From the shape's own coordinates to those of the body.
Vector3 shift_of_shape(const Section& body, const Solid& shape)
{
    const bool stays = body.has("inertia") && shape.has_own_origin;
    return stays || !body.has("center_of_mass")
               ? Vector3{}
               : body.vector("center_of_mass") - shape.properties.center_of_mass;
}

/// Surfaces are computed in the shape's own coordinates, and move with its centre.
std::vector<NamedSurface> surfaces_in_body(const Section& body, const Solid& shape)
{
    std::vector<NamedSurface> surfaces = shape.surfaces;
    const Vector3 d = shift_of_shape(body, shape);
    if (d != Vector3{})
        for (NamedSurface& s : surfaces) s.moments = moved(s.moments, identity<3>(), d);
    return surfaces;
}

/// Likewise, and with the body's mass where that is stated. What the parts weigh is unknown beside `inertia`.
std::vector<ShapePart> parts_in_body(const Section& body, const Solid& shape)
{
    if (body.has("inertia")) return {};
    std::vector<ShapePart> parts = shape.parts;
    for (ShapePart& part : parts) {
        if (body.has("mass")) part.mass *= body.number("mass") / shape.properties.mass;
        part.center += shift_of_shape(body, shape);
    }
    return parts;
}

/// Outlines are drawn about the body's centre of mass, and those of shapes about their own.
Outline outline_in_body(const Section& body, const Solid& shape)
{
    if (!body.has("inertia") || !shape.has_own_origin) return shape.outline;
    const Vector3 d = shape.properties.center_of_mass - body.vector("center_of_mass");
    Outline whole;
    whole.parts = shape.outline.parts.empty() ? std::vector{shape.outline} : shape.outline.parts;
    for (Outline& part : whole.parts) part.place += d;
    return whole;
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
              "is not "
              "`nothing`. Prescribed momenta are computed from these positions and velocities.",
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
