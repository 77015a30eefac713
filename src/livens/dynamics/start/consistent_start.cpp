// SPDX-License-Identifier: BSD-3-Clause
// Consistent initial conditions: directors, positions, branches, rank, inertia and velocities of a start, in
// this order, as each step takes the ones before for granted. theory.md, "Starting".
#include "livens/dynamics/start/consistent_start.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "livens/base/elementary.h"
#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/dynamics/rows/projection.h"
#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/reach.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/start/laws_at_start.h"
#include "livens/dynamics/start/rate_changes.h"
#include "livens/dynamics/start/start_speeds.h"
#include "livens/multibody/rotors.h"
#include "livens/multibody/wording.h"

namespace livens {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double start_tolerance = 1e-9;
constexpr const char* project_help = "correct it, or let the start be projected onto the joints";

std::string number(double x) { return to_text(x, 3); }

std::string joint_path(const Model& model, int row)
{
    return "joint[" + model.joints()[model.row_joint(row)].name + "]";
}

/// Why a start is refused; none: it is in order.
using Fault = std::optional<Complaint>;

/// Columns of point masses that must be zero are zero from here on; numbers are numbers.
Fault clean(const Model& model, State& state)
{
    const std::size_t n = model.bodies().size();
    if (state.X.size() != n || state.V.size() != n) {
        return Complaint{"start-position",
                         "start",
                         "the start does not have one X and one V for every body",
                         std::to_string(state.X.size()) + " and " + std::to_string(state.V.size()),
                         std::to_string(n),
                         "",
                         "begin with Model::start()"};
    }
    for (int b = 0; b < model.n_bodies(); ++b) {
        const std::string path = "body[" + model.body_name(b) + "]";
        for (const auto& [m, code] :
             {std::pair{&state.X[b], "start-position"}, {&state.V[b], "start-velocity"}}) {
            if (!all_finite(*m))
                return Complaint{code, path, "the start is not finite", "", "finite numbers", "", ""};
            if (model.bodies()[b].is_point) *m = configuration(m->column(0), Matrix3{});
        }
    }
    return {};
}

// --- rigidity

struct Worst {
    double value = 0;   ///< signed
    std::string name;   ///< "d2.d3"
};

/// The largest entry of 1/2 (A^T B + B^T A - target), A and B being directors or their rates.
Worst worst_product(const Matrix3& A, const Matrix3& B, double target)
{
    static constexpr const char* names[3][3] = {
        {"d1.d1", "d1.d2", "d1.d3"}, {"", "d2.d2", "d2.d3"}, {"", "", "d3.d3"}};
    const Matrix3 products = transpose(A) * B;
    Worst worst;
    for (int i = 0; i < 3; ++i) {
        for (int j = i; j < 3; ++j) {
            const double value = 0.5 * (products(i, j) + products(j, i)) - (i == j ? target : 0);
            if (std::abs(value) > std::abs(worst.value)) worst = {value, names[i][j]};
        }
    }
    return worst;
}

/// Directors orthonormal to rounding. Small violations leave by D <- D (3 I - D^T D) / 2, which keeps exact
/// zeros.
Fault settle_directors(const Model& model, StartPolicy policy, State& state, std::vector<std::string>& notes)
{
    for (int b = 0; b < model.n_bodies(); ++b) {
        if (model.bodies()[b].is_point) continue;
        Matrix3 D = directors(state.X[b]);
        const Worst worst = worst_product(D, D, 1);
        if (std::abs(worst.value) <= 4 * epsilon && determinant(D) > 0) continue;
        const std::string path = "body[" + model.body_name(b) + "].directors";
        if (determinant(D) <= 0) {
            return Complaint{"start-position",
                             path,
                             "the directors are not a right-handed triad",
                             "determinant " + number(determinant(D)),
                             "1",
                             "d1 x d2 = d3",
                             "change the sign of one director"};
        }
        if (std::abs(worst.value) > start_tolerance) {
            if (policy == StartPolicy::check) {
                return Complaint{"start-position",
                                 path,
                                 "the directors are not orthonormal: " + worst.name + " is wrong",
                                 number(worst.value),
                                 number(start_tolerance),
                                 "",
                                 project_help};
            }
            D = project_directors(D);
            notes.push_back("the directors of body '" + model.body_name(b) + "' were made orthonormal (" +
                            worst.name + " was wrong by " + number(std::abs(worst.value)) + ")");
        }
        for (int pass = 0; pass < 3 && std::abs(worst_product(D, D, 1).value) > 4 * epsilon; ++pass) {
            D = 0.5 * (D * (3.0 * identity<3>() - transpose(D) * D));
        }
        state.X[b] = configuration(state.X[b].column(0), D);
    }
    return {};
}

// --- positions

void note_moves(const Model& model, std::span<const Matrix34> before, std::span<const Matrix34> after,
                std::vector<std::string>& notes)
{
    const double length = model.length();
    for (int b = 0; b < model.n_bodies(); ++b) {
        if (!model.bodies()[b].is_matter()) continue;
        const double shift = norm(after[b].column(0) - before[b].column(0));
        double turn = 0;
        for (int i = 1; i < 4; ++i) turn = std::max(turn, norm(after[b].column(i) - before[b].column(i)));
        if (shift <= start_tolerance * length && turn <= start_tolerance) continue;
        notes.push_back("the start of body '" + model.body_name(b) + "' was moved by " + number(shift) +
                        " m and turned by " + number(2 * arc_sine(std::min(1.0, 0.5 * turn))) +
                        " rad to close the joints");
    }
}

Fault settle_positions(const Model& model, StartPolicy policy, State& state, std::vector<std::string>& notes)
{
    const Gap gap = widest_gap(model, state.X, all_rows(model));
    const bool projects = policy == StartPolicy::project;
    if (gap.level <= 1 && !(projects && drives_are_turned(model, state.X))) return {};
    const bool is_open = !gap.near || gap.level <= 1;
    Closing closing = close_rows(model, state.X, all_rows(model), is_open);
    const bool is_other = projects && closing.closed && !is_in_its_branch(model, closing.X);
    if (is_open && (!closing.closed || is_other)) {
        Reach other = reach(model, state.X);
        if (!other.closing.closed && !closing.closed) return why_open(model, closing, state.X, other.n_tries);
        if (other.closing.closed) closing = std::move(other.closing);
        if (projects && !other.how.empty()) notes.push_back(other.how);
    }
    if (!gap.near && !projects) {
        return Complaint{"start-position",
                         joint_path(model, gap.row),
                         model.row_name(gap.row) + " is open at the start" +
                             drive_words(model, gap.row, state.X),
                         "violation " + number(gap.violation),
                         number(start_tolerance),
                         "",
                         drive_help(model, gap.row, state.X) + project_help};
    }
    note_moves(model, state.X, closing.X, notes);
    for (int b = 0; b < model.n_bodies(); ++b) {
        if (closing.X[b] == state.X[b]) continue;
        // Rates were given at the old directors; the angular velocity in world axes is what is kept.
        const Matrix34& X = state.X[b];
        const Matrix34& V = state.V[b];
        const bool rigid =
            std::abs(worst_product(directors(X), directors(V), 0).value) <= start_tolerance * norm(V);
        if (rigid && !model.bodies()[b].is_point) {
            state.V[b] = rate(closing.X[b], V.column(0), angular_velocity(X, V));
        }
        state.X[b] = closing.X[b];
    }
    return {};
}

// --- velocities

/// Largest inconsistency relative to what the largest speed can make; names what it is.
struct RateGap {
    double relative = 0;
    Complaint complaint;
};

/// `drives`: drive_rates(). The bound is of G V alone: a drive that is slower than bodies move does not
/// matter, and one that is faster is a fault.
RateGap worst_rate(const Model& model, const State& state, const RowWrenches& wrenches,
                   std::span<const Vector3> centers, std::span<const double> drives, double speed)
{
    RateGap fault;
    const double length = model.length();
    for (int b = 0; b < model.n_bodies(); ++b) {
        if (model.bodies()[b].is_point) continue;
        const Worst worst = worst_product(directors(state.X[b]), directors(state.V[b]), 0);
        const double relative = speed > 0 ? std::abs(worst.value) * length / speed : 0;
        if (relative <= fault.relative) continue;
        fault.relative = relative;
        const std::string name = model.body_name(b);
        fault.complaint = {"start-velocity",
                           "body[" + name + "].director_rates",
                           "the rates of the directors of body '" + name + "' break its rigidity in " +
                               worst.name,
                           "d(" + worst.name + ")/dt = " + number(2 * worst.value) + " 1/s",
                           "",
                           "",
                           project_help};
    }
    const std::vector<double> rates = joint_rates(model, state.X, state.V);
    const bool rests = std::ranges::all_of(state.V, [](const Matrix34& V) { return V == Matrix34{}; });
    for (int r = 0; r < model.n_rows(); ++r) {
        const double bound = rate_bound(state, wrenches[r], centers, speed, length);
        const double rate = rates[r] + drives[r];
        const double relative = bound > 0 ? std::abs(rate) / bound : drives[r] != 0 ? 1 : 0;
        if (relative <= fault.relative) continue;
        fault.relative = relative;
        fault.complaint = {"start-velocity",
                           joint_path(model, r),
                           std::string("the initial velocities") + (rests ? ", all zero," : "") +
                               " violate " + model.row_name(r),
                           "dPhi/dt = " + number(rate),
                           "",
                           "",
                           project_help};
    }
    fault.complaint.bound = number(start_tolerance) + " of the largest speed";
    return fault;
}

/// `model`: of positions, frozen; `the_model`: with its drives.
Fault settle_velocities(const Model& model, const Model& the_model, StartPolicy policy,
                        const RowWrenches& wrenches, std::span<const int> independent,
                        std::span<const double> drives, State& state, std::vector<std::string>& notes)
{
    const std::vector<Vector3> centers = centers_of_mass(model);
    const double stated = largest_speed(model, state, centers),
                 speed = std::max(stated, speed_by_weight(model));
    const bool is_driven = std::ranges::any_of(drives, [](double rate) { return rate != 0; });
    if (stated == 0 && !is_driven) return {};
    RateGap fault = worst_rate(model, state, wrenches, centers, drives, speed);
    if (fault.relative <= 8 * epsilon) return {};
    if (fault.relative > start_tolerance) {
        // Rates that are zero but for rounding were computed from something; they are held against what moves
        // soon.
        const double least = speed_of_rounding(the_model, state, wrenches, centers);
        if (least > speed) fault = worst_rate(model, state, wrenches, centers, drives, least);
    }
    if (fault.relative > start_tolerance && policy == StartPolicy::check) return fault.complaint;
    const std::vector<Matrix34> before = state.V;
    state.V = nearest_rates(model, state.X, state.V, independent, drives);
    if (fault.relative <= start_tolerance) return {};
    RateGap left = worst_rate(model, state, wrenches, centers, drives,
                              std::max(largest_speed(model, state, centers), speed));
    if (left.relative > start_tolerance) {   // of a row that is redundant
        left.complaint.code = "joint-contradiction";
        left.complaint.message += ", whatever they are: the other joints and drives want another rate";
        left.complaint.help = "make the laws of the drives agree, or leave one of them out";
        return left.complaint;
    }
    const std::string changes = rate_changes(model, state.X, before, state.V);
    notes.push_back(fault.complaint.message + " (" + fault.complaint.value +
                    "); they were projected onto the joints" + (changes.empty() ? "" : ": " + changes));
    return {};
}

// --- inertia

Fault why_weightless(const Model& model, std::span<const Matrix34> X)
{
    const std::optional<WeightlessSpin> spin = weightless_spin(model, X);
    if (!spin) return {};
    Vector3 axis = spin->axis;
    for (double& a : axis.a) a = std::abs(a) < 1e-9 ? 0.0 : a;
    const std::string name = model.body_name(spin->body);
    return Complaint{
        "spin-without-inertia",
        "body[" + name + "].inertia",
        "body '" + name + "' can spin about an axis without inertia, and no joint holds this spin",
        "axis (" + number(axis[0]) + ", " + number(axis[1]) + ", " + number(axis[2]) + ") in the world",
        "",
        spin->by_digits ? "the reference point is so far from the centre of mass that the mass matrix holds "
                          "no digit of this inertia"
                        : "its motion has no equation",
        spin->by_digits ? "choose a reference point near the body"
                        : "give the body inertia about this axis, hold the spin by a joint, or use a point "
                          "mass"};
}

/// One sentence a joint on its redundant rows, which ascend.
void note_redundancy(const Model& model, ConsistentStart& assembly)
{
    for (std::size_t i = 0; i < assembly.redundant.size();) {
        const int joint = model.row_joint(assembly.redundant[i]);
        const std::size_t n_rows = model.joints()[joint].rows.size();
        std::string rows;
        std::size_t count = 0;
        for (; i < assembly.redundant.size() && model.row_joint(assembly.redundant[i]) == joint; ++i, ++count)
            rows += (count == 0 ? "" : ", ") + model.row(assembly.redundant[i]).label;
        assembly.notes.push_back("joint '" + model.joints()[joint].name + "' is " +
                                 (count == n_rows ? "redundant (all of its " : "partly redundant (") +
                                 (count == n_rows ? "" : std::to_string(count) + " of ") +
                                 std::to_string(n_rows) + " constraint" + (n_rows == 1 ? "" : "s") + ": " +
                                 rows + "): reactions in this loop are not unique");
    }
}

}   // namespace

