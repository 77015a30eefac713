// SPDX-License-Identifier: BSD-3-Clause
// Which rows are independent, and which spins have no inertia: theory.md, "Rank is geometry" and "Spins
// without inertia". Masses do not enter the rank; every threshold is one of these two sections.
#include "livens/dynamics/rows/rank.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>

#include "livens/dynamics/rows/forest.h"
#include "livens/solvers/factors.h"
#include "livens/solvers/sparse_rows.h"
#include "livens/solvers/spectral.h"

namespace livens::inline dynamics_internal {

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

// --- inertia

/// An axis through the centre of mass without inertia.
struct FreeAxis {
    int body;
    Vector3 axis;      ///< world axes
    Vector3 center;    ///< of mass, body coordinates
    double gyration;   ///< m
    double doubt;      ///< of the direction, rad
};

void add_free_axes(int b, const Body& body, const Matrix34& X, std::vector<FreeAxis>& free)
{
    const MassProperties known = mass_properties(body.mass);
    const PrincipalValues J = symmetric_spectrum(known.inertia);
    // Inequality: J <= 16 eps tr E is no inertia, since J comes from E by subtraction.
    const double level = 16 * eps * (body.mass(1, 1) + body.mass(2, 2) + body.mass(3, 3));
    const double gyration = std::sqrt(std::max(J.values[2], 0.0) / known.mass);
    int n = 0;
    while (n < 3 && J.values[n] <= level) ++n;
    const double doubt = n < 3 ? level / J.values[n] : 0;
    for (int k = 0; k < n; ++k)
        free.push_back({b, X * direction(J.vectors.column(k)), known.center_of_mass, gyration, doubt});
}

/// The moment of a row about the axis; zero if it is not above what is known.
double hold_of(const Wrench& w, const Matrix34& X, const FreeAxis& free)
{
    const double force = norm(w.force);
    const double size = norm(w.moment) + (norm(w.at - free.center) + free.gyration) * force;
    const double digits = 8 * eps * (norm(X.column(0)) + norm(w.at) + norm(free.center)) * force;
    const double moment = dot(free.axis, moment_about(w, X, free.center));
    // Three doubts: the threshold of rank, the direction of the axis, and the digits of far points.
    return std::abs(moment) > (1e-9 + free.doubt) * size + digits ? moment : 0;
}

void normalise_row(DenseMatrix& A, int row)
{
    double largest = 0, square = 0;
    for (int j = 0; j < A.cols; ++j) largest = std::max(largest, std::abs(A(row, j)));
    for (int j = 0; j < A.cols; ++j) square += (A(row, j) / largest) * (A(row, j) / largest);
    if (!(square > 0)) return;   // nan where all are zero
    const double size = std::sqrt(square) * largest;
    for (int j = 0; j < A.cols; ++j) A(row, j) /= size;
}

/// Spins about the free axes that no row holds, a combination in each column.
DenseMatrix unheld_spins(std::span<const Matrix34> X, const RowWrenches& wrenches,
                         const std::vector<FreeAxis>& free)
{
    const int n_rows = static_cast<int>(wrenches.size()), n_columns = static_cast<int>(free.size());
    DenseMatrix H(std::max(n_rows, 1), n_columns);
    for (int r = 0; r < n_rows; ++r)
        for (int k = 0; k < n_columns; ++k)
            for (const Wrench& w : wrenches[r])
                if (w.body == free[k].body) H(r, k) += hold_of(w, X[w.body], free[k]);
    for (int r = 0; r < n_rows; ++r) normalise_row(H, r);
    return null_space(H, 1e-9);
}

// --- rank

/// What the twists of a body are measured by, see twist_rows().
struct Pole {
    Vector3 point{};
    double length = 0;
    double reach = 0;   ///< of positions and joint points
};

std::vector<Pole> poles_of(const Model& model, std::span<const Matrix34> X, const RowWrenches& wrenches)
{
    std::vector<Pole> poles(X.size());
    std::vector<double> counts(X.size(), 0.0);
    const auto each = [&](const auto& act) {
        for (const auto& row : wrenches)
            for (const Wrench& w : row) act(w, poles[w.body]);
    };
    each([&](const Wrench& w, Pole& pole) {
        pole.point += (1 / ++counts[w.body]) * (w.at - pole.point);
        pole.reach = std::max(pole.reach, norm(X[w.body].column(0)) + norm(w.at));
    });
    double largest = 0;
    each([&](const Wrench& w, Pole& pole) {
        const double force = norm(w.force);
        if (force == 0) return;
        const double arm = std::max(norm(w.at - pole.point), norm(w.moment) / force);
        // Points of one body that are nearer to each other than their rounding are one point.
        if (arm > 1e-13 * pole.reach) pole.length = std::max(pole.length, arm);
        largest = std::max(largest, pole.length);
    });
    if (largest == 0) largest = model.length();
    // sqrt(a A): rows of points want the body's own arm, rows of axes the largest one of all bodies.
    for (Pole& pole : poles) pole.length = std::sqrt((pole.length > 0 ? pole.length : largest) * largest);
    return poles;
}

/// A row's parts and doubt.
BodyRow touched_row(std::span<const Wrench> wrenches, std::span<const Matrix34> X,
                    const std::vector<Pole>& poles, double& doubt)
{
    BodyRow row;
    for (const Wrench& w : wrenches) {
        auto part = std::ranges::find(row.parts, w.body, &BodyRow::Part::body);
        if (part == row.parts.end()) part = row.parts.insert(row.parts.end(), {w.body, {}});
        const Vector3 moment = moment_about(w, X[w.body], poles[w.body].point);
        for (int i = 0; i < 3; ++i) {
            part->entries[i] += w.force[i];
            part->entries[3 + i] += moment[i] / poles[w.body].length;
        }
        doubt = std::max(doubt, w.doubt);
    }
    return row;
}

void scale_to_one(BodyRow& row)
{
    double largest = 0, square = 0;
    for (const auto& part : row.parts)
        for (const double x : part.entries) largest = std::max(largest, std::abs(x));
    if (!(largest > 0)) return;
    for (const auto& part : row.parts)
        for (const double x : part.entries) square += (x / largest) * (x / largest);
    row.size = largest * std::sqrt(square);
    for (auto& part : row.parts)
        for (double& x : part.entries) x /= row.size;
}

}   // namespace

