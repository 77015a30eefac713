// SPDX-License-Identifier: BSD-3-Clause
// Extremes are bracketed on the polynomials, element by element, and refined in the best states that there
// are: docs/theory.md, "Extremes".
#include "livens/diagnostics/extremes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "livens/solvers/patience.h"

namespace livens {

double QuantitySeries::of(std::span<const double> numbers) const
{
    const std::span<const double> mine = numbers.subspan(static_cast<std::size_t>(quantity.first));
    if (component >= 0) return mine[static_cast<std::size_t>(component)];
    if (quantity.size == 1) return mine[0];
    return norm(Vector3{mine[0], mine[1], mine[2]});
}

namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// A place that is above its neighbours, in an element; an element's end has one neighbour.
struct Place {
    double from, at, until;
    double value;
    double rise;   ///< how much higher it may be beside, by the parabola through the three, twice
};

/// f is to become large; where it is to become small its sign is turned.
struct Hunt {
    double sign;
    std::vector<Place> places{};

    void look_at(std::span<const double> t, std::span<const double> f);
    /// The same of an element so short that its polynomials are rounding: its ends alone, which are known.
    void look_at_ends(std::span<const double> t, std::span<const double> f);
};

constexpr double equal_values = 1e-9;     // relative
constexpr double alike = 1e-4;            // that polynomials do not tell apart, relative
constexpr std::size_t most_places = 24;   // that are kept of a series

void Hunt::look_at(std::span<const double> t, std::span<const double> f)
{
    const std::size_t last = f.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
        const double here = sign * f[i], before = i > 0 ? sign * f[i - 1] : here,
                     after = i < last ? sign * f[i + 1] : here;
        if (!(here >= before && here >= after)) continue;
        const double rise =
            i > 0 && i < last ? std::max(here - before, here - after) : std::abs(2 * here - before - after);
        places.push_back({t[i > 0 ? i - 1 : 0], t[i], t[i < last ? i + 1 : last], here, rise});
    }
    if (places.size() < 4 * most_places) return;
    // Of many that are equal the first stay.
    std::ranges::stable_sort(places, [](const Place& a, const Place& b) { return a.value > b.value; });
    places.resize(most_places);
}

void Hunt::look_at_ends(std::span<const double> t, std::span<const double> f)
{
    for (std::size_t i = 0; i < f.size(); ++i) places.push_back({t[i], t[i], t[i], sign * f[i], 0});
}

/// How close an instant is to be found between two others.
double tolerance_between(double a, double b)
{
    return std::max(1e-7 * (b - a),
                    4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(a), std::abs(b)));
}

/// Brent's minimisation of -f between two instants, from one between [Brent1973, chapter 5].
template <class Function>
Extreme highest(const Function& f, double a, double x, double fx, double b, double tolerance)
{
    constexpr double golden = 0.381966011250105;
    double w = x, fw = fx, v = x, fv = fx, step = 0, before = 0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (a + b);
        if (std::abs(x - middle) <= 2 * tolerance - 0.5 * (b - a)) break;
        bool is_parabola = false;
        if (std::abs(before) > tolerance) {
            const double r = (x - w) * (fx - fv);
            double q = (x - v) * (fx - fw), p = (x - v) * q - (x - w) * r;
            q = 2 * (q - r);
            if (q > 0) p = -p;
            q = std::abs(q);
            const double last = before;
            before = step;
            is_parabola = std::abs(p) < std::abs(0.5 * q * last) && p > q * (a - x) && p < q * (b - x);
            if (is_parabola) step = p / q;
        }
        if (!is_parabola) {
            before = x < middle ? b - x : a - x;
            step = golden * before;
        }
        const double u = std::abs(step) >= tolerance ? x + step : x + (step > 0 ? tolerance : -tolerance);
        if (u <= a || u >= b) break;
        const double fu = f(u);
        if (fu >= fx) {
            (u < x ? b : a) = x;
            v = w, fv = fw, w = x, fw = fx, x = u, fx = fu;
        } else {
            (u < x ? a : b) = u;
            if (fu >= fw || w == x)
                v = w, fv = fw, w = u, fw = fu;
            else if (fu >= fv || v == x || v == w)
                v = u, fv = fu;
        }
    }
    return {fx, x};
}

/// The numbers of a series at single instants.
class Looker {
public:
    Looker(const Quantities& quantities, const Motion& motion, const BetterState& better)
        : quantities_(quantities), motion_(motion), better_(better),
          numbers_(static_cast<std::size_t>(quantities.n_numbers()))
    {}

