// SPDX-License-Identifier: BSD-3-Clause
// The fields of a motion at fixed places of every element.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "livens/base/linear.h"
#include "livens/multibody/motion.h"

namespace livens::inline diagnostics_internal {

/// Evaluates a field at the same local points s of each element: the basis is tabulated once, so that a point
/// costs (degree + 1) sums over the numbers of a coefficient and allocates nothing. Denominators differ from
/// element to element and are applied to a copy of the table's row.
class FieldTable {
public:
    /// The field must outlive the table.
    FieldTable(const Field& field, std::span<const double> points);

    /// Value at point k; at a node its coefficient to the bit.
    void values(int element, int k, std::span<double> out) const;
    /// The same for the bodies stacked in a field of 12 numbers each.
    void values(int element, int k, std::span<Matrix34> bodies) const;
    /// `factor` times the derivative by s: 1 / h makes it one by time.
    void derivatives(int element, int k, double factor, std::span<Matrix34> bodies) const;
    /// The coefficient that point k is; nullptr: it lies between the nodes.
    const double* node(int element, int k) const
    {
        return nodes_[k] < 0 ? nullptr : field_->coefficient(element, nodes_[k]).data();
    }

    bool has_nodes_alone() const { return std::ranges::find(nodes_, -1) == nodes_.end(); }

    // The same at all points at once, one after the other.
    void all_values(int element, std::span<double> out) const;
    void all_derivatives(int element, double factor, std::span<double> out) const;
    void all_of_both(int element, double factor, std::span<double> values,
                     std::span<double> derivatives) const;

private:
    using Row = std::array<double, 33>;   // up to degree 32, the largest of basis_on

    /// What coefficients are multiplied with: of the table, or made in `scratch`.
    std::span<const double> row(int element, int k, int derivative, Row& scratch) const;
    void sum_up(int element, int derivative, std::span<const double> d, std::span<double> out) const;
    void add_first(int element, std::span<double> values) const;

    const Field* field_;
    std::vector<int> nodes_;            // the node that a point is, or -1
    std::vector<double> values_;        // M_A(s_k) at [k * (degree + 1) + A]
    std::vector<double> derivatives_;   // M_A'(s_k) likewise
};

/// d_A = factor (x_A - x_0), A = 1 .. degree, of the coefficients of an element, one after the other.
void differences_of(const Field& field, int element, double factor, std::vector<double>& d);
/// out_k = sum over A of M_kA d_A, of n numbers each; row k of M begins at M[k * stride].
struct ConstantMatrix {
    const double* entries;
    int rows, columns, stride;
};
void multiply(const ConstantMatrix& M, const double* d, int n, double* out);

/// A field at any instant of the motion.
std::vector<double> field_at(const Field& field, const TimeMesh& mesh, double t);
/// t at a local point; at the element's ends to the bit, and from the element's side.
Instant instant_at(const TimeMesh& mesh, int element, double s);

/// X, its derivative and the momentum of a motion at the same local points s of each element.
class ElementSampler {
public:
    /// The motion must outlive the sampler.
    ElementSampler(const Motion& motion, std::vector<double> points);

    int size() const { return static_cast<int>(points_.size()); }
    const std::vector<double>& points() const { return points_; }
    /// See instant_at().
    Instant instant(int element, int k) const { return instant_at(motion_.mesh, element, points_[k]); }

    /// X of all bodies at point k; at a node its coefficient to the bit.
    void positions(int element, int k, std::span<Matrix34> X) const;
    /// dX/dt of the field, also at the element's ends.
    void velocities(int element, int k, std::span<Matrix34> V) const;
    /// Whether the motion has momenta of its own between element ends.
    bool has_momenta() const { return P_.has_value(); }
    /// P of all bodies from that field.
    void momenta(int element, int k, std::span<Matrix34> P) const;

private:
    const Motion& motion_;
    std::vector<double> points_;
    FieldTable X_;
    std::optional<FieldTable> P_;
};

/// X of all bodies at element end number `end`, as of the element that starts there; and where fields are not
/// continuous also as of the element that ends there.
void positions_at_end(const Motion& motion, int end, std::span<Matrix34> X);
void positions_before_end(const Motion& motion, int end, std::span<Matrix34> X);
/// V of all bodies there, from the momentum.
std::span<const Matrix34> velocities_at_end(const Motion& motion, int end, Side side = Side::right);

}   // namespace livens::inline diagnostics_internal
