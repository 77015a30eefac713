// SPDX-License-Identifier: BSD-3-Clause
// The multipliers of rigidity, which are the stress of a body summed over it: theory.md, "Bodies without
// rotation parameters", Stress of rigidity. They come from the equations of motion at the instant, F - G^T
// lambda - X'' m along the directors.
#include "livens/diagnostics/rigidity.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "livens/base/error.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/sample.h"
#include "livens/dynamics/instant/reactions.h"
#include "livens/dynamics/rows/row_tables.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/multibody/acting_models.h"
#include "livens/multibody/rotors.h"
#include "livens/multibody/unwrapped_angles.h"
#include "livens/statics/small_motions.h"

namespace livens {

namespace {

/// rest -= G^T lambda.
void take_off_rows(const RowTables& rows, Instant at, std::span<const Matrix34> X,
                   std::span<const double> multipliers, std::vector<Matrix34>& rest)
{
    for (int r = 0; r < std::ssize(multipliers); ++r) {
        if (multipliers[r] == 0) continue;
        const RowTable& row = rows[static_cast<std::size_t>(r)];
        double g[RowTables::gradient_size];
        rows.gradient(r, at, X.data()->data(), g);
        for (int side = 0; side < row.n_sides; ++side)
            for (const int column : row.columns[side])
                for (int i = column; i < column + 3; ++i)
                    rest[static_cast<std::size_t>(row.bodies[side])].a[i] -=
                        multipliers[r] * g[12 * side + i];
    }
}

/// rest -= a q'' dq/dX of inertias along coordinates.
void take_off_rotors(const Model& model, Instant at, std::span<const Matrix34> X, std::span<const Matrix34> V,
                     std::span<const Matrix34> A, std::vector<Matrix34>& rest)
{
    for (const Rotor& rotor : rotors_of(model)) {
        const ConstraintRow row = coupling_row({{1, rotor.coordinate}}, 0, 1, "rotor");
        const double force =
            rotor.inertia * (coordinate_rate(rotor.coordinate, X, A) + constraint_curvature(row, at, X, V));
        const RowGradient gradient = constraint_gradient(row, at, X);
        for (int side = 0; side < gradient.bodies.size; ++side)
            rest[static_cast<std::size_t>(gradient.bodies.bodies[static_cast<std::size_t>(side)])] -=
                force * gradient.by[static_cast<std::size_t>(side)];
    }
}

/// rest += F of loads.
void add_loads(const Model& model, Instant at, std::span<const Matrix34> X, std::span<const Matrix34> V,
               std::span<const double> angles, std::vector<Matrix34>& rest)
{
    if (model.loads().empty()) return;
    const UnwrappedAngles turns(model);
    for (int l = 0; l < static_cast<int>(model.loads().size()); ++l) {
        const Load& load = model.loads()[l];
        LoadForces F(load.n_acted);
        load.forces(load_arguments(load, at, X, V, turns.of(l, angles)), F);
        for (std::size_t b = 0; b < load.n_acted; ++b)
            if (load.bodies[b] != world) rest[static_cast<std::size_t>(load.bodies[b])] += F[b];
    }
}

/// F - G^T lambda - X'' m of all bodies, each load and row looked at once.
std::vector<Matrix34> forces_less_inertia(const Model& model, const RowTables& rows, Instant at,
                                          std::span<const Matrix34> X, std::span<const Matrix34> V,
                                          std::span<const Matrix34> A, std::span<const double> multipliers,
                                          std::span<const double> angles)
{
    std::vector<Matrix34> rest;
    rest.reserve(X.size());
    for (std::size_t b = 0; b < X.size(); ++b)
        rest.push_back(weight(model.bodies()[b], model.gravity()) - A[b] * model.bodies()[b].mass);
    add_loads(model, at, X, V, angles, rest);
    take_off_rows(rows, at, X, multipliers, rest);
    take_off_rotors(model, at, X, V, A, rest);
    return rest;
}

/// Of what is left the parts along the directors.
std::array<double, 6> along_directors(const Matrix34& rest, const Matrix34& X)
{
    const Matrix3 along = transpose(directors(rest)) * directors(X);   // (a, b): column a along d_b
    return {along(0, 0), along(1, 1), along(2, 2), along(0, 1), along(0, 2), along(1, 2)};
}

}   // namespace

std::vector<double> rigidity_multipliers(const Model& model, int body, Instant at,
                                         std::span<const Matrix34> X, std::span<const Matrix34> V,
                                         std::span<const Matrix34> A, std::span<const double> multipliers,
                                         std::span<const double> angles)
{
    assert(body >= 0 && body < model.n_bodies());
    assert(static_cast<int>(multipliers.size()) == model.n_rows());
    if (model.bodies()[body].is_point) return std::vector<double>(6, 0.0);
    const RowTables rows(model, false);
    const std::array<double, 6> six =
        along_directors(forces_less_inertia(model, rows, at, X, V, A, multipliers, angles)[body], X[body]);
    return {six.begin(), six.end()};
}

namespace {

/// X'' = [a, alpha x d_i + w x (w x d_i)].
Matrix34 acceleration(const Matrix34& X, const double* twist, const double* rates)
{
    const Vector3 alpha{twist[3], twist[4], twist[5]}, w{rates[3], rates[4], rates[5]};
    Matrix34 A{};
    A.set_column(0, {twist[0], twist[1], twist[2]});
    for (int i = 1; i < 4; ++i) A.set_column(i, cross(alpha, X.column(i)) + cross(w, cross(w, X.column(i))));
    return A;
}

/// Along the directors as they are stated: tr(Lambda U^T Phi U) is tr(U Lambda U^T Phi).
Matrix3 as_stated(const Body& body, const std::array<double, 6>& six)
{
    const Matrix3 straight{six[0], six[3], six[4], six[3], six[1], six[5], six[4], six[5], six[2]};
    if (!is_skew(body)) return straight;
    const Matrix3 back = inverse(body.stretch);
    return back * straight * transpose(back);
}

/// On one side, with the joints that act there.
struct SideOfRigidity {
    explicit SideOfRigidity(std::size_t n) : multipliers(n), is_unique(n, true) {}

