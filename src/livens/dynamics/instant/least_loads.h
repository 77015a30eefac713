// SPDX-License-Identifier: BSD-3-Clause
// The least reactions of redundant joints, of many states one after the other.
#pragma once

#include <span>
#include <vector>

#include "livens/dynamics/rows/row_tables.h"
#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"

namespace livens::inline dynamics_internal {

/// Rows of a joint and bodies that they touch. Moments are by the length of the model.
struct LoadsOfJoint {
    int first_row = 0, n_rows = 0;
    std::vector<int> bodies{};
    std::vector<double> reactions{};   ///< on the second body about the joint's point, 6 numbers a row
    std::vector<double> square{};      ///< Cholesky factor of their products
    std::vector<double> loads{};       ///< on the bodies about their poles, 6 numbers each, row by row
    std::vector<double> scaled{};      ///< the inverse factor times them
    std::vector<double> sums{};        ///< one a row
    std::vector<Vector3> poles{};      ///< of the bodies, from their origins, in space
};

/// What least_reactions() says of forces and torques, without what it says of which of them are unique, for a
/// tenth of the work. With M the sum of squares joint by joint, lambda = M^-1 G y and
/// (G^T M^-1 G) y = G^T lambda_given have the least sum among all multipliers that move the bodies alike, and
/// no null vector is asked for.
class LeastLoads {
public:
    /// `n_independent`: of the model's rows. References must outlive it.
    LeastLoads(const Model& model, const RowTables& rows, int n_independent);

    /// What joints exert on their second bodies by one set of multipliers or several, joint by joint, set by
    /// set. Null where least_reactions() has to be asked: it is not clear which directions are free (squared
    /// pivots between 1e-9 and 1e-6), rows of a joint say nearly the same, or bodies that hang together are
    /// far apart in their order.
    const Reaction* find(double t, std::span<const Matrix34> X, std::span<const double> multipliers);

private:
    using Part = LoadsOfJoint;

    Part part_of(int joint);
    void find_profile();
    void form(const Joint& joint, Instant at, std::span<const Matrix34> X, Part& part) const;
    void add(Part& part);
    bool factorise();
    void solve(double* y) const;
    double add_least(const std::vector<double>& push);
    void add_push(const double* multipliers, double factor, std::vector<double>& push) const;
    bool find_set(const double* multipliers, Reaction* reactions);
    double* line(int row) { return matrix_.data() + begin_[row]; }
    const double* line(int row) const { return matrix_.data() + begin_[row]; }

    const Model& model_;
    const RowTables& tables_;
    int n_independent_;
    double length_;
    bool serves_ = true;
    std::vector<Vector3> poles_;   // of bodies, in their coordinates
    std::vector<Part> parts_;      // joint by joint
    std::vector<int> first_,
        begin_;   // column and place of each line of G^T M^-1 G, which end at the diagonal
    std::vector<double> matrix_, push_, left_, y_, lambda_;
    std::vector<Reaction> found_;
};

}   // namespace livens::inline dynamics_internal
