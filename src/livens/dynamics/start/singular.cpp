// SPDX-License-Identifier: BSD-3-Clause
// Starts in singular positions: what redundant rows ask of motions in second order, mu . gamma(Z x) = 0, and
// the branches that meet there. theory.md, "Singular positions", "A start in such a position".
#include "livens/dynamics/start/singular.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/dynamics/rows/tables.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/body.h"
#include "livens/multibody/model.h"
#include "livens/solvers/factors.h"
#include "livens/solvers/noise.h"
#include "livens/solvers/sparse_rows.h"
#include "livens/solvers/spectral.h"

namespace livens {

namespace {

using Values = std::vector<double>;

constexpr double nothing = 1e-6;     // of the terms of a sum
constexpr int most_directions = 8;   // in which branches are looked for

/// The rows and their second derivatives at one configuration, for scaled twists y.
class Curvatures {
public:
    Curvatures(const Model& model, const ConsistentStart& closed)
        : tables_(model, closed.independent), at_{closed.start.t}, maps_(12 * closed.start.X.size())
    {
        for (const Matrix34& X : closed.start.X) X_.insert(X_.end(), std::begin(X.a), std::end(X.a));
        tables_.bodies.map_twists(X_.data(), maps_.data());
        const int n = tables_.n_rows();
        gradients_.assign(static_cast<std::size_t>(tables_.rows.longest_gradient() * n), 0.0);
        scale_.resize(static_cast<std::size_t>(n));
        Values row(static_cast<std::size_t>(tables_.n_twists));
        for (int r = 0; r < n; ++r) {
            tables_.rows.gradient(r, at_, X_.data(), gradient(r));
            tables_.scaled_gradient(r, X_.data(), maps_.data(), gradient(r), row.data());
            scale_[r] = norm(row);
            for (int i = 0; i < tables_.n_twists; ++i)
                if (row[i] != 0) entries_.push_back({r, i, row[i] / scale_[r]});
        }
    }

    const ModelTables& tables() const { return tables_; }
    /// Of the rows' gradients, scaled to norm 1.
    const std::vector<SparseRows::Entry>& entries() const { return entries_; }

    /// d2 Phi/dt2 less G X'' of all rows, over the norms of their gradients.
    Values of(std::span<const double> y) const
    {
        const Values V = rates(y);
        Values centripetal(V.size(), 0.0), xi(y.size());
        tables_.bodies.to_twist(maps_.data(), y.data(), xi.data());
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            const auto& body = tables_.bodies[b];
            if (body.dofs == 3) continue;
            double spin[6] = {0, 0, 0, xi[body.first + 3], xi[body.first + 4], xi[body.first + 5]};
            twist::columns(V.data() + 12 * b, spin, centripetal.data() + 12 * b);
        }
        Values bend(scale_.size());
        for (int r = 0; r < tables_.n_rows(); ++r) {
            const auto& table = tables_.rows[r];
            double gamma = tables_.rows.curvature(r, at_, X_.data(), V.data());
            for (int side = 0; side < table.n_sides; ++side)
                for (const int column : table.columns[side])
                    for (int i = 0; i < 3; ++i)
                        gamma += gradient(r)[12 * side + column + i] *
                                 centripetal[12 * table.bodies[side] + column + i];
            bend[r] = scale_[r] > 0 ? gamma / scale_[r] : 0;
        }
        return bend;
    }

    /// What bends of a motion are compared with: they are rounding where nothing turns.
    double least_size(std::span<const double> y) const
    {
        const Values V = rates(y);
        double rate = 0;
        for (std::size_t i = 0; i < V.size(); ++i)
            rate = std::max(rate, std::abs(V[i]) / (i % 12 < 3 ? tables_.length : 1));
        return nothing * rate * norm(y);
    }

    /// X' of all bodies, 12 numbers each.
    Values rates(std::span<const double> y) const
    {
        Values xi(y.size()), V(X_.size());
        tables_.bodies.to_twist(maps_.data(), y.data(), xi.data());
        tables_.bodies.rates_of(X_.data(), xi.data(), V.data());
        return V;
    }

