// SPDX-License-Identifier: BSD-3-Clause
// Which coefficients of the fields are unknown, and which rows are solved for them.
#pragma once

#include <algorithm>
#include <vector>

#include "livens/spacetime/method.h"

namespace livens::mixed {

/// What is given at the two ends of a block.
struct Given {
    bool X_at_start = true;
    bool P_at_start = true;
    bool X_at_end = false;
    bool P_at_end = false;
    bool P_at_last = P_at_end;   ///< at the end of time, of which a block may be a part
};

/// The places of unknowns and rows, function of time after function of time: in each the numbers of X, P and
/// the multipliers.
///
/// | start   | unknown X  | rows dX    | unknown P | rows dP   | multipliers, equal: trial | test        |
/// | natural | X not given| P given    | all       | all       | rows dX                   | unknown X   |
/// | strong  | X not given| X not given| not given | unknown P | unknown X                 | unknown X   |
///
/// in the first and in the last function; all others are unknown and have their rows. Multipliers of lower
/// degree are unknown and tested throughout.
///
/// At a torn function equal multipliers have two, left and right, of which one is unknown as it was before:
/// the left one is open where the last one is, else the right one.
class Numbering {
public:
    Numbering(const Given& given, Mixed::Start start, Mixed::Multipliers multipliers, int n_functions,
              int n_coordinates, int n_rows, const std::vector<int>& torn = {});

    /// Unknowns and rows are as many, but at the ends of a part: then some rows or columns are empty, behind.
    int size() const { return std::max(n_unknowns_, n_equations_); }
    int n_unknowns() const { return n_unknowns_; }
    int n_equations() const { return n_equations_; }
    /// First of the numbers of function A, -1 where there are none.
    int X(int A) const { return X_[A]; }
    int P(int A) const { return P_[A]; }
    int lambda(int A) const { return lambda_[A]; }
    int row_dX(int A) const { return row_dX_[A]; }
    int row_dP(int A) const { return row_dP_[A]; }
    int row_dlambda(int A) const { return row_dlambda_[A]; }
    int n_functions() const { return static_cast<int>(X_.size()); }
    int n_multiplier_functions() const { return static_cast<int>(lambda_.size()); }

private:
    int n_unknowns_ = 0, n_equations_ = 0;
    std::vector<int> X_, P_, lambda_, row_dX_, row_dP_, row_dlambda_;
};

}   // namespace livens::mixed
