// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/pace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/diagnostics/acceptance.h"
#include "livens/diagnostics/diagnostics.h"

namespace livens {

namespace {

// Measured on 436 runs of twelve problems (docs/theory.md, "To an accuracy").
constexpr double safety = 0.8, shrink = 0.3, grow = 2.5;
/// After an element that saw nothing of the motion: of its length, and by how much this regains from element
/// to element, the faster the longer all goes well.
constexpr double below_blind = 0.8, regain = 1.01;
constexpr double refused_above = 20;   // of the tolerance: refusing earlier gains nothing
/// Of the duration: shorter elements are none.
constexpr double shortest = 1e-9;
/// What rounding alone makes of a jump; up to a hundred times as much says only that elements may be longer.
constexpr double least_jump = 1e-15;

/// Of J in the local error, and of h in it, by which lengths follow.
double exponent(Points points, int degree)
{
    return (points == Points::lobatto ? 2.0 * degree + 1 : 2.0 * degree) / (degree + 1);
}
double order(Points points, int degree) { return exponent(points, degree) * (degree + 1); }

}   // namespace

double velocity_jump_of(Points points, int degree, double error)
{
    return power(error / local_error(points, degree, 1), 1 / exponent(points, degree));
}

Pace::Pace(Points points, int degree, double tolerance, double first_length, std::vector<double> stops)
    : points_(points), degree_(degree), tolerance_(tolerance), length_(first_length),
      largest_jump_(
          std::min(acceptable_velocity_jump, velocity_jump_of(points, degree, refused_above * tolerance))),
      stops_(std::move(stops))
{}

double Pace::next_end(double t) const
{
    const double stop = *std::upper_bound(stops_.begin(), stops_.end() - 1, t);
    const double left = stop - t, pieces = std::ceil(0.98 * left / length_);
    if (pieces <= 1) return stop;
    const double end = pieces <= 3 ? t + left / pieces : t + length_;
    return end < stop ? end : stop;
}

bool Pace::is_stop(double t) const { return std::binary_search(stops_.begin(), stops_.end(), t); }

double Pace::suggestion(double length, double jump) const
{
    const double error = local_error(points_, degree_, jump);
    return length * safety * power(tolerance_ / error, 1 / order(points_, degree_));
}

void Pace::accepted(double length, double jump, bool is_slow)
{
    // an element that a stop cut short says as much as a whole one, but not beyond what was tried before
    const double most = std::max((is_slow ? 1 : grow) * length, length < length_ ? length_ : 0);
    const bool is_rounding = jump < 100 * least_jump;
    regained_ *= regain;
    blind_length_ *= regained_;
    length_ = is_rounding ? most : std::clamp(suggestion(length, jump), shrink * length, most);
    length_ = std::min(length_, std::max(blind_length_, length));
    if (is_rounding && tells_length_) return;
    if (!is_rounding && !tells_length_) sum_of_scales_ = n_accepted_ = 0;
    tells_length_ = !is_rounding;
    sum_of_scales_ += logarithm(length) - logarithm(std::max(jump, least_jump)) / (degree_ + 1);
    ++n_accepted_;
}

bool Pace::refused(double length, double jump)
{
    const bool is_lie = !(jump <= acceptable_velocity_jump);
    if (is_lie) {
        blind_length_ = below_blind * length;
        regained_ = 1;
    }
    length_ = is_lie ? 0.5 * length : std::clamp(suggestion(length, jump), shrink * length, 0.9 * length);
    return length_ > shortest * (stops_.back() - stops_.front());
}

double Pace::mean_length(int degree, double tolerance) const
{
    if (n_accepted_ == 0) return 0;
    const double scale = exponential(sum_of_scales_ / n_accepted_);
    return safety * scale * power(velocity_jump_of(points_, degree, tolerance), 1.0 / (degree + 1));
}

double Pace::mean_stop() const
{
    return (stops_.back() - stops_.front()) / static_cast<double>(stops_.size() - 1);
}

}   // namespace livens
