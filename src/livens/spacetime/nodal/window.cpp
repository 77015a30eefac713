// SPDX-License-Identifier: BSD-3-Clause
// A window of lobatto(p) or radau(p): its known states and nodes, initial guesses of its elements, and what
// is told of them (docs/theory.md, "Windows").
#include "livens/spacetime/nodal/window.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/base/text.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/body.h"
#include "livens/multibody/model.h"
#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"
#include "livens/spacetime/nodal/elimination.h"

namespace livens {

NodalWindow::NodalWindow(const ModelTables& tables, const TimeMesh& mesh, const Ends& ends,
                         const ElementRule& rule)
    : BorderedWindow(static_cast<ElementMonitor&>(*this)), tables_(tables), ends_(ends),
      conditions_(ends.has_components() ? std::make_unique<EndConditions>(tables, ends) : nullptr),
      system_(tables, rule), series_(tables, system_.rule()), kernel_(tables, system_.rule()),
      end_(tables, is_sparse()), checks_(tables, system_.rule()), record_(tables, mesh, system_.rule())
{
    record_.note_redundant(ends.redundant);
    if (conditions_ != nullptr) system_.close_with(*conditions_);
}

void NodalWindow::border_with(std::function<DenseMatrix(Formed)> columns)
{
    system_.conditions()->border_with([columns = std::move(columns)](Elimination& formed) {
        Elimination* const only = &formed;
        return columns({&only, 1});
    });
}

bool NodalWindow::adopt(const BorderedWindow& other, bool is_pulled)
{
    return system_.adopt(static_cast<const NodalWindow&>(other).system_, is_pulled);
}

void NodalWindow::solve_for(const BorderedWindow& other, std::span<double> dx)
{
    system_.solve_for(static_cast<const NodalWindow&>(other).system_, dx);
}

/// The mesh's number of the stretch's element end.
int NodalWindow::mesh_end(int end) const { return ends_.is_backwards() ? last_ - end : first_ + end; }

void NodalWindow::be_part(ChainEnds& ends, const WindowLayout::Part& part)
{
    layout_.part = part;
    system_.conditions()->be_part(ends, part.n_joins);
}

void NodalWindow::restart()
{
    record_.begin_anew();
    if (ends_.start.t != end_.here().t) end_.here().forget_past();
    is_ready_ = false;
}

bool NodalWindow::open(int first, int last, SolveReport& report)
{
    first_ = first;
    last_ = last;
    layout_.degree = system_.rule().degree;
    layout_.points = system_.rule().points;
    layout_.times.resize(static_cast<std::size_t>(last - first) + 1);
    for (int e = 0; e <= last - first; ++e) layout_.times[e] = record_.mesh().ends[mesh_end(e)];
    if (!ends_.has_state()) {
        layout_.X_first = knows_positions(ends_.at_start);
        layout_.P_first = knows_momenta(ends_.at_start);
        layout_.X_last = knows_positions(ends_.at_end);
        layout_.P_last = knows_momenta(ends_.at_end);
    }
    if (ends_.has_components()) layout_.P_first = layout_.P_last = layout_.are_momenta_unknown = true;
    layout_.n_numbers = ends_.n_numbers;
    if (!is_ready_ && !begin_front(report)) return false;
    if (layout_.X_last && !set_state(far_, ends_.end, report)) return false;
    if (!tables_.loads.turns.empty())
        layout_.angles = layout_.X_first    ? end_.here().angles
                         : ends_.is_phase() ? tables_.loads.turns.begin(ends_.start)
                                            : tables_.loads.turns.begin();
    system_.open(layout_, layout_.X_first ? &end_.here() : nullptr, layout_.X_last ? &far_ : nullptr);
    if (ends_.has_components()) return true;   // which momenta, is decided with the nodes
    if (!layout_.X_first && layout_.P_first)
        set_momenta(ends_.start, system_.balances().end_momentum(false).about_reference);
    if (layout_.P_last) set_momenta(ends_.end, system_.balances().end_momentum(true).about_reference);
    return true;
}

/// Six numbers a body, about its reference point.
/// Of an end that is led they go linearly from those of the arrival to the stated ones (docs/theory.md,
/// "Finding the motion").
void NodalWindow::set_momenta(const State& given, std::vector<double>& momenta) const
{
    const double share = given.t == ends_.led.from.t ? ends_.led.share : 1;
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        double six[6], before[6] = {};
        const auto momenta_of = [&](const State& state, double* to) {
            const Matrix34 of_body = state.V[b] * tables_.model->bodies()[b].mass;
            twist::rows(state.X[b].a, of_body.a, to);
        };
        momenta_of(given, six);
        if (share != 1) momenta_of(ends_.led.from, before);
        for (int i = 0; i < tables_.bodies[b].dofs; ++i)
            momenta[tables_.bodies[b].first + i] = share * six[i] + (1 - share) * before[i];
    }
}

