// SPDX-License-Identifier: BSD-3-Clause
// Blocks of (P23) one after the other: a guess becomes coefficients, what is known at the ends is put in, and
// the momentum that the law gives at the far end is handed on (docs/theory.md, "The elements of the paper":
// Natural and strong, Loads that jump).
#include "livens/spacetime/mixed/window.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/solvers/crew.h"
#include "livens/spacetime/mixed/bases.h"
#include "livens/spacetime/mixed/block.h"
#include "livens/spacetime/mixed/border.h"
#include "livens/spacetime/mixed/rank_block.h"

namespace livens::inline spacetime_internal {

using namespace mixed;

namespace {

constexpr int least_shared_states = 16;   // that a thread takes

/// Gauss points that integrate every product of fields in (P23) exactly, if they are polynomials: degree 3 p.
/// Quotients are integrated with p more.
int exact_points(const Mixed& method)
{
    const int p = method.degree;
    return (3 * p + 2) / 2 + (basis_of(method).has_weights ? p : 0);
}

/// Functions are one at their own interpolation points, and zero at the others.
bool are_own_at_points(const TimeSpace& space)
{
    const std::vector<double> points = space.interpolation_points();
    std::vector<double> values(static_cast<std::size_t>(space.degree() + 1)), rates(values);
    for (int i = 0; i < space.size(); ++i) {
        const TimeSpace::Place place = space.place(points[i]);
        space.evaluate(place.element, place.s, values, rates);
        for (int a = 0; a <= space.degree(); ++a)
            if (values[a] != (space.first(place.element) + a == i ? 1 : 0)) return false;
    }
    return true;
}

/// Coefficients whose function takes the columns' values at the interpolation points, in place.
void interpolate(const TimeSpace& space, int n_values, std::vector<double>& columns)
{
    const std::vector<double> points = space.interpolation_points();
    const int n = space.size(), local = space.degree() + 1;
    std::vector<std::vector<std::pair<int, double>>> by_column(static_cast<std::size_t>(n));
    std::vector<double> values(static_cast<std::size_t>(local)), rates(values);
    for (int i = 0; i < n; ++i) {
        const TimeSpace::Place place = space.place(points[i]);
        space.evaluate(place.element, place.s, values, rates);
        for (int a = 0; a < local; ++a)
            if (values[a] != 0) by_column[space.first(place.element) + a].push_back({i, values[a]});
    }
    const SparseMatrix A = sparse_from_columns(by_column);
    SparseLU lu(SparseBackend::eigen);
    lu.analyse(A);
    if (!lu.factorise(A)) return;   // values near the coefficients will do for a guess
    std::vector<double> x(static_cast<std::size_t>(n));
    for (int k = 0; k < n_values; ++k) {
        for (int i = 0; i < n; ++i) x[i] = columns[static_cast<std::size_t>(i) * n_values + k];
        lu.solve(x, x);
        for (int i = 0; i < n; ++i) columns[static_cast<std::size_t>(i) * n_values + k] = x[i];
    }
}

/// Elements that begin where a load breaks. Where the functions may bend there, multipliers jump as it does.
std::vector<int> tears_of(const TimeSpace& space, const std::vector<double>& breaks)
{
    std::vector<int> elements;
    const double reach = 1e-9 * (space.ends().back() - space.ends().front());   // as in clamped_knots()
    for (int e = 1; e < space.n_elements(); ++e) {
        const bool is_break =
            std::ranges::any_of(breaks, [&](double t) { return std::abs(t - space.ends()[e]) <= reach; });
        if (is_break && space.first(e) - space.first(e - 1) == space.degree()) elements.push_back(e);
    }
    return elements;
}

}   // namespace

int shortest_block(const Mixed& method) { return basis_of(method).has_knots ? method.degree : 1; }

TimeSpace space_of(const Model& model, const Mixed& method, const TimeMesh& mesh, int first, int last)
{
    const std::vector<double> ends(mesh.ends.begin() + first, mesh.ends.begin() + last + 1);
    return basis_of(method).space(method, ends, model.load_breaks());
}

MixedWindow::MixedWindow(const ModelTables& tables, const TimeMesh& mesh, const Ends& ends,
                         const Mixed& method, Ranks* ranks)
    : tables_(tables), mesh_(mesh), ends_(ends), method_(method),
      coordinates_(tables), given_{knows_positions(ends.at_start), knows_momenta(ends.at_start),
                                   knows_positions(ends.at_end), knows_momenta(ends.at_end)},
      ranks_(ranks), motion_(coordinates_, mesh, method)
{
    for (auto [end, state] : {std::pair{&start_, &ends.start}, {&end_, &ends.end}}) {
        end->state = *state;
        for (std::size_t b = 0; b < state->V.size(); ++b)
            end->P.push_back(state->V[b] * tables.model->bodies()[b].mass);
    }
    if (!ends.has_components()) return;
    // Places at both ends are unknown, and momenta there close the law.
    given_ = {false, true, false, true};
    border_ = std::make_unique<Border>(*tables.model, ends, ranks);
}

MixedWindow::~MixedWindow() = default;

NewtonProblem& MixedWindow::equations() { return *block_; }

/// P where X is known, else the momenta of the state, which turn with the bodies.
EndMomentum MixedWindow::momentum_of(bool X_known, const EndOfBlock& end) const
{
    EndMomentum result{end.P, {}};
    for (std::size_t b = 0; !X_known && b < end.P.size(); ++b)
        result.turning.emplace_back(tables_.model->bodies()[b], end.state.X[b], end.state.V[b]);
    return result;
}

/// What is known at the ends of the elements at hand: where they are ranks' neighbours, nothing, and no
/// momentum is.
Given MixedWindow::known_of_part() const
{
    Given given = given_;
    const bool is_natural = method_.start == Mixed::Start::natural;
    if (first_ > 0 && ranks_ != nullptr) {
        given.X_at_start = false;
        given.P_at_start = is_natural;
    }
    if (last_ < mesh_.n_elements() && ranks_ != nullptr) {
        given.X_at_end = false;
        given.P_at_end = is_natural;
    }
    return given;
}

std::unique_ptr<mixed::Block> MixedWindow::make_block(Equations equations)
{
    if (ranks_ != nullptr) return std::make_unique<RankBlock>(std::move(equations), *ranks_, border_.get());
    assert(equations.space().numbering.n_unknowns() == equations.space().numbering.n_equations());
    return std::make_unique<mixed::Block>(std::move(equations), method_.linear_solver, border_.get());
}

bool MixedWindow::open(int first, int last, SolveReport&)
{
    start_.state.t = mesh_.ends[first];
    end_.state.t = mesh_.ends[last];
    first_ = first;
    last_ = last;
    if (ranks_ != nullptr) {
        const std::vector<int> parts = parts_of_ranks(*tables_.model, mesh_, ranks_->size(), method_);
        first_ = parts[static_cast<std::size_t>(ranks_->rank())];
        last_ = parts[static_cast<std::size_t>(ranks_->rank()) + 1];
    }
    const TimeSpace functions = space_of(*tables_.model, method_, mesh_, first_, last_);
    const bool is_equal = method_.multipliers == Mixed::Multipliers::equal;
    const std::vector<int> tears =
        is_equal ? tears_of(functions, tables_.model->load_breaks()) : std::vector<int>{};
    std::vector<int> torn;
    for (const int e : tears) torn.push_back(functions.first(e));
    const Given given = known_of_part();
    const Numbering numbering(given, method_.start, method_.multipliers, functions.size(), coordinates_.size,
                              coordinates_.n_rows(), torn);
    const int gauss_points = method_.gauss_points > 0 ? method_.gauss_points : exact_points(method_);
    FieldSpace space(coordinates_, {functions, is_equal ? functions : functions.lower(), gauss_points, tears},
                     numbering, method_.start, method_.end_multiplier);
    const auto momentum_at = [&](int element_end, bool X_known, const EndOfBlock& end) {
        const bool is_inside = element_end > first && element_end < last;   // nothing is given there
        if (!is_inside) return momentum_of(X_known, end);
        return EndMomentum{std::vector<Matrix34>(tables_.model->bodies().size()), {}};
    };
    if (ranks_ != nullptr)
        space.functions.go_on(first_ > first ? mesh_.length(first_ - 1) : 0,
                              last_ < last ? mesh_.length(last_) : 0);
    EndMomentum at_start = momentum_at(first_, given_.X_at_start, start_),
                at_end = momentum_at(last_, given_.X_at_end, end_);
    block_ = make_block(Equations(std::move(space), std::move(at_start), std::move(at_end)));
    return true;
}

std::vector<double> MixedWindow::values_of_conditions() const
{
    std::vector<double> values;
    for (std::size_t i = 0; border_ != nullptr && i < ends_.components.size(); ++i)
        values.push_back(ends_.value(i) - border_->conditions().missed()[i]);
    return values;
}

FiguresOfPart MixedWindow::figures() const
{
    const auto& block = static_cast<const RankBlock&>(*block_);
    FiguresOfPart of;
    of.first = first_;
    of.last = last_;
    of.n_formed = block.equations().n_formed();
    of.n_left = block.factors().n_left();
    of.n_in_chain = block.factors().n_in_chain();
    of.n_chain = block.factors().n_chain();
    of.flops = block.factors().flops();
    of.n_unknowns = block.n_own();
    of.factor_entries = block.factors().entries();
    return of;
}

bool MixedWindow::start_from(const Guess& guess)
{
    if (!guess) return false;
    take_guess(guess);
    if (border_ != nullptr)
        for (const bool last : {false, true})
            if (!border_->conditions().begin(last, guess(last ? mesh_.end() : mesh_.start()))) return false;
    fix_known();
    if (ranks_ != nullptr) static_cast<RankBlock&>(*block_).share_guess();
    block_->begin();
    return true;
}

void MixedWindow::border_with(std::function<DenseMatrix(Formed)> columns)
{
    border_->number_by([columns = std::move(columns)] { return columns({}); });
}

bool MixedWindow::factorise() { return block_->factorise(); }

bool MixedWindow::adopt(const BorderedWindow& other, bool)
{
    block_->adopt(*static_cast<const MixedWindow&>(other).block_);
    return true;
}

std::vector<double> MixedWindow::rows_in(Formed) { return block_->rows_behind(); }

void MixedWindow::solve_for(const BorderedWindow& other, std::span<double> dx)
{
    block_->solve_for(*static_cast<const MixedWindow&>(other).block_, dx);
}

/// X0, X and P by interpolation, multipliers by the acceleration-level equation at their functions' instants.
void MixedWindow::take_guess(const Guess& guess)
{
    const BlockFunctions& functions = block_->equations().space().functions;
    Fields& fields = block_->fields();
    const TimeSpace& space = functions.space();
    const int n = coordinates_.size, n_rows = coordinates_.n_rows();
    const bool is_equal = method_.multipliers == Mixed::Multipliers::equal;
    const std::vector<double> points = space.interpolation_points();
    std::vector<State> states(is_equal ? points.size() : 0);
    for (std::size_t A = 0; A < points.size(); ++A) {
        State state = guess(points[A]);
        state.t = points[A];
        if (A == 0) {
            fields.X0 = coordinates_.gather(state.X);
            if (ranks_ != nullptr) ranks_->broadcast(0, fields.X0);   // unknowns at borders are the same
        }
        std::vector<Matrix34> P = state.V;
        for (std::size_t b = 0; b < P.size(); ++b) P[b] = state.V[b] * tables_.model->bodies()[b].mass;
        const std::vector<double> x = coordinates_.gather(state.X), p = coordinates_.gather(P);
        for (int i = 0; i < n; ++i) {
            fields.x[A * n + i] = x[i] - fields.X0[i];
            fields.P[A * n + i] = p[i];
        }
        if (is_equal) states[A] = std::move(state);
    }
    for_each_item(static_cast<int>(states.size()), least_shared_states,
                  [&](int A) { put_multipliers(A, states[A]); });
    const bool is_done = are_own_at_points(space);
    if (!is_done) interpolate(space, n, fields.x);
    if (!is_done) interpolate(space, n, fields.P);
    if (is_equal) {
        if (!is_done) interpolate(space, n_rows, fields.lambda);
        const std::vector<double> whole = fields.lambda;   // as if nothing was torn
        for (int e = 0; e < space.n_elements(); ++e)
            std::copy_n(whole.begin() + static_cast<std::ptrdiff_t>(space.first(e)) * n_rows,
                        (space.degree() + 1) * n_rows,
                        fields.lambda.begin() +
                            static_cast<std::ptrdiff_t>(functions.first_multiplier(e)) * n_rows);
        return;
    }
    for (int A = 0; A < functions.multipliers().size(); ++A) {
        State state = guess(functions.centre(A));
        state.t = functions.centre(A);
        put_multipliers(A, state);
    }
}

void MixedWindow::put_multipliers(int A, const State& state)
{
    const std::vector<double> lambda = coordinates_.multipliers(state);
    for (std::size_t k = 0; k < lambda.size(); ++k)
        block_->fields().lambda[A * lambda.size() + k] = std::isfinite(lambda[k]) ? lambda[k] : 0;
}

/// Known coefficients of the fields, which the guess left as they came.
void MixedWindow::fix_known()
{
    const Numbering& n = block_->equations().space().numbering;
    Fields& fields = block_->fields();
    const int last = n.n_functions() - 1, size = coordinates_.size;
    const Given given = known_of_part();
    if (given_.X_at_start) fields.X0 = coordinates_.gather(start_.state.X);   // x_0 is zero then
    for (const bool at_end : {false, true}) {
        const EndOfBlock& end = at_end ? end_ : start_;
        const int A = at_end ? last : 0;
        if (at_end ? given.X_at_end : given.X_at_start) {
            const std::vector<double> x = coordinates_.gather(end.state.X);
            for (int i = 0; i < size; ++i) fields.x[A * size + i] = x[i] - fields.X0[i];
        }
        if (n.P(A) >= 0) continue;
        const std::vector<double> p = coordinates_.gather(end.P);
        std::copy(p.begin(), p.end(), fields.P.begin() + static_cast<std::ptrdiff_t>(A) * size);
    }
    block_->equations().space().tie(fields);
}

AcceptedElements MixedWindow::close(const AcceptanceCriteria&, SolveReport& report)
{
    const bool is_part = ranks_ != nullptr;
    motion_.add(first_, block_->equations(), block_->fields(),
                {!is_part || ranks_->is_first(), !is_part || ranks_->is_last()});
    report.unknowns = std::max(report.unknowns, block_->n_unknowns());
    report.factor_entries = std::max(report.factor_entries, block_->factor_entries());
    if (is_part) return {mesh_.n_elements(), false};
    const bool is_last = ends_.is_backwards() ? first_ == 0 : last_ == mesh_.n_elements();
    return {is_last || hand_on(report) ? last_ - first_ : 0, false};
}

/// The far end of a block becomes the known end of the next one.
bool MixedWindow::hand_on(SolveReport& report)
{
    const bool backwards = ends_.is_backwards();
    EndOfBlock& end = backwards ? end_ : start_;
    end.state.t = mesh_.ends[backwards ? first_ : last_];
    end.state.X = block_->equations().space().end_position(block_->fields(), !backwards);
    end.P = block_->equations().end_momentum(block_->fields(), !backwards);
    for (std::size_t b = 0; b < end.P.size(); ++b) end.state.V[b] = end.P[b] * coordinates_.inverse_masses[b];
    if (method_.interfaces == Mixed::Interfaces::carry) return true;
    TriedStart tried = try_consistent_start(*tables_.model, end.state, StartPolicy::project);
    if (!tried.closed) {
        report.status = SolveStatus::not_converged;
        report.message =
            "what the block before t = " + to_text(end.state.t, 6) +
            " s ends in is no admissible state to continue from: " + InputError(tried.why).what();
        return false;
    }
    end.state = std::move(tried.closed->start);
    for (std::size_t b = 0; b < end.P.size(); ++b)
        end.P[b] = end.state.V[b] * tables_.model->bodies()[b].mass;
    return true;
}

State MixedWindow::at(int element_end) const
{
    if (ends_.has_state() && element_end == (ends_.is_backwards() ? last_ : first_))
        return ends_.is_backwards() ? end_.state : start_.state;
    const int e = element_end - first_;
    std::vector<double> x(static_cast<std::size_t>(coordinates_.size));
    block_->equations().space().evaluate_X(block_->fields(), e == 0 ? 0 : e - 1, e == 0 ? 0 : 1, x.data());
    State state;
    state.X = coordinates_.bodies(x.data());
    return state;
}

WorstResidual MixedWindow::worst() const
{
    const Worst worst = block_->worst();
    return {worst.name, worst.t, block_->bad_load()};
}

void MixedWindow::describe(SolveReport& report) const
{
    if (!block_) return;
    report.unknowns = std::max(report.unknowns, block_->n_unknowns());
    report.factor_entries = std::max(report.factor_entries, block_->factor_entries());
}

Motion MixedWindow::take_motion()
{
    const bool is_torn = motion_.n_blocks() > 1 && method_.interfaces == Mixed::Interfaces::project;
    Motion motion = motion_.take(is_torn, ends_.is_backwards() ? ends_.end : ends_.start);
    motion.redundant_rows = ends_.redundant;
    return motion;
}

}   // namespace livens::inline spacetime_internal
