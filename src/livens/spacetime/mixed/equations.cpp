// SPDX-License-Identifier: BSD-3-Clause
// The rows (P23) of one block by Gauss points: X' = P m^-1, the law with (P10) or without (P11) integration
// by parts, and the constraints, each tested with functions of time (docs/theory.md, "The elements of the
// paper").
#include "livens/spacetime/mixed/equations.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace livens::mixed {

Equations::Equations(FieldSpace space, EndMomentum at_start, EndMomentum at_end)
    : space_(std::move(space)), at_start_(std::move(at_start)), at_end_(std::move(at_end))
{}

std::string Equations::residual(const Fields& fields, std::vector<double>& r)
{
    const BlockFunctions& functions = space_.functions;
    const Coordinates& m = space_.coordinates;
    const Numbering& numbering = space_.numbering;
    std::string bad;
    dP_.assign(static_cast<std::size_t>(m.size) * functions.space().size(), 0.0);
    dX_.assign(dP_.size(), 0.0);
    dlambda_.assign(static_cast<std::size_t>(m.n_rows()) * functions.multipliers().size(), 0.0);
    F_.resize(m.n_X());
    for (int e = 0; e < functions.n_elements(); ++e)
        for (int g = 0; g < functions.n_gauss(); ++g) {
            sample_.take(space_, fields, e, g);
            const double t = functions.time(e, g);
            m.forces(t, sample_.X.data(), sample_.V.data(), sample_.lambda.data(), F_.data());
            double sum = 0;   // is finite where all are
            for (const double f : F_) sum += std::abs(f);
            if (!std::isfinite(sum)) {
                const int load = m.tables.loads.bad({t, Side::middle}, sample_.X.data(), sample_.V.data());
                if (load >= 0) bad = not_finite(m.tables.model->loads()[load]);
            }
            add_point(e, g);
        }
    r.assign(static_cast<std::size_t>(space_.size()), 0.0);
    const auto take = [&r](int to, const std::vector<double>& raw, int A, int count) {
        if (to >= 0) std::copy_n(raw.data() + static_cast<std::size_t>(A) * count, count, r.data() + to);
    };
    for (int A = 0; A < functions.space().size(); ++A) {
        take(numbering.row_dP(A), dP_, A, m.size);
        take(numbering.row_dX(A), dX_, A, m.size);
    }
    for (int A = 0; A < functions.multipliers().size(); ++A)
        take(numbering.row_dlambda(A), dlambda_, A, m.n_rows());
    add_boundary(fields, r);
    return bad;
}

/// What one Gauss point adds to all rows.
void Equations::add_point(int e, int g)
{
    const BlockFunctions& functions = space_.functions;
    const Coordinates& m = space_.coordinates;
    const double w = functions.weight(e, g);
    const double *M = functions.M(e, g), *D = functions.D(e, g), *L = functions.L(e, g);
    for (int b = 0; b < m.n_bodies(); ++b) {
        Matrix34 P{};
        std::copy_n(sample_.p.data() + m.first[b], m.n_numbers(b), P.a);
        Matrix34 slip = -P * m.inverse_masses[b];
        for (int c = 0; c < 12; ++c) slip.a[c] += sample_.V[12 * b + c];
        for (int a = 0; a < functions.n_local(); ++a) {
            const double value = w * M[a], rate = w * D[a];
            const std::size_t at = static_cast<std::size_t>(functions.first(e) + a) * m.size + m.first[b];
            for (int c = 0; c < m.n_numbers(b); ++c) {
                dP_[at + c] += value * slip.a[c];
                const double inertia =
                    space_.is_natural ? -rate * P.a[c] : value * sample_.p_rate[m.first[b] + c];
                dX_[at + c] += inertia - value * F_[12 * b + c];
            }
        }
    }
    for (int k = 0; k < m.n_rows(); ++k) {
        const double phi = w * m.tables.rows.value(m.rows[k], {}, sample_.X.data());
        for (int a = 0; a < functions.n_local_multipliers(); ++a) {
            const int A = functions.multipliers().first(e) + a;
            dlambda_[static_cast<std::size_t>(A) * m.n_rows() + k] += L[a] * phi;
        }
    }
}

/// P at an end where it is given; X there is X0 + x_A.
std::vector<Matrix34> Equations::given_momentum(const Fields& fields, bool at_end) const
{
    if (given(at_end).turning.empty()) return given(at_end).fixed;
    const std::vector<Matrix34> X = space_.end_position(fields, at_end);
    std::vector<Matrix34> P;
    for (std::size_t b = 0; b < X.size(); ++b) P.push_back(given(at_end).turning[b].at(X[b]));
    return P;
}

/// Natural start: -P(0) in row 0 and P(T) in row n.
void Equations::add_boundary(const Fields& fields, std::vector<double>& r) const
{
    if (!space_.is_natural) return;
    const Coordinates& m = space_.coordinates;
    for (const bool at_end : {false, true}) {
        const int row = space_.numbering.row_dX(at_end ? space_.numbering.n_functions() - 1 : 0);
        if (row < 0) continue;
        const std::vector<double> p = m.gather(given_momentum(fields, at_end));
        for (int i = 0; i < m.size; ++i) r[row + i] += at_end ? p[i] : -p[i];
    }
}

std::vector<Matrix34> Equations::end_momentum(const Fields& fields, bool at_end) const
{
    const Coordinates& m = space_.coordinates;
    const int A = at_end ? space_.numbering.n_functions() - 1 : 0;
    const std::size_t at = static_cast<std::size_t>(A) * m.size;
    if (!space_.is_natural) return m.bodies(fields.P.data() + at);
    if (space_.numbering.row_dX(A) >= 0) return given_momentum(fields, at_end);
    std::vector<double> p(dX_.begin() + at, dX_.begin() + at + m.size);   // what the row lacks is P(0), -P(T)
    if (at_end)
        for (double& value : p) value = -value;
    return m.bodies(p.data());
}

}   // namespace livens::mixed
