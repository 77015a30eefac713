// SPDX-License-Identifier: BSD-3-Clause
#include "livens/diagnostics/detail/sampler.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace livens {
namespace {

constexpr std::size_t most_nodes = 33;   // of a field: degree 32, the largest of basis_on
using Row = std::array<double, most_nodes>;

void unstack(std::span<const double> stacked, std::span<Matrix34> bodies)
{
    assert(stacked.size() == 12 * bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) std::copy_n(stacked.data() + 12 * b, 12, bodies[b].a);
}

/// out += sum over A of row_A (x_A - x_0), for entries first, first + 1, .. of the coefficients. In
/// differences from the first node, as the basis adds up to one: rounding is that of the change.
void add_changes(const Field& field, int element, std::span<const double> row, std::size_t first,
                 std::span<double> out)
{
    const double* start = field.coefficient(element, 0).data() + first;
    for (int A = 1; A <= field.degree; ++A) {
        const double* x = field.coefficient(element, A).data() + first;
        for (std::size_t i = 0; i < out.size(); ++i) out[i] += row[A] * (x[i] - start[i]);
    }
}

}   // namespace

FieldTable::FieldTable(const Field& field, std::span<const double> points) : field_(&field)
{
    const LagrangeBasis basis = field.basis();
    const std::size_t n = static_cast<std::size_t>(basis.size());
    assert(n <= most_nodes);
    values_.resize(points.size() * n);
    derivatives_.resize(points.size() * n);
    for (std::size_t k = 0; k < points.size(); ++k) {
        basis.values(points[k], std::span<double>(values_).subspan(k * n, n));
        basis.derivatives(points[k], std::span<double>(derivatives_).subspan(k * n, n));
        const auto node = std::find(basis.nodes().begin(), basis.nodes().end(), points[k]);
        nodes_.push_back(node == basis.nodes().end() ? -1 : static_cast<int>(node - basis.nodes().begin()));
    }
}

void FieldTable::fill_row(int element, int k, int derivative, std::span<double> row) const
{
    const std::size_t n = static_cast<std::size_t>(field_->degree) + 1, at = static_cast<std::size_t>(k) * n;
    const std::span<const double> M(values_.data() + at, n), D(derivatives_.data() + at, n);
    std::ranges::copy(derivative == 0 ? M : D, row.begin());
    if (field_->denominators.empty()) return;
    if (derivative == 0) {
        field_->make_rational(element, row.first(n), {});
    } else {
        Row scratch;
        std::ranges::copy(M, scratch.begin());
        field_->make_rational(element, std::span(scratch).first(n), row.first(n));
    }
}

void FieldTable::values(int element, int k, std::span<double> out) const
{
    assert(static_cast<int>(out.size()) == field_->n_values);
    std::ranges::copy(field_->coefficient(element, std::max(nodes_[k], 0)), out.begin());
    if (nodes_[k] >= 0) return;
    Row row;
    fill_row(element, k, 0, row);
    add_changes(*field_, element, row, 0, out);
}

void FieldTable::values(int element, int k, std::span<Matrix34> bodies) const
{
    unstack(field_->coefficient(element, std::max(nodes_[k], 0)), bodies);
    if (nodes_[k] >= 0) return;
    Row row;
    fill_row(element, k, 0, row);
    for (std::size_t b = 0; b < bodies.size(); ++b) add_changes(*field_, element, row, 12 * b, bodies[b].a);
}

void FieldTable::derivatives(int element, int k, double factor, std::span<Matrix34> bodies) const
{
    assert(static_cast<std::size_t>(field_->n_values) == 12 * bodies.size());
    Row row;
    fill_row(element, k, 1, row);
    for (int A = 1; A <= field_->degree; ++A) row[A] *= factor;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        bodies[b] = {};
        add_changes(*field_, element, row, 12 * b, bodies[b].a);
    }
}

ElementSampler::ElementSampler(const Motion& motion, std::vector<double> points)
    : motion_(motion), points_(std::move(points)), X_(motion.X, points_)
{
    if (!motion.P.empty()) P_.emplace(motion.P, points_);
}

Instant ElementSampler::instant(int element, int k) const
{
    const double s = points_[k];
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

}   // namespace livens
