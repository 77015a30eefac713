#include "livens/spacetime/lobatto/march.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "livens/base/error.h"
#include "livens/spacetime/lobatto/element.h"
#include "livens/spacetime/lobatto/whole_matrix.h"

namespace livens {

namespace {

std::string number(double x)
{
    std::ostringstream s;
    s.precision(6);
    s << x;
    return s.str();
}

Matrix34 body_matrix(const double* stacked, int body)
{
    Matrix34 m;
    std::copy_n(stacked + 12 * body, 12, m.a);
    return m;
}

/// end + low <- start + low + increment without the rounding of the sum [Kahan1965]: over many elements a
/// motion adds up many small increments, whose own rounding is much smaller.
void add_increments(const InstantState& start, const double* increments, InstantState& end)
{
    const std::size_t n = end.X.size();
    const double* __restrict from = start.X.data();
    const double* __restrict from_low = start.X_low.data();
    const double* __restrict by = increments;
    double* __restrict to = end.X.data();
    double* __restrict low = end.X_low.data();
    for (std::size_t i = 0; i < n; ++i) {
        const double x = from[i], d = by[i] + from_low[i];
        const double sum = x + d, back = sum - x;
        to[i] = sum;
        low[i] = (x - (sum - back)) + (d - back);
    }
}

/// Re-orthonormalises directors that have drifted beyond rounding: one Newton step of the polar factor.
void polish(double* X)
{
    Matrix3 d{};
    std::copy_n(X + 3, 9, d.a);
    const Matrix3 error = transpose(d) * d - identity<3>();
    if (norm(error) < 2e-15) return;
    d -= 0.5 * d * error;
    std::copy_n(d.a, 9, X + 3);
}

class March {
public:
    March(const Model& model, const Assembly& assembly, const TimeMesh& mesh, int degree,
          const SolveOptions& options)
        : model_(model), mesh_(mesh), options_(options), rule_(lobatto_rule(degree)),
          tables_(model, static_cast<int>(assembly.independent.size())), element_(tables_, rule_),
          ends_(tables_)
    {
        for (InstantState& state : states_) state.resize(tables_);
        lambda_.assign(tables_.rows.size(), 0.0);
        end_lambda_ = lambda_;
        jumps_ = model.load_breaks();
        prepare_motion(assembly);
    }

    Solution run(const Assembly& assembly)
    {
        if (start(assembly)) {
            for (int e = 0; e < mesh_.n_elements(); ++e) {
                if (!advance(e)) break;
            }
        }
        finish();
        return std::move(solution_);
    }

private:
    InstantState& here() { return states_[now_]; }
    InstantState& next() { return states_[1 - now_]; }

    void prepare_motion(const Assembly& assembly)
    {
        Motion& m = solution_.motion;
        const int nb = model_.n_bodies(), p = rule_.degree;
        m.n_bodies = nb;
        m.n_rows = model_.n_rows();
        m.X = {12 * nb, p, true, {}, {}};
        m.multipliers = {m.n_rows, p, false, {}, {}};
        m.order_at_ends = 2 * p;
        m.dense_order_X = p + 1;
        m.dense_order_V = p;
        m.constraints_hold = "element nodes";
        m.gauss_points = p;
        m.redundant_rows = assembly.redundant;
        for (const std::string& note : assembly.notes) solution_.report.notes.push_back(note);
        const auto n = static_cast<std::size_t>(mesh_.n_elements());
        m.X.values.reserve((n * static_cast<std::size_t>(p) + 1) * static_cast<std::size_t>(12 * nb));
        m.mesh.ends.reserve(n + 1);
        const auto bodies = static_cast<std::size_t>(nb), rows = static_cast<std::size_t>(m.n_rows);
        m.multipliers.values.reserve(n * static_cast<std::size_t>(p + 1) * rows);
        m.velocities.reserve((n + 1) * bodies);
        m.momenta.reserve((n + 1) * bodies);
        m.accelerations.reserve(2 * (n + 1) * bodies);
        m.end_multipliers.reserve(2 * (n + 1) * rows);
        solution_.report.iterations.reserve(n);
        solution_.report.unknowns = element_.unknowns();
    }