TwistRows twist_rows(const Model& model, std::span<const Matrix34> X, std::span<const int> rows)
{
    return twist_rows(model, X, rows, row_wrenches(model, X));
}

TwistRows twist_rows(const Model& model, std::span<const Matrix34> X, std::span<const int> rows,
                     const RowWrenches& wrenches)
{
    const std::vector<Pole> poles = poles_of(model, X, wrenches);
    TwistRows twists;
    for (const Pole& pole : poles) twists.doubt = std::max(twists.doubt, 8 * eps * pole.reach / pole.length);
    for (const int r : rows) {
        twists.rows.push_back(touched_row(wrenches[r], X, poles, twists.doubt));
        scale_to_one(twists.rows.back());
    }
    return twists;
}

namespace {

/// Rows that hold so well are independent by any judge.
constexpr double well_held = 1e-3;

/// Ties go to the row that comes first.
double favour(int row, int n) { return 1 - 1e-3 * static_cast<double>(row) / static_cast<double>(n); }

/// Of rows of norm 1 those that depend on others, ascending, if all others are clearly independent: joint by
/// joint along trees, and where loops close by what they add to that. Else nothing.
std::optional<std::vector<int>> clearly_dependent(const std::vector<BodyRow>& rows, int n_bodies,
                                                  double threshold, double& smallest_pivot)
{
    const Forest forest = spanning_forest(rows, n_bodies, well_held);
    smallest_pivot = forest.smallest_pivot;
    std::vector<int> dependent;
    if (forest.closing.empty()) return dependent;
    const int n_closing = static_cast<int>(forest.closing.size());
    const SparseRows held(static_cast<int>(forest.rows.size()), 6 * n_bodies, entries_of(rows, forest.rows));
    if (!(held.smallest_pivot() > SparseRows::well_held)) return {};
    const std::vector<double> nothing(forest.rows.size(), 0.0);
    DenseMatrix added(6 * n_bodies, n_closing);
    for (const auto& entry : entries_of(rows, forest.closing)) added(entry.column, entry.row) = entry.value;
    for (int k = 0; k < n_closing; ++k) {
        held.project(added.column(k), nothing);
        for (double& entry : added.column(k)) entry *= favour(k, n_closing);
    }
    const PivotedQR qr(added);
    for (int k = 0; k < n_closing; ++k) {
        const double pivot = k < qr.n_pivots() ? qr.pivot(k) : 0;   // no more directions are there
        if (pivot > well_held)
            smallest_pivot = std::min(smallest_pivot, pivot);
        else if (pivot <= threshold)
            dependent.push_back(forest.closing[qr.column(k)]);
        else
            return {};
    }
    std::ranges::sort(dependent);
    return dependent;
}

}   // namespace