    /// Scaled twists of given rates: the inverse of the map, body by body.
    Values twists_of(const State& state) const
    {
        DenseMatrix D(tables_.n_twists, tables_.n_twists);
        for (int j = 0; j < D.cols; ++j) {
            Values unit(static_cast<std::size_t>(D.cols), 0.0);
            unit[j] = 1;
            tables_.bodies.to_twist(maps_.data(), unit.data(), D.column(j).data());
        }
        Values xi(static_cast<std::size_t>(tables_.n_twists), 0.0);
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            const auto& body = tables_.bodies[b];
            const Vector3 v = state.V[b].column(0);
            const Vector3 w = body.dofs == 6 ? angular_velocity(state.X[b], state.V[b]) : Vector3{};
            for (int i = 0; i < body.dofs; ++i) xi[body.first + i] = i < 3 ? v[i] : w[i - 3];
        }
        return lu_solution(D, xi).x;
    }

private:
    double* gradient(int r) { return gradients_.data() + tables_.rows.longest_gradient() * r; }
    const double* gradient(int r) const { return gradients_.data() + tables_.rows.longest_gradient() * r; }

    ModelTables tables_;
    Instant at_;
    Values X_, maps_, gradients_, scale_;
    std::vector<SparseRows::Entry> entries_;
};

Values random_vector(Noise& noise, int n)
{
    Values x(static_cast<std::size_t>(n));
    for (double& entry : x) entry = noise();
    return x;
}

/// Whether redundant combinations ask nothing of any motion, judged by some motions at random: a quadratic
/// form that is zero there is zero. Cost and room grow with the bodies. False also where that cannot be told
/// so.
bool asks_nothing(const Curvatures& curvatures, const ConsistentStart& closed)
{
    const int n_columns = curvatures.tables().n_twists;
    const std::vector<int>&independent = closed.independent, &redundant = closed.redundant;
    std::vector<SparseRows::Entry> held;
    DenseMatrix rest(n_columns, static_cast<int>(redundant.size()));
    for (const auto& entry : curvatures.entries()) {
        const auto at = std::ranges::lower_bound(independent, entry.row);
        if (at != independent.end() && *at == entry.row)
            held.push_back({static_cast<int>(at - independent.begin()), entry.column, entry.value});
        else
            rest(entry.column, static_cast<int>(std::ranges::lower_bound(redundant, entry.row) -
                                                redundant.begin())) = entry.value;
    }
    const SparseRows rows(static_cast<int>(independent.size()), n_columns, held);
    if (!(rows.smallest_pivot() > SparseRows::well_held)) return false;
    const Values zero(independent.size(), 0.0);
    std::vector<std::pair<Values, double>> bends;   // of motions, and their size
    Noise noise;
    for (int motion = 0; motion < 3; ++motion) {
        Values y = random_vector(noise, n_columns);
        rows.project(y, zero);
        const Values bend = curvatures.of(y);
        bends.emplace_back(bend, std::max(largest_size(bend), 1e3 * curvatures.least_size(y)));
    }
    for (std::size_t k = 0; k < redundant.size(); ++k) {
        const Values of_others = rows.project(rest.column(static_cast<int>(k)), zero);
        for (const auto& [bend, size] : bends) {
            double sum = bend[redundant[k]];
            for (std::size_t i = 0; i < independent.size(); ++i) sum -= of_others[i] * bend[independent[i]];
            // A tighter bound than the judge's below: in doubt the dense way decides.
            if (!(std::abs(sum) <= 1e-3 * nothing * size)) return false;
        }
    }
    return true;
}

/// What redundant combinations ask of the free motions.
class SecondOrder {
public:
    explicit SecondOrder(const Curvatures& curvatures) : curvatures_(curvatures)
    {
        const ModelTables& tables = curvatures.tables();
        DenseMatrix G(tables.n_twists, tables.n_rows());
        for (const auto& entry : curvatures.entries()) G(entry.column, entry.row) = entry.value;
        free_ = complement(G, tables.rank);
        redundant_ = complement(transpose(G), tables.rank);
    }

