// SPDX-License-Identifier: BSD-3-Clause
// Alternation from node to node, sin^2 of half the angle per step: solutions of the paper's elements that are
// none (theory.md, "The elements of the paper", Acceptance).
#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "livens/base/error.h"
#include "livens/diagnostics/detail/alternation.h"
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

std::vector<double> equal_steps(int n)
{
    std::vector<double> points;
    for (int k = 0; k <= n; ++k) points.push_back(static_cast<double>(k) / n);
    return points;
}

/// Noise of positions in the metric of the masses, from the largest at element ends; kg^(1/2) m.
double position_noise(const Model& model, const Motion& motion, const PartMetric& metric)
{
    double mass = 0, largest = 0;
    for (const Body& body : model.bodies()) mass += body.mass(0, 0);
    std::vector<double> numbers(static_cast<std::size_t>(metric.size()));
    for (int end = 0; end <= motion.n_elements(); ++end) {
        Patience::ask();
        const bool is_last = end == motion.n_elements();
        metric.apply(motion.X.coefficient(is_last ? end - 1 : end, is_last ? motion.X.degree : 0).data(),
                     numbers.data());
        double square = 0;
        for (const double x : numbers) square += x * x;
        raise_to(largest, std::sqrt(square));
    }
    double noise = noise_level * largest;
    raise_to(noise, noise_of_lengths * model.length() * std::sqrt(mass));
    return noise;
}

/// Mean velocities over equal steps of an element, as numbers of a metric.
class StepVelocities {
public:
    StepVelocities(const Motion& motion, const PartMetric& metric)
        : motion_(motion), metric_(metric), n_(motion.X.degree), table_(motion.X, equal_steps(n_)),
          reduced_(static_cast<std::size_t>(n_ * metric.size())), samples_(reduced_)
    {
        const LagrangeBasis basis = motion.X.basis();
        std::vector<double> here(static_cast<std::size_t>(n_) + 1), next(here.size());
        basis.values(0, here);
        for (int k = 1; k <= n_; ++k) {
            basis.values(static_cast<double>(k) / n_, next);
            for (std::size_t A = 1; A < here.size(); ++A) matrix_.push_back(next[A] - here[A]);
            std::swap(here, next);
        }
    }

    /// Of n steps of a length, one after the other.
    const double* of(int element, double step)
    {
        const bool is_polynomial = motion_.X.denominators.empty();
        if (is_polynomial)
            differences_of(motion_.X, element, 1 / step, values_);
        else
            find_increments(element, step);
        for (int k = 0; k < n_; ++k)
            metric_.apply(values_.data() + k * motion_.X.n_values, reduced_.data() + k * metric_.size());
        if (!is_polynomial) return reduced_.data();
        multiply({matrix_.data(), n_, n_, n_}, reduced_.data(), metric_.size(), samples_.data());
        return samples_.data();
    }

private:
    void find_increments(int element, double step)
    {
        const auto n = static_cast<std::size_t>(motion_.X.n_values);
        places_.resize(n * static_cast<std::size_t>(n_ + 1));
        values_.resize(places_.size() - n);
        table_.all_values(element, places_);
        for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = (places_[i + n] - places_[i]) / step;
    }

    const Motion& motion_;
    const PartMetric& metric_;
    int n_;
    FieldTable table_;             // of quotients of polynomials
    std::vector<double> matrix_;   // increments of the basis, step by step, but for its first function
    std::vector<double> places_, values_, reduced_, samples_;
};

/// Steps lie inside elements, so that jumps of X between blocks do not enter.
SampleSeries step_velocities(const Motion& motion, double noise, const PartMetric& metric)
{
    const int n = motion.X.degree;
    SampleSeries series(metric, noise, motion.n_elements() * n);
    StepVelocities velocities(motion, metric);
    for (int e = 0; e < motion.n_elements(); ++e) {
        Patience::ask();
        const double step = motion.mesh.length(e) / n;
        const double* const samples = velocities.of(e, step);
        for (int k = 0; k < n; ++k)
            series.append(motion.mesh.ends[e] + (k + 0.5) * step, step, samples + k * metric.size());
    }
    return series;
}

/// The field of momenta at the starts of its steps, and at the very end.
SampleSeries momenta(const Model& model, const Motion& motion, double noise)
{
    const int n = std::max(motion.P.degree, 1);
    const PartMetric metric = PartMetric::of_momenta(model);
    SampleSeries series(metric, noise, motion.n_elements() * n + 1);
    const ElementSampler sampler(motion, equal_steps(n));
    std::vector<Matrix34> P(static_cast<std::size_t>(motion.n_bodies));
    std::vector<double> numbers(static_cast<std::size_t>(metric.size()));
    for (int e = 0; e < motion.n_elements(); ++e) {
        Patience::ask();
        for (int k = 0; k < (e + 1 < motion.n_elements() ? n : n + 1); ++k) {
            sampler.momenta(e, k, P);
            metric.apply(P.data()->data(), numbers.data());
            series.append(sampler.instant(e, k).t, motion.mesh.length(e) / n, numbers.data());
        }
    }
    return series;
}

/// Velocities at element ends, which are momenta: V in the metric of m is P in that of m^-1.
SampleSeries end_velocities(const Motion& motion, double noise, const PartMetric& metric)
{
    SampleSeries series(metric, noise, motion.n_elements() + 1);
    std::vector<double> numbers(static_cast<std::size_t>(metric.size()));
    for (int end = 0; end <= motion.n_elements(); ++end) {
        Patience::ask();
        metric.apply(velocities_at_end(motion, end).data()->data(), numbers.data());
        series.append(motion.mesh.ends[end], motion.mesh.length(std::max(end - 1, 0)), numbers.data());
    }
    return series;
}

/// The momentum that belongs to the derivative of X is no more than X has said; velocities at element ends
/// are data of their own, but a smooth motion may turn by radians between the ends of elements that are not
/// linear.
Alternation worst_of_momenta(const Model& model, const Motion& motion, double noise, int window,
                             const PartMetric& metric, const Alternation& of_X)
{
    const bool invertible = std::ranges::none_of(
        model.bodies(), [](const Body& body) { return is_singular(body.mass, body.is_point); });
    if (!motion.P.empty() && invertible) return momenta(model, motion, noise).worst(window);
    return motion.X.degree == 1 ? end_velocities(motion, noise, metric).worst(window) : of_X;
}

}   // namespace

Zigzag zigzag(const Model& model, const Motion& motion, int window)
{
    assert(model.n_bodies() == motion.n_bodies);
    constexpr int fewest = SampleSeries::fewest;
    if (window < fewest) {
        throw InputError({"window", "window", "too few samples to tell an oscillation from a zig-zag",
                          std::to_string(window), ">= " + std::to_string(fewest), "", ""});
    }
    if (motion.n_elements() < 1 || motion.n_bodies == 0) return {};
    const PartMetric metric = PartMetric::of_velocities(model);
    const double noise = position_noise(model, motion, metric);
    const Alternation positions = step_velocities(motion, noise, metric).worst(window);
    const Alternation momenta = worst_of_momenta(model, motion, noise, window, metric, positions);
    const bool in_positions = !(positions.value < momenta.value) && !std::isnan(momenta.value);
    return {positions.value, momenta.value, in_positions ? positions.time : momenta.time};
}

}   // namespace livens
