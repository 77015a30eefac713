// SPDX-License-Identifier: BSD-3-Clause
// Where Newton's iteration of one element starts from.  (docs/theory.md, "Newton's iteration")
#pragma once

#include <memory>
#include <vector>

#include "livens/dynamics/rows/tables.h"
#include "livens/solvers/newton.h"
#include "livens/spacetime/elements/window_layout.h"

namespace livens::inline dynamics_internal {
struct InstantState;
}   // namespace livens::inline dynamics_internal

namespace livens::inline spacetime_internal {

class NodalSystem;

/// Twists from the start by their Taylor series. Where that bends by more than about a radian within h, or by
/// half a length (a stiff spring that vibrates within the element), constant twist is the safer guess.
class TwistSeries {
public:
    TwistSeries(const ModelTables& tables, const InstantState& start, double h);
    /// The finite twist from the start to tau after it.
    void at(double tau, double* twist) const;

private:
    const ModelTables& tables_;
    const InstantState& start_;
    const double* acceleration_;
    double on_;   // 0: constant twist
};

/// Guesses for a single element from the state at its start: a Taylor series of the twist, and where that
/// ends too early, the solution of half the degree, which is guessed likewise.
class Series {
public:
    Series(const ModelTables& tables, const ElementRule& rule);
    ~Series();

    /// Places all nodes of the open system.
    void place(NodalSystem& system, const InstantState& start);
    /// Tangents that were factorised for guesses so far.
    long factorisations() const
    {
        return factorisations_ + (coarse_series_ ? coarse_series_->factorisations() : 0);
    }
    /// Evaluations of the equations at a node so far.
    long long evaluations() const;

private:
    void predict(NodalSystem& system, const InstantState& start) const;
    double error(const InstantState& start, double h) const;
    void make_coarse();
    bool place_coarse(NodalSystem& system, const InstantState& start);

    const ModelTables& tables_;
    const ElementRule& rule_;
    std::unique_ptr<NodalSystem> coarse_;   // half the degree; null until it is needed
    std::unique_ptr<Series> coarse_series_;
    std::vector<double> to_fine_;   // values of its basis at the nodes here, node after node
    Newton newton_;
    long factorisations_ = 0;
};

}   // namespace livens::inline spacetime_internal
