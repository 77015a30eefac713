// The tables of one Lobatto element on the unit interval.
#pragma once

#include <vector>

namespace livens {

/// Nodes and quadrature of degree p, n = p + 1 points.
struct LobattoRule {
    int degree = 0;
    std::vector<double> nodes;     ///< s_A in [0, 1]
    std::vector<double> weights;   ///< w_A, sum 1
    std::vector<double> D;         ///< D_CA = M_A'(s_C), row by row
    std::vector<double> k;         ///< k_AB = sum_C w_C D_CA D_CB, row by row

    int size() const { return degree + 1; }
};

/// Throws InputError unless 1 <= degree <= 16.
LobattoRule lobatto_rule(int degree);

}   // namespace livens
