// SPDX-License-Identifier: BSD-3-Clause
// theory.md, "Conditions by component": the chart of an end is a move along free motions, a pull onto the
// joints, and momenta that stay what they are in world axes but for what the joints take off.
#include "livens/spacetime/march/end_point.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "livens/dynamics/rows/tables.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/model.h"

namespace livens::inline spacetime_internal {

namespace {

constexpr double step_of_places = 1e-3;   // lengths and radians
constexpr double step_of_rates = 1e-2;    // of the rate that matters

/// Momenta about the centres of mass, or back to the reference points.
void shift_moments(const BodyTables& bodies, const double* maps, double sign, std::vector<double>& p)
{
    for (int b = 0; b < bodies.n_bodies(); ++b) {
        if (bodies[b].dofs == 3) continue;
        const double* c = maps + 12 * b + 9;
        double* q = p.data() + bodies[b].first;
        q[3] -= sign * (c[1] * q[2] - c[2] * q[1]);
        q[4] -= sign * (c[2] * q[0] - c[0] * q[2]);
        q[5] -= sign * (c[0] * q[1] - c[1] * q[0]);
    }
}

}   // namespace

EndPoint::EndPoint(const ModelTables& tables)
    : tables_(tables), instant_(tables), momenta_(static_cast<std::size_t>(tables.n_twists))
{
    state_.resize(tables);
    for (const Body& body : tables.model->bodies()) stated_.push_back(body.X);
    X_ = V_ = stated_;
}

bool EndPoint::place(double t, const double* X, const double* X_low, const std::vector<double>& momenta)
{
    state_.t = t;
    std::copy_n(X, state_.X.size(), state_.X.begin());
    if (X_low != nullptr)
        std::copy_n(X_low, state_.X.size(), state_.X_low.begin());
    else
        std::ranges::fill(state_.X_low, 0.0);
    return instant_.prepare(state_, tables_.independent) && finish(momenta);
}

/// P = V m of each body as the six numbers N^T P about its reference point; a place off the joints is pulled
/// onto them while these stay what they are.
bool EndPoint::place(const State& given)
{
    std::vector<double> momenta(momenta_.size());
    double six[6];
    state_.t = given.t;
    std::ranges::fill(state_.X_low, 0.0);
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const auto& body = tables_.bodies[b];
        std::copy_n(given.X[b].a, 12, state_.X.begin() + 12 * b);
        const Matrix34 P = given.V[b] * tables_.model->bodies()[b].mass;
        twist::rows(given.X[b].a, P.a, six);
        std::copy_n(six, body.dofs, momenta.begin() + body.first);
    }
    if (!instant_.prepare(state_, tables_.independent)) return false;
    instant_.close(state_);
    return finish(momenta);
}

bool EndPoint::place_moved(const EndPoint& from, const double* scaled_twist,
                           const std::vector<double>& momenta)
{
    std::vector<double> twist(momenta_.size());
    std::array<double, 12> dX{};
    state_.t = from.state_.t;
    std::ranges::fill(state_.X_low, 0.0);
    tables_.bodies.to_twist(from.state_.maps.data(), scaled_twist, twist.data());
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const auto& body = tables_.bodies[b];
        const double* X = from.state_.X.data() + 12 * b;
        dX.fill(0);
        if (body.dofs == 6)
            twist::displacement(twist.data() + body.first, X, dX.data());
        else
            std::copy_n(twist.begin() + body.first, 3, dX.begin());
        for (int i = 0; i < 12; ++i) state_.X[12 * b + i] = X[i] + dX[i];
    }
    return instant_.prepare(state_, from.state_.held.rows) && instant_.close(state_) && finish(momenta);
}

/// The instant has moments about centres of mass, where the mass matrix has no mixed part; the chart has them
/// about reference points. What is between the two is the projection onto what joints and drives allow.
bool EndPoint::finish(const std::vector<double>& momenta)
{
    std::vector<double> lambda(tables_.rows.size()), rates(12 * X_.size());
    momenta_ = momenta;
    shift_moments(tables_.bodies, state_.maps.data(), 1, momenta_);
    instant_.from_momentum(state_, momenta_.data(), 1, lambda.data());
    momenta_ = state_.p;
    shift_moments(tables_.bodies, state_.maps.data(), -1, momenta_);
    tables_.bodies.rates_of(state_.X.data(), state_.velocity.data(), rates.data());
    for (std::size_t b = 0; b < X_.size(); ++b) {
        std::copy_n(state_.X.data() + 12 * b, 12, X_[b].a);
        std::copy_n(rates.data() + 12 * b, 12, V_[b].a);
    }
    return all_finite(state_.X) && all_finite(momenta_) && all_finite(rates);
}

double EndPoint::value(const StateQuantity& quantity) const { return value_of(quantity, stated_, X_, V_); }

