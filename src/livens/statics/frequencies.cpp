// SPDX-License-Identifier: BSD-3-Clause
// How fast springs, dampers and constraint forces can be at a state: theory.md, "Highest frequencies". Up to
// 60 freedoms by a basis of the free motions and a dense solver, above by Lanczos' iteration with the
// projection along the joints.
#include "livens/statics/frequencies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "livens/multibody/rotors.h"
#include "livens/solvers/spectral.h"
#include "livens/statics/small_motions.h"

namespace livens {

namespace {

/// An eigenvalue, and the body and the source that have the largest part in it.
struct Mode {
    double value = 0;
    int body = -1, source = -1;
};

using Values = std::vector<double>;

/// Terms on the free motions: by a basis of these, or by what projects onto them.
class Spectrum {
public:
    Spectrum(const ModelTables& tables, InstantState& state, const TwistTerms& mass)
        : tables_(tables), state_(state)
    {
        // Long chains have no basis: to make one would cost more than the whole iteration.
        if (state.held.by_joints) return;
        free_.emplace(tables, state);
        mass_ = on_free_motions(mass);
    }

    /// Of the positive eigenvalues, ascending. `columns`: X of each body by its scaled twist.
    std::vector<Vibration> vibrations(const TwistTerms& terms, const TwistTerms& dampers,
                                      const std::vector<BodyColumns>& columns, double slowest) const
    {
        std::vector<Vibration> found;
        if (terms.empty() || !free_ || free_->n == 0) return found;
        const SymmetricSpectrum spectrum = generalised_spectrum(on_free_motions(terms), mass_);
        if (!spectrum.is_found) return found;
        for (int i = 0; i < free_->n; ++i) {
            if (!(spectrum.values[i] > 0)) continue;
            Vibration one{std::sqrt(spectrum.values[i])};
            if (one.rate < slowest) continue;
            const Values y = product(free_->Z, spectrum.vectors.column(i));
            // With y^T M y = 1 this is y^T C y, the rate at which dampers take this form (theory.md, "What
            // radau takes").
            one.decay = dot(y, times(dampers, y));
            for (int b = 0; b < tables_.n_bodies(); ++b) {
                if (!tables_.model->bodies()[static_cast<std::size_t>(b)].is_matter()) continue;
                const auto twist = part(y, b);
                Matrix34 moved{};
                for (int k = 0; k < tables_.bodies[b].dofs; ++k)
                    for (int r = 0; r < 12; ++r) moved[r] += columns[b](r, k) * twist[k];
                const std::span<const double> all(moved.a);
                one.shift = std::max(one.shift, norm(all.first(3)));
                one.turn = std::max(one.turn, norm(all.last(9)) / std::sqrt(2.0));
            }
            found.push_back(one);
        }
        return found;
    }

    /// The largest eigenvalue, if it is positive and no rounding.
    Mode highest(const TwistTerms& terms) const
    {
        Mode mode;
        if (terms.empty() || tables_.freedoms() == 0) return mode;
        const auto [value, y] = state_.held.by_joints ? by_lanczos(terms) : by_basis(terms);
        if (!(value > 0) || is_rounding(value, y, terms)) return mode;
        mode.value = value;
        double most = 0;
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            if (squared_norm(part(y, b)) <= most) continue;
            most = squared_norm(part(y, b));
            mode.body = b;
        }
        mode.source = most_active(terms, y);
        return mode;
    }

private:
    struct Pair {
        double value = 0;
        Values y{};
    };

    Pair by_basis(const TwistTerms& terms) const
    {
        const SymmetricSpectrum spectrum = generalised_spectrum(on_free_motions(terms), mass_);
        if (!spectrum.is_found) return {};
        // Values descend. The largest one that is no rounding counts; a matrix of nothing but rounding has
        // none.
        for (int i = free_->n - 1; i >= 0; --i) {
            const Pair found{spectrum.values[i], product(free_->Z, spectrum.vectors.column(i))};
            if (!(found.value > 0) || !is_rounding(found.value, found.y, terms)) return found;
        }
        return {};
    }

