// SPDX-License-Identifier: BSD-3-Clause
// What every load must fulfil; a new one gets it by a line in load_kit_registry.cpp.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "livens/dynamics/lanes/aligned_doubles.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/loads.h"
#include "livens/multibody/model.h"
#include "properties/kit.h"
#include "unit/multibody/random_states.h"

namespace livens {

struct LoadCase {
    std::string type;   ///< Load::type, and the name of its file in src/livens/multibody/loads
    std::string what;   ///< for messages
    std::function<Load(Random&)> make;   ///< on bodies 0 and 1, or on 0 alone
    /// Where the bodies are, for a load that is no number everywhere; else anywhere.
    std::function<std::array<Matrix34, 2>(Random&)> place{};
};

inline void PrintTo(const LoadCase& load, std::ostream* out) { *out << load.type << ", " << load.what; }

/// Every load of the library, in every variant.
const std::vector<LoadCase>& load_cases();

/// Skew and moving bodies, some way apart so that no two points meet.
LoadArguments random_arguments(Random& random, const Load& load, const LoadCase& load_case);

/// Load 0 of a model at some points, one by one.
class LoadAtPoints {
public:
    /// `at`: of the load's bodies; the model must outlive it.
    LoadAtPoints(const Model& model, std::vector<LoadArguments> at);

    /// From the same in lanes of the instructions in use: the largest, by the sum of the absolute terms that
    /// a force is made of. `spoil` puts a fault into what the lanes have found.
    double difference(const std::function<void(AlignedDoubles& F, int width)>& spoil = nullptr) const;

private:
    static double factor(std::size_t c);
    std::vector<double> first_turns() const;
    void add_alone(std::size_t c, std::vector<double>& turns);
    double scale_of(const LoadArguments& here) const;
    AlignedDoubles in_lanes(int W, PerBody<Matrix34> LoadArguments::*of) const;

    const ModelTables tables_;
    const Load& load_;
    std::vector<LoadArguments> at_;
    std::vector<std::vector<double>> alone_;   // of each point, about the centres of mass
    std::vector<double> scales_;
};

/// dF/dX and dF/dV equal differences of order 8 (error about 1e-12) at 1000 states with skew directors; where
/// a flag says that there is no dependence, there is none.
Failures check_load_tangent(const LoadCase& load);
/// tr(F^T V) = - d(potential)/dt + power without potential, at any X and V.
Failures check_load_energy(const LoadCase& load);
/// Load::products: F is what their directions make of some sizes, whose slopes are by_X, where nothing moves,
/// and by_V, by differences. Nothing of loads without them.
Failures check_load_products(const LoadCase& load);
/// F = - d(potential)/dX at rest.
Failures check_load_potential(const LoadCase& load);
/// F is smooth in time between its breaks, and at a break each side is the limit from there.
Failures check_load_breaks(const LoadCase& load);
/// In lanes of every set of instructions that is here F is what it is alone, to 1e-14 of its scale, also
/// turn after turn.
Failures check_load_lanes(const LoadCase& load);
/// What it supplies, on a tape: F, its moment and its power without potential, to 1e-13 of what they are made
/// of; and sizes that are at least those of F.
Failures check_load_supply(const LoadCase& load, double bound = 1e-13);
/// No force outside the first column unless needs_directors says so.
Failures check_load_directors(const LoadCase& load);

Failures check_load(const LoadCase& load);   ///< all of them

}   // namespace livens
