// SPDX-License-Identifier: BSD-3-Clause
// Mass and inertia of a body: of its shape; as they are given, when a shape is only looked at; or by the
// paper's M, S, E of (P7).
#include "livens/io/scenario/bodies/body_mass.h"

#include "livens/base/text.h"

namespace livens {

namespace {

constexpr double symmetry_slack = 1e-12;   // of the size of a matrix: what rounding loses

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
    body.refuse({"density"}, "mass-conflict", "'mass' and 'inertia' are given");
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

/// A matrix, or its diagonal.
Matrix3 read_symmetric(const Section& body, const char* key)
{
    if (body.find(key)->n_rows != 1) return body.columns(key);   // rows or columns: it must be symmetric
    Matrix3 m{};
    for (int i = 0; i < 3; ++i) m(i, i) = body.vector(key)[i];
    return m;
}

/// From the shape's own coordinates to those of the body.
Vector3 shift_of_shape(const Section& body, const Solid& shape)
{
    const bool stays = body.has("inertia") && shape.has_own_origin;
    return stays || !body.has("center_of_mass")
               ? Vector3{}
               : body.vector("center_of_mass") - shape.properties.center_of_mass;
}

}   // namespace

bool io_internal::has_moments(const Section& body)
{
    return body.has("first_moment") || body.has("second_moment");
}

void io_internal::check_mass(const Section& body)
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

/// (M, S^T; S, E) of (P7), symmetric to the bit: check_moments() lets rounding pass.
Matrix4 io_internal::read_moments(const Section& body)
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

MassProperties io_internal::read_mass(const Section& body, const Solid& shape)
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

std::vector<NamedSurface> io_internal::surfaces_in_body(const Section& body, const Solid& shape)
{
    std::vector<NamedSurface> surfaces = shape.surfaces;
    const Vector3 d = shift_of_shape(body, shape);
    if (d != Vector3{})
        for (NamedSurface& s : surfaces) s.moments = moved(s.moments, identity<3>(), d);
    return surfaces;
}

std::vector<ShapePart> io_internal::parts_in_body(const Section& body, const Solid& shape)
{
    if (body.has("inertia")) return {};
    std::vector<ShapePart> parts = shape.parts;
    for (ShapePart& part : parts) {
        if (body.has("mass")) part.mass *= body.number("mass") / shape.properties.mass;
        part.center += shift_of_shape(body, shape);
    }
    return parts;
}

/// Beside `inertia` a mesh or union stays where it lies in the body, and its own centre, about which it is
/// drawn, is another one than the body's.
Outline io_internal::outline_in_body(const Section& body, const Solid& shape)
{
    if (!body.has("inertia") || !shape.has_own_origin) return shape.outline;
    const Vector3 d = shape.properties.center_of_mass - body.vector("center_of_mass");
    Outline whole;
    whole.parts = shape.outline.parts.empty() ? std::vector{shape.outline} : shape.outline.parts;
    for (Outline& part : whole.parts) part.place += d;
    return whole;
}

}   // namespace livens
