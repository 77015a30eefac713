// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/reactions.h"

#include <algorithm>

#include <Eigen/Dense>

#include "livens/multibody/motion.h"
#include "livens/multibody/rank.h"
#include "livens/multibody/rows.h"

namespace livens {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// [f; t / L] of a joint for a multiplier of one in each of its rows.
MatrixXd unit_reactions(const Model& model, int joint, std::span<const Matrix34> X)
{
    const Index n = static_cast<Index>(model.joints()[joint].rows.size());
    std::vector<double> multipliers(model.n_rows(), 0.0);
    MatrixXd A(6, n);
    for (Index k = 0; k < n; ++k) {
        double& unit = multipliers[model.first_row(joint) + static_cast<int>(k)];
        unit = 1;
        const Reaction reaction = joint_reaction(model, joint, X, multipliers);
        unit = 0;
        for (int i = 0; i < 3; ++i) {
            A(i, k) = reaction.force[i];
            A(3 + i, k) = reaction.torque[i] / model.length();
        }
    }
    return A;
}

/// R with |R lambda| = |A lambda|, kept regular by 1e-8 of the rows where some of them say the same.
MatrixXd root_metric(const MatrixXd& A, const VectorXd& sizes)
{
    MatrixXd tall = MatrixXd::Zero(A.rows() + A.cols(), A.cols());
    tall.topRows(A.rows()) = A;
    tall.bottomRows(A.cols()).diagonal() = 1e-8 * sizes;
    const Eigen::HouseholderQR<MatrixXd> qr(tall);
    return qr.matrixQR().topRows(A.cols()).triangularView<Eigen::Upper>();
}

}   // namespace

/// In the coordinates rho = R lambda, joint by joint, least is what is perpendicular to all null vectors.
UniqueReactions least_reactions(const Model& model, std::span<const Matrix34> X,
                                std::span<const double> multipliers, std::span<const int> independent)
{
    const Index n = model.n_rows(), n_null = n - static_cast<Index>(independent.size());
    const int n_joints = static_cast<int>(model.joints().size());
    UniqueReactions result{{multipliers.begin(), multipliers.end()}, std::vector<bool>(n_joints, true), 0};
    if (n_null <= 0) return result;

    const std::vector<double> columns = twist_rows(model, X, all_rows(model)).columns;
    MatrixXd T = Eigen::Map<const MatrixXd>(columns.data(), n, 6 * model.n_bodies());
    VectorXd rho = Eigen::Map<const VectorXd>(multipliers.data(), n);
    std::vector<MatrixXd> A, R;
    for (int j = 0; j < n_joints; ++j) {
        A.push_back(unit_reactions(model, j, X));
        const Index at = model.first_row(j), m = A[j].cols();
        R.push_back(root_metric(A[j], T.middleRows(at, m).rowwise().norm()));
        T.middleRows(at, m) = R[j].transpose().triangularView<Eigen::Lower>().solve(T.middleRows(at, m));
        rho.segment(at, m) = R[j] * rho.segment(at, m);
    }
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(T);
    MatrixXd null = MatrixXd::Identity(n, n).rightCols(n_null);
    null.applyOnTheLeft(qr.householderQ());
    rho -= null * (null.transpose() * rho);
    for (int j = 0; j < n_joints; ++j) {
        const Index at = model.first_row(j), m = A[j].cols();
        const auto solver = R[j].triangularView<Eigen::Upper>();
        const MatrixXd parts = A[j] * solver.solve(null.middleRows(at, m));
        const double part = Eigen::JacobiSVD<MatrixXd>(parts).singularValues()[0];
        result.largest_null = std::max(result.largest_null, part);
        if (part <= 1e-9) continue;
        result.joint_is_unique[j] = false;
        const VectorXd lambda = solver.solve(rho.segment(at, m));
        std::copy(lambda.begin(), lambda.end(), result.multipliers.begin() + at);
    }
    return result;
}

}   // namespace livens
