// SPDX-License-Identifier: BSD-3-Clause
// Alternation from node to node, sin^2 of half the angle per step: solutions of the paper's elements that are
// none (theory.md, "The elements of the paper", Acceptance). Second differences of an alternating function
// are four times it, those of a smooth one are small.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>

#include "livens/base/error.h"
#include "livens/diagnostics/detail/sampler.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/largest.h"
#include "livens/solvers/patience.h"

namespace livens {
namespace {

/// Of positions, relative to their size: above what Newton's iteration and rounding leave.
constexpr double noise_level = 1e-11;
/// Relative to the model's length, which places bodies that are near the origin.
constexpr double noise_of_lengths = 1e-13;
/// A body's spin is judged by itself down to this fraction of the speed of all that moves.
constexpr double smallest_part = 1e-3;
/// With fewer samples a smooth oscillation may look like any other.
constexpr int fewest_samples = 6;

using Bodies = std::vector<Matrix34>;

/// Of symmetric metrics, of whose entries many are zero.
double square(const std::vector<Matrix4>& metric, const Bodies& g)
{
    double sum = 0;
    for (std::size_t b = 0; b < g.size(); ++b)
        for (int p = 0; p < 4; ++p)
            for (int q = 0; q <= p; ++q) {
                const double m = metric[b](p, q);
                if (m != 0) sum += (p == q ? m : 2 * m) * dot(g[b].column(p), g[b].column(q));
            }
    return sum;
}

/// Twice the kinetic energy of velocities is their square in the mass matrices, which are the sum of two:
/// what the centres of mass have, and what the spins have about them. The same for momenta, with inverses.
struct Metric {
    std::vector<Matrix4> centres, spins;

    static Metric of_velocities(const Model& model)
    {
        Metric metric;
        for (const Body& body : model.bodies()) {
            Vector4 centre{};   // (1, theta): m (1, 0) = M (1, theta)
            for (int i = 0; i < 4; ++i) centre[i] = body.mass(i, 0) / body.mass(0, 0);
            // Centres and spins apart: an alternating spin would be lost beside a large velocity of the
            // centre.
            metric.add(body.mass, body.mass(0, 0) * outer(centre, centre));
        }
        return metric;
    }
    static Metric of_momenta(const Model& model)
    {
        Metric metric;
        for (const Body& body : model.bodies()) {
            Matrix4 linear{};
            linear(0, 0) = 1 / body.mass(0, 0);
            metric.add(inverse_mass(body.mass, body.is_point), linear);
        }
        return metric;
    }

private:
    void add(const Matrix4& all, const Matrix4& centre)
    {
        centres.push_back(centre);
        spins.push_back(all - centre);
    }
};

struct Worst {
    double value = 0;
    double time = 0;
};

/// Squares of a function of time and of its second differences, sample after sample.
class Squares {
public:
    Squares(std::vector<Matrix4> metric, std::size_t n) : metric_(std::move(metric))
    {
        samples_.reserve(n);
        differences_.reserve(n);
    }

    /// The next sample, and the second difference about the last one if there is any.
    void append(const Bodies& g, const Bodies* second_difference)
    {
        // E about the centre is what m leaves, and may be negative by rounding where it is zero.
        samples_.push_back(positive(square(metric_, g)));
        if (second_difference) differences_.back() = positive(square(metric_, *second_difference));
        differences_.push_back(0);
    }

    double operator[](std::size_t i) const { return samples_[i]; }
    std::size_t size() const { return samples_.size(); }

    /// Alternating part of `count` samples against all of them, or against `floor` if that is more. An
    /// alternating g has second differences 4 g.
    double alternation(std::size_t first, std::size_t count, double floor) const
    {
        double sum = 0, second = 0;
        for (std::size_t i = first; i < first + count; ++i) sum += samples_[i];
        for (std::size_t i = first + 1; i + 1 < first + count; ++i) second += differences_[i];
        const double n = static_cast<double>(count);
        const double reference = std::max(sum / n, floor);
        return reference > 0 ? std::min(1.0, std::sqrt(second / (16 * (n - 2)) / reference)) : 0;
    }

private:
    static double positive(double x) { return x < 0 ? 0 : x; }

