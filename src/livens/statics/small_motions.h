// SPDX-License-Identifier: BSD-3-Clause
// The linear terms of small motions about a state: stiffness, damping and mass in scaled twists, source by
// source, and on what the joints leave free.  (docs/theory.md, "Small motions")
#pragma once

#include <span>
#include <vector>

#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/dynamics/start/consistent_start.h"
#include "livens/solvers/dense_matrix.h"

namespace livens::inline statics_internal {

/// Part of a form on scaled twists: what a source (a load, a joint, or -1) does to body i when body j moves.
struct TwistTerm {
    int source, i, j;
    Matrix<6, 6> K;        ///< of a point mass the first three rows or columns
    Matrix<6, 6> size{};   ///< what its rounding is relative to: by absolute values of all that is summed
};
using TwistTerms = std::vector<TwistTerm>;

/// What a matrix makes of the first numbers of `y`, six at most: of K or size of a term.
Matrix<6, 1> times(const Matrix<6, 6>& K, std::span<const double> y);

/// N D of a body: its X by its scaled twist.
using BodyColumns = Matrix<12, 6>;

/// Terms about a prepared state. They are not symmetric where loads follow the bodies they act on.
class SmallMotions {
public:
    /// `state`: prepared, with multipliers and accelerations on this side.
    SmallMotions(const ModelTables& tables, const InstantState& state, Side side);

    const std::vector<BodyColumns>& columns() const { return columns_; }

    /// - dF/dX and - dF/dX' of the loads.
    void add_loads(TwistTerms& springs, TwistTerms& dampers) const;
    /// sum lambda K of the joints' rows, joint by joint, and the same of rigidity: its multipliers are what
    /// is left of F - G^T lambda - X'' m, whose turning with the body is the geometric term.
    void add_constraints(TwistTerms& terms) const;
    /// The mass itself: the identity unless an inertia is singular.
    void add_mass(TwistTerms& terms) const;

private:
    TwistTerm term(int source, const Matrix<12, 12>& K, double factor, int i, int j) const;
    std::vector<double> forces_less_inertia(int side) const;

    const ModelTables& tables_;
    const InstantState& state_;
    Instant at_;
    std::vector<BodyColumns> columns_;
    std::vector<Matrix<6, 6>> maps_;   // D of each body
};

/// A basis Z of what the joints leave free, orthonormal in scaled twists.
struct FreeMotions {
    int n_twists = 0;
    int n = 0;       ///< how many
    DenseMatrix Z;   ///< n_twists x n

    /// Of a prepared state that has a basis.
    FreeMotions(const ModelTables& tables, const InstantState& state);

    /// Z^T K Z, n x n.
    DenseMatrix reduced(const ModelTables& tables, const TwistTerms& terms) const;
    /// The diagonal of |Z|^T |K| |Z|: what rounding of Z^T K Z is relative to.
    std::vector<double> sizes(const ModelTables& tables, const TwistTerms& terms) const;
    /// Column k as plain twists, n_twists numbers.
    std::vector<double> twists(const ModelTables& tables, const InstantState& state, int k) const;
};

/// Throws InputError `controller-sampled`: what changes at instants has no rest.
void refuse_sampling(const Model& model);

/// In the coordinates of free motions those that move a body along a state that it holds, in the order of the
/// model, and along what it holds nothing by.
struct StateDirections {
    DenseMatrix held, idle;   ///< n x .., orthonormal

    StateDirections(const ModelTables& tables, const FreeMotions& free);
    bool is_empty() const { return held.cols + idle.cols == 0; }
};

/// A state, closed, with accelerations and multipliers on one side.
struct PreparedState {
    /// `by_basis`: with a basis of what is free, however much that is.
    PreparedState(const Model& model, const State& given, Side side, bool by_basis);
    PreparedState(const Model& model, const ConsistentStart& closed, Side side, bool by_basis);

    ModelTables tables;
    mutable InstantState state;   // which projects in room of its own
    bool is_fit;                  // else consistent_start() has refused it
};

}   // namespace livens::inline statics_internal
