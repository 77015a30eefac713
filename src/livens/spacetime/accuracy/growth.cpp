// SPDX-License-Identifier: BSD-3-Clause
// How perturbations of the start grow: neighbouring motions, carried along.  (docs/theory.md, "The horizon")
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "livens/diagnostics/largest.h"
#include "livens/spacetime/accuracy/neighbour.h"
#include "livens/spacetime/accuracy/perturbations.h"
#include "livens/spacetime/accuracy/reference_solution.h"

namespace livens {

namespace {

/// How near neighbours are, in lengths of the model and rad: where they are brought near again, and how far
/// they may part until then, as foreseen and at the most.
struct Nearness {
    double small, wide, too_wide;
};
/// On one side of the motion what bends is of second order, on both sides of third; the smaller, the more of
/// it is what the iteration leaves.
constexpr Nearness beside_one{1e-7, 3e-7, 1e-6}, beside_two{1e-5, 3e-5, 1e-4};
/// Growth up to which a neighbour on one side does, and what an error of it may become. Not where a piece
/// that begins anew is not the motion: blocks, and steps that go on from more than a state.
constexpr double most_of_one = 100, share_of_one = 1e-2;
/// Of what neighbours are apart: what their iteration may leave, by the square of the growth.
constexpr double share_left = 1e-4;
/// Of numbers, by half.
constexpr double spacing = 0x1p-53;
/// Elements that neighbours are solved for together, at first and at the most.
constexpr int first_piece = 16, most_in_piece = 128;
/// Where roundings are added behind each: many enough at any instant, of which a few may be where it matters.
constexpr int rounded_piece = 4;

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

/// A motion beside the one at hand, or one on either side of it: what bends in half their difference is of
/// third order.
struct Perturbed {
    Perturbed(Neighbour one, Neighbour other) : sides{std::move(one), std::move(other)} {}

    Neighbour sides[2];
    State starts[2]{};
    double so_far = 1;            // by the difference at hand: what was made smaller on the way
    double least = 1, most = 1;   // that it was stretched to, positions and velocities
    bool is_lost = false;
};

/// What neighbours are made of.
struct Surroundings {
    const Model& model;
    const Method& method;
    const SolveOptions& quiet;
    const Motion& motion;
    const std::shared_ptr<Prepared>& prepared;
    const std::optional<Ends>& closed;   // where a window marches
    double rate;                         // the fastest there ever is
    bool has_bends = false;              // of their own

    /// On which perturbations are put.
    std::span<const int> rows() const
    {
        return closed ? std::span<const int>(closed->independent) : std::span<const int>();
    }
};

/// All of them, piece by piece; between pieces they are brought near again.
class Neighbours {
public:
    Neighbours(const Surroundings& at, double most_left)
        : at_(at), motion_(at.motion),
          most_alone_(
              at.closed ? std::min(most_of_one, std::sqrt(share_of_one * beside_one.small / most_left)) : 0),
          has_two_(most_alone_ < 1), near_(has_two_ ? beside_two : beside_one)
    {}

    /// At element ends, as far as any can be solved: by the size at the start, with velocities by this rate.
    Growth grown_from(const std::vector<Kicks>& kicks, double rate)
    {
        for (const Kicks& one : kicks) add(one, near_.small);
        march([&] { judge_start(rate); });
        return std::move(grown_);
    }
    /// By what the kicks are: of the start, and of every element, as roundings are.
    Growth grown_from(Roundings& roundings)
    {
        roundings_ = &roundings;
        length_ = rounded_piece;
        for (const Kicks& one : roundings.of(motion_.at_end(0)))
            if (const double size = size_of(at_.model, one, at_.rate); size > 0) add(one, near_.small / size);
        march([&] {
            for (Perturbed& one : all_) lose_unless_apart(one, at_.rate);
        });
        return std::move(grown_);
    }

private:
    Neighbour neighbour() const
    {
        return Neighbour(at_.model, at_.method, at_.quiet, motion_, at_.prepared,
                         at_.closed ? &*at_.closed : nullptr, at_.has_bends);
    }

    void add(const Kicks& kicks, double factor)
    {
        Perturbed one(neighbour(), neighbour());
        one.so_far = 1 / factor;
        for (int k = 0; k < (has_two_ ? 2 : 1); ++k)
            one.starts[k] =
                beside(at_.model, motion_.at_end(0), kicks, k == 0 ? factor : -factor, at_.rows());
        all_.push_back(std::move(one));
    }

    void march(const std::function<void()>& begin)
    {
        for (int at = 0; at < motion_.n_elements();) {
            const int last = solve_from(at);
            if (at == 0) begin();
            if (are_lost()) break;
            if (at == 0) grown_.factors.push_back(1);
            const int end = record(at, last);
            if (end == at) break;
            bring_near(at, end);
            at = end;
        }
    }

