// SPDX-License-Identifier: BSD-3-Clause
// Newton's iteration on a window: rows Z^T D^T N^T r_A of the active nodes, twists D Z eta of the unknown
// ones, and after each move a pull back onto the constraints. Rows are compared with the rounding of the sums
// over k_AB, which cancel (docs/theory.md, "Newton's iteration", "The whole matrix of lobatto").
#include "livens/spacetime/nodal/system.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "livens/dynamics/instant/instant.h"
#include "livens/solvers/crew.h"
#include "livens/spacetime/nodal/elimination.h"

namespace livens {

NodalSystem::~NodalSystem() = default;

NodalSystem::NodalSystem(const ModelTables& tables, const ElementRule& rule)
    : tables_(tables), rule_(rule), nodes_(tables, rule_), rows_(tables, rule_), tangent_(tables, rule_),
      range_(tables.rank)
{}

void NodalSystem::open(const WindowLayout& layout, const InstantState* first, const InstantState* last)
{
    const bool is_alike = layout.n_nodes() == layout_.n_nodes() && layout.X_first == layout_.X_first &&
                          layout.P_first == layout_.P_first && layout.X_last == layout_.X_last &&
                          layout.P_last == layout_.P_last &&
                          layout.are_momenta_unknown == layout_.are_momenta_unknown &&
                          layout.part == layout_.part;
    layout_ = layout;
    nodes_.open(layout_);
    if (!is_alike) rows_.open(layout_);
    if (first != nullptr) nodes_.fix(0, *first);
    if (last != nullptr) nodes_.fix(layout_.n_nodes() - 1, *last);
    if (first != nullptr) rows_.start_with(*first);
    if (!is_alike) elimination_.reset();
}

void NodalSystem::choose_elimination()
{
    elimination_ = takes_bodies_apart() ? body_elimination(tables_) : on_null_spaces(false);
}

/// One element of degree 1 where loads have no tangent.
bool NodalSystem::takes_bodies_apart() const
{
    return rule_.degree == 1 && rule_.points == Points::lobatto && layout_.n_elements() == 1 &&
           layout_.is_march() && tables_.loads.with_tangent.empty();
}

std::unique_ptr<Elimination> NodalSystem::on_null_spaces(bool as_a_whole) const
{
    // a part of a chain may not turn to another elimination by itself
    if (conditions_ != nullptr && conditions_->chain() != nullptr)
        return null_space_elimination(tables_, layout_, solver_of_part(*conditions_->chain()));
    return null_space_elimination(tables_, layout_, layout_.is_march() ? forward_solver() : chain_solver(),
                                  as_a_whole ? Inside::as_a_whole : Inside::as_it_pays);
}

bool NodalSystem::settle()
{
    if (elimination_ == nullptr) choose_elimination();
    in_use_ = pending_ = false;
    correction_ = 0;
    if (!nodes_.constrain(layout_, false)) return false;
    if (!layout_.is_march()) return pull(true);
    for (int round = 0; round < 6; ++round) {
        pending_ = nodes_.is_near() && elimination_->takes_constraints();
        correction_ = 0;
        if (pending_) break;
        correction_ = nodes_.correct(layout_);
        if (correction_ < 1e-3) break;   // lengths and radians: bases turn by no more
        if (!nodes_.constrain(layout_, false)) return false;
    }
    return true;
}

std::size_t NodalSystem::n_node_numbers() const
{
    const int n_known = (layout_.X_first ? 1 : 0) + (layout_.X_last ? 1 : 0);
    return static_cast<std::size_t>(layout_.n_nodes() - n_known) * static_cast<std::size_t>(tables_.n_twists);
}

/// Of an unknown node's twist among all.
std::ptrdiff_t NodalSystem::place_of(int A) const
{
    return static_cast<std::ptrdiff_t>(layout_.X_first ? A - 1 : A) * tables_.n_twists;
}

int NodalSystem::n_unknowns() const
{
    return static_cast<int>(n_node_numbers()) + (conditions_ != nullptr ? conditions_->n_numbers() : 0);
}

bool NodalSystem::evaluate_conditions()
{
    const int last = layout_.n_nodes() - 1, n = layout_.n_elements();
    const auto at = [&](int A, int end, int e) {
        return EndPlaces{layout_.times[static_cast<std::size_t>(end)], nodes_.X(A), nodes_.low(A),
                         layout_.h(e)};
    };
    return conditions_->evaluate({at(0, 0, 0), at(last, n, n - 1)},
                                 [&](const NamedCoordinate& coordinate, double from) {
                                     return followed(coordinate, conditions_->stated(), from);
                                 });
}

double NodalSystem::followed(const NamedCoordinate& coordinate, std::span<const Matrix34> stated,
                             double from) const
{
    FollowedAngle angle(coordinate, stated, from);
    for (int A = 0; A < layout_.n_nodes(); ++A) angle.pass(nodes_.X(A));
    return angle.now();
}

bool NodalSystem::residual()
{
    evaluations_ += layout_.n_nodes();
    if (conditions_ == nullptr) return rows_.evaluate(layout_, nodes_);
    if (!evaluate_conditions()) return false;
    for (const bool last : {false, true})
        rows_.end_momentum(last).about_reference = conditions_->momenta(last);
    return rows_.evaluate(layout_, nodes_);
}

void NodalSystem::form_all(Elimination& elimination)
{
    elimination.begin(layout_, nodes_);
    tangent_.form(layout_, nodes_, rows_, elimination);
    if (conditions_ == nullptr) return;
    conditions_->differentiate({&nodes_.basis(0), &nodes_.basis(layout_.n_nodes() - 1)});
    const DenseMatrix columns = conditions_->columns(elimination);
    elimination.stand_at(tables_, nodes_);
    elimination.close_with(conditions_->closing(), columns);
}

bool NodalSystem::adopt(const NodalSystem& other, bool is_pulled)
{
    in_use_ = pending_ = false;
    nodes_.adopt(other.nodes_, layout_);
    if (conditions_ != nullptr) conditions_->adopt(*other.conditions_);
    return !is_pulled || (nodes_.constrain(layout_, false) && pull(true));
}

bool NodalSystem::put(int A, const double* X, const double* low)
{
    if (!nodes_.place_at(A, X, low)) return true;
    const double before = correction_;
    if (!nodes_.constrain(layout_, in_use_) || !pull(true)) return false;
    correction_ = std::max(correction_, before);
    measure();
    return true;
}

bool NodalSystem::meet(int A, const double* X, const double* low)
{
    constexpr double rounding = 1e-13;   // lengths, and of directors
    const double *own = nodes_.X(A), *own_low = nodes_.low(A);
    for (std::size_t i = 0; i < 12 * tables_.bodies.size(); ++i) {
        const double off = std::abs((X[i] - own[i]) + (low[i] - own_low[i]));
        const double size = i % 12 < 3 ? std::max(tables_.length, std::abs(X[i])) : 1;
        if (!(off <= rounding * size)) return put(A, X, low);
    }
    if (!nodes_.place_at(A, X, low)) return true;
    for (int e = layout_.first_element(A); e <= layout_.last_element(A); ++e) nodes_.take_differences(e);
    return true;
}

std::vector<double> NodalSystem::rows_in(Elimination& formed) const
{
    formed.stand_at(tables_, nodes_);
    std::vector<double> rows = conditions_->behind(rows_.reduced());
    formed.carry(rows.data());
    return rows;
}

bool NodalSystem::factorise()
{
    if (elimination_ == nullptr) choose_elimination();
    in_use_ = true;
    form_all(*elimination_);
    if (elimination_->factorise()) return true;
    if (elimination_->is_whole()) return false;
    elimination_ = on_null_spaces(true);   // which exchanges rows of all that is inside
    form_all(*elimination_);
    return elimination_->factorise();
}

void NodalSystem::keep()
{
    nodes_.keep();
    if (conditions_ != nullptr) conditions_->keep();
}

void NodalSystem::solve_for(const NodalSystem& other, std::span<double> dx)
{
    const std::vector<double>& rows = other.rows_.reduced();
    if (conditions_ == nullptr)
        solve_rows(other, rows, dx);
    else
        solve_rows(other, other.conditions_->behind(rows), dx);
}

void NodalSystem::solve_rows(const NodalSystem& other, std::span<const double> rows, std::span<double> dx)
{
    if (pending_) {   // one node: its violations go into the linear system with the rows
        for (int c = 0; c < tables_.rank; ++c) range_[c] = -nodes_.violations(1)[c];
        nodes_.basis(1).q.solve_R_transposed(range_.data());
    }
    const double* range = pending_ ? range_.data() : nullptr;
    elimination_->stand_at(other.tables_, other.nodes_);
    elimination_->solve(rows, range, dx.data());
    for_each_item(layout_.n_nodes(), least_shared, [&](int A) {
        if (!layout_.is_unknown(A)) return;
        double* const own = dx.data() + place_of(A);
        other.tables_.bodies.to_twist(other.nodes_.maps(A), own, own);
    });
    if (conditions_ == nullptr) return;
    double* const twist = dx.data() + n_node_numbers();
    const std::vector<double> along(twist, twist + conditions_->n_border());
    conditions_->to_momenta(along.data(), twist);
}

bool NodalSystem::move(std::span<const double> dx, double damping)
{
    nodes_.begin_move();
    for_each_item(layout_.n_nodes(), least_shared, [&](int A) {
        if (layout_.is_unknown(A)) nodes_.move(A, dx.data() + place_of(A), damping);
    });
    if (conditions_ != nullptr) conditions_->move(dx.subspan(n_node_numbers()), damping);
    pending_ = false;
    if (!nodes_.constrain(layout_, in_use_)) return false;
    if (damping == 0)
        correction_ = 0;   // the way back changes nothing
    else if (layout_.is_march())
        correction_ = nodes_.correct(layout_);
    else if (!pull(false))
        return false;
    measure();
    return true;
}

/// Of a whole window nodes may move far: they are pulled until their bases fit. Else the next step would
/// begin elsewhere than this one ended, and multipliers, which must belong to the places, would leave a part
/// of themselves in the rows. Placed nodes may come from anywhere; moved ones are as good as their step:
/// false where a pull does not halve what is left.
bool NodalSystem::pull(bool are_placed)
{
    constexpr double fits = 1e-9;   // lengths and radians
    double before = std::numeric_limits<double>::infinity();
    for (int round = 0; round < 20; ++round) {
        correction_ = nodes_.correct(layout_);
        if (bases_fit()) return true;
        if (!are_placed && !(correction_ < before / 2)) return false;
        if (!nodes_.constrain(layout_, in_use_)) return false;
        if (correction_ < fits) return true;
        before = correction_;
    }
    return true;
}

/// Motion and impulse inside the elements.
void NodalSystem::measure()
{
    extents_.assign(static_cast<std::size_t>(Crew::size()), {});
    in_shares(layout_.n_elements(), least_shared, [&](int slot, int begin, int end) {
        auto& [motion, impulse] = extents_[slot];
        for (int e = begin; e < end; ++e) impulse = std::max(impulse, impulse_of(e, motion));
    });
    extent_ = {};
    for (const auto& [motion, impulse] : extents_) {
        extent_.motion = std::max(extent_.motion, motion);
        extent_.impulse = std::max(extent_.impulse, impulse);
    }
}

/// Of an element: mass times motion over h, in scaled rows; `motion` grows to what moves in it, in lengths
/// and radians.
double NodalSystem::impulse_of(int e, double& motion) const
{
    const double inverse = 1 / std::abs(layout_.h(e));
    double impulse = 0;
    for (int B = 1; B <= rule_.degree; ++B) {
        for (int b = 0; b < tables_.n_bodies(); ++b) {
            const double* d = nodes_.dX(e, B) + 12 * b;
            const auto& body = tables_.bodies[b];
            double u = 0, turn = 0;
            for (int i = 0; i < 3; ++i) u = std::max(u, std::abs(d[i]));
            for (int i = 3; i < 12; ++i) turn = std::max(turn, std::abs(d[i]));
            motion = std::max(motion, std::max(u / tables_.length, turn));
            impulse = std::max(impulse,
                               ((u + body.reach * turn) / body.inverse_root_mass + body.root_inertia * turn) *
                                   inverse);
        }
    }
    return impulse;
}

double NodalSystem::size_of(std::span<const double> dx) const
{
    double size = 0;
    const auto take = [&size](double here) {
        if (!(here <= size) && !std::isnan(size)) size = here;
    };
    const std::size_t n = n_node_numbers();
    std::vector<double> sizes(tables_.n_twists > 0 ? n / tables_.n_twists : 0);
    for_each_item(static_cast<int>(sizes.size()), least_shared, [&](int i) {
        sizes[i] = nodes_.size_of(dx.data() + static_cast<std::ptrdiff_t>(i) * tables_.n_twists);
    });
    for (const double here : sizes) take(here);
    if (conditions_ != nullptr) take(conditions_->size_of(dx.subspan(n)));
    return size;
}

double NodalSystem::largest_k() const
{
    double largest = 0;
    for (const double k : rule_.k) largest = std::max(largest, std::abs(k));
    return largest;
}

/// A body may fly many lengths while its turns need their digits all the same.
double NodalSystem::scale() const { return std::clamp(extent_.motion, 1e-6, 1.0); }

/// The sums over k_AB cancel: their rounding is that of their largest term.
NewtonProblem::Rows NodalSystem::rows() const
{
    const double terms = std::max(extent_.impulse, rows_.terms());
    // what conditions miss counts by its share of their scales
    const double missing = conditions_ != nullptr ? terms * conditions_->largest() : 0;
    return {std::max(rows_.size(), missing), terms,
            1e-16 * (largest_k() * extent_.impulse + rows_.terms() + tangent_.load_rounding()),
            layout_.n_elements() == 1 && conditions_ == nullptr, correction_};
}

/// Each row has the rounding of its own terms: a motion that decays keeps its digits.
std::vector<double> NodalSystem::roundings() const
{
    std::vector<double> roundings(static_cast<std::size_t>(layout_.n_nodes()), 0.0);
    const auto size = static_cast<std::ptrdiff_t>(12 * tables_.bodies.size());
    double motion = 0;
    for (int e = 0; e < layout_.n_elements(); ++e) {
        const double of_element = largest_k() * impulse_of(e, motion) + tangent_.load_rounding(e);
        for (int A = e * layout_.degree; A <= (e + 1) * layout_.degree; ++A)
            roundings[A] = std::max(roundings[A], 1e-16 * of_element);
    }
    for (int A = 0; A < layout_.n_nodes(); ++A) {
        if (!layout_.is_active(A)) continue;
        const double* raw = rows_.raw(A);
        const auto largest =
            std::max_element(raw, raw + size, [](double a, double b) { return std::abs(a) < std::abs(b); });
        roundings[A] += 1e-16 * std::abs(*largest);
    }
    return roundings;
}

double NodalSystem::uncertainty(std::vector<double>& twists)
{
    std::vector<double> roundings = this->roundings();
    if (conditions_ != nullptr)
        for (const double rounding : conditions_->roundings()) roundings.push_back(rounding);
    const double response = elimination_->least_resisted(roundings, twists);
    double* twist = twists.data();
    for (int A = 0; A < layout_.n_nodes() && !twists.empty(); ++A) {
        if (!layout_.is_unknown(A)) continue;
        tables_.bodies.to_twist(nodes_.maps(A), twist, twist);
        twist += tables_.n_twists;
    }
    return response;
}

void NodalSystem::measure_condition(SolveReport& report, const std::function<bool()>& goes_on)
{
    const double f = tables_.freedoms(), p = layout_.degree;
    if (f == 0) return;   // nothing moves: there is no matrix
    if (layout_.n_elements() * p * (2 * p + 1) * f * f > std::numeric_limits<int>::max()) {
        report.notes.push_back("the whole matrix is too large for its condition number; use fewer elements");
        return;
    }
    // What solving had is taken as it is, and not kept: its blocks go.
    std::unique_ptr<Elimination> elimination = std::move(elimination_);
    if (elimination == nullptr || takes_bodies_apart() || !elimination->is_whole())
        elimination = on_null_spaces(true);
    form_all(*elimination);
    elimination->measure_condition(report, goes_on);
}

}   // namespace livens
