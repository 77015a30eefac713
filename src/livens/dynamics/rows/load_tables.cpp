// SPDX-License-Identifier: BSD-3-Clause
// Loads by their own functions, one by one; dynamics/lanes runs those that are recorded side by side.
#include "livens/dynamics/rows/load_tables.h"

#include <algorithm>
#include <cmath>

#include "livens/multibody/model.h"

namespace livens {

namespace {

Matrix34 at(const double* X, int body)
{
    Matrix34 m{};
    std::copy(X + 12 * body, X + 12 * body + 12, m.a);
    return m;
}

}   // namespace

LoadTables::LoadTables(const Model& model) : turns(model), model_(model)
{
    for (int l = 0; l < static_cast<int>(model.loads().size()); ++l)
        if (model.loads()[l].depends_on_X || model.loads()[l].depends_on_V) with_tangent.push_back(l);
}

/// The world keeps the configuration and the velocity, zero, that arguments begin with.
LoadArguments LoadTables::arguments(int index, Instant instant, const double* X, const double* V,
                                    std::span<const double> angles) const
{
    const Load& load = model_.loads()[index];
    LoadArguments arguments(load.bodies.size());
    arguments.at = instant;
    arguments.angles = turns.of(index, angles);
    for (std::size_t side = 0; side < load.bodies.size(); ++side) {
        const int body = load.bodies[side];
        if (body == world) continue;
        arguments.X[side] = at(X, body);
        arguments.V[side] = at(V, body);
    }
    return arguments;
}

void LoadTables::add(Instant instant, const double* X, const double* V, double factor, double* raw,
                     std::span<const double> angles) const
{
    for (int l = 0; l < static_cast<int>(model_.loads().size()); ++l)
        add_one(l, instant, X, V, factor, raw, angles);
}

void LoadTables::add_one(int l, Instant instant, const double* X, const double* V, double factor, double* raw,
                         std::span<const double> angles) const
{
    const Load& load = model_.loads()[l];
    LoadForces forces(load.n_acted);
    load.forces(arguments(l, instant, X, V, angles), forces);
    for (std::size_t side = 0; side < load.n_acted; ++side) {
        if (load.bodies[side] == world) continue;
        double* f = raw + 12 * load.bodies[side];
        for (int i = 0; i < 12; ++i) f[i] += factor * forces[side].a[i];
    }
}

int LoadTables::bad(Instant instant, const double* X, const double* V, std::span<const double> angles) const
{
    for (std::size_t l = 0; l < model_.loads().size(); ++l) {
        const Load& load = model_.loads()[l];
        LoadForces forces(load.n_acted);
        load.forces(arguments(static_cast<int>(l), instant, X, V, angles), forces);
        double sum = 0;
        for (const Matrix34& F : forces)
            for (const double f : F.a) sum += std::abs(f);
        if (!std::isfinite(sum)) return static_cast<int>(l);
    }
    return -1;
}

}   // namespace livens
