// SPDX-License-Identifier: BSD-3-Clause
// Fields of a motion at the same points of every element: the values of the basis are made once, and each
// evaluation is a product with coefficients. Diagnostics integrate with the rules of the method (theory.md,
// "What is diagnosed").
#include "livens/diagnostics/detail/sampler.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

#include "livens/diagnostics/detail/pairs.h"
#include "livens/diagnostics/detail/point_kernels.h"

namespace livens::inline diagnostics_internal {
namespace {

void unstack(std::span<const double> stacked, std::span<Matrix34> bodies)
{
    assert(stacked.size() == 12 * bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) std::copy_n(stacked.data() + 12 * b, 12, bodies[b].a);
}

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

void differences_of(const Field& field, int element, double factor, std::vector<double>& d)
{
    const auto n = static_cast<std::size_t>(field.n_values);
    d.resize(n * static_cast<std::size_t>(field.degree));
    const double* const first = field.coefficient(element, 0).data();
    const double* x = first + n;
    for (std::size_t A = 0; A < d.size(); A += n, x += n)
        for (std::size_t i = 0; i < n; ++i) d[A + i] = factor * (x[i] - first[i]);
}

void multiply(const ConstantMatrix& M, const double* d, int n, double* out)
{
    if (M.columns == 0) return void(std::fill_n(out, static_cast<std::ptrdiff_t>(M.rows) * n, 0.0));
    point_kernels().multiply(M.entries, M.rows, M.columns, M.stride, d, n, out);
}

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

/// From differences of the coefficients; of quotients point by point.
/// Column 0 of the tables has no part in it: differences are those from node 0.
void FieldTable::sum_up(int element, int derivative, std::span<const double> d, std::span<double> out) const
{
    const auto n = static_cast<std::size_t>(field_->n_values);
    const int n_points = static_cast<int>(nodes_.size()), size = field_->degree + 1;
    assert(out.size() == n * nodes_.size());
    if (field_->denominators.empty()) {
        const double* const table = (derivative == 0 ? values_ : derivatives_).data();
        multiply({table + 1, n_points, size - 1, size}, d.data(), static_cast<int>(n), out.data());
        return;
    }
    Row scratch;
    for (int k = 0; k < n_points; ++k)
        multiply({row(element, k, derivative, scratch).data() + 1, 1, size - 1, size}, d.data(),
                 static_cast<int>(n), out.data() + static_cast<std::size_t>(k) * n);
}

/// To sums of differences; at nodes the coefficients themselves.
void FieldTable::add_first(int element, std::span<double> values) const
{
    const auto n = static_cast<std::size_t>(field_->n_values);
    const double* const first = field_->coefficient(element, 0).data();
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
        double* const at = values.data() + k * n;
        if (nodes_[k] >= 0)
            std::ranges::copy(field_->coefficient(element, nodes_[k]), at);
        else
            for (std::size_t i = 0; i < n; ++i) at[i] += first[i];
    }
}

void FieldTable::all_values(int element, std::span<double> out) const
{
    std::vector<double> d;
    differences_of(*field_, element, 1, d);
    sum_up(element, 0, d, out);
    add_first(element, out);
}

void FieldTable::all_derivatives(int element, double factor, std::span<double> out) const
{
    std::vector<double> d;
    differences_of(*field_, element, factor, d);
    sum_up(element, 1, d, out);
}

void FieldTable::all_of_both(int element, double factor, std::span<double> values,
                             std::span<double> derivatives) const
{
    std::vector<double> d;
    differences_of(*field_, element, 1, d);
    sum_up(element, 0, d, values);
    add_first(element, values);
    for (double& x : d) x *= factor;
    sum_up(element, 1, d, derivatives);
}

ElementSampler::ElementSampler(const Motion& motion, std::vector<double> points)
    : motion_(motion), points_(std::move(points)), X_(motion.X, points_)
{
    if (!motion.P.empty()) P_.emplace(motion.P, points_);
}

std::vector<double> field_at(const Field& field, const TimeMesh& mesh, double t)
{
    const int element = mesh.element_at(t);
    std::vector<double> values(static_cast<std::size_t>(field.n_values));
    field.evaluate(element, (t - mesh.ends[element]) / mesh.length(element), 0, values);
    return values;
}

Instant instant_at(const TimeMesh& mesh, int element, double s)
{
    // Seen from inside the element: a load that jumps at its end has not jumped yet.
    if (s == 0) return {mesh.ends[element], Side::right};
    if (s == 1) return {mesh.ends[element + 1], Side::left};
    return {mesh.ends[element] + s * mesh.length(element), Side::middle};
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

std::span<const Matrix34> velocities_at_end(const Motion& motion, int end, Side side)
{
    const std::size_t n = static_cast<std::size_t>(motion.n_bodies);
    assert(motion.velocities.size() == motion.mesh.ends.size() * n);
    const int impact = side == Side::left ? motion.impacts.at(end) : -1;
    if (impact >= 0)
        return std::span<const Matrix34>(motion.impacts.velocities)
            .subspan(static_cast<std::size_t>(impact) * n, n);
    return std::span<const Matrix34>(motion.velocities).subspan(static_cast<std::size_t>(end) * n, n);
}

}   // namespace livens::inline diagnostics_internal
