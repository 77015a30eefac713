// What is conserved, and how well: free functions of a motion, whoever made it.
#pragma once

#include <span>
#include <vector>

#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"

namespace livens {

/// Energies (J), momenta (N s, N m s about the world's origin) and their balances at the element ends.
///
/// Balances are what is left when the supply since the start is taken off: energy less the work of loads
/// without potential; momentum less the impulse of gravity, loads and of joints to the world. Supplies are
/// integrated with the Gauss-Lobatto rule of the motion's own nodes, which makes lobatto's momentum balances
/// exact. A motion with X of degree 1 and one multiplier an element was stepped: midpoint's supplies are
/// taken in the middle (momentum balances exact), those of a method of order 1 at the end of the element
/// (linear momentum exact). Rows without multipliers leave the joints' impulse in the drift.
struct Balance {
    std::vector<double> t;
    std::vector<double> kinetic;
    std::vector<double> potential;
    std::vector<double> energy;
    std::vector<double> work;   ///< of loads without potential, since the start
    std::vector<Vector3> linear_momentum;
    std::vector<Vector3> angular_momentum;
    std::vector<Vector3> linear_impulse;   ///< supplied since the start
    std::vector<Vector3> angular_impulse;
    std::vector<double> energy_drift;   ///< |energy - start - work|
    std::vector<double> linear_momentum_drift;
    std::vector<double> angular_momentum_drift;
    double largest_kinetic = 0;    ///< over the ends
    double largest_moment = 0;     ///< largest sum over bodies and columns of |x| |P|
    double reference_energy = 0;   ///< J: all weights times the model's length, plus the largest |potential|
    double reference_moment = 0;   ///< N m s: integral of the sum over all forces and columns of |x| |F|

    /// Largest drift relative to the largest kinetic energy; to the reference energy if nothing moves, that
    /// is largest_kinetic <= 1e-9 reference_energy (what is left is rounding of the reference).
    double relative_energy_drift() const;
    /// Largest drift relative to largest_moment; to reference_moment if largest_moment <= 1e-9
    /// reference_moment.
    double relative_angular_momentum_drift() const;
};
Balance balance(const Model& model, const Motion& motion);

double kinetic_energy(const Model& model, std::span<const Matrix34> X, std::span<const Matrix34> V);
/// Gravity (body of mass M at height: -M g . x) and the loads' potentials.
double potential_energy(const Model& model, Instant at, std::span<const Matrix34> X,
                        std::span<const Matrix34> V);
Vector3 linear_momentum(std::span<const Matrix34> P);
/// About the world's origin: sum over bodies of sum over columns x_c cross p_c.
Vector3 angular_momentum(std::span<const Matrix34> X, std::span<const Matrix34> P);

/// Integrals over each element of L = T - V and of H = T + V by Gauss quadrature with degree + 2 points.
struct ActionSeries {
    std::vector<double> lagrangian;    ///< J s per element
    std::vector<double> hamiltonian;   ///< J s per element
};
ActionSeries action(const Model& model, const Motion& motion);

/// Largest violations of joint rows, each divided by its scale, and of rigidity |1/2 (d_a . d_b - delta_ab)|,
/// which point masses do not have. A motion that is not a number has violations that are not.
struct ViolationReport {
    double joints_at_nodes = 0;
    double rigidity_at_nodes = 0;
    double joints_between = 0;   ///< at `samples` points inside each gap between nodes
    double rigidity_between = 0;
    double velocity_level = 0;   ///< |dPhi/dt| / scale at element ends, 1/s
    int worst_row = -1;          ///< of the model, at nodes; -1: no row is violated at all
    double worst_time = 0;       ///< of that row
};
/// Throws InputError for a negative number of samples.
ViolationReport violations(const Model& model, const Motion& motion, int samples = 3);

/// The six rigidity multipliers of a body (11, 22, 33, 12, 13, 23) from X'', forces and joint multipliers at
/// an instant: lambda_ab = (F - G^T lambda - X'' m)_a . d_b, N m; tension is positive. Zero for a point mass.
///
/// They are the components of the symmetric tensor of (P4), which close the law as
/// P'_a = (F - G^T lambda)_a - sum_b lambda_ab d_b. As (P4) has each off-diagonal row twice, the multiplier
/// of a single such row of rigidity_rows is 2 lambda_ab.
std::vector<double> rigidity_multipliers(const Model& model, int body, Instant at,
                                         std::span<const Matrix34> X, std::span<const Matrix34> V,
                                         std::span<const Matrix34> A, std::span<const double> multipliers);

}   // namespace livens
