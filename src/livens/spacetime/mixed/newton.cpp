#include "livens/spacetime/mixed/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace livens::mixed {

namespace {

constexpr double rounding_begins = 1e-9;   // below, an increment that no longer shrinks is rounding
constexpr double good_contraction = 0.25;
constexpr double shortest_step = 1.0 / 1024;

bool finite(const std::vector<double>& values)
{
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

class Iteration {
public:
    Iteration(Equations& equations, Fields& fields, const NewtonOptions& options)
        : equations_(equations), fields_(fields), options_(options), lu_(options.backend)
    {}

    NewtonReport run()
    {
        equations_.scales(fields_, row_scale_, column_scale_);
        if (!evaluate(fields_)) return finish(SolveStatus::not_finite);
        Verdict verdict = equations_.size() == 0 ? Verdict::done : Verdict::new_tangent;
        while (verdict == Verdict::new_tangent) {
            if (report_.iterations >= options_.max_iterations) {
                report_.reached_limit = true;
                return finish(SolveStatus::not_converged);
            }
            if (options_.goes_on && !options_.goes_on(report_.iterations))
                return finish(SolveStatus::cancelled);
            if (!factorise()) return finish(SolveStatus::singular);
            solve(increment_);
            const double size = equations_.size_of(increment_);
            if (!std::isfinite(size)) return finish(SolveStatus::singular);
            verdict = descend(size);
        }
        if (verdict == Verdict::failed) {
            finish(failed_load_.empty() ? SolveStatus::not_converged : SolveStatus::not_finite);
            report_.load = failed_load_;
            return report_;
        }
        if (options_.condition) measure_condition();
        return finish(SolveStatus::converged);
    }

private:
    bool evaluate(const Fields& fields)
    {
        report_.load = equations_.residual(fields, residual_);
        return report_.load.empty() && finite(residual_);
    }

    bool factorise()
    {
        const bool is_new = equations_.tangent(fields_, scaled_);
        for (int c = 0; c < scaled_.size; ++c)
            for (int k = scaled_.column_starts[c]; k < scaled_.column_starts[c + 1]; ++k)
                scaled_.values[k] *= row_scale_[scaled_.rows[k]] * column_scale_[c];
        if (is_new) lu_.analyse(scaled_);
        ++report_.factorisations;
        const bool is_regular = lu_.factorise(scaled_);
        report_.factor_entries = lu_.factor_entries();
        return is_regular;
    }

    /// increment = -J^-1 residual, with one step of refinement.
    void solve(std::vector<double>& increment)
    {
        increment.resize(residual_.size());
        scaled_residual_.resize(residual_.size());
        for (std::size_t i = 0; i < residual_.size(); ++i)
            scaled_residual_[i] = -residual_[i] * row_scale_[i];
        solve_refined(lu_, scaled_, scaled_residual_, increment);
        for (std::size_t i = 0; i < increment.size(); ++i) increment[i] *= column_scale_[i];
    }

    enum class Verdict { done, new_tangent, failed };

    /// Goes on with one factorisation: one damped step, then whole ones as long as they contract.
    Verdict descend(double size)
    {
        double damping = std::min(1.0, 2 * damping_);
        bool is_fresh = true;
        for (;;) {
            Fields trial = fields_;
            equations_.add(trial, increment_, damping);
            double next = std::numeric_limits<double>::infinity();
            if (evaluate(trial)) {
                solve(simplified_);
                next = equations_.size_of(simplified_);
            }
            failed_load_ = report_.load;
            const bool at_rounding =
                size < rounding_begins && damping == 1 && std::isfinite(next) && next > 0.5 * size;
            const bool shrinks = next <= (1 - damping / 4) * size;
            if (!shrinks && !at_rounding && !(std::isfinite(next) && size <= options_.tolerance)) {
                if (is_fresh) damping /= 2;
                if (is_fresh && damping >= shortest_step) continue;
                evaluate(fields_);
                return is_fresh ? Verdict::failed : Verdict::new_tangent;
            }
            is_fresh = false;
            fields_ = std::move(trial);
            damping_ = damping;
            ++report_.iterations;
            if (at_rounding || size <= options_.tolerance) return Verdict::done;
            if (damping == 1 && next <= options_.tolerance) {
                equations_.add(fields_, simplified_, 1);
                return Verdict::done;
            }
            if (damping < 1 || next > good_contraction * size ||
                report_.iterations >= options_.max_iterations)
                return Verdict::new_tangent;
            increment_.swap(simplified_);
            size = next;
        }
    }

    void measure_condition()
    {
        if (!factorise()) return;
        report_.condition = condition_numbers(scaled_, lu_, row_scale_, column_scale_);
        report_.scaled_condition = condition_numbers(scaled_, lu_).one;
        --report_.factorisations;
    }

    NewtonReport finish(SolveStatus status)
    {
        report_.status = status;
        evaluate(fields_);   // the rows that stay define the momenta at the ends
        report_.worst = equations_.worst(residual_, row_scale_);
        report_.residual = report_.worst.value / std::max(reference(), 1e-300);
        return report_;
    }

    /// Largest scaled momentum or multiplier.
    double reference() const
    {
        const Numbering& n = equations_.numbering();
        const Mechanism& m = *equations_.setup().mechanism;
        double result = 0;
        for (int A = 0; A < n.n_functions(); ++A)
            for (int i = 0; i < m.n_coordinates; ++i) {
                const std::size_t at = static_cast<std::size_t>(A) * m.n_coordinates + i;
                result = std::max(result, std::abs(fields_.P[at]) / m.root_masses[i]);
            }
        for (int A = 0; A < n.n_multiplier_functions(); ++A)
            for (int k = 0; n.lambda(A) >= 0 && k < m.n_rows(); ++k) {
                const std::size_t at = static_cast<std::size_t>(A) * m.n_rows() + k;
                result = std::max(result, std::abs(fields_.lambda[at]) / column_scale_[n.lambda(A) + k]);
            }
        return result;
    }

    Equations& equations_;
    Fields& fields_;
    const NewtonOptions& options_;
    SparseLU lu_;
    SparseMatrix scaled_;
    std::vector<double> row_scale_, column_scale_;
    std::vector<double> residual_, scaled_residual_, increment_, simplified_;
    double damping_ = 1;
    std::string failed_load_;   ///< that was not finite at the last trial
    NewtonReport report_;
};

}   // namespace

NewtonReport solve_block(Equations& equations, Fields& fields, const NewtonOptions& options)
{
    return Iteration(equations, fields, options).run();
}

}   // namespace livens::mixed
