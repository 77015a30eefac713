// SPDX-License-Identifier: BSD-3-Clause
// Balances of a pass that tells more than these.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "livens/diagnostics/detail/motion_pass.h"

namespace livens::inline diagnostics_internal {

/// balance() by the supplies of a pass, which goes to the end.
BalanceFigures passed_balance(const Model& model, const Motion& motion, int n_ends,
                              const std::function<void(Balance&)>& take, MotionPass& pass);

/// potential_energy() of one state after the other.
class PotentialEnergy {
public:
    explicit PotentialEnergy(const Model& model);
    double at(Instant at, std::span<const Matrix34> X, std::span<const Matrix34> V,
              std::span<const double> angles) const;

private:
    const Model& model_;
    std::vector<Matrix34> weights_;
    UnwrappedAngles turns_;
};

}   // namespace livens::inline diagnostics_internal
