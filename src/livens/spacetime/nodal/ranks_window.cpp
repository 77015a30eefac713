// SPDX-License-Identifier: BSD-3-Clause
// Elements of one rank, with unknown places and momenta at both of their ends, and what it has in common with
// its neighbours and with the ends of time: theory.md, "Lobatto windows on ranks".
#include "livens/spacetime/nodal/ranks_window.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "livens/dynamics/rows/twist.h"
#include "livens/spacetime/march/components.h"
#include "livens/spacetime/march/window_notes.h"
#include "livens/spacetime/nodal/elimination.h"

namespace livens::inline spacetime_internal {

namespace {

Elements elements_of_rank(const ModelTables& tables, const TimeMesh& mesh, const Lobatto& method,
                          const Ranks& ranks)
{
    const std::vector<int> parts = parts_of_ranks(*tables.model, mesh, ranks.size(), method);
    const auto rank = static_cast<std::size_t>(ranks.rank());
    return {parts[rank], parts[rank + 1]};
}

/// As rows of balances have them, see EndPoint.
std::vector<double> momenta_of(const ModelTables& tables, const State& state)
{
    std::vector<double> momenta(static_cast<std::size_t>(tables.n_twists));
    for (int b = 0; b < tables.n_bodies(); ++b) {
        double six[6];
        const Matrix34 of_body = state.V[b] * tables.model->bodies()[b].mass;
        twist::rows(state.X[b].a, of_body.a, six);
        std::copy_n(six, tables.bodies[b].dofs, momenta.begin() + tables.bodies[b].first);
    }
    return momenta;
}

}   // namespace

TimeMesh RanksWindow::stretch_of(const TimeMesh& whole, const Elements& of)
{
    return {{whole.ends.begin() + of.first, whole.ends.begin() + of.last + 1}};
}

/// Nothing is known at the ends of a stretch, as at those of a phase.
Ends RanksWindow::ends_of_part(const Ends& whole, const TimeMesh& part)
{
    Ends ends;
    ends.at_start = ends.at_end = Known::nothing;
    ends.start_is = Ends::Start::of_phase;
    ends.start = whole.start;
    ends.end = whole.end;
    ends.start.t = part.start();
    ends.end.t = part.end();
    if (whole.has_components() || !knows_positions(whole.at_start)) ends.start.angles.clear();
    ends.independent = whole.independent;
    ends.redundant = whole.redundant;
    ends.n_numbers = whole.n_numbers;
    return ends;
}

/// Of the ends of time that this rank has: a row for each free motion whose place or momentum is known, or
/// for each condition. One of both ends is a row in the first rank and one in the last, joined by an unknown;
/// on one rank it is a single row.
ConditionsOfRank RanksWindow::places_of(const Ends& ends, int n_free, const Ranks& ranks)
{
    ConditionsOfRank places;
    for (auto& rows : places.rows) rows.assign(ends.components.size(), -1);
    places.joins.assign(ends.components.size(), -1);
    for (const bool last : {false, true}) {
        if (last ? !ranks.is_last() : !ranks.is_first()) continue;
        const Known known = last ? ends.at_end : ends.at_start;
        const int of_whole = (knows_positions(known) ? 1 : 0) + (knows_momenta(known) ? 1 : 0);
        if (!ends.has_components()) places.n_rows += of_whole * n_free;
        for (std::size_t i = 0; i < ends.components.size(); ++i) {
            const Condition::At at = ends.components[i].at;
            if (at == (last ? Condition::At::start : Condition::At::end)) continue;
            const bool is_there = ranks.size() == 1 && last && places.rows[0][i] >= 0;
            places.rows[last ? 1 : 0][i] = is_there ? places.rows[0][i] : places.n_rows++;
        }
    }
    for (std::size_t i = 0; ranks.size() > 1 && i < ends.components.size(); ++i) {
        if (ends.components[i].at != Condition::At::both) continue;
        places.joins[i] = places.n_joins++;
    }
    if (ranks.is_first() || ranks.is_last()) places.n_own_joins = places.n_joins;
    return places;
}

std::vector<int> RanksWindow::others() const
{
    std::vector<int> all;
    for (int i = 0; i < places_.n_own_joins; ++i) all.push_back(i);
    for (int i = 0; i < ends_.n_numbers; ++i) all.push_back(places_.n_joins + i);
    return all;
}

RanksWindow::RanksWindow(const ModelTables& tables, const TimeMesh& mesh, const Ends& ends,
                         const Lobatto& method, Ranks& ranks)
    : tables_(tables), ends_(ends), ranks_(ranks), elements_(elements_of_rank(tables, mesh, method, ranks)),
      whole_(mesh), mesh_(stretch_of(mesh, elements_)), part_(ends_of_part(ends, mesh_)),
      places_(places_of(ends, tables.freedoms(), ranks)),
      chain_(ranks, tables.freedoms(), others(), places_.n_joins + ends.n_numbers),
      window_(tables, mesh_, part_, lobatto_rule(method.degree)),
      missed_(tables, ends), points_{EndPoint(tables), EndPoint(tables)}
{
    for (const Body& body : tables.model->bodies()) stated_.push_back(body.X);
    window_.be_part(chain_, {places_.n_rows, places_.n_own_joins});
    for (const bool last : {false, true}) {
        if (ends.has_components() || !has(last)) continue;
        KnownEndOfRank& end = known_[last ? 1 : 0];
        const State& state = last ? ends.end : ends.start;
        end.has_X = knows_positions(last ? ends.at_end : ends.at_start);
        end.has_momenta = knows_momenta(last ? ends.at_end : ends.at_start);
        for (const Matrix34& X : state.X) end.X.insert(end.X.end(), X.a, X.a + 12);
        if (end.has_momenta) end.momenta = momenta_of(tables, state);
    }
}

bool RanksWindow::open(int, int, SolveReport& report)
{
    return ranks_.all(window_.open(0, mesh_.n_elements(), report));
}

bool RanksWindow::start_from(const Guess& guess) { return guess && ranks_.all(window_.start_from(guess)); }

/// Momenta of known ends are what they are before joints take their part, wherever the bodies are.
void RanksWindow::hold_known()
{
    for (const bool last : {false, true})
        if (known_[last ? 1 : 0].has_momenta) system().conditions()->hold(last, known_[last ? 1 : 0].momenta);
}

/// False: places are not finite.
/// 24 numbers a body, X and digits below, and momenta go from the last node of a rank to the first node of
/// the next one: assignments, as between phases.
bool RanksWindow::meet_neighbours()
{
    const std::size_t n = 12 * tables_.bodies.size(), n_p = static_cast<std::size_t>(tables_.n_twists);
    bool is_good = true;
    const std::vector<double> zeros(n, 0.0);
    for (const bool last : {false, true})
        if (known_[last ? 1 : 0].has_X)
            is_good =
                system().meet(last ? last_node() : 0, known_[last ? 1 : 0].X.data(), zeros.data()) && is_good;
    const auto message = [&](int node, bool last) {
        std::vector<double> numbers(system().nodes().X(node), system().nodes().X(node) + n);
        numbers.insert(numbers.end(), system().nodes().low(node), system().nodes().low(node) + n);
        const std::vector<double>& p = system().conditions()->momenta(last);
        numbers.insert(numbers.end(), p.begin(), p.end());
        return numbers;
    };
    std::vector<double> before(2 * n + n_p);
    ranks_.receive_from_before(before);
    ranks_.pass_on(message(last_node(), true));
    if (ranks_.is_first()) return is_good;
    const auto p = before.begin() + static_cast<std::ptrdiff_t>(2 * n);
    system().conditions()->hold(false, {p, before.end()});
    return system().meet(0, before.data(), before.data() + n) && is_good;
}

/// Angles that count turns go on from those of the rank before.
void RanksWindow::relay_angles()
{
    const UnwrappedAngles& turns = tables_.loads.turns;
    if (turns.empty()) return;
    std::vector<double> angles = system().layout().angles;
    ranks_.receive_from_before(angles);
    system().begin_angles(angles);
    for (int A = 0; A <= last_node(); ++A) turns.follow(Configurations(system().nodes().X(A)), angles);
    ranks_.pass_on(angles);
}

bool RanksWindow::residual()
{
    hold_known();
    bool is_good = meet_neighbours();
    relay_angles();
    is_good = is_good && system().residual();
    if (!ranks_.all(is_good)) return false;
    if (!ends_.components.empty() && !compare()) return false;
    miss();
    return true;
}

/// All ranks have the places and momenta at both ends of time.
bool RanksWindow::compare()
{
    const std::size_t n = 12 * tables_.bodies.size();
    for (const bool last : {false, true}) {
        const int node = last ? last_node() : 0;
        std::vector<double> numbers{last ? mesh_.end() : mesh_.start()};
        const auto add = [&](const double* from, std::size_t count) {
            numbers.insert(numbers.end(), from, from + count);
        };
        add(system().nodes().X(node), n);
        add(system().nodes().low(node), n);
        const std::vector<double>& p = system().conditions()->momenta(last);
        add(p.data(), p.size());
        ranks_.broadcast(last ? ranks_.size() - 1 : 0, numbers);
        const double* X = numbers.data() + 1;
        const std::vector<double> momenta(numbers.begin() + 1 + static_cast<std::ptrdiff_t>(2 * n),
                                          numbers.end());
        if (!points_[last ? 1 : 0].place(numbers[0], X, X + n, momenta)) return false;
    }
    return missed_.compare(
        points_[0], points_[1], whole_.end() - whole_.start(),
        [this](const NamedCoordinate& coordinate, double from) { return followed(coordinate, from); });
}

/// Every rank follows it over its own elements; as neighbours have the same places at their border, turns
/// add up.
double RanksWindow::followed(const NamedCoordinate& coordinate, double from) const
{
    FollowedAngle first(coordinate, stated_, from);
    first.pass(system().nodes().X(0));
    const double begin = ranks_.is_first() ? from : first.now();
    double turned = system().followed(coordinate, stated_, from) - begin;
    ranks_.sum({&turned, 1});
    FollowedAngle last(coordinate, stated_, from + turned);
    const State end = points_[1].state();
    last.pass(end.X.data()->data());
    return last.now();
}

void RanksWindow::miss()
{
    std::vector<double> rows(static_cast<std::size_t>(places_.n_rows), 0.0);
    for (std::size_t i = 0; i < ends_.components.size(); ++i) {
        const int row = places_.rows[ends_.components[i].at == Condition::At::end ? 1 : 0][i];
        if (row >= 0) rows[static_cast<std::size_t>(row)] = missed_.rows()[i];
    }
    system().conditions()->miss_in_part(std::move(rows));
}

std::vector<double> RanksWindow::free_motions(int node) const
{
    std::vector<double> z(static_cast<std::size_t>(tables_.n_twists * tables_.freedoms()));
    system().nodes().basis(node).q.null_space(z.data());
    return z;
}

/// By places at the first node and at the last, momenta at the first and at the last, and what joins rows.
std::vector<double> RanksWindow::closing_rows() const
{
    const int f = tables_.freedoms(), width = 4 * f + places_.n_own_joins;
    std::vector<double> rows(static_cast<std::size_t>(places_.n_rows * width), 0.0);
    const auto at = [&](int row, int column) -> double& {
        return rows[static_cast<std::size_t>(row * width + column)];
    };
    int next = 0;
    for (const bool last : {false, true}) {
        const KnownEndOfRank& end = known_[last ? 1 : 0];
        for (int j = 0; end.has_X && j < f; ++j) at(next++, (last ? f : 0) + j) = 1;
        for (int j = 0; end.has_momenta && j < f; ++j) at(next++, (last ? 3 * f : 2 * f) + j) = 1;
        if (ends_.components.empty() || !has(last)) continue;
        const DenseMatrix D =
            missed_.derivatives(last, points_[last ? 1 : 0], system().nodes().basis(last ? last_node() : 0));
        for (std::size_t i = 0; i < ends_.components.size(); ++i) {
            const int row = places_.rows[last ? 1 : 0][i];
            for (int j = 0; row >= 0 && j < f; ++j) {
                at(row, (last ? f : 0) + j) = D(static_cast<int>(i), j);
                at(row, (last ? 3 * f : 2 * f) + j) = D(static_cast<int>(i), f + j);
            }
            if (row >= 0 && places_.joins[i] >= 0) at(row, 4 * f + places_.joins[i]) = last ? -1 : 1;
        }
    }
    return rows;
}

void RanksWindow::border_with(std::function<DenseMatrix(Formed)> columns)
{
    window_.border_with(std::move(columns));
}

bool RanksWindow::factorise()
{
    chain_.meet(tables_.n_twists, free_motions(0), free_motions(last_node()));
    system().conditions()->close_part(closing_rows());
    return ranks_.all(window_.factorise());
}

bool RanksWindow::adopt(const BorderedWindow& other, bool is_pulled)
{
    return ranks_.all(window_.adopt(static_cast<const RanksWindow&>(other).window_, is_pulled));
}

void RanksWindow::solve_for(const BorderedWindow& other, std::span<double> dx)
{
    window_.solve_for(static_cast<const RanksWindow&>(other).window_, dx);
}

bool RanksWindow::move(std::span<const double> dx, double damping)
{
    return ranks_.all(system().move(dx, damping));
}

double RanksWindow::size_of(std::span<const double> dx) const { return ranks_.largest(system().size_of(dx)); }

double RanksWindow::scale() const { return ranks_.largest(system().scale()); }

NewtonProblem::Rows RanksWindow::rows() const
{
    Rows all = system().rows();
    double numbers[] = {all.size, all.terms, all.rounding, all.correction};
    ranks_.largest(numbers);
    all = {numbers[0], numbers[1], numbers[2], false, numbers[3]};
    all.size = std::max(all.size, all.terms * missed_.largest());
    return all;
}

/// An element that is refused ends all: nobody divides it.
AcceptedElements RanksWindow::close(const AcceptanceCriteria& criteria, SolveReport& report)
{
    SolveReport own;
    const AcceptedElements closed = window_.close(criteria, own);
    const bool is_whole = closed.n_elements == mesh_.n_elements();
    if (ranks_.all(is_whole)) return {whole_.n_elements(), false};
    const int e = elements_.first + closed.n_elements;
    std::string why = is_whole ? "" : !own.message.empty() ? own.message : closed.contradiction;
    if (!is_whole && why.empty()) why = of_spurious_root(window_at(whole_, e, e + 1));
    report.status = SolveStatus::not_converged;
    report.message = said_by_first(why, ranks_);
    return {0, false};
}

FiguresOfPart RanksWindow::figures() const
{
    const int f = tables_.freedoms(), n = last_node();
    FiguresOfPart of;
    of.first = elements_.first;
    of.last = elements_.last;
    of.n_formed = mesh_.n_elements();
    of.n_left = 2 * f;
    of.n_in_chain = chain_.n_rows();
    of.n_chain = chain_.n_unknowns();
    of.n_unknowns = n * f;
    // of the first rank also those at the end that all have
    const bool is_state = ends_.has_state() && !ends_.has_components();
    const int known = (knows_positions(ends_.at_start) ? 1 : 0) + (knows_positions(ends_.at_end) ? 1 : 0);
    if (ranks_.is_first() && !is_state) of.n_unknowns += (ends_.has_components() ? 1 : 1 - known) * f;
    SolveReport report;
    window_.describe(report);
    of.factor_entries = report.factor_entries;
    if (system().elimination() != nullptr) of.flops = system().elimination()->flops();
    return of;
}

std::vector<double> RanksWindow::values_of_conditions() const
{
    std::vector<double> values;
    for (std::size_t i = 0; i < ends_.components.size(); ++i)
        values.push_back(ends_.value(i) - missed_.rows()[i]);
    return values;
}

UnknownsWindow::Maker windows_of_ranks(const Lobatto& method, Ranks& ranks)
{
    struct Own {
        Own(const NumberedProblem::Instance& of, const Lobatto& method, Ranks& ranks)
            : tables(*of.rebuilt.model, of.ends.independent), window(tables, of.mesh, of.ends, method, ranks)
        {}
        ModelTables tables;
        RanksWindow window;
    };
    return [&method, &ranks](const NumberedProblem::Instance& of) -> std::shared_ptr<BorderedWindow> {
        auto own = std::make_shared<Own>(of, method, ranks);
        return {own, &own->window};
    };
}

}   // namespace livens::inline spacetime_internal
