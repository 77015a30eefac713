// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/lobatto/rule.h"

#include <cmath>
#include <span>
#include <string>

#include "livens/base/error.h"
#include "livens/time/basis.h"
#include "livens/time/quadrature.h"

namespace livens {

namespace {

/// Makes sum_A k_AB = 0 hold for the rounded numbers too: what is left of a column goes into its smallest
/// entry. A sum that is not zero is a force proportional to the displacement, and drives the momentum element
/// by element.
void balance_columns(LobattoRule& rule)
{
    const int n = rule.size();
    for (int round = 0; round < 3; ++round) {
        for (int b = 0; b < n; ++b) {
            long double sum = 0;
            int smallest = 0;
            for (int a = 0; a < n; ++a) {
                sum += rule.k[a * n + b];
                if (std::abs(rule.k[a * n + b]) < std::abs(rule.k[smallest * n + b])) smallest = a;
            }
            rule.k[smallest * n + b] = static_cast<double>(rule.k[smallest * n + b] - sum);
        }
    }
}

}   // namespace

LobattoRule lobatto_rule(int degree)
{
    if (degree < 1 || degree > 17)
        throw InputError({"degree-out-of-range", "method.degree", "lobatto elements have degree 1 to 17",
                          std::to_string(degree), "1..17", "", "4 to 8 suit most mechanisms"});
    const LagrangeBasis basis = lobatto_basis(degree);
    const int n = degree + 1;
    LobattoRule rule{
        degree, basis.nodes(), gauss_lobatto(n).weights, basis.differentiation(), {}, gauss(degree), {}, {}};
    rule.k.assign(static_cast<std::size_t>(n * n), 0.0);
    for (int a = 0; a < n; ++a) {
        for (int b = 0; b <= a; ++b) {
            long double sum = 0;
            for (int c = 0; c < n; ++c)
                sum += static_cast<long double>(rule.weights[c]) * rule.D[c * n + a] * rule.D[c * n + b];
            rule.k[a * n + b] = rule.k[b * n + a] = static_cast<double>(sum);
        }
    }
    balance_columns(rule);
    const auto size = static_cast<std::size_t>(n);
    rule.M.resize(size * rule.loads.points.size());
    rule.dM.resize(rule.M.size());
    for (std::size_t c = 0; c < rule.loads.points.size(); ++c) {
        basis.values(rule.loads.points[c], std::span(rule.M).subspan(c * size, size));
        basis.derivatives(rule.loads.points[c], std::span(rule.dM).subspan(c * size, size));
    }
    return rule;
}

}   // namespace livens
