// SPDX-License-Identifier: BSD-3-Clause
// Rows that are more than one quadratic form: Phi = form + sum_k f_k(t) form_k + sum_m F_m(q_1, ..), where
// the q are forms too. Forms are sums over the numbers of a configuration; what makes them rows are weights.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "livens/dynamics/lanes/lanes.h"
#include "livens/multibody/constraint.h"

namespace livens::inline dynamics_internal {

/// The weights of all forms of some rows. It has copies of their functions, since patterns may outlive the
/// model that they are of.
class RowForms {
public:
    void add(const ConstraintRow& row);
    /// Of the rows in the elimination.
    void place(std::vector<std::int32_t> places) { places_ = std::move(places); }

    int n_rows() const { return static_cast<int>(rows_.size()); }
    int n_forms() const { return n_forms_; }
    const std::int32_t* places() const { return places_.data(); }

    /// At one instant, from the values of forms: weights, and the part that forms have of each row's value.
    void weigh_at(Instant at, const lanes::Values& one) const;
    /// Weights of functions of time at the nodes of an element, one lane each; in lanes behind them those of
    /// its start.
    void weigh_nodes(std::span<const double> times, const lanes::Values& start, const lanes::Values& nodes,
                     int width) const;
    /// lanes::FormPattern::weigh, of one that weigh_nodes() was called for.
    static void weigh(const void* forms, const lanes::Values& start, const lanes::Values& nodes, int width);
    /// out += dPhi/dt where nothing moves, by places; from the values of forms.
    void add_rates(Instant at, const lanes::Values& one, double* out) const;
    /// out += the part that forms have of d2 Phi/dt2, by places; from their values and, one after the other,
    /// their first and second derivatives in time.
    void add_curvatures(Instant at, const lanes::Values& one, const double* first, const double* second,
                        double* out) const;

private:
    struct Row {
        int first;   ///< form
        std::vector<TimeFunction> factors;
        std::vector<SmoothFunction> functions;   ///< of the forms behind those with factors
        double period, constant;                 ///< ConstraintRow::period, c

        int first_coordinate() const { return first + static_cast<int>(factors.size()); }
    };

    static void add_function(const SmoothFunction& F, int first, const lanes::Values& start,
                             const lanes::Values& nodes, int width, double* change);

    int n_forms_ = 0;
    std::vector<Row> rows_;
    std::vector<std::int32_t> places_;
};

}   // namespace livens::inline dynamics_internal
