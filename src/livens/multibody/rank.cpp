// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/rank.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "livens/multibody/rows.h"
#include "livens/multibody/sparse_rows.h"

namespace livens {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double eps = std::numeric_limits<double>::epsilon();

// --- inertia

/// An axis through the centre of mass without inertia.
struct FreeAxis {
    int body;
    Vector3 axis;      ///< world axes
    Vector3 center;    ///< of mass, body coordinates
    double gyration;   ///< m
    double doubt;      ///< of the direction, rad
};

void add_free_axes(int b, const Body& body, const Matrix34& X, std::vector<FreeAxis>& free)
{
    const MassProperties known = mass_properties(body.mass);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> J(
        Eigen::Map<const Eigen::Matrix3d>(known.inertia.data()));
    const double level = 16 * eps * (body.mass(1, 1) + body.mass(2, 2) + body.mass(3, 3));
    const double gyration = std::sqrt(std::max(J.eigenvalues()[2], 0.0) / known.mass);
    int n = 0;
    while (n < 3 && J.eigenvalues()[n] <= level) ++n;
    const double doubt = n < 3 ? level / J.eigenvalues()[n] : 0;
    for (int k = 0; k < n; ++k) {
        const Eigen::Vector3d a = J.eigenvectors().col(k);
        free.push_back({b, X * direction({a[0], a[1], a[2]}), known.center_of_mass, gyration, doubt});
    }
}

/// The moment of a row about the axis; zero if it is not above what is known.
double hold_of(const Wrench& w, const Matrix34& X, const FreeAxis& free)
{
    const double force = norm(w.force);
    const double size = norm(w.moment) + (norm(w.at - free.center) + free.gyration) * force;
    const double digits = 8 * eps * (norm(X.column(0)) + norm(w.at) + norm(free.center)) * force;
    const double moment = dot(free.axis, moment_about(w, X, free.center));
    return std::abs(moment) > (1e-9 + free.doubt) * size + digits ? moment : 0;
}

/// Spins about the free axes that no row holds, a combination in each column.
MatrixXd unheld_spins(std::span<const Matrix34> X, const RowWrenches& wrenches,
                      const std::vector<FreeAxis>& free)
{
    MatrixXd H = MatrixXd::Zero(static_cast<Index>(std::max<std::size_t>(wrenches.size(), 1)),
                                static_cast<Index>(free.size()));
    for (std::size_t r = 0; r < wrenches.size(); ++r)
        for (std::size_t k = 0; k < free.size(); ++k)
            for (const Wrench& w : wrenches[r])
                if (w.body == free[k].body)
                    H(static_cast<Index>(r), static_cast<Index>(k)) += hold_of(w, X[w.body], free[k]);
    for (auto row : H.rowwise()) row.stableNormalize();
    Eigen::FullPivLU<MatrixXd> lu(H);
    lu.setThreshold(1e-9);
    return lu.dimensionOfKernel() > 0 ? MatrixXd(lu.kernel()) : MatrixXd(H.cols(), 0);
}

// --- rank

/// What the twists of a body are measured by, see twist_rows().
struct Pole {
    Vector3 point{};
    double length = 0;
    double reach = 0;   ///< of positions and joint points
};

std::vector<Pole> poles_of(const Model& model, std::span<const Matrix34> X, const RowWrenches& wrenches)
{
    std::vector<Pole> poles(X.size());
    std::vector<double> counts(X.size(), 0.0);
    const auto each = [&](const auto& act) {
        for (const auto& row : wrenches)
            for (const Wrench& w : row) act(w, poles[w.body]);
    };
    each([&](const Wrench& w, Pole& pole) {
        pole.point += (1 / ++counts[w.body]) * (w.at - pole.point);
        pole.reach = std::max(pole.reach, norm(X[w.body].column(0)) + norm(w.at));
    });
    double largest = 0;
    each([&](const Wrench& w, Pole& pole) {
        const double force = norm(w.force);
        if (force == 0) return;
        const double arm = std::max(norm(w.at - pole.point), norm(w.moment) / force);
        if (arm > 1e-13 * pole.reach) pole.length = std::max(pole.length, arm);
        largest = std::max(largest, pole.length);
    });
    if (largest == 0) largest = model.length();
    for (Pole& pole : poles) pole.length = std::sqrt((pole.length > 0 ? pole.length : largest) * largest);
    return poles;
}

}   // namespace

