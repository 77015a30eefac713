// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/nodal/inside.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/diagnostics/largest.h"
#include "livens/dynamics/instant/instant.h"
#include "livens/spacetime/nodal/nodes.h"

namespace livens {

namespace {

/// The whole way is integrated with as many points more than load points, its pieces with as many.
constexpr int more_points = 4, points_of_piece = 8;
/// A law that is steeper than this many times what is seen of it may hide something.
constexpr double steeper = 4;
/// Of lengths or rad that something hidden may shift an element's end by.
constexpr double negligible = 1e-11;
constexpr std::size_t most_panels = 64;
/// Where nothing bounds its slopes a law is looked at this near to both ends.
constexpr double beside_ends[] = {1e-4, 1e-2};
/// Of what is not seen: below, it is rounding.
constexpr double rounding = 1e-15;

/// Legendre polynomials of degree 0, 1, 2 at a share.
std::array<double, 3> legendre(double s) { return {1, 2 * s - 1, 6 * s * (s - 1) + 1}; }

/// F itself, of a load of which nothing else is known: an entry is a factor. It looks at X and V of its
/// bodies and its angles.
LawInside whole(const Load& load)
{
    const std::size_t n = load.bodies.size();
    LawInside law;
    law.n_numbers = 24 * n + load.angles.size();
    law.n_factors = 24;
    law.numbers = [n](const LoadArguments& at, std::span<double> numbers) {
        for (std::size_t b = 0; b < n; ++b) {
            std::copy_n(at.X[b].a, 12, numbers.begin() + static_cast<std::ptrdiff_t>(24 * b));
            std::copy_n(at.V[b].a, 12, numbers.begin() + static_cast<std::ptrdiff_t>(24 * b + 12));
        }
        std::ranges::copy(at.angles, numbers.begin() + static_cast<std::ptrdiff_t>(24 * n));
    };
    law.factors = [n, forces = load.forces](Instant t, std::span<const double> numbers,
                                            std::span<double> factors) {
        LoadArguments at(n);
        at.at = t;
        for (std::size_t b = 0; b < n; ++b) {
            std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(24 * b), 12, at.X[b].a);
            std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(24 * b + 12), 12, at.V[b].a);
        }
        at.angles = numbers.subspan(24 * n);
        LoadForces F{};
        forces(at, F);
        for (std::size_t b = 0; b < 2; ++b)
            std::copy_n(F[b].a, 12, factors.begin() + static_cast<std::ptrdiff_t>(12 * b));
    };
    law.unit = [](const LoadArguments&, std::size_t k, LoadForces& F) { F[k / 12].a[k % 12] += 1; };
    return law;
}

}   // namespace

InsideLaws::CheckedRule::CheckedRule(int n_points) : gauss(livens::gauss(n_points))
{
    const std::size_t n = gauss.points.size(), left_out = 1 + n / 2;
    std::vector<double> nodes{0};
    nodes.insert(nodes.end(), gauss.points.begin(), gauss.points.end());
    nodes.push_back(1);
    nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(left_out));
    const LagrangeBasis basis(nodes);
    std::vector<double> weights(n + 1, 0.0), values(n + 1);
    for (std::size_t i = 0; i < n; ++i) {
        basis.values(gauss.points[i], values);
        for (std::size_t k = 0; k <= n; ++k) weights[k] += gauss.weights[i] * values[k];
    }
    weights.insert(weights.begin() + static_cast<std::ptrdiff_t>(left_out), 0.0);
    check = std::move(weights);
}

InsideLaws::InsideLaws(const Tables& tables, const ElementRule& rule)
    : tables_(tables), rule_(rule), way_(tables, rule), basis_(lobatto_basis(rule.degree + 2)),
      fine_(static_cast<int>(rule.loads.points.size()) + more_points), some_(points_of_piece)
{
    const std::vector<Load>& loads = tables.model->loads();
    for (std::size_t l = 0; l < loads.size(); ++l) {
        if (loads[l].is_smooth) continue;
        Law law{
            static_cast<int>(l), loads[l].bodies, loads[l].inside ? *loads[l].inside : whole(loads[l]), {}};
        std::erase(law.bodies, world);
        weigh(law);
        laws_.push_back(std::move(law));
    }
}

