// SPDX-License-Identifier: BSD-3-Clause
// Roots and shapes of M q'' + C q' + K q = 0, and what they say of stability.
#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "livens/statics/linearisation.h"

namespace livens {

namespace {

using Complex = std::complex<double>;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

MatrixXd square(const Linearisation& linear, const std::vector<double>& A)
{
    return Eigen::Map<const ByRows>(A.data(), linear.n, linear.n);
}

bool is_undamped(const Linearisation& linear)
{
    return std::ranges::all_of(linear.C, [&](double c) { return std::abs(c) <= linear.damping_rounding; });
}

/// Roots of the upper half plane, each with its shape in q.
struct Roots {
    VectorXcd s;
    MatrixXcd q;
};

/// Of a symmetric K without damping: s^2 = -k, of which one root stands for both.
Roots undamped_roots(const Linearisation& linear)
{
    const MatrixXd K = square(linear, linear.K);
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(0.5 * (K + K.transpose()),
                                                                    square(linear, linear.M));
    Roots roots{VectorXcd(linear.n), solver.eigenvectors().cast<Complex>()};
    for (int i = 0; i < linear.n; ++i) {
        const double k = solver.eigenvalues()(i);
        roots.s(i) = std::abs(k) <= linear.rounding ? Complex{}
                     : k > 0                        ? Complex{0, std::sqrt(k)}
                                                    : Complex{std::sqrt(-k), 0};
    }
    return roots;
}

/// Directions that nothing restores: K q = 0.
MatrixXd idle_directions(const Linearisation& linear)
{
    const Eigen::JacobiSVD<MatrixXd> svd(square(linear, linear.K), Eigen::ComputeFullV);
    const auto n_idle = (svd.singularValues().array() <= linear.rounding).count();
    return svd.matrixV().rightCols(n_idle);
}

/// Of all else. Roots that are zero are told by K: rounding parts those that come twice.
Roots general_roots(const Linearisation& linear)
{
    const int n = linear.n;
    const MatrixXd mass = square(linear, linear.M);
    const Eigen::LLT<MatrixXd> M(mass);
    const MatrixXd K = M.solve(square(linear, linear.K)), C = M.solve(square(linear, linear.C));
    const double largest = std::max(std::sqrt(K.cwiseAbs().maxCoeff()), C.cwiseAbs().maxCoeff()),
                 unit = largest > 0 ? largest : 1;
    MatrixXd A = MatrixXd::Zero(2 * n, 2 * n);   // on (unit q, q'), whose entries are of one size
    A.topRightCorner(n, n).diagonal().setConstant(unit);
    A.bottomLeftCorner(n, n) = -K / unit;
    A.bottomRightCorner(n, n) = -C;
    const Eigen::EigenSolver<MatrixXd> solver(A);
    VectorXcd s = solver.eigenvalues();
    const MatrixXd idle = idle_directions(linear);
    std::vector<int> kept;
    for (int i = 0; i < 2 * n; ++i) {
        if (s(i).imag() >= 0 && std::norm(s(i)) > linear.rounding) kept.push_back(i);
        if (std::abs(s(i).real()) <= 1e-13 * unit) s(i).real(0);
    }
    const auto n_kept = static_cast<Eigen::Index>(kept.size());
    Roots roots{VectorXcd::Zero(idle.cols() + n_kept), MatrixXcd(n, idle.cols() + n_kept)};
    roots.q.leftCols(idle.cols()) = idle.cast<Complex>();
    for (Eigen::Index i = 0; i < n_kept; ++i) {
        roots.s(idle.cols() + i) = s(kept[static_cast<std::size_t>(i)]);
        roots.q.col(idle.cols() + i) = solver.eigenvectors().col(kept[static_cast<std::size_t>(i)]).head(n);
    }
    return roots;
}

Roots roots_of(const Linearisation& linear)
{
    return linear.is_conservative && is_undamped(linear) ? undamped_roots(linear) : general_roots(linear);
}

/// Turns and scales the displacements of all bodies as VibrationMode says.
void normalise(VectorXcd& twists, double length)
{
    double largest = 0;
    Eigen::Index first = 0;
    for (Eigen::Index i = 0; i < twists.size(); i += 3) {
        const double size = twists.segment(i, 3).norm() / (i % 6 == 0 ? length : 1);
        if (!(size > largest * (1 + 1e-9))) continue;   // of equal ones the first, whatever rounding says
        largest = size;
        first = i;
    }
    if (largest == 0) return;
    Eigen::Index most = first;
    for (Eigen::Index i = first; i < first + 3; ++i)
        if (std::abs(twists(i)) > std::abs(twists(most)) * (1 + 1e-9)) most = i;
    twists *= std::conj(twists(most)) / (std::abs(twists(most)) * largest);
}

}   // namespace

std::vector<VibrationMode> vibration_modes(const Linearisation& linear)
{
    std::vector<VibrationMode> modes;
    if (linear.n == 0) return modes;
    const Roots roots = roots_of(linear);
    const auto n_bodies = linear.state.X.size();
    const Eigen::Map<const ByRows> twists(linear.twists.data(), static_cast<Eigen::Index>(6 * n_bodies),
                                          linear.n);
    for (Eigen::Index i = 0; i < roots.s.size(); ++i) {
        VectorXcd moved = twists * roots.q.col(i);
        normalise(moved, linear.length);
        VibrationMode mode{roots.s(i), std::vector<BodyShape>(n_bodies)};
        for (std::size_t b = 0; b < n_bodies; ++b) {
            const auto first = static_cast<Eigen::Index>(6 * b);
            std::copy_n(moved.data() + first, 3, mode.bodies[b].displacement.begin());
            std::copy_n(moved.data() + first + 3, 3, mode.bodies[b].rotation.begin());
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
    if (linear.n == 0) return report;
    if (linear.is_conservative) {
        const MatrixXd K = square(linear, linear.K);
        const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(
            0.5 * (K + K.transpose()), square(linear, linear.M), Eigen::EigenvaluesOnly);
        for (const double k : solver.eigenvalues()) {
            report.n_unstable += k < -linear.rounding;
            report.n_neutral += std::abs(k) <= linear.rounding;
        }
    } else {
        const Roots roots = general_roots(linear);
        const double largest = roots.s.cwiseAbs().maxCoeff();
        for (const Complex& s : roots.s)   // a pair grows in two directions
            report.n_unstable += s.real() > 1e-10 * largest ? (s.imag() > 0 ? 2 : 1) : 0;
        report.n_neutral = static_cast<int>(idle_directions(linear).cols());
    }
    report.stability = report.n_unstable > 0  ? Stability::unstable
                       : report.n_neutral > 0 ? Stability::neutral
                                              : Stability::stable;
    return report;
}

}   // namespace livens