TwistRows twist_rows(const Model& model, std::span<const Matrix34> X, std::span<const int> rows)
{
    const RowWrenches wrenches = row_wrenches(model, X);
    const std::size_t n = rows.size();
    TwistRows result{std::vector<double>(n * 6 * X.size()), 0};
    const std::vector<Pole> poles = poles_of(model, X, wrenches);
    for (const Pole& pole : poles) result.doubt = std::max(result.doubt, 8 * eps * pole.reach / pole.length);
    for (std::size_t k = 0; k < n; ++k) {
        for (const Wrench& w : wrenches[rows[k]]) {
            double* line = &result.columns[n * 6 * w.body + k];
            const Vector3 moment = moment_about(w, X[w.body], poles[w.body].point);
            for (int i = 0; i < 3; ++i) {
                line[n * i] += w.force[i];
                line[n * (3 + i)] += moment[i] / poles[w.body].length;
            }
            result.doubt = std::max(result.doubt, w.doubt);
        }
    }
    return result;
}

namespace {

/// Rows that hold so well by elimination are independent by any judge.
constexpr double well_held = 1e-3;

/// Of the rows of twist_rows(); a number on which masses have no influence.
double pivot_by_elimination(const Model& model, std::span<const Matrix34> X, std::span<const int> rows)
{
    const RowWrenches wrenches = row_wrenches(model, X);
    const std::vector<Pole> poles = poles_of(model, X, wrenches);
    std::vector<SparseRows::Entry> entries;
    for (int k = 0; k < static_cast<int>(rows.size()); ++k)
        for (const Wrench& w : wrenches[rows[k]]) {
            const Vector3 moment = moment_about(w, X[w.body], poles[w.body].point);
            for (int i = 0; i < 3; ++i) {
                entries.push_back({k, 6 * w.body + i, w.force[i]});
                entries.push_back({k, 6 * w.body + 3 + i, moment[i] / poles[w.body].length});
            }
        }
    return SparseRows(static_cast<int>(rows.size()), 6 * model.n_bodies(), entries).smallest_pivot();
}

}   // namespace

RowRank row_rank(const Model& model, std::span<const Matrix34> X, std::span<const int> rows, double threshold)
{
    RowRank rank;
    if (rows.empty()) return rank;
    rank.smallest_pivot = pivot_by_elimination(model, X, rows);
    if (rank.smallest_pivot > well_held) {
        rank.independent.assign(rows.begin(), rows.end());
        std::ranges::sort(rank.independent);
        return rank;
    }
    rank.smallest_pivot = 1;
    TwistRows lines = twist_rows(model, X, rows);
    Eigen::Map<MatrixXd> G(lines.columns.data(), static_cast<Index>(rows.size()), 6 * model.n_bodies());
    threshold = std::max(threshold, std::min(lines.doubt, 1e-4));
    for (Index r = 0; r < G.rows(); ++r) {
        G.row(r).stableNormalize();
        // ties go to the row that comes first
        G.row(r) *= 1 - 1e-3 * static_cast<double>(r) / static_cast<double>(G.rows());
    }
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(G.transpose());
    const VectorXd pivots = qr.matrixQR().diagonal().cwiseAbs();
    Index k = 0;
    while (k < pivots.size() && pivots[k] > threshold * pivots[0]) ++k;
    if (k > 0) rank.smallest_pivot = pivots[k - 1] / pivots[0];
    for (Index i = 0; i < G.rows(); ++i)
        (i < k ? rank.independent : rank.dependent).push_back(rows[qr.colsPermutation().indices()[i]]);
    std::ranges::sort(rank.independent);
    std::ranges::sort(rank.dependent);
    return rank;
}

std::optional<WeightlessSpin> weightless_spin(const Model& model, std::span<const Matrix34> X)
{
    std::vector<FreeAxis> free;
    for (int b = 0; b < model.n_bodies(); ++b)
        if (!model.bodies()[b].is_point) add_free_axes(b, model.bodies()[b], X[b], free);
    if (free.empty()) return {};
    const MatrixXd spins = unheld_spins(X, row_wrenches(model, X), free);
    if (spins.cols() == 0) return {};
    std::vector<Vector3> w(X.size());
    for (std::size_t k = 0; k < free.size(); ++k)
        w[free[k].body] += spins(static_cast<Index>(k), 0) * free[k].axis;
    const auto fastest = std::ranges::max_element(w, {}, [](const Vector3& v) { return norm(v); });
    WeightlessSpin spin;
    spin.body = static_cast<int>(fastest - w.begin());
    spin.axis = (1 / norm(*fastest)) * *fastest;
    if (std::ranges::max(spin.axis.a) < -std::ranges::min(spin.axis.a)) spin.axis *= -1;
    const MassProperties known = mass_properties(model.bodies()[spin.body].mass);
    const double remote = known.mass * dot(known.center_of_mass, known.center_of_mass);
    spin.by_digits = 16 * eps * remote > 1e-9 * trace(known.inertia);
    return spin;
}

}   // namespace livens
