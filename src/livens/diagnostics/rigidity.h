// SPDX-License-Identifier: BSD-3-Clause
// What keeps bodies rigid along a motion: the multipliers of (P4), and the stress they are.
#pragma once

#include <memory>
#include <vector>

#include "livens/diagnostics/coordinates.h"
#include "livens/diagnostics/sample.h"

namespace [[gnu::visibility("default")]] livens {

inline namespace dynamics_internal {
class RowTables;
}   // namespace dynamics_internal
inline namespace multibody_internal {
class ActingModels;
}   // namespace multibody_internal

/// What keeps a body rigid at an instant, from both sides of it: the multipliers Lambda_ab of (P4), N m, in
/// components along the body's directors as they are stated; tension is positive. They are the second
/// Piola-Kirchhoff stress summed up over the body: divided by its volume, the mean stress.  (P4, after it)
struct RigiditySample {
    Matrix3 left{};
    Matrix3 right{};
    bool is_unique = true;    ///< see JointSample, of the joints at the body
    bool is_bounded = true;   ///< likewise; false: nan
};

/// All bodies of a motion, point masses with zeros, by the equations of motion at the instant; jumps of loads
/// and events of joints are seen from both sides.  (docs/theory.md, "Stress of rigidity")
class Rigidity {
public:
    Rigidity(const Model& model, const Motion& motion);

    /// At t, after snap_to_element_end(); at element ends of what the motion holds there.
    std::vector<RigiditySample> at(double t) const;
    /// The same in a state that sample_state() gave; `joints` may know reactions there.
    std::vector<RigiditySample> at_sample(const State& state, const JointSampler* joints = nullptr) const;
    /// The same in a state at an instant of the motion, as sample_exactly() has it.
    std::vector<RigiditySample> at(const State& state) const;

private:
    std::vector<RigiditySample> at_end(const State& state, int end, const JointSampler* joints) const;

    std::span<const Matrix34> accelerations_at(int end, std::size_t side, std::size_t n) const;

    const Model& model_;
    const Motion& motion_;
    LoadTurns turns_;
    std::vector<int> independent_;   ///< rows
    std::shared_ptr<const RowTables> rows_;
    std::shared_ptr<ActingModels> acting_;
};

}   // namespace gnu::visibility("default")]]livens
