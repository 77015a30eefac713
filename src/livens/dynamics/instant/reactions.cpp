// SPDX-License-Identifier: BSD-3-Clause
#include "livens/dynamics/instant/reactions.h"

#include <algorithm>

#include <Eigen/Dense>

#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/multibody/motion.h"

namespace livens {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// [f; t / L] of a joint for a multiplier of one in each of its rows. `zeros`: of all rows.
MatrixXd unit_reactions(const Model& model, int joint, std::span<const Matrix34> X, double length,
                        std::vector<double>& zeros)
{
    const Index n = static_cast<Index>(model.joints()[joint].rows.size());
    MatrixXd A(6, n);
    for (Index k = 0; k < n; ++k) {
        double& unit = zeros[model.first_row(joint) + static_cast<int>(k)];
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
MatrixXd root_metric(const MatrixXd& A, const Eigen::Map<const VectorXd>& sizes)
{
    MatrixXd tall = MatrixXd::Zero(A.rows() + A.cols(), A.cols());
    tall.topRows(A.rows()) = A;
    tall.bottomRows(A.cols()).diagonal() = 1e-8 * sizes;
    const Eigen::HouseholderQR<MatrixXd> qr(tall);
    return qr.matrixQR().topRows(A.cols()).triangularView<Eigen::Upper>();
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
    const Index n = model.n_rows(), n_null = n - static_cast<Index>(independent.size());
    const int n_joints = static_cast<int>(model.joints().size());
    UniqueReactions result{{multipliers.begin(), multipliers.end()},
                           std::vector<bool>(n_joints, true),
                           std::vector<SharedComponents>(n_joints, SharedComponents{}),
                           0};
    if (n_null <= 0) return result;

    const Dependencies known = dependencies(model, X, independent);
    MatrixXd null = MatrixXd::Zero(n, n_null);
    for (Index k = 0; k < n_null; ++k) {
        null(known.dependent[k], k) = 1;
        for (std::size_t i = 0; i < known.independent.size(); ++i)
            null(known.independent[i], k) = -known.factors[k][i];
    }
    MatrixXd rho =
        Eigen::Map<const MatrixXd>(multipliers.data(), n, static_cast<Index>(multipliers.size()) / n);
    std::vector<MatrixXd> A, R;
    std::vector<double> zeros(static_cast<std::size_t>(n), 0.0);
    const double length = model.length();
    for (int j = 0; j < n_joints; ++j) {
        A.push_back(unit_reactions(model, j, X, length, zeros));
        const Index at = model.first_row(j), m = A[j].cols();
        R.push_back(root_metric(A[j], Eigen::Map<const VectorXd>(known.sizes.data() + at, m)));
        null.middleRows(at, m) = R[j] * null.middleRows(at, m);
        rho.middleRows(at, m) = R[j] * rho.middleRows(at, m);
    }
    const Eigen::HouseholderQR<MatrixXd> qr(null);
    null = qr.householderQ() * MatrixXd::Identity(n, n_null);
    rho -= null * (null.transpose() * rho);
    for (int j = 0; j < n_joints; ++j) {
        const Index at = model.first_row(j), m = A[j].cols();
        const auto solver = R[j].triangularView<Eigen::Upper>();
        const MatrixXd parts = A[j] * solver.solve(null.middleRows(at, m));
        const double part = Eigen::JacobiSVD<MatrixXd>(parts).singularValues()[0];
        result.largest_null = std::max(result.largest_null, part);
        if (part <= least_part) continue;
        result.joint_is_unique[j] = false;
        for (Index i = 0; i < 6; ++i) result.shared[j][i] = parts.row(i).norm() > least_part / 3;   // one is
        for (Index set = 0; set < rho.cols(); ++set) {
            const VectorXd lambda = solver.solve(rho.col(set).segment(at, m));
            std::copy(lambda.begin(), lambda.end(), result.multipliers.begin() + set * n + at);
        }
    }
    return result;
}

}   // namespace livens