/// By the bodies alone, where they are at the start: what matters is decided with the joints, later.
void InsideLaws::weigh(Law& law) const
{
    const State start = tables_.model->start();
    std::vector<double> X, V, maps(12 * tables_.bodies.size()), q(static_cast<std::size_t>(tables_.n_twists));
    for (const Matrix34& x : start.X) X.insert(X.end(), std::begin(x.a), std::end(x.a));
    for (const Matrix34& v : start.V) V.insert(V.end(), std::begin(v.a), std::end(v.a));
    tables_.bodies.map_twists(X.data(), maps.data());
    const LoadArguments at = tables_.loads.arguments(law.load, {start.t}, X.data(), V.data(), {});
    const Load& load = tables_.model->loads()[static_cast<std::size_t>(law.load)];
    for (std::size_t k = 0; k < law.inside.n_factors; ++k) {
        LoadForces F{};
        law.inside.unit(at, k, F);
        std::vector<double> raw(X.size(), 0.0);
        for (std::size_t b = 0; b < 2; ++b)
            if (load.bodies[b] != world)
                std::copy_n(F[b].a, 12, raw.begin() + static_cast<std::ptrdiff_t>(12 * load.bodies[b]));
        tables_.bodies.twist_rows(X.data(), maps.data(), raw.data(), q.data());
        tables_.bodies.to_scaled_rows(maps.data(), q.data(), q.data());
        tables_.bodies.to_twist(maps.data(), q.data(), q.data());
        double mobility = 0;
        for (std::size_t i = 0; i < q.size(); ++i)
            mobility += std::abs(q[i]);   // m/s^2 and rad/s^2: lengths are of the order of the model's
        law.mobility.push_back(mobility * std::max(1.0, 1 / tables_.length));
    }
}

/// A law that is smooth except where its centre is near.
bool InsideLaws::is_calm(const Law& law, const Stretch& stretch, const Nodes& nodes, int e)
{
    constexpr double far = 2;
    if (!law.inside.only_at_centre) return false;
    const Load& load = tables_.model->loads()[static_cast<std::size_t>(law.load)];
    double least = 0, change = 0;
    Vector3 before{};
    for (int i = 0; i < 3; ++i) {
        way_.go(stretch, nodes, e, 0.5 * i, law.bodies);
        const Vector3 c = load.centre(tables_.loads.arguments(law.load, way_.at(), way_.X(), way_.V()));
        least = i == 0 ? norm(c) : std::min(least, norm(c));
        if (i > 0) change = std::max(change, norm(c - before));
        before = c;
    }
    return least > far * change;
}

/// The numbers of a law at the nodes of a basis, and how they may bend between them.
void InsideLaws::follow(const Law& law, const Stretch& stretch, const Nodes& nodes, int e,
                        const std::vector<double>& angles)
{
    constexpr double between = 2;   // nodes a derivative may be larger than at them
    const std::size_t n = law.inside.n_numbers, size = static_cast<std::size_t>(basis_.size());
    start_ = stretch.times[static_cast<std::size_t>(e)];
    h_ = stretch.h(e);
    numbers_.resize(n * size);
    std::vector<double> turned = angles;
    for (std::size_t A = 0; A < size; ++A) {
        way_.go(stretch, nodes, e, basis_.nodes()[A], law.bodies);
        tables_.loads.turns.follow_of(law.load, Configurations(way_.X()), turned);
        law.inside.numbers(tables_.loads.arguments(law.load, way_.at(), way_.X(), way_.V(), turned),
                           std::span(numbers_).subspan(n * A, n));
    }
    if (!law.inside.steepest) return;
    const std::vector<double>& D = basis_.differentiation();
    const auto derive = [&](const std::vector<double>& of, std::vector<double>& derivative) {
        derivative.assign(of.size(), 0.0);
        for (std::size_t A = 0; A < size; ++A)
            for (std::size_t B = 0; B < size; ++B)
                for (std::size_t k = 0; k < n; ++k) derivative[n * A + k] += D[size * A + B] * of[n * B + k];
    };
    std::vector<double> second, third;
    derive(numbers_, slopes_);
    derive(slopes_, second);
    derive(second, third);
    second_.assign(n, 0.0);
    third_.assign(n, 0.0);
    for (std::size_t i = 0; i < n * size; ++i) {
        second_[i % n] = std::max(second_[i % n], between * std::abs(second[i]));
        third_[i % n] = std::max(third_[i % n], between * std::abs(third[i]));
    }
}

