// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/nodal/window.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "livens/base/text.h"
#include "livens/diagnostics/largest.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/body.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/march/pace.h"
#include "livens/spacetime/nodal/elimination.h"

namespace livens {

namespace {

/// Of the largest pivot in an element: below, reactions at its end have no digit left (docs/theory.md,
/// "Singular positions").
constexpr double least_for_reactions = 1e-4;

}   // namespace

LobattoWindow::LobattoWindow(const Tables& tables, const TimeMesh& mesh, const Ends& ends,
                             const ElementRule& rule)
    : Window(static_cast<ElementMonitor&>(*this)), tables_(tables), ends_(ends), system_(tables, rule),
      series_(tables, system_.rule()), kernel_(tables, system_.rule()),
      instant_(tables, kernel_.serves() && ends.has_state()), record_(tables, mesh, system_.rule()),
      front_(tables), breaks_{tables.model->load_breaks(), Bends(tables, rule), {}, {}}, rank_{Branches(
                                                                                             tables,
                                                                                             system_.rule())}
{
    if (!std::ranges::all_of(tables.model->loads(), &Load::is_smooth))
        breaks_.inside.emplace(tables, system_.rule());
    record_.note_redundant(ends.redundant);
    work_.lambda.assign(tables.rows.size(), 0.0);
    work_.end_lambda = work_.lambda;
    work_.impulse.assign(static_cast<std::size_t>(tables.rank), 0.0);
    work_.momentum.assign(static_cast<std::size_t>(tables.n_twists), 0.0);
    work_.wrench = work_.momentum;
    work_.raw.assign(12 * tables.bodies.size(), 0.0);
}

bool LobattoWindow::is_jump(double t) const { return std::ranges::binary_search(breaks_.jumps, t); }

/// The mesh's number of the stretch's element end.
int LobattoWindow::mesh_end(int end) const { return ends_.is_backwards() ? last_ - end : first_ + end; }

void LobattoWindow::restart()
{
    record_.begin_anew();
    if (ends_.start.t != front_.here().t) front_.here().forget_past();
    front_.is_ready = false;
}

bool LobattoWindow::open(int first, int last, SolveReport& report)
{
    first_ = first;
    last_ = last;
    stretch_.degree = system_.rule().degree;
    stretch_.points = system_.rule().points;
    stretch_.times.resize(static_cast<std::size_t>(last - first) + 1);
    for (int e = 0; e <= last - first; ++e) stretch_.times[e] = record_.mesh().ends[mesh_end(e)];
    if (!ends_.has_state()) {
        stretch_.X_first = knows_positions(ends_.at_start);
        stretch_.P_first = knows_momenta(ends_.at_start);
        stretch_.X_last = knows_positions(ends_.at_end);
        stretch_.P_last = knows_momenta(ends_.at_end);
    }
    if (!front_.is_ready && !begin_front(report)) return false;
    if (stretch_.X_last && !set_state(far_, ends_.end, report)) return false;
    stretch_.angles = stretch_.X_first ? front_.here().angles : tables_.loads.turns.begin();
    system_.open(stretch_, stretch_.X_first ? &front_.here() : nullptr, stretch_.X_last ? &far_ : nullptr);
    if (!stretch_.X_first && stretch_.P_first)
        set_momenta(ends_.start, system_.balances().end_momentum(false).about_reference);
    if (stretch_.P_last) set_momenta(ends_.end, system_.balances().end_momentum(true).about_reference);
    return true;
}

/// Six numbers a body, about its reference point.
void LobattoWindow::set_momenta(const State& given, std::vector<double>& momenta) const
{
    std::vector<double>& P = momenta;
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const Matrix34 of_body = given.V[b] * tables_.model->bodies()[b].mass;
        double six[6];
        twist::rows(given.X[b].a, of_body.a, six);
        std::copy_n(six, tables_.bodies[b].dofs, P.begin() + tables_.bodies[b].first);
    }
}

