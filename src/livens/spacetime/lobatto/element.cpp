#include "livens/spacetime/lobatto/element.h"

#include <algorithm>
#include <cmath>

#include "livens/time/basis.h"

namespace livens {

namespace {

/// sum += x, for arrays that do not overlap.
inline void accumulate(double* __restrict sum, const double* __restrict x, std::size_t n)
{
    for (std::size_t i = 0; i < n; ++i) sum[i] += x[i];
}

}   // namespace

Element::Element(const Tables& tables, const LobattoRule& rule)
    : tables_(tables), rule_(rule), elimination_(tables, rule.degree), n_(tables.n_twists)
{
    const auto nodes = static_cast<std::size_t>(rule.size());
    const std::size_t size = 12 * tables.bodies.size();
    const auto twists = static_cast<std::size_t>(n_);
    const auto rank = static_cast<std::size_t>(tables.rank);
    increments_.resize(nodes * tables.bodies.size());
    X0_.assign(size, 0.0);
    for (auto* v : {&dX_, &X_, &raw_, &forces_, &maps_}) v->assign(nodes * size, 0.0);
    for (auto* v : {&X_c_, &V_c_}) v->assign(size, 0.0);
    blocks_.assign(3 * size, 0.0);
    q_.assign(nodes * twists, 0.0);
    bases_.resize(nodes);
    for (std::size_t A = 1; A < nodes; ++A) bases_[A].resize(tables, false);
    orthogonal_.assign(nodes, nullptr);
    if (rule.degree >= 4) {
        coarse_ = std::make_unique<Element>(tables, lobatto_rule(rule.degree / 2));
        const LagrangeBasis basis(coarse_->rule_.nodes);
        to_fine_.assign(static_cast<std::size_t>(rule.size() * basis.size()), 0.0);
        for (int A = 0; A < rule.size(); ++A)
            basis.values(rule.nodes[A],
                         {to_fine_.data() + A * basis.size(), static_cast<std::size_t>(basis.size())});
    }
    for (double k : rule.k) largest_k_ = std::max(largest_k_, std::abs(k));
    for (auto* v : {&phi_, &lambda_}) v->assign(nodes * rank, 0.0);
    phi0_.assign(rank, 0.0);
    rho_.assign(static_cast<std::size_t>(rule.degree * tables.freedoms()), 0.0);
    work_.assign(twists, 0.0);
    twist_.assign(twists, 0.0);
    scratch_.assign(std::max(twists, size), 0.0);
}

/// Makes the start and the interval current.
void Element::attach(const InstantState& start, double t_end)
{
    start_ = &start;
    t0_ = start.t;
    t1_ = t_end;
    h_ = t_end - start.t;
    X0_ = start.X;
    std::copy(X0_.begin(), X0_.end(), X_.begin());
    std::copy(start.maps.begin(), start.maps.end(), maps_.begin());
    orthogonal_[0] = &start.basis.q;
    keep_choices_ = false;
    start_terms_ = load_rounding_ = 0;
    for (double p : start.momentum) start_terms_ = std::max(start_terms_, std::abs(p));
    smallest_pivot_ = start.smallest_pivot;
    for (int c = 0; c < tables_.rank; ++c)
        phi0_[c] = tables_.value(start.basis.rows[c], X0_.data(), start.basis.gradients.data() + 24 * c);
}

void Element::begin(const InstantState& start, double t_end)
{
    attach(start, t_end);
    predict();
}

void Element::configure(int B)
{
    double* dX = dX_.data() + node(B);
    double* X = X_.data() + node(B);
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const auto& increment = increments_[static_cast<std::size_t>(B * tables_.n_bodies() + b)];
        twist::displacement(increment, X0_.data() + 12 * b, dX + 12 * b);
    }
    const double* __restrict from = X0_.data();
    const double* __restrict by = dX;
    double* __restrict to = X;
    const std::size_t size = X0_.size();
    for (std::size_t i = 0; i < size; ++i) to[i] = from[i] + by[i];
}

