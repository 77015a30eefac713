// SPDX-License-Identifier: BSD-3-Clause
// Laws as sums of factors f_k(t, q) times units F_k. Along an element q(s) is interpolated at p + 3
// Gauss-Lobatto points, its slope follows by their differentiation matrix, and interval enclosures of both
// between two shares are chords, widened by an eighth of the width squared times the second derivative
// (docs/theory.md, "Looks at laws", Enclosures).
#include "livens/spacetime/nodal/laws/law_on_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/model.h"
#include "livens/spacetime/nodal/laws/looks_in_lanes.h"

namespace livens::inline spacetime_internal {

namespace {

/// F itself, of a load of which nothing else is known: an entry is a factor. It looks at X and V of its
/// bodies and its angles.
LawInside whole(const Load& load)
{
    const std::size_t n = load.bodies.size(), n_acted = load.n_acted;
    LawInside law;
    law.n_numbers = 24 * n + load.angles.size();
    law.n_factors = 12 * n_acted;
    law.numbers = [n](const LoadArguments& at, std::span<double> numbers) {
        for (std::size_t b = 0; b < n; ++b) {
            std::copy_n(at.X[b].a, 12, numbers.begin() + static_cast<std::ptrdiff_t>(24 * b));
            std::copy_n(at.V[b].a, 12, numbers.begin() + static_cast<std::ptrdiff_t>(24 * b + 12));
        }
        std::ranges::copy(at.angles, numbers.begin() + static_cast<std::ptrdiff_t>(24 * n));
    };
    law.factors = [n, n_acted, forces = load.forces](Instant t, std::span<const double> numbers,
                                                     std::span<double> factors) {
        LoadArguments at(n);
        at.at = t;
        for (std::size_t b = 0; b < n; ++b) {
            std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(24 * b), 12, at.X[b].a);
            std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(24 * b + 12), 12, at.V[b].a);
        }
        at.angles = numbers.subspan(24 * n);
        LoadForces F(n_acted);
        forces(at, F);
        for (std::size_t b = 0; b < n_acted; ++b)
            std::copy_n(F[b].a, 12, factors.begin() + static_cast<std::ptrdiff_t>(12 * b));
    };
    law.unit = [](const LoadArguments&, std::size_t k, LoadForces& F) { F[k / 12].a[k % 12] += 1; };
    return law;
}

/// Mobilities by the bodies alone, at the start: an order of magnitude. Accepted kicks are computed with the
/// joints.
void weigh(const ModelTables& tables, InspectedLaw& law)
{
    const State start = tables.model->start();
    std::vector<double> X, V, maps(12 * tables.bodies.size()), q(static_cast<std::size_t>(tables.n_twists));
    for (const Matrix34& x : start.X) X.insert(X.end(), std::begin(x.a), std::end(x.a));
    for (const Matrix34& v : start.V) V.insert(V.end(), std::begin(v.a), std::end(v.a));
    tables.bodies.map_twists(X.data(), maps.data());
    const LoadArguments at = tables.loads.arguments(law.load, {start.t}, X.data(), V.data(), {});
    const Load& load = tables.model->loads()[law.load];
    for (std::size_t k = 0; k < law.inside.n_factors; ++k) {
        LoadForces F(load.n_acted);
        law.inside.unit(at, k, F);
        std::vector<double> raw(X.size(), 0.0);
        for (std::size_t b = 0; b < load.n_acted; ++b)
            if (load.bodies[b] != world)
                std::copy_n(F[b].a, 12, raw.begin() + static_cast<std::ptrdiff_t>(12 * load.bodies[b]));
        tables.bodies.twist_rows(X.data(), maps.data(), raw.data(), q.data());
        tables.bodies.to_scaled_rows(maps.data(), q.data(), q.data());
        tables.bodies.to_twist(maps.data(), q.data(), q.data());
        double mobility = 0;
        for (std::size_t i = 0; i < q.size(); ++i)
            mobility += std::abs(q[i]);   // m/s^2 and rad/s^2: lengths are of the order of the model's
        law.mobility.push_back(mobility * std::max(1.0, 1 / tables.length));
    }
}

}   // namespace