/// X, twists and the constraint basis of a state in which the mechanism is closed.
bool LobattoWindow::set_state(InstantState& state, const State& given, SolveReport& report)
{
    state.t = given.t;
    if (state.X.empty()) state.resize(tables_);
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        std::copy_n(given.X[b].a, 12, state.X.begin() + 12 * b);
        const auto& body = tables_.bodies[b];
        const Vector3 v = given.V[b].column(0);
        const Vector3 w = body.dofs == 6 ? angular_velocity(given.X[b], given.V[b]) : Vector3{};
        for (int i = 0; i < body.dofs; ++i) state.velocity[body.first + i] = i < 3 ? v[i] : w[i - 3];
    }
    state.angles = tables_.loads.turns.begin(given);
    tables_.loads.turns.follow(Configurations(state.X.data()), state.angles);
    if (!instant_.prepare(state, tables_.independent))
        return fail(report,
                    "the mass matrix on the free motions is singular at t = " + to_text(state.t, 6) + " s");
    instant_.from_velocity(state);
    return true;
}

/// The state at the near end, as far as it is known.
bool LobattoWindow::begin_front(SolveReport& report)
{
    const State& given = ends_.is_backwards() ? ends_.end : ends_.start;
    if (!knows_positions(ends_.is_backwards() ? ends_.at_end : ends_.at_start)) return true;
    if (!set_state(front_.here(), given, report)) return false;
    if (!ends_.has_state()) return true;
    front_.is_ready = true;
    accelerate(front_.here());
    record_.end(mesh_end(0), front_.here(), instant_, is_jump(given.t));
    return true;
}

bool LobattoWindow::fail(SolveReport& report, const std::string& message) const
{
    report.status = SolveStatus::singular;
    report.message = message;
    return false;
}

bool LobattoWindow::solve(const NewtonOptions& options, bool soon, NewtonReport& report)
{
    if (!kernel_.serves() || !stretch_.is_march() || stretch_.n_elements() > 1 ||
        !kernel_.solve(stretch_, front_.here(), options, soon, report))
        return false;
    for (int B = 0; B <= stretch_.degree; ++B) {
        if (B < stretch_.degree) kernel_.impulses(B, system_.balances().own_impulses(B));
        system_.nodes().set_pivot(B, kernel_.pivot(B));
    }
    system_.nodes().place_solved(kernel_.increments(), kernel_.width());
    system_.balances().count_turns(stretch_, system_.nodes());
    return true;
}

/// Blocks Z_A^T J Z_B take some p^2 n f^2 operations, and the factor (p f)^3: of p n f f times what an
/// element of p n f takes, measured on chains of 10 to 100 bodies.
double LobattoWindow::tangent_cost() const
{
    constexpr double measured = 1e-2;
    const bool is_known = kernel_.serves() && stretch_.is_march() && front_.here().held.by_joints;
    return is_known ? measured * stretch_.degree * std::pow(tables_.freedoms(), 2) : 0;
}

void LobattoWindow::begin_newton()
{
    kernel_.forget();
    if (stretch_.X_first) instant_.add_basis(front_.here());
}

bool LobattoWindow::start_by_series()
{
    if (!stretch_.is_march() || stretch_.n_elements() > 1) return false;
    begin_newton();
    series_.place(system_, front_.here());
    return system_.settle();
}

bool LobattoWindow::start_from(const Guess& guess)
{
    if (!guess) return start_by_series();
    begin_newton();
    const ElementRule& rule = system_.rule();
    std::vector<double> X(12 * tables_.bodies.size());
    for (int A = 0; A < stretch_.n_nodes(); ++A) {
        if (!stretch_.is_unknown(A)) continue;
        Patience::ask();
        const State state = guess(stretch_.time(rule, A));
        for (std::size_t b = 0; b < state.X.size(); ++b) {
            const Matrix34 rigid =
                tables_.bodies[b].dofs == 3
                    ? state.X[b]
                    : configuration(state.X[b].column(0), project_directors(directors(state.X[b])));
            std::copy_n(rigid.a, 12, X.begin() + static_cast<std::ptrdiff_t>(12 * b));
        }
        system_.nodes().place_at(A, X.data());
    }
    return system_.settle();
}