void Element::move(int B, const double* xi)
{
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const auto& body = tables_.bodies[b];
        double twist[6] = {0, 0, 0, 0, 0, 0};
        std::copy(xi + body.first, xi + body.first + body.dofs, twist);
        twist::update(increments_[static_cast<std::size_t>(B * tables_.n_bodies() + b)], twist);
    }
    configure(B);
}

/// Constraint values, gradients and their bases at nodes 1..p.
///
/// Phi is a quadratic polynomial, so Phi(X) = Phi(X_0) + 1/2 <grad Phi(X_0) + grad Phi(X), X - X_0>, which
/// does not lose the digits of a small increment.
bool Element::evaluate_constraints()
{
    constexpr double rounding = 1e-16;   // of Phi at the start itself: nothing to correct
    constexpr double close = 1e-4;       // relative, for one linear step onto the constraints
    near_ = true;

    const ConstraintBasis& first = start_->basis;
    const int k = tables_.rank;
    double sum = 0;
    for (int B = 1; B <= rule_.degree; ++B) {
        ConstraintBasis& basis = bases_[B];
        tables_.map_twists(X(B), maps_.data() + node(B));
        smallest_pivot_ =
            std::min(smallest_pivot_, basis.build(tables_, X(B), maps(B), first.rows, keep_choices_));
        orthogonal_[B] = &basis.q;
        for (int c = 0; c < k; ++c) {
            const auto& table = tables_.rows[basis.rows[c]];
            const double* g0 = first.gradients.data() + 24 * c;
            const double* g = basis.gradients.data() + 24 * c;
            double phi = 0;
            for (int side = table.first_side(); side < 2; ++side) {
                const double* d = dX_.data() + node(B) + 12 * table.body(side);
                auto add_column = [&](int a) {
                    for (int i = a; i < a + 3; ++i) phi += (g0[12 * side + i] + g[12 * side + i]) * d[i];
                };
                for (const int a : table.columns[side]) add_column(a);
            }
            phi = phi0_[c] + 0.5 * phi;
            if (std::abs(phi) < rounding * table.row->scale) phi = 0;
            if (std::abs(phi) > close * table.row->scale) near_ = false;
            phi_[static_cast<std::size_t>(B * k + c)] = phi * basis.row_scale[c];
            sum += std::abs(phi);
        }
    }
    return std::isfinite(sum);
}

/// Rows at node A: the bracket without multipliers, N^T of it, and what the multipliers leave.
void Element::evaluate_row(int A)
{
    const std::size_t size = X0_.size();
    const int n_nodes = rule_.size();
    double* __restrict y = scratch_.data();
    const double* __restrict first = dX_.data() + node(1);
    const double k1 = rule_.k[A * n_nodes + 1];
    for (std::size_t i = 0; i < size; ++i) y[i] = k1 * first[i];
    for (int B = 2; B < n_nodes; ++B) {
        const double k = rule_.k[A * n_nodes + B];
        const double* __restrict d = dX_.data() + node(B);
        for (std::size_t i = 0; i < size; ++i) y[i] += k * d[i];
    }
    double* raw = raw_.data() + node(A);
    tables_.times_mass(y, 1 / h_, raw);
    accumulate(raw, forces_.data() + node(A), size);
    double* q = q_.data() + twist_node(A);
    tables_.twist_rows(X(A), maps(A), raw, q);
    eliminate_multipliers(A);
}

/// X and X' at Gauss point c.
void Element::interpolate(int c, double* X, double* V) const
{
    const std::size_t size = X0_.size();
    const int n_nodes = rule_.size();
    std::copy(X0_.begin(), X0_.end(), X);
    std::fill(V, V + size, 0.0);
    for (int B = 1; B < n_nodes; ++B) {
        const double m = rule_.M[c * n_nodes + B], d = rule_.dM[c * n_nodes + B] / h_;
        const double* __restrict dX = dX_.data() + node(B);
        for (std::size_t i = 0; i < size; ++i) {
            X[i] += m * dX[i];
            V[i] += d * dX[i];
        }
    }
}

