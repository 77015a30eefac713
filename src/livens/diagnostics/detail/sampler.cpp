// SPDX-License-Identifier: BSD-3-Clause
// Fields of a motion at the same points of every element: the values of the basis are made once, and each
// evaluation is a product with coefficients. Diagnostics integrate with the rules of the method (theory.md,
// "What is diagnosed").
#include "livens/diagnostics/detail/sampler.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

namespace livens::inline diagnostics_internal {
namespace {

void unstack(std::span<const double> stacked, std::span<Matrix34> bodies)
{
    assert(stacked.size() == 12 * bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) std::copy_n(stacked.data() + 12 * b, 12, bodies[b].a);
}

/// Two doubles in one register; the compiler does not find them by itself here.
typedef double Pair __attribute__((vector_size(16)));

/// out = factor x_0 + sum over A of row_A (x_A - x_0), for n `Number`s of coefficients that are `stride`
/// doubles apart. In differences from the first node, as the basis adds up to one: rounding is that of the
/// change.
template <class Number, int n>
void combine(const double* x, std::size_t stride, std::span<const double> row, double factor, double* out)
{
    const auto at = [](const double* place, int i) {   // coefficients are aligned as doubles are
        Number value;
        std::memcpy(&value, reinterpret_cast<const char*>(place) + i * sizeof value, sizeof value);
        return value;
    };
    Number sum[n], start[n];
    for (int i = 0; i < n; ++i) sum[i] = factor * (start[i] = at(x, i));
    for (std::size_t A = 1; A < row.size(); ++A) {
        x += stride;
        for (int i = 0; i < n; ++i) sum[i] += row[A] * (at(x, i) - start[i]);
    }
    for (int i = 0; i < n; ++i)
        std::memcpy(reinterpret_cast<char*>(out) + i * sizeof sum[i], &sum[i], sizeof sum[i]);
}

void combine_bodies(const Field& field, int element, std::span<const double> row, double factor,
                    std::span<Matrix34> bodies)
{
    const std::size_t stride = 12 * bodies.size();
    assert(static_cast<std::size_t>(field.n_values) == stride);
    const double* x = field.coefficient(element, 0).data();
    for (std::size_t b = 0; b < bodies.size(); ++b)
        combine<Pair, 6>(x + 12 * b, stride, row, factor, bodies[b].a);
}

}   // namespace

FieldTable::FieldTable(const Field& field, std::span<const double> points) : field_(&field)
{
    const LagrangeBasis basis = field.basis();
    const std::size_t n = static_cast<std::size_t>(basis.size());
    assert(n <= std::tuple_size_v<Row>);
    values_.resize(points.size() * n);
    derivatives_.resize(points.size() * n);
    for (std::size_t k = 0; k < points.size(); ++k) {
        basis.values(points[k], std::span<double>(values_).subspan(k * n, n));
        basis.derivatives(points[k], std::span<double>(derivatives_).subspan(k * n, n));
        const auto node = std::find(basis.nodes().begin(), basis.nodes().end(), points[k]);
        // At a node the coefficient itself is the value, to the bit.
        nodes_.push_back(node == basis.nodes().end() ? -1 : static_cast<int>(node - basis.nodes().begin()));
    }
}

std::span<const double> FieldTable::row(int element, int k, int derivative, Row& scratch) const
{
    const std::size_t n = static_cast<std::size_t>(field_->degree) + 1, at = static_cast<std::size_t>(k) * n;
    const std::span<const double> M(values_.data() + at, n), D(derivatives_.data() + at, n);
    if (field_->denominators.empty()) return derivative == 0 ? M : D;
    Row values;
    std::ranges::copy(M, values.begin());
    std::ranges::copy(D, scratch.begin());
    field_->make_rational(element, std::span(values).first(n), std::span(scratch).first(n));
    if (derivative == 0) scratch = values;
    return std::span(scratch).first(n);
}

void FieldTable::values(int element, int k, std::span<double> out) const
{
    const std::size_t n = static_cast<std::size_t>(field_->n_values);
    assert(out.size() == n);
    if (nodes_[k] >= 0) {
        std::ranges::copy(field_->coefficient(element, nodes_[k]), out.begin());
        return;
    }
    Row scratch;
    const std::span<const double> M = row(element, k, 0, scratch);
    const double* x = field_->coefficient(element, 0).data();
    std::size_t i = 0;
    for (; i + 4 <= n; i += 4) combine<Pair, 2>(x + i, n, M, 1, &out[i]);
    for (; i < n; ++i) combine<double, 1>(x + i, n, M, 1, &out[i]);
}

void FieldTable::values(int element, int k, std::span<Matrix34> bodies) const
{
    if (nodes_[k] >= 0) return unstack(field_->coefficient(element, nodes_[k]), bodies);
    Row scratch;
    combine_bodies(*field_, element, row(element, k, 0, scratch), 1, bodies);
}

void FieldTable::derivatives(int element, int k, double factor, std::span<Matrix34> bodies) const
{
    Row scratch;
    const std::span<const double> D = row(element, k, 1, scratch);
    std::ranges::transform(D, scratch.begin(), [&](double d) { return factor * d; });
    combine_bodies(*field_, element, std::span<const double>(scratch).first(D.size()), 0, bodies);
}

ElementSampler::ElementSampler(const Motion& motion, std::vector<double> points)
    : motion_(motion), points_(std::move(points)), X_(motion.X, points_)
{
    if (!motion.P.empty()) P_.emplace(motion.P, points_);
}

Instant ElementSampler::instant(int element, int k) const
{
    const double s = points_[k];
    // Seen from inside the element: a load that jumps at its end has not jumped yet.
    if (s == 0) return {motion_.mesh.ends[element], Side::right};
    if (s == 1) return {motion_.mesh.ends[element + 1], Side::left};
    return {motion_.mesh.ends[element] + s * motion_.mesh.length(element), Side::middle};
}

void ElementSampler::positions(int element, int k, std::span<Matrix34> X) const { X_.values(element, k, X); }

void ElementSampler::velocities(int element, int k, std::span<Matrix34> V) const
{
    X_.derivatives(element, k, 1 / motion_.mesh.length(element), V);
}

void ElementSampler::momenta(int element, int k, std::span<Matrix34> P) const
{
    assert(P_);
    P_->values(element, k, P);
}

void positions_at_end(const Motion& motion, int end, std::span<Matrix34> X)
{
    if (end == motion.n_elements() && end > 0) return positions_before_end(motion, end, X);
    unstack(motion.X.coefficient(end, 0), X);
}

void positions_before_end(const Motion& motion, int end, std::span<Matrix34> X)
{
    assert(end > 0);
    unstack(motion.X.coefficient(end - 1, motion.X.degree), X);
}

std::span<const Matrix34> velocities_at_end(const Motion& motion, int end)
{
    const std::size_t n = static_cast<std::size_t>(motion.n_bodies);
    assert(motion.velocities.size() == motion.mesh.ends.size() * n);
    return std::span<const Matrix34>(motion.velocities).subspan(static_cast<std::size_t>(end) * n, n);
}

}   // namespace livens::inline diagnostics_internal