    bool are_lost() const
    {
        return std::ranges::all_of(all_, [](const Perturbed& one) { return one.is_lost; });
    }

    /// Neighbours bend at instants of their own, and are known well at their element ends alone.
    bool has_end(const Motion& beside, int end) const
    {
        return std::ranges::binary_search(beside.mesh.ends, motion_.mesh.ends[end]);
    }
    bool have_end(int end) const
    {
        return std::ranges::all_of(all_, [&](const Perturbed& one) {
            return one.is_lost || (has_end(one.sides[0].motion(), end) &&
                                   (!has_two_ || has_end(one.sides[1].motion(), end)));
        });
    }

    Difference apart_at(const Perturbed& one, int end) const
    {
        const double t = motion_.mesh.ends[end];
        return has_two_ ? Difference(one.sides[0].motion().at(t), one.sides[1].motion().at(t), 0.5)
                        : Difference(one.sides[0].motion().at(t), motion_.at_end(end), 1);
    }

    /// The first motion tells how far it is to go before it is too far from the one between them.
    int solve_from(int first)
    {
        int last = std::min(first + length_, motion_.n_elements());
        const double left = share_left * near_.small / (stretched_ * stretched_);
        bool is_first = true;
        for (Perturbed& each : all_) {
            if (each.is_lost) continue;
            each.is_lost = !each.sides[0].solve(each.starts[0], motion_, first, last, left);
            if (each.is_lost) continue;
            const Motion& one = each.sides[0].motion();
            for (int end = first + 1; is_first && end < last; ++end)
                if (has_end(one, end + 1) &&
                    Difference(one.at(motion_.mesh.ends[end + 1]), motion_.at_end(end + 1), 1)
                            .size(at_.model, at_.rate) > near_.too_wide)
                    last = end;
            is_first = false;
            if (!has_two_) continue;
            const Motion other = mirrored(motion_, first, one);
            each.is_lost =
                !each.sides[1].solve(each.starts[1], other.X.empty() ? motion_ : other, first, last, left);
        }
        return last;
    }

    /// How far it is apart at the start; nothing can move but what is driven where that is next to nothing.
    double lose_unless_apart(Perturbed& one, double rate) const
    {
        if (one.is_lost) return 0;
        const State side = one.sides[0].motion().at(motion_.start());
        const double size = Difference::of_bodies(at_.model, side, motion_.at_end(0), rate);
        one.is_lost = !(size > 1e-3 * near_.small);
        return size;
    }

    /// Perturbations are judged as they are where all constraints hold.
    void judge_start(double rate)
    {
        for (Perturbed& one : all_)
            if (const double size = lose_unless_apart(one, rate); !one.is_lost) one.so_far = 1 / size;
    }

    /// What is perturbed later may grow by more than this one, by as much as this one shrinks at times.
    void judge_way(Perturbed& one, double width)
    {
        one.least = std::min(one.least, width);
        raise_to(one.most, width);
        raise_to(grown_.later, width / one.least);
        raise_to(shrunk_, one.most / width);
    }

    /// Up to where one is too wide or wants another side, or to the end of what was solved.
    int record(int first, int last)
    {
        int end = first;
        for (int next = first + 1; next <= last && (has_two_ || stretched_ <= most_alone_); ++next) {
            if (!have_end(next)) continue;
            double size = 0, grown = 0, stretched = 0;
            Growing part;
            for (Perturbed& one : all_) {
                if (one.is_lost) continue;
                const Difference apart = apart_at(one, next);
                const double width = apart.size(at_.model, at_.rate),
                             of_one = one.so_far * apart.size_of_places(at_.model);
                raise_to(size, width);
                raise_to(stretched, one.so_far * width);
                judge_way(one, one.so_far * width);
                if (of_one > grown && of_one > largest_) part = apart.most(at_.model, motion_.at_end(next).X);
                raise_to(grown, of_one);
            }
            if (size > near_.too_wide && end > first) break;
            if (grown > largest_ && largest_ < growth_at_horizon) grown_.part = part;
            raise_to(largest_, grown);
            raise_to(stretched_, stretched);
            raise_to(grown_.later, stretched_ * std::min(stretched_, shrunk_ * shrunk_));
            for (; end < next; ++end) grown_.factors.push_back(grown);
        }
        return end;
    }

    /// As a difference of states, off the joints by what bends.
    Difference kicked(int end, const Kicks& kicks, double factor) const
    {
        const State here = motion_.at_end(end);
        return {beside(at_.model, here, kicks, factor, at_.rows()), here, 1};
    }