/// forces <- F_A at all nodes. All Gauss points lie inside the element, on its side of every jump. The weight
/// is constant, and its integral against M_A is h w_A to the last digit.
void Element::evaluate_forces()
{
    const std::size_t size = X0_.size();
    const int n_nodes = rule_.size();
    std::fill(forces_.begin(), forces_.end(), 0.0);
    for (int A = 0; A < n_nodes; ++A) tables_.add_weight(h_ * rule_.weights[A], forces_.data() + node(A));
    if (tables_.model->loads().empty()) return;
    std::vector<double>& F = scratch_;
    for (int c = 0; c < rule_.degree; ++c) {
        interpolate(c, X_c_.data(), V_c_.data());
        std::fill(F.begin(), F.end(), 0.0);
        tables_.add_loads({t0_ + rule_.loads.points[c] * h_, Side::middle}, X_c_.data(), V_c_.data(),
                             h_ * rule_.loads.weights[c], F.data());
        for (int A = 0; A < n_nodes; ++A) {
            const double m = rule_.M[c * n_nodes + A];
            double* __restrict f = forces_.data() + node(A);
            for (std::size_t i = 0; i < size; ++i) f[i] += m * F[i];
        }
    }
}

/// lambda_A from the rows in the constraint directions; what is left are the reduced rows.
void Element::eliminate_multipliers(int A)
{
    const ConstraintBasis& basis = A == 0 ? start_->basis : bases_[A];
    const int k = tables_.rank, f = tables_.freedoms();
    const double* q = q_.data() + twist_node(A);
    double* y = work_.data();
    tables_.to_scaled_rows(maps(A), q, y);
    if (A == 0) accumulate(y, start_->momentum.data(), static_cast<std::size_t>(n_));
    double terms = terms_;
    for (int i = 0; i < n_; ++i) terms = std::max(terms, std::abs(y[i]));
    terms_ = terms;
    basis.q.apply_transposed(y);
    double* rho = rho_.data() + A * f;
    for (int i = 0; i < f; ++i) rho[i] = -y[k + i];
    basis.q.solve_R(y);
    const double weight = h_ * rule_.weights[A];
    for (int c = 0; c < k; ++c)
        lambda_[static_cast<std::size_t>(A * k + c)] = y[c] * basis.row_scale[c] / weight;
}

bool Element::evaluate() { return evaluate_constraints() && finish_evaluation(false); }

/// Rows at the nodes. `correct` first takes the constraint violations off, with bases that are then stale by
/// as much; near the solution that is nothing, and the rows do not feel the violations through k_AB / h.
bool Element::finish_evaluation(bool correct)
{
    if (correct) correct_constraints();
    terms_ = start_terms_;
    evaluate_forces();
    for (int A = 0; A < rule_.degree; ++A) evaluate_row(A);
    double sum = terms_, largest = 0;
    for (const double r : rho_) {
        sum += std::abs(r);   // keeps a nan, which a maximum would lose
        largest = std::max(largest, std::abs(r));
    }
    rows_size_ = largest;
    return std::isfinite(sum);
}

/// raw -= h w_A G^T lambda_A.
void Element::subtract_reactions(int A, double* raw) const
{
    const ConstraintBasis& basis = A == 0 ? start_->basis : bases_[A];
    for (int c = 0; c < tables_.rank; ++c) {
        const auto& table = tables_.rows[basis.rows[c]];
        const double s = h_ * rule_.weights[A] * lambda_[static_cast<std::size_t>(A * tables_.rank + c)];
        for (int side = table.first_side(); side < 2; ++side) {
            double* r = raw + 12 * table.body(side);
            const double* g = basis.gradients.data() + 24 * c + 12 * side;
            for (const int a : table.columns[side])
                for (int i = a; i < a + 3; ++i) r[i] -= s * g[i];
        }
    }
}

void Element::multipliers(int A, double* lambda) const
{
    std::fill(lambda, lambda + tables_.n_rows(), 0.0);
    for (int c = 0; c < tables_.rank; ++c)
        lambda[start_->basis.rows[c]] = lambda_[static_cast<std::size_t>(A * tables_.rank + c)];
}

