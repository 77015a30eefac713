// SPDX-License-Identifier: BSD-3-Clause
// Which joint rows are independent in a configuration, and whether what they leave free has inertia.
//
// Rank is geometry: no mass enters it. Inertia is judged by the digits that mass matrices hold.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "livens/dynamics/rows/forest.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/multibody/model.h"

namespace livens::inline dynamics_internal {

/// The twist Jacobian without masses: of each given row six entries for every body that it touches, [force,
/// moment / length] about the mean of the body's joint points, scaled to norm 1. The length is sqrt(a A) with
/// the arm a of the body, its largest distance of a joint point from that mean or |moment| / |force| of a
/// row, and the largest arm A: rows of points want a; rows of axes, which compare the spins of two bodies,
/// want one length. An arm counts if it is above 1e-13 of the distances that it is a difference of; else A
/// stands for it, or Model::length() without any arm.
struct TwistRows {
    std::vector<BodyRow> rows;
    double doubt = 0;   ///< 8 eps times the largest of these distances over lengths, or that of the forces
};
TwistRows twist_rows(const Model& model, std::span<const Matrix34> X, std::span<const int> rows);
TwistRows twist_rows(const Model& model, std::span<const Matrix34> X, std::span<const int> rows,
                     const RowWrenches& wrenches);

/// Clear cases are judged along the joints, at a cost that grows with the bodies: rows of a spanning forest
/// by single joints, rows that close loops by what is new in them beside the forest; independent above 1e-3,
/// dependent below the threshold. Else by a QR decomposition of all rows with column pivoting. Of equal rows
/// the one that comes first is kept.
struct RowRank {
    std::vector<int> independent;   ///< rows of the model, ascending
    std::vector<int> dependent;     ///< the others, ascending
    double smallest_pivot = 1;      ///< of the independent rows: of any, or the last |R_kk| / |R_00|
};
/// The threshold is at least the doubt of the rows, or 1e-4 if that is more: 8 eps times the largest ratio of
/// positions and joint points to arms, or to lengths of rods. So 1e-9 bears distances of 5e5 arms.
RowRank row_rank(const Model& model, std::span<const Matrix34> X, std::span<const int> rows,
                 double threshold = 1e-9);
RowRank row_rank(const TwistRows& twists, int n_bodies, std::span<const int> rows, double threshold = 1e-9);

/// Of all rows of the model.
struct Dependencies {
    std::vector<int> independent, dependent;   ///< ascending
    /// [k][i]: row dependent[k] is the sum of these times rows independent[i], in twists.
    std::vector<std::vector<double>> factors;
    std::vector<double> sizes;   ///< norms of the twist rows
};
/// `independent`: as many as there are, and these where elimination holds them well (pivots above 1e-3); else
/// others are chosen.
Dependencies dependencies(const Model& model, std::span<const Matrix34> X, std::span<const int> independent,
                          const RowWrenches& wrenches);

/// A spin about an axis through the centre of mass, alone or together with such spins of other bodies, that
/// no row holds and that carries no inertia.
struct WeightlessSpin {
    int body = 0;             ///< that turns most
    Vector3 axis{};           ///< world axes, norm 1
    bool by_digits = false;   ///< there may be an inertia, but M |c|^2 takes all its digits
};
/// Without inertia are the principal axes of the body with J <= 16 eps tr E, the rounding level of
/// J = (tr E - M |c|^2) 1 - (E - M c c^T), known to an angle u = 16 eps tr E / J of the next axis. A row with
/// force f, moment m about its joint point and arm r from the centre of mass holds such an axis if its moment
/// there is above (1e-9 + u) (|m| + (|r| + gyration) |f|) + 8 eps (position + |at| + |c|) |f|.
std::optional<WeightlessSpin> weightless_spin(const Model& model, std::span<const Matrix34> X);

}   // namespace livens::inline dynamics_internal
