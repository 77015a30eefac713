// SPDX-License-Identifier: BSD-3-Clause
// The nearest positions and velocities that fulfil the joints, in the mass metric: theory.md, "Starting".
// Gauss-Newton steps on the rotation group for positions, one least-squares step for velocities, both in
// mass-orthonormal coordinates.
#include "livens/dynamics/rows/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/solvers/dense.h"
#include "livens/solvers/sparse_rows.h"

namespace livens::inline dynamics_internal {

namespace {

/// One body in mass-orthonormal coordinates y = (sqrt(M) v_c, L^T w_body): its kinetic energy is 1/2 |y|^2,
/// and nothing in them is a difference of large numbers. L L^T is the inertia about the centre of mass and
/// 1e-14 of its trace (more where rounding has left it indefinite): a spin without inertia stays as it is
/// where no joint holds it.
struct Inertia {
    explicit Inertia(const Body& body) : known(mass_properties(body.mass)), root_mass(std::sqrt(known.mass))
    {
        if (body.is_point) return;
        Cholesky cholesky;
        cholesky.resize(3);
        // Only the coordinates feel the shift: it chooses among motions that the equations of rigid bodies do
        // not tell apart.
        double shift = 1e-14 * std::abs(trace(known.inertia));
        for (bool definite = false; !definite; shift = shift > 0 ? 10 * shift : 1e-14 * known.mass) {
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) cholesky.row(i)[j] = known.inertia(i, j) + (i == j ? shift : 0);
            definite = cholesky.factorise();
        }
        Matrix3 L{};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j <= i; ++j) L(i, j) = cholesky.row(i)[j];
        spin = transpose(inverse(L));
    }

    /// What a force and a moment about the centre of mass do to y.
    void push(const Matrix34& X, const Vector3& force, const Vector3& moment, double* y) const
    {
        const Vector3 turning = transpose(directors(X) * spin) * moment;
        for (int i = 0; i < 3; ++i) {
            y[i] = force[i] / root_mass;
            y[3 + i] = turning[i];
        }
    }

    MassProperties known;
    double root_mass;
    Matrix3 spin{};   ///< L^-T: w_body = spin y_2; zero for a point mass
};

struct Twist {
    Vector3 velocity{};   ///< of the centre of mass
    Vector3 spin{};       ///< world axes
};

/// The directions of y that the given independent rows hold, and those that they leave free, at X.
/// Reflections lead with the largest entry: planar data keep their zeros, and masses may be of any ratio
/// [Cox1998].
class Projector {
public:
    Projector(const Model& model, const std::vector<Inertia>& inertias, std::span<const Matrix34> X,
              std::span<const int> rows)
        : inertias_(inertias), X_(X), order_(rows.size()), size_(rows.size(), 1.0)
    {
        const int n = 6 * model.n_bodies(), rank = static_cast<int>(rows.size());
        const RowWrenches wrenches = row_wrenches(model, X);
        std::vector<SparseRows::Entry> entries;
        for (int k = 0; k < rank; ++k) {
            const std::size_t first = entries.size();
            double square = 0;
            for (const Wrench& w : wrenches[rows[k]]) {
                const Vector3 moment = moment_about(w, X[w.body], inertias[w.body].known.center_of_mass);
                double y[6];
                inertias[w.body].push(X[w.body], w.force, moment, y);
                for (int i = 0; i < 6; ++i) entries.push_back({k, 6 * w.body + i, y[i]});
                square += std::inner_product(y, y + 6, y, 0.0);
            }
            if (square > 0) size_[k] = std::sqrt(square);
            for (std::size_t i = first; i < entries.size(); ++i) entries[i].value /= size_[k];
        }
        // Elimination squares the rows, and with them ratios of masses; the orthogonal basis bears any ratio.
        if (masses_are_alike()) by_elimination_ = std::make_unique<SparseRows>(rank, n, entries);
        if (by_elimination_ && by_elimination_->smallest_pivot() > SparseRows::well_held) {
            std::iota(order_.begin(), order_.end(), 0);
            return;
        }
        by_elimination_.reset();
        basis_.resize(n, rank);
        for (int k = 0; k < rank; ++k) std::fill_n(basis_.column(k), n, 0.0);
        for (const auto& entry : entries) basis_.column(entry.row)[entry.column] += entry.value;
        basis_.factorise_pivoted(rank, order_);
    }

