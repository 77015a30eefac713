// SPDX-License-Identifier: BSD-3-Clause
// The classical rules step by step: midpoint and implicit Euler, theory.md, "The witnesses". Written apart
// from the elements on purpose, with Newton's plain iteration and a fresh tangent each time: a mistake of the
// engine cannot be one of its witness.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/multibody/mass_properties.h"
#include "livens/solvers/factors.h"
#include "livens/solvers/sparse_rows.h"
#include "livens/stepping/step_equations.h"
#include "livens/stepping/stepping.h"

namespace livens::inline stepping_internal {

namespace {

using System = StepEquations::System;

/// Solves the system; false if the matrix is singular. Rows are divided by their largest entry first, so that
/// the choice of pivots does not depend on the units.
class LinearSolver {
public:
    explicit LinearSolver(int size) : size_(static_cast<std::size_t>(size)) {}

    bool solve(const System& system, std::vector<double>& solution)
    {
        // Rows of forces and of constraints have different units; without scaling partial pivoting would
        // compare them.
        std::vector<double> largest(size_, 0.0), rhs(size_);
        for (const SparseEntry& e : system.tangent)
            largest[e.row] = std::max(largest[e.row], std::abs(e.value));
        if (!std::ranges::all_of(largest, [](double size) { return size > 0 && std::isfinite(size); }))
            return false;
        for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = system.residual[i] / largest[i];
        std::vector<SparseEntry> scaled = system.tangent;
        for (SparseEntry& e : scaled) e.value /= largest[e.row];
        auto x = rhs.size() <= dense_until ? dense(scaled, rhs) : sparse_solution(scaled, rhs);
        if (!x) return false;
        solution = std::move(*x);
        return all_finite(solution);
    }

private:
    static constexpr std::size_t dense_until = 200;

    std::optional<std::vector<double>> dense(const std::vector<SparseEntry>& entries,
                                             const std::vector<double>& rhs) const
    {
        const int n = static_cast<int>(rhs.size());
        DenseMatrix A(n, n);
        for (const SparseEntry& e : entries) A(e.row, e.column) += e.value;
        LUSolution solution = lu_solution(A, rhs);
        // Inequality: smallest pivot > eps / 1000 of the largest. Below, the solution would be made of
        // rounding.
        if (!(solution.smallest_pivot >
              std::numeric_limits<double>::epsilon() * 1e-3 * solution.largest_pivot))
            return {};
        return std::move(solution.x);
    }

    std::size_t size_;
};

/// Below, a tolerance that rounding did not let be met deserves a word; the default is no promise of digits.
constexpr double finest_tolerance = 1e-12;

/// What Newton's iteration came to in one step.
struct StepOutcome {
    SolveStatus status = SolveStatus::converged;
    int iterations = 0;
    bool is_growing = false;      ///< the last increment was longer than the one before
    bool is_rounded = false;      ///< ended by rounding, short of the tolerance
    StepEquations::Worst worst;   ///< of the residual at the end
    std::string load;             ///< that is not finite
};

/// The march: its state, and the motion and report it fills.
class Marcher {
public:
    Marcher(const Model& model, const ConsistentStart& assembly, const TimeMesh& mesh, SteppingRule rule,
            const SteppingOptions& options)
        : model_(model), mesh_(mesh), options_(options), equations_(model, assembly, rule),
          solver_(equations_.size()), unknowns_(equations_.size(), 0.0)
    {
        now_.X = assembly.start.X;
        now_.t = mesh.start();
        for (int b = 0; b < model.n_bodies(); ++b)
            now_.P.push_back(assembly.start.V[b] * model.bodies()[b].mass);
        begin_motion(assembly, rule);
        result_.report.unknowns = equations_.size();
        guess_from(assembly.start.V);
    }

