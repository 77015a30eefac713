// SPDX-License-Identifier: BSD-3-Clause
// The points of every element at which something is looked at, and what a motion is there.
#pragma once

#include <optional>
#include <vector>

#include "livens/diagnostics/detail/sampler.h"
#include "livens/time/quadrature.h"

namespace livens::inline diagnostics_internal {

/// What is asked at the points of a set. A start of elements that is a node and no point of the rule, as
/// that of Radau points, is a set of its own, of which the first element alone has one where X is continuous.
struct PointRoles {
    bool loads = false;    ///< supplies of loads; needs V
    bool joints = false;   ///< supplies of joints; needs multipliers
    bool nodes = false;    ///< violations: all points are nodes, in the order of X's coefficients
    int first_node = 0;    ///< of the points among those of the element
};

/// X, V and multipliers at the points of a rule, element after element.
class MotionPoints {
public:
    /// The motion must outlive them.
    MotionPoints(const Motion& motion, Quadrature rule, const PointRoles& roles);

    const PointRoles& roles() const { return roles_; }
    int size() const { return static_cast<int>(rule_.points.size()); }
    /// Whether it is the start of elements alone.
    bool is_start() const
    {
        return roles_.nodes && roles_.first_node == 0 && motion_.X.points == Points::radau;
    }
    void go_to(int element);

    /// Of an integral over the element.
    double weight(int k) const { return motion_.mesh.length(element_) * rule_.weights[k]; }
    Instant instant(int k) const { return instant_at(motion_.mesh, element_, rule_.points[k]); }
    const double* X(int k) const { return at(X_table_, X_, motion_.X.n_values, k); }
    const double* V(int k) const { return V_.data() + k * motion_.X.n_values; }
    const double* multipliers(int k) const { return at(*multiplier_table_, multipliers_, motion_.n_rows, k); }

private:
    const double* at(const FieldTable& table, const std::vector<double>& values, int n, int k) const
    {
        const double* const node = table.node(element_, k);
        return node != nullptr ? node : values.data() + k * n;
    }

    const Motion& motion_;
    PointRoles roles_;
    Quadrature rule_;
    FieldTable X_table_;
    std::optional<FieldTable> multiplier_table_;
    std::vector<double> X_, V_, multipliers_;   // X and multipliers: where points are no nodes
    int element_ = 0;
};

bool takes_loads_at_nodes(const Motion& motion);
/// Where a method takes loads, where it holds joints, and the nodes: sets of points that have all roles that
/// fall together.
std::vector<MotionPoints> points_of(const Motion& motion, const PointRoles& wanted);

}   // namespace livens::inline diagnostics_internal
