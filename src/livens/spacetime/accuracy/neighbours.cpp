// SPDX-License-Identifier: BSD-3-Clause
// Differences of neighbouring motions, made small as a whole.  (docs/theory.md, "The horizon")
#include "livens/spacetime/accuracy/neighbours.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "livens/diagnostics/largest.h"
#include "livens/spacetime/accuracy/reference_solution.h"

namespace livens {

namespace {

/// On one side of the motion what bends is of second order, on both sides of third; the smaller, the more of
/// it is what the iteration leaves.
constexpr Nearness beside_one{1e-7, 3e-7, 1e-6}, beside_two{1e-5, 3e-5, 1e-4};
/// Where neighbours are not careful what bends is no more than their iteration may leave.
constexpr Nearness beside_at_first{1e-7, 1e-6, 3e-6};
/// Growth up to which a careful neighbour on one side does, and what an error of it may become.
constexpr double most_of_one = 100, share_of_one = 1e-2;
/// Of what neighbours are apart: what their iteration may leave, if careful by the square of the growth.
constexpr double share_left = 1e-4, least_share_at_first = 1e-5;
/// The square of what they may shrink by, or grow by again from there if that is less, before others have to
/// be careful.
constexpr double most_folded = 100;
/// Elements that neighbours are solved for together, at first and at the most.
constexpr int first_piece = 16, most_in_piece = 128;
/// Where roundings are added behind each: many enough at any instant, of which a few may be where it matters.
constexpr int rounded_piece = 4;
/// Elements after which it is seen whether they have become too far: seldom, since it is foreseen, but soon
/// where it was not, in which case all beyond would be solved in vain.
constexpr int seen_after = 8;
bool is_seen_after(unsigned n) { return n % seen_after == 0 || std::has_single_bit(n); }
/// Pieces that could not be gone through element by element, before nobody tries.
constexpr int most_failed = 3;

/// What lies on the other side of the motion as this piece of a neighbour, from an element on: its guess, off
/// by what bends. Without elements where the two have different ones.
Motion mirrored(const Motion& motion, int first, const Motion& beside)
{
    Motion other;
    const Field &X = motion.X, &Y = beside.X;
    const auto begin = motion.mesh.ends.begin() + first;
    const bool is_alike = X.continuous && X.degree == Y.degree && X.points == Y.points &&
                          X.denominators.empty() &&
                          std::equal(beside.mesh.ends.begin(), beside.mesh.ends.end(), begin);
    if (!is_alike) return other;
    other.mesh = beside.mesh;
    other.X = Y;
    const double* x = X.coefficient(first, 0).data();
    for (double& y : other.X.values) y = 2 * *x++ - y;
    return other;
}

/// A piece that begins anew from a state of the motion is the motion: not of blocks and steps, which go on
/// from more than a state, nor where the motion decides or turns are counted that pieces over events lose.
bool begins_as_motion(const Surroundings& at)
{
    return at.closed || (is_nodal(at.method) && at.model.events().empty() && at.motion.load_angles.empty());
}

}   // namespace

Neighbours::Neighbours(const Surroundings& at, double most_left)
    : at_(at), kicked_(at.model, at.rows()), is_careful_(at.is_careful),
      most_alone_(begins_as_motion(at)
                      ? std::min(most_of_one, std::sqrt(share_of_one * beside_one.small / most_left))
                      : 0),
      has_two_(most_alone_ < 1), near_(has_two_ ? beside_two : beside_one), way_{.length = first_piece}
{
    if (at.closed && !at.has_bends)
        elements_.emplace(at.model, *at.prepared, at.method, *at.closed, at.motion);
    if (elements_ && !elements_->serves()) elements_.reset();
    // what the iteration of the motion left is in the difference, too
    is_careful_ = is_careful_ || !elements_ || elements_->freedoms() == 1 ||
                  most_left > least_share_at_first * near_.small;
    if (!is_careful_) near_ = beside_at_first;
}

Growth Neighbours::grown_from(std::span<const Kicks> kicks, double rate)
{
    for (const Kicks& one : kicks) add(one, near_.small);
    march([&] { judge_start(rate); });
    return std::move(grown_);
}

Growth Neighbours::grown_from(Roundings& roundings)
{
    roundings_ = &roundings;
    way_.length = rounded_piece;
    for (const Kicks& one : roundings.of(motion().at_end(0)))
        if (const double size = size_of(at_.model, one, at_.rate); size > 0) add(one, near_.small / size);
    march([&] {
        for (Perturbed& one : all_) lose_unless_apart(one, at_.rate);
    });
    return std::move(grown_);
}

bool Neighbours::is_unsure() const { return !is_careful_ && way_.folded > most_folded; }

Neighbour Neighbours::neighbour() const
{
    return Neighbour(at_.model, at_.method, at_.quiet, motion(), at_.prepared,
                     at_.closed ? &*at_.closed : nullptr, at_.has_bends);
}

void Neighbours::add(const Kicks& kicks, double factor)
{
    Perturbed one(neighbour(), neighbour());
    one.so_far = 1 / factor;
    for (int k = 0; k < (has_two_ ? 2 : 1); ++k)
        one.starts[k] =
            kicked_.beside(motion().at_end(0), kicks, k == 0 ? factor : -factor, roundings_ != nullptr);
    all_.push_back(std::move(one));
}

/// Where constraints hold at the start perturbations are judged before anything is solved.
void Neighbours::march(const std::function<void()>& judge)
{
    if (at_.closed) judge();
    for (int at = 0; at < motion().n_elements() && !are_lost();) {
        const int last = solve_from(at);
        if (at == 0 && !at_.closed) judge();
        if (are_lost()) break;
        if (at == 0) grown_.factors.push_back(1);
        const int end = record(at, last);
        if (end == at || end == motion().n_elements() || is_unsure()) break;
        bring_near(at, end);
        at = end;
    }
}

bool Neighbours::are_lost() const
{
    return std::ranges::all_of(all_, [](const Perturbed& one) { return one.is_lost; });
}

/// Neighbours bend at instants of their own, and are known well at their element ends alone.
bool Neighbours::have_end(int end) const
{
    return std::ranges::all_of(all_, [&](const Perturbed& one) {
        return one.is_lost || (one.sides[0].has_end(end) && (!has_two_ || one.sides[1].has_end(end)));
    });
}

/// `here`: the motion.
void Neighbours::apart_at(const Perturbed& one, int end, const State& here, Difference& apart) const
{
    if (has_two_)
        one.sides[0].apart_from(one.sides[1].at_end(end), end, 0.5, apart);
    else
        one.sides[0].apart_from(here, end, 1, apart);
}

/// From the one between them.
bool Neighbours::is_too_far(const Neighbour& one, int end)
{
    motion().at_end(end, Side::right, here_);
    one.apart_from(here_, end, 1, apart_);
    return apart_.size(at_.model, at_.rate) > near_.too_wide;
}

double Neighbours::left() const
{
    const double share = share_left / (way_.stretched * way_.stretched);
    return near_.small * (is_careful_ ? share : std::max(share, least_share_at_first));
}

/// The first motion tells how far it is to go before it is too far from the one between them.
int Neighbours::solve_from(int first)
{
    int last = std::min(first + way_.length, motion().n_elements());
    while (last < motion().n_elements() && motion().impacts.at(last) >= 0)
        ++last;   // see Neighbour::has_end()
    if (elements_) {
        const int reached = go_through(first, last);
        if (reached > first) return reached;
        if (++way_.n_failed > most_failed) elements_.reset();
    }
    return solve_by_windows(first, last);
}

/// Element by element. Where that fails the start of the first.
int Neighbours::go_through(int first, int last)
{
    const auto for_sides = [&](auto&& action) {
        for (Perturbed& one : all_)
            for (int k = 0; !one.is_lost && k < (has_two_ ? 2 : 1); ++k)
                if (!action(one, k)) return false;
        return true;
    };
    const bool have_begun = for_sides([&](Perturbed& one, int k) {
        return one.sides[k].begin(*elements_, one.starts[k], first, one.share);
    });
    if (!have_begun) return first;
    const BesideLimits limits{near_.too_wide, left()};
    for (int e = first; e < last; ++e) {
        elements_->open(e);
        const bool is_solved = for_sides([&](Perturbed& one, int k) {
            return one.sides[k].go_on(*elements_, limits, k > 0 ? &one.sides[0] : nullptr);
        });
        if (!is_solved) return first;
        const auto one = std::ranges::find(all_, false, &Perturbed::is_lost);
        if (is_seen_after(static_cast<unsigned>(e - first + 1)) && one != all_.end() &&
            is_too_far(one->sides[0], e + 1))
            return e + 1;
    }
    return last;
}

int Neighbours::solve_by_windows(int first, int last)
{
    bool is_first = true;
    for (Perturbed& each : all_) {
        if (each.is_lost) continue;
        each.is_lost = !each.sides[0].solve(each.starts[0], motion(), first, last, left());
        if (each.is_lost) continue;
        for (int end = first + 1; is_first && end < last; ++end)
            if (each.sides[0].has_end(end + 1) && is_too_far(each.sides[0], end + 1)) last = end;
        is_first = false;
        if (!has_two_) continue;
        const Motion other = mirrored(motion(), first, each.sides[0].motion());
        each.is_lost =
            !each.sides[1].solve(each.starts[1], other.X.empty() ? motion() : other, first, last, left());
    }
    return last;
}

/// How far it is apart at the start; nothing can move but what is driven where that is next to nothing.
double Neighbours::lose_unless_apart(Perturbed& one, double rate) const
{
    if (one.is_lost) return 0;
    const State side = at_.closed ? one.starts[0] : one.sides[0].at_end(0);
    const double size = Difference::of_bodies(at_.model, side, motion().at_end(0), rate);
    one.is_lost = !(size > 1e-3 * near_.small);
    return size;
}

/// Perturbations are judged as they are where all constraints hold.
void Neighbours::judge_start(double rate)
{
    for (Perturbed& one : all_)
        if (const double size = lose_unless_apart(one, rate); !one.is_lost) one.so_far = 1 / size;
}

/// What is perturbed later may grow by more than this one, by as much as this one shrinks at times. An error
/// may grow by what this one shrinks by, and go on with it when it grows again.
void Neighbours::judge_way(Perturbed& one, double width)
{
    one.least = std::min(one.least, width);
    raise_to(one.most, width);
    raise_to(grown_.later, width / one.least);
    const double shrunk = one.most / width;
    raise_to(way_.shrunk, shrunk);
    if (raise_to(one.deepest, shrunk)) one.at_deepest = width;
    const double again = width / one.at_deepest;
    raise_to(way_.folded, std::min(one.deepest, again) * std::min(one.deepest, again));
}

bool Neighbours::wants_other_side() const { return is_careful_ && !has_two_ && way_.stretched > most_alone_; }

/// Up to where one is too wide or wants another side, or to the end of what was solved.
int Neighbours::record(int first, int last)
{
    int end = first;
    for (int next = first + 1; next <= last && !wants_other_side(); ++next) {
        if (!have_end(next)) continue;
        motion().at_end(next, Side::right, here_);
        double size = 0, grown = 0, stretched = 0;
        Growing part;
        for (Perturbed& one : all_) {
            if (one.is_lost) continue;
            apart_at(one, next, here_, apart_);
            const double of_places = apart_.size_of_places(at_.model),
                         width = apart_.size(at_.model, at_.rate, of_places), of_one = one.so_far * of_places;
            raise_to(size, width);
            raise_to(stretched, one.so_far * width);
            judge_way(one, one.so_far * width);
            if (of_one > grown && of_one > way_.largest) part = apart_.most(at_.model, here_.X);
            raise_to(grown, of_one);
        }
        if (size > near_.too_wide && end > first) break;
        if (grown > way_.largest && way_.largest < growth_at_horizon) grown_.part = part;
        raise_to(way_.largest, grown);
        raise_to(way_.stretched, stretched);
        raise_to(grown_.later, way_.stretched * std::min(way_.stretched, way_.shrunk * way_.shrunk));
        for (; end < next; ++end) grown_.factors.push_back(grown);
    }
    return end;
}

/// As a difference of states, off the joints by what bends.
Difference Neighbours::kicked(const State& here, const Kicks& kicks, double factor)
{
    return {kicked_.beside(here, kicks, factor, true), here, 1};
}

/// What elements round on the way is added to what rounding has grown to: of n of them sqrt(n) times it.
void Neighbours::bring_near(int first, int end)
{
    const bool wants_two = has_two_ || wants_other_side();
    const Nearness next = wants_two ? beside_two : near_;
    const int n = end - first;
    double widest = near_.small;
    const State here = motion().at_end(end);
    const std::vector<Kicks> rounded =
        roundings_ != nullptr ? roundings_->of(here) : std::vector<Kicks>(all_.size());
    for (std::size_t i = 0; i < all_.size(); ++i) {
        Perturbed& one = all_[i];
        if (one.is_lost) continue;
        // Near in positions alone is not near: where neighbours cross, their velocities differ most.
        Difference apart;
        apart_at(one, end, here, apart);
        if (roundings_ != nullptr) apart += kicked(here, rounded[i], std::sqrt(n) / one.so_far);
        const double size = apart.size(at_.model, at_.rate), share = next.small / size;
        raise_to(widest, size);
        one.is_lost = !std::isfinite(share);
        one.so_far /= share;
        one.share = share;
        for (int k = 0; k < 2; ++k) {
            one.starts[k] = apart.beside(here, k == 0 ? share : -share);
            one.starts[k].t = motion().mesh.ends[end];
        }
    }
    const double by_element = std::log(widest / near_.small) / n,
                 fitting = std::log(next.wide / next.small) / by_element;
    const int most = roundings_ != nullptr ? rounded_piece : most_in_piece;
    way_.length = static_cast<int>(std::clamp(fitting, 1.0, std::min(2.0 * n, 1.0 * most)));
    has_two_ = wants_two;
    near_ = next;
}

}   // namespace livens
