// SPDX-License-Identifier: BSD-3-Clause
// F_A of the elements of a window: loads at the p points of the element's second rule, Gauss points or the
// nodes of radau, shared out to the nodes by the values of their polynomials there, so that impulses and
// moments are those of the load itself (docs/theory.md, "The element", "Why two rules", "Radau points").
#include "livens/spacetime/nodal/laws/element_loads.h"

#include <algorithm>

#include "livens/multibody/model.h"
#include "livens/solvers/crew.h"
#include "livens/spacetime/elements/kernel_functions.h"
#include "livens/spacetime/nodal/nodes.h"

namespace livens {

ElementLoads::ElementLoads(const ModelTables& tables, const ElementRule& rule)
    : tables_(tables), rule_(rule), n_(12 * tables.n_bodies())
{
    if (tables.model->loads().empty()) return;
    const lanes::Functions& functions = *lanes::functions(rule.degree);
    const int W = functions.width;
    workspaces_.emplace_back(tables, rule);
    M_.resize(static_cast<std::size_t>(rule.size() * W));
    dM_ = M_;
    for (int B = 0; B < rule.size(); ++B)
        for (int l = 0; l < W; ++l) {   // lanes behind the last point are as this one
            const int c = std::min(l, rule.degree - 1);
            M_[B * W + l] = rule.M[c * rule.size() + B];
            dM_[B * W + l] = rule.dM[c * rule.size() + B];
        }
}

ElementLoads::Workspace::Workspace(const ModelTables& tables, const ElementRule& rule)
{
    const lanes::Functions& functions = *lanes::functions(rule.degree);
    lanes = std::make_unique<LoadLanes>(tables, functions.loads->run, functions.width, rule.degree);
    X.assign(12 * tables.bodies.size() * static_cast<std::size_t>(functions.width), 0.0);
    V = F = X;
    factors.assign(static_cast<std::size_t>(functions.width), 0.0);
}

void ElementLoads::interpolate(const WindowLayout& layout, const NodePositions& nodes, int e, int c,
                               double* X, double* V) const
{
    const int n_nodes = rule_.size();
    const double inverse = 1 / layout.h(e);
    const std::size_t n = 12 * tables_.bodies.size();
    std::copy_n(nodes.X(e * rule_.degree), n, X);
    std::fill_n(V, n, 0.0);
    for (int B = 1; B < n_nodes; ++B) {
        accumulate(X, rule_.M[c * n_nodes + B], nodes.dX(e, B), n);
        accumulate(V, rule_.dM[c * n_nodes + B] * inverse, nodes.dX(e, B), n);
    }
}

/// At all nodes of the window, one after the other: an angle has its turns from the node before.
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

/// Those of the last node that is not behind the load point.
std::span<const double> ElementLoads::angles(int e, int c) const
{
    if (angles_.empty()) return {};
    int node = 0;
    while (node < rule_.degree && rule_.nodes[node + 1] <= rule_.loads.points[c]) ++node;
    const std::size_t n = tables_.loads.turns.size();
    return std::span(angles_).subspan((e * rule_.degree + node) * n, n);
}

/// X and X' at all load points, about the centres of mass.
void ElementLoads::interpolate_all(const WindowLayout& layout, const NodePositions& nodes, int e,
                                   Workspace& at) const
{
    const int W = at.lanes->width();
    const double inverse = 1 / layout.h(e);
    const double* first = nodes.X(e * rule_.degree);
    for (int i = 0; i < 12 * tables_.n_bodies(); ++i) {
        double *X = at.X.data() + i * W, *V = at.V.data() + i * W;
        std::fill_n(X, W, first[i]);
        std::fill_n(V, W, 0.0);
        for (int B = 1; B < rule_.size(); ++B) {
            const double dX = nodes.dX(e, B)[i], rate = inverse * dX;
            for (int l = 0; l < W; ++l) {
                X[l] += M_[B * W + l] * dX;
                V[l] += dM_[B * W + l] * rate;
            }
        }
    }
    for (int b = 0; b < tables_.n_bodies(); ++b)
        for (int a = 0; tables_.bodies[b].offset && a < 3; ++a)
            for (int k = 0; k < 3 * W; ++k) {
                const double center = tables_.bodies[b].center[a];
                at.X[12 * b * W + k] += center * at.X[(12 * b + 3 + 3 * a) * W + k];
                at.V[12 * b * W + k] += center * at.V[(12 * b + 3 + 3 * a) * W + k];
            }
}

/// Lanes know bodies about their centres of mass, rows about their reference points: X goes to the former,
/// and F back by the transposed map. Turns are counted from the first load point on, from lane to lane.
void ElementLoads::add_element(const WindowLayout& layout, const NodePositions& nodes, int e, Workspace& at)
{
    const int n_nodes = rule_.size(), n = 12 * tables_.n_bodies(), W = at.lanes->width();
    interpolate_all(layout, nodes, e, at);
    for (int c = 0; c < rule_.degree; ++c) at.factors[c] = layout.h(e) * rule_.loads.weights[c];
    at.lanes->begin(layout.load_points(rule_, e));
    const std::span<const double> turns = angles(e, 0);
    at.lanes->evaluate(at.X.data(), at.V.data(), at.factors.data(), turns, at.F.data());
    for (int A = 0; A < n_nodes; ++A) {
        double* forces = forces_.data() + (e * n_nodes + A) * n;
        for (int i = 0; i < n; ++i) {
            forces[i] = 0;
            for (int c = 0; c < rule_.degree; ++c) forces[i] += rule_.M[c * n_nodes + A] * at.F[i * W + c];
        }
        for (int b = 0; b < tables_.n_bodies(); ++b)   // about the reference points
            for (int k = 0; tables_.bodies[b].offset && k < 9; ++k)
                forces[12 * b + 3 + k] += tables_.bodies[b].center[k / 3] * forces[12 * b + k % 3];
    }
}

void ElementLoads::evaluate(const WindowLayout& layout, const NodePositions& nodes)
{
    count_turns(layout, nodes);
    if (workspaces_.empty()) return;
    while (static_cast<int>(workspaces_.size()) < Crew::size()) workspaces_.emplace_back(tables_, rule_);
    forces_.resize(layout.n_elements() * rule_.size() * 12 * tables_.bodies.size());
    in_shares(layout.n_elements(), least_shared, [&](int slot, int begin, int end) {
        for (int e = begin; e < end; ++e) add_element(layout, nodes, e, workspaces_[slot]);
    });
}

std::string ElementLoads::bad_load(const WindowLayout& layout, const NodePositions& nodes) const
{
    std::vector<double> X(12 * tables_.bodies.size()), V(X);
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