namespace {

/// Rotors move along with what they are bound to, and count where something is moved.
TriedStart try_with_rotors(const Model& model, const State& start, StartPolicy policy)
{
    const WithRotors rotors(model);
    TriedStart tried = try_consistent_start(rotors.model(), rotors.with(start), policy);
    if (!tried.closed) return tried;
    rotors.take_off(tried.closed->start);
    for (auto* rows : {&tried.closed->independent, &tried.closed->redundant})
        std::erase_if(*rows, [&](int row) { return row >= rotors.n_rows(); });
    return tried;
}

}   // namespace

TriedStart try_consistent_start(const Model& the_model, const State& start, StartPolicy policy)
{
    const std::size_t n = the_model.bodies().size();
    if (the_model.has_rotors() && start.X.size() == n && start.V.size() == n)
        return try_with_rotors(the_model, start, policy);
    ConsistentStart closed;
    closed.start = start;
    std::optional<Model> now;
    if (the_model.has_drives()) now = frozen(the_model, {start.t});
    const Model& model = now ? *now : the_model;
    Fault fault = clean(model, closed.start);
    if (!fault) fault = settle_directors(model, policy, closed.start, closed.notes);
    if (!fault) fault = why_without_law(model, closed.start.X);
    if (!fault) fault = settle_positions(model, policy, closed.start, closed.notes);
    if (!fault) fault = why_in_other_branch(model, closed.start.X);
    if (fault) return {{}, std::move(*fault)};

    const std::vector<int> rows = all_rows(model);
    const RowWrenches wrenches = row_wrenches(model, closed.start.X);
    const RowRank rank = row_rank(twist_rows(model, closed.start.X, rows, wrenches), model.n_bodies(), rows);
    // After rank: a spin without inertia is no fault where a joint holds it.
    fault = why_weightless(model, closed.start.X);
    if (fault) return {{}, std::move(*fault)};
    closed.independent = rank.independent;
    for (const Body& body : model.bodies())
        if (!body.holds_states()) closed.degrees_of_freedom += body.is_point ? 3 : 6;
    closed.degrees_of_freedom -= static_cast<int>(rank.independent.size());
    closed.redundant = rank.dependent;
    note_redundancy(model, closed);
    if (rank.smallest_pivot < 1e-6)
        closed.notes.push_back("the joints are close to a singular configuration at the start (pivot " +
                               number(rank.smallest_pivot) + ")");
    const std::vector<double> drives = drive_rates(the_model, {start.t}, closed.start.X);
    fault = settle_velocities(model, the_model, policy, wrenches, closed.independent, drives, closed.start,
                              closed.notes);
    if (fault) return {{}, std::move(*fault)};
    return {std::move(closed), {}};
}

ConsistentStart consistent_start(const Model& model, const State& start, StartPolicy policy)
{
    TriedStart tried = try_consistent_start(model, start, policy);
    if (!tried.closed) throw InputError(std::move(tried.why));
    return std::move(*tried.closed);
}

}   // namespace livens
