// SPDX-License-Identifier: BSD-3-Clause
// F_A of the elements of a window: loads at the p points of the element's second rule, Gauss points or the
// nodes of radau, shared out to the nodes by the values of their polynomials there, so that impulses and
// moments are those of the load itself (docs/theory.md, "The element", "Why two rules", "Radau points").
#include "livens/spacetime/nodal/element_loads.h"

#include <algorithm>

#include "livens/spacetime/nodal/nodes.h"

namespace livens {

ElementLoads::ElementLoads(const ModelTables& tables, const ElementRule& rule)
    : tables_(tables), rule_(rule), X_(12 * tables.bodies.size()), V_(X_), at_point_(X_)
{}

void ElementLoads::interpolate(const WindowLayout& layout, const NodePositions& nodes, int e, int c,
                               double* X, double* V) const
{
    const int n_nodes = rule_.size();
    const double inverse = 1 / layout.h(e);
    std::copy_n(nodes.X(e * rule_.degree), X_.size(), X);
    std::fill_n(V, V_.size(), 0.0);
    for (int B = 1; B < n_nodes; ++B) {
        accumulate(X, rule_.M[c * n_nodes + B], nodes.dX(e, B), X_.size());
        accumulate(V, rule_.dM[c * n_nodes + B] * inverse, nodes.dX(e, B), V_.size());
    }
}

void ElementLoads::count_turns(const WindowLayout& layout, const NodePositions& nodes)
{
    angles_.clear();
    if (tables_.loads.turns.empty()) return;
    std::vector<double> now = layout.angles;
    for (int A = 0; A < layout.n_nodes(); ++A) {
        tables_.loads.turns.follow(Configurations(nodes.X(A)), now);
        angles_.insert(angles_.end(), now.begin(), now.end());
    }
}

std::span<const double> ElementLoads::angles(int e, int c) const
{
    if (angles_.empty()) return {};
    int node = 0;
    while (node < rule_.degree && rule_.nodes[node + 1] <= rule_.loads.points[c]) ++node;
    const std::size_t n = tables_.loads.turns.size();
    return std::span(angles_).subspan((e * rule_.degree + node) * n, n);
}

void ElementLoads::add_element(const WindowLayout& layout, const NodePositions& nodes, int e)
{
    const int n_nodes = rule_.size();
    const std::size_t n = X_.size();
    double* first = forces_.data() + e * n_nodes * n;
    std::fill_n(first, n_nodes * n, 0.0);
    for (int c = 0; c < rule_.degree; ++c) {
        interpolate(layout, nodes, e, c, X_.data(), V_.data());
        std::ranges::fill(at_point_, 0.0);
        const Instant at = layout.load_point(rule_, e, c);
        tables_.loads.add(at, X_.data(), V_.data(), layout.h(e) * rule_.loads.weights[c], at_point_.data(),
                          angles(e, c));
        for (int A = 0; A < n_nodes; ++A) {
            const double m = rule_.M[c * n_nodes + A];
            accumulate(first + A * n, m, at_point_.data(), n);
        }
    }
}

void ElementLoads::evaluate(const WindowLayout& layout, const NodePositions& nodes)
{
    count_turns(layout, nodes);
    if (tables_.model->loads().empty()) return;
    forces_.resize(layout.n_elements() * rule_.size() * X_.size());
    for (int e = 0; e < layout.n_elements(); ++e) add_element(layout, nodes, e);
}

std::string ElementLoads::bad_load(const WindowLayout& layout, const NodePositions& nodes) const
{
    std::vector<double> X(X_.size()), V(X_.size());
    for (int e = 0; e < layout.n_elements(); ++e)
        for (int c = 0; c < rule_.degree; ++c) {
            interpolate(layout, nodes, e, c, X.data(), V.data());
            const Instant at = layout.load_point(rule_, e, c);
            const int load = tables_.loads.bad(at, X.data(), V.data(), angles(e, c));
            if (load >= 0) return not_finite(tables_.model->loads()[load]);
        }
    return "";
}

}   // namespace livens
