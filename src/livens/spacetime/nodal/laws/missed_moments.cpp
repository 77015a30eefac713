// SPDX-License-Identifier: BSD-3-Clause
// D_kn = int_0^1 P_n f_k ds - sum_c w_c P_n(s_c) f_k(s_c) of a law along a solved element (docs/theory.md,
// "Looks at laws"). The interval is divided until the integral is verified: enclosed slopes bound the
// integral of a needle between two samples, and a second rule on the same samples bounds the quadrature
// error.
#include "livens/spacetime/nodal/laws/missed_moments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "livens/spacetime/nodal/laws/law_on_path.h"
#include "livens/spacetime/nodal/laws/looks_in_lanes.h"

namespace livens {

namespace {

constexpr std::size_t n_moments = MissedMoments::n_moments;
/// The whole way is integrated with as many points more than load points, its pieces with as many.
constexpr int more_points = 4, points_of_piece = 8;
/// A law with slopes above this many times the steepest chord between samples may hide a needle.
constexpr double steeper = 4;
/// Of lengths or rad that something hidden may shift an element's end by.
constexpr double negligible = 1e-11;
constexpr std::size_t most_panels = 64;
/// Where nothing bounds its slopes a law is looked at this near to both ends.
constexpr double beside_moments[] = {1e-4, 1e-2};

/// Legendre polynomials of degree 0, 1, 2 at a share.
std::array<double, n_moments> legendre(double s) { return {1, 2 * s - 1, 6 * s * (s - 1) + 1}; }

/// A piece of the way, and integrals over it: of factor k with the polynomial n at [n * n_factors + k].
struct Panel {
    double first = 0, last = 1;
    double doubt = 0;   // bound of the error that may be hidden in it, lengths or rad
    std::vector<double> moments;
};

/// The error by a needle between two samples, as high as the steepest slope allows.
/// `seen`: shares and factors there, ascending.
double steepness_doubt(LawOnPath& path, const Panel& panel, const std::vector<double>& seen)
{
    const std::size_t m = path.n_factors();
    const double width = panel.last - panel.first, h = path.h();
    std::vector<double> bounds(m);
    path.bound_slopes(panel.first, panel.last, bounds);
    double doubt = 0;
    for (std::size_t k = 0; k < m; ++k) {
        double steepest = 0, widest = 0;
        for (std::size_t i = 1 + m; i < seen.size(); i += 1 + m) {
            const double step = seen[i] - seen[i - 1 - m];
            steepest = std::max(steepest, std::abs(seen[i + 1 + k] - seen[i - m + k]) / step);
            widest = std::max(widest, step);
        }
        if (bounds[k] <= steeper * steepest) continue;
        // triangles of that slope in all gaps: the sum of gap^2 / 4 is at most widest * width / 4
        const double hidden = 0.25 * bounds[k] * widest * width * path.law().mobility[k] * h * h;
        doubt = std::max(doubt, std::isnan(hidden) ? Enclosure::infinite : hidden);
    }
    return doubt > negligible ? doubt : 0;
}

/// The difference of a second rule, which uses the ends as well: a law may be sampled everywhere, and yet
/// bend so much between samples that their integral is wrong.
double quadrature_doubt(const LawOnPath& path, const CheckedRule& rule, const Panel& panel,
                        const std::vector<double>& seen)
{
    const std::size_t m = path.n_factors(), n = rule.gauss.points.size();
    const double width = panel.last - panel.first, h = path.h();
    double doubt = 0;
    for (std::size_t q = 0; q < n_moments; ++q)
        for (std::size_t k = 0; k < m; ++k) {
            double other = 0;
            for (std::size_t i = 0; i < n + 2; ++i)
                other += width * rule.check[i] * legendre(seen[i * (1 + m)])[q] * seen[i * (1 + m) + 1 + k];
            doubt =
                std::max(doubt, std::abs(other - panel.moments[q * m + k]) * path.law().mobility[k] * h * h);
        }
    return doubt > negligible ? doubt : 0;
}

/// `looks`: those at the points of the rule were taken; null: they were not.
void integrate(LawOnPath& path, const CheckedRule& rule, Panel& panel, const LooksInLanes* looks = nullptr)
{
    const std::size_t m = path.n_factors(), n = rule.gauss.points.size();
    const double width = panel.last - panel.first;
    const bool is_bounded = static_cast<bool>(path.law().inside.steepest);
    panel.moments.assign(n_moments * m, 0.0);
    std::vector<double> seen((n + 2) * (1 + m));
    const auto see = [&](std::size_t i, double share) {
        seen[i * (1 + m)] = share;
        double* factors = seen.data() + i * (1 + m) + 1;
        if (looks != nullptr)
            looks->factors(path.law().load, i, factors);
        else
            path.factors_at(share, factors);
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
    panel.doubt = std::max(steepness_doubt(path, panel, seen), quadrature_doubt(path, rule, panel, seen));
}

/// Panels are halved, the most doubtful first.
void divide(LawOnPath& path, const CheckedRule& rule, std::vector<Panel>& panels)
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
        integrate(path, rule, left);
        integrate(path, rule, right);
        *worst = std::move(left);
        panels.push_back(std::move(right));
    }
}

/// The second rule has both ends and the Gauss points without the middle one, with weights that integrate the
/// polynomial through them: Gauss points do that exactly. The one left out has the weight 0.
CheckedRule made_rule(int n_points)
{
    CheckedRule rule{gauss(n_points), {}};
    const std::size_t n = rule.gauss.points.size(), left_out = 1 + n / 2;
    std::vector<double> nodes{0};
    nodes.insert(nodes.end(), rule.gauss.points.begin(), rule.gauss.points.end());
    nodes.push_back(1);
    nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(left_out));
    const LagrangeBasis basis(nodes);
    std::vector<double> values(n + 1);
    rule.check.assign(n + 1, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        basis.values(rule.gauss.points[i], values);
        for (std::size_t k = 0; k <= n; ++k) rule.check[k] += rule.gauss.weights[i] * values[k];
    }
    rule.check.insert(rule.check.begin() + static_cast<std::ptrdiff_t>(left_out), 0.0);
    return rule;
}

