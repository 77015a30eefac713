// SPDX-License-Identifier: BSD-3-Clause
// The tables of one Lobatto element on the unit interval.
#pragma once

#include <vector>

#include "livens/time/quadrature.h"

namespace livens {

/// Degree p: n = p + 1 nodes, where constraints hold, and p Gauss points, where loads are taken.
struct LobattoRule {
    int degree = 0;
    std::vector<double> nodes;     ///< s_A in [0, 1]
    std::vector<double> weights;   ///< w_A, sum 1
    std::vector<double> D;         ///< D_CA = M_A'(s_C), row by row
    std::vector<double> k;         ///< k_AB = sum_C w_C D_CA D_CB, row by row
    Quadrature loads;              ///< the p Gauss points s_c
    std::vector<double> M;         ///< M_A(s_c) at [c * n + A]
    std::vector<double> dM;        ///< M_A'(s_c) likewise

    int size() const { return degree + 1; }
};

/// Throws InputError unless 1 <= degree <= 17; the last is for the estimate of the error of 16.
LobattoRule lobatto_rule(int degree);

}   // namespace livens
