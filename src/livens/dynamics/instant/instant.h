// SPDX-License-Identifier: BSD-3-Clause
// The state at an element end: velocity from the momentum, acceleration and reactions from the equations of
// motion.
#pragma once

#include <vector>

#include "livens/dynamics/lanes/joint_factor.h"
#include "livens/dynamics/lanes/load_lanes.h"
#include "livens/dynamics/rows/constraint_basis.h"

namespace livens::inline dynamics_internal {

/// What constraints hold at an instant: independent rows, and what solves for them.
struct HeldRows {
    std::vector<int> rows;    ///< chosen here, they serve the next element
    bool are_new = false;     ///< others than before, see InstantSystem::prepare()
    JointFactor joints;       ///< of these rows, where the system is sparse
    bool by_joints = false;   ///< by elimination along the joints
    ConstraintBasis basis;    ///< of these rows, if has_basis
    bool has_basis = false;
    double smallest_pivot = 1;
};

/// Everything the next element, and the motion, need of one instant.
struct InstantState {
    double t = 0;
    std::vector<double> angles;     ///< of loads, see Turns
    std::vector<double> X;          ///< 12 a body
    std::vector<double> X_low;      ///< what rounding took off X, see add_increments()
    std::vector<double> maps;       ///< of the scaled twists, 12 a body
    std::vector<double> velocity;   ///< twists [v, w]
    std::vector<double> p;          ///< momentum and spin of each body, tangent to the constraints; handed on
    std::vector<double> momentum;   ///< p in scaled rows
    std::vector<double> acceleration[2];   ///< twists [a, alpha]; left and right of a jump of loads
    std::vector<double> multipliers[2];    ///< at the acceleration level, all rows of the model; likewise
    std::vector<double> jerk,
        snap;   ///< second and third derivative of the twist, extrapolated; zero without past
    bool has_past = false;
    HeldRows held;

    void resize(const ModelTables& tables);
    /// All but what its rows hold: they are the same, and have to be prepared.
    void take(const InstantState& other);
    /// jerk and snap of the cubic through velocity and acceleration here and at an earlier end; for guesses.
    /// `forwards`: the earlier end has the smaller t.
    void look_back(const InstantState& earlier, bool forwards);
    void forget_past();
};

/// Solves at one instant (docs/theory.md, "Element ends").
class InstantSystem {
public:
    /// `sparse`: by elimination along the joints where they hold well, JointFactor::serves() must be true;
    /// else by orthogonal bases.
    explicit InstantSystem(const ModelTables& tables, bool sparse = false);

    /// Whether no law of a load is near a bend, see LoadsAtInstant.
    void trust_tapes(bool are_trusted) { tapes_are_trusted_ = are_trusted; }
    /// Trusts and chooses rows as another one, which is where this one begins, would from now on.
    void choose_as(const InstantSystem& other)
    {
        tapes_are_trusted_ = other.tapes_are_trusted_;
        pivot_at_choice_ = other.pivot_at_choice_;
    }

    /// Prepares maps and what constraints hold at state.t and state.X, with the given independent rows as
    /// long as they are fit: the others hold to 1e-9 of their scale, and the smallest scaled pivot is above
    /// 1e-6 and a tenth of what it was when they were chosen; else rows are chosen again among all
    /// (HeldRows::are_new). False if a free motion carries no inertia.
    /// `known` is exchanged with the state's basis where it serves: built for this X with all rows of the
    /// model, as are then state.maps.
    bool prepare(InstantState& state, const std::vector<int>& rows, ConstraintBasis* known = nullptr,
                 const NearFactor& near = {});
    /// The basis of a prepared state, where there is none.
    void add_basis(InstantState& state) const;
    /// X of a prepared state <- what its chosen rows allow there, nearest in the mass metric, and prepared
    /// anew. False: it does not come within 1e-12 of their scale, and all is as it was.
    bool close(InstantState& state);
    /// velocity and momentum <- the parts of a given twist momentum N^T P that the constraints and their
    /// drives allow, Ghat velocity = -dPhi/dt (explicit). `lambda` <- the multipliers of the rest, W Ghat^T
    /// lambda = N^T P - Mr velocity; all rows of the model, zero for rows that are not chosen.
    void from_momentum(InstantState& state, const double* p, double weight, double* lambda);
    /// momentum <- that of state.velocity, which is consistent.
    void from_velocity(InstantState& state);
    /// acceleration <- what generalised forces alone, 12 numbers a body, would accelerate: a twist, with what
    /// the constraints of the prepared state do to it.
    void respond(InstantState& state, const double* raw, double* acceleration);
    /// Accelerations and multipliers on one side.
    void accelerate(InstantState& state, Side side);

    /// Rows of the combination that is nearest to zero, by more than a thousandth of its largest part: where
    /// the joints lose rank, what their multipliers hold grows without bound.
    std::vector<int> weak_rows(InstantState& state) const;

    /// X' and [0, w x (w x d_a)] of the last state that was accelerated, 12 numbers a body.
    const double* rates() const { return V_.data(); }
    const double* centripetal() const { return centripetal_.data(); }

private:
    void give_room(ConstraintBasis& basis) const;
    void hold(InstantState& state, const std::vector<int>& rows, const NearFactor& near = {});
    bool rows_are_fit(const InstantState& state);
    bool prepare_singular(const InstantState& state);
    void apply_mass(const InstantState& state, const double* y, double* out);
    void solve(const InstantState& state, double* forces, double* y);
    double move_towards_rows(InstantState& state);
    void follow_drives(const InstantState& state, double* y) const;
    void particular(const InstantState& state, Side from, double* y) const;
    void scatter(const InstantState& state, double* y, double weight, double* lambda) const;

    const ModelTables& tables_;
    LoadsAtInstant loads_;
    Cholesky reduced_;        // Z^T M Z, used only where an inertia is singular
    std::vector<double> z_;   // null space, n x f; likewise
    std::vector<double> a_, b_, V_, centripetal_, raw_, row_rates_;
    bool is_sparse_, tapes_are_trusted_ = false;
    std::shared_ptr<const RowPattern> pattern_;   // of the last rows
    double pivot_at_choice_ = 0;
};

}   // namespace livens::inline dynamics_internal
