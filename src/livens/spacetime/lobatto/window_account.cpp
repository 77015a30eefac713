// SPDX-License-Identifier: BSD-3-Clause
// What a window of lobatto tells about itself.
#include <algorithm>
#include <cmath>
#include <limits>

#include "livens/spacetime/lobatto/window.h"

namespace livens {

Place LobattoWindow::worst() const
{
    Place place{"", stretch_.times[0], system_.balances().bad_load(stretch_, system_.nodes())};
    double worst = 0;
    int row = -1, body = -1;
    for (int A = 0; A < stretch_.n_nodes(); ++A) {
        if (!stretch_.is_unknown(A)) continue;
        for (int c = 0; c < tables_.rank; ++c) {
            const double v = std::abs(system_.nodes().violations(A)[c]);
            if (v <= worst) continue;   // nan is worst of all
            worst = v;
            row = system_.nodes().basis(A).rows[c];
            place.t = stretch_.times[stretch_.first_element(A)];
        }
    }
    worst = 0;
    std::vector<double> q(static_cast<std::size_t>(tables_.n_twists)), wrench(12 * tables_.bodies.size());
    for (int A = 0; A < stretch_.n_nodes(); ++A) {
        if (!stretch_.is_active(A)) continue;
        const Nodes& nodes = system_.nodes();
        std::copy_n(system_.balances().raw(A), wrench.size(), wrench.begin());
        tables_.twist_rows(nodes.X(A), nodes.maps(A), wrench.data(), q.data());
        for (int b = 0; b < tables_.n_bodies(); ++b)
            for (int i = 0; i < tables_.bodies[b].dofs; ++i) {
                const double v = std::abs(q[tables_.bodies[b].first + i]);
                if (v <= worst) continue;
                worst = v;
                body = b;
            }
    }
    if (row >= 0) place.name = tables_.model->row_name(row);
    if (body >= 0) place.name += (row >= 0 ? ", body '" : "body '") + tables_.model->body_name(body) + "'";
    return place;
}

void LobattoWindow::describe(SolveReport& report) const
{
    report.unknowns = std::max(report.unknowns, static_cast<int>(system_.balances().reduced().size()));
    report.smallest_pivot = std::min(report.smallest_pivot, system_.nodes().smallest_pivot());
    report.guess_factorisations = series_.factorisations();
    system_.elimination().describe(report);
}

void LobattoWindow::measure_condition(SolveReport& report, const std::function<bool()>& goes_on)
{
    const double f = tables_.freedoms(), p = stretch_.degree;
    if (f == 0) return;   // nothing moves: there is no matrix
    if (stretch_.n_elements() * p * (2 * p + 1) * f * f > std::numeric_limits<int>::max()) {
        report.notes.push_back("the whole matrix is too large for its condition number; use fewer elements");
        return;
    }
    const auto elimination = null_space_elimination(tables_, stretch_, whole_solver(SparseBackend::eigen));
    elimination->begin(stretch_, system_.nodes());
    system_.form_tangent(*elimination);
    elimination->measure_condition(report, goes_on);
}

}   // namespace livens