State LobattoWindow::at(int element_end) const
{
    State state;
    state.X.resize(tables_.bodies.size());
    const int end = ends_.is_backwards() ? last_ - element_end : element_end - first_;
    if (end > 0 || !front_.is_ready) {
        const double* X = system_.nodes().X(end * stretch_.degree);
        for (std::size_t b = 0; b < state.X.size(); ++b) std::copy_n(X + 12 * b, 12, state.X[b].a);
        return state;
    }
    const InstantState& here = front_.here();
    std::vector<double> V(here.X.size());
    tables_.bodies.rates_of(here.X.data(), here.velocity.data(), V.data());
    state.t = here.t;
    state.angles = here.angles;
    state.V.resize(tables_.bodies.size());
    for (std::size_t b = 0; b < state.X.size(); ++b) {
        std::copy_n(here.X.data() + 12 * b, 12, state.X[b].a);
        std::copy_n(V.data() + 12 * b, 12, state.V[b].a);
    }
    return state;
}

/// Both sides of an instant where loads jump, else one for both.
void LobattoWindow::accelerate(InstantState& state)
{
    instant_.accelerate(state, Side::right);
    if (is_jump(state.t)) {
        instant_.accelerate(state, Side::left);
    } else {
        state.acceleration[0] = state.acceleration[1];
        state.multipliers[0] = state.multipliers[1];
    }
}

/// The state at the first node, where only the solution told it, and the multipliers that are left there when
/// its momentum is tangent to the constraints.
bool LobattoWindow::find_first_state(SolveReport& report)
{
    InstantState& here = front_.here();
    const double weight = stretch_.weight(system_.rule(), 0);
    here.t = stretch_.times[0];
    if (!stretch_.X_first) {
        here.angles = tables_.loads.turns.begin();
        tables_.loads.turns.follow(Configurations(system_.nodes().X(0)), here.angles);
        std::copy_n(system_.nodes().X(0), here.X.size(), here.X.begin());
        std::copy_n(system_.nodes().low(0), here.X.size(), here.X_low.begin());
        if (!instant_.prepare(here, tables_.independent))
            return fail(report, "the free motions carry no inertia at t = " + to_text(here.t, 6) + " s");
    }
    std::vector<double>& p = work_.momentum;
    if (stretch_.P_first) {
        p = system_.balances().end_momentum(false).about_reference;
        for (int b = 0; b < tables_.n_bodies(); ++b)
            if (tables_.bodies[b].dofs == 6)
                BodyTables::to_centre(here.maps.data() + 12 * b, p.data() + tables_.bodies[b].first);
    } else {
        system_.balances().twist_row(stretch_, system_.nodes(), 0, p.data());
        for (double& value : p) value = -value;
    }
    instant_.from_momentum(here, p.data(), weight, work_.lambda.data());
    for (int c = 0; c < tables_.rank; ++c) {
        const double taken = weight * work_.lambda[here.held.rows[c]];
        work_.impulse[c] = (stretch_.P_first ? system_.balances().impulses(0)[c] : 0.0) - taken;
    }
    accelerate(here);
    record_.end(mesh_end(0), here, instant_, is_jump(here.t));
    return true;
}