    const DenseMatrix& free() const { return free_; }
    int n_redundant() const { return redundant_.cols; }
    int strongest_row(int combination) const
    {
        const auto column = redundant_.column(combination);
        return static_cast<int>(std::ranges::max_element(column, {}, [](double x) { return std::abs(x); }) -
                                column.begin());
    }
    /// mu . d2 Phi/dt2 less G X'' of the redundant combinations; `size` is raised to the terms of the sums.
    Values of(std::span<const double> y, double& size) const
    {
        const Values bend = curvatures_.of(y);
        size = std::max({size, largest_size(bend), curvatures_.least_size(y)});
        return transposed_product(redundant_, bend);
    }

private:
    /// What is perpendicular to the columns of a matrix of known rank.
    static DenseMatrix complement(const DenseMatrix& A, int rank)
    {
        return PivotedQR(A).basis(rank, A.rows - rank);
    }

    const Curvatures& curvatures_;
    DenseMatrix free_, redundant_;   // motions, and combinations of rows that are zero on all motions
};

/// Rank of a matrix whose entries are known to `level`, and the columns of an orthonormal basis of its rows.
DenseMatrix row_space(const DenseMatrix& A, double level)
{
    const PivotedQR qr(transpose(A));
    int rank = 0;
    for (int k = 0; k < qr.n_pivots(); ++k) rank += qr.pivot(k) > level;
    return qr.basis(0, rank);
}

Values sum(std::span<const double> x, std::span<const double> y, double factor = 1)
{
    Values z(x.begin(), x.end());
    add_scaled(z, factor, y);
    return z;
}

/// Quadratic forms Q_k on the free motions, of which the conditions consist; `row` takes part in the largest.
std::vector<DenseMatrix> forms_of(const SecondOrder& second, double& size, int& row)
{
    const DenseMatrix& Z = second.free();
    const int f = Z.cols, n = second.n_redundant();
    std::vector<Values> squares;
    const Values rest = second.of(Values(static_cast<std::size_t>(Z.rows), 0.0), size);   // of drives
    size = 0;
    for (int i = 0; i < f; ++i) squares.push_back(second.of(Z.column(i), size));
    DenseMatrix packed(n, f * (f + 1) / 2);
    for (int i = 0, at = 0; i < f; ++i)
        for (int j = i; j < f; ++j, ++at) {
            const Values both = second.of(sum(Z.column(i), Z.column(j)), size);
            for (int k = 0; k < n; ++k)
                // Polarisation: Q(x, y) = (Q(x + y) - Q(x) - Q(y)) / 2. `rest` is of drives, and was
                // subtracted once too often.
                packed(k, at) = 0.5 * (both[k] - squares[i][k] - squares[j][k] + rest[k]);
        }
    const Values in_rows = row_norms(packed);
    row = second.strongest_row(static_cast<int>(std::ranges::max_element(in_rows) - in_rows.begin()));
    // the span of the forms, with the metric of symmetric matrices left aside
    const DenseMatrix basis = row_space(packed, nothing * size);
    std::vector<DenseMatrix> forms;
    for (int k = 0; k < basis.cols; ++k) {
        DenseMatrix Q(f, f);
        for (int i = 0, at = 0; i < f; ++i)
            for (int j = i; j < f; ++j, ++at) Q(i, j) = Q(j, i) = basis(at, k);
        forms.push_back(Q);
    }
    return forms;
}

/// Whether one of the forms is definite, so that no motion fulfils it.
bool is_locked(const std::vector<DenseMatrix>& forms)
{
    return std::ranges::any_of(forms, [](const DenseMatrix& Q) {
        const Values eigenvalues = symmetric_values(Q);
        return eigenvalues.front() > nothing || eigenvalues.back() < -nothing;
    });
}

