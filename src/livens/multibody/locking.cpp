// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/locking.h"

#include <Eigen/Dense>

#include "livens/multibody/rank.h"
#include "livens/multibody/rows.h"

namespace livens {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr std::size_t most_rows = 400;   // their matrix is dense
constexpr double much_nearer = 1e-2, least_part = 0.02;

Model as_at(const Model& model, const State& state)
{
    return model.has_drives() ? frozen(model, {state.t}) : model;
}

/// Products of the rows, each of norm 1.
MatrixXd products(const Model& model, const State& state, const std::vector<int>& rows)
{
    const TwistRows twists = twist_rows(as_at(model, state), state.X, rows);
    MatrixXd J = MatrixXd::Zero(static_cast<Index>(rows.size()), 6 * model.n_bodies());
    for (std::size_t r = 0; r < rows.size(); ++r)
        for (const BodyRow::Part& part : twists.rows[r].parts)
            for (int i = 0; i < 6; ++i) J(static_cast<Index>(r), 6 * part.body + i) += part.entries[i];
    return J * J.transpose();
}

}   // namespace

std::vector<int> joints_that_lock(const Model& model, const State& before, const State& now)
{
    if (model.n_rows() == 0 || model.has_events() || static_cast<std::size_t>(model.n_rows()) > most_rows)
        return {};
    const std::vector<int> rows = row_rank(as_at(model, before), before.X, all_rows(model)).independent;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> held(products(model, before, rows), Eigen::EigenvaluesOnly),
        left(products(model, now, rows));
    if (!(left.eigenvalues()[0] < much_nearer * much_nearer * held.eigenvalues()[0])) return {};
    std::vector<double> parts(model.joints().size(), 0.0);
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const double part = left.eigenvectors()(static_cast<Index>(r), 0);
        parts[static_cast<std::size_t>(model.row_joint(rows[r]))] += part * part;
    }
    std::vector<int> joints;
    for (std::size_t j = 0; j < parts.size(); ++j)
        if (parts[j] > least_part) joints.push_back(static_cast<int>(j));
    return joints;
}

}   // namespace livens