    std::vector<Matrix3> multipliers;
    std::vector<bool> is_unique;
    bool is_bounded = true;
};

/// All that the equations of motion say of an instant.
struct Balanced {
    Instant at;
    std::span<const Matrix34> X, V, A;
    std::span<const double> angles;
};

bool are_numbers(std::span<const double> multipliers)
{
    return std::ranges::none_of(multipliers, [](double x) { return std::isnan(x); });
}

/// Of one set of multipliers or more, with drives as they are at an instant.
UniqueReactions least_at(const Model& model, Instant at, const std::vector<Matrix34>& X,
                         std::span<const double> multipliers, std::span<const int> independent)
{
    if (!model.has_drives()) return least_reactions(model, X, multipliers, independent);
    return least_reactions(frozen(model, at), X, multipliers, independent);
}

SideOfRigidity rigidity_of(const Model& model, const RowTables& rows, const Balanced& b,
                           std::span<const double> multipliers, const std::vector<bool>& joint_is_unique)
{
    SideOfRigidity all(b.X.size());
    for (std::size_t j = 0; j < joint_is_unique.size(); ++j) {
        // A body on which a reaction is not unique has no unique stress either.
        if (joint_is_unique[j]) continue;
        for (const ConstraintRow& row : model.joints()[j].rows)
            for (const int body : row_bodies(row)) all.is_unique[static_cast<std::size_t>(body)] = false;
    }
    const std::vector<Matrix34> rest =
        forces_less_inertia(model, rows, b.at, b.X, b.V, b.A, multipliers, b.angles);
    for (std::size_t i = 0; i < b.X.size(); ++i)
        if (!model.bodies()[i].is_point)
            all.multipliers[i] = as_stated(model.bodies()[i], along_directors(rest[i], b.X[i]));
    return all;
}

SideOfRigidity unbounded(std::size_t n)
{
    SideOfRigidity none(n);
    none.is_bounded = false;
    return none;
}

/// By the equations of motion, solved in a state that need not be closed.
SideOfRigidity rigidity_on(const Model& model, const State& state, Side side)
{
    const std::size_t n = model.bodies().size(), s = side == Side::left ? 0 : 1;
    std::optional<WithRotors> rotors;
    if (model.has_rotors()) rotors.emplace(model);
    const Model& whole = rotors ? rotors->model() : model;
    std::optional<PreparedState> prepared;
    // Between nodes rows hold to the order of the interpolation only: the state is closed first.
    const TriedStart tried =
        try_consistent_start(whole, rotors ? rotors->with(state) : state, StartPolicy::project);
    if (tried.closed)
        prepared.emplace(whole, *tried.closed, side, false);   // else the joints allow none near
    if (!prepared || !prepared->is_fit || !are_numbers(prepared->state.multipliers[s])) return unbounded(n);
    const InstantState& at = prepared->state;
    std::vector<Matrix34> X(n), V(n), A(n);
    for (std::size_t b = 0; b < n; ++b) {
        std::copy_n(at.X.begin() + 12 * static_cast<std::ptrdiff_t>(b), 12, X[b].a);
        const auto& body = prepared->tables.bodies[b];
        double twist[6] = {}, rates[6] = {};
        std::copy_n(at.acceleration[s].begin() + body.first, body.dofs, twist);
        std::copy_n(at.velocity.begin() + body.first, body.dofs, rates);
        A[b] = acceleration(X[b], twist, rates);
        V[b] = rate(X[b], {rates[0], rates[1], rates[2]}, {rates[3], rates[4], rates[5]});
    }
    std::vector<double> multipliers = at.multipliers[s];
    multipliers.resize(static_cast<std::size_t>(model.n_rows()));
    std::vector<int> rows = at.held.rows;
    std::erase_if(rows, [&](int row) { return row >= model.n_rows(); });
    const UniqueReactions least = least_at(model, {state.t, side}, X, multipliers, rows);
    return rigidity_of(model, RowTables(model, false), {{state.t, side}, X, V, A, at.angles},
                       least.multipliers, least.joint_is_unique);
}

std::vector<RigiditySample> of_both_sides(const SideOfRigidity& left, const SideOfRigidity& right)
{
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<RigiditySample> samples;
    for (std::size_t b = 0; b < left.multipliers.size(); ++b) {
        RigiditySample& sample = samples.emplace_back();
        sample.left = left.multipliers[b];
        sample.right = right.multipliers[b];
        sample.is_unique = left.is_unique[b] && right.is_unique[b];
        sample.is_bounded = left.is_bounded && right.is_bounded;
        if (sample.is_bounded) continue;
        std::fill_n(sample.left.a, 9, nan);
        sample.right = sample.left;
    }
    return samples;
}

}   // namespace

Rigidity::Rigidity(const Model& model, const Motion& motion)
    : model_(model), motion_(motion), turns_(model, motion), independent_(all_rows(model)),
      rows_(std::make_shared<const RowTables>(model, false)), acting_(std::make_shared<ActingModels>(model))
{
    std::erase_if(independent_, [&](int row) {
        return std::ranges::find(motion.redundant_rows, row) != motion.redundant_rows.end();
    });
}

std::vector<RigiditySample> Rigidity::at(double t) const { return at_sample(sample_state(motion_, t)); }

std::vector<RigiditySample> Rigidity::at_sample(const State& state, const JointSampler* joints) const
{
    const int end = element_end_at(motion_.mesh, state.t);
    const bool is_held =
        !motion_.accelerations.empty() && (motion_.n_rows == 0 || !motion_.end_multipliers.empty());
    return end >= 0 && is_held && !model_.has_events() ? at_end(state, end, joints) : at(state);
}

std::vector<RigiditySample> Rigidity::at(const State& given) const
{
    constexpr double infinity = std::numeric_limits<double>::infinity();
    State state = given;
    state.angles = turns_.at(given);
    if (!model_.has_events())
        return of_both_sides(rigidity_on(model_, state, Side::left), rigidity_on(model_, state, Side::right));
    // On the left act the joints of the instant just before, on the right those of the instant itself.
    const std::shared_ptr<const ActingModel> before = acting_->at(std::nextafter(state.t, -infinity)),
                                             after = acting_->at(state.t);
    return of_both_sides(rigidity_on(before->model, state, Side::left),
                         rigidity_on(after->model, state, Side::right));
}

std::vector<RigiditySample> Rigidity::at_end(const State& state, int end, const JointSampler* joints) const
{
    const std::vector<double> angles = turns_.at_end(end);
    const std::size_t n = static_cast<std::size_t>(motion_.n_bodies),
                      n_rows = static_cast<std::size_t>(motion_.n_rows);
    const std::span<const double> both =
        std::span(motion_.end_multipliers).subspan(2 * static_cast<std::size_t>(end) * n_rows, 2 * n_rows);
    // Both sides of an instant have the same rows, so one decomposition serves both sets of multipliers.
    const bool is_redundant = static_cast<int>(independent_.size()) < model_.n_rows(),
               is_shared = !model_.has_drives() && are_numbers(both);   // rows that do not move
    UniqueReactions own;
    const UniqueReactions* least = nullptr;
    if (is_redundant && is_shared && joints != nullptr) least = joints->least_at(state, end);
    if (is_redundant && is_shared && least == nullptr) {
        own = least_at(model_, {state.t}, state.X, both, independent_);
        least = &own;
    }
    const std::span<const Matrix34> A[] = {accelerations_at(end, 0, n), accelerations_at(end, 1, n)};
    const auto side = [&](std::size_t s) {
        const Balanced b{{state.t, s == 0 ? Side::left : Side::right}, state.X, state.V, A[s], angles};
        const std::span<const double> multipliers = both.subspan(s * n_rows, n_rows);
        if (!are_numbers(multipliers)) return unbounded(n);
        if (!is_redundant) return rigidity_of(model_, *rows_, b, multipliers, {});
        if (is_shared)
            return rigidity_of(model_, *rows_, b, std::span(least->multipliers).subspan(s * n_rows, n_rows),
                               least->joint_is_unique);
        const UniqueReactions of_side = least_at(model_, b.at, state.X, multipliers, independent_);
        return rigidity_of(model_, *rows_, b, of_side.multipliers, of_side.joint_is_unique);
    };
    const SideOfRigidity left = side(0);
    // Without loads and drives what is the same on both sides has one stress.
    const bool is_same = is_shared && model_.loads().empty() && std::ranges::equal(A[0], A[1]) &&
                         std::ranges::equal(both.first(n_rows), both.last(n_rows));
    return of_both_sides(left, is_same ? left : side(1));
}

/// X'' of all bodies on a side of an element end.
std::span<const Matrix34> Rigidity::accelerations_at(int end, std::size_t side, std::size_t n) const
{
    return std::span(motion_.accelerations).subspan((2 * static_cast<std::size_t>(end) + side) * n, n);
}

}   // namespace livens
