// SPDX-License-Identifier: BSD-3-Clause
// Lagrange polynomials on given nodes of the unit interval.
#pragma once

#include <span>
#include <vector>

namespace [[gnu::visibility("default")]] livens {

/// The polynomials of degree n - 1 that are 1 at one node and 0 at the others.
/// Evaluated by the barycentric formula [Berrut and Trefethen 2004, eq. 4.2 and 9.3-9.5].
class LagrangeBasis {
public:
    /// At least one node; nodes must be finite and ascend strictly; throws InputError otherwise.
    explicit LagrangeBasis(std::vector<double> nodes);

    int degree() const { return static_cast<int>(nodes_.size()) - 1; }
    int size() const { return static_cast<int>(nodes_.size()); }
    const std::vector<double>& nodes() const { return nodes_; }

    /// out[A] = M_A(s); exact 0 and 1 at nodes. s may lie outside the nodes (extrapolation).
    void values(double s, std::span<double> out) const;
    /// out[A] = M_A'(s); s may lie outside the nodes.
    void derivatives(double s, std::span<double> out) const;

    /// D_CA = M_A'(s_C), row by row: differentiation()[C * size() + A]; rows add up to zero (negative sum
    /// trick).
    const std::vector<double>& differentiation() const { return differentiation_; }

private:
    std::vector<double> nodes_;
    std::vector<double> barycentric_;
    std::vector<double> differentiation_;
};

/// What the nodes of an element are.
enum class Points {
    lobatto,   ///< the Gauss-Lobatto points
    radau      ///< 0 and the right Radau points
};

/// The basis on these points of the given degree (1..32, else InputError).
LagrangeBasis basis_on(Points points, int degree);
LagrangeBasis lobatto_basis(int degree);

}   // namespace livens
