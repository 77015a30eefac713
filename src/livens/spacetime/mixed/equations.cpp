// SPDX-License-Identifier: BSD-3-Clause
// The rows (P23) of one block by Gauss points: X' = P m^-1, the law with (P10) or without (P11) integration
// by parts, and the constraints, each tested with functions of time (docs/theory.md, "The elements of the
// paper").
#include "livens/spacetime/mixed/equations.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/multibody/model.h"
#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"

namespace livens::mixed {

Equations::Equations(FieldSpace space, EndMomentum at_start, EndMomentum at_end)
    : space_(std::move(space)), at_start_(std::move(at_start)), at_end_(std::move(at_end))
{}

std::string Equations::residual(const Fields& fields, std::vector<double>& r)
{
    const BlockFunctions& functions = space_.functions;
    const Coordinates& m = space_.coordinates;
    const Numbering& numbering = space_.numbering;
    dP_.resize(static_cast<std::size_t>(m.size) * functions.space().size());
    dX_.resize(dP_.size());
    dlambda_.resize(static_cast<std::size_t>(m.n_rows()) * functions.multipliers().size());
    r.resize(static_cast<std::size_t>(space_.size()));   // of which each is of a function
    workspaces_.resize(static_cast<std::size_t>(Crew::size()));
    for (Workspace& at : workspaces_) {
        at.bad.clear();
        at.n_formed = 0;
    }
    const auto take = [&r](int to, const std::vector<double>& raw, int A, int count) {
        if (to >= 0) std::copy_n(raw.data() + static_cast<std::size_t>(A) * count, count, r.data() + to);
    };
    // A thread makes all elements of its functions: those that it shares with others twice, so that sums at
    // a function are made in one order, whoever makes them.
    in_shares(functions.space().size(), least_shared_functions, [&](int slot, int begin, int end) {
        Workspace& at = workspaces_[slot];
        at.begin = begin;
        at.end = end;
        const int multipliers_end = std::min(end, functions.multipliers().size());
        std::fill(dP_.begin() + begin * m.size, dP_.begin() + end * m.size, 0.0);
        std::fill(dX_.begin() + begin * m.size, dX_.begin() + end * m.size, 0.0);
        if (begin < multipliers_end)
            std::fill(dlambda_.begin() + begin * m.n_rows(), dlambda_.begin() + multipliers_end * m.n_rows(),
                      0.0);
        add_elements(fields, at);
        for (int A = begin; A < end; ++A) {
            take(numbering.row_dP(A), dP_, A, m.size);
            take(numbering.row_dX(A), dX_, A, m.size);
            if (A < multipliers_end) take(numbering.row_dlambda(A), dlambda_, A, m.n_rows());
        }
    });
    std::string bad;
    for (Workspace& at : workspaces_)
        if (!at.bad.empty()) bad = std::move(at.bad);
    add_boundary(fields, r);
    return bad;
}

int Equations::n_formed() const
{
    int n = 0;
    for (const Workspace& at : workspaces_) n += at.n_formed;
    return n;
}

void Equations::add_elements(const Fields& fields, Workspace& at)
{
    const BlockFunctions& functions = space_.functions;
    const Coordinates& m = space_.coordinates;
    at.F.resize(static_cast<std::size_t>(m.n_X()));
    const auto [first, last] = functions.elements_of(at.begin, at.end);
    at.n_formed = last - first;
    for (int e = first; e < last; ++e) {
        Patience::ask();
        for (int g = 0; g < functions.n_gauss(); ++g) {
            at.sample.take(space_, fields, e, g);
            const double t = functions.time(e, g);
            m.forces(t, at.sample.X.data(), at.sample.V.data(), at.sample.lambda.data(), at.F.data());
            double sum = 0;   // is finite where all are
            for (const double f : at.F) sum += std::abs(f);
            if (!std::isfinite(sum)) {
                const int load =
                    m.tables.loads.bad({t, Side::middle}, at.sample.X.data(), at.sample.V.data());
                if (load >= 0) at.bad = not_finite(m.tables.model->loads()[load]);
            }
            add_point(e, g, at);
        }
    }
}

/// What one Gauss point adds to all rows of the thread's functions.
void Equations::add_point(int e, int g, const Workspace& at)
{
    const FieldSample& sample = at.sample;
    const BlockFunctions& functions = space_.functions;
    const Coordinates& m = space_.coordinates;
    const double w = functions.weight(e, g);
    const double *M = functions.M(e, g), *D = functions.D(e, g), *L = functions.L(e, g);
    for (int b = 0; b < m.n_bodies(); ++b) {
        Matrix34 P{};
        std::copy_n(sample.p.data() + m.first[b], m.n_numbers(b), P.a);
        Matrix34 slip = -P * m.inverse_masses[b];
        for (int c = 0; c < 12; ++c) slip.a[c] += sample.V[12 * b + c];
        for (int a = 0; a < functions.n_local(); ++a) {
            if (functions.first(e) + a < at.begin || functions.first(e) + a >= at.end) continue;
            const double value = w * M[a], rate = w * D[a];
            const std::size_t place = static_cast<std::size_t>(functions.first(e) + a) * m.size + m.first[b];
            for (int c = 0; c < m.n_numbers(b); ++c) {
                dP_[place + c] += value * slip.a[c];
                const double inertia =
                    space_.is_natural ? -rate * P.a[c] : value * sample.p_rate[m.first[b] + c];
                dX_[place + c] += inertia - value * at.F[12 * b + c];
            }
        }
    }
    for (int k = 0; k < m.n_rows(); ++k) {
        const double phi = w * m.tables.rows.value(m.rows[k], {}, sample.X.data());
        for (int a = 0; a < functions.n_local_multipliers(); ++a) {
            const int A = functions.multipliers().first(e) + a;
            if (A < at.begin || A >= at.end) continue;
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

/// Strong: the value of the field. Natural: what is given, or what the row of the end defines, which is not
/// solved then.
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
