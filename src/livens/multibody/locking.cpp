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

/// Whether no row of a drive moves at any of some instants.
bool is_at_rest(const Model& model, int joint, double start, double end)
{
    constexpr int looks = 16;
    const int first = model.first_row(joint), n = static_cast<int>(model.joints()[joint].rows.size());
    for (int r = first; r < first + n; ++r)
        for (const Drive& drive : model.row(r).drives)
            for (int i = 0; i <= looks; ++i)
                if (drive.factor({start + (end - start) * i / looks, Side::middle}).first != 0) return false;
    return true;
}

}   // namespace

Lock joints_that_lock(const Model& model, const State& before, const State& now)
{
    if (model.n_rows() == 0 || model.has_events() || static_cast<std::size_t>(model.n_rows()) > most_rows)
        return {};
    const std::vector<int> rows = row_rank(as_at(model, before), before.X, all_rows(model)).independent;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> held(products(model, before, rows), Eigen::EigenvaluesOnly),
        left(products(model, now, rows));
    const double nearest = left.eigenvalues()[0];
    if (!(nearest < much_nearer * much_nearer * held.eigenvalues()[0])) return {};
    std::vector<double> parts(model.joints().size(), 0.0);
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const double part = left.eigenvectors()(static_cast<Index>(r), 0);
        parts[static_cast<std::size_t>(model.row_joint(rows[r]))] += part * part;
    }
    Lock lock;
    for (int j = 0; j < static_cast<int>(parts.size()); ++j) {
        if (model.joints()[j].type != "drive") {
            if (parts[static_cast<std::size_t>(j)] > least_part) lock.joints.push_back(j);
            continue;
        }
        // a row of a torque weighs less than those of forces: what counts is whether the others hold alone
        std::vector<int> others;
        for (const int r : rows)
            if (model.row_joint(r) != j) others.push_back(r);
        if (others.size() == rows.size()) continue;
        const Eigen::SelfAdjointEigenSolver<MatrixXd> alone(products(model, now, others),
                                                            Eigen::EigenvaluesOnly);
        if (alone.eigenvalues().size() == 0 || nearest < much_nearer * alone.eigenvalues()[0])
            lock.drives.push_back(j);
    }
    std::erase_if(lock.drives, [&](int j) {   // what stands still asks for nothing new
        return lock.drives.size() > 1 && is_at_rest(model, j, before.t, now.t);
    });
    return lock;
}

}   // namespace livens