Values normalised(Values x)
{
    const double size = norm(x);
    if (size > 0)
        for (double& entry : x) entry /= size;
    return x;
}

/// A root of the forms on the unit sphere near a start, by Newton's iteration; empty if it finds none where
/// the conditions are independent.
Values root_near(const std::vector<DenseMatrix>& forms, Values x)
{
    const int m = static_cast<int>(forms.size()), f = static_cast<int>(x.size());
    DenseMatrix J(m + 1, f);
    Values r(forms.size() + 1, 0.0);   // less what the forms are
    for (int iteration = 0; iteration < 50; ++iteration) {
        for (int k = 0; k < m; ++k) {
            const Values slope = product(forms[k], x);
            for (int i = 0; i < f; ++i) J(k, i) = 2 * slope[i];
            r[k] = -dot(x, slope);
        }
        for (int i = 0; i < f; ++i) J(m, i) = x[i];
        const PivotedQR qr(J);
        // Where the conditions are dependent two branches touch, and Newton's iteration has no meaning.
        if (qr.pivot(f - 1) < nothing) return {};
        const Values dx = qr.solve(r);
        x = normalised(sum(x, dx));
        if (norm(dx) < 1e-13) return x;
    }
    return {};
}

/// All of them, up to their signs.
std::vector<Values> roots_of(const std::vector<DenseMatrix>& forms, int f)
{
    std::vector<Values> roots;
    Noise noise;
    const int starts = 64 << f;   // of 2^(f - 1) roots at most
    for (int i = 0; i < starts; ++i) {
        const Values root = root_near(forms, normalised(random_vector(noise, f)));
        if (root.empty()) continue;
        const bool is_known = std::ranges::any_of(
            roots, [&](const Values& other) { return 1 - std::abs(dot(root, other)) < 1e-9; });
        if (!is_known) roots.push_back(root);
    }
    return roots;
}

}   // namespace

Mobility mobility(const Model& model, const ConsistentStart& closed)
{
    Mobility result;
    result.first_order = closed.degrees_of_freedom;
    if (closed.redundant.empty() || closed.degrees_of_freedom == 0) return result;
    const Curvatures curvatures(model, closed);
    if (asks_nothing(curvatures, closed)) return result;
    const SecondOrder second(curvatures);
    double size = 0;
    const std::vector<DenseMatrix> forms = forms_of(second, size, result.row);
    const DenseMatrix& Z = second.free();
    result.conditions = static_cast<int>(forms.size());
    if (!result.is_singular()) return result;
    result.is_locked = is_locked(forms);

    const Values y = curvatures.twists_of(closed.start);
    double speed_size = 0;
    const Values rest = second.of(y, speed_size);
    result.are_possible = largest_size(rest) <= nothing * speed_size || speed_size == 0;
    DenseMatrix J(second.n_redundant(), Z.cols);
    double unused = 0;
    for (int j = 0; j < Z.cols; ++j) {
        const Values ahead = second.of(sum(y, Z.column(j)), unused),
                     behind = second.of(sum(y, Z.column(j), -1), unused);
        // Central differences of quadratic forms are exact: these are 2 Q_mu x along each free motion.
        for (int k = 0; k < J.rows; ++k) J(k, j) = 0.5 * (ahead[k] - behind[k]);
    }
    const int rank = norm(y) > 0 ? row_space(J, nothing * size * norm(y)).cols : 0;
    result.choose_branch = result.are_possible && rank == result.conditions;

    if (result.conditions != result.first_order - 1 || result.first_order > most_directions) return result;
    for (const Values& root : roots_of(forms, Z.cols)) {
        const Values V = curvatures.rates(product(Z, root));
        const double fastest =
            std::abs(*std::ranges::max_element(V, {}, [](double v) { return std::abs(v); }));
        std::vector<Matrix34>& branch = result.branches.emplace_back(closed.start.X.size());
        for (std::size_t i = 0; i < V.size(); ++i) branch[i / 12].a[i % 12] = V[i] / fastest;
    }
    return result;
}

}   // namespace livens
