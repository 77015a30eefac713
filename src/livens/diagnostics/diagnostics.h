// SPDX-License-Identifier: BSD-3-Clause
// What is conserved, and how well: free functions of a motion, whoever made it.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "livens/multibody/motion.h"

namespace [[gnu::visibility("default")]] livens {

/// What is left of the balances of a whole motion, see Balance; 0 before anything was balanced.
///
/// Each relative drift is the largest drift over the larger of what is in motion and of the rounding level,
/// and 0 below that level, 16 times the spacing of numbers at the references: over all forces (weights,
/// loads, joints) and columns, with L the model's length, as constraints place bodies to the rounding of it
/// and stiff loads turn that into forces (their dF/dX' counts by 1 / h). So a mechanism at rest has none,
/// whose motion and drift are rounding both, and a slow one is not measured by what it could be (a rod of 3e9
/// m is a slide as well).
struct BalanceFigures {
    double largest_kinetic = 0;     ///< over the ends and where loads are taken between them
    double largest_momentum = 0;    ///< over the ends, of the sum of the bodies' |p|
    double largest_moment = 0;      ///< largest sum over bodies and columns of |x| |P|
    double reference_energy = 0;    ///< J: largest sum of |F| (|x| + L), plus the largest |potential|
    double reference_impulse = 0;   ///< N s: integral of the sum of |F| + |dF/dX| (|x| + L)
    double reference_moment = 0;    ///< N m s: integral of the sum of these times |x| + L
    double largest_change = 0;      ///< J: of the potential energy since the start
    double largest_impulse = 0;     ///< N s: supplied since the start
    double largest_energy_drift = 0;
    double largest_energy_rise = 0;   ///< see relative_energy_rise()
    double energy_loss = 0;           ///< J: from start to end, of energy less work
    double largest_linear_momentum_drift = 0;
    double largest_angular_momentum_drift = 0;

