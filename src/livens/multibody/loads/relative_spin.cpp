// SPDX-License-Identifier: BSD-3-Clause
// Damping by relative angular velocity: theory.md, "Coordinates of joints", Relative angular velocity.
#include "livens/multibody/loads/relative_spin.h"

#include <algorithm>
#include <array>

#include "livens/multibody/loads/load_values.h"

namespace livens {

namespace {

Vector3 unit_vector(int k)
{
    Vector3 e{};
    e[k] = 1;
    return e;
}

/// b_m in axes of the first, or its rate.
Vector3 axis_of(std::span<const double> numbers, std::size_t first, int m)
{
    const double* const b = numbers.data() + first + 3 * m;
    return {b[0], b[1], b[2]};
}

}   // namespace

inline namespace multibody_internal {

Matrix<6, 1> SpinDamping::rates(const LawArguments& at) const
{
    Matrix<6, 1> u{};
    for (int k = 0; has_displacements && k < 3; ++k) u[k] = at.rates[static_cast<std::size_t>(k)];
    for (int m = 0; m < 3; ++m) {
        const Vector3 w = cross(axis_of(at.values, first(), m), axis_of(at.rates, first(), m));
        for (int k = 0; k < 3; ++k) u[3 + k] += 0.5 * w[k];
    }
    return u;
}

/// With f by what is looked at: dw/dR_lm = 1/2 e_l x b_m', dw/dR'_lm = 1/2 b_m x e_l.
/// The slopes of factor k stand from 2 n k on: n by values, then n by rates.
void SpinDamping::operator()(const LawArguments& at, std::span<double> factors,
                             std::span<double> slopes) const
{
    const Matrix<6, 1> f = force(at);
    const Vector3 turning{f[3], f[4], f[5]};
    const auto put = [&](const Matrix<6, 1>& by, const Vector3& axis, int m, auto&& at_place) {
        const Vector3 g = 0.5 * cross({by[3], by[4], by[5]}, axis);
        for (int l = 0; l < 3; ++l) at_place(first() + static_cast<std::size_t>(3 * m + l), g[l]);
    };
    for (std::size_t k = 0; k < first(); ++k) factors[k] = f[static_cast<int>(k)];
    for (int m = 0; m < 3; ++m)
        put(f, axis_of(at.values, first(), m), m, [&](std::size_t i, double g) { factors[i] = g; });
    if (slopes.empty()) return;
    std::ranges::fill(slopes, 0.0);
    // Of all factors by number j, whose change moves f by df.
    const auto add_column = [&](std::size_t j, const Matrix<6, 1>& df) {
        for (std::size_t k = 0; k < first(); ++k) slopes[2 * n() * k + j] += df[static_cast<int>(k)];
        for (int m = 0; m < 3; ++m)
            put(df, axis_of(at.values, first(), m), m,
                [&](std::size_t i, double g) { slopes[2 * n() * i + j] += g; });
    };
    const auto by_spin = [&](const Vector3& w) {
        return -1. * (damping * Matrix<6, 1>{0, 0, 0, w[0], w[1], w[2]});
    };
    for (std::size_t k = 0; k < first(); ++k) {
        Matrix<6, 1> unit{};
        unit[static_cast<int>(k)] = 1;
        add_column(n() + k, -1. * (damping * unit));
    }
    for (int m = 0; m < 3; ++m)
        for (int l = 0; l < 3; ++l) {
            const std::size_t j = first() + static_cast<std::size_t>(3 * m + l);
            const Vector3 e = unit_vector(l);
            add_column(j, by_spin(0.5 * cross(e, axis_of(at.rates, first(), m))));
            add_column(n() + j, by_spin(0.5 * cross(axis_of(at.values, first(), m), e)));
            const Vector3 g = 0.5 * cross(turning, e);   // the factor's own axis
            for (int i = 0; i < 3; ++i)
                slopes[2 * n() * (first() + static_cast<std::size_t>(3 * m + i)) + j] += g[i];
        }
}

SpinDamping::OnTape SpinDamping::on_tape(const LawOnTape& at) const
{
    OnTape seen;
    const auto sum = [](TapeNumber& to, TapeNumber more) { to = to.place < 0 ? more : to + more; };
    for (std::size_t k = 0; k < first(); ++k) seen.rates[k] = at.rate(k);
    const auto value = [&](std::size_t m, std::size_t l) { return at.value(first() + 3 * m + l % 3); };
    const auto rate = [&](std::size_t m, std::size_t l) { return at.rate(first() + 3 * m + l % 3); };
    for (std::size_t k = 0; k < 3; ++k) {
        TapeNumber twice{&at.tape};
        for (std::size_t m = 0; m < 3; ++m)
            sum(twice, value(m, k + 1) * rate(m, k + 2) - value(m, k + 2) * rate(m, k + 1));
        seen.rates[3 + k] = 0.5 * twice;
    }
    for (int k = 0; k < 6; ++k) {
        TapeNumber f{&at.tape};
        for (int l = has_displacements ? 0 : 3; l < 6; ++l)
            if (damping(k, l) != 0) sum(f, -damping(k, l) * seen.rates[l]);
        seen.force[k] = f.place < 0 ? at.tape.number(0) : f;
    }
    return seen;
}

void SpinDamping::record(const LawOnTape& at, std::span<TapeNumber> factors) const
{
    const OnTape seen = on_tape(at);
    for (std::size_t k = 0; k < first(); ++k) factors[k] = seen.force[k];
    const auto f = [&](std::size_t k) { return seen.force[3 + k % 3]; };
    for (std::size_t m = 0; m < 3; ++m)
        for (std::size_t l = 0; l < 3; ++l) {
            const auto b = [&](std::size_t k) { return at.value(first() + 3 * m + k % 3); };
            factors[first() + 3 * m + l] = 0.5 * (f(l + 1) * b(l + 2) - f(l + 2) * b(l + 1));
        }
}

TapeNumber SpinDamping::recorded_power(const LawOnTape& at) const
{
    const OnTape seen = on_tape(at);
    TapeNumber sum = at.tape.number(0);
    for (std::size_t k = has_displacements ? 0 : 3; k < 6; ++k) sum = sum + seen.rates[k] * seen.force[k];
    return sum;
}

std::vector<LawCoordinate> turned_axes(int first, const Matrix3& axes_first, int second,
                                       const Matrix3& axes_second, const Configurations& X)
{
    std::vector<LawCoordinate> all;
    for (int m = 0; m < 3; ++m)
        for (int l = 0; l < 3; ++l) {
            const PairForm form = inner_product_row(first, direction(axes_first.column(l)), second,
                                                    direction(axes_second.column(m)), 0, 1);
            all.push_back({{{form}}, form_value(form, form.body_i, form.body_j, X)});
        }
    return all;
}

}   // namespace multibody_internal

Load rotational_damper(const std::string& name, int first, int second, double damping,
                       const Configurations& X)
{
    check_not_negative(start_load(name, "rotational_damper", {second, first}), damping, "damping");
    SpinDamping law;
    for (int k = 3; k < 6; ++k) law.damping(k, k) = damping;
    LoadParts parts;
    parts.coordinates = turned_axes(first, identity<3>(), second, identity<3>(), X);
    for (const LawCoordinate& q : parts.coordinates) parts.units.push_back(unit_along(name, q.coordinate, X));
    parts.law = law;
    parts.recorded_law = [law](const LawOnTape& at, std::span<TapeNumber> factors) {
        law.record(at, factors);
    };
    parts.is_smooth = true;
    parts.depends_on_rates = damping > 0;
    parts.power = [law](const LawArguments& at) { return law.power(at); };
    parts.recorded_power = [law](const LawOnTape& at) { return law.recorded_power(at); };
    for (int k = 0; k < 3; ++k)
        parts.readings.push_back({std::string("torque_") + "xyz"[k], "N m",
                                  [law, k](const LawArguments& at) { return law.force(at)[3 + k]; }});
    return modulated(name, "rotational_damper", parts, X);
}

}   // namespace livens