    /// The twists nearest to the rates or displacements dX, which need not be rigid, with dPhi = `wanted`.
    std::vector<Twist> nearest(std::span<const Matrix34> dX, std::span<const double> wanted) const
    {
        std::vector<double> y(6 * X_.size());
        for (std::size_t b = 0; b < X_.size(); ++b) {
            const MassProperties& m = inertias_[b].known;
            const Matrix3 P = directors(dX[b]) * (0.5 * trace(m.inertia) * identity<3>() - m.inertia);
            Vector3 spin{};
            for (int i = 0; i < 3; ++i) spin += cross(X_[b].column(i + 1), P.column(i));
            inertias_[b].push(X_[b], m.mass * (dX[b] * point(m.center_of_mass)), spin, &y[6 * b]);
        }
        std::vector<double> held(wanted.size());
        for (std::size_t k = 0; k < held.size(); ++k) held[k] = wanted[order_[k]] / size_[order_[k]];
        if (by_elimination_) {
            by_elimination_->project(y, held);
        } else {
            basis_.solve_R_transposed(held.data());
            basis_.apply_transposed(y.data());
            std::ranges::copy(held, y.begin());
            basis_.apply(y.data());
        }
        std::vector<Twist> twists;
        for (std::size_t b = 0; b < X_.size(); ++b) {
            const double *v = &y[6 * b], *w = v + 3, unit = 1 / inertias_[b].root_mass;
            twists.push_back({unit * Vector3{v[0], v[1], v[2]},
                              directors(X_[b]) * (inertias_[b].spin * Vector3{w[0], w[1], w[2]})});
        }
        return twists;
    }

private:
    /// Else squares of the rows have no digits of what heavy bodies do.
    bool masses_are_alike() const
    {
        const auto [lightest, heaviest] = std::ranges::minmax_element(
            inertias_, {}, [](const Inertia& inertia) { return inertia.root_mass; });
        return inertias_.empty() || heaviest->root_mass < 30 * lightest->root_mass;
    }

    const std::vector<Inertia>& inertias_;
    std::span<const Matrix34> X_;
    std::vector<int> order_;
    std::vector<double> size_;                     ///< norms of the rows before they were scaled to one
    std::unique_ptr<SparseRows> by_elimination_;   // where that has digits enough, else the basis
    OrthogonalBasis basis_;
};

/// Column 0 of dX from the motion of the centre of mass and the change of directors.
void set_reference(const Inertia& inertia, const Vector3& of_center, Matrix34& dX)
{
    dX.set_column(0, of_center - dX * direction(inertia.known.center_of_mass));
}

/// One closing of the given rows with one threshold for their pivots.
class Closer {
public:
    Closer(const Model& model, std::span<const Matrix34> X_from, std::span<const Matrix34> X_given,
           std::span<const int> rows)
        : model_(model), inertias_(model.bodies().begin(), model.bodies().end()), from_(X_from),
          given_(X_given), rows_(rows), length_(model.length())
    {}

