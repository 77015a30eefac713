// SPDX-License-Identifier: BSD-3-Clause
#include <cassert>

#include "livens/diagnostics/diagnostics.h"
#include "livens/multibody/turns.h"

namespace livens {

std::vector<double> rigidity_multipliers(const Model& model, int body, Instant at,
                                         std::span<const Matrix34> X, std::span<const Matrix34> V,
                                         std::span<const Matrix34> A, std::span<const double> multipliers,
                                         std::span<const double> angles)
{
    assert(body >= 0 && body < model.n_bodies());
    assert(static_cast<int>(multipliers.size()) == model.n_rows());
    const Body& self = model.bodies()[body];
    if (self.is_point) return std::vector<double>(6, 0.0);

    Matrix34 rest = weight(self, model.gravity()) - A[body] * self.mass;   // F - G^T lambda - X'' m
    const Turns turns(model);
    for (int l = 0; l < static_cast<int>(model.loads().size()); ++l) {
        const Load& load = model.loads()[l];
        if (load.bodies[0] != body && load.bodies[1] != body) continue;
        LoadForces F{};
        load.forces(load_arguments(load, at, X, V, turns.of(l, angles)), F);
        for (int b = 0; b < 2; ++b) {
            if (load.bodies[b] == body) rest += F[b];
        }
    }
    for (int r = 0; r < model.n_rows(); ++r)
        rest -= multipliers[r] * constraint_gradient(model.row(r), at, X).of(body);
    const Matrix3 along = transpose(directors(rest)) * directors(X[body]);   // (a, b): column a along d_b
    return {along(0, 0), along(1, 1), along(2, 2), along(0, 1), along(0, 2), along(1, 2)};
}

}   // namespace livens