    bool has_better() const { return static_cast<bool>(better_); }
    /// In the best state there is. Where it cannot be had, of the polynomials.
    double operator()(const QuantitySeries& series, double t)
    {
        Patience::ask();
        const std::optional<BetterSample> sample = better_ ? better_(t) : std::nullopt;
        if (!sample) return on_polynomials(series, t);
        quantities_.at(sample->state, Side::right, {&series.quantity, 1}, numbers_, sample->joints);
        return series.of(numbers_);
    }
    double on_polynomials(const QuantitySeries& series, double t)
    {
        quantities_.at(sample_state(motion_, t), Side::right, {&series.quantity, 1}, numbers_);
        return series.of(numbers_);
    }

private:
    const Quantities& quantities_;
    const Motion& motion_;
    const BetterState& better_;
    std::vector<double> numbers_;
};

/// What is known of a place once it was looked at.
struct Refined {
    Extreme extreme;
    double gap;   ///< between the polynomials and what is better, at the place itself
};

/// The highest value of f about a place, `there` at the place itself, or where the way from an end begins.
template <class Function>
Extreme highest_about(const Function& f, const Place& place, double there)
{
    const double tolerance = tolerance_between(place.from, place.until);
    return highest(f, place.from, place.at, there, place.until, tolerance);
}

/// At an end, which is known best of all: the way from there leads up only if it begins so.
template <class Function>
Extreme highest_at_end(const Function& f, const Place& place)
{
    const Extreme end{place.value, place.at};
    const double way = place.until - place.from, inwards = place.at == place.from ? 0.02 : -0.02;
    Place near = place;
    near.at += inwards * way;
    const double beside = f(near.at);
    if (!(beside > end.value)) return end;
    const Extreme found = highest_about(f, near, beside);
    return found.value > end.value + equal_values * std::abs(end.value) ? found : end;
}

bool is_at_end(const Place& place) { return place.at == place.from || place.at == place.until; }

/// On the polynomials, which cost little: where the best states are to be asked for.
void polish(Looker& look, const QuantitySeries& series, double sign, Place& place)
{
    const auto f = [&](double t) { return sign * look.on_polynomials(series, t); };
    const Extreme found = is_at_end(place) ? highest_at_end(f, place) : highest_about(f, place, place.value);
    place.value = found.value;
    place.at = found.t;
}

/// In the best states, from what polynomials tell: their extremes stand close to it.
Refined refine(Looker& look, const QuantitySeries& series, double sign, const Place& place)
{
    if (!look.has_better()) return {{place.value, place.at}, 0};
    const auto f = [&](double t) { return sign * look(series, t); };
    if (is_at_end(place)) return {highest_at_end(f, place), 0};
    const double there = f(place.at), reach = 0.05 * (place.until - place.from),
                 tolerance = tolerance_between(place.from, place.until);
    const double a = std::max(place.from, place.at - reach), b = std::min(place.until, place.at + reach);
    Extreme found = highest(f, a, place.at, there, b, tolerance);
    if (found.t - a < 4 * tolerance || b - found.t < 4 * tolerance) found = highest_about(f, place, there);
    return {found, std::abs(there - place.value)};
}

Extreme extreme_of(Looker& look, const QuantitySeries& series, Hunt& hunt, bool is_constant)
{
    if (hunt.places.empty()) return {no_value, no_value};
    const auto by_value = [](const Place& a, const Place& b) { return a.value > b.value; };
    std::ranges::stable_sort(hunt.places, by_value);
    if (is_constant) return {hunt.sign * hunt.places[0].value, hunt.places[0].at};
    if (hunt.places.size() > most_places) hunt.places.resize(most_places);
    const double highest_sample = hunt.places[0].value;
    std::erase_if(hunt.places, [&](const Place& one) { return one.value + one.rise < highest_sample; });
    for (Place& place : hunt.places) polish(look, series, hunt.sign, place);
    std::ranges::stable_sort(hunt.places, by_value);
    const Refined first = refine(look, series, hunt.sign, hunt.places[0]);
    Extreme best = first.extreme;
    double gap = first.gap;
    for (const Place& place : std::span(hunt.places).subspan(1)) {
        if (place.value + 2 * gap + alike * std::abs(best.value) < best.value) break;
        const Refined refined = refine(look, series, hunt.sign, place);
        gap = std::max(gap, refined.gap);
        const Extreme& found = refined.extreme;
        const double equal = equal_values * std::abs(best.value);
        const bool is_earlier = found.t < best.t && found.value > best.value - equal;
        if (found.value > best.value + equal || is_earlier) best = found;
    }
    return {hunt.sign * best.value, best.t};
}

