// SPDX-License-Identifier: BSD-3-Clause
// Newton's iteration with one rule of damping and one of stopping for all families: theory.md, "Newton's
// iteration". Steps are judged by the natural level function [Deuflhard2011, section 3.3], the size of the
// next increment with the same factors, which does not depend on how rows are scaled.
#include "livens/solvers/newton.h"
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "livens/base/elementary.h"
#include "livens/solvers/patience.h"

namespace livens {

namespace {

constexpr double shortest_step = 1.0 / 1024;
constexpr double hopeless_size = 1e3;      // of an increment of which only the shortest step is taken
constexpr double rounding_begins = 1e-9;   // below, an increment that no longer shrinks is rounding
constexpr double slow_contraction = 0.3;
constexpr double far_step = 0.1;   // where rows were made that far apart they foretell no contraction
constexpr int most_whole_steps = 9;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// What is to be added, and how much that is.
struct Increment {
    Room& values;
    double size = 0;
};

class Iteration {
public:
    Iteration(NewtonProblem& problem, const NewtonOptions& options, Increment increment, Increment next)
        : problem_(problem), options_(options), increment_(increment), next_(next)
    {}

    NewtonReport run()
    {
        try {
            return iterate();
        } catch (const Stopped&) {
            report_.residual = infinite;
            fail(SolveStatus::cancelled);
            return report_;
        }
    }

private:
    NewtonReport iterate()
    {
        are_finite_ = problem_.residual();
        problem_.keep();
        Verdict verdict = problem_.n_unknowns() == 0 ? Verdict::converged : Verdict::new_factors;
        if (!are_finite_) verdict = fail(SolveStatus::not_finite);
        while (verdict == Verdict::new_factors) verdict = use_new_factors();
        report_.residual = infinite;
        if (!are_finite_) return report_;
        const NewtonProblem::Rows rows = problem_.rows();
        report_.residual = rows.terms > 0 ? rows.size / rows.terms : rows.size;
        return report_;
    }

    enum class Verdict { converged, new_factors, failed };

    /// New factors at the kept point, which is the current one, and steps with them as long as they serve.
    Verdict use_new_factors()
    {
        if (report_.iterations >= options_.max_iterations) return stop_at_limit();
        if (options_.goes_on && !options_.goes_on(report_.iterations)) return fail(SolveStatus::cancelled);
        ++report_.factorisations;
        rows_before_ = problem_.rows().size;
        if (!problem_.factorise() || !solve(increment_)) return fail(SolveStatus::singular);
        are_fresh_ = true;
        size_before_ = 0;
        // Damping at most doubles from step to step, so that a difficult stretch is not left by a leap.
        double damping = std::min(1.0, 2 * damping_);
        for (;;) {
            look_ahead(damping);
            // A damped step leaves a share of the increment undone by design; its size says nothing about
            // convergence.
            const bool is_done = damping == 1 && (within_tolerance() || at_rounding());
            if (!is_done && !shrinks(next_.size, increment_.size, damping)) {
                if (!are_fresh_ || damping <= shortest_step) return go_back();
                damping /= 2;
                continue;
            }
            accept(damping);
            if (is_done) return finish();
            // Such a step makes no visible way: of a thousand lengths it goes one, and would go on so for all
            // iterations.
            if (damping <= shortest_step && increment_.size > hopeless_size)
                return fail(SolveStatus::not_converged);
            if (report_.iterations >= options_.max_iterations) return stop_at_limit();
            if (!are_worth_another_step() || !advance()) return Verdict::new_factors;
        }
    }

    /// False if the increment is not finite.
    bool solve(Increment& increment)
    {
        problem_.solve(increment.values);
        increment.size = problem_.size_of(increment.values);
        return std::isfinite(increment.size);
    }

    /// Takes the step for a trial, and finds the size of the next increment with the same factors; infinite
    /// where there is none. It is solved for only where the rows do not foretell enough.
    void look_ahead(double damping)
    {
        next_.size = infinite;
        is_solved_ = false;
        are_finite_ = problem_.move(increment_.values, damping) && problem_.residual();
        if (!are_finite_) return;
        rows_ = problem_.rows();
        tolerance_ = options_.tolerance * problem_.scale();
        if (rows_.foretell) {
            // rows that were zero can only have met their rounding
            const double rate = rows_before_ > 0 ? rows_.size / rows_before_ : (rows_.size > 0 ? 1 : 0);
            // Where rows shrink as increments do, the solution with the same factors is spared ("Newton's
            // iteration").
            next_.size = increment_.size * rate;
            if (damping == 1 && (within_tolerance() || at_rounding())) return;
            if (shrinks(next_.size, increment_.size, damping)) return;
        }
        is_solved_ = true;
        if (!solve(next_)) next_.size = infinite;
    }

    static bool shrinks(double next, double size, double damping)
    {
        return next <= (1 - damping / 4) * size && std::isfinite(next);
    }