    bool start(const Assembly& assembly)
    {
        here().t = mesh_.start();
        for (int b = 0; b < model_.n_bodies(); ++b) {
            std::copy_n(assembly.start.X[b].a, 12, here().X.begin() + 12 * b);
            const auto& body = tables_.bodies[b];
            const Vector3 v = assembly.start.V[b].column(0);
            const Vector3 w =
                body.dofs == 6 ? angular_velocity(assembly.start.X[b], assembly.start.V[b]) : Vector3{};
            for (int i = 0; i < body.dofs; ++i) here().velocity[body.first + i] = i < 3 ? v[i] : w[i - 3];
        }
        if (!ends_.prepare(here())) {
            fail_at_start();
            return false;
        }
        ends_.from_velocity(here());
        accelerate(here());
        const double* X = here().X.data();
        solution_.motion.X.values.insert(solution_.motion.X.values.end(), X, X + here().X.size());
        record(here());
        return true;
    }

    void fail_at_start()
    {
        solution_.report.status = SolveStatus::singular;
        solution_.report.failed_at = mesh_.start();
        solution_.report.message = "the mass matrix on the free motions is singular at the start";
        ends_.from_velocity(here());
        const double* X = here().X.data();
        solution_.motion.X.values.insert(solution_.motion.X.values.end(), X, X + here().X.size());
        record(here());
    }

    bool is_jump(double t) const { return std::binary_search(jumps_.begin(), jumps_.end(), t); }

    void accelerate(InstantState& state)
    {
        ends_.accelerate(state, Side::right);
        if (is_jump(state.t)) {
            ends_.accelerate(state, Side::left);
        } else {
            state.acceleration[0] = state.acceleration[1];
            state.multipliers[0] = state.multipliers[1];
        }
    }

    /// Appends the end values of `state`, for which `ends_` has just made the accelerations, to the motion.
    void record(const InstantState& state)
    {
        Motion& m = solution_.motion;
        const double *V = ends_.rates(), *turn = ends_.centripetal();
        V_.resize(state.X.size());
        tables_.times_mass(V, 1.0, V_.data());
        m.mesh.ends.push_back(state.t);
        for (int b = 0; b < m.n_bodies; ++b) {
            m.velocities.push_back(body_matrix(V, b));
            m.momenta.push_back(body_matrix(V_.data(), b));
        }
        for (int side = 0; side < 2; ++side) {
            if (side == 0 || is_jump(state.t)) {
                // X'' = [a, alpha x d + w x (w x d)]
                tables_.rates_of(state.X.data(), state.acceleration[side].data(), V_.data());
                double* __restrict A = V_.data();
                const std::size_t size = state.X.size();
                for (std::size_t i = 0; i < size; ++i) A[i] += turn[i];
            }
            for (int b = 0; b < m.n_bodies; ++b) m.accelerations.push_back(body_matrix(V_.data(), b));
            m.end_multipliers.insert(m.end_multipliers.end(), state.multipliers[side].begin(),
                                     state.multipliers[side].end());
        }
    }

    bool advance(int e)
    {
        const double t_end = mesh_.ends[e + 1];
        const ElementReport r =
            element_.solve(here(), t_end, {options_.tolerance, options_.max_iterations, true});
        SolveReport& report = solution_.report;
        report.newton_iterations += r.iterations;
        report.factorisations += r.factorisations;
        report.guess_factorisations += r.guess_factorisations;
        report.rescued += r.rescued ? 1 : 0;
        if (r.status != SolveStatus::converged) {
            fail(e, r);
            return false;
        }
        report.iterations.push_back(r.iterations);
        report.most_iterations = std::max(report.most_iterations, r.iterations);
        report.residual_norm = std::max(report.residual_norm, r.residual);
        report.smallest_pivot = std::min(report.smallest_pivot, r.smallest_pivot);
        if (!close_element(t_end, e)) return false;
        ++report.n_elements;
        if (options_.progress &&
            !options_.progress({e + 1, mesh_.n_elements(), t_end, r.iterations, r.residual})) {
            report.status = SolveStatus::cancelled;
            report.failed_at = t_end;
            report.message =
                "stopped at t = " + number(t_end) + " s as asked; the motion up to there is complete";
            return false;
        }
        return true;
    }

