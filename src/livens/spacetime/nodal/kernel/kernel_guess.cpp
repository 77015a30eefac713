// SPDX-License-Identifier: BSD-3-Clause
// Places of an element's nodes before its iteration: the Taylor series of the twist, of order h^5, which a
// polynomial through p + 1 nodes beats where they resolve the motion, although it is extrapolated
// (docs/theory.md, "Without a tangent", Guesses; of a motion that is followed: "The estimated error").
#include "livens/spacetime/nodal/kernel/kernel_guess.h"

#include <algorithm>
#include <cmath>

#include "livens/base/elementary.h"
#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/twist.h"

namespace livens {

namespace {

// Lengths or radians; below, the series, which costs a quarter of a step, has to be nearer by a factor.
constexpr double near_enough = 1e-6, much_nearer = 4;
constexpr int elements_alone = 16;   // behind one that was not found near the motion that is followed

}   // namespace

KernelGuess::KernelGuess(const ModelTables& tables, const ElementRule& rule,
                         const lanes::Functions* functions)
    : tables_(tables), rule_(rule), functions_(functions), twist_(tables.n_twists)
{
    if (functions == nullptr) return;
    polynomial_ = Extrapolation(rule, *functions);
    for (End* end : {&by_series_, &by_polynomial_}) end->place.assign(7 * tables.bodies.size(), 0.0);
}

/// Places of a node, tau after the start, from the series there; 7 numbers a body, `stride` apart.
void KernelGuess::place_series(const TwistSeries& series, double tau, const InstantState& start, int stride,
                               double* place)
{
    series.at(tau, twist_.data());
    for (int b = 0; b < tables_.n_bodies(); ++b, place += 7 * stride) {
        const BodyTable& body = tables_.bodies[b];
        const double *t = twist_.data() + body.first, *w = t + 3, *d = start.X.data() + 12 * b + 3;
        double dX[12];
        for (int i = 0; i < 3; ++i) place[i * stride] = t[i];
        if (body.dofs == 3) continue;
        const double angle = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
        const SineCosine half = sine_cosine(0.5 * angle);
        // sin(a / 2) / a, which is 1/2 to rounding for small angles
        const double factor = angle > 1e-8 ? half.sine / angle : 0.5;
        place[3 * stride] = half.cosine;
        for (int a = 0; a < 3; ++a)
            place[(4 + a) * stride] = factor * (d[3 * a] * w[0] + d[3 * a + 1] * w[1] + d[3 * a + 2] * w[2]);
        if (!body.offset) continue;
        twist::displacement(t, d - 3, dX);
        for (int i = 0; i < 3; ++i)
            place[i * stride] +=
                dX[3 + i] * body.center[0] + dX[6 + i] * body.center[1] + dX[9 + i] * body.center[2];
    }
}

/// Where a polynomial goes on, the end of the element by both ways is kept for compare(): of a series that is
/// not used that is all that is made.
void KernelGuess::place(const WindowLayout& layout, const InstantState& start, double* place)
{
    was_followed_ = n_alone_ == 0 && following_.place(layout, place);
    if (was_followed_) {
        by_polynomial_.is_known = false;   // nothing to compare
        return;
    }
    const double h = layout.h(0);
    const TwistSeries series(tables_, start, h);
    const int W = functions_->width;
    by_polynomial_.is_known = start.has_past && polynomial_.follows(layout.times.front(), h);
    by_series_.is_known = by_polynomial_.is_known;   // else there is nothing to compare
    if (by_polynomial_.is_known && is_polynomial_) {
        place_series(series, h, start, 1, by_series_.place.data());
        polynomial_.place(h, place);
        return keep_end(by_polynomial_, place);
    }
    if (by_polynomial_.is_known) {
        polynomial_.place(h, place);
        keep_end(by_polynomial_, place);
    }
    for (int l = 0; l < rule_.degree; ++l)
        place_series(series, rule_.nodes[l == 0 ? rule_.degree : l] * h, start, W, place + l);
    if (by_series_.is_known) keep_end(by_series_, place);
}

void KernelGuess::part() { n_alone_ = elements_alone; }

void KernelGuess::keep_end(End& end, const double* place) const
{
    for (std::size_t i = 0; i < end.place.size(); ++i) end.place[i] = place[i * functions_->width];
}

/// How far the end of the element is from there now, lengths and radians.
/// Vector parts of quaternions are half of small angles.
double KernelGuess::moved_from(const End& end, const double* place) const
{
    double far = 0, wide = 0;
    for (int b = 0; b < tables_.n_bodies(); ++b)
        for (int i = 0; i < (tables_.bodies[b].dofs == 6 ? 7 : 3); ++i) {
            const double gap = std::abs(end.place[7 * b + i] - place[(7 * b + i) * functions_->width]);
            (i < 3 ? far : wide) = std::max(i < 3 ? far : wide, gap);
        }
    return std::max(far / tables_.length, 2 * wide);
}

void KernelGuess::compare(const double* place)
{
    if (!by_polynomial_.is_known) return;
    const double polynomial = moved_from(by_polynomial_, place), series = moved_from(by_series_, place);
    is_polynomial_ = polynomial < (polynomial < near_enough ? much_nearer : 1) * series;
}

void KernelGuess::remember(const double* place, const WindowLayout& layout)
{
    polynomial_.remember(place, tables_.n_bodies(), layout.times.front(), layout.times.back());
}

void KernelGuess::forget()
{
    is_polynomial_ = false;
    polynomial_.forget();
}

}   // namespace livens
