// SPDX-License-Identifier: BSD-3-Clause
// Mass matrices (P7) from mass, centre and inertia and back, what inertias may be, and closed forms of simple
// solids: theory.md, "Bodies without rotation parameters".
#include "livens/multibody/mass_properties.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "livens/base/error.h"
#include "livens/multibody/nearest_inertia.h"
#include "livens/multibody/wording.h"
#include "livens/solvers/factors.h"
#include "livens/solvers/spectral.h"

namespace livens {

namespace {

constexpr double relative_slack = 1e-12;   // of the largest moment, in every inequality on moments below

Matrix3 diagonal(double a, double b, double c) { return {a, 0, 0, 0, b, 0, 0, 0, c}; }

void require_size(double size, const char* shape, const char* what)
{
    if (size > 0 && std::isfinite(size)) return;
    throw InputError({"size-not-positive", "", std::string(what) + " of a " + shape + " must be positive",
                      to_text(size), "> 0", "", ""});
}

/// s with s_i^2 m_ii = 1: scaled by it, m does not depend on the unit of length nor on the body's size.
Vector4 unit_scaling(const Matrix4& m)
{
    Vector4 s;
    for (int i = 0; i < 4; ++i) s[i] = 1 / std::sqrt(m(i, i));
    return s;
}

/// s_i m_ij s_j
Matrix4 scaled_both_ways(const Matrix4& m, const Vector4& s)
{
    Matrix4 scaled;
    for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) scaled(i, j) = s[i] * m(i, j) * s[j];
    return scaled;
}

/// As scenarios spell it: three moments, or the rows of the matrix.
std::string inertia_in_words(const Matrix3& m)
{
    const bool is_diagonal = m(0, 1) == 0 && m(0, 2) == 0 && m(1, 2) == 0;
    if (is_diagonal) return to_text(Vector3{m(0, 0), m(1, 1), m(2, 2)});
    return "[" + to_text(m.column(0)) + ", " + to_text(m.column(1)) + ", " + to_text(m.column(2)) + "]";
}

void check_principal_moments(const Matrix3& inertia, double arms, const std::string& path)
{
    const Vector3 j = symmetric_values(inertia);   // ascending
    // Inequality: J1 + J2 >= J3 - 1e-12 of the largest moment. Flat bodies meet it with equality, so rounding
    // has to pass; that of moments which were taken from those about the reference point is of M |c|^2.
    const double slack = relative_slack * std::max({std::abs(j[0]), std::abs(j[2]), arms});
    const std::string moments = to_text(j);
    if (j[0] < -slack)
        throw InputError({"inertia-negative", path, "a principal moment of inertia is negative", moments,
                          ">= 0", "the moment about an axis is the sum of m r^2 over the body", ""});
    if (j[0] + j[1] < j[2] - slack) {
        const double sum = j[0] + j[1], missing = j[2] - sum;
        constexpr double rounded = 2e-3;   // of moments with three digits or more
        const std::string help =
            missing < rounded * j[2]
                ? "of a flat body that was rounded: write the sum of the other two for the largest, " +
                      to_text(sum, 12) + ", or all of them with more digits"
                : "the inertia is taken about the centre of mass, in body axes; if it is, the nearest that a "
                  "body can have is " +
                      inertia_in_words(nearest_inertia(inertia));
        throw InputError({"inertia-triangle", path,
                          "the largest principal moment exceeds the sum of the other two by " +
                              to_text(missing, 3) + " (" + to_text(100 * missing / j[2], 2) + " percent)",
                          moments, "J1 + J2 >= J3",
                          "principal moments of inertia satisfy the triangle inequality for every "
                          "distribution of mass",
                          help});
    }
}

}   // namespace

