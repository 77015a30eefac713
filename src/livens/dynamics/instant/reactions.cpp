// SPDX-License-Identifier: BSD-3-Clause
// Reactions of redundant joints with the least sum of squares: docs/theory.md, "Least reactions".
#include "livens/dynamics/instant/reactions.h"

#include <algorithm>

#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/solvers/factors.h"

namespace livens {

namespace {

constexpr double least_part = 1e-9;      // of a null vector
constexpr double share_of_rows = 1e-8;   // in the sum of squares

/// What the sum of squares is made of, by multipliers: of each joint [f; t / L] on its second body, at its
/// point, and behind them 1e-8 of the rows, which decide where some of them say the same.
class WrenchTerms {
public:
    WrenchTerms(const Model& model, const RowWrenches& wrenches, std::span<const double> sizes)
        : model_(model), wrenches_(wrenches), sizes_(sizes),
          n_joints_(static_cast<int>(model.joints().size()))
    {}

    int n() const { return 6 * n_joints_ + model_.n_rows(); }
    void add(const double* multipliers, double* terms) const
    {
        const double length = model_.length();
        for (int r = 0; r < model_.n_rows(); ++r) {
            const int joint = model_.row_joint(r);
            for (const Wrench& wrench : wrenches_[r])
                for (int i = 0; wrench.body == model_.joints()[joint].second && i < 3; ++i) {
                    terms[6 * joint + i] -= multipliers[r] * wrench.force[i];
                    terms[6 * joint + 3 + i] -= multipliers[r] * wrench.moment[i] / length;
                }
            terms[6 * n_joints_ + r] += share_of_rows * sizes_[r] * multipliers[r];
        }
    }

private:
    const Model& model_;
    const RowWrenches& wrenches_;
    std::span<const double> sizes_;
    int n_joints_;
};

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

/// lambda + N c with the least |terms(lambda + N c)|: with terms(N) = Q R, N a basis of null vectors, the
/// part of terms(lambda) along Q is taken off. In each joint Q has the parts of null vectors that are
/// orthonormal there.
/// Where a joint has more than least_part, one of its six components has more than a third of that, as
/// sqrt(6) < 3.
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

    const RowWrenches wrenches = row_wrenches(model, X);
    const Dependencies known = dependencies(model, X, independent, wrenches);
    const WrenchTerms terms(model, wrenches, known.sizes);
    const int n_sets = static_cast<int>(multipliers.size()) / n;
    DenseMatrix null(n, n_null), of_null(terms.n(), n_null), of_sets(terms.n(), n_sets);
    for (int k = 0; k < n_null; ++k) {
        null(known.dependent[k], k) = 1;
        for (std::size_t i = 0; i < known.independent.size(); ++i)
            null(known.independent[i], k) = -known.factors[k][i];
        terms.add(null.column(k).data(), &of_null(0, k));
    }
    for (int set = 0; set < n_sets; ++set) terms.add(multipliers.data() + set * n, &of_sets(0, set));
    const DenseMatrix Q = orthonormal_columns(of_null);
    const DenseMatrix along =
        product(null, upper_solution(transposed_product(Q, of_null), transposed_product(Q, of_sets)));
    for (int j = 0; j < n_joints; ++j) {
        const std::vector<double> in_rows = row_norms(Q.middle_rows(6 * j, 6));
        const double part = norm(in_rows);
        result.largest_null = std::max(result.largest_null, part);
        if (part <= least_part) continue;
        result.joint_is_unique[j] = false;
        for (int i = 0; i < 6; ++i) result.shared[j][i] = in_rows[i] > least_part / 3;   // one is
        for (int set = 0; set < n_sets; ++set)
            for (int r = model.first_row(j); r < n && model.row_joint(r) == j; ++r)
                result.multipliers[set * n + r] -= along(r, set);
    }
    return result;
}

}   // namespace livens
