// SPDX-License-Identifier: BSD-3-Clause
// What the kernel of a march begins an element with.
#include <algorithm>
#include <cmath>

#include "livens/base/elementary.h"
#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/spacetime/nodal/kernel/march_kernel.h"

namespace livens {

namespace {

// Lengths or radians; below, the series, which costs a quarter of a step, has to be nearer by a factor.
constexpr double near_enough = 1e-6, much_nearer = 4;

}   // namespace

/// Places of a node, tau after the start, from the series there; 7 numbers a body, `stride` apart.
void MarchKernel::place_series(const TwistSeries& series, double tau, const InstantState& start, int stride,
                               double* place)
{
    series.at(tau, work_.twist.data());
    for (int b = 0; b < tables_.n_bodies(); ++b, place += 7 * stride) {
        const BodyTable& body = tables_.bodies[b];
        const double *t = work_.twist.data() + body.first, *w = t + 3, *d = start.X.data() + 12 * b + 3;
        double dX[12];
        for (int i = 0; i < 3; ++i) place[i * stride] = t[i];
        if (body.dofs == 3) continue;
        const double angle = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
        const SineCosine half = sine_cosine(0.5 * angle);
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

/// Places of all nodes: from the series at the start, or by the polynomial of the element before, whichever
/// was nearer to the end of the last element.
void MarchKernel::guess(const Stretch& stretch, const InstantState& start)
{
    const double h = stretch.h(0);
    const TwistSeries series(tables_, start, h);
    double* place = nodes_.values().place;
    const int W = functions_->width;
    guess_.by_polynomial.is_known = start.has_past && guess_.polynomial.follows(stretch.times.front(), h);
    guess_.by_series.is_known = guess_.by_polynomial.is_known;   // else there is nothing to compare
    if (guess_.by_polynomial.is_known && guess_.is_polynomial) {
        place_series(series, h, start, 1, guess_.by_series.place.data());
        guess_.polynomial.place(h, place);
        return keep_end(guess_.by_polynomial);
    }
    if (guess_.by_polynomial.is_known) {
        guess_.polynomial.place(h, place);
        keep_end(guess_.by_polynomial);
    }
    for (int l = 0; l < rule_.degree; ++l)
        place_series(series, rule_.nodes[node_of(l)] * h, start, W, place + l);
    if (guess_.by_series.is_known) keep_end(guess_.by_series);
}

void MarchKernel::keep_end(Guess::End& end) const
{
    const double* place = nodes_.values().place;
    for (std::size_t i = 0; i < end.place.size(); ++i) end.place[i] = place[i * functions_->width];
}

/// How far the end of the element is from there now, lengths and radians.
double MarchKernel::moved_from(const Guess::End& end) const
{
    const double* place = nodes_.values().place;
    double far = 0, wide = 0;
    for (int b = 0; b < tables_.n_bodies(); ++b)
        for (int i = 0; i < (tables_.bodies[b].dofs == 6 ? 7 : 3); ++i) {
            const double gap = std::abs(end.place[7 * b + i] - place[(7 * b + i) * functions_->width]);
            (i < 3 ? far : wide) = std::max(i < 3 ? far : wide, gap);
        }
    return std::max(far / tables_.length, 2 * wide);
}

/// Where the element has ended now.
void MarchKernel::compare_guesses()
{
    if (!guess_.by_polynomial.is_known) return;
    const double polynomial = moved_from(guess_.by_polynomial), series = moved_from(guess_.by_series);
    guess_.is_polynomial = polynomial < (polynomial < near_enough ? much_nearer : 1) * series;
}

bool MarchKernel::follow(const Stretch& stretch)
{
    if (!guess_.following.place(stretch, nodes_.values().place)) return false;
    guess_.by_polynomial.is_known = false;   // nothing to compare
    return true;
}

}   // namespace livens