Matrix4 mass_matrix(const MassProperties& properties)
{
    const Vector3& c = properties.center_of_mass;
    const Matrix3& J = properties.inertia;
    // Euler's tensor of J about the centre, and Steiner's part for the reference point.
    const Matrix3 E = 0.5 * trace(J) * identity<3>() - J + properties.mass * outer(c, c);
    Matrix4 m{};
    m(0, 0) = properties.mass;
    for (int i = 0; i < 3; ++i) {
        m(0, i + 1) = m(i + 1, 0) = properties.mass * c[i];
        for (int j = 0; j < 3; ++j) m(i + 1, j + 1) = 0.5 * (E(i, j) + E(j, i));
    }
    return m;
}

MassProperties mass_properties(const Matrix4& mass_matrix)
{
    MassProperties properties;
    properties.mass = mass_matrix(0, 0);
    Matrix3 E{};
    for (int i = 0; i < 3; ++i) {
        properties.center_of_mass[i] = mass_matrix(i + 1, 0) / properties.mass;
        for (int j = 0; j < 3; ++j) E(i, j) = mass_matrix(i + 1, j + 1);
    }
    const Vector3& c = properties.center_of_mass;
    E -= properties.mass * outer(c, c);
    // The inverse of E = tr(J)/2 1 - J, since tr(E) = tr(J)/2.
    properties.inertia = trace(E) * identity<3>() - E;
    return properties;
}

bool is_singular(const Matrix4& mass_matrix, bool is_point)
{
    if (is_point) return !(mass_matrix(0, 0) > 0);
    const Matrix4& m = mass_matrix;
    // Negations, so that a mass that is not a number is singular.
    if (!(m(0, 0) > 0)) return true;
    const double trace_E = m(1, 1) + m(2, 2) + m(3, 3);
    for (int i = 1; i < 4; ++i)
        if (!(m(i, i) > 1e-14 * trace_E)) return true;
    const Vector4 values = symmetric_values(scaled_both_ways(m, unit_scaling(m)));
    // Scaled, the rounding of the matrix itself is as large as this where a lamina lies almost across an
    // axis.
    const double rounding =
        8 * std::numeric_limits<double>::epsilon() * trace_E / std::min({m(1, 1), m(2, 2), m(3, 3)});
    return !(values[0] > std::max(1e-12, rounding));
}

Matrix4 inverse_mass(const Matrix4& mass_matrix, bool is_point)
{
    assert(!is_singular(mass_matrix, is_point));
    Matrix4 inverse{};
    if (is_point) {
        inverse(0, 0) = 1 / mass_matrix(0, 0);
        return inverse;
    }
    // Scaled to ones on the diagonal, a body of a micrometre is inverted as exactly as one of a kilometre.
    const Vector4 s = unit_scaling(mass_matrix);
    const Matrix4 raw = scaled_both_ways(inverse_of_positive(scaled_both_ways(mass_matrix, s)), s);
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) inverse(i, j) = 0.5 * (raw(i, j) + raw(j, i));
    return inverse;
}

void check_mass_properties(const MassProperties& properties, const std::string& path)
{
    const Matrix3& J = properties.inertia;
    require_finite(Matrix<1, 1>{properties.mass}, path + ".mass", "the mass");
    require_finite(properties.center_of_mass, path + ".center_of_mass", "the centre of mass");
    require_finite(J, path + ".inertia", "the inertia");
    if (!(properties.mass > 0))
        throw InputError({"mass-not-positive", path + ".mass", "the mass of a body must be positive",
                          to_text(properties.mass), "> 0", "", "a fixed body is the world"});
    // Inequality: |J_ij - J_ji| <= 1e-12 of the largest entry.
    const double largest = std::ranges::max(J.a, {}, [](double entry) { return std::abs(entry); });
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < i; ++j)
            if (std::abs(J(i, j) - J(j, i)) > relative_slack * std::abs(largest))
                throw InputError({"inertia-not-symmetric", path + ".inertia", "the inertia must be symmetric",
                                  to_text(J(i, j)) + " and " + to_text(J(j, i)), "equal entries",
                                  "J_ij = -sum of m x_i x_j for i != j, the same both ways", ""});
    const Vector3& c = properties.center_of_mass;
    check_principal_moments(J, properties.mass * dot(c, c), path + ".inertia");
}

