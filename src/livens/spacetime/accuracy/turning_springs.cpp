// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/accuracy/turning_springs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "livens/base/text.h"
#include "livens/diagnostics/acceptance_bounds.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/statics/turning_vibrations.h"

namespace livens::inline spacetime_internal {

namespace {

/// An element; what grows more slowly would need thousands.
constexpr double slowest_growth = 1e-3;
/// Of what moves: energy that nobody supplied and that is worth a question.
constexpr double noticeable = 1e-5;
/// Energy grows as the square of a vibration. By the time in which that grows by e it is seven times as much,
/// if all of it is the vibration's; what was there by another reason may be as much as that.
constexpr double share_before = 0.4;
/// Of the longest element that is steady, in advice.
constexpr double safe_share = 0.9;
/// Element ends between two questions that were answered by no, as a share of those before.
constexpr double patience = 0.25;
constexpr double least_growth = 3;     // powers of e until the end
constexpr double largest_turn = 1.5;   // rad in an element that may be right about what turns
/// Of the longest element's length, before an instant: elements there tell how long they were before some
/// were divided.
constexpr double looked_back = 16;

/// The product of h omega and the turn in an element beyond which vibrations grow.
double bound_of_product(int degree) { return std::sqrt(8.0 * degree * (degree + 1) * (2 * degree - 1)); }

struct GrowingTurn {
    TurningVibration vibration;
    double growth = 0;                                          // an element
    double longest = std::numeric_limits<double>::infinity();   // element without growth, of all vibrations
};

/// The rate (rad/s) of a vibration that might grow in elements of this length.
double slowest_that_grows(double h, int degree) { return bound_of_product(degree) / (largest_turn * h); }

GrowingTurn fastest_growing(const Model& model, const Motion& motion, int end, double h, int degree)
{
    GrowingTurn found;
    const std::vector<TurningVibration> vibrations =
        turning_vibrations(model, motion.at_end(end), slowest_that_grows(h, degree));
    for (const TurningVibration& one : vibrations) {
        const double growth = growth_of_turning(degree, h * one.spring.rate, h * one.turn);
        if (!(growth > 0)) continue;
        found.longest = std::min(found.longest, longest_element(degree, one.spring.rate, one.turn));
        if (growth > found.growth) std::tie(found.vibration, found.growth) = std::tie(one, growth);
    }
    return found;
}

/// Of the longest of the last elements before an end.
double length_before(const TimeMesh& mesh, int end)
{
    double longest = 0, there = 0;
    for (int e = 0; e < end; ++e) longest = std::max(longest, mesh.length(e));
    for (int e = end - 1; e >= 0 && mesh.ends[e + 1] > mesh.ends[end] - looked_back * longest; --e)
        there = std::max(there, mesh.length(e));
    return there;
}

/// Energy that nobody supplied.
class Surplus {
public:
    Surplus(const Model& model, const Motion& motion) : balance_(balance(model, motion))
    {
        for (std::size_t e = 0; e < balance_.t.size(); ++e)
            moving_.push_back(std::max({e > 0 ? moving_.back() : 0, balance_.kinetic[e],
                                        std::abs(balance_.potential[e] - balance_.potential[0])}));
    }

    bool is_noticeable(int end) const { return at(end) > noticeable * moving_[end]; }
    /// Up to an end, as a vibration does that grows by e in this time, and so that it matters by `until`.
    bool grows(int end, double time, double until) const
    {
        const double t = balance_.t[end], now = at(end), before = at_time(t - time);
        const double left = std::exp(std::min(2 * (until - t) / time, 100.0));
        return t - time > balance_.t[0] && before < share_before * now &&
               at_time(t - 2 * time) <= share_before * before && now * left > acceptable_drift * moving_[end];
    }

private:
    double at(int end) const { return balance_.energy[end] - balance_.energy[0] - balance_.work[end]; }
    /// At the last element end up to t, or at the start.
    double at_time(double t) const
    {
        const auto behind = std::upper_bound(balance_.t.begin() + 1, balance_.t.end(), t);
        return std::abs(at(static_cast<int>(behind - balance_.t.begin()) - 1));
    }

