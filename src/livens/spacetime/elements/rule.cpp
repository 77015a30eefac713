// SPDX-License-Identifier: BSD-3-Clause
// k_AB = sum_C w_C D_CA D_CB of lobatto(p), k_AB = - w_A sum_C>0 D_AC D_CB and c_A = - w_A D_A0 of radau(p),
// and the Lagrange polynomials at the load points (docs/theory.md, "The element", "Radau points"). Sums that
// are zero or one are made exact for the rounded numbers, too.
#include "livens/spacetime/elements/rule.h"

#include <cmath>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <utility>

#include "livens/base/error.h"
#include "livens/time/basis.h"
#include "livens/time/quadrature.h"

namespace livens::inline spacetime_internal {

namespace {

/// Makes sum_A k_AB = 0 hold for the rounded numbers too: what is left of a column goes into its smallest
/// entry. A sum that is not zero is a force proportional to the displacement, and drives the momentum element
/// by element.
void balance_columns(ElementRule& rule)
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

/// Makes sum_B x_B s_B = value hold for the rounded numbers of a row too, in its smallest entry but the
/// first: steady motion is then steady to rounding.
void balance_row(const ElementRule& rule, double* x, double value)
{
    for (int round = 0; round < 3; ++round) {
        long double sum = -static_cast<long double>(value);
        int smallest = 1;
        for (int b = 1; b < rule.size(); ++b) {
            sum += static_cast<long double>(x[b]) * rule.nodes[b];
            if (std::abs(x[b]) < std::abs(x[smallest])) smallest = b;
        }
        x[smallest] = static_cast<double>(x[smallest] - sum / rule.nodes[smallest]);
    }
}

void check_degree(Points points, int degree, bool is_second)
{
    const bool is_lobatto = points == Points::lobatto;
    const int most = is_lobatto ? 16 : 8, more = is_lobatto ? 2 : 1;
    if (degree >= 1 && degree <= most + (is_second ? more : 0)) return;
    const std::string last = std::to_string(most);
    throw InputError(
        {"degree-out-of-range", "method.degree",
         std::string(points == Points::lobatto ? "lobatto" : "radau") + " elements have degree 1 to " + last,
         std::to_string(degree), "1.." + last, "", "4 to 8 suit most mechanisms"});
}

/// Hamilton's law: k_AB = sum_C w_C D_CA D_CB.
void fill_lobatto(ElementRule& rule)
{
    const int n = rule.size();
    rule.weights = gauss_lobatto(n).weights;
    rule.loads = gauss(rule.degree);
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
}

/// Collocation: minus w_A times the slope at node A of the polynomial through the velocities, V_0 at the
/// start and sum_B D_CB X_B at the other nodes, - w_A (D_A0 V_0 + sum_C>0 D_AC D_CB X_B).
void fill_radau(ElementRule& rule)
{
    const int n = rule.size();
    rule.loads = radau(rule.degree);
    rule.weights = rule.loads.weights;
    rule.weights.insert(rule.weights.begin(), 0.0);
    rule.k.assign(static_cast<std::size_t>(n * n), 0.0);
    rule.c.assign(static_cast<std::size_t>(n), 0.0);
    for (int a = 1; a < n; ++a) {
        const auto w = static_cast<long double>(rule.weights[a]);
        rule.c[a] = static_cast<double>(-w * rule.D[a * n]);
        for (int b = 0; b < n; ++b) {
            long double sum = 0;
            for (int c = 1; c < n; ++c)
                sum += static_cast<long double>(rule.D[a * n + c]) * rule.D[c * n + b];
            rule.k[a * n + b] = static_cast<double>(-w * sum);
        }
        balance_row(rule, rule.k.data() + a * n, -rule.c[a]);
    }
    balance_row(rule, rule.D.data() + rule.degree * n, 1);
}

ElementRule make_rule(Points points, int degree)
{
    const LagrangeBasis basis = basis_on(points, degree);
    ElementRule rule;
    rule.points = points;
    rule.degree = degree;
    rule.nodes = basis.nodes();
    rule.D = basis.differentiation();
    if (points == Points::lobatto)
        fill_lobatto(rule);
    else
        fill_radau(rule);
    const auto size = static_cast<std::size_t>(rule.size());
    rule.M.resize(size * rule.loads.points.size());
    rule.dM.resize(rule.M.size());
    for (std::size_t c = 0; c < rule.loads.points.size(); ++c) {
        basis.values(rule.loads.points[c], std::span(rule.M).subspan(c * size, size));
        basis.derivatives(rule.loads.points[c], std::span(rule.dM).subspan(c * size, size));
    }
    return rule;
}

}   // namespace

/// Made once, for a second solution asks for it with every piece. (They stay: what ends with its thread asks
/// for memory at its first use, without which the C library ends the program.)
const ElementRule& element_rule(Points points, int degree)
{
    check_degree(points, degree, true);
    static std::mutex in_use;
    static auto& known = *new std::map<std::pair<Points, int>, ElementRule>;
    const std::scoped_lock lock(in_use);
    const auto [place, is_new] = known.try_emplace({points, degree});
    if (is_new || place->second.degree == 0) place->second = make_rule(points, degree);
    return place->second;
}

void check_degree(const Method& method, bool is_second)
{
    if (const auto* radau = std::get_if<Radau>(&method))
        check_degree(Points::radau, radau->degree, is_second);
    else
        check_degree(Points::lobatto, std::get<Lobatto>(method).degree, is_second);
}

const ElementRule& rule_of(const Method& method)
{
    if (const auto* radau = std::get_if<Radau>(&method)) return element_rule(Points::radau, radau->degree);
    return element_rule(Points::lobatto, std::get<Lobatto>(method).degree);
}

/// Gauss and Jordan with pivots by rows, in long double: what is rounded here is in every step of a march.
std::vector<double> inverse_of_k(const ElementRule& rule)
{
    using Wide = long double;
    const int p = rule.degree;
    std::vector<Wide> a(static_cast<std::size_t>(2 * p * p), 0);   // [K 1] by rows
    const auto at = [&](int i, int j) -> Wide& { return a[2 * p * i + j]; };
    for (int A = 0; A < p; ++A) {
        for (int B = 0; B < p; ++B) at(A, B) = rule.k[node_of_row(rule, A) * rule.size() + B + 1];
        at(A, p + A) = 1;
    }
    for (int i = 0; i < p; ++i) {
        int best = i;
        for (int r = i; r < p; ++r)
            if (std::abs(at(r, i)) > std::abs(at(best, i))) best = r;
        for (int j = 0; j < 2 * p; ++j) std::swap(at(i, j), at(best, j));
        const Wide pivot = at(i, i);
        for (int j = 0; j < 2 * p; ++j) at(i, j) /= pivot;
        for (int r = 0; r < p; ++r) {
            const Wide factor = at(r, i);
            for (int j = 0; r != i && j < 2 * p; ++j) at(r, j) -= factor * at(i, j);
        }
    }
    std::vector<double> inverse(static_cast<std::size_t>(p * p));
    for (int i = 0; i < p; ++i)
        for (int j = 0; j < p; ++j) inverse[p * i + j] = static_cast<double>(at(i, p + j));
    return inverse;
}

}   // namespace livens::inline spacetime_internal
