// SPDX-License-Identifier: BSD-3-Clause
// The equations of all elements, closed by the state at the start: theory.md, "Arrival".
#include "livens/spacetime/nodal/arrival.h"

#include <algorithm>
#include <vector>

#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/march/end_point.h"
#include "livens/spacetime/nodal/elimination.h"
#include "livens/spacetime/nodal/system.h"

namespace livens::inline spacetime_internal {

namespace {

/// All places and both momenta are unknown; closing rows say which of them are known.
WindowLayout open_layout(const ModelTables& tables, const TimeMesh& mesh, const ElementRule& rule)
{
    WindowLayout layout;
    layout.times = mesh.ends;
    layout.angles = tables.loads.turns.begin();
    layout.degree = rule.degree;
    layout.X_first = layout.X_last = false;
    layout.P_first = layout.P_last = layout.are_momenta_unknown = true;
    return layout;
}

/// At a motion that is solved.
bool place(NodalSystem& system, const ModelTables& tables, const WindowLayout& layout, const Guess& motion)
{
    system.open(layout, nullptr, nullptr);
    in_shares(layout.n_nodes(), least_shared, [&](int, int begin, int end) {
        std::vector<double> X(12 * tables.bodies.size());
        for (int A = begin; A < end; ++A) {
            Patience::ask();
            const State state = motion(layout.time(system.rule(), A));
            for (std::size_t b = 0; b < state.X.size(); ++b)
                std::copy_n(state.X[b].a, 12, X.begin() + static_cast<std::ptrdiff_t>(12 * b));
            system.nodes().place_at(A, X.data());
        }
    });
    if (!system.settle()) return false;
    EndPoint point(tables);
    for (const bool last : {false, true}) {
        if (!point.place(motion(last ? layout.times.back() : layout.times.front()))) return false;
        system.balances().end_momentum(last).about_reference = point.momenta();
    }
    return system.residual();
}

/// Free motions and momenta at the first node are what they are, in the order of the closing columns: first
/// node, last node, momenta at the first, at the last.
std::vector<double> rows_of_a_state(int f)
{
    const auto columns = 4 * static_cast<std::size_t>(f);
    std::vector<double> rows(2 * static_cast<std::size_t>(f) * columns, 0.0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(f); ++i) {
        rows[i * columns + i] = 1;
        rows[(static_cast<std::size_t>(f) + i) * columns + 2 * static_cast<std::size_t>(f) + i] = 1;
    }
    return rows;
}

}   // namespace

FlowDerivative flow_derivative(const ModelTables& tables, const TimeMesh& mesh, const ElementRule& rule,
                               const Guess& motion)
{
    const int f = tables.freedoms(), n = tables.n_twists;
    const WindowLayout layout = open_layout(tables, mesh, rule);
    NodalSystem system(tables, rule);
    if (f == 0 || !place(system, tables, layout, motion)) return {};
    Elimination& whole = *system.elimination();
    whole.begin(layout, system.nodes());
    system.form_tangent(whole);
    whole.close_with(rows_of_a_state(f), DenseMatrix());
    if (!whole.factorise()) return {};
    const int last = layout.n_nodes() - 1;
    FlowDerivative flow{DenseMatrix(n, f), DenseMatrix(n, f)};
    for (int j = 0; j < f; ++j) {
        std::vector<double> conditions(2 * static_cast<std::size_t>(f), 0.0),
            own(static_cast<std::size_t>(n), 0.0), y(own);
        conditions[static_cast<std::size_t>(f + j)] = 1;
        whole.last_twist(conditions, y.data());
        tables.bodies.to_twist(system.nodes().maps(last), y.data(), flow.arrival.column(j).data());
        // a momentum along a free motion is a velocity along it
        own[tables.rank + j] = 1;
        system.nodes().basis(0).q.apply(own.data());
        tables.bodies.to_twist(system.nodes().maps(0), own.data(), flow.start.column(j).data());
    }
    return flow;
}

}   // namespace livens::inline spacetime_internal