    /// What elements round on the way is added to what rounding has grown to: of n of them sqrt(n) times it.
    void bring_near(int first, int end)
    {
        const bool wants_two = has_two_ || stretched_ > most_alone_;
        const Nearness next = wants_two ? beside_two : near_;
        const int n = end - first;
        double widest = near_.small;
        const std::vector<Kicks> rounded =
            roundings_ != nullptr ? roundings_->of(motion_.at_end(end)) : std::vector<Kicks>(all_.size());
        for (std::size_t i = 0; i < all_.size(); ++i) {
            Perturbed& one = all_[i];
            if (one.is_lost) continue;
            // Near in positions alone is not near: where neighbours cross, their velocities differ most.
            Difference apart = apart_at(one, end);
            if (roundings_ != nullptr) apart += kicked(end, rounded[i], std::sqrt(n) / one.so_far);
            const double size = apart.size(at_.model, at_.rate), share = next.small / size;
            raise_to(widest, size);
            one.is_lost = !std::isfinite(share);
            one.so_far /= share;
            for (int k = 0; k < 2; ++k) {
                one.starts[k] = apart.beside(motion_.at_end(end), k == 0 ? share : -share);
                one.starts[k].t = motion_.mesh.ends[end];
            }
        }
        const double by_element = std::log(widest / near_.small) / n,
                     fitting = std::log(next.wide / next.small) / by_element;
        const int most = roundings_ != nullptr ? rounded_piece : most_in_piece;
        length_ = static_cast<int>(std::clamp(fitting, 1.0, std::min(2.0 * n, 1.0 * most)));
        has_two_ = wants_two;
        near_ = next;
    }

    const Surroundings& at_;
    const Motion& motion_;
    Roundings* roundings_ = nullptr;   // that are added on the way
    double most_alone_;
    bool has_two_;
    Nearness near_;
    int length_ = first_piece;
    std::vector<Perturbed> all_;
    double largest_ = 1, stretched_ = 1, shrunk_ = 1;
    Growth grown_;
};

double largest(const Growth& grown)
{
    double largest = 0;
    for (const double g : grown.factors) raise_to(largest, g);
    return largest;
}

/// What is told of rounding by the growth of any perturbation may be far more than what rounding does.
bool is_doubtful(const Growth& grown, double told)
{
    return largest(grown) >= growth_at_horizon || spacing * largest(grown) > told;
}

/// Where a law jumps, a neighbour whose elements do not end there is pushed by all of an element; where it
/// bends and touches again and again, one whose elements do is not on the elements of the motion any more.
/// Both grow too much, not too little.
void take_smaller(Growth& grown, Growth&& other)
{
    if (!(largest(other) < largest(grown)) || other.factors.size() < grown.factors.size()) return;
    grown = std::move(other);
}

}   // namespace

Growth growth(const Model& model, const Problem& stated, const Method& method, const SolveOptions& options,
              const Motion& motion, double told)
{
    const Problem problem = with_prepared(stated);
    if (problem.conditions.at_start != Known::state || motion.n_elements() == 0) return {};
    SolveOptions quiet = options;
    quiet.condition = quiet.judge = quiet.end_at_bends = quiet.look_at_laws = false;
    quiet.meeting = std::numeric_limits<double>::infinity();   // neighbours are beside it
    quiet.initial = StartPolicy::project;
    std::optional<Ends> closed;
    if (is_nodal(method) && !model.has_events())
        closed = close_ends(model, problem, motion.start(), motion.end(), options.initial);
    const State start = motion.at_end(0);
    const double at_start = fastest_rate(model, start.V), ever = fastest_rate(model, motion.velocities);
    Surroundings at{model, method, quiet, motion, problem.prepared, closed, ever > 0 ? ever : 1};
    const auto measure = [&](const std::vector<Kicks>& kicks) {
        return Neighbours(at, options.tolerance).grown_from(kicks, at_start);
    };
    const std::vector<Kicks> kicks = kicks_everywhere(model, start, at_start);
    Growth grown = measure(kicks);
    at.has_bends = closed && !motion.mesh.bends.empty();
    if (at.has_bends && is_doubtful(grown, told)) take_smaller(grown, measure(kicks));
    if (!is_rounding_open(grown, told, options.tolerance)) return grown;
    Roundings roundings(model, motion, at.rate);
    const Growth of_rounding = Neighbours(at, options.tolerance).grown_from(roundings);
    for (std::size_t e = 0; e < grown.factors.size(); ++e)
        grown.rounding.push_back(e < of_rounding.factors.size() ? of_rounding.factors[e] : grown.factors[e]);
    grown.rounding_in = of_rounding.part;
    return grown;
}

/// What is rounded on the way may grow by more than what is rounded at the start, too.
bool spacetime_internal::is_rounding_open(const Growth& grown, double told, double tolerance)
{
    return is_doubtful(grown, told) || rounded_by(tolerance) * grown.later > told;
}

}   // namespace livens
