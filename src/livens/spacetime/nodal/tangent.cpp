// SPDX-License-Identifier: BSD-3-Clause
// d(N_A^T r_A) / d(twist at B): mass and loads for every pair of nodes that share an element, at A = B also
// the Hessians of constraints and the derivative of N_A itself (docs/theory.md, "The tangent"). Blocks go to
// a sink, scaled by the maps D of their nodes.
#include "livens/spacetime/nodal/tangent.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "livens/dynamics/rows/twist.h"
#include "livens/dynamics/rows/twist_blocks.h"
#include "livens/multibody/model.h"
#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"
#include "livens/solvers/row_functions.h"
#include "livens/spacetime/nodal/nodes.h"
#include "livens/spacetime/nodal/rows.h"

namespace livens {

namespace {

/// Blocks of one body's rows by another one's twists at a node, both ways, until others come.
class Crossing {
public:
    Crossing(const ModelTables& tables, const Nodes& nodes, int A, TangentSink& sink)
        : tables_(tables), nodes_(nodes), A_(A), sink_(sink)
    {}
    /// The block of body i by body j, to be added to.
    double* of(int i, int j)
    {
        if (std::minmax(i, j) != std::minmax(bodies_[0], bodies_[1])) {
            pass_on();
            bodies_ = {i, j};
        }
        return blocks_[i == bodies_[0] ? 0 : 1].data();
    }
    void pass_on()
    {
        double scaled[36];
        for (int k = 0; k < 2 && bodies_[0] >= 0; ++k) {
            const int i = bodies_[k], j = bodies_[1 - k];
            scale_block(tables_, nodes_.maps(A_), i, nodes_.maps(A_), j, blocks_[k].data(), scaled);
            sink_.block(i, j, scaled);
            blocks_[k].fill(0);
        }
        bodies_ = {-1, -1};
    }

private:
    const ModelTables& tables_;
    const Nodes& nodes_;
    int A_;
    TangentSink& sink_;
    std::array<int, 2> bodies_{-1, -1};
    std::array<std::array<double, 36>, 2> blocks_{};
};

}   // namespace

Tangent::Tangent(const ModelTables& tables, const ElementRule& rule) : tables_(tables), rule_(rule) {}

Tangent::Workspace Tangent::workspace() const
{
    Workspace made;
    const std::size_t size = 12 * tables_.bodies.size();
    made.blocks.assign(3 * size, 0.0);
    for (auto* v : {&made.total, &made.X, &made.V}) v->assign(size, 0.0);
    return made;
}

void Tangent::form(const WindowLayout& layout, const Nodes& nodes, const NodalRows& rows, TangentSink& sink)
{
    const Point of{layout, nodes, rows};
    const bool is_divided = sink.of_thread(0) != nullptr;
    const auto n_threads = static_cast<std::size_t>(is_divided ? Crew::size() : 1);
    while (workspaces_.size() < n_threads) workspaces_.push_back(workspace());
    load_roundings_.assign(static_cast<std::size_t>(layout.n_elements()), 0.0);
    const auto form_share = [&](int slot, int begin, int end) {
        Workspace& at = workspaces_[slot];
        at.sink = is_divided ? sink.of_thread(slot) : &sink;
        for (int e = begin; e < end; ++e) form_element(of, e, at);
    };
    if (is_divided)
        in_shares(layout.n_elements(), least_elements(tables_), form_share);
    else
        form_share(0, 0, layout.n_elements());
}

void Tangent::form_element(const Point& of, int e, Workspace& at)
{
    const auto& [layout, nodes, rows] = of;
    TangentSink& sink = *at.sink;
    Patience::ask();
    const bool are_masses_taken = sink.take_masses(e, rule_.k, layout.h(e));
    const bool has_loads = !tables_.loads.with_tangent.empty();
    if (has_loads) evaluate_loads(of, e, at);
    for (int a = 0; a < rule_.size(); ++a) {
        const int A = e * rule_.degree + a;
        if (!layout.is_active(A)) continue;
        for (int b = 0; b < rule_.size(); ++b) {
            const int B = e * rule_.degree + b;
            if (!layout.is_unknown(B)) continue;
            // once for a shared node: in the element that ends there
            const bool is_own = A == B && (a > 0 || e == 0);
            if (are_masses_taken && !is_own && !has_loads) continue;
            sink.open(e, A, B);
            if (!are_masses_taken) add_masses(of, e, a, b, at);
            if (is_own) add_node_terms(of, A, at);
            if (has_loads) add_loads(of, e, a, b, at);
            sink.close();
        }
    }
    sink.finish(e);
}

void Tangent::add_masses(const Point& of, int e, int a, int b, Workspace& at) const
{
    const double *X_A = of.nodes.X(e * rule_.degree + a), *X_B = of.nodes.X(e * rule_.degree + b);
    const double factor = rule_.k[a * rule_.size() + b] / of.layout.h(e);
    double H[9] = {};
    for (int body = 0; body < tables_.n_bodies(); ++body) {
        if (tables_.bodies[body].dofs == 6) tables_.bodies.spin_mass(body, X_A, X_B, H);
        at.sink->mass(body, factor, H);
    }
}

/// What stands at (A, A) besides mass and loads: rows that turn with the bodies, Hessians of constraints.
void Tangent::add_node_terms(const Point& of, int A, Workspace& at) const
{
    const auto& [layout, nodes, rows] = of;
    std::copy_n(rows.raw(A), at.total.size(), at.total.data());
    rows.subtract(nodes.basis(A), rows.impulses(A), at.total.data());
    std::fill(at.blocks.begin(), at.blocks.end(), 0.0);
    for (int b = 0; b < tables_.n_bodies(); ++b)
        if (tables_.bodies[b].dofs == 6)
            twist::add_geometric(nodes.X(A) + 12 * b, at.total.data() + 12 * b, at.blocks.data() + 36 * b, 6);
    add_constraints(of, A, at);
    double scaled[36];
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        scale_block(tables_, nodes.maps(A), b, nodes.maps(A), b, at.blocks.data() + 36 * b, scaled);
        at.sink->block(b, b, scaled);
    }
}

