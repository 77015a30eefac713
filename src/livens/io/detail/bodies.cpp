#include <array>
#include <cmath>

#include "livens/io/detail/builder.h"
#include "livens/io/json.h"

namespace livens {

namespace {

constexpr double quaternion_slack = 1e-6;   // | |q| - 1 |: more than printed digits lose

bool is_point_mass(const Section& body)
{
    const std::span<const Section> shape = body.sections("shape");
    return !shape.empty() && shape.front().has("point");
}

bool check_shape(const Section& body, Findings& findings)
{
    const std::span<const Section> shapes = body.sections("shape");
    if (shapes.empty()) return true;
    const Section& shape = shapes.front();
    if (!at_most_one(shape, {"box", "sphere", "cylinder", "capsule", "ellipsoid", "cone", "point"}, "shape",
                     findings))
        return false;
    if (!shape.is_valid()) return false;   // told already
    if (shape.values().empty()) {
        findings.error(shape.place(), "shape", shape.label() + " is empty",
                       {"", "give one of box, sphere, cylinder, capsule, ellipsoid, cone, point"});
        return false;
    }
    for (const Section& tube : shape.sections("cylinder"))
        if (tube.number("inner_radius") >= tube.number("radius")) {
            findings.error(tube.place("inner_radius"), "size-inner-radius",
                           "'inner_radius' of " + tube.label() + " must be smaller than its radius");
            return false;
        }
    return true;
}

bool check_point_mass(const Section& body, Findings& findings)
{
    bool is_clean = refuse_keys(
        body,
        {"density", "center_of_mass", "inertia", "directors", "quaternion", "rotation_vector",
         "angular_velocity", "angular_velocity_body", "director_rates"},
        "point-mass", "a point mass has a mass, a position and a velocity, nothing else", findings);
    if (!body.has("mass")) {
        findings.error(body.place("shape"), "mass-missing", body.label() + " is a point mass without 'mass'");
        is_clean = false;
    }
    return is_clean;
}

/// Mass and inertia must follow from exactly one set of keys.
bool check_mass(const Section& body, Findings& findings)
{
    if (body.has("shape")) {
        bool is_clean = at_most_one(body, {"density", "mass"}, "mass-conflict", findings);
        is_clean = refuse_keys(body, {"inertia"}, "mass-conflict", "it follows from the shape", findings) &&
                   is_clean;
        if (body.has("density") || body.has("mass")) return is_clean;
        findings.error(body.place("shape"), "mass-missing",
                       body.label() + " has a shape, but neither 'density' nor 'mass'");
        return false;
    }
    bool is_clean = refuse_keys(body, {"density"}, "mass-conflict", "the body has no shape", findings);
    for (const std::string key : {"mass", "inertia"}) {
        if (body.has(key)) continue;
        findings.error(body.place(), "mass-missing", body.label() + " has no shape and no '" + key + "'",
                       {"without a shape a body needs both 'mass' and 'inertia'",
                        "add 'shape' with 'density' or 'mass', or 'mass' and 'inertia'"});
        is_clean = false;
    }
    return is_clean;
}

bool check_quaternion(const Section& body, Findings& findings)
{
    const Value* q = body.find("quaternion");
    if (q == nullptr) return true;
    const double size = std::hypot(std::hypot(q->numbers[0], q->numbers[1]),
                                   std::hypot(q->numbers[2], q->numbers[3]));
    if (std::abs(size - 1) <= quaternion_slack) return true;
    std::string help;
    if (size > 0 && std::isfinite(size)) {
        help = "to keep its direction write [";
        for (int i = 0; i < 4; ++i)
            help += (i > 0 ? ", " : "") + to_text(q->numbers[static_cast<std::size_t>(i)] / size);
        help += "]";
    }
    findings.error(body.place("quaternion"), "quaternion-norm",
                   "the quaternion of " + body.label() + " has norm " + to_text(size) + ", not 1",
                   {"rotations are quaternions (w, x, y, z) of norm 1", help});
    return false;
}

bool check_body(const Section& body, Findings& findings)
{
    const int before = findings.n_errors();
    check_name(body, findings);
    check_shape(body, findings);
    if (is_point_mass(body)) check_point_mass(body, findings);
    else check_mass(body, findings);
    check_pose(body, findings);
    return findings.n_errors() == before && body.is_valid();
}

MassProperties shape_properties(const Section& shape, double density)
{
    if (shape.has("box")) return box(density, shape.vector("box"));
    if (shape.has("ellipsoid")) return ellipsoid(density, shape.vector("ellipsoid"));
    if (shape.has("sphere")) {
        const std::span<const Section> s = shape.sections("sphere");
        return sphere(density, s.empty() ? shape.number("sphere") : s.front().number("radius"));
    }
    if (shape.has("cone")) {
        const Section& c = shape.sections("cone").front();
        return cone(density, c.number("radius"), c.number("height"));
    }
    if (shape.has("capsule")) {
        const Section& c = shape.sections("capsule").front();
        return capsule(density, c.number("radius"), c.number("length"));
    }
    const Section& c = shape.sections("cylinder").front();
    return cylinder(density, c.number("radius"), c.number("length"), c.number("inner_radius"));
}

MassProperties read_mass(const Section& body)
{
    if (body.has("shape")) {
        const Section& shape = body.sections("shape").front();
        const MassProperties solid = shape_properties(shape,
                                                      body.has("density") ? body.number("density") : 1);
        const Vector3 center = body.vector("center_of_mass");
        return with_center(body.has("mass") ? with_mass(solid, body.number("mass")) : solid, center);
    }
    MassProperties properties{body.number("mass"), body.vector("center_of_mass"), {}};
    const Value* inertia = body.find("inertia");
    if (inertia->n_rows == 1)
        for (int i = 0; i < 3; ++i) properties.inertia(i, i) = inertia->numbers[static_cast<std::size_t>(i)];
    else properties.inertia = body.columns("inertia");   // rows or columns: it must be symmetric
    return properties;
}

Matrix3 read_orientation(const Section& body)
{
    if (body.has("directors")) return body.columns("directors");
    if (const Value* q = body.find("quaternion"))
        return directors_from_quaternion({q->numbers[0], q->numbers[1], q->numbers[2], q->numbers[3]});
    if (body.has("rotation_vector")) return directors_from_rotation_vector(body.vector("rotation_vector"));
    return identity<3>();
}

Body build_body(const Section& section, const std::string& name)
{
    const Placement placement = read_placement(section);
    if (is_point_mass(section))
        return point_mass(name, section.number("mass"), placement.position, placement.velocity);
    Body body = rigid_body(name, read_mass(section), placement);
    if (section.has("director_rates")) {
        const Matrix3 rates = section.columns("director_rates");
        for (int i = 0; i < 3; ++i) body.V.set_column(i + 1, rates.column(i));
    }
    return body;
}

}   // namespace

bool check_pose(const Section& body, Findings& findings)
{
    const int before = findings.n_errors();
    at_most_one(body, {"directors", "quaternion", "rotation_vector"}, "orientation-conflict", findings);
    at_most_one(body, {"angular_velocity", "angular_velocity_body", "director_rates"}, "rates-conflict",
                findings);
    check_quaternion(body, findings);
    return findings.n_errors() == before;
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
    Findings& findings = builder.findings();
    for (const Section& section : builder.top().sections("body")) {
        const bool is_good = check_body(section, findings);
        const Value* named = section.find("name");
        if (named == nullptr) continue;
        const std::string& name = named->text;
        if (builder.bodies().count(name) > 0) {
            findings.error(named->node->place, "name-duplicate",
                           "a body called '" + name + "' exists already",
                           {"joints, loads and results refer to bodies by name", "rename one of them"});
            continue;
        }
        DeclaredBody& declared = builder.bodies()[name];
        const std::string path = "body[" + name + "]";
        builder.remember(path, section);
        declared.is_built = is_good && builder.guard(path, [&] {
            declared.index = builder.model().add_body(build_body(section, name));
        });
    }
    builder.close_bodies();
}

}   // namespace livens
