// SPDX-License-Identifier: BSD-3-Clause
// The rotation vector of a turn and its derivatives by the four forms that tell it, and the couple that acts
// along it: theory.md, "Coordinates of joints", Bushing.
#include "livens/multibody/loads/rotation_vector.h"

#include <cmath>

#include "livens/base/elementary.h"
#include "livens/multibody/loads/load_tape.h"

namespace livens {

namespace {

// The rotation vector is r = psi s with s = sin(angle) times the axis and c = cos(angle), all of which are
// forms in X: psi = angle / |s| = atan2(sqrt(sigma), c) / sqrt(sigma), sigma = s . s.

/// psi by sigma and c, to the second derivatives.
struct Psi {
    double value, by_sigma, by_c, by_sigma_sigma, by_sigma_c, by_c_c;
};

Psi psi(double sigma, double c)
{
    // 1 on the rotation group, but not between the nodes of an element.
    const double r2 = sigma + c * c;
    Psi p{};
    p.by_c = -1 / r2;
    p.by_sigma_c = 1 / (r2 * r2);
    p.by_c_c = 2 * c / (r2 * r2);
    // Below a hundredth ten terms of the series leave 1e-20; above, the closed forms lose few digits.
    const double x = sigma / (c * c);
    if (c > 0 && x < 0.01) {   // the closed forms cancel: series of atan(sqrt(x)) / sqrt(x)
        double power = 1, sign = 1;
        for (int k = 0; k < 10; ++k, power *= x, sign = -sign) {
            p.value += sign * power / (2 * k + 1);
            p.by_sigma -= sign * power * (k + 1) / (2 * k + 3);
            p.by_sigma_sigma += sign * power * (k + 1) * (k + 2) / (2 * k + 5);
        }
        p.value /= c;
        p.by_sigma /= c * c * c;
        p.by_sigma_sigma /= c * c * c * c * c;
        return p;
    }
    const double s = std::sqrt(sigma);
    p.value = arc_tangent(s, c) / s;
    p.by_sigma = (c / r2 - p.value) / (2 * sigma);
    p.by_sigma_sigma = (-c / (r2 * r2) - 3 * p.by_sigma) / (2 * sigma);
    return p;
}

}   // namespace

inline namespace multibody_internal {

TapeVector turn_of_sine(TapeNumber sigma, TapeNumber c)
{
    return {c.tape, c.tape->add({TapeKind::turn, -1, sigma.place, c.place, -1, 0})};
}

void turn_of_sine(double sigma, double c, double* both)
{
    const Psi p = psi(sigma, c);
    both[0] = p.value;
    both[1] = 2 * p.by_sigma;
}

/// r_k = psi s_k and J_kl = dr_k/dq_l = 2 psi_sigma s_k s_l + psi delta_kl, J_k3 = psi_c s_k, with one more
/// derivative carried along by dual numbers.
Turn turn_of(const double* q)
{
    const auto variable = [&](std::size_t i) {
        Dual d{q[i], {}};
        d.by[i] = 1;
        return d;
    };
    const std::array<Dual, 4> v{variable(0), variable(1), variable(2), variable(3)};
    const Dual sigma = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    const Psi p = psi(sigma.value, v[3].value);
    const auto composed = [&](double value, double by_sigma, double by_c) {
        Dual d{value, {}};
        for (std::size_t i = 0; i < 4; ++i) d.by[i] = by_sigma * sigma.by[i] + by_c * v[3].by[i];
        return d;
    };
    const Dual of = composed(p.value, p.by_sigma, p.by_c), twice{2, {}};
    const Dual by_sigma = composed(p.by_sigma, p.by_sigma_sigma, p.by_sigma_c);
    const Dual by_c = composed(p.by_c, p.by_sigma_c, p.by_c_c);
    Turn turn;
    for (std::size_t k = 0; k < 3; ++k) {
        turn.r[k] = of * v[k];
        for (std::size_t l = 0; l < 3; ++l) turn.J[k][l] = twice * by_sigma * v[k] * v[l];
        turn.J[k][k] = turn.J[k][k] + of;
        turn.J[k][3] = by_c * v[k];
    }
    return turn;
}

/// tau = f + 1/2 r x f + k r x (r x f), k = (1 - x cot x) / 4 x^2 and x = |r| / 2, whose power along w is
/// that of f along r'.
Vector3 couple_of(const Vector3& f, const Vector3& r)
{
    const double x2 = 0.25 * dot(r, r), x = std::sqrt(x2);
    const auto [sine, cosine] = sine_cosine(x);
    // Its series where the difference cancels.
    const double k = x2 > 0.01 ? (1 - x * cosine / sine) / (4 * x2)
                               : 1. / 12 + x2 * (1. / 180 + x2 * (1. / 1890 + x2 / 18900));
    return f + 0.5 * cross(r, f) + k * cross(r, cross(r, f));
}

}   // namespace multibody_internal

}   // namespace livens
