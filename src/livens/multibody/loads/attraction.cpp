// SPDX-License-Identifier: BSD-3-Clause
// Attraction by a point to second order in the extent of the body, MacCullagh's formula: theory.md,
// "Coordinates of joints", Attraction. Both terms of the potential are laws of three coordinates, with exact
// second derivatives.
#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "livens/base/elementary.h"
#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/multibody/body.h"
#include "livens/multibody/loads/load_laws.h"
#include "livens/multibody/loads/load_values.h"

namespace livens {

namespace {

/// A potential of a place y with its derivatives.
struct Attracted {
    double energy = 0;
    Vector3 slope{};
    Matrix3 curvature{};

    /// factor a r^n, r = |y|, with a(y) and its derivatives.
    void add(double factor, const Vector3& y, int n, double a, const Vector3& da, const Matrix3& dda)
    {
        const double r = hypotenuse(y[0], y[1], y[2]), r2 = r * r, rn = factor * power(r, n);
        const Vector3 dr = n * rn / r2 * y;   // of r^n
        energy += rn * a;
        slope += rn * da + a * dr;
        // Product rule for a(y) r^n, with d2 r^n = n r^(n-2) (1 + (n - 2) y y^T / r^2).
        curvature += rn * dda + outer(da, dr) + outer(dr, da) +
                     a * (n * rn / r2) * (identity<3>() + (n - 2) / r2 * outer(y, y));
    }
};

/// -mu m / r.
Attracted of_the_centre(double mu, double mass, const Vector3& y)
{
    Attracted V;
    V.add(-mu * mass, y, -1, 1, {}, {});
    return V;
}

/// -mu (tr J - 3 y . J y / r^2) / (2 r^3), in axes in which J does not change.
Attracted of_the_extent(double mu, const Matrix3& J, const Vector3& y)
{
    const Vector3 Jy = J * y;
    Attracted V;
    V.add(-0.5 * mu * trace(J), y, -3, 1, {}, {});
    V.add(1.5 * mu, y, -5, dot(y, Jy), 2 * Jy, 2.0 * J);
    return V;
}

/// A term of the potential, and where its three coordinates begin among those of the load.
struct AttractionTerm {
    std::size_t first = 0;
    std::function<Attracted(const Vector3&)> of;

    Attracted at(const LawArguments& arguments) const
    {
        const std::span<const double> y = arguments.values.subspan(first);
        return of({y[0], y[1], y[2]});
    }
};

LoadLaw law_of(const std::vector<AttractionTerm>& terms)
{
    return [terms](const LawArguments& arguments, std::span<double> factors, std::span<double> slopes) {
        const std::size_t n = factors.size();
        std::ranges::fill(slopes, 0.0);
        for (const AttractionTerm& term : terms) {
            const Attracted V = term.at(arguments);
            for (int k = 0; k < 3; ++k) {
                const std::size_t unit = term.first + static_cast<std::size_t>(k);
                factors[unit] = -V.slope[k];
                for (int l = 0; l < 3 && !slopes.empty(); ++l)
                    slopes[2 * n * unit + term.first + static_cast<std::size_t>(l)] = -V.curvature(k, l);
            }
        }
    };
}

/// The slopes of both terms, as of_the_centre() and of_the_extent() have them, less.
void record_attraction(const LawOnTape& at, double mu, double mass, const Matrix3& J,
                       std::span<TapeNumber> factors)
{
    const auto squared = [](const TapeNumber* y) { return y[0] * y[0] + y[1] * y[1] + y[2] * y[2]; };
    for (std::size_t first = 0; first < factors.size(); first += 3) {
        const TapeNumber y[3] = {at.value(first), at.value(first + 1), at.value(first + 2)};
        const TapeNumber r2 = squared(y), by_r3 = at.tape.number(1) / (r2 * root(r2));
        if (first == 0) {
            for (std::size_t k = 0; k < 3; ++k) factors[k] = -mu * mass * (by_r3 * y[k]);
            continue;
        }
        TapeNumber Jy[3];
        for (int k = 0; k < 3; ++k) Jy[k] = J(k, 0) * y[0] + J(k, 1) * y[1] + J(k, 2) * y[2];
        const TapeNumber by_r5 = by_r3 / r2;
        const TapeNumber across = 5.0 * ((y[0] * Jy[0] + y[1] * Jy[1] + y[2] * Jy[2]) / r2);
        for (std::size_t k = 0; k < 3; ++k)
            factors[first + k] = -1.5 * mu * (by_r5 * ((trace(J) + -across) * y[k] + 2.0 * Jy[k]));
    }
}

/// What is exerted on the body, world axes.
std::vector<LoadReading> forces_of(const Load& load)
{
    std::vector<LoadReading> readings;
    for (int k = 0; k < 3; ++k)
        readings.push_back(
            {std::string(1, "xyz"[k]), "N", [forces = load.forces, k](const LoadArguments& at) {
                 LoadForces F{};
                 forces(at, F);
                 return F[0](k, 0);
             }});
    return readings;
}

}   // namespace

/// The first term is of the place of the centre of mass in the world, the second of that of the attracting
/// point in axes of the body. In those the first one would pull at the directors, too: mu m / r, whose
/// rounding is more than all of the second where r is long (J / m is of the size of the body, squared).
Load attraction(const std::string& name, int body, const Body& properties, const Attraction& law,
                const Configurations& X)
{
    const std::string path = "load[" + name + "]";
    if (!(law.mu > 0) || !std::isfinite(law.mu))
        throw InputError({"attraction-mu", path + ".mu", "mu of an attraction must be positive",
                          to_text(law.mu), "> 0", "", ""});
    const MassProperties mass = properties.is_point ? MassProperties{properties.mass(0, 0), {}, {}}
                                                    : mass_properties(properties.mass);
    const Vector4 centre = point(mass.center_of_mass), there = point(law.point);
    LoadParts parts;
    const auto add = [&](const PairForm& form) {
        parts.coordinates.push_back({{{form}}, form_value(form, form.body_i, form.body_j, X)});
        parts.units.push_back(unit_along(name, {{form}}, X));
    };
    for (const PairForm& row : coincidence_rows(world, there, body, centre, 1)) add(row);
    std::vector<AttractionTerm> terms{
        {0, [mu = law.mu, m = mass.mass](const Vector3& y) { return of_the_centre(mu, m, y); }}};
    // A point has no extent, and no axes in which J could be constant.
    if (law.has_gradient && !properties.is_point) {
        for (int k = 0; k < 3; ++k) {
            Vector3 unit{};
            unit[k] = 1;
            add(plane_row(body, direction(unit), centre, world, there, 0, 1));
        }
        terms.push_back(
            {3, [mu = law.mu, J = mass.inertia](const Vector3& y) { return of_the_extent(mu, J, y); }});
    }
    parts.is_smooth = true;   // the nearer the faster: elements see it by the motion
    parts.law = law_of(terms);
    parts.recorded_law = [mu = law.mu, mass](const LawOnTape& at, std::span<TapeNumber> factors) {
        record_attraction(at, mu, mass.mass, mass.inertia, factors);
    };
    parts.potential = [terms](const LawArguments& arguments) {
        double energy = 0;
        for (const AttractionTerm& term : terms) energy += term.at(arguments).energy;
        return energy;
    };
    parts.domain = "it has no size at the attracting point";
    Load load = modulated(name, "attraction", parts, X);
    load.sets_length_scale = true;
    load.readings = forces_of(load);
    load.points = {law.point, mass.center_of_mass};
    if (load.bodies[0] != world) std::swap(load.points[0], load.points[1]);
    return load;
}

}   // namespace livens
