// SPDX-License-Identifier: BSD-3-Clause
// q(s) of a law from its values at p + 3 Gauss-Lobatto points, its slope by their differentiation matrix, and
// interval enclosures of both between two shares: a chord, widened by an eighth of the width squared times
// the next derivative but one (docs/theory.md, "Looks at laws", Enclosures).
#include "livens/spacetime/nodal/law_on_path.h"

#include <algorithm>
#include <cmath>

namespace livens {

LawOnPath::LawOnPath(const Tables& tables, const ElementRule& rule)
    : tables_(tables), basis_(lobatto_basis(rule.degree + 2))
{}

void LawOnPath::follow(const InspectedLaw& law, ElementPath& path, const std::vector<double>& angles)
{
    constexpr double between = 2;   // nodes a derivative may be larger than at them
    const std::size_t n = law.inside.n_numbers, size = static_cast<std::size_t>(basis_.size());
    law_ = &law;
    start_ = path.start();
    h_ = path.h();
    numbers_.resize(n * size);
    std::vector<double> turned = angles;
    for (std::size_t A = 0; A < size; ++A) {
        path.go(basis_.nodes()[A], law.bodies);
        tables_.turns.follow_of(law.load, Configurations(path.X()), turned);
        law.inside.numbers(tables_.arguments(law.load, path.at(), path.X(), path.V(), turned),
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

/// Between the values at both ends, for which values_ are, and beyond by what it may bend.
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

}   // namespace livens