MassProperties box(double density, const Vector3& edges)
{
    require_size(density, "box", "the density");
    for (int i = 0; i < 3; ++i) require_size(edges[i], "box", "an edge");
    const double mass = density * edges[0] * edges[1] * edges[2];
    const double x = edges[0] * edges[0], y = edges[1] * edges[1], z = edges[2] * edges[2];
    return {mass, {}, mass / 12 * diagonal(y + z, z + x, x + y)};
}

MassProperties sphere(double density, double radius)
{
    require_size(density, "sphere", "the density");
    require_size(radius, "sphere", "the radius");
    return ellipsoid(density, {radius, radius, radius});
}

MassProperties cylinder(double density, double radius, double length, double inner_radius)
{
    require_size(density, "cylinder", "the density");
    require_size(radius, "cylinder", "the radius");
    require_size(length, "cylinder", "the length");
    if (!(inner_radius >= 0 && inner_radius < radius))
        throw InputError({"size-inner-radius", "",
                          "the inner radius of a cylinder must lie between zero and the outer one",
                          to_text(inner_radius), ">= 0 and < " + to_text(radius), "", ""});
    // (R - r)(R + r), not R^2 - r^2: thin tubes keep their digits.
    const double mass =
        density * std::numbers::pi * (radius - inner_radius) * (radius + inner_radius) * length;
    const double squares = radius * radius + inner_radius * inner_radius;
    const double across = mass * (3 * squares + length * length) / 12;
    return {mass, {}, diagonal(across, across, mass * squares / 2)};
}

MassProperties capsule(double density, double radius, double length)
{
    require_size(density, "capsule", "the density");
    require_size(radius, "capsule", "the radius");
    require_size(length, "capsule", "the length");
    const double square = radius * radius;
    const double tube = density * std::numbers::pi * square * length;
    const double caps = density * std::numbers::pi * 4 / 3 * square * radius;   // both half spheres
    // The centroid of a half sphere lies 3/8 of the radius above its flat side.
    const double across = tube * (3 * square + length * length) / 12 +
                          caps * (0.4 * square + 0.25 * length * length + 0.375 * length * radius);
    return {tube + caps, {}, diagonal(across, across, 0.5 * tube * square + 0.4 * caps * square)};
}

MassProperties ellipsoid(double density, const Vector3& semi_axes)
{
    require_size(density, "ellipsoid", "the density");
    for (int i = 0; i < 3; ++i) require_size(semi_axes[i], "ellipsoid", "a semi-axis");
    const double mass = density * std::numbers::pi * 4 / 3 * semi_axes[0] * semi_axes[1] * semi_axes[2];
    const double x = semi_axes[0] * semi_axes[0], y = semi_axes[1] * semi_axes[1],
                 z = semi_axes[2] * semi_axes[2];
    return {mass, {}, mass / 5 * diagonal(y + z, z + x, x + y)};
}

MassProperties cone(double density, double radius, double height)
{
    require_size(density, "cone", "the density");
    require_size(radius, "cone", "the radius");
    require_size(height, "cone", "the height");
    const double mass = density * std::numbers::pi * radius * radius * height / 3;
    // About the centre of mass, a quarter of the height above the base.
    const double across = mass * (3 * radius * radius / 20 + 3 * height * height / 80);
    return {mass, {}, diagonal(across, across, 3 * mass * radius * radius / 10)};
}

/// The density changes and the shape does not: moments go with the mass.
MassProperties with_mass(MassProperties properties, double mass)
{
    if (!(properties.mass > 0))
        throw InputError({"mass-not-positive", "", "only a body that has mass can be scaled to another mass",
                          to_text(properties.mass), "> 0", "", ""});
    properties.inertia *= mass / properties.mass;
    properties.mass = mass;
    return properties;
}

MassProperties with_center(MassProperties properties, const Vector3& center_of_mass)
{
    properties.center_of_mass = center_of_mass;
    return properties;
}

}   // namespace livens