    SteppingResult run()
    {
        for (int e = 0; e < mesh_.n_elements() && result_.report.converged(); ++e) step(e);
        if (rounded_ > 0 && options_.tolerance < finest_tolerance)
            result_.report.notes.push_back("the tolerance " + to_text(options_.tolerance, 6) +
                                           " is below rounding: " + std::to_string(rounded_) + " of " +
                                           std::to_string(result_.report.n_elements) +
                                           " steps ended at rounding level");
        return std::move(result_);
    }

private:
    void begin_motion(const ConsistentStart& assembly, SteppingRule rule)
    {
        Motion& motion = result_.motion;
        motion.n_bodies = model_.n_bodies();
        motion.n_rows = model_.n_rows();
        motion.mesh.ends = {mesh_.start()};
        motion.X.n_values = 12 * motion.n_bodies;
        // Between the ends of steps the rules say nothing; the motion is told there by straight lines.
        motion.X.degree = 1;
        motion.multipliers.n_values = motion.n_rows;
        motion.multipliers.degree = 0;
        motion.multipliers.continuous = false;
        motion.order_at_ends = rule == SteppingRule::midpoint ? 2 : 1;
        motion.dense_order_X = motion.order_at_ends;
        motion.dense_order_V = 1;
        motion.gauss_points = rule == SteppingRule::midpoint ? 1 : 0;
        motion.constraints_hold = ConstraintsHold::at_element_ends;
        motion.redundant_rows = assembly.redundant;
        for (const std::string& note : assembly.notes) result_.report.notes.push_back(note);
        append_end(assembly.start.V);
    }

    void append_end(const std::vector<Matrix34>& velocities)
    {
        Motion& motion = result_.motion;
        for (const Matrix34& X : now_.X)
            motion.X.values.insert(motion.X.values.end(), std::begin(X.a), std::end(X.a));
        motion.momenta.insert(motion.momenta.end(), now_.P.begin(), now_.P.end());
        motion.velocities.insert(motion.velocities.end(), velocities.begin(), velocities.end());
    }

    /// First guess: the velocity at the start goes on. Later steps begin with the step before them.
    void guess_from(const std::vector<Matrix34>& V)
    {
        int at = 0;
        for (int b = 0; b < model_.n_bodies(); ++b)
            for (int c = 0; c < (model_.bodies()[b].is_point ? 3 : 12); ++c) unknowns_[at++] = V[b][c];
        displacements_ = at;
        guess_h_ = 1;
    }

    /// The guess for a step of length h: displacements grow with h, Lambda with h^2.
    std::vector<double> guess(double h) const
    {
        const double ratio = h / guess_h_;
        std::vector<double> x = unknowns_;
        for (int i = 0; i < static_cast<int>(x.size()); ++i)
            x[i] *= i < displacements_ ? ratio : ratio * ratio;
        return x;
    }

    void step(int element)
    {
        now_.t = mesh_.ends[element];
        now_.h = mesh_.length(element);
        std::vector<double> x = guess(now_.h);
        StepOutcome outcome = newton(x);
        SolveReport& report = result_.report;
        report.newton_iterations += outcome.iterations;
        report.most_iterations = std::max(report.most_iterations, outcome.iterations);

        StepStart next;
        std::vector<Matrix34> V;
        if (outcome.status == SolveStatus::converged) {
            next = equations_.next(now_, x);
            // The momentum has a part along G^T that belongs to the constraint forces; velocities must not.
            if (!velocities(next, V)) outcome.status = SolveStatus::singular;
        }
        if (outcome.status != SolveStatus::converged) {
            fail(outcome);
            return;
        }
        unknowns_ = x;
        guess_h_ = now_.h;
        accept(element, outcome, next, V);
    }

    /// Newton's iteration with a fresh tangent each time.
    ///
    /// Ends when the scaled increment (see StepEquations::increment_size) is at most the tolerance:
    /// convergence is quadratic, so what remains is its square. Or at the rounding level: below 1e-9 and no
    /// longer halved.
    StepOutcome newton(std::vector<double>& x)
    {
        StepOutcome outcome;
        double last = std::numeric_limits<double>::infinity();
        System system = equations_.evaluate(now_, x);
        for (bool done = false; !done;) {
            outcome.load = system.not_finite;
            outcome.worst = equations_.worst_residual(system.residual);
            if (!system.not_finite.empty() || !std::isfinite(outcome.worst.value)) {
                outcome.status = SolveStatus::not_finite;
                return outcome;
            }
            if (outcome.iterations == options_.max_iterations) {
                outcome.status = SolveStatus::not_converged;
                return outcome;
            }
            std::vector<double> increment;
            ++result_.report.factorisations;
            ++outcome.iterations;
            if (!solver_.solve(system, increment)) {
                outcome.status = SolveStatus::singular;
                return outcome;
            }
            for (std::size_t i = 0; i < x.size(); ++i) x[i] -= increment[i];
            const double size = equations_.increment_size(increment);
            outcome.is_rounded = size > options_.tolerance && size < 1e-9 && size > 0.5 * last;
            outcome.is_growing = size > last;
            done = size <= options_.tolerance || outcome.is_rounded;
            last = size;
            system = equations_.evaluate(now_, x);
        }
        outcome.worst = equations_.worst_residual(system.residual);
        return outcome;
    }

