// SPDX-License-Identifier: BSD-3-Clause
// The equations of one block: their rows, and the momenta that these define at its ends.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "livens/spacetime/mixed/end_momentum.h"
#include "livens/spacetime/mixed/fields.h"

namespace livens::mixed {

/// The system (P23) of one block, its fields X, P and the multipliers on the functions M_A and L_A of time:
///
///     dP_A       int M_A (X' - P m^-1) dt = 0
///     dX_A       natural: int -M_A' P + M_A (G^T lambda - F) dt = P(0) for A = 0, -P(T) for A = n, else 0
///                strong:  int  M_A (P' + G^T lambda - F) dt = 0
///     dlambda_A  int L_A Phi(X) dt = 0
///
/// A row dX of the natural start that is not solved is the definition of the momentum there.
class Equations {
public:
    Equations(FieldSpace space, EndMomentum at_start, EndMomentum at_end);

    const FieldSpace& space() const { return space_; }
    /// Elements that the last residual() has evaluated, those at the border of two threads for both.
    int n_formed() const;
    const EndMomentum& given(bool at_end) const { return at_end ? at_end_ : at_start_; }
    void give(bool at_end, EndMomentum momentum) { (at_end ? at_end_ : at_start_) = std::move(momentum); }
    /// Rows at `fields`; the solved ones are returned, all are kept for end_momentum(). Tells of a load that
    /// is not finite, empty if all are.
    std::string residual(const Fields& fields, std::vector<double>& r);
    /// The momentum that the law gives at an end, from the rows of the last residual(); for the strong start
    /// the value of P.
    std::vector<Matrix34> end_momentum(const Fields& fields, bool at_end) const;

private:
    /// Of a thread, with its functions.
    struct Workspace {
        int begin = 0, end = 0, n_formed = 0;
        FieldSample sample;
        std::vector<double> F;   // forces less reactions at the Gauss point, 12 numbers a body
        std::string bad;
    };
    void add_elements(const Fields& fields, Workspace& at);
    void add_point(int e, int g, const Workspace& at);
    void add_boundary(const Fields& fields, std::vector<double>& r) const;
    std::vector<Matrix34> given_momentum(const Fields& fields, bool at_end) const;

    FieldSpace space_;
    EndMomentum at_start_, at_end_;
    std::vector<Workspace> workspaces_;
    std::vector<double> dP_, dX_, dlambda_;   ///< rows of all functions, the solved and the others
};

}   // namespace livens::mixed
