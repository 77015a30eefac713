// SPDX-License-Identifier: BSD-3-Clause
// Lengths by the velocity jump J: docs/theory.md, "To an accuracy" and "The local error".
#include "livens/spacetime/march/step_size_controller.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/diagnostics/acceptance.h"
#include "livens/diagnostics/diagnostics.h"

namespace livens::inline spacetime_internal {

namespace {

// Measured on 436 runs of twelve problems (docs/theory.md, "To an accuracy").
constexpr double safety = 0.8, shrink = 0.3, grow = 2.5;
/// Steps of an element that is as long as it should be; and those that cost more than shorter elements do, of
/// which the next is at least this share.
constexpr int most_steps = 10;
constexpr double far_too_many = 30, least_ease = 0.5;
constexpr double worth_a_factor = 1.4;   // times the length: less does not pay for another factor
constexpr double steepest = 0.5;         // of what one length is foretold to be shorter than the one before
/// After an element that saw nothing of the motion: of its length, and by how much this regains from element
/// to element, the faster the longer all goes well.
constexpr double below_blind = 0.8, regain = 1.01;
constexpr double refused_above = 20;   // of the tolerance: refusing earlier gains nothing
/// Of the duration: shorter elements are none.
constexpr double shortest = 1e-9;
/// What rounding alone makes of a jump; up to a hundred times as much says only that elements may be longer.
constexpr double least_jump = 1e-15;

/// In tolerances: what elements lose that are not ruled by it. And how many of them there are between stops
/// that do not rule them either.
constexpr double much_less = 1e-5;
constexpr int many_between_stops = 4;

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

StepSizeController::StepSizeController(Points points, int degree, double tolerance, double first_length,
                                       std::vector<double> stops)
    : points_(points), degree_(degree), tolerance_(tolerance), length_(first_length),
      largest_jump_(
          std::min(acceptable_velocity_jump, velocity_jump_of(points, degree, refused_above * tolerance))),
      stops_(std::move(stops))
{}

/// A stop that is at most 2 percent beyond the length is reached at once; where no more than three elements
/// are left to it they are made alike, so that none of them is a sliver.
double StepSizeController::next_end(double t) const
{
    const double stop = *std::upper_bound(stops_.begin(), stops_.end() - 1, t);
    const double left = stop - t, pieces = std::ceil(0.98 * left / length_);
    if (pieces <= 1) return stop;
    const double end = pieces <= 3 ? t + left / pieces : t + length_;
    return end < stop ? end : stop;
}

bool StepSizeController::is_stop(double t) const
{
    return std::binary_search(stops_.begin(), stops_.end(), t);
}

void StepSizeController::sample_at(std::vector<double> stops, double error)
{
    sampled_ = {std::move(stops), error};
}

bool StepSizeController::may_leave(double stop) const
{
    return is_stop(stop) && stop != stops_.front() && stop != stops_.back() &&
           std::ranges::binary_search(sampled_.first, stop);
}

void StepSizeController::leave(double stop)
{
    if (!may_leave(stop)) return;
    stops_.erase(std::ranges::lower_bound(stops_, stop));
    left_.push_back(stop);
}

double StepSizeController::largest_jump(double start, double end) const
{
    const auto inside = std::ranges::upper_bound(left_, start);
    const bool is_sampled = inside != left_.end() && *inside < end;
    return is_sampled ? std::min(largest_jump_, sampled_.second) : largest_jump_;
}

/// 0.8 h (tau / e)^(1 / (2 p + 1)), of radau ^(1 / 2 p); how far it may go is for those who ask.
double StepSizeController::suggestion(double length, double jump) const
{
    const double error = local_error(points_, degree_, jump);
    return length * safety * power(tolerance_ / error, 1 / order(points_, degree_));
}

/// By how much the next scale will be smaller than this one, if scales go on as they do. The smaller of the
/// two before counts, since jumps that pass through zero make single scales large.
double StepSizeController::trend_to(double scale)
{
    const double before = std::min(scales_[0], scales_[1]);
    scales_[0] = std::exchange(scales_[1], scale);
    return std::clamp(scale / before, steepest, 1.0);
}

/// `whole` is the length that the error and its trend allow, `most` what the steps of the iteration do. What
/// the latter alone take away is held_back_.
void StepSizeController::accepted(double length, double jump, int steps, bool has_factor)
{
    // an element that a stop cut short says as much as a whole one, but not beyond what was tried before
    const double tried = steps <= far_too_many && length < length_ ? length_ : 0;
    const double ease = steps > most_steps ? std::clamp(far_too_many / steps, least_ease, 1.0) : grow;
    const double most = std::max(ease * length, tried);
    const bool is_rounding = jump < 100 * least_jump;
    seen_.jump = std::max(seen_.jump, jump);
    blind_.second *= regain;
    blind_.first *= blind_.second;
    const double trend = is_rounding ? 1 : trend_to(length * power(jump, -1.0 / (degree_ + 1)));
    const double longest = std::max(grow * length, most);
    const double whole = is_rounding ? longest : std::max(trend * suggestion(length, jump), shrink * length);
    length_ = std::min(whole, most);
    length_ = std::min(length_, std::max(blind_.first, length));
    held_back_ = std::max(std::min({whole, longest, std::max(blind_.first, length)}) / length_, 1.0);
    if (has_factor && length_ > length && length_ < worth_a_factor * length) length_ = length;
    last_refused_.first -= length;
    if (last_refused_.first > 1e-3 * length && length_ > last_refused_.second) {
        length_ = last_refused_.second;
        held_back_ = 1;
    }
    if (is_rounding && seen_.tells_length) return;
    if (!is_rounding && !seen_.tells_length) seen_.sum_of_scales = seen_.n_accepted = 0;
    seen_.tells_length = !is_rounding;
    seen_.sum_of_scales += logarithm(length) - logarithm(std::max(jump, least_jump)) / (degree_ + 1);
    ++seen_.n_accepted;
}

void StepSizeController::too_dear(double length)
{
    blind_.first = below_blind * length;
    blind_.second = 1;
    length_ = std::min(length_, blind_.first);
}

/// An element that saw nothing of the motion says nothing of the right length either: it is halved, and those
/// behind it stay below 0.8 of its length for a while. Else its jump tells, 0.3 to 0.9 of the length.
bool StepSizeController::rejected(double length, double jump, double most)
{
    if (most == 0) most = largest_jump_;
    const bool is_lie = !(jump <= acceptable_velocity_jump);
    if (is_lie) {
        blind_.first = below_blind * length;
        blind_.second = 1;
    }
    const double whole =
        std::min(suggestion(length, jump), 0.9 * length * power(most / jump, 1.0 / (degree_ + 1)));
    length_ = is_lie ? 0.5 * length : std::clamp(whole, shrink * length, 0.9 * length);
    last_refused_.first = length;
    last_refused_.second = length_;
    return ascends() && length_ > shortest * (stops_.back() - stops_.front());
}

bool StepSizeController::ascends() const
{
    const double latest = std::max(std::abs(stops_.front()), std::abs(stops_.back()));
    return length_ > 4 * std::numeric_limits<double>::epsilon() * latest;
}

/// With the geometric mean of the scales H = h J^(-1 / (p + 1)), which do not depend on lengths: an element
/// of the length H J_tau^(1 / (p + 1)) has the jump J_tau that loses the tolerance.
double StepSizeController::mean_length(int degree, double tolerance) const
{
    if (seen_.n_accepted == 0) return 0;
    const double scale = exponential(seen_.sum_of_scales / seen_.n_accepted);
    return safety * scale * power(velocity_jump_of(points_, degree, tolerance), 1.0 / (degree + 1));
}

/// (h / h_tau)^(2 p + 1) by geometric means of both; 1 where stops rule the lengths.
double StepSizeController::lost(const TimeMesh& mesh) const
{
    if (!seen_.tells_length) return 1;
    double sum = 0;
    for (int e = 0; e < mesh.n_elements(); ++e) sum += logarithm(mesh.length(e));
    const double length = exponential(sum / mesh.n_elements());
    if (many_between_stops * length > mean_stop()) return 1;
    const double lost = power(length / mean_length(), order(points_, degree_));
    return lost < much_less ? lost : 1;
}

double StepSizeController::mean_stop() const
{
    return (stops_.back() - stops_.front()) / static_cast<double>(stops_.size() - 1);
}

}   // namespace livens::inline spacetime_internal
