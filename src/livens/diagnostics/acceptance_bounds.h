// SPDX-License-Identifier: BSD-3-Clause
// The bounds of judge(), for whoever shows them beside the figures.
#pragma once

namespace livens::inline diagnostics_internal {

inline constexpr double acceptable_violation = 1e-6;
// Bounds for constraints that hold weakly and for zig-zag are drawn between right and wrong runs of the
// paper's pendulums, two bricks and a free box to 1 .. 20 s, with elements of 0.0025 to 0.1 s. Weak
// constraints hold as integrals and are off at points by what the discretisation is: runs with an energy off
// by less than 2 percent reached 6e-4 in the mean and 0.02 at nodes. Velocities of right runs alternated by
// 0.23 at most. By 0.7 and more did those of strong starts whose directors were off by 0.1 to 0.24 with an
// energy off by 1e-4, and of a motion that was metres from its place with an energy off by 0.8 percent: there
// no balance tells. Elements of lobatto that are too long (ten of degree 8 for 5 s of a double pendulum)
// keep momenta to rounding and energy within 2.4 percent, and alternate by 0.59 to 0.77.
inline constexpr double acceptable_weak_violation = 1e-3;
inline constexpr double acceptable_nodal_violation = 0.05;
inline constexpr double acceptable_zigzag = 0.5;
inline constexpr double acceptable_drift = 0.05;
inline constexpr double acceptable_distance = 0.05;
inline constexpr double acceptable_error = 1e-2;

}   // namespace livens::inline diagnostics_internal