    /// Relative to the largest kinetic energy or change of potential energy since the start.
    double relative_energy_drift() const;
    // For motions that damp, relative to the same. What the energy has risen by, since any earlier end,
    // beyond what loads supplied to each element (docs/theory.md, "What is diagnosed"); what energy less work
    // has fallen by from start to end.
    double relative_energy_rise() const;
    double relative_energy_loss() const;
    double hidden_energy_loss() const;   ///< J: no more than rounding, or than the energy has risen by
    /// Relative to largest_momentum or the largest impulse.
    double relative_linear_momentum_drift() const;
    /// Relative to largest_moment.
    double relative_angular_momentum_drift() const;

private:
    double moving_energy() const;
};

/// Energies (J), momenta (N s, N m s about the world's origin) and their balances at the element ends.
///
/// Balances are what is left when the supply since the start is taken off: energy less the work of loads
/// without potential and of drives; momentum less the impulse of gravity, loads and of joints to the world.
/// Supplies are integrated with the quadrature of the method: its Gauss points, or the Gauss-Lobatto rule of
/// the motion's own nodes, which makes momentum balances exact: lobatto's at all element ends, those of the
/// elements `mixed` with a natural start at the ends of blocks. A motion without Gauss points, with X of
/// degree 1 and one multiplier an element was stepped: midpoint's supplies are taken in the middle (momentum
/// balances exact), those of a method of order 1 at the end of the element (linear momentum exact). Rows
/// without multipliers leave the joints' impulse in the drift.
struct Balance : BalanceFigures {
    std::vector<double> t;
    std::vector<double> kinetic;
    std::vector<double> potential;
    std::vector<double> energy;
    std::vector<double> work;   ///< of loads without potential and of drives, since the start
    std::vector<Vector3> linear_momentum;
    std::vector<Vector3> angular_momentum;
    std::vector<Vector3> linear_impulse;   ///< supplied since the start
    std::vector<Vector3> angular_impulse;
    std::vector<double> energy_drift;   ///< |energy - start - work|
    std::vector<double> linear_momentum_drift;
    std::vector<double> angular_momentum_drift;
};
Balance balance(const Model& model, const Motion& motion);
/// The same, `n_ends` element ends at a time, for motions that leave no room for more: `take` is handed one
/// piece after the other, each with the figures so far.
BalanceFigures balance(const Model& model, const Motion& motion, int n_ends,
                       const std::function<void(Balance&)>& take);

double kinetic_energy(const Model& model, std::span<const Matrix34> X, std::span<const Matrix34> V);
/// Gravity (body of mass M at height: -M g . x) and the loads' potentials.
/// `angles`: of loads, see Turns.
double potential_energy(const Model& model, Instant at, std::span<const Matrix34> X,
                        std::span<const Matrix34> V, std::span<const double> angles = {});
Vector3 linear_momentum(std::span<const Matrix34> P);
/// About the world's origin: sum over bodies of sum over columns x_c cross p_c.
Vector3 angular_momentum(std::span<const Matrix34> X, std::span<const Matrix34> P);

/// Integrals over each element by Gauss quadrature with degree + 2 points (twice as many for NURBS), or at
/// the points of the method's loads where these are as exact: of L = T - V, of H = T + V and of the angular
/// momentum about the world's origin (P36), whose last term, d_i x lambda_ij d_j, is zero identically. The
/// kinetic energy is that of the momentum where the motion has a field of it, H = T*(P) + V and L = tr(P
/// X'^T) - H as in Livens' principle, else that of dX/dt.
struct ActionSeries {
    std::vector<double> lagrangian;          ///< J s per element
    std::vector<double> hamiltonian;         ///< J s per element
    std::vector<Vector3> angular_momentum;   ///< N m s^2 per element
};
ActionSeries action(const Model& model, const Motion& motion);
/// Of the elements `first` to `last` - 1 alone.
ActionSeries action(const Model& model, const Motion& motion, int first, int last);

/// How much a motion alternates from node to node: 0 for a smooth one, 1 for a pure zig-zag.
///
/// With g the mean velocities over X.degree equal steps an element, in the metric of the masses, and d2 g
/// their second differences, the value is the largest over windows of `window` steps of
///
///     (mean |d2 g|^2 / 16 / max(mean |g|^2, the same over the whole motion))^(1/2)  <= 1.
///
/// It is sin^2(theta / 2) for an oscillation by theta a step (0.23 at 1 rad), and for an alternating part of
/// the velocity about its share: an alternating error of X of order h^2 shows with order h and means little,
/// a motion of which as much alternates as does not has 0.7. Centres of mass and spins about them are judged
/// apart, so that a fast flight does not hide a trembling body (spins relative to at least 1e-3 of all
/// speed). Velocities that an error of X by 1e-11 of its size, or by 1e-13 of the model's length, would make
/// count as none, and motions of less than six steps as smooth. Steps lie inside elements and are divided by
/// their lengths, so neither jumps of X between blocks nor uneven elements alternate; kinks of the velocity
/// are steps of g, which have little.
///
/// The same for the momentum, g being its field at P.degree equal steps an element. Without such a field it
/// is the velocities at element ends for X of degree 1, and else the value of X again.
struct Zigzag {
    double positions = 0;
    double momenta = 0;
    double worst_time = 0;   ///< middle of the worst window of the larger, s
};
/// A motion that is not a number has values that are not. Throws InputError for a window below 6.
Zigzag zigzag(const Model& model, const Motion& motion, int window = 16);

/// How far the polynomial of an element is from the velocity that its momentum has at its end, and with Radau
/// points, which meet that velocity at the end, at its start: the largest
///
///     h |V - X_h'|      of the centre of mass by the model's length, of directors by sqrt(2)
///
/// over bodies and elements. It is of order h^(degree + 1) for elements that resolve the motion, and of the
/// size of the motion inside an element for those that do not, however well their balances close.
struct VelocityJump {
    double largest = 0;
    double time = 0;   ///< end of the worst element, s
};
VelocityJump velocity_jump(const Model& model, const Motion& motion);
/// Of every element, of its worst body; of elements first to last - 1.
std::vector<double> velocity_jumps(const Model& model, const Motion& motion);
std::vector<double> velocity_jumps(const Model& model, const Motion& motion, int first, int last);

/// What an element with such a velocity jump J adds to the error of X, in lengths of the model or rad:
///
///     C_p J^q      q = (2p + 1) / (p + 1) with Gauss-Lobatto points, 2p / (p + 1) with Radau points
///
/// so that it has the order of the local error, h^(2p + 1) or h^(2p). C_p is a median over problems
/// (docs/theory.md, "The local error"); single elements are off by a factor of 5 or so to both sides.
double local_error(Points points, int degree, double jump);

/// Largest violations of joint rows, each divided by its scale, and of rigidity |1/2 (d_a . d_b - delta_ab)|,
/// which point masses do not have. A motion that is not a number has violations that are not. Where X jumps
/// between elements both sides of the instant are nodes.
struct ViolationReport {
    double joints_at_nodes = 0;
    double rigidity_at_nodes = 0;
    double joints_between = 0;   ///< at `samples` points inside each gap between nodes
    double rigidity_between = 0;
    /// Largest |integral of Phi over an element| / (h scale), for any method: the mean, which is small where
    /// a method holds constraints as integrals and Phi itself is not.
    double joints_weakly = 0;
    double rigidity_weakly = 0;
    double velocity_level = 0;   ///< |dPhi/dt| / scale at element ends, 1/s
    int worst_row = -1;          ///< of the model, at nodes; -1: no row is violated at all
    double worst_time = 0;       ///< of that row
};
/// Without `means` nothing is integrated. Throws InputError for a negative number of samples.
ViolationReport violations(const Model& model, const Motion& motion, int samples = 3, bool means = true);

/// The largest at each node, in the order of X's coefficients.
struct NodeViolations {
    std::vector<double> joints;   ///< |Phi| / scale
    std::vector<double> rigidity;
};
NodeViolations node_violations(const Model& model, const Motion& motion);

/// What is told of every element end, element and node.
struct MotionSeries {
    Balance balance;
    ActionSeries integrals;   ///< empty: not made; action() does
    NodeViolations nodes;
};

/// The six rigidity multipliers of a body (11, 22, 33, 12, 13, 23) from X'', forces and joint multipliers at
/// an instant: lambda_ab = (F - G^T lambda - X'' m)_a . d_b, N m; tension is positive. Zero for a point mass.
///
/// They are the components of the symmetric tensor of (P4), which close the law as
/// P'_a = (F - G^T lambda)_a - sum_b lambda_ab d_b. As (P4) has each off-diagonal row twice, the multiplier
/// of a single such row of rigidity_rows is 2 lambda_ab.
std::vector<double> rigidity_multipliers(const Model& model, int body, Instant at,
                                         std::span<const Matrix34> X, std::span<const Matrix34> V,
                                         std::span<const Matrix34> A, std::span<const double> multipliers,
                                         std::span<const double> angles = {});

}   // namespace livens
