// SPDX-License-Identifier: BSD-3-Clause
// At rest the rates of states are zero as forces on bodies are; both are found together (docs/theory.md,
// "States", last paragraph).
#include "livens/statics/rest_with_states.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "livens/solvers/factors.h"

namespace livens::inline statics_internal {

namespace {

using Values = std::vector<double>;

/// Newton's method for bodies and states together, whose stiffness is no question of energy: steps are kept
/// where the next one by the same tangent is shorter.
class RestWithStates {
public:
    RestWithStates(Search& search, const EquilibriumOptions& options) : search_(search), options_(options) {}

    /// Steps are measured in lengths of the model, rad and sizes of states. One of 1e-13 is rounding; below
    /// 1e-9 it is a rest where steps do not halve any more.
    SearchOutcome run(RestPoint& here, int& iterations)
    {
        constexpr double met = 1e-13, near = 1e-9, least_share = 1e-6;
        double before = std::numeric_limits<double>::infinity();
        for (;;) {
            if (options_.goes_on && !options_.goes_on()) return SearchOutcome::cancelled;
            if (iterations == options_.max_iterations) return SearchOutcome::limit;
            ++iterations;
            const DenseMatrix tangent = tangent_at(here);
            const Step whole = step_of(here, here, tangent);
            if (!std::isfinite(whole.size)) return SearchOutcome::unrestored;
            // As far as rounding lets it go.
            if (whole.size <= met || (whole.size <= near && !(whole.size < 0.5 * before)))
                return SearchOutcome::balanced;
            before = whole.size;
            double share = whole.moved > largest_step ? largest_step / whole.moved : 1;
            RestPoint there;
            for (;; share *= 0.5) {
                if (share < least_share)
                    return whole.size <= near ? SearchOutcome::balanced : SearchOutcome::stuck;
                // 1 - share / 4: the test of docs/theory.md, "Newton's iteration".
                if (go(here, whole, share, there) &&
                    step_of(there, here, tangent).size <= (1 - 0.25 * share) * whole.size)
                    break;
            }
            here = std::move(there);
        }
    }

private:
    struct Step {
        Values xi;          // plain twists; of bodies that hold states changes of these
        double moved = 0;   // in lengths and rad
        double size = 0;    // also in sizes of states
    };

    /// Columns of what holds states are those of C: forces by velocities.
    /// (A e - K e) e^T puts A e where K e was; directions that no state uses get e itself, so that the
    /// matrix is regular.
    DenseMatrix tangent_at(const RestPoint& at) const
    {
        const FreeMotions& free = at.statics->free;
        const StateDirections states(search_.tables(), free);
        const DenseMatrix K = free.reduced(search_.tables(), at.statics->stiffness),
                          C = free.reduced(search_.tables(), at.statics->damping);
        DenseMatrix all = K;
        for (const auto& [E, A] :
             {std::pair(&states.held, &C), std::pair(&states.idle, (const DenseMatrix*)nullptr)})
            for (int k = 0; k < E->cols; ++k) {
                const Values e(E->column(k).begin(), E->column(k).end()),
                    Ke = product(K, e), Ae = A != nullptr ? product(*A, e) : e;
                for (int j = 0; j < all.cols; ++j)
                    for (int i = 0; i < all.rows; ++i) {
                        const auto r = static_cast<std::size_t>(i);
                        all(i, j) += (Ae[r] - Ke[r]) * e[static_cast<std::size_t>(j)];
                    }
            }
        return all;
    }

    /// Newton's step for the forces at one point by the tangent of another.
    Step step_of(const RestPoint& forces, const RestPoint& of_tangent, const DenseMatrix& tangent) const
    {
        const FreeMotions& free = of_tangent.statics->free;
        const Values rows = transposed_product(free.Z, forces.statics->rows);
        Step step{search_.twists(of_tangent, lu_solution(tangent, rows).x)};
        step.moved = largest_displacement(search_.tables(), step.xi.data());
        step.size = std::max(step.moved, search_.size_of_states(step.xi));
        for (const double x : step.xi)
            if (!std::isfinite(x)) step.size = x;
        return step;
    }

    bool go(const RestPoint& from, const Step& step, double share, RestPoint& to)
    {
        Values xi = step.xi;
        for (double& x : xi) x *= share;
        to = {};
        to.states = from.states;
        for (int b = 0; b < search_.tables().n_bodies(); ++b)
            for (int k = 0; search_.holds_states(b) && k < 3; ++k) {
                const auto at = static_cast<std::size_t>(search_.tables().bodies[b].first + k);
                to.states[at] += xi[at];
            }
        std::vector<Matrix34> X;
        return search_.move_by(from, xi, X) && search_.look(std::move(X), to);
    }

    Search& search_;
    const EquilibriumOptions& options_;
};

}   // namespace

SearchOutcome rest_with_states(Search& search, const EquilibriumOptions& options, RestPoint& here,
                               int& iterations)
{
    return RestWithStates(search, options).run(here, iterations);
}

}   // namespace livens::inline statics_internal
