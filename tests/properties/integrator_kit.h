// SPDX-License-Identifier: BSD-3-Clause
// What every method of integration must fulfil, and what is stated of each; a new method, degree or pairing
// gets it by a line in integrator_kit_registry.cpp.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "livens/multibody/model.h"
#include "livens/spacetime/solve.h"
#include "properties/kit.h"

namespace livens {

/// Velocities turned round and loads run backwards lead back to the start.
enum class Reversal {
    never,
    points,    ///< without constraints only
    always
};

/// Where constraints hold to rounding.
enum class Holds {
    nodes,   ///< at all nodes of X
    weakly   ///< as integrals
};

/// The problems that orders are measured on: a free box under torque, two bricks on ball joints, a hinged
/// brick with spring and damper.
inline constexpr int n_problems = 3;

/// Order of X and V at the ends of elements (n even); 0: no rate is stated, and the registry says why.
struct StatedOrder {
    double order = 0;
    double tolerance = 0.15;
};

/// A method, and what is stated of it: every statement is checked on both sides.
struct IntegratorCase {
    std::string what;   ///< for messages
    Method method;
    std::array<StatedOrder, n_problems> orders;
    Reversal reversal = Reversal::never;
    bool keeps_linear_momentum = false;
    bool keeps_angular_momentum = false;
    Holds holds = Holds::nodes;
    bool is_stable = false;   ///< on every oscillator, with any damping and elements of any length
    /// Likewise for a stiffness that comes from forces which directors carry at rest.
    bool is_stable_with_preload = false;

    /// What is not stated is off by more than this; 0: the method is too exact for that to be seen.
    double seen = 1e-8;

    int n_smallest = 1;   ///< elements whose map is judged for stability
    /// The method's; controls put in a wrong one.
    std::function<Solution(const Model& model, const State& start, const TimeMesh& mesh)> run;
};

IntegratorCase integrator_case(const Method& method, const std::string& more = "");

/// Every method of the library, in its degrees and pairings.
const std::vector<IntegratorCase>& integrator_cases();

/// The rate of the last two of at least four refinements whose errors are 50 times above the gap of two runs
/// of a witness (Newton's and Euler's equations, tests/newton_euler.h).
Failures check_integrator_order(const IntegratorCase& c);
/// Forth and back over coarse elements: the start within 1e-10 (m, 1), 1e-9 in velocities; above `seen`
/// where it is not stated.
Failures check_integrator_reversal(const IntegratorCase& c);
/// A floating chain with a spring and damper inside, over 0.5 s: momenta within 1e-11 of their size,
/// directors and a joint within 1e-12 at all nodes. What is not stated is off by more than `seen`.
Failures check_integrator_invariants(const IntegratorCase& c);
/// The linear map (x omega, v) -> (x omega, v) of one motion of a mass on a spring with a damper: its
/// spectral radius is at most 1 + 1e-12 for h omega = 0.1 .. 1e5 and zeta = 0 .. 100. Above 1 + 1e-4
/// somewhere where it is not stated.
///
/// Rounding: x = 1 / omega is stored to an ulp, of which a stiff spring makes h omega ulps of v. It enters
/// the product of the map's off-diagonal entries alone, the other of which is as small as 1 / (h omega),
/// since each column comes from its own start: the radius stays good to some ulps.
Failures check_integrator_stability(const IntegratorCase& c);
/// The same of a rigid body that two springs and two dampers turn, at a turn of 1e-5: radius at most
/// 1 + 1e-8, h omega up to 1e3.
Failures check_integrator_stability_of_turns(const IntegratorCase& c);
/// The same of a body between two springs that pull at its ends: all stiffness is that of a pendulum.
Failures check_integrator_stability_with_preload(const IntegratorCase& c);

Failures check_integrator(const IntegratorCase& c);   ///< all of them

/// A linear map of the plane.
struct PlaneMap {
    double a11, a12, a21, a22;
};
double spectral_radius(const PlaneMap& map);

}   // namespace livens
