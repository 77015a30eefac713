// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/mixed/equations.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "livens/time/quadrature.h"

namespace livens::mixed {

namespace {

/// out += sum_a weights[a] * (row first + a of a table with n columns).
void combine(const std::vector<double>& table, int first, int n, std::span<const double> weights, double* out)
{
    for (std::size_t a = 0; a < weights.size(); ++a) {
        const double* row =
            table.data() + (static_cast<std::size_t>(first) + a) * static_cast<std::size_t>(n);
        for (int i = 0; i < n; ++i) out[i] += weights[a] * row[i];
    }
}


}   // namespace

Equations::Equations(Setup setup, const Numbering& numbering)
    : setup_(std::move(setup)), numbering_(numbering)
{
    tabulate();
    make_ties();
    const Coordinates& m = *setup_.coordinates;
    for (int l = 0; l < static_cast<int>(m.tables.model->loads().size()); ++l) {
        const Load& load = m.tables.model->loads()[l];
        if (!load.depends_on_X && !load.depends_on_V) continue;
        for (int by = 0; by < 2; ++by)
            for (int of = 0; of < static_cast<int>(load.bodies.size()); ++of) {
                if (load.bodies[by] == world || load.bodies[of] == world) continue;
                load_blocks_.push_back({l, by, of, {}, {}});
            }
    }
}

void Equations::tabulate()
{
    const Quadrature rule = gauss(setup_.gauss_points);
    tables_.gauss_places = rule.points;
    tables_.gauss_weights = rule.weights;
    const TimeSpace& space = setup_.space;
    const std::size_t n_points = static_cast<std::size_t>(space.n_elements()) * rule.points.size();
    tables_.M.resize(n_points * n_local());
    tables_.D.resize(tables_.M.size());
    tables_.L.resize(n_points * n_local_multipliers());
    std::vector<double> unused(static_cast<std::size_t>(n_local_multipliers()));
    std::vector<int> n_elements(static_cast<std::size_t>(space.size()), 0);
    tables_.lengths.assign(n_elements.size(), 0.0);
    tables_.centres.assign(n_elements.size(), 0.0);
    for (int e = 0, n_tears = 0; e < space.n_elements(); ++e) {
        n_tears += std::binary_search(setup_.tears.begin(), setup_.tears.end(), e);
        tables_.n_tears.push_back(n_tears);
        for (int g = 0; g < n_gauss(); ++g) {
            const std::size_t at = static_cast<std::size_t>(e) * rule.points.size() + g;
            const auto part = [&](std::vector<double>& table, int n) {
                return std::span<double>(table).subspan(at * n, n);
            };
            space.evaluate(e, rule.points[g], part(tables_.M, n_local()), part(tables_.D, n_local()));
            setup_.multipliers.evaluate(e, rule.points[g], part(tables_.L, n_local_multipliers()), unused);
        }
        for (int a = 0; a < n_local(); ++a) {
            ++n_elements[space.first(e) + a];
            tables_.lengths[space.first(e) + a] += space.length(e);
            tables_.centres[space.first(e) + a] += space.ends()[e] + 0.5 * space.length(e);
        }
    }
    for (std::size_t A = 0; A < n_elements.size(); ++A) {
        tables_.lengths[A] /= n_elements[A];
        tables_.centres[A] /= n_elements[A];
    }
}

/// Where a row defines the momentum, and on one side of a tear, the multiplier of a function is no unknown.
/// It is tied to the others of its element, where it lives alone, so that the multipliers are of degree p - 1
/// there: their p-th derivative vanishes. In the strong form the one at an end keeps its value.
void Equations::make_ties()
{
    const int p = setup_.multipliers.degree(), last = numbering_.n_multiplier_functions() - 1;
    for (int e = 0; e < setup_.space.n_elements(); ++e)
        for (const int frozen : {first_multiplier(e), first_multiplier(e) + p}) {
            const bool is_end = frozen == 0 || frozen == last;
            if (numbering_.lambda(frozen) >= 0 || (is_end && setup_.start == Mixed::Start::strong)) continue;
            Tie& tie = ties_.emplace_back(Tie{frozen, {}});
            if (is_end && setup_.end_multiplier == Mixed::EndMultiplier::zero) continue;
            const std::vector<double> derivative = setup_.multipliers.highest_derivative(e);
            const int first = first_multiplier(e);
            // Both of an element that has no unknown one between them are zero.
            for (int a = 0; a <= p; ++a)
                if (numbering_.lambda(first + a) >= 0)
                    tie.terms.emplace_back(first + a, -derivative[a] / derivative[frozen - first]);
        }
}

void Equations::tie(Fields& fields) const
{
    const std::size_t n = static_cast<std::size_t>(setup_.coordinates->n_rows());
    for (const Tie& tie : ties_)
        for (std::size_t k = 0; k < n; ++k) {
            double sum = 0;
            for (const auto& [B, factor] : tie.terms) sum += factor * fields.lambda[B * n + k];
            fields.lambda[tie.function * n + k] = sum;
        }
}

Fields Equations::zero_fields() const
{
    const Coordinates& m = *setup_.coordinates;
    const std::size_t n = static_cast<std::size_t>(m.size);
    Fields fields;
    fields.X0.assign(n, 0.0);
    fields.x.assign(n * setup_.space.size(), 0.0);
    fields.P.assign(n * setup_.space.size(), 0.0);
    fields.lambda.assign(static_cast<std::size_t>(m.n_rows()) * numbering_.n_multiplier_functions(), 0.0);
    return fields;
}

void Equations::sample(const Fields& fields, int e, int g)
{
    const Coordinates& m = *setup_.coordinates;
    const int first = setup_.space.first(e), n = m.size;
    const std::span<const double> values(M(e, g), n_local()), rates(D(e, g), n_local());
    sample_.x = fields.X0;
    sample_.v.assign(n, 0.0);
    sample_.p.assign(n, 0.0);
    sample_.lambda.assign(m.n_rows(), 0.0);
    combine(fields.x, first, n, values, sample_.x.data());
    combine(fields.x, first, n, rates, sample_.v.data());
    combine(fields.P, first, n, values, sample_.p.data());
    if (setup_.start == Mixed::Start::strong) {
        sample_.p_rate.assign(n, 0.0);
        combine(fields.P, first, n, rates, sample_.p_rate.data());
    }
    combine(fields.lambda, first_multiplier(e), m.n_rows(),
            {L(e, g), static_cast<std::size_t>(n_local_multipliers())}, sample_.lambda.data());
    for (auto* v : {&sample_.X, &sample_.V, &sample_.F}) v->resize(m.n_X());
    m.spread(sample_.x.data(), sample_.X.data());
    m.spread(sample_.v.data(), sample_.V.data());
}

std::string Equations::residual(const Fields& fields, std::vector<double>& r)
{
    const Coordinates& m = *setup_.coordinates;
    const std::size_t n = static_cast<std::size_t>(m.size);
    std::string bad;
    const std::vector<Load>& loads = m.tables.model->loads();
    raw_.dP.assign(n * setup_.space.size(), 0.0);
    raw_.dX.assign(n * setup_.space.size(), 0.0);
    raw_.dlambda.assign(static_cast<std::size_t>(m.n_rows()) * setup_.multipliers.size(), 0.0);
    for (int e = 0; e < setup_.space.n_elements(); ++e)
        for (int g = 0; g < n_gauss(); ++g) {
            sample(fields, e, g);
            m.forces(time(e, g), sample_.X.data(), sample_.V.data(), sample_.lambda.data(), sample_.F.data());
            double sum = 0;
            for (const double f : sample_.F) sum += std::abs(f);
            if (!std::isfinite(sum)) {
                const int load =
                    m.tables.loads.bad({time(e, g), Side::middle}, sample_.X.data(), sample_.V.data());
                if (load >= 0) bad = not_finite(loads[load]);
            }
            add_rows(e, g);
        }
    r.assign(static_cast<std::size_t>(size()), 0.0);
    const auto take = [&r](int to, const std::vector<double>& raw, int A, int count) {
        if (to >= 0) std::copy_n(raw.data() + static_cast<std::size_t>(A) * count, count, r.data() + to);
    };
    for (int A = 0; A < setup_.space.size(); ++A) {
        take(numbering_.row_dP(A), raw_.dP, A, m.size);
        take(numbering_.row_dX(A), raw_.dX, A, m.size);
    }
    for (int A = 0; A < setup_.multipliers.size(); ++A)
        take(numbering_.row_dlambda(A), raw_.dlambda, A, m.n_rows());
    add_boundary(fields, r);
    return bad;
}

/// What one Gauss point adds to all rows.
void Equations::add_rows(int e, int g)
{
    const Coordinates& m = *setup_.coordinates;
    const int first = setup_.space.first(e);
    const double w = weight(e, g);
    const bool is_natural = setup_.start == Mixed::Start::natural;
    for (int b = 0; b < m.n_bodies(); ++b) {
        Matrix34 P{};
        std::copy_n(sample_.p.data() + m.first[b], m.n_numbers(b), P.a);
        Matrix34 slip = -P * m.inverse_masses[b];
        for (int c = 0; c < 12; ++c) slip.a[c] += sample_.V[12 * b + c];
        for (int a = 0; a < n_local(); ++a) {
            const double value = w * M(e, g)[a], rate = w * D(e, g)[a];
            const std::size_t at = static_cast<std::size_t>(first + a) * m.size + m.first[b];
            for (int c = 0; c < m.n_numbers(b); ++c) {
                raw_.dP[at + c] += value * slip.a[c];
                const double inertia = is_natural ? -rate * P.a[c] : value * sample_.p_rate[m.first[b] + c];
                raw_.dX[at + c] += inertia - value * sample_.F[12 * b + c];
            }
        }
    }
    for (int k = 0; k < m.n_rows(); ++k) {
        const double phi = w * m.tables.rows.value(m.rows[k], {}, sample_.X.data());
        for (int a = 0; a < n_local_multipliers(); ++a) {
            const int A = setup_.multipliers.first(e) + a;
            raw_.dlambda[static_cast<std::size_t>(A) * m.n_rows() + k] += L(e, g)[a] * phi;
        }
    }
}

/// P at an end where it is given; X there is X0 + x_A.
std::vector<Matrix34> Equations::given_momentum(const Fields& fields, bool at_end) const
{
    const EndMomentum& given = at_end ? setup_.at_end : setup_.at_start;
    if (given.turning.empty()) return given.fixed;
    const std::vector<Matrix34> X = end_position(fields, at_end);
    std::vector<Matrix34> P;
    for (std::size_t b = 0; b < X.size(); ++b) P.push_back(given.turning[b].at(X[b]));
    return P;
}

std::vector<Matrix34> Equations::end_position(const Fields& fields, bool at_end) const
{
    const Coordinates& m = *setup_.coordinates;
    const std::size_t A = at_end ? static_cast<std::size_t>(setup_.space.size()) - 1 : 0;
    std::vector<double> x = fields.X0;
    for (int i = 0; i < m.size; ++i) x[i] += fields.x[A * m.size + i];
    return m.bodies(x.data());
}

/// Natural start: -P(0) in row 0 and P(T) in row n.
void Equations::add_boundary(const Fields& fields, std::vector<double>& r) const
{
    if (setup_.start != Mixed::Start::natural) return;
    const Coordinates& m = *setup_.coordinates;
    for (const bool at_end : {false, true}) {
        const int row = numbering_.row_dX(at_end ? setup_.space.size() - 1 : 0);
        if (row < 0) continue;
        const std::vector<double> p = m.gather(given_momentum(fields, at_end));
        for (int i = 0; i < m.size; ++i) r[row + i] += at_end ? p[i] : -p[i];
    }
}

std::vector<Matrix34> Equations::end_momentum(const Fields& fields, bool at_end) const
{
    const Coordinates& m = *setup_.coordinates;
    const int A = at_end ? setup_.space.size() - 1 : 0;
    const std::size_t at = static_cast<std::size_t>(A) * m.size;
    if (setup_.start == Mixed::Start::strong) return m.bodies(fields.P.data() + at);
    if (numbering_.row_dX(A) >= 0) return given_momentum(fields, at_end);
    std::vector<double> p(raw_.dX.begin() + at, raw_.dX.begin() + at + m.size);
    if (at_end)
        for (double& value : p) value = -value;
    return m.bodies(p.data());
}

void Equations::add(Fields& fields, std::span<const double> increment, double factor) const
{
    const Coordinates& m = *setup_.coordinates;
    const auto move = [&](std::vector<double>& values, int A, int from, int count) {
        if (from < 0) return;
        double* to = values.data() + static_cast<std::size_t>(A) * count;
        for (int i = 0; i < count; ++i) to[i] += factor * increment[from + i];
    };
    for (int A = 0; A < setup_.space.size(); ++A) {
        move(fields.x, A, numbering_.X(A), m.size);
        move(fields.P, A, numbering_.P(A), m.size);
    }
    for (int A = 0; A < numbering_.n_multiplier_functions(); ++A)
        move(fields.lambda, A, numbering_.lambda(A), m.n_rows());
    tie(fields);
}

void Equations::evaluate(const TimeSpace& space, int first, const std::vector<double>& coefficients, int n,
                         int element, double s, double* out) const
{
    std::array<double, 9> values{}, rates{};
    const std::size_t count = static_cast<std::size_t>(space.degree()) + 1;
    space.evaluate(element, s, {values.data(), count}, {rates.data(), count});
    combine(coefficients, first, n, {values.data(), count}, out);
}

void Equations::evaluate_X(const Fields& fields, int element, double s, double* X) const
{
    std::copy(fields.X0.begin(), fields.X0.end(), X);
    evaluate(setup_.space, setup_.space.first(element), fields.x, setup_.coordinates->size, element, s, X);
}

void Equations::evaluate_P(const Fields& fields, int element, double s, double* P) const
{
    std::fill_n(P, setup_.coordinates->size, 0.0);
    evaluate(setup_.space, setup_.space.first(element), fields.P, setup_.coordinates->size, element, s, P);
}

void Equations::evaluate_multipliers(const Fields& fields, int element, double s, double* lambda) const
{
    std::fill_n(lambda, setup_.coordinates->n_rows(), 0.0);
    evaluate(setup_.multipliers, first_multiplier(element), fields.lambda, setup_.coordinates->n_rows(),
             element, s, lambda);
}

}   // namespace livens::mixed