    std::vector<Matrix4> metric_;
    std::vector<double> samples_, differences_;   // the second difference at the sample in its middle
};

/// A velocity or a momentum, one sample after the other.
class Series {
public:
    /// `noise` times 1 / step is what rounding may make of a sample; `n` samples will come.
    Series(Metric metric, double noise, int n)
        : parts_{Squares(std::move(metric.centres), static_cast<std::size_t>(n)),
                 Squares(std::move(metric.spins), static_cast<std::size_t>(n))},
          noise_(noise)
    {
        times_.reserve(static_cast<std::size_t>(n));
        steps_.reserve(static_cast<std::size_t>(n));
    }

    void append(double t, double step, const Bodies& g)
    {
        times_.push_back(t);
        steps_.push_back(step);
        const bool has_two = times_.size() > 2;
        for (std::size_t b = 0; has_two && b < g.size(); ++b) before_[b] += g[b] - 2.0 * last_[b];
        for (Squares& part : parts_) part.append(g, has_two ? &before_ : nullptr);
        before_ = std::move(last_);
        last_ = g;
    }

    Worst worst(int window) const
    {
        for (std::size_t i = 0; i < times_.size(); ++i) {
            if (!std::isfinite(parts_[0][i] + parts_[1][i]))
                return {std::numeric_limits<double>::quiet_NaN(), times_[i]};
        }
        Worst result;
        const std::size_t n = std::min(static_cast<std::size_t>(window), times_.size());
        if (n < fewest_samples) return result;
        const std::array<double, 2> means{mean(parts_[0]), mean(parts_[1])};
        for (std::size_t p = 0; p < 2; ++p) {
            // Against the mean over all time: where a motion rests for a while, noise would alternate by its
            // own size.
            const double floor = std::max(means[p], smallest_part * smallest_part * (means[0] + means[1]));
            for (std::size_t first = 0; first + n <= times_.size(); ++first) {
                const double value = parts_[p].alternation(first, n, std::max(floor, noise_square(first, n)));
                if (raise_to(result.value, value))
                    result.time = 0.5 * (times_[first] + times_[first + n - 1]);
            }
        }
        return result;
    }

private:
    /// Mean over time.
    double mean(const Squares& part) const
    {
        double sum = 0, length = 0;
        for (std::size_t i = 0; i < times_.size(); ++i) {
            sum += steps_[i] * part[i];
            length += steps_[i];
        }
        return sum / length;
    }
    double noise_square(std::size_t first, std::size_t count) const
    {
        const double step = *std::min_element(steps_.begin() + static_cast<std::ptrdiff_t>(first),
                                              steps_.begin() + static_cast<std::ptrdiff_t>(first + count));
        return (noise_ / step) * (noise_ / step);
    }