void InsideLaws::factors_at(const Law& law, double share, double* factors)
{
    const std::size_t n = law.inside.n_numbers, size = static_cast<std::size_t>(basis_.size());
    work_.resize(size);
    at_.assign(n, 0.0);
    basis_.values(share, work_);
    for (std::size_t A = 0; A < size; ++A)
        for (std::size_t k = 0; k < n; ++k) at_[k] += work_[A] * numbers_[n * A + k];
    law.inside.factors({start_ + share * h_, Side::middle}, at_, {factors, law.inside.n_factors});
}

/// A number on a piece of the way: between its ends, and beyond by what it may bend.
EnclosedValue InsideLaws::range(std::size_t number, std::size_t n, const Panel& panel) const
{
    const auto size = static_cast<std::size_t>(basis_.size());
    const double width = panel.last - panel.first, eighth = 0.125 * width * width;
    EnclosedValue range{{Enclosure::infinite, -Enclosure::infinite},
                        {Enclosure::infinite, -Enclosure::infinite}};
    const auto meet = [&](const double* weights) {
        double value = 0, slope = 0;
        for (std::size_t A = 0; A < size; ++A) {
            value += weights[A] * numbers_[n * A + number];
            slope += weights[A] * slopes_[n * A + number];
        }
        range.value = hull(range.value, Enclosure::of(value));
        range.slope = hull(range.slope, Enclosure::of(slope));
    };
    meet(work_.data());
    meet(work_.data() + size);
    const double bend = eighth * second_[number], more = eighth * third_[number];
    return {{range.value.low - bend, range.value.high + bend},
            {range.slope.low - more, range.slope.high + more}};
}

/// What may be hidden between places where the law was seen: a needle as high as its steepest slope allows.
/// `seen`: shares and factors there, ascending.
double InsideLaws::steepness_doubt(const Law& law, const Panel& panel, const std::vector<double>& seen)
{
    const std::size_t n = law.inside.n_numbers, m = law.inside.n_factors,
                      size = static_cast<std::size_t>(basis_.size());
    work_.resize(2 * size);
    basis_.values(panel.first, std::span(work_).first(size));
    basis_.values(panel.last, std::span(work_).subspan(size));
    std::vector<EnclosedValue> numbers;
    for (std::size_t k = 0; k < n; ++k) numbers.push_back(range(k, n, panel));
    const double width = panel.last - panel.first;
    const Enclosure t =
        hull(Enclosure::of(start_ + panel.first * h_), Enclosure::of(start_ + panel.last * h_));
    std::vector<double> bounds(m);
    law.inside.steepest({t, Enclosure::of(h_)}, numbers, bounds);
    double doubt = 0;
    for (std::size_t k = 0; k < m; ++k) {
        double steepest = 0, widest = 0;
        for (std::size_t i = 1 + m; i < seen.size(); i += 1 + m) {
            const double step = seen[i] - seen[i - 1 - m];
            steepest = std::max(steepest, std::abs(seen[i + 1 + k] - seen[i - m + k]) / step);
            widest = std::max(widest, step);
        }
        if (bounds[k] <= steeper * steepest) continue;
        const double hidden = 0.25 * bounds[k] * widest * width * law.mobility[k] * h_ * h_;
        doubt = std::max(doubt, std::isnan(hidden) ? Enclosure::infinite : hidden);
    }
    return doubt > negligible ? doubt : 0;
}