    Closing run(bool nearest, double threshold) const
    {
        Closing best{false, {from_.begin(), from_.end()}};
        std::vector<Matrix34> X = best.X;
        // Teeth that mesh where the bodies were stated do so however far the closing moves them.
        std::vector<double> phi = joint_values_from(model_, joint_values(model_, given_), given_, X);
        Gap least = widest_gap(model_, X, rows_, phi);
        int since_best = 0;
        for (int i = 0; i < 100 && since_best < 6 && (least.level > 1 || nearest); ++i) {
            // With `nearest` each step also pulls back to the given place, so the limit is a foot of the
            // perpendicular.
            const std::vector<Matrix34> before = X;
            const double step = iterate(X, phi, nearest, threshold);
            if (!std::isfinite(step)) break;
            phi = joint_values_from(model_, phi, before, X);
            // The pull leaves the rows open by its own convergence; the last steps close them without it.
            if (nearest && (step < 1e-9 || i >= 30)) nearest = false;
            const Gap now = widest_gap(model_, X, rows_, phi);
            since_best = nearest || now.level < least.level ? 0 : since_best + 1;
            if (since_best > 0) continue;
            least = now;
            best.X = X;
        }
        best.closed = least.level <= 1 || least.violation < 1e-12;
        return best;
    }

private:
    /// One step, shortened so that no body turns by more than half a radian; returns its size relative to the
    /// model (1: a length, a radian).
    double iterate(std::vector<Matrix34>& X, std::span<const double> phi, bool nearest,
                   double threshold) const
    {
        const std::vector<int> rows = row_rank(model_, X, rows_, threshold).independent;
        std::vector<double> wanted;
        for (const int r : rows) wanted.push_back(-phi[r]);
        std::vector<Matrix34> back(X.size(), Matrix34{});
        for (std::size_t b = 0; nearest && b < X.size(); ++b) back[b] = given_[b] - X[b];
        const std::vector<Twist> twists = Projector(model_, inertias_, X, rows).nearest(back, wanted);
        double shift = 0, angle = 0;
        bool finite = true;
        for (const Twist& twist : twists) {
            shift = std::max(shift, norm(twist.velocity) / length_);
            angle = std::max(angle, norm(twist.spin));
            finite = finite && std::isfinite(norm(twist.velocity) + norm(twist.spin));
        }
        if (!finite) return std::numeric_limits<double>::infinity();
        // Beyond half a radian the linear foretelling of a turn is worth little, and may lead to another
        // branch.
        const double fraction = angle > 0.5 ? 0.5 / angle : 1;
        for (std::size_t b = 0; b < X.size(); ++b) {
            const Vector3 w = fraction * twists[b].spin;
            const double turn[6] = {0, 0, 0, w[0], w[1], w[2]};
            Matrix34 change{};
            twist::displacement(turn, X[b].data(), change.data());
            set_reference(inertias_[b], fraction * twists[b].velocity, change);
            X[b] += change;
        }
        return std::max(shift, angle);
    }

    const Model& model_;
    std::vector<Inertia> inertias_;
    std::span<const Matrix34> from_, given_;
    std::span<const int> rows_;
    double length_;
};

}   // namespace

Closing close_rows(const Model& model, std::span<const Matrix34> X_given, std::span<const int> rows,
                   bool nearest)
{
    return close_rows_from(model, X_given, X_given, rows, nearest);
}

Closing close_rows_from(const Model& model, std::span<const Matrix34> X_from,
                        std::span<const Matrix34> X_given, std::span<const int> rows, bool nearest)
{
    const Closer closer(model, X_from, X_given, rows);
    Closing closing;
    // A start far away may spoil the pull towards the nearest configuration, and rows that are all but
    // redundant need a smaller threshold; each attempt starts afresh.
    for (const double threshold : {1e-4, 1e-7, 1e-9}) {
        if (nearest) {
            closing = closer.run(true, threshold);
            if (closing.closed) return closing;
        }
        closing = closer.run(false, threshold);
        if (closing.closed) return closing;
    }
    return closer.run(false, 1e-4);
}

std::vector<Matrix34> nearest_rates(const Model& model, std::span<const Matrix34> X,
                                    std::span<const Matrix34> V, std::span<const int> rows,
                                    std::span<const double> drive_rates)
{
    const std::vector<Inertia> inertias(model.bodies().begin(), model.bodies().end());
    const Projector projector(model, inertias, X, rows);
    // The first pass projects, the others take rounding out of dPhi/dt and of the part that does not move any
    // more.
    std::vector<Matrix34> rates(X.size(), Matrix34{}), missing(X.size());
    std::vector<double> wanted(rows.size());
    for (int pass = 0; pass < 3; ++pass) {
        const std::vector<double> left = joint_rates(model, X, rates);
        for (std::size_t k = 0; k < rows.size(); ++k)
            wanted[k] = -left[rows[k]] - (drive_rates.empty() ? 0.0 : drive_rates[rows[k]]);
        for (std::size_t b = 0; b < X.size(); ++b) missing[b] = V[b] - rates[b];
        const std::vector<Twist> twists = projector.nearest(missing, wanted);
        for (std::size_t b = 0; b < X.size(); ++b) {
            Matrix34 more = rate(X[b], {}, twists[b].spin);
            set_reference(inertias[b], twists[b].velocity, more);
            rates[b] += more;
        }
    }
    return rates;
}

}   // namespace livens::inline dynamics_internal
