// SPDX-License-Identifier: BSD-3-Clause
// Scales of the whole matrix by mass, element length and |G m^(-1/2)|, after which its blocks are of size one
// whatever the units; without them its condition number grows like h^-3 (docs/theory.md, "The elements of the
// paper": Scaling). Increments and residuals are measured in the same units.
#include "livens/spacetime/mixed/scaling.h"

#include <algorithm>
#include <cmath>

#include "livens/multibody/model.h"
#include "livens/solvers/crew.h"

namespace livens::mixed {

void Scaling::set(const Fields& fields)
{
    const Coordinates& m = space_.coordinates;
    const BlockFunctions& functions = space_.functions;
    const Numbering& numbering = space_.numbering;
    std::vector<double> X(static_cast<std::size_t>(m.n_X())), gradients;
    m.spread(fields.X0.data(), X.data());
    m.gradients(X.data(), gradients);
    std::vector<double> factors(static_cast<std::size_t>(m.n_rows()), 0.0);   // becomes 1 / |G_k m^(-1/2)|
    for (std::size_t i = 0; i < gradients.size(); ++i) {
        const double g = gradients[i] / m.root_masses[m.gradient_entries[i].coordinate];
        factors[m.gradient_entries[i].row] += g * g;
    }
    for (double& factor : factors) factor = factor > 0 ? 1 / std::sqrt(factor) : 1;

    rows_.assign(static_cast<std::size_t>(space_.size()), 1.0);
    columns_.assign(rows_.size(), 1.0);
    const auto fill = [](std::vector<double>& scale, int first, int count, auto value) {
        if (first >= 0)
            for (int i = 0; i < count; ++i) scale[first + i] = value(i);
    };
    for (int A = 0; A < functions.space().size(); ++A) {
        const double h = functions.length(A);
        const auto root = [&](int i) { return m.root_masses[i]; };
        fill(columns_, numbering.X(A), m.size, [&](int i) { return h / root(i); });
        fill(columns_, numbering.P(A), m.size, root);
        fill(rows_, numbering.row_dP(A), m.size, [&](int i) { return root(i) / h; });
        fill(rows_, numbering.row_dX(A), m.size, [&](int i) { return 1 / root(i); });
    }
    for (int A = 0; A < functions.multipliers().size(); ++A) {
        const double h = functions.length(A);
        fill(rows_, numbering.row_dlambda(A), m.n_rows(), [&](int k) { return factors[k] / (h * h); });
    }
    for (int e = 0; e < functions.n_elements(); ++e)
        for (int a = 0; a < functions.n_local_multipliers(); ++a) {
            const double h = functions.length(functions.multipliers().first(e) + a);
            fill(columns_, numbering.lambda(functions.first_multiplier(e) + a), m.n_rows(),
                 [&](int k) { return factors[k] / h; });
        }
}

/// Of all that look_at(A, look) shows; nan, once seen, stays.
template <class LookAt>
double Scaling::largest_of_functions(const LookAt& look_at) const
{
    const auto larger = [](double size, double value) {
        return !(value <= size) && !std::isnan(size) ? value : size;
    };
    std::vector<double> sizes(static_cast<std::size_t>(Crew::size()), 0.0);
    in_shares(space_.numbering.n_functions(), least_shared_functions, [&](int slot, int begin, int end) {
        double size = 0;
        for (int A = begin; A < end; ++A) look_at(A, [&](double value) { size = larger(size, value); });
        sizes[static_cast<std::size_t>(slot)] = size;
    });
    double size = 0;
    for (const double of_thread : sizes) size = larger(size, of_thread);
    return size;
}

double Scaling::size_of(std::span<const double> increment) const
{
    const Coordinates& m = space_.coordinates;
    const double length = m.tables.length;
    return largest_of_functions([&](int A, auto look) {
        const int X = space_.numbering.X(A), P = space_.numbering.P(A);
        for (int b = 0; b < m.n_bodies(); ++b)
            for (int c = 0; c < m.n_numbers(b); ++c) {
                const int i = m.first[b] + c;
                const double unit = c < 3 ? length : 1, root = m.root_masses[i];
                if (X >= 0) look(std::abs(increment[X + i]) / unit);
                if (P >= 0)
                    look(std::abs(increment[P + i]) * space_.functions.length(A) / (root * root * unit));
            }
    });
}

Worst Scaling::worst(const std::vector<double>& r) const
{
    const Coordinates& m = space_.coordinates;
    const Numbering& numbering = space_.numbering;
    Worst worst;
    int at = -1, function = 0;
    enum { definition, balance, constraint } kind = balance;
    const auto look = [&](int A, int first, int count, auto what) {
        for (int i = 0; first >= 0 && i < count; ++i) {
            const double value = std::abs(r[first + i]) * rows_[first + i];
            if (value <= worst.value || std::isnan(worst.value)) continue;
            worst.value = value;
            at = i, function = A, kind = what;
            if (std::isnan(value)) return;
        }
    };
    for (int A = 0; A < numbering.n_functions(); ++A) {
        look(A, numbering.row_dP(A), m.size, definition);
        look(A, numbering.row_dX(A), m.size, balance);
    }
    for (int A = 0; A < space_.functions.multipliers().size(); ++A)
        look(A, numbering.row_dlambda(A), m.n_rows(), constraint);
    if (at < 0) return worst;
    worst.t = space_.functions.centre(function);
    if (kind == constraint) {
        worst.name = m.row_name(at);
        return worst;
    }
    int body = m.n_bodies() - 1;
    while (m.first[body] > at) --body;
    worst.name = std::string(kind == balance ? "the balance of momentum" : "the velocity") + " of body '" +
                 m.tables.model->body_name(body) + "'";
    return worst;
}

double Scaling::largest(const Fields& fields) const
{
    const Coordinates& m = space_.coordinates;
    const Numbering& n = space_.numbering;
    double result = largest_of_functions([&](int A, auto look) {
        for (int i = 0; i < m.size; ++i)
            if (const double size = std::abs(fields.P[A * m.size + i]) / m.root_masses[i]; !std::isnan(size))
                look(size);
    });
    for (int A = 0; A < n.n_multiplier_functions(); ++A)
        for (int k = 0; n.lambda(A) >= 0 && k < m.n_rows(); ++k)
            result =
                std::max(result, std::abs(fields.lambda[A * m.n_rows() + k]) / columns_[n.lambda(A) + k]);
    return result;
}

}   // namespace livens::mixed