    /// The end state of the solved element, its nodes and multipliers into the motion.
    bool close_element(double t_end, int e)
    {
        const int p = rule_.degree;
        next().t = t_end;
        add_increments(here(), element_.dX(p), next());
        for (int b = 0; b < model_.n_bodies(); ++b)
            if (tables_.bodies[b].dofs == 6 && e % 16 == 15) polish(next().X.data() + 12 * b);
        if (!ends_.prepare(next(), element_.final_basis()) || !rows_compatible(next(), e)) {
            if (solution_.report.message.empty()) {
                solution_.report.message = "at t = " + number(t_end) + " s the free motions carry no inertia";
                solution_.report.status = SolveStatus::singular;
                solution_.report.failed_at = here().t;
            }
            return false;
        }
        ends_.from_momentum(next(), element_.final_momentum(), (t_end - here().t) * rule_.weights[p],
                            end_lambda_.data());
        accelerate(next());
        Motion& m = solution_.motion;
        for (int A = 1; A < p; ++A)
            m.X.values.insert(m.X.values.end(), element_.X(A), element_.X(A) + next().X.size());
        m.X.values.insert(m.X.values.end(), next().X.begin(), next().X.end());
        for (int A = 0; A < p; ++A) {
            element_.multipliers(A, lambda_.data());
            m.multipliers.values.insert(m.multipliers.values.end(), lambda_.begin(), lambda_.end());
        }
        m.multipliers.values.insert(m.multipliers.values.end(), end_lambda_.begin(), end_lambda_.end());
        if (is_jump(t_end))
            next().forget_past();
        else
            next().look_back(here());
        now_ = 1 - now_;
        record(here());
        return true;
    }

    /// Rows that were left out as redundant must still hold.
    bool rows_compatible(const InstantState& state, int e)
    {
        if (tables_.rank == tables_.n_rows()) return true;
        for (int r = 0; r < tables_.n_rows(); ++r) {
            const ConstraintRow& row = *tables_.rows[r].row;
            if (std::abs(tables_.value(r, state.X.data())) / row.scale < 1e-8) continue;
            SolveReport& report = solution_.report;
            report.status = SolveStatus::singular;
            report.failed_at = mesh_.ends[e];
            report.message =
                "joint '" + model_.joints()[model_.row_joint(r)].name + "', row '" + row.label +
                "': was redundant at the start and contradicts the other joints by t = " + number(state.t) +
                " s";
            return false;
        }
        return true;
    }

    void fail(int e, const ElementReport& r)
    {
        SolveReport& report = solution_.report;
        report.status = r.status;
        report.failed_at = mesh_.ends[e];
        std::string where;
        if (r.worst_row >= 0) {
            const int joint = model_.row_joint(r.worst_row);
            where =
                ", joint '" + model_.joints()[joint].name + "' (row '" + model_.row(r.worst_row).label + "')";
        }
        if (r.worst_body >= 0) where += ", body '" + model_.bodies()[r.worst_body].name + "'";
        std::string what =
            "Newton's iteration did not converge in " + std::to_string(r.iterations) + " iterations";
        std::string advice = "use more elements, or a lower degree";
        if (r.status == SolveStatus::singular) {
            what = "the tangent is singular";
            advice =
                "the tables may pass a singular position; shift the element ends or use more elements";
        } else if (r.status == SolveStatus::not_finite) {
            what = "a number became infinite or undefined";
            advice = "look at the loads on this body near that time; use more elements";
        }
        report.message = what + " in element " + std::to_string(e) + " (t = " + number(mesh_.ends[e]) +
                         " to " + number(mesh_.ends[e + 1]) +
                         " s); worst: " + (where.empty() ? "-" : where.substr(2)) + "; try: " + advice;
    }

    void finish()
    {
        SolveReport& report = solution_.report;
        if (report.rescued > 0)
            report.notes.push_back(
                std::to_string(report.rescued) + " of " + std::to_string(report.n_elements) +
                " elements needed a guess from many small elements; more elements would be cheaper");
        if (report.smallest_pivot < 1e-6)
            report.notes.push_back("the joints come close to a singular position (scaled pivot " +
                                   number(report.smallest_pivot) + "); shifting the element ends may help");
    }

    const Model& model_;
    const TimeMesh& mesh_;
    const SolveOptions& options_;
    LobattoRule rule_;
    Tables tables_;
    Element element_;
    InstantSystem ends_;
    InstantState states_[2];
    int now_ = 0;
    std::vector<double> V_, lambda_, end_lambda_, jumps_;
    Solution solution_;
};

}   // namespace

Solution march_lobatto(const Model& model, const Assembly& assembly, const TimeMesh& mesh, int degree,
                       const SolveOptions& options)
{
    Solution solution = March(model, assembly, mesh, degree, options).run(assembly);
    if (options.condition && solution.report.converged())
        measure_condition(model, solution.motion, solution.report);
    return solution;
}

}   // namespace livens