/// Motion and impulse of node B into the largest so far.
void Element::measure(int B, Step& step) const
{
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const double* d = dX_.data() + node(B) + 12 * b;
        const auto& body = tables_.bodies[b];
        double u = 0, turn = 0;
        for (int i = 0; i < 3; ++i) u = std::max(u, std::abs(d[i]));
        for (int i = 3; i < 12; ++i) turn = std::max(turn, std::abs(d[i]));
        step.motion = std::max(step.motion, std::max(u / tables_.length, turn));
        step.impulse = std::max(
            step.impulse, ((u + body.reach * turn) / body.inverse_root_mass + body.root_inertia * turn) / h_);
    }
}

/// Newton's direction from the reduced rows, applied to all nodes along the constraints.
Element::Step Element::solve_step()
{
    const int k = tables_.rank, f = tables_.freedoms();
    if (pending_) {
        // one node: its violations go into the linear system with the rows
        for (int c = 0; c < k; ++c)
            twist_[static_cast<std::size_t>(c)] = -phi_[static_cast<std::size_t>(k + c)];
        bases_[1].q.solve_R_transposed(twist_.data());
        elimination_.solve(rho_.data(), twist_.data());
    } else {
        elimination_.solve(rho_.data(), nullptr);
    }
    Step step;
    for (int B = 1; B <= rule_.degree; ++B) {
        const OrthogonalBasis& q = bases_[B].q;
        double* y = work_.data();
        if (pending_)
            std::copy_n(twist_.begin(), k, y);
        else
            std::fill(y, y + k, 0.0);
        std::copy(rho_.begin() + (B - 1) * f, rho_.begin() + B * f, y + k);
        q.apply(y);
        tables_.to_twist(maps(B), y, twist_.data());
        step.size = std::max(step.size, size_of(twist_.data()));
        move(B, twist_.data());
        measure(B, step);
    }
    pending_ = false;
    return step;
}

/// Moves each node by itself back to the constraints, with the bases at hand.
void Element::correct_constraints()
{
    const int k = tables_.rank;
    correction_ = 0;
    for (int B = 1; B <= rule_.degree; ++B) {
        double* y = work_.data();
        std::fill(y, y + n_, 0.0);
        double size = 0;
        for (int c = 0; c < k; ++c) {
            y[c] = -phi_[static_cast<std::size_t>(B * k + c)];
            size = std::max(size, std::abs(y[c]));
        }
        if (size == 0) continue;
        bases_[B].q.solve_R_transposed(y);
        bases_[B].q.apply(y);
        tables_.to_twist(maps(B), y, twist_.data());
        correction_ = std::max(correction_, size_of(twist_.data()));
        move(B, twist_.data());
    }
}

/// Predicted nodes may lie far from the constraints: repeat until the bases fit the nodes.
bool Element::settle()
{
    for (int round = 0; round < 6; ++round) {
        if (!evaluate_constraints()) return false;
        pending_ = near_ && elimination_.takes_constraints();
        if (pending_) break;
        correct_constraints();
        if (correction_ < 1e-3) break;
    }
    return finish_evaluation(false);
}

ElementReport Element::fail(SolveStatus status, ElementReport report) const
{
    report.status = status;
    double worst = 0;
    for (int B = 1; B <= rule_.degree; ++B) {
        for (int c = 0; c < tables_.rank; ++c) {
            const double v = std::abs(phi_[static_cast<std::size_t>(B * tables_.rank + c)]);
            if (v > worst || !std::isfinite(v)) {
                worst = v;
                report.worst_row = start_->basis.rows[c];
            }
        }
    }
    worst = 0;
    for (int A = 0; A < rule_.degree; ++A) {
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            for (int i = 0; i < tables_.bodies[b].dofs; ++i) {
                const double v =
                    std::abs(q_[twist_node(A) + static_cast<std::size_t>(tables_.bodies[b].first + i)]);
                if (v > worst || !std::isfinite(v)) {
                    worst = v;
                    report.worst_body = b;
                }
            }
        }
    }
    return report;
}

