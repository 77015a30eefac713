// Where Newton's iteration of an element starts from.  (docs/theory.md, "Newton's iteration")
#include <algorithm>
#include <cmath>

#include "livens/multibody/body.h"
#include "livens/spacetime/lobatto/element.h"

namespace livens {

namespace {

/// Where the series at the start may be off by more than this (of the model's length, or rad), a solution of
/// half the degree makes a guess that saves more iterations than it costs (measured on P16, degrees 4 to 16).
constexpr double trusted_guess = 1e-3;

}   // namespace

/// Largest turn that the acceleration adds inside the element, rad.
double Element::bend() const
{
    double turn = 0;
    for (const auto& body : tables_.bodies)
        for (int i = 3; i < body.dofs; ++i)
            turn = std::max(turn, std::abs(start_->acceleration[1][body.first + i]));
    return turn * h_ * h_;
}

/// Size of the last terms of the series below at the end of the element: how far it may be trusted.
double Element::guess_error() const
{
    double size = 0;
    for (const auto& body : tables_.bodies) {
        for (int i = 0; i < body.dofs; ++i) {
            const auto k = static_cast<std::size_t>(body.first + i);
            const double a = start_->acceleration[1][k], j = start_->jerk[k], s = start_->snap[k];
            const double term = start_->has_past ? h_ * h_ * h_ / 6 * (std::abs(j) + h_ / 4 * std::abs(s))
                                                 : h_ * h_ / 6 * std::abs(a);
            size = std::max(size, i < 3 ? term / tables_.length : term);
        }
    }
    return size;
}

/// Nodes from a Taylor series of the twist at the start. Where that bends by more than about a radian,
/// constant twist is the safer guess.
void Element::predict()
{
    const double on = bend() < 1 ? 1 : 0;
    for (int B = 1; B <= rule_.degree; ++B) {
        const double tau = rule_.nodes[B] * h_;
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            const auto& body = tables_.bodies[b];
            const double* v = start_->velocity.data() + body.first;
            const double* a = start_->acceleration[1].data() + body.first;
            const double* j = start_->jerk.data() + body.first;
            const double* s = start_->snap.data() + body.first;
            double move[6] = {0, 0, 0, 0, 0, 0};
            for (int i = 0; i < body.dofs; ++i)
                move[i] = tau * (v[i] + tau / 2 * on * (a[i] + tau / 3 * (j[i] + tau / 4 * s[i])));
            if (body.dofs == 6) {
                // turns do not commute: second term of the Magnus series
                const double c = on * tau * tau * tau / 12;
                move[3] += c * (a[4] * v[5] - a[5] * v[4]);
                move[4] += c * (a[5] * v[3] - a[3] * v[5]);
                move[5] += c * (a[3] * v[4] - a[4] * v[3]);
            }
            increments_[static_cast<std::size_t>(B * tables_.n_bodies() + b)] =
                twist::from_vectors(move, move + 3);
        }
        configure(B);
    }
}

/// Nodes interpolated from a solution of half the degree.
bool Element::guess_from_coarse(ElementReport& report)
{
    const ElementReport r = coarse_->solve(*start_, t1_, {1e-5, 12, false});
    report.guess_factorisations += r.factorisations + r.guess_factorisations;
    if (r.status != SolveStatus::converged) return false;
    const int bodies = tables_.n_bodies(), m = coarse_->rule_.size();
    for (int A = 1; A <= rule_.degree; ++A) {
        for (int b = 0; b < bodies; ++b) {
            double z[7] = {0, 0, 0, 0, 0, 0, 0};
            for (int B = 0; B < m; ++B) {
                const auto& q = coarse_->increments_[static_cast<std::size_t>(B * bodies + b)];
                const double c = to_fine_[static_cast<std::size_t>(A * m + B)];
                const double from[7] = {q.u[0], q.u[1], q.u[2], q.s, q.v[0], q.v[1], q.v[2]};
                for (int i = 0; i < 7; ++i) z[i] += c * from[i];
            }
            const double size = std::sqrt(z[3] * z[3] + z[4] * z[4] + z[5] * z[5] + z[6] * z[6]);
            if (!(size > 0.1)) return false;
            increments_[static_cast<std::size_t>(A * bodies + b)] = {
                {z[0], z[1], z[2]}, z[3] / size, {z[4] / size, z[5] / size, z[6] / size}};
        }
        configure(A);
    }
    return true;
}

/// The best guess that is cheap: the series, or a solution of half the degree where the series ends too
/// early.
void Element::guess(ElementReport& report)
{
    predict();
    if (coarse_ && guess_error() > trusted_guess && !guess_from_coarse(report)) predict();
}

/// The last resort: nodes from a march of small quadratic elements, `pieces` between two nodes.
bool Element::guess_from_march(int pieces)
{
    Element small(tables_, lobatto_rule(2));
    InstantSystem ends(tables_);
    InstantState here = *start_, next = here;
    std::vector<double> lambda(tables_.rows.size());
    for (int A = 1; A <= rule_.degree; ++A) {
        const double from = here.t, to = A == rule_.degree ? t1_ : t0_ + rule_.nodes[A] * h_;
        for (int i = 1; i <= pieces; ++i) {
            next.t = i == pieces ? to : from + (to - from) * i / pieces;
            if (small.solve(here, next.t, {1e-8, 20, false}).status != SolveStatus::converged) return false;
            std::copy_n(small.X(2), next.X.size(), next.X.begin());
            if (!ends.prepare(next)) return false;
            ends.from_momentum(next, small.final_momentum(), 1.0, lambda.data());
            ends.accelerate(next, Side::right);
            next.acceleration[0] = next.acceleration[1];
            next.look_back(here);
            std::swap(here, next);
        }
        place(A, here);
    }
    return true;
}

/// Node A at the configuration of an end state.
void Element::place(int A, const InstantState& state)
{
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        auto& increment = increments_[static_cast<std::size_t>(A * tables_.n_bodies() + b)];
        for (int i = 0; i < 3; ++i) increment.u[i] = state.X[12 * b + i] - X0_[12 * b + i];
        if (tables_.bodies[b].dofs == 3) continue;
        Matrix34 from{}, to{};
        std::copy_n(X0_.begin() + 12 * b, 12, from.a);
        std::copy_n(state.X.begin() + 12 * b, 12, to.a);
        const Vector4 q =
            quaternion_from_directors(project_directors(directors(to) * transpose(directors(from))));
        increment.s = q[0];
        for (int i = 0; i < 3; ++i) increment.v[i] = q[i + 1];
    }
    configure(A);
}

}   // namespace livens
