// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <optional>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/multibody/body.h"
#include "livens/multibody/detail/load_values.h"
#include "livens/multibody/load_laws.h"

namespace livens {

namespace {

/// -mu (m / r + (tr J - 3 y . J y / r^2) / (2 r^3)) with its derivatives by y, the place of the attracting
/// point in axes in which J does not change.
struct Potential {
    double mu, mass;
    Matrix3 J;   ///< zero without the gradient

    struct Value {
        double energy = 0;
        Vector3 slope{};
        Matrix3 curvature{};
    };

    /// Terms a r^n with a = 1 or y . J y.
    Value operator()(const Vector3& y) const
    {
        const double r = hypotenuse(y[0], y[1], y[2]), r2 = r * r;
        Value sum;
        const auto add = [&](double factor, double a, const Vector3& da, const Matrix3& dda, int n) {
            const double rn = factor * power(r, n);
            sum.energy += rn * a;
            const Vector3 dr = n * rn / r2 * y;   // of r^n
            sum.slope += rn * da + a * dr;
            sum.curvature += rn * dda + outer(da, dr) + outer(dr, da) +
                             a * (n * rn / r2) * (identity<3>() + (n - 2) / r2 * outer(y, y));
        };
        add(-mu * (mass), 1, {}, {}, -1);
        if (J != Matrix3{}) {
            const Vector3 Jy = J * y;
            add(-0.5 * mu * trace(J), 1, {}, {}, -3);
            add(1.5 * mu, dot(y, Jy), 2 * Jy, 2.0 * J, -5);
        }
        return sum;
    }
};

}   // namespace

Load attraction(const std::string& name, int body, const Body& properties, const Attraction& law,
                const Configurations& X)
{
    const std::string path = "load[" + name + "]";
    if (!(law.mu > 0) || !std::isfinite(law.mu))
        throw InputError({"attraction-mu", path + ".mu", "mu of an attraction must be positive",
                          to_text(law.mu), "> 0", "", ""});
    const MassProperties mass = properties.is_point ? MassProperties{properties.mass(0, 0), {}, {}}
                                                    : mass_properties(properties.mass);
    const bool in_body_axes = law.has_gradient && !properties.is_point;
    const Vector4 centre = point(mass.center_of_mass), there = point(law.point);
    LoadParts parts;
    const auto rows = coincidence_rows(world, there, body, centre, 1);
    for (int k = 0; k < 3; ++k) {
        Vector3 unit{};
        unit[k] = 1;
        // In axes of the body it is the way from the centre to the point, else back: the potential is even.
        const PairForm form =
            in_body_axes ? plane_row(body, direction(unit), centre, world, there, 0, 1) : rows[k];
        parts.coordinates.push_back({{{form}}, form_value(form, form.body_i, form.body_j, X)});
        parts.units.push_back(unit_along(name, {{form}}, X));
    }
    const Potential of{law.mu, mass.mass, in_body_axes ? mass.inertia : Matrix3{}};
    const auto at = [of](const LawArguments& arguments) {
        return of({arguments.values[0], arguments.values[1], arguments.values[2]});
    };
    parts.is_smooth = true;   // the nearer the faster: elements see it by the motion
    parts.law = [at](const LawArguments& arguments, std::span<double> factors, std::span<double> slopes) {
        const Potential::Value V = at(arguments);
        for (int k = 0; k < 3; ++k) {
            factors[k] = -V.slope[k];
            for (int l = 0; l < 3 && !slopes.empty(); ++l) {
                slopes[6 * k + l] = -V.curvature(k, l);
                slopes[6 * k + 3 + l] = 0;
            }
        }
    };
    const auto force = [at, in_body_axes](int k) -> LawEnergy {
        return
            [=](const LawArguments& arguments) { return (in_body_axes ? 1 : -1) * at(arguments).slope[k]; };
    };
    for (int k = 0; k < 3; ++k) parts.readings.push_back({std::string(1, "xyz"[k]), "N", force(k)});
    parts.potential = [at](const LawArguments& arguments) { return at(arguments).energy; };
    parts.domain = "it has no size at the attracting point";
    Load load = modulated(name, "attraction", parts, X);
    load.points = {law.point, mass.center_of_mass};
    if (load.bodies[0] != world) std::swap(load.points[0], load.points[1]);
    return load;
}

}   // namespace livens