/// Made once, as element_rule() is, where a law is not calm.
const CheckedRule& checked_rule(int n_points)
{
    static std::mutex in_use;
    static auto& known = *new std::map<int, CheckedRule>;
    const std::scoped_lock lock(in_use);
    const auto [place, is_new] = known.try_emplace(n_points);
    if (is_new || place->second.check.empty()) place->second = made_rule(n_points);
    return place->second;
}

}   // namespace

MissedMoments::MissedMoments(const ElementRule& rule)
    : rule_(rule), n_fine_(static_cast<int>(rule.loads.points.size()) + more_points)
{}

std::vector<double> MissedMoments::shares() const
{
    std::vector<double> shares = gauss(n_fine_).points;
    shares.insert(shares.begin(), 0);
    shares.push_back(1);
    return shares;
}

std::vector<double> MissedMoments::of(LawOnPath& path, const LooksInLanes* looks) const
{
    const std::size_t m = path.n_factors();
    const CheckedRule& fine = checked_rule(n_fine_);
    std::vector<Panel> panels;
    if (path.law().inside.steepest) {
        panels.resize(1);
        integrate(path, fine, panels[0], looks);
        if (panels[0].doubt > 0) looks = nullptr;   // pieces are by the numbers between its looks
        divide(path, checked_rule(points_of_piece), panels);
    } else {
        const double ends[] = {
            0, beside_moments[0], beside_moments[1], 1 - beside_moments[1], 1 - beside_moments[0], 1};
        for (std::size_t i = 0; i + 1 < std::size(ends); ++i) {
            panels.push_back({ends[i], ends[i + 1], 0, {}});
            integrate(path, i == 2 ? fine : checked_rule(2), panels.back());
        }
    }
    std::vector<double> moments(n_moments * m, 0.0), factors(m), size(m, 0.0);
    for (const Panel& panel : panels)
        for (std::size_t i = 0; i < moments.size(); ++i) moments[i] += panel.moments[i];
    for (std::size_t c = 0; c < rule_.loads.points.size(); ++c) {
        if (looks != nullptr)
            looks->factors_at_load_point(path.law().load, c, factors.data());
        else
            path.factors_at(rule_.loads.points[c], factors.data());
        const std::array<double, n_moments> P = legendre(rule_.loads.points[c]);
        for (std::size_t i = 0; i < moments.size(); ++i)
            moments[i] -= rule_.loads.weights[c] * P[i / m] * factors[i % m];
        for (std::size_t k = 0; k < m; ++k) size[k] = std::max(size[k], std::abs(factors[k]));
    }
    for (std::size_t i = 0; i < moments.size(); ++i)
        // differences of equal integrals: rounding
        if (std::abs(moments[i]) <= 1e-14 * size[i % m]) moments[i] = 0;
    return moments;
}

}   // namespace livens
