#include "livens/diagnostics/detail/sampler.h"

#include <algorithm>
#include <cassert>

#include "livens/time/basis.h"

namespace livens {
namespace {

void unstack(std::span<const double> stacked, std::span<Matrix34> bodies)
{
    assert(stacked.size() == 12 * bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) std::copy_n(stacked.data() + 12 * b, 12, bodies[b].a);
}

}   // namespace

ElementSampler::ElementSampler(const Motion& motion, std::vector<double> points)
    : motion_(motion), points_(std::move(points))
{
    const LagrangeBasis basis = lobatto_basis(motion.X.degree);
    const std::size_t n = static_cast<std::size_t>(basis.size());
    values_.resize(points_.size() * n);
    derivatives_.resize(points_.size() * n);
    for (std::size_t k = 0; k < points_.size(); ++k) {
        basis.values(points_[k], std::span<double>(values_).subspan(k * n, n));
        basis.derivatives(points_[k], std::span<double>(derivatives_).subspan(k * n, n));
        const auto node = std::find(basis.nodes().begin(), basis.nodes().end(), points_[k]);
        nodes_.push_back(node == basis.nodes().end() ? -1 : static_cast<int>(node - basis.nodes().begin()));
    }
}

Instant ElementSampler::instant(int element, int k) const
{
    const double s = points_[k];
    if (s == 0) return {motion_.mesh.ends[element], Side::right};
    if (s == 1) return {motion_.mesh.ends[element + 1], Side::left};
    return {motion_.mesh.ends[element] + s * motion_.mesh.length(element), Side::middle};
}

void ElementSampler::positions(int element, int k, std::span<Matrix34> X) const
{
    if (nodes_[k] >= 0) {
        unstack(motion_.X.coefficient(element, nodes_[k]), X);
        return;
    }
    const double* M = values_.data() + static_cast<std::size_t>(k) * (motion_.X.degree + 1);
    const std::span<const double> first = motion_.X.coefficient(element, 0);
    unstack(first, X);
    for (int A = 1; A <= motion_.X.degree; ++A) {
        const std::span<const double> x = motion_.X.coefficient(element, A);
        for (std::size_t b = 0; b < X.size(); ++b) {
            // In differences from the first node, so that rounding is that of the change.
            for (int i = 0; i < 12; ++i) X[b][i] += M[A] * (x[12 * b + i] - first[12 * b + i]);
        }
    }
}

void ElementSampler::velocities(int element, int k, std::span<Matrix34> V) const
{
    const double* D = derivatives_.data() + static_cast<std::size_t>(k) * (motion_.X.degree + 1);
    const double h = motion_.mesh.length(element);
    const std::span<const double> first = motion_.X.coefficient(element, 0);
    std::fill(V.begin(), V.end(), Matrix34{});
    for (int A = 1; A <= motion_.X.degree; ++A) {
        const std::span<const double> x = motion_.X.coefficient(element, A);
        for (std::size_t b = 0; b < V.size(); ++b) {
            for (int i = 0; i < 12; ++i) V[b][i] += D[A] / h * (x[12 * b + i] - first[12 * b + i]);
        }
    }
}

void positions_at_end(const Motion& motion, int end, std::span<Matrix34> X)
{
    unstack(end < motion.n_elements() ? motion.X.coefficient(end, 0)
                                      : motion.X.coefficient(end - 1, motion.X.degree),
            X);
}

std::span<const Matrix34> velocities_at_end(const Motion& motion, int end)
{
    const std::size_t n = static_cast<std::size_t>(motion.n_bodies);
    assert(motion.velocities.size() == motion.mesh.ends.size() * n);
    return std::span<const Matrix34>(motion.velocities).subspan(static_cast<std::size_t>(end) * n, n);
}

}   // namespace livens
