// SPDX-License-Identifier: BSD-3-Clause
// Scales of unknowns and rows, and what is measured in them.
#include <algorithm>
#include <cmath>

#include "livens/spacetime/mixed/equations.h"

namespace livens::mixed {

void Equations::scales(const Fields& fields, std::vector<double>& of_rows,
                       std::vector<double>& of_columns) const
{
    const Coordinates& m = *setup_.coordinates;
    std::vector<double> X(static_cast<std::size_t>(m.n_X()));
    m.spread(fields.X0.data(), X.data());
    std::vector<double> factors(static_cast<std::size_t>(m.n_rows()), 0.0);   // becomes 1 / |G_k m^(-1/2)|
    double gradient[RowTables::gradient_size];
    for (std::size_t i = 0; i < m.gradient_entries.size(); ++i) {
        const GradientEntry& entry = m.gradient_entries[i];
        if (i == 0 || m.gradient_entries[i - 1].row != entry.row)
            m.tables.rows.gradient(m.rows[entry.row], {}, X.data(), gradient);
        const double g = gradient[12 * entry.side + entry.component] / m.root_masses[entry.coordinate];
        factors[entry.row] += g * g;
    }
    for (double& factor : factors) factor = factor > 0 ? 1 / std::sqrt(factor) : 1;

    of_rows.assign(static_cast<std::size_t>(size()), 1.0);
    of_columns.assign(static_cast<std::size_t>(size()), 1.0);
    const auto fill = [](std::vector<double>& scale, int first, int count, auto value) {
        if (first >= 0)
            for (int i = 0; i < count; ++i) scale[first + i] = value(i);
    };
    for (int A = 0; A < setup_.space.size(); ++A) {
        const double h = tables_.lengths[A];
        const auto root = [&](int i) { return m.root_masses[i]; };
        fill(of_columns, numbering_.X(A), m.size, [&](int i) { return h / root(i); });
        fill(of_columns, numbering_.P(A), m.size, root);
        fill(of_rows, numbering_.row_dP(A), m.size, [&](int i) { return root(i) / h; });
        fill(of_rows, numbering_.row_dX(A), m.size, [&](int i) { return 1 / root(i); });
    }
    for (int A = 0; A < setup_.multipliers.size(); ++A) {
        const double h = tables_.lengths[A];
        fill(of_rows, numbering_.row_dlambda(A), m.n_rows(), [&](int k) { return factors[k] / (h * h); });
    }
    for (int e = 0; e < setup_.space.n_elements(); ++e)
        for (int a = 0; a < n_local_multipliers(); ++a) {
            const double h = tables_.lengths[setup_.multipliers.first(e) + a];
            fill(of_columns, numbering_.lambda(first_multiplier(e) + a), m.n_rows(),
                 [&](int k) { return factors[k] / h; });
        }
}

double Equations::size_of(std::span<const double> increment) const
{
    const Coordinates& m = *setup_.coordinates;
    const double length = m.tables.length;
    double size = 0;
    const auto look = [&size](double value) {
        if (!(value <= size) && !std::isnan(size)) size = value;
    };
    for (int A = 0; A < setup_.space.size(); ++A) {
        const int X = numbering_.X(A), P = numbering_.P(A);
        for (int b = 0; b < m.n_bodies(); ++b)
            for (int c = 0; c < m.n_numbers(b); ++c) {
                const int i = m.first[b] + c;
                const double unit = c < 3 ? length : 1, root = m.root_masses[i];
                if (X >= 0) look(std::abs(increment[X + i]) / unit);
                if (P >= 0) look(std::abs(increment[P + i]) * tables_.lengths[A] / (root * root * unit));
            }
    }
    return size;
}

Worst Equations::worst(const std::vector<double>& r, const std::vector<double>& scale) const
{
    const Coordinates& m = *setup_.coordinates;
    Worst worst;
    int at = -1, function = 0;
    enum { definition, balance, constraint } kind = balance;
    const auto look = [&](int A, int first, int count, auto what) {
        for (int i = 0; first >= 0 && i < count; ++i) {
            const double value = std::abs(r[first + i]) * scale[first + i];
            if (value <= worst.value || std::isnan(worst.value)) continue;
            worst.value = value;
            at = i, function = A, kind = what;
            if (std::isnan(value)) return;
        }
    };
    for (int A = 0; A < setup_.space.size(); ++A) {
        look(A, numbering_.row_dP(A), m.size, definition);
        look(A, numbering_.row_dX(A), m.size, balance);
    }
    for (int A = 0; A < setup_.multipliers.size(); ++A)
        look(A, numbering_.row_dlambda(A), m.n_rows(), constraint);
    if (at < 0) return worst;
    worst.t = tables_.centres[function];
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

}   // namespace livens::mixed