bool EndPoint::is_known(const StateQuantity& quantity) const
{
    return quantity.function || quantity.body >= 0 || livens::is_known(quantity.coordinate.coordinate, X_);
}

State EndPoint::state() const { return {state_.t, X_, V_}; }

std::vector<Matrix34> EndPoint::accelerations() const
{
    std::vector<double> A(state_.X.size());
    state_.angles = tables_.loads.turns.begin(state());
    instant_.accelerate(state_, Side::right);
    tables_.bodies.rates_of(state_.X.data(), state_.acceleration[1].data(), A.data());
    std::vector<Matrix34> all(X_.size());
    for (std::size_t b = 0; b < all.size(); ++b)
        for (std::size_t i = 0; i < 12; ++i) all[b].a[i] = A[12 * b + i] + instant_.centripetal()[12 * b + i];
    return all;
}

/// Q e with the unit vector e of rank + j: the last f columns of Q span what the joints leave free.
void EndPoint::free_motion(const ConstraintBasis& basis, int j, double* scaled_twist) const
{
    std::fill_n(scaled_twist, tables_.n_twists, 0.0);
    scaled_twist[tables_.rank + j] = 1;
    basis.q.apply(scaled_twist);
}

double EndPoint::size_of(const double* maps, const double* scaled_twist) const
{
    std::vector<double> twist(momenta_.size());
    tables_.bodies.to_twist(maps, scaled_twist, twist.data());
    double size = 0;
    for (const auto& body : tables_.bodies)
        for (int i = 0; i < body.dofs; ++i)
            size = std::max(size, std::abs(twist[body.first + i]) / (i < 3 ? tables_.length : 1));
    return size;
}

double EndPoint::size_along(const ConstraintBasis& basis, const double* maps, int j) const
{
    std::vector<double> y(momenta_.size());
    free_motion(basis, j, y.data());
    return size_of(maps, y.data());
}

double EndPoint::size_of_momenta(std::vector<double> momenta) const
{
    std::vector<double> y(momenta.size());
    shift_moments(tables_.bodies, maps(), 1, momenta);
    tables_.bodies.to_scaled_rows(maps(), momenta.data(), y.data());
    return size_of(maps(), y.data());
}

/// N^T (N xi m) for the twist xi of the free motion, about reference points.
void EndPoint::momenta_along(const ConstraintBasis& basis, const double* maps, int j, double* momenta) const
{
    const std::size_t size = state_.X.size();
    std::vector<double> y(momenta_.size()), rates(size), raw(size);
    free_motion(basis, j, y.data());
    tables_.bodies.to_twist(maps, y.data(), y.data());
    tables_.bodies.rates_of(state_.X.data(), y.data(), rates.data());
    tables_.bodies.times_mass(rates.data(), 1.0, raw.data());
    double six[6];
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        twist::rows(state_.X.data() + 12 * b, raw.data() + 12 * b, six);
        std::copy_n(six, tables_.bodies[b].dofs, momenta + tables_.bodies[b].first);
    }
}

DenseMatrix EndPoint::derivatives(std::span<const StateQuantity> quantities, const ConstraintBasis& basis,
                                  double rate) const
{
    // [f(1) - f(-1)] 8 / 12 - [f(2) - f(-2)] / 12, over the step
    constexpr std::array<std::array<double, 2>, 4> rule{
        {{-2, 1.0 / 12}, {-1, -8.0 / 12}, {1, 8.0 / 12}, {2, -1.0 / 12}}};
    const int f = tables_.freedoms(), m = static_cast<int>(quantities.size());
    DenseMatrix D(m, 2 * f);
    if (m == 0 || f == 0) return D;
    EndPoint moved(tables_);
    std::vector<double> along(momenta_.size()), y(momenta_.size()), p(momenta_.size());
    for (int j = 0; j < f; ++j) {
        const double size = size_along(basis, maps(), j);
        const double h_places = step_of_places / size, h_rates = step_of_rates * rate / size;
        momenta_along(basis, maps(), j, along.data());
        for (const auto& [k, weight] : rule) {
            free_motion(basis, j, y.data());
            for (double& value : y) value *= k * h_places;
            const bool is_moved = moved.place_moved(*this, y.data(), momenta_);
            for (int i = 0; i < m; ++i) {
                double change = moved.value(quantities[i]) - value(quantities[i]);
                if (quantities[i].counts_turns()) change = turned_to(change, 0);
                D(i, j) += is_moved ? weight / h_places * change : std::nan("");
            }
            for (std::size_t i = 0; i < p.size(); ++i) p[i] = momenta_[i] + k * h_rates * along[i];
            moved.place(t(), state_.X.data(), state_.X_low.data(), p);
            for (int i = 0; i < m; ++i)
                D(i, f + j) += weight / h_rates * (moved.value(quantities[i]) - value(quantities[i]));
        }
    }
    return D;
}

}   // namespace livens::inline spacetime_internal
