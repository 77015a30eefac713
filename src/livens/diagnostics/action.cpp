#include <cassert>

#include "livens/diagnostics/detail/sampler.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/time/quadrature.h"

namespace livens {

ActionSeries action(const Model& model, const Motion& motion)
{
    assert(model.n_bodies() == motion.n_bodies);
    ActionSeries series;
    if (motion.n_elements() < 1) return series;
    const Quadrature rule = gauss(motion.X.degree + 2);
    const ElementSampler sampler(motion, rule.points);
    std::vector<Matrix34> X(static_cast<std::size_t>(motion.n_bodies)), V(X.size());
    for (int e = 0; e < motion.n_elements(); ++e) {
        double lagrangian = 0, hamiltonian = 0;
        for (int k = 0; k < sampler.size(); ++k) {
            sampler.positions(e, k, X);
            sampler.velocities(e, k, V);
            const double kinetic = kinetic_energy(model, X, V);
            const double potential = potential_energy(model, sampler.instant(e, k), X, V);
            const double weight = motion.mesh.length(e) * rule.weights[k];
            lagrangian += weight * (kinetic - potential);
            hamiltonian += weight * (kinetic + potential);
        }
        series.lagrangian.push_back(lagrangian);
        series.hamiltonian.push_back(hamiltonian);
    }
    return series;
}

}   // namespace livens
