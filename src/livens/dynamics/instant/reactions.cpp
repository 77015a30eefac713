// SPDX-License-Identifier: BSD-3-Clause
#include "livens/dynamics/instant/reactions.h"

#include <algorithm>

#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/multibody/motion.h"
#include "livens/solvers/factors.h"
#include "livens/solvers/spectral.h"

namespace livens {

namespace {

/// [f; t / L] of a joint for a multiplier of one in each of its rows. `zeros`: of all rows.
DenseMatrix unit_reactions(const Model& model, int joint, std::span<const Matrix34> X, double length,
                           std::vector<double>& zeros)
{
    const int n = static_cast<int>(model.joints()[joint].rows.size());
    DenseMatrix A(6, n);
    for (int k = 0; k < n; ++k) {
        double& unit = zeros[model.first_row(joint) + k];
        unit = 1;
        const Reaction reaction = joint_reaction(model, joint, X, zeros);
        unit = 0;
        for (int i = 0; i < 3; ++i) {
            A(i, k) = reaction.force[i];
            A(3 + i, k) = reaction.torque[i] / length;
        }
    }
    return A;
}

/// R with |R lambda| = |A lambda|, kept regular by 1e-8 of the rows where some of them say the same.
DenseMatrix root_metric(const DenseMatrix& A, std::span<const double> sizes)
{
    DenseMatrix tall(A.rows + A.cols, A.cols);
    tall.set_rows(0, A);
    for (int k = 0; k < A.cols; ++k) tall(A.rows + k, k) = 1e-8 * sizes[k];
    return upper_factor(tall);
}

constexpr double least_part = 1e-9;   // of a null vector

}   // namespace

std::string in_words(const SharedComponents& shared)
{
    constexpr std::array<const char*, 6> names{"force x",  "force y",  "force z",
                                               "torque x", "torque y", "torque z"};
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (shared[i]) text += (text.empty() ? "" : ", ") + std::string(names[i]);
    return text;
}

/// In the coordinates rho = R lambda, joint by joint, least is what is perpendicular to all null vectors.
UniqueReactions least_reactions(const Model& model, std::span<const Matrix34> X,
                                std::span<const double> multipliers, std::span<const int> independent)
{
    const int n = model.n_rows(), n_null = n - static_cast<int>(independent.size());
    const int n_joints = static_cast<int>(model.joints().size());
    UniqueReactions result{{multipliers.begin(), multipliers.end()},
                           std::vector<bool>(n_joints, true),
                           std::vector<SharedComponents>(n_joints, SharedComponents{}),
                           0};
    if (n_null <= 0) return result;

    const Dependencies known = dependencies(model, X, independent);
    DenseMatrix null(n, n_null);
    for (int k = 0; k < n_null; ++k) {
        null(known.dependent[k], k) = 1;
        for (std::size_t i = 0; i < known.independent.size(); ++i)
            null(known.independent[i], k) = -known.factors[k][i];
    }
    DenseMatrix rho({n, static_cast<int>(multipliers.size()) / n, multipliers.data()});
    std::vector<DenseMatrix> A, R;
    std::vector<double> zeros(static_cast<std::size_t>(n), 0.0);
    const double length = model.length();
    for (int j = 0; j < n_joints; ++j) {
        A.push_back(unit_reactions(model, j, X, length, zeros));
        const int at = model.first_row(j), m = A[j].cols;
        R.push_back(root_metric(A[j], std::span(known.sizes).subspan(at, m)));
        null.set_rows(at, product(R[j], null.middle_rows(at, m)));
        rho.set_rows(at, product(R[j], rho.middle_rows(at, m)));
    }
    null = orthonormal_columns(null);
    add_scaled(rho.a, -1, product(null, transposed_product(null, rho)).a);
    for (int j = 0; j < n_joints; ++j) {
        const int at = model.first_row(j), m = A[j].cols;
        const DenseMatrix parts = product(A[j], upper_solution(R[j], null.middle_rows(at, m)));
        const double part = singular_values(parts)[0];
        result.largest_null = std::max(result.largest_null, part);
        if (part <= least_part) continue;
        result.joint_is_unique[j] = false;
        const std::vector<double> in_rows = row_norms(parts);
        for (int i = 0; i < 6; ++i) result.shared[j][i] = in_rows[i] > least_part / 3;   // one is
        for (int set = 0; set < rho.cols; ++set) {
            const std::vector<double> lambda = upper_solution(R[j], rho.column(set).subspan(at, m));
            std::ranges::copy(lambda, result.multipliers.begin() + set * n + at);
        }
    }
    return result;
}

}   // namespace livens
