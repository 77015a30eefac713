// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/march/event_locator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/spacetime/march/window.h"

namespace livens {

/// A bend that was found ends the element if it lies ahead. Until it is met no element is longer than
/// `longest_`: one that was too long would step over the bend once more.
double EventLocator::end(double start, double wanted)
{
    wanted_ = std::min(wanted, start + longest_);
    return at_ > start && at_ < wanted_ ? at_ : wanted_;
}

/// An end that was expected counts as found: moves() corrects it, or lets it go where nothing bends.
void EventLocator::begin(double end)
{
    if (is_found(end) || !std::ranges::binary_search(expected_, end)) return;
    at_ = end;
    is_expected_ = true;
}

/// The way of an element that ends at a bend is followed beyond its end, as the bend may lie behind it; that
/// of any other to its end alone. The new end lies by `margin` before the bend.
bool EventLocator::moves(Window& window, double start, double end)
{
    if (n_crowded_ >= most_crowded) return false;
    constexpr double spacings = 4 * std::numeric_limits<double>::epsilon();
    const bool was_found = is_found(end);
    const double length = end - start, margin = std::max(before * length, spacings * std::abs(end));
    const double bend = start + length * window.monitor().bend(was_found ? beyond : 1);
    is_met_ = was_found && std::abs(bend - end) <= 3 * margin;
    if (std::isinf(bend) && std::exchange(is_expected_, false)) at_ = -infinite;   // an end like others
    const double nearest = std::max(shortest_, 2 * margin);   // its end would not be behind its start
    if (is_met_ || std::isinf(bend) || (!was_found && end - bend <= margin) || bend - start < nearest)
        return false;
    n_moves_ = was_found && start == moved_from_ ? n_moves_ + 1 : 0;
    moved_from_ = start;
    if (n_moves_ > most_moves) return false;
    at_ = bend - margin;
    return at_ < wanted_;
}

/// Counts elements in succession that are tiny, and ends that crowd, by which marches on a jump are seen.
bool EventLocator::accepted(double start, double end)
{
    const bool was_found = is_found(end);
    longest_so_far_ = std::max(longest_so_far_, end - start);
    n_tiny_ = end - start < tiny * longest_so_far_ ? n_tiny_ + 1 : 0;
    n_crowded_ = was_found && end - start < crowded * (wanted_ - start) ? n_crowded_ + 1 : 0;
    if (!was_found)
        longest_ *= 2;
    else   // what is not met there lies ahead, and long elements would see it too early again
        longest_ = is_met_ ? infinite : 2 * (end - start);
    return was_found && is_met_;
}

}   // namespace livens
