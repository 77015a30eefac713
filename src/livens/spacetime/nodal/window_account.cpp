// SPDX-License-Identifier: BSD-3-Clause
// What a window of lobatto tells about itself.
#include <algorithm>
#include <cmath>
#include <limits>

#include "livens/diagnostics/largest.h"
#include "livens/spacetime/nodal/elimination.h"
#include "livens/spacetime/nodal/window.h"

namespace livens {

WorstResidual LobattoWindow::worst() const
{
    WorstResidual place{"", stretch_.times[0], system_.balances().bad_load(stretch_, system_.nodes())};
    double worst = 0;
    int row = -1, body = -1;
    for (int A = 0; A < stretch_.n_nodes(); ++A) {
        if (!stretch_.is_unknown(A)) continue;
        for (int c = 0; c < tables_.rank; ++c) {
            const double v = std::abs(system_.nodes().violations(A)[c]);
            if (v <= worst) continue;   // nan is worst of all
            worst = v;
            row = system_.nodes().rows()[c];
            place.t = stretch_.times[stretch_.first_element(A)];
        }
    }
    worst = 0;
    std::vector<double> q(static_cast<std::size_t>(tables_.n_twists)), wrench(12 * tables_.bodies.size());
    for (int A = 0; A < stretch_.n_nodes(); ++A) {
        if (!stretch_.is_active(A)) continue;
        const Nodes& nodes = system_.nodes();
        std::copy_n(system_.balances().raw(A), wrench.size(), wrench.begin());
        tables_.bodies.twist_rows(nodes.X(A), nodes.maps(A), wrench.data(), q.data());
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

/// The velocity jump h |V - X_h'| at the end of an element (radau: at its start), as velocity_jump() of
/// diagnostics has it; infinite where a body turns by more than 90 degrees from node to node:
/// |R_B - R_A|^2 = 4 there.
double LobattoWindow::velocity_jump(int e, bool refuse_turns) const
{
    const ElementRule& rule = system_.rule();
    const bool at_start = rule.points == Points::radau;
    const double *D = rule.D.data() + (at_start ? 0 : rule.degree * rule.size()), h = stretch_.h(e);
    const double* V = instant_.rates();   // at the end
    std::vector<double> first_V(at_start ? 12 * tables_.bodies.size() : 0);
    if (at_start) {
        tables_.bodies.rates_of(front_.here().X.data(), front_.here().velocity.data(), first_V.data());
        V = first_V.data();
    }
    double of_centres = 0, of_directors = 0, widest_turn = 0;   // squares
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const auto& body = tables_.bodies[b];
        const int n = body.dofs == 6 ? 12 : 3;
        double jump[12] = {};
        for (int i = 0; i < n; ++i) jump[i] = h * V[12 * b + i];
        for (int B = 1; B <= rule.degree; ++B) {
            const double *d = system_.nodes().dX(e, B) + 12 * b,
                         *before = system_.nodes().dX(e, B - 1) + 12 * b;
            double turn = 0;
            for (int i = 0; i < n; ++i) jump[i] -= D[B] * d[i];
            for (int i = 3; i < n; ++i) turn += (d[i] - before[i]) * (d[i] - before[i]);
            raise_to(widest_turn, turn);
        }
        double of_centre = 0;
        for (int i = 0; i < 3; ++i) {
            const double x = jump[i] + body.center[0] * jump[3 + i] + body.center[1] * jump[6 + i] +
                             body.center[2] * jump[9 + i];
            of_centre += x * x;
        }
        raise_to(of_centres, of_centre);
        for (int a = 3; a < 12; a += 3)
            raise_to(of_directors, jump[a] * jump[a] + jump[a + 1] * jump[a + 1] + jump[a + 2] * jump[a + 2]);
    }
    if (refuse_turns && !(widest_turn <= 4)) return std::numeric_limits<double>::infinity();
    double largest = std::sqrt(of_centres) / tables_.length;
    raise_to(largest, std::sqrt(0.5 * of_directors));
    return largest;
}

/// Pivots at local nodes first..last of an element: the smallest of them by the largest of all its nodes.
double LobattoWindow::rank_left(int e, int first, int last) const
{
    const int p = system_.rule().degree;
    double largest = 0, smallest = std::numeric_limits<double>::infinity();
    for (int a = 0; a <= p; ++a) {
        const double pivot = system_.nodes().pivot(e * p + a);
        raise_to(largest, pivot);
        if (a >= first && a <= last) smallest = std::min(smallest, pivot);
    }
    return smallest / largest;
}

RankLoss LobattoWindow::rank_loss(int e) const
{
    constexpr double least = 1e-2;   // docs/theory.md, "Singular positions"
    const int p = system_.rule().degree;
    if (rank_left(e, p, p) < least) return RankLoss::at_end;
    return rank_left(e, 1, p - 1) < least ? RankLoss::inside : RankLoss::none;
}

void LobattoWindow::describe(SolveReport& report) const
{
    report.unknowns = std::max(report.unknowns, static_cast<int>(system_.balances().reduced().size()));
    report.smallest_pivot = std::min(report.smallest_pivot, rank_.smallest_pivot);
    report.guess_factorisations = series_.factorisations();
    report.evaluations = system_.evaluations() + series_.evaluations() + kernel_.evaluations();
    if (system_.elimination() != nullptr) system_.elimination()->describe(report);
}

}   // namespace livens
