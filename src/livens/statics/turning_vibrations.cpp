// SPDX-License-Identifier: BSD-3-Clause
// How fast the directions of stiff springs turn, by a difference over a small displacement: what theory.md,
// "Springs that turn", compares with the length of elements. Of dense work, so of models up to 600 freedoms.
#include "livens/statics/turning_vibrations.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/solvers/spectral.h"
#include "livens/statics/small_motions.h"

namespace livens::inline statics_internal {

namespace {

using Values = std::vector<double>;

constexpr int most_freedoms = 600;
constexpr double small_turn = 1e-3;   // lengths of the model or rad, over which a difference is taken
/// Of its stiffness: forms below are softer than a form, others as stiff.
constexpr double much_softer = 0.5;

/// The springs of a model at a state, on what its joints leave free there.
class Springs {
public:
    explicit Springs(const PreparedState& at)
        : tables_(at.tables), state_(at.state), forms_(at.tables, at.state, Side::right),
          free_(at.tables, at.state)
    {
        TwistTerms dampers, mass;
        forms_.add_loads(terms_, dampers);
        forms_.add_mass(mass);
        if (terms_.empty() || free_.n == 0) return;
        mass_ = symmetric_part(free_.reduced(tables_, mass));
        SymmetricSpectrum spectrum =
            generalised_spectrum(symmetric_part(free_.reduced(tables_, terms_)), mass_);
        if (spectrum.is_found) all_ = std::move(spectrum);
    }

    bool is_empty() const { return all_.values.empty(); }
    /// Of the rates of all forms, ascending; negative where loads drive apart.
    const Values& squares() const { return all_.values; }
    std::span<const double> form(int i) const { return all_.vectors.column(i); }
    /// What the first `n` forms have of a motion.
    Values slow_part(const Values& q, int n) const
    {
        const DenseView slow = all_.vectors.left_columns(n);
        return product(slow, transposed_product(slow, product(mass_, q)));
    }
    double size(const Values& q) const { return std::sqrt(dot(q, product(mass_, q))); }

    /// Of the state, as a form.
    Values velocity() const
    {
        Values V(state_.X.size());
        tables_.bodies.rates_of(state_.X.data(), state_.velocity.data(), V.data());
        return form_of(V);
    }

    /// What a form moves, 12 numbers a body.
    Values moved(std::span<const double> form) const
    {
        const Values y = product(free_.Z, form);
        Values dX;
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            const Values of_body = product(columns(b), part(y, b));
            dX.insert(dX.end(), of_body.begin(), of_body.end());
        }
        return dX;
    }

    /// The form that moves bodies so, as near as rigid bodies and joints can here: its turn is the least.
    Values form_of(const Values& dX) const
    {
        Values y, mdX(dX.size());
        tables_.bodies.times_mass(dX.data(), 1.0, mdX.data());
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            const Values of_body = transposed_product(columns(b), std::span(mdX).subspan(12 * b, 12));
            y.insert(y.end(), of_body.begin(), of_body.end());   // bodies follow each other
        }
        return transposed_product(free_.Z, y);
    }

    /// The body that moves most, and the load that does most of the work.
    Frequency name(double rate, std::span<const double> form) const
    {
        const Values y = product(free_.Z, form);
        Frequency found{rate};
        double most = 0;
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            if (squared_norm(part(y, b)) <= most) continue;
            most = squared_norm(part(y, b));
            found.body = b;
        }
        Values work(tables_.model->loads().size(), 0.0);
        for (const TwistTerm& t : terms_) {
            const Matrix<6, 1> Ky = times(t.K, part(y, t.j));
            work[t.source] += dot(part(y, t.i), std::span(Ky.a).first(tables_.bodies[t.i].dofs));
        }
        const auto hardest = std::max_element(work.begin(), work.end());
        found.name = "load '" + tables_.model->loads()[hardest - work.begin()].name + "'";
        return found;
    }

private:
    DenseView columns(int b) const { return {12, tables_.bodies[b].dofs, forms_.columns()[b].data()}; }

    std::span<const double> part(const Values& y, int b) const
    {
        return std::span(y).subspan(tables_.bodies[b].first, tables_.bodies[b].dofs);
    }

    const ModelTables& tables_;
    const InstantState& state_;
    SmallMotions forms_;
    FreeMotions free_;
    TwistTerms terms_;
    DenseMatrix mass_;
    SymmetricSpectrum all_;   // empty where there is none
};

/// |x| of nine numbers, added as four pairs and one.
double norm_of_nine(const double* x)
{
    const auto square = [x](int i) { return x[i] * x[i]; };
    return std::sqrt(((square(0) + square(2)) + (square(4) + square(6))) +
                     ((square(1) + square(3)) + (square(5) + square(7))) + square(8));
}

/// A little further on with these velocities, and by which time; 0: nothing moves.
std::pair<State, double> moved(const Model& model, State state, const Values& V)
{
    double rate = 0;
    for (int b = 0; b < model.n_bodies(); ++b)
        rate = std::max({rate, norm(std::span(V).subspan(12 * b, 3)) / model.length(),
                         norm_of_nine(V.data() + 12 * b + 3)});
    if (rate == 0) return {std::move(state), 0};
    const double time = small_turn / rate;
    for (int b = 0; b < model.n_bodies(); ++b)
        for (int i = 0; i < 12; ++i) state.X[b].a[i] += time * V[12 * b + i];
    return {std::move(state), time};
}

int n_below(const Values& ascending, double bound)
{
    return static_cast<int>(std::ranges::lower_bound(ascending, bound) - ascending.begin());
}

}   // namespace

std::vector<TurningVibration> turning_vibrations(const Model& model, const State& state, double slowest)
{
    if (model.has_rotors()) return {};   // what they add to inertia is not seen here
    if (6 * model.n_bodies() - model.n_rows() > most_freedoms) return {};
    const PreparedState now(model, state, Side::right, true);
    if (!now.is_fit) return {};
    const Springs springs(now);
    if (springs.is_empty()) return {};
    const Values& squares = springs.squares();
    const int n_slow = n_below(squares, slowest * slowest), n = static_cast<int>(squares.size());
    if (n_slow == n) return {};
    // Only the slow part of the velocity turns springs; the vibrations themselves stretch them to and fro.
    const Values V = springs.moved(springs.slow_part(springs.velocity(), n_slow));
    const auto [then, time] = moved(model, state, V);
    const PreparedState soon(model, then, Side::right, true);
    if (!(time > 0) || !soon.is_fit) return {};
    const Springs later(soon);
    std::vector<TurningVibration> found;
    for (int i = n_slow; i < n; ++i) {
        const Values q = later.form_of(springs.moved(springs.form(i)));
        // Between forms of like stiffness a turn has no meaning; softer ones make up the direction across the
        // spring.
        const Values left = later.slow_part(q, n_below(later.squares(), much_softer * squares[i]));
        Values stays = q;
        add_scaled(stays, -1, left);
        const double turn = std::atan2(later.size(left), later.size(stays));
        found.push_back({springs.name(std::sqrt(squares[i]), springs.form(i)), turn / time});
    }
    return found;
}

}   // namespace livens::inline statics_internal