Closed LobattoWindow::close(const Trust& trust, SolveReport& report)
{
    if (stretch_.is_march())
        std::copy_n(system_.balances().impulses(0), tables_.rank, work_.impulse.begin());
    else if (!find_first_state(report))
        return {};
    const bool is_watched = trust.turns || !std::isinf(trust.velocity_jump);
    Closed closed;
    for (int e = 0; e < stretch_.n_elements(); ++e) {
        closed.loss = trust.full_rank ? rank_loss(e) : RankLoss::none;
        closed.is_refused = closed.loss != RankLoss::none;
        if (closed.is_refused) return closed;
        if (!end_element(e, report)) return closed;
        closed.contradiction = contradiction(front_.next());
        if (!closed.contradiction.empty()) {
            closed.velocity_jump = std::numeric_limits<double>::infinity();
            closed.is_refused = stretch_.is_march() || fail(report, closed.contradiction);
            return closed;
        }
        if (is_watched) closed.velocity_jump = velocity_jump(e, trust.turns);
        if (is_watched && !kernel_.has_followed() &&
            rank_.branches.leaves(stretch_, system_.nodes(), front_.here().held.rows, e))
            closed.velocity_jump = std::numeric_limits<double>::infinity();
        Unseen unseen = look_at_laws(e, closed);
        closed.is_refused = !(closed.velocity_jump <= trust.velocity_jump);
        if (closed.is_refused) return closed;
        if (unseen.load >= 0) breaks_.unseen.push_back(std::move(unseen));
        close_element(e);
        ++closed.n_elements;
        for (int A = e * system_.rule().degree; A <= (e + 1) * system_.rule().degree; ++A)
            rank_.smallest_pivot = std::min(rank_.smallest_pivot, system_.nodes().pivot(A));
    }
    front_.is_ready = true;
    return closed;
}

/// What a law did unseen counts as the velocity jump that goes with such an error.
Unseen LobattoWindow::look_at_laws(int e, Closed& closed)
{
    if (!breaks_.inside) return {};
    Unseen unseen =
        breaks_.inside->look(stretch_, system_.nodes(), e, front_.here().angles, instant_, front_.next());
    if (!(unseen.error > 0)) return unseen;
    const double jump = velocity_jump_of(stretch_.points, stretch_.degree, unseen.error);
    if (raise_to(closed.velocity_jump, jump))
        closed.load = tables_.model->loads()[static_cast<std::size_t>(unseen.load)].name;
    return unseen;
}

/// The nodes and multipliers of a believed element into the motion, its end as the start of the next.
void LobattoWindow::close_element(int e)
{
    const int p = system_.rule().degree, A = (e + 1) * p;
    const double weight = stretch_.h(e) * system_.rule().weights[p];
    InstantState &here = front_.here(), &next = front_.next();
    record_element(e);
    if (e + 1 < stretch_.n_elements())   // the shared node's other side
        for (int c = 0; c < tables_.rank; ++c)
            work_.impulse[c] =
                system_.balances().impulses(A)[c] - weight * work_.end_lambda[system_.nodes().rows()[c]];
    if (is_jump(next.t))
        next.forget_past();
    else
        next.look_back(here, stretch_.h(e) > 0);
    front_.now = 1 - front_.now;
    record_.end(mesh_end(e + 1), front_.here(), instant_, is_jump(next.t));
    if (rank_left(e, p, p) < least_for_reactions)
        record_.forget_reactions(mesh_end(e + 1), instant_.weak_rows(front_.here()));
}

void LobattoWindow::record_element(int e)
{
    const ElementRule& rule = system_.rule();
    const int p = rule.degree;
    const bool back = ends_.is_backwards();
    const int element = std::min(mesh_end(e), mesh_end(e + 1));
    const int without = is_radau() ? 0 : p;   // as above
    for (int a = 0; a <= p; ++a) {
        const int A = e * p + a, place = back ? p - a : a;
        if (a > 0 && a < p) record_.node(element, place, system_.nodes().X(A));
        if (a == without) {   // at the start of radau what the equations of motion ask for
            record_.multipliers(element, place,
                                (a == p ? work_.end_lambda : front_.here().multipliers[1]).data());
            continue;
        }
        const double* impulses = a == 0 ? work_.impulse.data() : system_.balances().impulses(A);
        const std::vector<int>& rows = system_.nodes().rows();
        if (a == p)
            work_.lambda = work_.end_lambda;
        else if (tables_.rank < tables_.n_rows())
            std::fill(work_.lambda.begin(), work_.lambda.end(), 0.0);
        const double weight = stretch_.h(e) * rule.weights[a];
        const int* row = rows.data();
        double* lambda = work_.lambda.data();
        for (int c = 0, n = tables_.rank; c < n; ++c) {
            const double own = impulses[c] / weight;
            lambda[row[c]] = a == p ? lambda[row[c]] + own : own;
        }
        record_.multipliers(element, place, work_.lambda.data());
    }
}

}   // namespace livens
