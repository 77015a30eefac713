// SPDX-License-Identifier: BSD-3-Clause
// Lagrange polynomials M_A and their derivatives by the barycentric formula [Berrut2004]: the functions of
// one element, to which theory.md, "The element" refers as M_A and D_CA. Weights and differentiation matrix
// are made once, in long double, since every row of an element is a sum of these numbers.
#include "livens/time/basis.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/time/quadrature.h"

namespace livens {
namespace {

// Differences of nodes are multiplied by this over their span: four over the length is the inverse of an
// interval's capacity, so products of many differences neither overflow nor vanish [Berrut and Trefethen
// 2004, section 7].
constexpr double inverse_capacity = 4;

void check_nodes(const std::vector<double>& nodes)
{
    Complaint complaint{
        "basis-nodes", "method.degree", "nodes of a time basis must ascend strictly", "", "", "", ""};
    if (nodes.empty()) {
        complaint.value = "no node";
        throw InputError(complaint);
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (std::isfinite(nodes[i]) && (i == 0 || nodes[i - 1] < nodes[i])) continue;
        complaint.value = to_text(nodes[i]) + " at place " + std::to_string(i);
        throw InputError(complaint);
    }
}

/// 4 / span of the nodes.
long double scale_of(const std::vector<double>& nodes)
{
    return nodes.size() == 1 ? 1
                             : inverse_capacity / (static_cast<long double>(nodes.back()) - nodes.front());
}

std::vector<long double> barycentric_weights(const std::vector<double>& nodes)
{
    const long double scale = scale_of(nodes);
    std::vector<long double> w(nodes.size(), 1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (std::size_t j = 0; j < nodes.size(); ++j) {
            if (j != i) w[i] /= scale * (static_cast<long double>(nodes[i]) - nodes[j]);
        }
    }
    return w;
}

}   // namespace

LagrangeBasis::LagrangeBasis(std::vector<double> nodes) : nodes_(std::move(nodes))
{
    check_nodes(nodes_);
    const std::vector<long double> w = barycentric_weights(nodes_);
    barycentric_.assign(w.begin(), w.end());

    const std::size_t n = nodes_.size();
    differentiation_.assign(n * n, 0);
    for (std::size_t c = 0; c < n; ++c) {
        long double sum = 0;   // of the entries as they are stored, so that the row adds up to zero
        for (std::size_t a = 0; a < n; ++a) {
            if (a == c) continue;
            // D_CA = (w_A / w_C) / (s_C - s_A). The diagonal follows from the constant function, whose
            // derivative is zero: a constant field then has no velocity to the last bit (theory.md,
            // "Increments").
            double& entry = differentiation_[c * n + a];
            entry = static_cast<double>(w[a] / w[c] / (static_cast<long double>(nodes_[c]) - nodes_[a]));
            sum += entry;
        }
        differentiation_[c * n + c] = static_cast<double>(-sum);
    }
}

void LagrangeBasis::values(double s, std::span<double> out) const
{
    const std::size_t n = nodes_.size();
    assert(out.size() == n);
    // The quotient below is 0/0 at a node, so a node is answered before it.
    const auto node = std::lower_bound(nodes_.begin(), nodes_.end(), s);
    if (node != nodes_.end() && *node == s) {
        std::fill(out.begin(), out.end(), 0.0);
        out[static_cast<std::size_t>(node - nodes_.begin())] = 1;
        return;
    }
    double sum = 0;
    for (std::size_t a = 0; a < n; ++a) sum += out[a] = barycentric_[a] / (s - nodes_[a]);
    double factor = 1 / sum;
    if (s < nodes_.front() || s > nodes_.back()) {
        // The quotient is unstable outside the nodes; the product form is not [Webb, Trefethen and Gonnet
        // 2012].
        const double scale = static_cast<double>(scale_of(nodes_));
        factor = 1 / scale;
        if (n == 1) factor = 1;
        for (const double x : nodes_) factor *= scale * (s - x);
    }
    for (double& value : out) value *= factor;
}

void LagrangeBasis::derivatives(double s, std::span<double> out) const
{
    // The derivative is a polynomial of lower degree, so the basis reproduces it: M_A'(s) = sum_C M_C(s)
    // D_CA. Unlike the quotient of eq. 9.3 this loses nothing near a node.
    const std::size_t n = nodes_.size();
    assert(out.size() == n);
    std::fill(out.begin(), out.end(), 0.0);
    // A degree of 32 has 33 nodes, and no element has more: the common case allocates nothing.
    constexpr std::size_t enough = 33;
    double on_stack[enough];
    std::vector<double> on_heap(n > enough ? n : 0);   // empty for every degree that livens uses
    const std::span<double> m = n > enough ? std::span<double>(on_heap) : std::span<double>(on_stack, n);
    values(s, m);
    for (std::size_t c = 0; c < n; ++c) {
        if (m[c] == 0) continue;
        for (std::size_t a = 0; a < n; ++a) out[a] += m[c] * differentiation_[c * n + a];
    }
}

LagrangeBasis basis_on(Points points, int degree)
{
    if (degree < 1 || degree > 32) {
        throw InputError({"degree", "method.degree", "there is no time basis of this degree",
                          std::to_string(degree), "1 .. 32", "", ""});
    }
    if (points == Points::lobatto) return LagrangeBasis(gauss_lobatto(degree + 1).points);
    // The Radau rule has no point at the start, but the polynomial of the element begins there (theory.md,
    // "Radau points").
    std::vector<double> nodes = radau(degree).points;
    nodes.insert(nodes.begin(), 0.0);
    return LagrangeBasis(std::move(nodes));
}

LagrangeBasis lobatto_basis(int degree) { return basis_on(Points::lobatto, degree); }

}   // namespace livens
