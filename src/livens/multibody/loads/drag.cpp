// SPDX-License-Identifier: BSD-3-Clause
// Drag F = -(k1 + k2 |v|) v of a point against a medium: a law of three rates (theory.md, "Coordinates of
// joints", Laws). With a quadratic part it bends where v is zero: that is its centre ("Laws that bend").
#include <array>
#include <cmath>

#include "livens/multibody/loads/load_laws.h"
#include "livens/multibody/loads/load_values.h"

namespace livens {

namespace {

/// |d(|v| v_k)/ds| <= |v| |dv_k/ds| + |dv/ds| |v_k|
void bound_slopes(const Drag& law, std::span<const EnclosedValue> numbers, std::span<double> bounds)
{
    double speed = 0, change = 0;
    std::array<double, 3> along{};
    for (int k = 0; k < 3; ++k) {
        const EnclosedValue& v = numbers[3 + k];
        const Enclosure against = v.value - Enclosure::of(law.medium[k]);
        along[k] = against.size();
        speed += square(against).high;
        change += square(v.slope).high;
    }
    speed = std::sqrt(speed), change = std::sqrt(change);
    for (int k = 0; k < 3; ++k)
        bounds[k] = (law.linear + law.quadratic * speed) * numbers[3 + k].slope.size() +
                    law.quadratic * change * along[k];
}

}   // namespace

Load drag(const std::string& name, int body, const Vector3& point, const Drag& law, const Configurations& X)
{
    LoadParts parts;
    const std::vector<ConstraintRow> rows =
        coincidence_rows(world, livens::point({}), body, livens::point(point), 1);
    for (int k = 0; k < 3; ++k) {
        Vector3 unit{};
        unit[k] = 1;
        parts.units.push_back(point_force(name, body, point, {unit[0], unit[1], unit[2]}, Frame::inertial));
        parts.coordinates.push_back({{{rows[k]}}, 0, false});
    }
    Load checked = parts.units[0];
    check_not_negative(checked, law.linear, "linear");
    check_not_negative(checked, law.quadratic, "quadratic");
    check_load_vector(checked, law.medium, "the medium's velocity");
    parts.depends_on_rates = law.linear > 0 || law.quadratic > 0;
    // d(|v| v)/dv = |v| I + v v^T / |v|, zero at rest.
    parts.law = [law](const LawArguments& at, std::span<double> factors, std::span<double> slopes) {
        const Vector3 v = Vector3{at.rates[0], at.rates[1], at.rates[2]} - law.medium;
        const double speed = norm(v), size = law.linear + law.quadratic * speed;
        for (int k = 0; k < 3; ++k) {
            factors[k] = -size * v[k];
            for (int l = 0; l < 3 && !slopes.empty(); ++l) {
                slopes[6 * k + l] = 0;
                slopes[6 * k + 3 + l] =
                    -(k == l ? size : 0.0) - (speed > 0 ? law.quadratic * v[k] * v[l] / speed : 0.0);
            }
        }
    };
    parts.recorded_law = [law](const LawOnTape& at, std::span<TapeNumber> factors) {
        const TapeNumber v[3] = {at.rate(0) - law.medium[0], at.rate(1) - law.medium[1],
                                 at.rate(2) - law.medium[2]};
        if (law.quadratic > 0) at.tape.watch_centre({v[0], v[1], v[2]});
        const TapeNumber speed = root(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        for (std::size_t k = 0; k < 3; ++k)
            factors[k] =
                law.quadratic > 0 ? (-law.linear + -law.quadratic * speed) * v[k] : -law.linear * v[k];
    };
    parts.steepest = [law](const EnclosedValue&, std::span<const EnclosedValue> numbers,
                           std::span<double> bounds) { bound_slopes(law, numbers, bounds); };
    parts.is_smooth = law.quadratic == 0;
    parts.is_smooth_off_centre = true;
    if (law.quadratic > 0)
        parts.guards.centre = [law](const LawArguments& at) {
            return Vector3{at.rates[0], at.rates[1], at.rates[2]} - law.medium;
        };
    for (std::size_t k = 0; k < 3; ++k)
        parts.readings.push_back(factor_reading(std::string(1, "xyz"[k]), "N", parts.law, k, 3));
    return modulated(name, "drag", parts, X);
}

}   // namespace livens
