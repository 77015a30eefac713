// SPDX-License-Identifier: BSD-3-Clause
// The guess for one element: the Taylor series of the twist from velocity, acceleration and the cubic through
// the ends of the element before, and where its last term is not small, the element with half the degree,
// which costs an eighth (docs/theory.md, "Newton's iteration").
#include "livens/spacetime/nodal/series.h"

#include <algorithm>
#include <cmath>

#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/spacetime/nodal/system.h"
#include "livens/time/basis.h"

namespace livens {

namespace {

/// Where the series at the start may be off by more than this (of the model's length, or rad), a solution of
/// half the degree makes a guess that saves more iterations than it costs (measured on P16, degrees 4 to 16).
constexpr double trusted_guess = 1e-3;
constexpr int least_halved = 4;   // degree

/// Lengths of the model that the series may add to a steady flight before it is not believed.
constexpr double far_away = 0.5;

/// The side of the start on which the element lies.
int side_of(double h) { return h > 0 ? 1 : 0; }

}   // namespace

Series::~Series() = default;

long long Series::evaluations() const
{
    return coarse_ ? coarse_->evaluations() + coarse_series_->evaluations() : 0;
}

Series::Series(const ModelTables& tables, const ElementRule& rule) : tables_(tables), rule_(rule) {}

void Series::make_coarse()
{
    const ElementRule& half = element_rule(rule_.points, rule_.degree / 2);
    coarse_ = std::make_unique<NodalSystem>(tables_, half);
    coarse_series_ = std::make_unique<Series>(tables_, half);
    const LagrangeBasis basis(half.nodes);
    to_fine_.assign(static_cast<std::size_t>(rule_.size() * basis.size()), 0.0);
    for (int A = 0; A < rule_.size(); ++A)
        basis.values(rule_.nodes[A],
                     {to_fine_.data() + A * basis.size(), static_cast<std::size_t>(basis.size())});
}

/// Size of the last terms of the series below at the end of the element: how far it may be trusted.
double Series::error(const InstantState& start, double h) const
{
    double size = 0;
    for (const auto& body : tables_.bodies) {
        for (int i = 0; i < body.dofs; ++i) {
            const int k = body.first + i;
            const double a = start.acceleration[side_of(h)][k], j = start.jerk[k], s = start.snap[k];
            const double term = start.has_past
                                    ? std::abs(h) * h * h / 6 * (std::abs(j) + std::abs(h) / 4 * std::abs(s))
                                    : h * h / 6 * std::abs(a);
            size = std::max(size, i < 3 ? term / tables_.length : term);
        }
    }
    return size;
}

TwistSeries::TwistSeries(const ModelTables& tables, const InstantState& start, double h)
    : tables_(tables), start_(start), acceleration_(start.acceleration[side_of(h)].data())
{
    const double *a = acceleration_, *j = start.jerk.data(), *s = start.snap.data();
    double away = 0, turn = 0;   // by h^2 / 2 and h^2
    for (const auto& body : tables_.bodies) {
        for (int i = body.first; i < body.first + 3; ++i)
            away = std::max(away, std::abs(a[i]) +
                                      std::abs(h) / 3 * (std::abs(j[i]) + std::abs(h) / 4 * std::abs(s[i])));
        for (int i = 3; i < body.dofs; ++i) turn = std::max(turn, std::abs(a[body.first + i]));
    }
    on_ = h * h * std::max(away / (2 * far_away * tables_.length), turn) < 1 ? 1 : 0;
}

void TwistSeries::at(double tau, double* __restrict twist) const
{
    const double *v = start_.velocity.data(), *a = acceleration_, *j = start_.jerk.data(),
                 *s = start_.snap.data(), c = on_ * tau * tau * tau / 12;
    for (int i = 0; i < tables_.n_twists; ++i)
        twist[i] = tau * (v[i] + tau / 2 * on_ * (a[i] + tau / 3 * (j[i] + tau / 4 * s[i])));
    for (const auto& body : tables_.bodies) {
        if (body.dofs == 3) continue;
        // turns do not commute: second term of the Magnus series
        const int x = body.first + 3, y = x + 1, z = x + 2;
        twist[x] += c * (a[y] * v[z] - a[z] * v[y]);
        twist[y] += c * (a[z] * v[x] - a[x] * v[z]);
        twist[z] += c * (a[x] * v[y] - a[y] * v[x]);
    }
}

/// Nodes from the series of the twist at the start.
void Series::predict(NodalSystem& system, const InstantState& start) const
{
    const ElementRule& rule = system.rule();
    const double h = system.layout().h(0);
    const TwistSeries series(tables_, start, h);
    std::vector<double> move(tables_.n_twists);
    for (int B = 1; B <= rule.degree; ++B) {
        series.at(rule.nodes[B] * h, move.data());
        system.nodes().place_from(B, 0, move.data());
    }
}

/// Nodes interpolated from a solution of half the degree.
bool Series::place_coarse(NodalSystem& system, const InstantState& start)
{
    WindowLayout layout = system.layout();
    layout.degree = coarse_->rule().degree;
    coarse_->open(layout, &start, nullptr);
    coarse_series_->place(*coarse_, start);
    if (!coarse_->settle()) return false;
    const NewtonReport report = newton_.run(*coarse_, {1e-5, 12, {}});
    factorisations_ += report.factorisations;
    if (report.status != SolveStatus::converged) return false;
    const int bodies = tables_.n_bodies(), m = coarse_->rule().size();
    std::vector<double> turns(static_cast<std::size_t>(7 * bodies * m), 0.0),
        turn(static_cast<std::size_t>(7 * bodies));
    for (int B = 0; B < m; ++B) {
        for (int b = 0; b < bodies; ++b) {
            const double* dX = coarse_->nodes().dX(0, B) + 12 * b;
            double* q = turns.data() + 7 * (B * bodies + b);
            std::copy(dX, dX + 3, q);
            q[3] = 1;
            if (B > 0 && tables_.bodies[b].dofs == 6)
                twist::quaternion_of(coarse_->nodes().X(0) + 12 * b, dX, q + 3);
        }
    }
    for (int A = 1; A <= system.rule().degree; ++A) {
        std::fill(turn.begin(), turn.end(), 0.0);
        for (int B = 0; B < m; ++B)
            for (int i = 0; i < 7 * bodies; ++i) turn[i] += to_fine_[A * m + B] * turns[7 * B * bodies + i];
        for (int b = 0; b < bodies; ++b) {
            double* z = turn.data() + 7 * b + 3;
            const double size = std::sqrt(z[0] * z[0] + z[1] * z[1] + z[2] * z[2] + z[3] * z[3]);
            if (!(size > 0.1)) return false;   // turns too far apart to be averaged
            for (int i = 0; i < 4; ++i) z[i] /= size;
        }
        system.nodes().turn_from(A, 0, turn.data());
    }
    return true;
}

void Series::place(NodalSystem& system, const InstantState& start)
{
    predict(system, start);
    if (rule_.degree < least_halved || !(error(start, system.layout().h(0)) > trusted_guess)) return;
    if (!coarse_) make_coarse();
    if (!place_coarse(system, start)) predict(system, start);
}

}   // namespace livens