    /// Whether y^T K y, y^T M y = 1, is no more than the rounding of what is summed to it.
    bool is_rounding(double value, const Values& y, const TwistTerms& terms) const
    {
        constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();   // of sums of 144 products
        Values sizes = y;
        for (double& entry : sizes) entry = std::abs(entry);
        double size = 0;
        for (const TwistTerm& t : terms) size += work(t.size, t, sizes);
        return value <= rounding * size;
    }

    /// Lanczos' iteration on P K P, each vector orthogonal to all before it; the mass is the identity there.
    Pair by_lanczos(const TwistTerms& terms) const
    {
        constexpr int most_vectors = 120;    // what is found then is a lower bound, and good to a few digits
        constexpr double tolerance = 1e-6;   // of the residual; the eigenvalue has its square
        const int most = std::min(most_vectors, tables_.freedoms());
        DenseMatrix V;
        Values alpha, beta, w(static_cast<std::size_t>(tables_.n_twists));
        // A start of fixed random numbers is perpendicular to no eigenvector, and the same in every run.
        std::minstd_rand random(1);
        for (double& x : w) x = static_cast<double>(random()) / static_cast<double>(random.max()) - 0.5;
        project(w);
        for (int k = 0;; ++k) {
            const double length = norm(w);
            for (double& entry : w) entry /= length;
            V.append_column(w);
            w = times(terms, V.column(k));
            project(w);
            alpha.push_back(dot(w, V.column(k)));
            // Twice is enough for orthogonality to rounding; without it converged values would come again as
            // copies.
            for (int pass = 0; pass < 2; ++pass) add_scaled(w, -1, product(V, transposed_product(V, w)));
            beta.push_back(norm(w));
            const bool is_last = k + 1 == most || !(beta[k] > 1e-13 * largest_size(alpha));
            if (!is_last && k % 10 != 9) continue;
            const SymmetricSpectrum small = tridiagonal_spectrum(alpha, std::span(beta).first(k));
            if (!small.is_found) return {};
            // The residual norm of a Ritz pair is beta times the last entry of its vector in the tridiagonal
            // problem.
            const double left = beta[k] * std::abs(small.vectors(k, k)), value = small.values[k];
            if (is_last || left <= tolerance * std::abs(value))
                return {value, product(V, small.vectors.column(k))};
        }
    }

    void project(Values& y) const
    {
        Values mu(state_.held.rows.size());
        state_.held.joints.project(y.data(), nullptr, mu.data());
    }

    /// The symmetric part of K y.
    Values times(const TwistTerms& terms, std::span<const double> y) const
    {
        Values out(y.size(), 0.0);
        for (const TwistTerm& t : terms) {
            const auto &i = tables_.bodies[t.i], &j = tables_.bodies[t.j];
            const Matrix<6, 1> Ky = livens::times(t.K, part(y, t.j));
            for (int r = 0; r < i.dofs; ++r) out[i.first + r] += 0.5 * Ky[r];
            for (int k = 0; k < j.dofs; ++k)
                out[j.first + k] += 0.5 * dot(std::span(t.K.a).subspan(6 * k, i.dofs), part(y, t.i));
        }
        return out;
    }

    /// y^T K y of a term.
    double work(const Matrix<6, 6>& K, const TwistTerm& t, std::span<const double> y) const
    {
        const Matrix<6, 1> Ky = livens::times(K, part(y, t.j));
        return dot(part(y, t.i), std::span(Ky.a).first(tables_.bodies[t.i].dofs));
    }

    std::span<const double> part(std::span<const double> y, int body) const
    {
        return y.subspan(tables_.bodies[body].first, tables_.bodies[body].dofs);
    }

    DenseMatrix on_free_motions(const TwistTerms& terms) const
    {
        return symmetric_part(free_->reduced(tables_, terms));
    }