/// Size of a twist: in lengths of the model and radians.
double Element::size_of(const double* xi) const
{
    double size = 0;
    for (const auto& body : tables_.bodies) {
        for (int i = 0; i < 3; ++i) size = std::max(size, std::abs(xi[body.first + i]) / tables_.length);
        for (int i = 3; i < body.dofs; ++i) size = std::max(size, std::abs(xi[body.first + i]));
    }
    return size;
}

ElementReport Element::solve(const InstantState& start, double t_end, const NewtonOptions& options)
{
    ElementReport report;
    attach(start, t_end);
    guess(report);
    report = iterate(report, options);
    for (int pieces = 4; report.status != SolveStatus::converged && options.rescue && pieces <= 64;
         pieces *= 4) {
        if (!guess_from_march(pieces)) continue;
        report.rescued = true;
        report.iterations = 0;
        report = iterate(report, options);
    }
    return report;
}

/// The momentum at the end from the balance of all rows, which is the last row once the others are solved:
///
///     p = p_0 + sum_A f_A,      s = s_0 + sum_A tau_A
///
/// with wrenches (f_A, tau_A) of loads and multipliers about the centre of mass (docs/theory.md, "The
/// element"). The last row itself would carry the rounding of k_AB / h, and what Newton's iteration left.
ElementReport Element::finish(const ElementReport& report)
{
    const int p = rule_.degree;
    double* end = q_.data() + twist_node(p);
    std::copy(start_->p.begin(), start_->p.end(), end);
    for (int A = 0; A <= p; ++A) {
        double* wrench = forces_.data() + node(A);
        if (A < p) subtract_reactions(A, wrench);
        tables_.twist_rows(X(A), maps(A), wrench, twist_.data());
        accumulate(end, twist_.data(), static_cast<std::size_t>(n_));
    }
    double sum = 0;
    for (int i = 0; i < n_; ++i) sum += std::abs(end[i]);
    return std::isfinite(sum) ? report : fail(SolveStatus::not_finite, report);
}

/// Newton's iteration from the nodes as they stand.
ElementReport Element::iterate(ElementReport report, const NewtonOptions& options)
{
    report.status = SolveStatus::converged;
    keep_choices_ = false;
    if (!settle()) return fail(SolveStatus::not_finite, report);
    bool renew = true;
    double rows = rows_size_, previous = 0;
    while (report.iterations < options.max_iterations) {
        if (renew) {
            ++report.factorisations;
            keep_choices_ = true;
            if (!factorise()) return fail(SolveStatus::singular, report);
        }
        const Step step = solve_step();
        ++report.iterations;
        if (!evaluate_constraints() || !finish_evaluation(true)) return fail(SolveStatus::not_finite, report);
        if (step.size > 1e3) break;   // hopeless: a thousand lengths or radians in one step
        // the next increment, foretold by the rows that are left
        const double rows_left = rows_size_;
        const double rate = rows > 0 ? rows_left / rows : 0;
        const double next = step.size * rate + correction_;
        // a body may fly many lengths while its turns need their digits all the same
        const double scale = std::clamp(step.motion, 1e-6, 1.0);
        // the sums over k_AB cancel: their rounding is that of their largest term
        const double rounding = 1e-16 * (largest_k_ * step.impulse + terms_ + load_rounding_);
        const double impulse = std::max(step.impulse, terms_);
        const bool small = next <= options.tolerance * scale && rows_left <= options.tolerance * impulse;
        if (small || (rate > 0.25 && rows_left < 4 * rounding)) {
            report.residual = impulse > 0 ? rows_left / impulse : 0;
            report.smallest_pivot = smallest_pivot_;
            return finish(report);
        }
        // a new tangent where the old one contracts too slowly to be worth its iterations
        const double contraction = previous > 0 ? step.size / previous : 0.1 * rate;
        const double left = std::log(options.tolerance * scale / next) / std::log(std::min(contraction, 0.9));
        renew = contraction > 0.3 || report.iterations + left > 9 || step.size > 0.1;
        previous = renew ? 0 : step.size;
        rows = rows_left;
    }
    return fail(SolveStatus::not_converged, report);
}

}   // namespace livens