    /// All that is left to do, as far as it is known.
    double left() const { return next_.size + rows_.correction; }

    bool within_tolerance() const
    {
        // Inequality: next increment + correction <= tolerance * scale, and rows <= tolerance * terms where
        // they are known.
        return left() <= tolerance_ && (!rows_.foretell || rows_.size <= options_.tolerance * rows_.terms);
    }

    bool at_rounding() const
    {
        // An iteration that still contracts well is not at its rounding, however small its rows are.
        if (!std::isfinite(next_.size) || next_.size <= 0.25 * increment_.size) return false;
        if (rows_.size < 4 * rows_.rounding) return true;
        return are_fresh_ && increment_.size < rounding_begins && next_.size > 0.5 * increment_.size;
    }

    void accept(double damping)
    {
        problem_.keep();
        damping_ = damping;
        rows_before_ = rows_.size;
        ++report_.iterations;
        whole_steps_ = damping == 1 ? whole_steps_ + 1 : 0;
        report_.last_increment = damping * increment_.size;
        report_.contraction = increment_.size > 0 ? next_.size / increment_.size : 0;
        report_.smallest_damping = std::min(report_.smallest_damping, damping);
    }

    /// Whether the factors contract well enough after the step that was accepted, to be used for the next.
    bool are_worth_another_step() const
    {
        if (damping_ < 1) return false;
        double contraction = report_.contraction;
        if (!is_solved_) {
            // Increments themselves tell, if there are two. With one there is only what the rows left of a
            // step much longer than those to come: a tenth of it is taken.
            contraction = size_before_ > 0 ? increment_.size / size_before_ : 0.1 * contraction;
            if (increment_.size > far_step) return false;
        }
        // With a constant contraction c the tolerance is met after log(tolerance / left) / log(c) more steps.
        // The bound 0.9 keeps the denominator away from zero.
        const double steps_left = logarithm(tolerance_ / left()) / logarithm(std::min(contraction, 0.9));
        return !(contraction > slow_contraction || whole_steps_ + steps_left > most_whole_steps);
    }

    /// The next increment becomes this one. False if it shows only now that factors do not contract.
    bool advance()
    {
        are_fresh_ = false;
        size_before_ = increment_.size;
        if (is_solved_) {
            increment_.values.swap(next_.values);
            increment_.size = next_.size;
            return true;
        }
        return solve(increment_) && shrinks(increment_.size, size_before_, 1);
    }

    /// After the last step was accepted. What was solved for besides is small enough to be safe.
    Verdict finish()
    {
        report_.ended_by_rounding = !within_tolerance();
        // The next increment is already there: taking it costs one residual, and squares what the tolerance
        // leaves.
        if (!is_solved_ || !within_tolerance() || next_.size == 0) return Verdict::converged;
        if (!problem_.move(next_.values, 1) || !problem_.residual())
            return return_to_kept() ? Verdict::converged : fail(SolveStatus::not_finite);
        problem_.keep();
        report_.last_increment = next_.size;
        return Verdict::converged;
    }

    /// Old factors get another chance by being replaced; new ones have had theirs.
    Verdict go_back()
    {
        const bool was_finite = are_finite_;
        if (!return_to_kept()) return fail(SolveStatus::not_finite);
        if (!are_fresh_) return Verdict::new_factors;
        return fail(was_finite ? SolveStatus::not_converged : SolveStatus::not_finite);
    }

    bool return_to_kept()
    {
        are_finite_ = problem_.move(increment_.values, 0) && problem_.residual();
        return are_finite_;
    }

    Verdict stop_at_limit()
    {
        report_.reached_limit = true;
        return fail(SolveStatus::not_converged);
    }

    Verdict fail(SolveStatus status)
    {
        report_.status = status;
        return Verdict::failed;
    }

    NewtonProblem& problem_;
    const NewtonOptions& options_;
    Increment increment_, next_;   // the next one may be foretold alone, without values
    NewtonReport report_;

    NewtonProblem::Rows rows_;   // at the last trial
    double size_before_ = 0;     // of the increment before, with the same factors; 0: none
    double rows_before_ = 0;     // size of the rows at the kept point
    double damping_ = 1;         // of the last accepted step
    double tolerance_ = 0;       // options' times scale, at the last trial
    int whole_steps_ = 0;        // since a damped one
    bool are_fresh_ = true;      // factors: they are the kept point's
    bool are_finite_ = true;     // the rows made last
    bool is_solved_ = false;     // the next increment, not only foretold
};

}   // namespace

NewtonReport Newton::run(NewtonProblem& problem, const NewtonOptions& options)
{
    const auto n = static_cast<std::size_t>(problem.n_unknowns());
    increment_.resize(n);
    next_.resize(n);
    return Iteration(problem, options, {increment_}, {next_}).run();
}

}   // namespace livens