namespace {

/// The places of the dependent rows, by the clear judge if `fits` the answer, else by column pivoting, where
/// is_independent(k, ratio) of the k-th pivot.
std::vector<int> judge(const TwistRows& twists, int n_bodies, double threshold, double& smallest_pivot,
                       const auto& fits, const auto& is_independent)
{
    const auto clear = clearly_dependent(twists.rows, n_bodies, threshold, smallest_pivot);
    if (clear && fits(*clear)) return *clear;
    smallest_pivot = 1;
    DenseMatrix G(6 * n_bodies, static_cast<int>(twists.rows.size()));
    for (int r = 0; r < G.cols; ++r)
        for (const auto& part : twists.rows[r].parts)
            for (int i = 0; i < 6; ++i) G(6 * part.body + i, r) = favour(r, G.cols) * part.entries[i];
    const PivotedQR qr(G);
    int k = 0;
    while (k < qr.n_pivots() && is_independent(k, qr.pivot(k) / qr.pivot(0))) ++k;
    if (k > 0) smallest_pivot = qr.pivot(k - 1) / qr.pivot(0);
    std::vector<int> dependent;
    for (; k < G.cols; ++k) dependent.push_back(qr.column(k));
    std::ranges::sort(dependent);
    return dependent;
}

void part(std::span<const int> rows, const std::vector<int>& dependent, RowRank& rank)
{
    for (int k = 0; k < static_cast<int>(rows.size()); ++k)
        (std::ranges::binary_search(dependent, k) ? rank.dependent : rank.independent).push_back(rows[k]);
    std::ranges::sort(rank.independent);
    std::ranges::sort(rank.dependent);
}

}   // namespace

RowRank row_rank(const Model& model, std::span<const Matrix34> X, std::span<const int> rows, double threshold)
{
    if (rows.empty()) return {};
    return row_rank(twist_rows(model, X, rows), model.n_bodies(), rows, threshold);
}

RowRank row_rank(const TwistRows& twists, int n_bodies, std::span<const int> rows, double threshold)
{
    RowRank rank;
    if (rows.empty()) return rank;
    // The doubt of joint points far from their reference may exceed the threshold, but never calls clear rows
    // parallel.
    threshold = std::max(threshold, std::min(twists.doubt, 1e-4));
    part(rows,
         judge(
             twists, n_bodies, threshold, rank.smallest_pivot, [](const std::vector<int>&) { return true; },
             [threshold](int, double ratio) { return ratio > threshold; }),
         rank);
    return rank;
}

