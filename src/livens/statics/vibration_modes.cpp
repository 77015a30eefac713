// SPDX-License-Identifier: BSD-3-Clause
// Roots and shapes of M q'' + C q' + K q = 0, and what they say of stability.
// theory.md, "Small motions": symmetric and undamped systems by the symmetric problem, whose roots keep their
// digits; others by the eigenvalues of the first-order matrix.
#include <algorithm>
#include <cmath>

#include "livens/solvers/factors.h"
#include "livens/solvers/spectral.h"
#include "livens/statics/linearisation.h"

namespace livens {

namespace {

using Complex = std::complex<double>;
using Shape = std::vector<Complex>;

/// Of entries row by row.
DenseMatrix square(const Linearisation& linear, const std::vector<double>& A)
{
    return transpose({linear.n, linear.n, A.data()});
}

bool is_undamped(const Linearisation& linear)
{
    return std::ranges::all_of(linear.C, [&](double c) { return std::abs(c) <= linear.damping_rounding; });
}

/// A root of the upper half plane and its shape in q.
struct Root {
    Complex s;
    Shape q;
};
using Roots = std::vector<Root>;

/// Of a symmetric K without damping: s^2 = -k, of which one root stands for both.
Roots undamped_roots(const Linearisation& linear)
{
    const SymmetricSpectrum spectrum =
        generalised_spectrum(symmetric_part(square(linear, linear.K)), square(linear, linear.M));
    Roots roots;
    for (int i = 0; i < linear.n; ++i) {
        const double k = spectrum.values[i];
        // Below rounding a stiffness is zero, or its root would be a slow frequency that nobody has.
        const Complex s = std::abs(k) <= linear.rounding ? Complex{}
                          : k > 0                        ? Complex{0, std::sqrt(k)}
                                                         : Complex{std::sqrt(-k), 0};
        const auto q = spectrum.vectors.column(i);
        roots.push_back({s, {q.begin(), q.end()}});
    }
    return roots;
}

/// Directions that nothing restores: K q = 0; with states (q, s z) in which all is in balance.
DenseMatrix idle_directions(const Linearisation& linear)
{
    const LinearStates& z = linear.states;
    const int n = linear.n, n_z = z.n();
    if (n_z == 0) return null_directions(square(linear, linear.K), linear.rounding);
    // Rounding of columns of C is made alike that of K.
    const double per_rate =
        linear.damping_rounding > 0 && linear.rounding > 0 ? linear.rounding / linear.damping_rounding : 1;
    DenseMatrix all(n + n_z, n + n_z);
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) all(i, j) = linear.K[static_cast<std::size_t>(i * n + j)];
        for (int j = 0; j < n_z; ++j)
            all(i, n + j) = per_rate * z.by_states[static_cast<std::size_t>(i * n_z + j)];
    }
    for (int i = 0; i < n_z; ++i) {
        for (int j = 0; j < n; ++j) all(n + i, j) = z.by_q[static_cast<std::size_t>(i * n + j)];
        for (int j = 0; j < n_z; ++j)
            all(n + i, n + j) = per_rate * z.own[static_cast<std::size_t>(i * n_z + j)];
    }
    return null_directions(all, linear.rounding);
}

/// Of all else. Roots that are zero are told by K: rounding parts those that come twice.
Roots general_roots(const Linearisation& linear)
{
    const int n = linear.n;
    const DenseMatrix L = cholesky(square(linear, linear.M)),
                      K = cholesky_solution(L, square(linear, linear.K)),
                      C = cholesky_solution(L, square(linear, linear.C));
    const double largest = std::max(std::sqrt(largest_size(K.a)), largest_size(C.a)),
                 unit = largest > 0 ? largest : 1;
    const LinearStates& z = linear.states;
    const int n_z = z.n(), size = 2 * n + n_z;
    DenseMatrix A(size, size);   // on (unit q, q', s z), whose entries are of one size
    const auto by_states =
        n > 0 && n_z > 0 ? cholesky_solution(L, transpose({n_z, n, z.by_states.data()})) : DenseMatrix();
    for (int k = 0; k < n_z; ++k) {
        for (int i = 0; i < n; ++i) {
            A(n + i, 2 * n + k) = -by_states(i, k);
            A(2 * n + k, i) = -z.by_q[static_cast<std::size_t>(k * n + i)] / unit;
            A(2 * n + k, n + i) = -z.by_rates[static_cast<std::size_t>(k * n + i)];
        }
        for (int j = 0; j < n_z; ++j) A(2 * n + k, 2 * n + j) = -z.own[static_cast<std::size_t>(k * n_z + j)];
    }
    for (int j = 0; j < n; ++j) {
        // Scaled by the fastest rate, positions and rates are of one size, so the general solver balances
        // well.
        A(j, n + j) = unit;
        for (int i = 0; i < n; ++i) A(n + i, j) = -K(i, j) / unit, A(n + i, n + j) = -C(i, j);
    }
    const GeneralSpectrum spectrum = general_spectrum(A);
    const DenseMatrix idle = idle_directions(linear);
    Roots roots;
    for (int k = 0; k < idle.cols; ++k)
        roots.push_back({{}, {idle.column(k).begin(), idle.column(k).begin() + n}});
    for (int i = 0; i < size; ++i) {
        Complex s = spectrum.values[i];
        // One root of each conjugate pair. Zeros were taken from K, as rounding parts a double zero into a
        // pair.
        if (!(s.imag() >= 0 && std::norm(s) > linear.rounding)) continue;
        if (std::abs(s.real()) <= 1e-13 * unit) s.real(0);
        roots.push_back({s, {spectrum.vectors[i].begin(), spectrum.vectors[i].begin() + n}});
    }
    return roots;
}