bool NodalWindow::set_state(InstantState& state, const State& given, SolveReport& report)
{
    return end_.set(state, given) ||
           fail(report,
                "the mass matrix on the free motions is singular at t = " + to_text(given.t, 6) + " s");
}

/// The state at the near end, as far as it is known.
bool NodalWindow::begin_front(SolveReport& report)
{
    const State& given = ends_.is_backwards() ? ends_.end : ends_.start;
    if (!knows_positions(ends_.is_backwards() ? ends_.at_end : ends_.at_start)) return true;
    if (!set_state(end_.here(), given, report)) return false;
    if (!ends_.has_state()) return true;
    is_ready_ = true;
    end_.accelerate(end_.here());
    record_end(end_, 0);
    return true;
}

bool NodalWindow::fail(SolveReport& report, const std::string& message) const
{
    report.status = SolveStatus::singular;
    report.message = message;
    return false;
}

/// What Newton's iteration would leave for closing is put in its place: impulses, pivots, nodes and turns.
bool NodalWindow::solve(const NewtonOptions& options, bool soon, NewtonReport& report)
{
    if (!kernel_.serves() || !layout_.is_march() || layout_.n_elements() > 1 ||
        !kernel_.solve(layout_, end_.here(), options, soon, report))
        return false;
    for (int B = 0; B <= layout_.degree; ++B) {
        if (layout_.is_active(B)) kernel_.impulses(B, system_.balances().own_impulses(B));
        system_.nodes().set_pivot(B, kernel_.pivot(B));
    }
    system_.nodes().place_solved(kernel_.increments(), kernel_.width());
    system_.balances().loads().count_turns(layout_, system_.nodes());
    checks_.look_at(kernel_.loads());
    end_.instant().trust_tapes(checks_.are_laws_calm());
    return true;
}

/// Blocks Z_A^T J Z_B take some p^2 n f^2 operations, and the factor (p f)^3: of p n f f times what an
/// element of p n f takes, measured on chains of 10 to 100 bodies.
double NodalWindow::tangent_cost() const
{
    constexpr double measured = 1e-2;
    const bool is_known = kernel_.serves() && layout_.is_march() && end_.here().held.by_joints;
    return is_known ? measured * layout_.degree * std::pow(tables_.freedoms(), 2) : 0;
}

void NodalWindow::begin_newton()
{
    kernel_.forget();
    checks_.look_at(nullptr);
    end_.instant().trust_tapes(false);
    if (layout_.X_first) end_.instant().add_basis(end_.here());
}

bool NodalWindow::start_by_series()
{
    if (!layout_.is_march() || layout_.n_elements() > 1) return false;
    begin_newton();
    series_.place(system_, end_.here());
    return system_.settle();
}

bool NodalWindow::start_from(const Guess& guess)
{
    if (!guess) return start_by_series();
    begin_newton();
    const ElementRule& rule = system_.rule();
    in_shares(layout_.n_nodes(), least_shared, [&](int, int begin, int end) {
        std::vector<double> X(12 * tables_.bodies.size());
        for (int A = begin; A < end; ++A) {
            if (!layout_.is_unknown(A)) continue;
            Patience::ask();
            const State state = guess(layout_.time(rule, A));
            for (std::size_t b = 0; b < state.X.size(); ++b) {
                const Matrix34 rigid =
                    tables_.bodies[b].dofs == 3
                        ? state.X[b]
                        : configuration(state.X[b].column(0), project_directors(directors(state.X[b])));
                std::copy_n(rigid.a, 12, X.begin() + static_cast<std::ptrdiff_t>(12 * b));
            }
            system_.nodes().place_at(A, X.data());
        }
    });
    return system_.settle() && begin_conditions(guess);
}

/// Momenta at both ends as a guess has them.
bool NodalWindow::begin_conditions(const Guess& guess)
{
    if (conditions_ == nullptr) return true;
    for (const bool last : {false, true}) {
        const double t = last ? layout_.times.back() : layout_.times.front();
        if (!conditions_->begin(last, guess(t))) return false;
    }
    return true;
}