    Balance balance_;
    std::vector<double> moving_;   // the most up to each end
};

std::string in_words(const Model& model, const GrowingTurn& found, double h, int degree,
                     const std::string& so)
{
    const TurningVibration& one = found.vibration;
    return one.spring.where(model) + " vibrates at " + to_text(one.spring.rate, 3) + " rad/s and turns by " +
           to_text(h * one.turn, 3) + " rad in an element of " + to_text(h, 3) +
           " s; such vibrations grow, by " + to_text(100 * found.growth, 2) +
           " percent an element, where that turn times h omega, " + to_text(h * one.spring.rate, 3) +
           ", exceeds " + to_text(bound_of_product(degree), 3) + so +
           "; try: the family radau, elements shorter than " + to_text(safe_share * found.longest, 2) +
           " s, or an accuracy instead of elements";
}

}   // namespace

double growth_of_turning(int degree, double phase, double turn)
{
    const double p = degree, most = turn * std::sqrt(p * (p + 1) / (2 * (2 * p - 1))),
                 lag = 2 * p * (p + 1) / phase;
    return most > lag ? std::sqrt(most * most - lag * lag) : 0;
}

double longest_element(int degree, double rate, double turn_rate)
{
    return std::sqrt(bound_of_product(degree) / (rate * turn_rate));
}

std::string of_turning_springs(const Model& model, const Motion& motion, int degree, int first_end,
                               double until)
{
    const int n = motion.n_elements();
    if (n < 1) return "";
    const Surplus surplus(model, motion);
    for (int end = std::max(1, first_end); end <= n; ++end) {
        if (!surplus.is_noticeable(end)) continue;
        const double h = length_before(motion.mesh, end);
        const GrowingTurn found = fastest_growing(model, motion, end, h, degree);
        if (found.growth > slowest_growth && surplus.grows(end, h / found.growth, until))
            return in_words(model, found, h, degree,
                            ", and energy grows so by t = " + to_text(motion.mesh.ends[end], 6) + " s");
        end += static_cast<int>(patience * end);
    }
    return "";
}

std::string of_unsteady_springs(const Model& model, const Motion& motion, int degree)
{
    if (motion.n_elements() < 1) return "";
    const double h = length_before(motion.mesh, 1);
    const GrowingTurn found = fastest_growing(model, motion, 0, h, degree);
    const double time = motion.end() - motion.start();
    if (!(found.growth * time > least_growth * h)) return "";
    return in_words(model, found, h, degree, "");
}

bool EnergyWatch::serves(const Model& model)
{
    return std::ranges::any_of(model.loads(), [](const Load& load) { return load.depends_on_X; });
}

std::string EnergyWatch::look(const Motion& so_far, double until)
{
    const int n = so_far.n_elements();
    const auto measure = [&](int end) {
        const State state = so_far.at_end(end);
        const double kinetic = kinetic_energy(model_, state.X, state.V),
                     potential =
                         potential_energy(model_, {state.t, Side::left}, state.X, state.V, state.angles);
        if (!is_started_) last_ = kinetic + (potential_ = potential);
        is_started_ = true;
        moving_ = std::max({moving_, kinetic, std::abs(potential - potential_)});
        return kinetic + potential;
    };
    if (!is_started_) measure(0);
    const double energy = measure(n);
    if (n < next_ || !(std::abs(energy - last_) > noticeable * moving_)) return "";
    last_ = energy;
    next_ = n + static_cast<int>(std::ceil(patience * n));
    // what could grow costs less than the balance of all elements so far, and the bound less than that
    const double h = length_before(so_far.mesh, n);
    if (!bounds_) bounds_ = std::make_shared<RateBounds>(model_);
    if (bounds_->springs(so_far.at_end(n)) < slowest_that_grows(h, degree_)) return "";
    if (!(fastest_growing(model_, so_far, n, h, degree_).growth > slowest_growth)) return "";
    return of_turning_springs(model_, so_far, degree_, n, until);
}

}   // namespace livens::inline spacetime_internal