Roots roots_of(const Linearisation& linear)
{
    return linear.is_conservative && is_undamped(linear) ? undamped_roots(linear) : general_roots(linear);
}

/// Turns and scales the displacements of all bodies as VibrationMode says.
void normalise(Shape& twists, double length)
{
    double largest = 0;
    std::size_t first = 0;
    for (std::size_t i = 0; i < twists.size(); i += 3) {
        const double squares = std::norm(twists[i]) + std::norm(twists[i + 1]) + std::norm(twists[i + 2]),
                     size = std::sqrt(squares) / (i % 6 == 0 ? length : 1);
        if (!(size > largest * (1 + 1e-9))) continue;   // of equal ones the first, whatever rounding says
        largest = size;
        first = i;
    }
    if (largest == 0) return;
    std::size_t most = first;
    for (std::size_t i = first; i < first + 3; ++i)
        if (std::abs(twists[i]) > std::abs(twists[most]) * (1 + 1e-9)) most = i;
    // Eigenvectors are known up to a complex factor; the largest component becomes real and positive.
    const Complex factor = std::conj(twists[most]) / (std::abs(twists[most]) * largest);
    for (Complex& entry : twists) entry *= factor;
}

/// The displacements and rotations of all bodies, row by row in `twists`.
Shape moved(const Linearisation& linear, const Shape& q)
{
    Shape all(6 * linear.state.X.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t k = 0; k < q.size(); ++k) all[i] += linear.twists[i * q.size() + k] * q[k];
    return all;
}

}   // namespace

std::vector<VibrationMode> vibration_modes(const Linearisation& linear)
{
    std::vector<VibrationMode> modes;
    if (linear.n + linear.states.n() == 0) return modes;
    const auto n_bodies = linear.state.X.size();
    for (const Root& root : roots_of(linear)) {
        Shape shape = moved(linear, root.q);
        normalise(shape, linear.length);
        VibrationMode mode{root.s, std::vector<BodyShape>(n_bodies)};
        for (std::size_t b = 0; b < n_bodies; ++b) {
            std::copy_n(shape.data() + 6 * b, 3, mode.bodies[b].displacement.begin());
            std::copy_n(shape.data() + 6 * b + 3, 3, mode.bodies[b].rotation.begin());
        }
        modes.push_back(std::move(mode));
    }
    std::ranges::stable_sort(modes, {}, &VibrationMode::frequency);
    return modes;
}

const char* to_string(Stability stability)
{
    switch (stability) {
    case Stability::stable:
        return "stable";
    case Stability::neutral:
        return "neutral";
    default:
        return "unstable";
    }
}

StabilityReport stability(const Linearisation& linear)
{
    StabilityReport report;
    if (linear.n + linear.states.n() == 0) return report;
    if (linear.is_conservative) {
        for (const double k :
             generalised_values(symmetric_part(square(linear, linear.K)), square(linear, linear.M))) {
            report.n_unstable += k < -linear.rounding;
            report.n_neutral += std::abs(k) <= linear.rounding;
        }
    } else {
        const Roots roots = general_roots(linear);
        double largest = 0;
        for (const Root& root : roots) largest = std::max(largest, std::abs(root.s));
        for (const auto& [s, q] : roots)   // a pair grows in two directions
            report.n_unstable += s.real() > 1e-10 * largest ? (s.imag() > 0 ? 2 : 1) : 0;
        report.n_neutral = idle_directions(linear).cols;
    }
    report.stability = report.n_unstable > 0  ? Stability::unstable
                       : report.n_neutral > 0 ? Stability::neutral
                                              : Stability::stable;
    return report;
}

}   // namespace livens
