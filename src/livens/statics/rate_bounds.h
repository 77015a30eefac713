// SPDX-License-Identifier: BSD-3-Clause
// What loads make of the motions of bodies is no faster than this, whatever joints hold.
// (docs/theory.md, "Highest frequencies")
#pragma once

#include <vector>

#include "livens/dynamics/rows/tables.h"

namespace livens::inline statics_internal {

/// Bounds of what highest_frequencies() and turning_vibrations() find of loads, by the sizes of their slopes,
/// for about a hundredth of the work. Infinite where an inertia is singular.
class RateBounds {
public:
    explicit RateBounds(const Model& model) : tables_(model, {}) {}

    /// At a state: of vibrations by springs, rad/s.
    double springs(const State& state);
    /// At a state: of what dampers take away, 1/s.
    double dampers(const State& state);

private:
    enum class Slopes { by_X, by_V };
    double largest(const State& state, Slopes slopes);
    void add(int load, const State& state, Slopes slopes);
    void add_damper(const Load& load, const ProductSlopes& slopes, const double* X);
    void add_size(int i, int j, double size);

    ModelTables tables_;
    std::vector<double> maps_, angles_;
    std::vector<double> sums_;   // of what each body's rows have, half of it of their transpose
};

}   // namespace livens::inline statics_internal
