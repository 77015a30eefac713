// SPDX-License-Identifier: BSD-3-Clause
// Quadrature rules on the unit interval.
#pragma once

#include <vector>

namespace [[gnu::visibility("default")]] livens {

/// Points and weights on [0, 1], points ascending, weights adding up to 1.
///
/// Points and weights are computed, not tabulated, and right to an ulp or two. Gauss and Gauss-Lobatto rules
/// are symmetric to the bit: points[n - 1 - i] == 1 - points[i] for the lower half i, and weights alike; a
/// middle point is 0.5.
struct Quadrature {
    std::vector<double> points;
    std::vector<double> weights;
};

/// Gauss-Legendre rule: exact to degree 2 n - 1; n = 1..64, else InputError.
Quadrature gauss(int n_points);

/// Gauss-Lobatto rule, both ends included: exact to degree 2 n - 3; n = 2..64, else InputError.
/// The ends are 0 and 1 to the bit.
Quadrature gauss_lobatto(int n_points);

/// Right Radau rule, the end included, which is 1 to the bit: exact to degree 2 n - 2; n = 1..64, else
/// InputError.
Quadrature radau(int n_points);

}   // namespace livens
