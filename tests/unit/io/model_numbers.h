// SPDX-License-Identifier: BSD-3-Clause
// What two models are compared by.
#pragma once

#include <vector>

#include "livens/multibody/model.h"

namespace livens::test {

/// Values and gradients of rows, forces of loads, and what sensors read of coordinates, at the start.
inline std::vector<double> numbers_of(const Model& model)
{
    std::vector<double> all;
    const State state = model.start();
    for (int b = 0; b < model.n_bodies(); ++b) {
        all.insert(all.end(), state.X[b].a, state.X[b].a + 12);
        all.insert(all.end(), state.V[b].a, state.V[b].a + 12);
    }
    for (int r = 0; r < model.n_rows(); ++r) {
        all.push_back(constraint_value(model.row(r), {0.1}, state.X));
        for (int b = 0; b < model.n_bodies(); ++b) {
            const Matrix34 g = constraint_gradient(model.row(r), {0.1}, state.X).of(b);
            all.insert(all.end(), g.a, g.a + 12);
        }
    }
    for (const Load& load : model.loads()) {
        LoadForces F{};
        load.forces(load_arguments(load, {0.1}, state.X, state.V), F);
        for (const Matrix34& of : F) all.insert(all.end(), of.a, of.a + 12);
    }
    for (const Sensor& sensor : model.sensors())
        for (const SensorComponent& c : sensor.components)
            if (!c.coordinate.coordinate.forms.empty())
                all.push_back(coordinate_value(c.coordinate.coordinate, state.X));
    for (const NamedPoint& point : model.points())
        all.insert(all.end(), point.position.a, point.position.a + 3);
    return all;
}

}   // namespace livens::test