State NodalWindow::at(int element_end) const
{
    State state;
    state.X.resize(tables_.bodies.size());
    const int end = ends_.is_backwards() ? last_ - element_end : element_end - first_;
    if (end > 0 || !is_ready_) {
        const double* X = system_.nodes().X(end * layout_.degree);
        for (std::size_t b = 0; b < state.X.size(); ++b) std::copy_n(X + 12 * b, 12, state.X[b].a);
        return state;
    }
    const InstantState& here = end_.here();
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

bool NodalWindow::find_first(SolveReport& report)
{
    if (!end_.find_first(system_))
        return fail(report,
                    "the free motions carry no inertia at t = " + to_text(layout_.times[0], 6) + " s");
    record_end(end_, 0);
    return true;
}

void NodalWindow::record_end(ElementEnd& state, int end)
{
    record_.end(mesh_end(end), state.here(), state.instant(), state.is_jump(state.here().t), state.work());
}

Uncertainty NodalWindow::uncertainty()
{
    std::vector<double> twists;
    const double size = system_.uncertainty(twists);
    double largest = 0, time = 0;
    int body = -1;
    const double* twist = twists.data();
    for (int A = 0; A < layout_.n_nodes() && !twists.empty(); ++A) {
        if (!layout_.is_unknown(A)) continue;
        for (int b = 0; b < tables_.n_bodies(); ++b)
            for (int i = 0; i < tables_.bodies[b].dofs; ++i) {
                const double v = std::abs(twist[tables_.bodies[b].first + i]) / (i < 3 ? tables_.length : 1);
                if (!(v > largest)) continue;
                largest = v;
                body = b;
                time = layout_.time(system_.rule(), A);
            }
        twist += tables_.n_twists;
    }
    std::vector<double> numbers;
    for (int i = 0; i < layout_.n_numbers && !twists.empty(); ++i)
        numbers.push_back(size * std::abs(twist[i]));
    if (body < 0) return {0, "", 0, std::move(numbers)};
    return {size / system_.scale(),
            "body '" + tables_.model->body_name(body) + "' near t = " + to_text(time, 4) + " s",
            size * largest, std::move(numbers)};
}

WorstResidual NodalWindow::worst() const
{
    WorstResidual place{"", layout_.times[0], system_.balances().loads().bad_load(layout_, system_.nodes())};
    double worst = 0;
    int row = -1, body = -1;
    for (int A = 0; A < layout_.n_nodes(); ++A) {
        if (!layout_.is_unknown(A)) continue;
        for (int c = 0; c < tables_.rank; ++c) {
            const double v = std::abs(system_.nodes().violations(A)[c]);
            if (v <= worst) continue;   // nan is worst of all
            worst = v;
            row = system_.nodes().rows()[c];
            place.t = layout_.times[layout_.first_element(A)];
        }
    }
    worst = 0;
    std::vector<double> q(static_cast<std::size_t>(tables_.n_twists)), wrench(12 * tables_.bodies.size());
    for (int A = 0; A < layout_.n_nodes(); ++A) {
        if (!layout_.is_active(A)) continue;
        const Nodes& nodes = system_.nodes();
        std::copy_n(system_.balances().raw(A), wrench.size(), wrench.begin());
        tables_.bodies.twist_rows(nodes.X(A), nodes.maps(A), wrench.data(), q.data());
        for (int b = 0; b < tables_.n_bodies(); ++b)
            for (int i = 0; i < tables_.bodies[b].dofs; ++i) {
                const double v = std::abs(q[tables_.bodies[b].first + i]);
                if (v <= worst) continue;
                worst = v;
                body = b;
            }
    }
    if (row >= 0) place.name = tables_.model->row_name(row);
    if (body >= 0) place.name += (row >= 0 ? ", body '" : "body '") + tables_.model->body_name(body) + "'";
    return place;
}

void NodalWindow::describe(SolveReport& report) const
{
    report.unknowns = std::max(report.unknowns, static_cast<int>(system_.balances().reduced().size()));
    report.smallest_pivot = std::min(report.smallest_pivot, checks_.smallest_pivot());
    report.guess_factorisations = series_.factorisations();
    report.evaluations = system_.evaluations() + series_.evaluations() + kernel_.evaluations();
    if (system_.elimination() != nullptr) system_.elimination()->describe(report);
}

}   // namespace livens