/// What another rule, which knows the ends, makes of the same places differently: a law may be seen, and yet
/// bend so much between them that their integral is not what it seems.
double InsideLaws::quadrature_doubt(const Law& law, const CheckedRule& rule, const Panel& panel,
                                    const std::vector<double>& seen) const
{
    const std::size_t m = law.inside.n_factors, n = rule.gauss.points.size();
    const double width = panel.last - panel.first;
    double doubt = 0;
    for (std::size_t q = 0; q < n_moments; ++q)
        for (std::size_t k = 0; k < m; ++k) {
            double other = 0;
            for (std::size_t i = 0; i < n + 2; ++i)
                other += width * rule.check[i] * legendre(seen[i * (1 + m)])[q] * seen[i * (1 + m) + 1 + k];
            doubt = std::max(doubt, std::abs(other - panel.moments[q * m + k]) * law.mobility[k] * h_ * h_);
        }
    return doubt > negligible ? doubt : 0;
}

void InsideLaws::integrate(const Law& law, const CheckedRule& rule, Panel& panel)
{
    const std::size_t m = law.inside.n_factors, n = rule.gauss.points.size();
    const double width = panel.last - panel.first;
    const bool is_bounded = static_cast<bool>(law.inside.steepest);
    panel.moments.assign(n_moments * m, 0.0);
    std::vector<double> seen((n + 2) * (1 + m));
    const auto see = [&](std::size_t i, double share) {
        seen[i * (1 + m)] = share;
        factors_at(law, share, seen.data() + i * (1 + m) + 1);
    };
    if (is_bounded) see(0, panel.first);
    for (std::size_t i = 0; i < n; ++i) {
        const double s = panel.first + width * rule.gauss.points[i];
        see(i + 1, s);
        const std::array<double, n_moments> P = legendre(s);
        for (std::size_t q = 0; q < n_moments; ++q)
            for (std::size_t k = 0; k < m; ++k)
                panel.moments[q * m + k] +=
                    width * rule.gauss.weights[i] * P[q] * seen[(i + 1) * (1 + m) + 1 + k];
    }
    if (!is_bounded) return;
    see(n + 1, panel.last);
    panel.doubt = std::max(steepness_doubt(law, panel, seen), quadrature_doubt(law, rule, panel, seen));
}

/// Panels are halved, the most doubtful first.
void InsideLaws::divide(const Law& law, std::vector<Panel>& panels)
{
    constexpr double narrowest = 1e-13;
    while (panels.size() < most_panels) {
        const auto worst = std::ranges::max_element(panels, {}, &Panel::doubt);
        if (!(worst->doubt > 0)) return;
        const double middle = worst->first + 0.5 * (worst->last - worst->first);
        if (worst->last - worst->first < narrowest) {
            worst->doubt = 0;
            continue;
        }
        Panel left{worst->first, middle, 0, {}}, right{middle, worst->last, 0, {}};
        integrate(law, some_, left);
        integrate(law, some_, right);
        *worst = std::move(left);
        panels.push_back(std::move(right));
    }
}

