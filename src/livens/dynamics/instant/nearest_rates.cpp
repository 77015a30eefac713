// SPDX-License-Identifier: BSD-3-Clause
// The rates nearest to V in the mass metric are those that an instant has of the momentum of V.
#include "livens/dynamics/instant/nearest_rates.h"

#include <algorithm>
#include <cassert>

#include "livens/dynamics/rows/projection.h"
#include "livens/multibody/model.h"

namespace livens::inline dynamics_internal {

NearestRates::NearestRates(const Model& model, std::span<const int> rows)
    : tables_(model, {rows.begin(), rows.end()}),
      is_sparse_(JointFactor::serves(tables_) && tables_.rows.are_quadratic()), instant_(tables_, is_sparse_),
      raw_(12 * tables_.bodies.size(), 0.0), momentum_(static_cast<std::size_t>(tables_.n_twists), 0.0),
      multipliers_(static_cast<std::size_t>(tables_.n_rows()), 0.0)
{
    assert(!model.has_drives());
    state_.resize(tables_);
}

std::vector<Matrix34> NearestRates::at(double t, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    if (!is_sparse_ || X.empty() || !project(t, X, V))
        return nearest_rates(*tables_.model, X, V, tables_.independent);
    std::vector<Matrix34> rates(X.size());
    tables_.bodies.rates_of(state_.X.data(), state_.velocity.data(), rates.data()->a);
    return rates;
}

/// False: other rows hold better there, or none of them well.
bool NearestRates::project(double t, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    state_.t = t;
    for (std::size_t b = 0; b < X.size(); ++b) std::copy_n(X[b].a, 12, state_.X.begin() + 12 * b);
    if (!instant_.prepare(state_, tables_.independent) || state_.held.are_new || !state_.held.by_joints)
        return false;
    tables_.bodies.times_mass(V.data()->a, 1.0, raw_.data());
    tables_.bodies.twist_rows(state_.X.data(), state_.maps.data(), raw_.data(), momentum_.data());
    instant_.from_momentum(state_, momentum_.data(), 1, multipliers_.data());
    return true;
}

}   // namespace livens::inline dynamics_internal