/// - W_A sum lambda K: of bodies with themselves into the blocks, the others to the sink, what rows of a
/// joint make of the same two bodies together.
void Tangent::add_constraints(const Point& of, int A, Workspace& at) const
{
    const auto& [layout, nodes, rows] = of;
    Crossing crossing{tables_, nodes, A, *at.sink};
    const ConstraintBasis& basis = nodes.basis(A);
    for (int c = 0; c < tables_.rank; ++c) {
        const auto& table = tables_.rows[basis.rows[c]];
        if (table.form.empty() && table.is_quadratic) continue;
        for (int r = 0; r < table.n_sides; ++r) {
            for (int s = 0; s < table.n_sides; ++s) {
                const int i = table.bodies[r], j = table.bodies[s];
                double* to = r == s ? at.blocks.data() + 36 * i : crossing.of(i, j);
                const double *X_i = nodes.X(A) + 12 * i, *X_j = nodes.X(A) + 12 * j;
                const double factor = -rows.impulses(A)[c];
                if (table.is_quadratic)
                    twist::add_block(table.K[r][s].data(), X_i, X_j, factor, to, 6);
                else
                    add_reduced(factor * constraint_hessian(*table.row, nodes.at(A),
                                                            Configurations(nodes.X(A)), i, j),
                                X_i, X_j, tables_.bodies[j].dofs, to);
            }
        }
    }
    crossing.pass_on();
}

/// dF/dX and dF/dX' of all loads at the load points of an element.
void Tangent::evaluate_loads(const Point& of, int e, Workspace& at)
{
    const auto& [layout, nodes, rows] = of;
    const std::size_t n = tables_.loads.with_tangent.size();
    at.loads.resize(n * rule_.loads.points.size());
    for (int c = 0; c < rule_.degree; ++c) {
        rows.loads().interpolate(layout, nodes, e, c, at.X.data(), at.V.data());
        const std::span<const double> angles = rows.loads().angles(e, c);
        for (std::size_t l = 0; l < n; ++l) {
            const Load& load = tables_.model->loads()[tables_.loads.with_tangent[l]];
            const Instant instant = layout.load_point(rule_, e, c);
            const LoadArguments arguments = tables_.loads.arguments(tables_.loads.with_tangent[l], instant,
                                                                    at.X.data(), at.V.data(), angles);
            LoadTangent& tangent = at.loads[c * n + l];
            tangent = LoadTangent(load.bodies.size(), load.n_acted);
            load.tangent(arguments, tangent);
            const double size = std::abs(layout.h(e)) * load_terms(tables_, load, arguments, tangent);
            load_roundings_[e] = std::max(load_roundings_[e], size);
        }
    }
}

/// sum_c h w_c M_A(s_c) N_A^T [ M_B(s_c) dF/dX + h^-1 M_B'(s_c) dF/dX' ] N_B.
void Tangent::add_loads(const Point& of, int e, int a, int b, Workspace& at) const
{
    const auto& [layout, nodes, rows] = of;
    const std::size_t n = tables_.loads.with_tangent.size();
    const int A = e * rule_.degree + a, B = e * rule_.degree + b, size = rule_.size();
    const RowFunctions& sums = row_functions();
    double block[36], scaled[36];
    for (std::size_t l = 0; l < n; ++l) {
        const Load& load = tables_.model->loads()[tables_.loads.with_tangent[l]];
        for (std::size_t r = 0; r < load.n_acted; ++r) {
            for (std::size_t s = 0; s < load.bodies.size(); ++s) {
                const int i = load.bodies[r], j = load.bodies[s];
                if (i == world || j == world) continue;
                Matrix<12, 12> K{};
                for (int c = 0; c < rule_.degree; ++c) {
                    const LoadTangent& tangent = at.loads[c * n + l];
                    const double w = rule_.loads.weights[c] * rule_.M[c * size + a];
                    const double by_X = layout.h(e) * w * rule_.M[c * size + b],
                                 by_V = w * rule_.dM[c * size + b];
                    const double *of_X = tangent.X[r][s].a, *of_V = tangent.V[r][s].a;
                    if (load.depends_on_X && load.depends_on_V)
                        sums.subtract_pair(K.a, -by_X, of_X, -by_V, of_V, 144);
                    else if (load.depends_on_X)
                        sums.subtract_scaled(K.a, -by_X, of_X, 144);
                    else if (load.depends_on_V)
                        sums.subtract_scaled(K.a, -by_V, of_V, 144);
                }
                std::fill(block, block + 36, 0.0);
                add_reduced(K, nodes.X(A) + 12 * i, nodes.X(B) + 12 * j, tables_.bodies[j].dofs, block);
                scale_block(tables_, nodes.maps(A), i, nodes.maps(B), j, block, scaled);
                at.sink->block(i, j, scaled);
            }
        }
    }
}

}   // namespace livens