std::vector<InspectedLaw> laws_to_inspect(const ModelTables& tables)
{
    std::vector<InspectedLaw> laws;
    const std::vector<Load>& loads = tables.model->loads();
    for (std::size_t l = 0; l < loads.size(); ++l) {
        if (loads[l].is_smooth) continue;
        InspectedLaw law{
            static_cast<int>(l), loads[l].bodies, loads[l].inside ? *loads[l].inside : whole(loads[l]), {}};
        std::erase(law.bodies, world);
        weigh(tables, law);
        laws.push_back(std::move(law));
    }
    return laws;
}

LawOnPath::LawOnPath(const ModelTables& tables, const ElementRule& rule)
    : tables_(tables), basis_(lobatto_basis(rule.degree + 2))
{}

/// Numbers q at the points where they are kept, from the polynomial through the looks at `shares`: so laws
/// that were looked at in lanes need no other look.
void LawOnPath::use(const std::vector<double>& shares)
{
    const LagrangeBasis looks(shares);
    from_looks_.resize(basis_.nodes().size() * shares.size());
    for (std::size_t A = 0; A < basis_.nodes().size(); ++A)
        looks.values(basis_.nodes()[A], std::span(from_looks_).subspan(A * shares.size(), shares.size()));
}

void LawOnPath::follow(const InspectedLaw& law, ElementPath& path, const std::vector<double>& angles,
                       const LooksInLanes* looks)
{
    const std::size_t n = law.inside.n_numbers, size = static_cast<std::size_t>(basis_.size());
    law_ = &law;
    start_ = path.start();
    h_ = path.h();
    numbers_.resize(n * size);
    std::vector<double> turned = angles;
    if (looks != nullptr) looks->numbers(law.load, from_looks_, numbers_);
    for (std::size_t A = 0; looks == nullptr && A < size; ++A) {
        path.go(basis_.nodes()[A], law.bodies);
        tables_.loads.turns.follow_of(law.load, Configurations(path.X()), turned);
        law.inside.numbers(tables_.loads.arguments(law.load, path.at(), path.X(), path.V(), turned),
                           std::span(numbers_).subspan(n * A, n));
    }
    if (law.inside.steepest) bound_derivatives();
}

/// Of q(s) by shares s, so that h is in them: slopes at the points, and the largest second and third
/// derivatives, by which chords of q and of its slope may be off.
void LawOnPath::bound_derivatives()
{
    constexpr double between = 2;   // nodes a derivative may be larger than at them
    const std::size_t n = law_->inside.n_numbers, size = static_cast<std::size_t>(basis_.size());
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

void LawOnPath::factors_at(double share, double* factors)
{
    const std::size_t n = law_->inside.n_numbers, size = static_cast<std::size_t>(basis_.size());
    values_.resize(size);
    at_.assign(n, 0.0);
    basis_.values(share, values_);
    for (std::size_t A = 0; A < size; ++A)
        for (std::size_t k = 0; k < n; ++k) at_[k] += values_[A] * numbers_[n * A + k];
    law_->inside.factors({start_ + share * h_, Side::middle}, at_, {factors, law_->inside.n_factors});
}

/// The hull of the values at both ends, for which values_ were made, widened by the curvature bounds.
EnclosedValue LawOnPath::range(std::size_t number, double width) const
{
    const std::size_t n = law_->inside.n_numbers, size = basis_.size();
    const double eighth = 0.125 * width * width;
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
    meet(values_.data());
    meet(values_.data() + size);
    const double bend = eighth * second_[number], more = eighth * third_[number];
    return {{range.value.low - bend, range.value.high + bend},
            {range.slope.low - more, range.slope.high + more}};
}

/// |df_k/ds| between two shares; time is one more number, whose slope by s is h.
void LawOnPath::bound_slopes(double first, double last, std::span<double> bounds)
{
    const std::size_t size = basis_.size();
    values_.resize(2 * size);
    basis_.values(first, std::span(values_).first(size));
    basis_.values(last, std::span(values_).subspan(size));
    std::vector<EnclosedValue> numbers;
    for (std::size_t k = 0; k < law_->inside.n_numbers; ++k) numbers.push_back(range(k, last - first));
    const Enclosure t = hull(Enclosure::of(start_ + first * h_), Enclosure::of(start_ + last * h_));
    law_->inside.steepest({t, Enclosure::of(h_)}, numbers, bounds);
}

}   // namespace livens::inline spacetime_internal
