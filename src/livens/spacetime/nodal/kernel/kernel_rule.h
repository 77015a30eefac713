// SPDX-License-Identifier: BSD-3-Clause
// The tables of an element's rule in lanes, for the length of the element at hand.
#pragma once

#include <vector>

#include "livens/dynamics/lanes/aligned_doubles.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/spacetime/elements/kernel_functions.h"
#include "livens/spacetime/elements/window_layout.h"

namespace livens::inline dynamics_internal {
struct InstantState;
}   // namespace livens::inline dynamics_internal

namespace livens::inline spacetime_internal {

/// Numbers of an element of length 1, made once, and of one of length h.
class KernelRule {
public:
    /// References must outlive it; functions null: it is not asked for.
    KernelRule(const ModelTables& tables, const ElementRule& rule, const lanes::Functions* functions);
    KernelRule(const KernelRule&) = delete;
    KernelRule& operator=(const KernelRule&) = delete;

    /// For the element of `stretch` from `start`, if the last one took `last_steps` steps: turns go in still
    /// axes where these may save some.
    void use(const WindowLayout& layout, const InstantState& start, int last_steps);
    const lanes::Rule& in_lanes() const { return lanes_; }
    /// Of nodes, in the order of their lanes.
    const std::vector<double>& times() const { return times_; }
    /// Largest terms of the sums over k_AB that make rows, by increments of all nodes; they cancel, and leave
    /// their rounding.
    double largest_of_sums(const double* increments) const;

private:
    void scale(double h);
    void find_start_rates(const InstantState& start);
    /// Of lane l, as a column or as a row.
    int node_of(int lane) const { return lane == 0 ? rule_.degree : lane; }
    int row_of(int lane) const { return row_in_lane(rule_, lane); }

    const ModelTables& tables_;
    const ElementRule& rule_;
    int width_;
    AlignedDoubles numbers_;   // of length 1, then of length h
    std::vector<double> times_;
    std::vector<double> start_rates_, no_momentum_;   // radau
    lanes::Rule lanes_{};
    double h_ = 0;
};

}   // namespace livens::inline spacetime_internal
