// SPDX-License-Identifier: BSD-3-Clause
// A mechanism at any state near its joints: put onto them, and what the equations of motion say there.
#pragma once

#include <optional>
#include <vector>

#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/tables.h"
#include "livens/multibody/state.h"

namespace livens::inline dynamics_internal {

class SettledInstant {
public:
    /// The model's joints all act; `independent`: rows of theirs.
    SettledInstant(const Model& model, std::vector<int> independent);

    /// The state put onto the joints. Between nodes directors are rigid, joints closed, and rates rigid
    /// motions that joints allow, to the order of the interpolation only. False: joints lose rank.
    bool settle(const State& state);
    /// Also accelerations and multipliers, on one side. What is there already is not solved again, as most
    /// who ask for one thing of a state ask for another.
    bool accelerate(const State& state, const std::vector<double>& angles, Side side);

    /// Twists by which impulses, 12 numbers a body, change those of a state that is settled.
    std::vector<double> response_to(const std::vector<double>& raw);

    const ModelTables& tables() const { return tables_; }
    const InstantSystem& system() const { return system_; }
    const InstantState& solved() const { return solved_; }
    /// Of all rows, as accelerate() left them.
    const std::vector<double>& multipliers(Side side) const
    {
        return solved_.multipliers[side == Side::left ? 0 : 1];
    }

private:
    ModelTables tables_;
    InstantSystem system_;
    InstantState solved_;
    State settled_;
    bool is_held_ = false;
    std::optional<Side> accelerated_;
};

/// Independent rows where most are: where joints lose rank nothing tells which are independent elsewhere.
std::vector<int> most_rows(const Model& model, std::span<const State> places);

}   // namespace livens::inline dynamics_internal
