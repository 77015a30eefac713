// SPDX-License-Identifier: BSD-3-Clause
// Which joints lock a mechanism where a march ends: the combination of independent rows that is nearest to
// zero, compared with the start. theory.md, "Singular positions", has the bounds (a hundredth, a fiftieth).
#include "livens/dynamics/start/locking.h"

#include <algorithm>
#include <cmath>

#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/solvers/dense.h"

namespace livens::inline dynamics_internal {

namespace {

constexpr std::size_t most_rows = 400;   // their matrix is dense
// Of the singular value at the start; of the square of the left vector.
constexpr double much_nearer = 1e-2, least_share = 0.02;

Model as_at(const Model& model, const State& state)
{
    return model.has_drives() ? frozen(model, {state.t}) : model;
}

/// What is nearest to nothing among combinations of rows, each of norm 1.
struct Nearest {
    double square = 1;             // of its size: the smallest eigenvalue of J J^T
    std::vector<double> factors;   // of the rows, of norm 1
};

Nearest nearest_to_nothing(const Model& model, const State& state, const std::vector<int>& rows)
{
    constexpr double shift = 1e-15;   // so that there is an inverse; below rounding nothing is told anyway
    constexpr int iterations = 12;
    const std::size_t m = rows.size();
    if (m == 0) return {};
    const TwistRows twists = twist_rows(as_at(model, state), state.X, rows);
    const auto product = [&](const BodyRow& a, const BodyRow& b) {
        double sum = 0;
        for (const BodyRow::Part& p : a.parts)
            for (const BodyRow::Part& q : b.parts)
                for (int i = 0; p.body == q.body && i < 6; ++i) sum += p.entries[i] * q.entries[i];
        return sum;
    };
    DenseLU lu;
    lu.resize(static_cast<int>(m));
    for (std::size_t i = 0; i < m; ++i)
        for (std::size_t j = 0; j < m; ++j)
            lu.row(static_cast<int>(i))[j] = product(twists.rows[i], twists.rows[j]) + (i == j ? shift : 0);
    Nearest nearest{0, std::vector<double>(m)};
    for (std::size_t i = 0; i < m; ++i)   // in no direction of symmetry
        nearest.factors[i] = 1 + 0.1 * static_cast<double>(i % 7);
    if (!lu.factorise()) return {};   // no numbers
    for (int k = 0; k < iterations; ++k) {
        // Inverse iteration on J J^T: the smallest eigenvalue is the square of the smallest singular value of
        // the rows.
        lu.solve(nearest.factors.data());
        double size = 0;
        for (const double x : nearest.factors) size += x * x;
        size = std::sqrt(size);
        nearest.square = std::max(1 / size - shift, 0.0);   // once the vector before had norm 1
        for (double& x : nearest.factors) x /= size;
    }
    return nearest;
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
    const Nearest nearest = nearest_to_nothing(model, now, rows);
    if (!(nearest.square < much_nearer * much_nearer * nearest_to_nothing(model, before, rows).square))
        return {};
    std::vector<double> parts(model.joints().size(), 0.0);
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const double part = nearest.factors[r];
        parts[static_cast<std::size_t>(model.row_joint(rows[r]))] += part * part;
    }
    Lock lock;
    for (int j = 0; j < static_cast<int>(parts.size()); ++j) {
        if (model.joints()[j].type != "drive") {
            if (parts[static_cast<std::size_t>(j)] > least_share) lock.joints.push_back(j);
            continue;
        }
        // a row of a torque weighs less than those of forces: what counts is whether the others hold alone
        std::vector<int> others;
        for (const int r : rows)
            if (model.row_joint(r) != j) others.push_back(r);
        if (others.size() == rows.size()) continue;
        // Of squares: a tenth of the singular value.
        if (nearest.square < much_nearer * nearest_to_nothing(model, now, others).square)
            lock.drives.push_back(j);
    }
    std::vector<int> moving;   // what stands still asks for nothing new
    for (const int j : lock.drives)
        if (!is_at_rest(model, j, before.t, now.t)) moving.push_back(j);
    if (!moving.empty()) lock.drives = moving;
    return lock;
}

}   // namespace livens::inline dynamics_internal