/// The moments of all factors less what the load points have of them.
std::vector<double> InsideLaws::unseen(const Law& law)
{
    const std::size_t m = law.inside.n_factors;
    std::vector<Panel> panels;
    if (law.inside.steepest) {
        panels.resize(1);
        integrate(law, fine_, panels[0]);
        divide(law, panels);
    } else {
        static const CheckedRule few(2);
        const double ends[] = {0, beside_ends[0], beside_ends[1], 1 - beside_ends[1], 1 - beside_ends[0], 1};
        for (std::size_t i = 0; i + 1 < std::size(ends); ++i) {
            panels.push_back({ends[i], ends[i + 1], 0, {}});
            integrate(law, i == 2 ? fine_ : few, panels.back());
        }
    }
    std::vector<double> moments(n_moments * m, 0.0), factors(m), size(m, 0.0);
    for (const Panel& panel : panels)
        for (std::size_t i = 0; i < moments.size(); ++i) moments[i] += panel.moments[i];
    for (std::size_t c = 0; c < rule_.loads.points.size(); ++c) {
        factors_at(law, rule_.loads.points[c], factors.data());
        const std::array<double, n_moments> P = legendre(rule_.loads.points[c]);
        for (std::size_t i = 0; i < moments.size(); ++i)
            moments[i] -= rule_.loads.weights[c] * P[i / m] * factors[i % m];
        for (std::size_t k = 0; k < m; ++k) size[k] = std::max(size[k], std::abs(factors[k]));
    }
    for (std::size_t i = 0; i < moments.size(); ++i)
        if (std::abs(moments[i]) <= 1e-14 * size[i % m]) moments[i] = 0;
    return moments;
}

Unseen InsideLaws::look(const Stretch& stretch, const Nodes& nodes, int e, const std::vector<double>& angles,
                        InstantSystem& instant, InstantState& end)
{
    Unseen found;
    std::vector<double> raw[n_moments];
    double largest = 0;
    std::vector<double> V(end.X.size());
    for (const Law& law : laws_) {
        if (is_calm(law, stretch, nodes, e)) continue;
        follow(law, stretch, nodes, e, angles);
        const std::vector<double> moments = unseen(law);
        const std::size_t m = law.inside.n_factors;
        double own = 0;
        for (std::size_t i = 0; i < moments.size(); ++i)
            own = std::max(own, std::abs(moments[i]) * law.mobility[i % m] * h_ * h_);
        if (own <= rounding) continue;
        if (raise_to(largest, own)) found.load = law.load;
        tables_.bodies.rates_of(end.X.data(), end.velocity.data(), V.data());
        const auto at = tables_.loads.arguments(law.load, {end.t}, end.X.data(), V.data(), end.angles);
        const Load& load = tables_.model->loads()[static_cast<std::size_t>(law.load)];
        for (std::size_t k = 0; k < m; ++k) {
            LoadForces F{};
            law.inside.unit(at, k, F);
            for (std::size_t q = 0; q < n_moments; ++q) {
                raw[q].resize(end.X.size(), 0.0);
                for (std::size_t b = 0; b < 2; ++b)
                    for (int i = 0; i < 12 && load.bodies[b] != world; ++i)
                        raw[q][12 * static_cast<std::size_t>(load.bodies[b]) + static_cast<std::size_t>(i)] +=
                            moments[q * m + k] * F[b].a[i];
            }
        }
    }
    if (found.load < 0) return found;
    found.t = end.t;
    found.duration = std::abs(stretch.h(e));
    found.shift.assign(tables_.bodies.size(), 0.0);
    found.turn = found.shift;
    std::vector<double> twist(end.velocity.size());
    for (std::size_t q = 0; q < n_moments; ++q) {
        instant.respond(end, raw[q].data(), twist.data());
        tables_.bodies.rates_of(end.X.data(), twist.data(), V.data());
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            const auto& body = tables_.bodies[static_cast<std::size_t>(b)];
            const double* dX = V.data() + 12 * b;
            Vector3 centre{};
            double turn = 0;
            for (int i = 0; i < 3; ++i)
                centre[i] = dX[i] + body.center[0] * dX[3 + i] + body.center[1] * dX[6 + i] +
                            body.center[2] * dX[9 + i];
            for (int i = 3; i < 12 && body.dofs == 6; ++i) turn += dX[i] * dX[i];
            const double shift = norm(centre) / tables_.length;
            turn = std::sqrt(0.5 * turn);
            raise_to(found.shift[static_cast<std::size_t>(b)], found.duration * shift);
            raise_to(found.turn[static_cast<std::size_t>(b)], found.duration * turn);
            raise_to(found.error, 0.5 * found.duration * found.duration * std::max(shift, turn));
        }
    }
    return found;
}

}   // namespace livens