    int most_active(const TwistTerms& terms, const Values& y) const
    {
        int most = -1;
        double largest = 0, sum = 0;
        for (std::size_t k = 0; k < terms.size(); ++k) {   // terms of a source follow each other
            const TwistTerm& t = terms[k];
            if (k == 0 || t.source != terms[k - 1].source) sum = 0;
            sum += work(t.K, t, y);
            const bool is_last = k + 1 == terms.size() || terms[k + 1].source != t.source;
            if (!is_last || sum <= largest) continue;
            largest = sum;
            most = t.source;
        }
        return most;
    }

    const ModelTables& tables_;
    InstantState& state_;
    std::optional<FreeMotions> free_;   // where the state has a basis
    DenseMatrix mass_;
};

/// What joints leave free vibrates no faster than all twists would: no eigenvalue of blocks is larger than
/// the largest sum of the norms of a row of them. Infinite where the mass is not the identity.
double fastest_possible(const TwistTerms& restoring, const TwistTerms& mass, std::size_t n_bodies)
{
    const auto is_unit = [](const TwistTerm& t) {
        return norm(t.K - identity<6>()) < 1e-6;   // else an inertia is singular
    };
    if (!std::ranges::all_of(mass, is_unit)) return std::numeric_limits<double>::infinity();
    Values sums(n_bodies, 0.0);
    for (const TwistTerm& t : restoring) {
        const double half = 0.5 * norm(t.K);
        sums[static_cast<std::size_t>(t.i)] += half;
        sums[static_cast<std::size_t>(t.j)] += half;
    }
    return std::sqrt(largest_size(sums));
}

}   // namespace

std::string Frequency::where(const Model& model) const
{
    if (body < 0) return "";
    return "body '" + model.body_name(body) + "'" + (name.empty() ? ", which bears a preload" : ", " + name);
}

HighestFrequencies highest_frequencies(const Model& model, const State& state, Side side)
{
    if (model.has_rotors()) {
        const WithRotors rotors(model);
        HighestFrequencies found = highest_frequencies(rotors.model(), rotors.with(state), side);
        for (Frequency* one : {&found.springs, &found.dampers, &found.constraints})
            one->body = rotors.told_body(one->body);
        return found;
    }
    const PreparedState at(model, state, side, false);
    if (!at.is_fit) return {};
    const SmallMotions forms(at.tables, at.state, side);
    TwistTerms springs, dampers, constraints, mass;
    forms.add_loads(springs, dampers);
    forms.add_constraints(constraints);
    forms.add_mass(mass);
    const Spectrum spectrum(at.tables, at.state, mass);
    const auto load = [&](const Mode& mode, double rate) {
        return Frequency{rate, mode.body,
                         mode.source < 0 ? "" : "load '" + model.loads()[mode.source].name + "'"};
    };
    // Apart from each other: springs are integrated at load points, constraint forces at nodes, with
    // different limits (theory.md, "Why two rules").
    const Mode spring = spectrum.highest(springs), damper = spectrum.highest(dampers),
               bearing = spectrum.highest(constraints);
    const Frequency of_constraints{
        std::sqrt(bearing.value), bearing.body,
        bearing.source < 0 ? "" : "joint '" + model.joints()[bearing.source].name + "'"};
    return {load(spring, std::sqrt(spring.value)), load(damper, damper.value), of_constraints};
}

std::vector<Vibration> vibrations(const Model& model, const State& state, Side side, double slowest)
{
    if (model.has_rotors()) {
        const WithRotors rotors(model);
        return vibrations(rotors.model(), rotors.with(state), side, slowest);
    }
    for (const bool by_basis : {false, true}) {
        const PreparedState at(model, state, side, by_basis);
        if (!at.is_fit) return {};
        const SmallMotions forms(at.tables, at.state, side);
        TwistTerms restoring, dampers, mass;
        forms.add_loads(restoring, dampers);
        forms.add_constraints(restoring);
        forms.add_mass(mass);
        if (fastest_possible(restoring, mass, model.bodies().size()) < slowest) return {};
        if (at.state.held.by_joints) continue;   // many freedoms, of which it has made no basis
        return Spectrum(at.tables, at.state, mass).vibrations(restoring, dampers, forms.columns(), slowest);
    }
    return {};
}

}   // namespace livens
