// The linear algebra behind assembly: twist Jacobian, rank, and moving a configuration onto its constraints.
#pragma once

#include <span>
#include <vector>

#include "livens/multibody/model.h"

namespace livens {

/// Motion of all bodies as twists: six numbers a body, [dphi, w] with dX = [dphi, w x d_i]; a point mass has
/// three, dphi.
struct TwistLayout {
    explicit TwistLayout(const Model& model);

    std::vector<int> first;   ///< of each body
    int size = 0;
};

/// What the rows of a model hold in one configuration.
///
/// The twist Jacobian Ghat = G N has, for a row with gradient g on a body, the columns
/// [g_0 ; sum_i d_i x g_i]. Its columns are scaled by 1/sqrt(M) (translation) and 1/(sqrt(M) r) (rotation),
/// r^2 = tr E / M but at least 1e-4 of the model's length, and its rows to norm 1; then a QR decomposition
/// with column pivoting of the transpose is the judge: rank = number of |R_kk| > 1e-9 |R_00|.
struct RowRank {
    std::vector<int> independent;   ///< rows of the model, ascending
    std::vector<int> dependent;     ///< the others, ascending
    double smallest_pivot = 1;      ///< |R_kk| / |R_00| of the last independent row
    /// Twists of a motion that no row holds and that carries no inertia: the eigenvector of the smallest
    /// eigenvalue of Z^T Mr Z in scaled twists if that is below 1e-12, Z an orthonormal basis of the null
    /// space of the rows. Empty if there is none.
    std::vector<double> weightless_motion;
};
RowRank row_rank(const Model& model, std::span<const Matrix34> X);

/// Phi of the model's rows, and dPhi/dt = G V.
std::vector<double> joint_values(const Model& model, std::span<const Matrix34> X);
std::vector<double> joint_rates(const Model& model, std::span<const Matrix34> X, std::span<const Matrix34> V);

/// Rounding level of Phi of every row: 4 eps max(sum of the absolute terms of Phi, scale).
std::vector<double> joint_rounding(const Model& model, std::span<const Matrix34> X);

/// Largest |dPhi/dt| of every row that velocities up to `speed` can make (m/s; speed / model length in
/// rad/s).
std::vector<double> joint_rate_bounds(const Model& model, std::span<const Matrix34> X, double speed);

struct Closing {
    /// Every |Phi| is at its rounding level, or as near as 100 iterations come and |Phi| / scale < 1e-12.
    bool closed = false;
    std::vector<Matrix34> X;
};

/// Moves X onto the given rows, directors by rotation only (d_i <- exp(w) d_i).
///
/// Every iteration solves  [M  G^T; G  -delta] [dx; lambda] = [-g; -Phi]  in scaled twists: the step of Gauss
/// and Newton in the mass metric, with delta = 1e-8 (1e-14 when that gets stuck) so that redundant rows do no
/// harm. If `nearest`, g = N^T (X - X_given) m first leads to the nearest configuration, 1/2 tr((X - X_given)
/// m (X - X_given)^T) -> min; otherwise, and in the end, g = 0. Elimination keeps the zeros of planar data
/// exactly zero.
Closing close_rows(const Model& model, std::span<const Matrix34> X_given, std::span<const int> rows,
                   bool nearest);

/// The rates [v, w x d_i] nearest to V in the mass metric with dPhi/dt = 0 for the given rows, which must be
/// independent.
std::vector<Matrix34> nearest_rates(const Model& model, std::span<const Matrix34> X,
                                    std::span<const Matrix34> V, std::span<const int> rows);

}   // namespace livens
