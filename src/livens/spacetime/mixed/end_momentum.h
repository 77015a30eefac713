// SPDX-License-Identifier: BSD-3-Clause
// Momenta that are given at an end of time.
#pragma once

#include <vector>

#include "livens/base/linear.h"
#include "livens/multibody/body.h"
#include "livens/multibody/state.h"

namespace livens::mixed {

/// The momentum of a body with given linear momentum p and moment of momentum L about its reference point,
/// both in world axes, where its X is unknown:
///
///     P(X) = [v, w x d_1, w x d_2, w x d_3] m,   P_0 = p,   sum_i d_i x P_i = L
///
/// six equations for v and w. It is P = V m of a rigid V: a part of P that strains the body would be for the
/// multipliers to bear, whose functions of time are too few for that.
class TurningMomentum {
public:
    /// p and L are those of the stated X and V.
    TurningMomentum(const Body& body, const Matrix34& X, const Matrix34& V);
    /// Six numbers: p, then L; of a point mass three.
    TurningMomentum(const Body& body, const double* momenta);

    /// P and, if asked for, d(columns of P)/d(columns of X); nan where the directors have collapsed.
    Matrix34 at(const Matrix34& X, Matrix<12, 12>* tangent = nullptr) const;

private:
    bool is_point_;
    Matrix4 mass_;
    Vector3 p_, L_;
};

/// P at an end: fixed, or turning with an unknown X, then one a body.
struct EndMomentum {
    std::vector<Matrix34> fixed;
    std::vector<TurningMomentum> turning;
};

}   // namespace livens::mixed
