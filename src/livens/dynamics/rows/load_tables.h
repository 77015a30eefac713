// SPDX-License-Identifier: BSD-3-Clause
// Loads of a model as the engine asks them.
#pragma once

#include <span>
#include <vector>

#include "livens/multibody/loads.h"
#include "livens/multibody/unwrapped_angles.h"

namespace livens::inline dynamics_internal {

class LoadTables {
public:
    explicit LoadTables(const Model& model);

    /// raw += factor * loads at the instant; X, V: 12 a body. `angles`: a row of `turns`, or nothing where
    /// turns are not known.
    void add(Instant at, const double* X, const double* V, double factor, double* raw,
             std::span<const double> angles = {}) const;
    /// The same of one of them.
    void add_one(int load, Instant at, const double* X, const double* V, double factor, double* raw,
                 std::span<const double> angles = {}) const;
    /// What a load is asked with.
    LoadArguments arguments(int load, Instant at, const double* X, const double* V,
                            std::span<const double> angles = {}) const;
    /// The first load that is not finite there; -1: none.
    int bad(Instant at, const double* X, const double* V, std::span<const double> angles = {}) const;

    std::vector<int> with_tangent;   ///< loads that depend on X or V
    UnwrappedAngles turns;

private:
    const Model& model_;
};

}   // namespace livens::inline dynamics_internal