    /// The velocity that belongs to the momentum and keeps the constraints: [v, w x d_i].
    bool velocities(const StepStart& end, std::vector<Matrix34>& V)
    {
        std::vector<double> solution;
        if (!solver_.solve(equations_.projection(end.X, end.P), solution)) return false;
        V = equations_.displacements(solution);
        return true;
    }

    void accept(int element, const StepOutcome& outcome, const StepStart& next,
                const std::vector<Matrix34>& V)
    {
        Motion& motion = result_.motion;
        SolveReport& report = result_.report;
        const std::vector<double> lambda = equations_.multipliers(unknowns_, now_.h);
        motion.multipliers.values.insert(motion.multipliers.values.end(), lambda.begin(), lambda.end());
        motion.mesh.ends.push_back(mesh_.ends[element + 1]);
        now_ = next;
        append_end(V);
        report.iterations.push_back(outcome.iterations);
        if (outcome.is_rounded) ++rounded_;
        report.residual_norm = std::max(report.residual_norm, outcome.worst.value);
        report.n_elements = element + 1;
        if (!options_.progress) return;
        const Progress progress{element + 1, mesh_.n_elements(), mesh_.ends[element + 1], outcome.iterations,
                                outcome.worst.value};
        if (options_.progress(progress) || element + 1 == mesh_.n_elements()) return;
        report.status = SolveStatus::cancelled;
        report.failed_at = mesh_.ends[element + 1];
        report.message = "cancelled at t = " + to_text(report.failed_at, 6) + " s";
    }

    void fail(const StepOutcome& outcome)
    {
        SolveReport& report = result_.report;
        report.status = outcome.status;
        report.failed_at = now_.t;
        const std::string where =
            " in the step from t = " + to_text(now_.t, 6) + " s to " + to_text(now_.t + now_.h, 6) + " s";
        const std::string worst = outcome.worst.name.empty()
                                      ? ""
                                      : "; the largest residual is " + to_text(outcome.worst.value, 6) +
                                            " in " + outcome.worst.name;
        if (!outcome.load.empty()) {
            report.message = outcome.load + where;
        } else if (outcome.status == SolveStatus::not_finite) {
            report.message = "the state is not finite" + where + worst + "; take shorter steps";
        } else if (outcome.status == SolveStatus::singular) {
            report.message =
                "the tangent is singular" + where + worst + "; the joints may have lost rank there";
        } else {
            const std::string n =
                std::to_string(outcome.iterations) + (outcome.iterations == 1 ? " iteration" : " iterations");
            report.message = "Newton's iteration did not converge in " + n + ", the limit," +
                             (outcome.is_growing ? " and was still diverging" : "") + where + worst +
                             "; take shorter steps";
        }
    }

    const Model& model_;
    const TimeMesh& mesh_;
    const SteppingOptions& options_;
    StepEquations equations_;
    LinearSolver solver_;
    SteppingResult result_;
    StepStart now_;
    std::vector<double> unknowns_;   ///< of the step before
    double guess_h_ = 1;             ///< and its length
    int displacements_ = 0;
    int rounded_ = 0;   ///< steps that ended by rounding, short of the tolerance
};

}   // namespace

/// Every entry of the mass matrix takes part in the equations of a director, so a vanishing second moment is
/// a missing equation.
void check_stepping(const Model& model)
{
    for (const Body& body : model.bodies()) {
        if (!is_singular(body.mass, body.is_point)) continue;
        throw InputError(
            {"mass-singular", "body[" + body.name + "].inertia",
             "the mass matrix of body '" + body.name + "' is singular, which classical stepping cannot use",
             "", "J1 + J2 > J3 for every principal moment",
             "a lamina or a needle has no extent along some axis, so one of its directors has no inertia",
             "use the method lobatto, or give the body a little thickness"});
    }
}

SteppingResult march_stepping(const Model& model, const ConsistentStart& assembly, const TimeMesh& mesh,
                              SteppingRule rule, const SteppingOptions& options)
{
    assert(!mesh.ends.empty() && static_cast<int>(assembly.start.X.size()) == model.n_bodies());
    check_stepping(model);
    return Marcher(model, assembly, mesh, rule, options).run();
}

}   // namespace livens::inline stepping_internal