/// Places of an element where it is looked at: close together near its ends, which are among them.
std::vector<double> places_of_element(const Motion& motion)
{
    const int n = std::max(2 * motion.X.degree + 4, 8);
    std::vector<double> s;
    for (int i = 0; i <= n; ++i) s.push_back(0.5 * (1 - std::cos(std::numbers::pi * i / n)));
    s.front() = 0;
    s.back() = 1;
    return s;
}

/// Looks along the motion; lost[i]: where a series is no number; sizes[i]: of the whole
/// vector that it is a component of.
class Survey {
public:
    Survey(const Quantities& quantities, const Motion& motion, std::span<const QuantitySeries> series)
        : quantities_(quantities), motion_(motion), series_(series), lost(series.size(), no_value),
          sizes(series.size(), 0.0)
    {
        for (const QuantitySeries& one : series) wanted_.push_back(one.quantity);
        for (std::size_t i = 0; i < series.size(); ++i) {
            least.push_back({-1});
            largest.push_back({1});
        }
    }

    void go()
    {
        const std::vector<double> inside = places_of_element(motion_), ends{0, 1};
        // Of elements beside a jump: what accelerates there is a difference of places over h^2.
        const double shortest = 1e-6 * (motion_.end() - motion_.start());
        std::vector<std::vector<double>> values(series_.size());
        const int n = std::max(motion_.n_elements(), 1);
        for (int e = 0; e < n; ++e) {
            Patience::ask();
            std::vector<double> t;
            for (std::vector<double>& one : values) one.clear();
            const bool is_short = motion_.n_elements() > 0 && instant(e, 1) - instant(e, 0) < shortest;
            for (const double place : is_short ? ends : inside) {
                t.push_back(instant(e, place));
                look(t.back(), place == 1 ? Side::left : Side::right, values);
                if (motion_.n_elements() == 0) break;   // a motion that has only its start
            }
            for (std::size_t i = 0; i < values.size(); ++i) {
                for (Hunt* hunt : {&least[i], &largest[i]})
                    is_short ? hunt->look_at_ends(t, values[i]) : hunt->look_at(t, values[i]);
            }
        }
    }

private:
    double instant(int element, double s) const
    {
        const std::vector<double>& ends = motion_.mesh.ends;
        const auto e = static_cast<std::size_t>(element);
        if (s == 0) return ends[e];
        return s == 1 ? ends[e + 1] : ends[e] + s * (ends[e + 1] - ends[e]);
    }
    void look(double t, Side side, std::vector<std::vector<double>>& values)
    {
        numbers_.resize(static_cast<std::size_t>(quantities_.n_numbers()));
        quantities_.at(sample_state(motion_, t), side, wanted_, numbers_);
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i].push_back(series_[i].of(numbers_));
            if (std::isnan(values[i].back()) && std::isnan(lost[i])) lost[i] = t;
            const NamedQuantity& q = series_[i].quantity;
            for (int k = 0; k < q.size; ++k)
                sizes[i] = std::max(sizes[i], std::abs(numbers_[static_cast<std::size_t>(q.first + k)]));
        }
    }

    const Quantities& quantities_;
    const Motion& motion_;
    std::span<const QuantitySeries> series_;
    std::vector<NamedQuantity> wanted_;
    std::vector<double> numbers_;

public:
    std::vector<Hunt> least, largest;
    std::vector<double> lost, sizes;

    /// Beside rounding.
    bool is_constant(std::size_t i) const
    {
        const auto top = [](const Hunt& hunt) {
            double value = -std::numeric_limits<double>::infinity();
            for (const Place& place : hunt.places) value = std::max(value, place.value);
            return value;
        };
        return top(largest[i]) + top(least[i]) <= 1e-11 * sizes[i];
    }
};

}   // namespace

std::vector<Extremes> find_extremes(const Quantities& quantities, const Motion& motion,
                                    std::span<const QuantitySeries> series, const BetterState& better)
{
    Survey survey(quantities, motion, series);
    survey.go();
    Looker look(quantities, motion, better);
    std::vector<Extremes> all;
    for (std::size_t i = 0; i < series.size(); ++i) {
        const Extreme none{no_value, no_value};
        Extremes found{series[i].name(), series[i].quantity.unit, none, none, survey.lost[i]};
        if (std::isnan(found.lost_at)) {
            const bool is_constant = survey.is_constant(i);
            found.least = extreme_of(look, series[i], survey.least[i], is_constant);
            found.largest = extreme_of(look, series[i], survey.largest[i], is_constant);
        }
        all.push_back(std::move(found));
    }
    return all;
}

}   // namespace livens