    std::array<Squares, 2> parts_;
    double noise_;
    std::vector<double> times_, steps_;
    Bodies before_, last_;   // the last two samples
};

std::vector<double> equal_steps(int n)
{
    std::vector<double> points;
    for (int k = 0; k <= n; ++k) points.push_back(static_cast<double>(k) / n);
    return points;
}

/// Noise of positions in the metric of the masses, from the largest at element ends; kg^(1/2) m.
double position_noise(const Model& model, const Motion& motion)
{
    std::vector<Matrix4> masses;
    double mass = 0, largest = 0;
    for (const Body& body : model.bodies()) {
        masses.push_back(body.mass);
        mass += body.mass(0, 0);
    }
    Bodies X(masses.size());
    for (int end = 0; end <= motion.n_elements(); ++end) {
        Patience::ask();
        positions_at_end(motion, end, X);
        raise_to(largest, std::sqrt(square(masses, X)));
    }
    double noise = noise_level * largest;
    raise_to(noise, noise_of_lengths * model.length() * std::sqrt(mass));
    return noise;
}

/// Mean velocities of steps inside elements, so that jumps of X between blocks do not enter.
Series step_velocities(const Model& model, const Motion& motion, double noise)
{
    const int n = motion.X.degree;
    Series series(Metric::of_velocities(model), noise, motion.n_elements() * n);
    const ElementSampler sampler(motion, equal_steps(n));
    Bodies here(static_cast<std::size_t>(motion.n_bodies)), next(here.size());
    for (int e = 0; e < motion.n_elements(); ++e) {
        Patience::ask();
        const double step = motion.mesh.length(e) / n;
        sampler.positions(e, 0, here);
        for (int k = 0; k < n; ++k) {
            sampler.positions(e, k + 1, next);
            for (std::size_t b = 0; b < here.size(); ++b) here[b] = (1 / step) * (next[b] - here[b]);
            series.append(motion.mesh.ends[e] + (k + 0.5) * step, step, here);
            std::swap(here, next);
        }
    }
    return series;
}

/// The field of momenta at the starts of its steps, and at the very end.
Series momenta(const Model& model, const Motion& motion, double noise)
{
    const int n = std::max(motion.P.degree, 1);
    Series series(Metric::of_momenta(model), noise, motion.n_elements() * n + 1);
    const ElementSampler sampler(motion, equal_steps(n));
    Bodies P(static_cast<std::size_t>(motion.n_bodies));
    for (int e = 0; e < motion.n_elements(); ++e) {
        Patience::ask();
        for (int k = 0; k < (e + 1 < motion.n_elements() ? n : n + 1); ++k) {
            sampler.momenta(e, k, P);
            series.append(sampler.instant(e, k).t, motion.mesh.length(e) / n, P);
        }
    }
    return series;
}

/// Velocities at element ends, which are momenta: V in the metric of m is P in that of m^-1.
Series end_velocities(const Model& model, const Motion& motion, double noise)
{
    Series series(Metric::of_velocities(model), noise, motion.n_elements() + 1);
    for (int end = 0; end <= motion.n_elements(); ++end) {
        Patience::ask();
        const std::span<const Matrix34> V = velocities_at_end(motion, end);
        const double step = motion.mesh.length(std::max(end - 1, 0));
        series.append(motion.mesh.ends[end], step, Bodies(V.begin(), V.end()));
    }
    return series;
}

/// The momentum that belongs to the derivative of X is no more than X has said; velocities at element ends
/// are data of their own, but a smooth motion may turn by radians between the ends of elements that are not
/// linear.
Worst worst_of_momenta(const Model& model, const Motion& motion, double noise, int window, const Worst& of_X)
{
    const bool invertible = std::ranges::none_of(
        model.bodies(), [](const Body& body) { return is_singular(body.mass, body.is_point); });
    if (!motion.P.empty() && invertible) return momenta(model, motion, noise).worst(window);
    return motion.X.degree == 1 ? end_velocities(model, motion, noise).worst(window) : of_X;
}

}   // namespace

Zigzag zigzag(const Model& model, const Motion& motion, int window)
{
    assert(model.n_bodies() == motion.n_bodies);
    if (window < fewest_samples) {
        throw InputError({"window", "window", "too few samples to tell an oscillation from a zig-zag",
                          std::to_string(window), ">= " + std::to_string(fewest_samples), "", ""});
    }
    if (motion.n_elements() < 1) return {};
    const double noise = position_noise(model, motion);
    const Worst positions = step_velocities(model, motion, noise).worst(window);
    const Worst momenta = worst_of_momenta(model, motion, noise, window, positions);
    const bool in_positions = !(positions.value < momenta.value) && !std::isnan(momenta.value);
    return {positions.value, momenta.value, in_positions ? positions.time : momenta.time};
}

}   // namespace livens
