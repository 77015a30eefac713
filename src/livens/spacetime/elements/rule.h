// SPDX-License-Identifier: BSD-3-Clause
// The tables of one element of lobatto(p) or radau(p) on the unit interval.
#pragma once

#include <vector>

#include "livens/spacetime/method.h"
#include "livens/time/basis.h"
#include "livens/time/quadrature.h"

namespace livens::inline spacetime_internal {

/// Degree p: n = p + 1 nodes, where constraints hold, and p points where loads are taken: Gauss points with
/// lobatto; the nodes but the first, which has no weight and no row, with radau.
struct ElementRule {
    Points points = Points::lobatto;
    int degree = 0;
    std::vector<double> nodes;     ///< s_A in [0, 1]
    std::vector<double> weights;   ///< w_A, sum 1
    std::vector<double> D;         ///< D_CA = M_A'(s_C), row by row
    std::vector<double> k;    ///< k_AB, row by row: sum_C w_C D_CA D_CB, with radau - w_A sum_C>0 D_AC D_CB
    std::vector<double> c;    ///< share c_A of row A in the momentum at the start; empty: row 0 has it all
    Quadrature loads;         ///< the p points s_c
    std::vector<double> M;    ///< M_A(s_c) at [c * n + A]
    std::vector<double> dM;   ///< M_A'(s_c) likewise

    int size() const { return degree + 1; }
};

/// Throws InputError unless 1 <= degree <= 18 (lobatto) or 9 (radau); 17, 18 and 9 are for the estimates of
/// errors alone. They stay as long as the program.
const ElementRule& element_rule(Points points, int degree);
/// Throws InputError for a degree out of range, and std::bad_variant_access for a method that is not nodal.
const ElementRule& rule_of(const Method& method);
/// Throws what rule_of() throws, unless `is_second` beyond 16 (lobatto) or 8 (radau), too.
void check_degree(const Method& method, bool is_second);
inline const ElementRule& lobatto_rule(int degree) { return element_rule(Points::lobatto, degree); }

/// The node of row A, A < p: that one, or with radau the one behind it.
inline int node_of_row(const ElementRule& rule, int A) { return A + (rule.points == Points::radau ? 1 : 0); }
/// The node of the row in lane A of the march kernel, whose lane 0 is node p where nodes are columns.
inline int row_in_lane(const ElementRule& rule, int A)
{
    return rule.points == Points::radau && A == 0 ? rule.degree : A;
}
/// The inverse of K_AB = k_AB with the p rows and the columns B = 1..p, row by row.
std::vector<double> inverse_of_k(const ElementRule& rule);

}   // namespace livens::inline spacetime_internal
