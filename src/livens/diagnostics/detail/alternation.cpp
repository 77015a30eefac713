// SPDX-License-Identifier: BSD-3-Clause
// Second differences of an alternating function are four times it, those of a smooth one are small. Centres
// and spins are judged apart (theory.md, "The elements of the paper", Acceptance).
#include "livens/diagnostics/detail/alternation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "livens/diagnostics/detail/pairs.h"
#include "livens/diagnostics/largest.h"

namespace livens::inline diagnostics_internal {

namespace {

/// A body's spin is judged by itself down to this fraction of the speed of all that moves.
constexpr double smallest_part = 1e-3;

}   // namespace

PartMetric PartMetric::of_velocities(const Model& model)
{
    PartMetric metric;
    const auto centre_of = [](const Body& body) {
        Vector4 centre{};   // (1, theta): m (1, 0) = M (1, theta)
        for (int i = 0; i < 4; ++i) centre[i] = body.mass(i, 0) / body.mass(0, 0);
        return body.mass(0, 0) * outer(centre, centre);
    };
    // Centres and spins apart: an alternating spin would be lost beside a large velocity of the centre.
    for (int b = 0; b < model.n_bodies(); ++b) metric.add(centre_of(model.bodies()[b]), b);
    metric.fill_up();
    metric.n_centres_ = metric.size_;
    for (int b = 0; b < model.n_bodies(); ++b)
        metric.add(model.bodies()[b].mass - centre_of(model.bodies()[b]), b);
    metric.fill_up();
    return metric;
}

PartMetric PartMetric::of_momenta(const Model& model)
{
    PartMetric metric;
    const auto linear_of = [](const Body& body) {
        Matrix4 linear{};
        linear(0, 0) = 1 / body.mass(0, 0);
        return linear;
    };
    for (int b = 0; b < model.n_bodies(); ++b) metric.add(linear_of(model.bodies()[b]), b);
    metric.fill_up();
    metric.n_centres_ = metric.size_;
    for (int b = 0; b < model.n_bodies(); ++b) {
        const Body& body = model.bodies()[b];
        metric.add(inverse_mass(body.mass, body.is_point) - linear_of(body), b);
    }
    metric.fill_up();
    return metric;
}

/// m = R^T R by the largest pivots first, until what is left is rounding: masses may be singular.
void PartMetric::add(const Matrix4& part, int body)
{
    Matrix4 m = part;
    const double level = 16 * std::numeric_limits<double>::epsilon() * std::max(trace(m), 0.0);
    for (int rank = 0; rank < 4; ++rank) {
        int k = 0;
        for (int i = 1; i < 4; ++i)
            if (m(i, i) > m(k, k)) k = i;
        if (!(m(k, k) > level)) break;
        Vector4 row = m.column(k);
        row *= 1 / std::sqrt(m(k, k));
        m -= outer(row, row);
        for (int i = 0; i < 4; ++i) m(i, k) = m(k, i) = 0;
        rows_.push_back({size_, 0});
        for (int i = 0; i < 4; ++i) {
            if (row[i] == 0) continue;
            terms_.push_back({12 * body + 3 * i, row[i]});
            ++rows_.back().n_terms;
        }
        size_ += 3;
    }
}

void PartMetric::fill_up() { size_ += size_ % 2; }

void PartMetric::apply(const double* g, double* out) const
{
    if (n_centres_ > 0) out[n_centres_ - 1] = 0;   // unless it is overwritten
    if (size_ > 0) out[size_ - 1] = 0;
    const Term* term = terms_.data();
    for (const Row& row : rows_) {
        double x = 0, y = 0, z = 0;
        for (const Term* const behind = term + row.n_terms; term != behind; ++term) {
            x += term->value * g[term->number];
            y += term->value * g[term->number + 1];
            z += term->value * g[term->number + 2];
        }
        out[row.at] = x, out[row.at + 1] = y, out[row.at + 2] = z;
    }
}

namespace {

// n is even.

double square(const double* x, int n)
{
    Pair sum = {};
    for (int i = 0; i < n; i += 2) sum += pair_at(x + i) * pair_at(x + i);
    return sum[0] + sum[1];
}

double second_difference_square(const double* a, const double* b, const double* c, int n)
{
    Pair sum = {};
    for (int i = 0; i < n; i += 2) {
        const Pair d = pair_at(a + i) - 2 * pair_at(b + i) + pair_at(c + i);
        sum += d * d;
    }
    return sum[0] + sum[1];
}

/// join of n values that follow each other, from each on of which n are there: by windows that double.
template <class Join>
std::vector<double> windows(std::vector<double> values, std::size_t n, double empty, const Join& join)
{
    std::vector<double> all(values.size() + 1 - n, empty);
    for (std::size_t size = 1, done = 0; done < n; size *= 2) {
        if (n & size) {
            for (std::size_t i = 0; i < all.size(); ++i) all[i] = join(all[i], values[i + done]);
            done += size;
        }
        for (std::size_t i = 0; i + size < values.size(); ++i) values[i] = join(values[i], values[i + size]);
    }
    return all;
}

std::vector<double> sums_of(std::vector<double> values, std::size_t n)
{
    return windows(std::move(values), n, 0, [](double a, double b) { return a + b; });
}

}   // namespace

SampleSeries::SampleSeries(const PartMetric& metric, double noise, int n)
    : n_centres_(metric.n_centres()), size_(metric.size()), noise_(noise)
{
    for (Squares& part : parts_) {
        part.samples.resize(static_cast<std::size_t>(n));
        part.differences.resize(static_cast<std::size_t>(n));
    }
    times_.resize(static_cast<std::size_t>(n));
    steps_.resize(static_cast<std::size_t>(n));
    before_.resize(static_cast<std::size_t>(size_));
    last_ = before_;
}

void SampleSeries::append(double t, double step, const double* sample)
{
    times_[n_] = t;
    steps_[n_] = step;
    for (int p = 0; p < 2; ++p) {
        const int first = p == 0 ? 0 : n_centres_, n = p == 0 ? n_centres_ : size_ - n_centres_;
        parts_[p].samples[n_] = square(sample + first, n);
        if (n_ < 2) continue;
        parts_[p].differences[n_ - 1] =
            second_difference_square(before_.data() + first, last_.data() + first, sample + first, n);
    }
    ++n_;
    std::swap(before_, last_);
    std::copy_n(sample, size_, last_.data());
}

Alternation SampleSeries::worst(int window) const
{
    assert(n_ == times_.size());
    for (std::size_t i = 0; i < times_.size(); ++i) {
        if (!std::isfinite(parts_[0].samples[i] + parts_[1].samples[i]))
            return {std::numeric_limits<double>::quiet_NaN(), times_[i]};
    }
    const std::size_t n = std::min(static_cast<std::size_t>(window), times_.size());
    if (n < fewest) return {};
    const double means[] = {mean(parts_[0]), mean(parts_[1])};
    const std::vector<double> steps = windows(steps_, n, std::numeric_limits<double>::infinity(),
                                              [](double a, double b) { return b < a ? b : a; });
    Alternation worst;
    for (int p = 0; p < 2; ++p) {
        // Against the mean over all time: where a motion rests for a while, noise would alternate by its own
        // size.
        const double floor = std::max(means[p], smallest_part * smallest_part * (means[0] + means[1]));
        const Alternation of_part = worst_of(parts_[p], n, floor, steps);
        if (raise_to(worst.value, of_part.value)) worst.time = of_part.time;
    }
    return worst;
}

/// Alternating part of n samples against all of them, or against `floor` or what is noise if that is more. An
/// alternating g has second differences 4 g.
/// Second differences of a wave that turns by theta a step are 4 sin^2(theta / 2) of it, so that the root of
/// the squares' ratio over 16 is sin^2(theta / 2): 1 where it alternates.
Alternation SampleSeries::worst_of(const Squares& part, std::size_t n, double floor,
                                   const std::vector<double>& steps) const
{
    const std::vector<double> all = sums_of(part.samples, n), second = sums_of(part.differences, n - 2);
    const double count = static_cast<double>(n);
    double largest = 0;
    Alternation worst;
    for (std::size_t first = 0; first < all.size(); ++first) {
        const double noise = noise_ / steps[first];
        const double reference = std::max(all[first] / count, std::max(floor, noise * noise));
        if (!(reference > 0)) continue;
        const double ratio = std::min(1.0, second[first + 1] / (16 * (count - 2)) / reference);
        if (!raise_to(largest, ratio)) continue;
        worst = {std::sqrt(ratio), 0.5 * (times_[first] + times_[first + n - 1])};
    }
    return worst;
}

/// Over time.
double SampleSeries::mean(const Squares& part) const
{
    double sum = 0, length = 0;
    for (std::size_t i = 0; i < times_.size(); ++i) {
        sum += steps_[i] * part.samples[i];
        length += steps_[i];
    }
    return sum / length;
}

}   // namespace livens::inline diagnostics_internal
