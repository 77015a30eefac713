// SPDX-License-Identifier: BSD-3-Clause
// The equations of one step of a classical rule, in directors with weak rigidity.
#pragma once

#include <string>
#include <vector>

#include "livens/dynamics/start/consistent_start.h"
#include "livens/multibody/model.h"
#include "livens/solvers/sparse_rows.h"
#include "livens/stepping/stepping.h"

namespace livens::inline stepping_internal {

/// Where a step begins.
struct StepStart {
    double t = 0;
    double h = 0;
    std::vector<Matrix34> X;   ///< q0
    std::vector<Matrix34> P;   ///< p0
};

/// Both rules are one formula with a number a: 1/2 for the midpoint, 1 for the endpoint. At the time t_a = t0
/// + a h,
///
///     q_a = q0 + a u,   V_a = u / h,   p_a = u m / h,   u = q1 - q0
///     p1 - p0 = h (F_a - G(q_a)^T lambda),   p_a = (1 - a) p0 + a p1,   Phi(q1) = 0
///
/// The momentum p1 is eliminated, and the rows are multiplied by a h, the multipliers by a h^2: unknown are u
/// and Lambda = a h^2 lambda in
///
///     u m - h p0 - a h^2 F_a + G(q_a)^T Lambda = 0,   Phi(q0 + u) = 0
///
/// so that no entry of the tangent grows when h becomes small. Never is m inverted.
class StepEquations {
public:
    /// Rows of `assembly.independent`, then the six rigidity rows of every body.
    StepEquations(const Model& model, const ConsistentStart& assembly, SteppingRule rule);

    /// Unknowns: u, twelve numbers a body (columns of X) or three a point mass, then Lambda.
    int size() const { return n_displacements_ + static_cast<int>(rows_.size()); }

    struct System {
        std::vector<double> residual;
        std::vector<SparseEntry> tangent;
        std::string not_finite;   ///< the load whose force or tangent is not finite; empty: none
    };
    System evaluate(const StepStart& start, const std::vector<double>& unknowns) const;

    /// The matrix [m (x) I3, G^T; G, 0] in the configuration X and the right-hand side [P; 0]: its solution
    /// begins with the velocity V nearest to m^-1 P, in the metric of the mass, that keeps joints and bodies:
    /// G V = 0.
    System projection(const std::vector<Matrix34>& X, const std::vector<Matrix34>& P) const;

    /// Body by body; zero outside the first column for point masses.
    std::vector<Matrix34> displacements(const std::vector<double>& unknowns) const;
    /// lambda of all rows of the model, 0 for those that are dropped.
    std::vector<double> multipliers(const std::vector<double>& unknowns, double h) const;
    /// q1 and p1.
    StepStart next(const StepStart& start, const std::vector<double>& unknowns) const;

    /// Largest scaled entry: |du_0| / L for points, |du_i| for directors. Multipliers do not count.
    double increment_size(const std::vector<double>& increment) const;
    struct Worst {
        double value = 0;
        std::string name;   ///< "joint 'b' (row 'x')", "the momentum of body 'c'"
    };
    /// Largest scaled residual: rows of momentum over M L or tr E, constraints |Phi| / scale.
    Worst worst_residual(const std::vector<double>& residual) const;

private:
    struct Row {
        ConstraintRow form;
        int model_row;   ///< -1: rigidity
    };

    int n_numbers(int body) const { return model_.bodies()[body].is_point ? 3 : 12; }
    std::string row_name(const Row& row) const;
    void add_mass(System& system) const;
    void add_constraints(const std::vector<Matrix34>& X_0, const std::vector<Matrix34>& X_a,
                         const std::vector<Matrix34>& X_1, const std::vector<double>& unknowns,
                         System& system) const;
    void add_hessian(const ConstraintRow& row, const std::vector<Matrix34>& X, double factor,
                     System& system) const;
    void add_loads(const StepStart& start, const std::vector<Matrix34>& X_a, const std::vector<Matrix34>& V_a,
                   System& system) const;
    void add_force(int body, double factor, const Matrix34& F, System& system) const;
    void add_columns(int body, int by, double factor, const Matrix4& C, System& system) const;

    const Model& model_;
    double a_;
    double length_;
    std::vector<int> first_;   ///< unknown of each body
    int n_displacements_ = 0;
    std::vector<Row> rows_;
};

}   // namespace livens::inline stepping_internal
