// SPDX-License-Identifier: BSD-3-Clause
// Integrals of L, H and angular momentum over each element, as the paper plots them (P36): theory.md, "What
// is diagnosed", and docs/paper.md, "Figures 9 and 13". H is the Legendre transform of the momentum field,
// where there is one.
#include <algorithm>
#include <cassert>

#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/detail/passed_balance.h"
#include "livens/diagnostics/detail/sampler.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/multibody/rotors.h"
#include "livens/time/quadrature.h"

namespace livens {
namespace {

/// Exact for the kinetic energy of polynomials; quotients of polynomials are given twice the points.
Quadrature action_rule(const Motion& motion)
{
    const int n = std::max(motion.X.degree, motion.P.degree) + 2;
    const bool rational = !motion.X.denominators.empty() || !motion.P.denominators.empty();
    return gauss(std::min(rational ? 2 * n : n, 64));
}

/// What is integrated, at one point of an element.
class Integrands {
public:
    Integrands(const Model& model, const Motion& motion, const Quadrature& rule)
        : model_(model), sampler_(motion, rule.points), X_(static_cast<std::size_t>(motion.n_bodies)),
          V_(X_.size()), P_(X_.size()), turns_(model, motion), potential_(model), rotors_(rotors_of(model))
    {
        if (!sampler_.has_momenta()) return;
        for (const Body& body : model.bodies()) inverse_.push_back(inverse_mass(body.mass, body.is_point));
    }

    void evaluate(int element, int k)
    {
        sampler_.positions(element, k, X_);
        sampler_.velocities(element, k, V_);
        if (k == 0) angles_ = turns_.at_end(element);   // points follow in order
        turns_.turns().follow(X_, angles_);
        double kinetic = 0, legendre = 0;   // T*(P) = 1/2 tr(P m^-1 P^T) and tr(P X'^T)
        if (sampler_.has_momenta()) sampler_.momenta(element, k, P_);
        for (std::size_t b = 0; b < X_.size(); ++b) {
            if (model_.bodies()[b].holds_states()) {
                P_[b] = {};
                continue;
            }
            // Without a field of its own P is that of dX/dt, whose mass matrix may be singular.
            if (!sampler_.has_momenta()) P_[b] = V_[b] * model_.bodies()[b].mass;
            const double product = dot(P_[b], V_[b]);
            legendre += product;
            kinetic += 0.5 * (sampler_.has_momenta() ? dot(P_[b], P_[b] * inverse_[b]) : product);
        }
        const double of_rotors = rotor_energy(rotors_, X_, V_);
        kinetic += of_rotors;
        legendre += 2 * of_rotors;
        const double potential = potential_.at(sampler_.instant(element, k), X_, V_, angles_);
        hamiltonian = kinetic + potential;
        // L = tr(P X'^T) - T* - V: with P = X' m this is T - V, as usual.
        lagrangian = legendre - kinetic - potential;
        moment = angular_momentum(X_, P_);
    }

    double lagrangian = 0;
    double hamiltonian = 0;
    Vector3 moment{};

private:
    const Model& model_;
    ElementSampler sampler_;
    std::vector<Matrix4> inverse_;
    std::vector<Matrix34> X_, V_, P_;
    LoadTurns turns_;
    PotentialEnergy potential_;
    std::vector<Rotor> rotors_;
    std::vector<double> angles_;
};

}   // namespace

ActionSeries action(const Model& model, const Motion& motion)
{
    return action(model, motion, 0, motion.n_elements());
}

ActionSeries action(const Model& model, const Motion& motion, int first, int last)
{
    assert(model.n_bodies() == motion.n_bodies);
    assert(first >= 0 && last <= motion.n_elements());
    ActionSeries series;
    if (last <= first) return series;
    if (has_own_integrals(model, motion))
        return MotionPass(model, motion, {.integrals = true, .first = first}).integrals(last);
    const Quadrature rule = action_rule(motion);
    Integrands at(model, motion, rule);
    for (int e = first; e < last; ++e) {
        double lagrangian = 0, hamiltonian = 0;
        Vector3 moment{};
        for (std::size_t k = 0; k < rule.points.size(); ++k) {
            at.evaluate(e, static_cast<int>(k));
            const double weight = motion.mesh.length(e) * rule.weights[k];
            lagrangian += weight * at.lagrangian;
            hamiltonian += weight * at.hamiltonian;
            moment += weight * at.moment;
        }
        series.lagrangian.push_back(lagrangian);
        series.hamiltonian.push_back(hamiltonian);
        series.angular_momentum.push_back(moment);
    }
    return series;
}

}   // namespace livens