namespace {

/// Chooses as many rows as `result` names, which does not hold well.
void choose_again(const TwistRows& twists, int n_bodies, Dependencies& result)
{
    const int n_independent = static_cast<int>(result.independent.size());
    std::vector<int> rows(twists.rows.size());
    std::iota(rows.begin(), rows.end(), 0);
    RowRank rank;
    part(rows,
         judge(
             twists, n_bodies, std::max(1e-9, std::min(twists.doubt, 1e-4)), rank.smallest_pivot,
             [&](const std::vector<int>& dependent) { return dependent.size() == result.dependent.size(); },
             [n_independent](int k, double) { return k < n_independent; }),
         rank);
    result.independent = std::move(rank.independent);
    result.dependent = std::move(rank.dependent);
}

}   // namespace

Dependencies dependencies(const Model& model, std::span<const Matrix34> X, std::span<const int> independent,
                          const RowWrenches& wrenches)
{
    const int n_columns = 6 * model.n_bodies(), n_independent = static_cast<int>(independent.size());
    const TwistRows twists = twist_rows(model, X, all_rows(model), wrenches);
    Dependencies result{{independent.begin(), independent.end()}, {}, {}, {}};
    for (const BodyRow& row : twists.rows) result.sizes.push_back(row.size);
    std::ranges::sort(result.independent);
    std::ranges::set_difference(all_rows(model), result.independent, std::back_inserter(result.dependent));
    auto held =
        std::make_unique<SparseRows>(n_independent, n_columns, entries_of(twists.rows, result.independent));
    // The given rows may hold badly in this position, although others of the same rank hold well.
    if (!(held->smallest_pivot() > well_held)) {
        choose_again(twists, model.n_bodies(), result);
        held = std::make_unique<SparseRows>(n_independent, n_columns,
                                            entries_of(twists.rows, result.independent));
    }
    DenseMatrix rest(n_columns, static_cast<int>(result.dependent.size()));
    for (const auto& entry : entries_of(twists.rows, result.dependent))
        rest(entry.column, entry.row) = entry.value;
    if (held->smallest_pivot() > SparseRows::well_held) {
        const std::vector<double> nothing(result.independent.size(), 0.0);
        for (int k = 0; k < rest.cols; ++k) result.factors.push_back(held->project(rest.column(k), nothing));
    } else {
        DenseMatrix G(n_columns, n_independent);
        for (const auto& entry : entries_of(twists.rows, result.independent))
            G(entry.column, entry.row) = entry.value;
        const DenseMatrix factors = least_squares(G, rest);
        for (int k = 0; k < factors.cols; ++k)
            result.factors.emplace_back(factors.column(k).begin(), factors.column(k).end());
    }
    for (std::size_t k = 0; k < result.dependent.size(); ++k)   // of rows as they are, not scaled to one
        for (std::size_t i = 0; i < result.independent.size(); ++i)
            result.factors[k][i] *= result.sizes[result.dependent[k]] / result.sizes[result.independent[i]];
    return result;
}

std::optional<WeightlessSpin> weightless_spin(const Model& model, std::span<const Matrix34> X)
{
    std::vector<FreeAxis> free;
    for (int b = 0; b < model.n_bodies(); ++b)
        if (!model.bodies()[b].is_point) add_free_axes(b, model.bodies()[b], X[b], free);
    if (free.empty()) return {};
    const DenseMatrix spins = unheld_spins(X, row_wrenches(model, X), free);
    if (spins.cols == 0) return {};
    std::vector<Vector3> w(X.size());
    for (std::size_t k = 0; k < free.size(); ++k)
        w[free[k].body] += spins(static_cast<int>(k), 0) * free[k].axis;
    const auto fastest = std::ranges::max_element(w, {}, [](const Vector3& v) { return norm(v); });
    WeightlessSpin spin;
    spin.body = static_cast<int>(fastest - w.begin());
    spin.axis = (1 / norm(*fastest)) * *fastest;
    if (std::ranges::max(spin.axis.a) < -std::ranges::min(spin.axis.a)) spin.axis *= -1;
    const MassProperties known = mass_properties(model.bodies()[spin.body].mass);
    const double remote = known.mass * dot(known.center_of_mass, known.center_of_mass);
    spin.by_digits = 16 * eps * remote > 1e-9 * trace(known.inertia);
    return spin;
}

}   // namespace livens::inline dynamics_internal
