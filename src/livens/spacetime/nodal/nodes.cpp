// SPDX-License-Identifier: BSD-3-Clause
// X of a node as a sum of two doubles, moved by x <- exp(twist) x with a compensated sum, and differences
// X_B - X_0 of both parts (docs/theory.md, "Increments"). Constraints follow from the element's first node
// on, where quadratic by the exact identity for changes; a violation is taken off by -D Y R^-T S^-1 Phi, node
// by node ("Eliminating the joint multipliers").
#include "livens/spacetime/nodal/nodes.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "livens/dynamics/instant/instant.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"

namespace livens {

namespace {

/// to + to_low <- x + x_low + by, without the rounding of the sum [Kahan1965]; of another node, or set.
inline void add_two_sums(const double* __restrict x, const double* __restrict x_low,
                         const double* __restrict by, double* __restrict to, double* __restrict to_low,
                         std::size_t n)
{
    for (std::size_t i = 0; i < n; ++i) {
        const double from = x[i], d = by[i] + x_low[i], sum = from + d, back = sum - from;
        to[i] = sum;
        to_low[i] = (from - (sum - back)) + (d - back);
    }
}

/// dX <- increments of a body about its centre of mass, `width` apart, to its reference point.
inline void take_increments(const double* __restrict lanes, int width, const double* __restrict center,
                            double* __restrict dX)
{
    for (int i = 3; i < 12; ++i) dX[i] = lanes[i * width];
    for (int i = 0; i < 3; ++i)
        dX[i] = lanes[i * width] - (dX[3 + i] * center[0] + dX[6 + i] * center[1] + dX[9 + i] * center[2]);
}

/// to <- x + x_low + by for a body.
inline void add_small(const double* __restrict x, const double* __restrict x_low, const double* __restrict by,
                      double* __restrict to)
{
    for (int i = 0; i < 12; ++i) to[i] = x[i] + (x_low[i] + by[i]);
}

/// d <- x + x_low - (x0 + x0_low).
inline void subtract_two_sums(const double* __restrict x, const double* __restrict x_low,
                              const double* __restrict x0, const double* __restrict x0_low,
                              double* __restrict d, std::size_t n)
{
    for (std::size_t b = 0; b < n; b += 12)
        for (std::size_t i = b; i < b + 12; ++i) d[i] = (x[i] - x0[i]) + (x_low[i] - x0_low[i]);
}

/// Zeros for so many nodes (or elements).
void take_room(Room& room, int n, std::size_t numbers)
{
    room.resize(static_cast<std::size_t>(n) * numbers);
    for_each_item(n, least_shared, [&](int i) { std::fill_n(room.begin() + i * numbers, numbers, 0.0); });
}

}   // namespace

NodePositions::NodePositions(const ModelTables& tables, const ElementRule& rule)
    : tables_(tables), rule_(rule), size_(12 * tables.bodies.size())
{}

void NodePositions::open(const WindowLayout& layout)
{
    const std::size_t n = layout.n_nodes();
    const bool is_alike = times_.size() == n;   // as all elements of a march are
    current_ = kept_ = 0;
    times_.resize(n);
    for (int A = 0; A < layout.n_nodes(); ++A) times_[A] = layout.time(rule_, A);
    if (is_alike) return;
    for (Set& set : sets_)
        for (Room* room : {&set.X, &set.low}) take_room(*room, static_cast<int>(n), size_);
    take_room(dX_, layout.n_elements(), rule_.size() * size_);
}

void NodePositions::fix(int A, const std::vector<double>& X, const std::vector<double>& low)
{
    for (Set& set : sets_) {
        std::copy_n(X.data(), size_, set.X.data() + place(A));
        std::copy_n(low.data(), size_, set.low.data() + place(A));
    }
}

void NodePositions::place_at(int A, const double* X)
{
    std::copy(X, X + size_, sets_[current_].X.data() + place(A));
    std::fill_n(sets_[current_].low.data() + place(A), size_, 0.0);
}

bool NodePositions::place_at(int A, const double* X, const double* low)
{
    double *own = sets_[current_].X.data() + place(A), *own_low = sets_[current_].low.data() + place(A);
    if (std::equal(X, X + size_, own) && std::equal(low, low + size_, own_low)) return false;
    std::copy_n(X, size_, own);
    std::copy_n(low, size_, own_low);
    return true;
}

void NodePositions::place_solved(const double* increments, int width)
{
    const int p = rule_.degree;
    Set& set = sets_[kept_];
    for (int B = 1; B <= p; ++B) {
        const double* d = increments + (B == p ? 0 : B);
        double *X = set.X.data() + place(B), *dX = dX_.data() + place(B);
        for (int b = 0; b < tables_.n_bodies(); ++b, d += 12 * width) {
            const double *X_0 = set.X.data() + 12 * b, *low_0 = set.low.data() + 12 * b;
            double* by = dX + 12 * b;
            take_increments(d, width, tables_.bodies[b].center, by);
            // digits below the last are handed on at the end alone
            if (B == p)
                add_two_sums(X_0, low_0, by, X + 12 * b, set.low.data() + place(B) + 12 * b, 12);
            else
                add_small(X_0, low_0, by, X + 12 * b);
        }
    }
}

void NodePositions::adopt(const NodePositions& others, const WindowLayout& layout)
{
    const Set& kept = others.sets_[others.kept_];
    for (int A = 0; A < layout.n_nodes(); ++A)
        for (Set& set : sets_) {
            if (!layout.is_unknown(A)) continue;
            std::copy_n(kept.X.begin() + static_cast<std::ptrdiff_t>(place(A)), size_,
                        set.X.begin() + static_cast<std::ptrdiff_t>(place(A)));
            std::copy_n(kept.low.begin() + static_cast<std::ptrdiff_t>(place(A)), size_,
                        set.low.begin() + static_cast<std::ptrdiff_t>(place(A)));
        }
}

/// Node A of `to` <- node A_from of `from`, both parts, moved.
void NodePositions::displace(const Set& from, int A_from, const double* twist, double factor, Set& to, int A)
{
    constexpr int few = 8;   // bodies at a time
    double displacement[12 * few], scaled[6];
    for (int begin = 0; begin < tables_.n_bodies(); begin += few) {
        const int n = std::min(few, tables_.n_bodies() - begin);
        for (int i = 0; i < n; ++i) {
            const auto& body = tables_.bodies[begin + i];
            const double* own = twist + body.first;
            double* by = displacement + 12 * i;
            for (int j = 0; j < body.dofs && factor != 1; ++j) scaled[j] = factor * own[j];
            if (factor != 1) own = scaled;
            if (body.dofs == 6) {
                twist::displacement(own, from.X.data() + place(A_from) + 12 * (begin + i), by);
            } else {
                std::copy_n(own, 3, by);
                std::fill(by + 3, by + 12, 0.0);
            }
        }
        const std::size_t first = place(A_from) + 12 * begin, to_first = place(A) + 12 * begin;
        add_two_sums(from.X.data() + first, from.low.data() + first, displacement, to.X.data() + to_first,
                     to.low.data() + to_first, 12 * static_cast<std::size_t>(n));
    }
}

void NodePositions::place_from(int A, int from, const double* twist)
{
    displace(sets_[current_], from, twist, 1, sets_[current_], A);
}

void NodePositions::turn_from(int A, int from, const double* turns)
{
    Set& set = sets_[current_];
    double displacement[12] = {};
    for (int b = 0; b < tables_.n_bodies(); ++b) {
        const std::size_t at = 12 * static_cast<std::size_t>(b);
        twist::displacement(turns + 7 * b, turns + 7 * b + 3, X(from) + at, displacement);
        add_two_sums(set.X.data() + place(from) + at, set.low.data() + place(from) + at, displacement,
                     set.X.data() + place(A) + at, set.low.data() + place(A) + at, 12);
    }
}

void NodePositions::move(int A, const double* twist, double factor)
{
    displace(sets_[kept_], A, twist, factor, sets_[1 - kept_], A);
}

void NodePositions::take_differences(int e)
{
    const int first = e * rule_.degree;
    for (int B = 1; B <= rule_.degree; ++B)
        subtract_two_sums(X(first + B), low(first + B), X(first), low(first),
                          dX_.data() + place(e * rule_.size() + B), size_);
}

double NodePositions::size_of(const double* twist) const
{
    double size = 0;
    const auto look = [&size](double value) {
        if (!(value <= size) && !std::isnan(size)) size = value;
    };
    for (const auto& body : tables_.bodies) {
        for (int i = 0; i < 3; ++i) look(std::abs(twist[body.first + i]) / tables_.length);
        for (int i = 3; i < body.dofs; ++i) look(std::abs(twist[body.first + i]));
    }
    return size;
}

/// Bases are freed as they were made: what one thread does while others have nothing to do counts twice.
Nodes::~Nodes()
{
    const auto n = static_cast<int>(bases_.size());
    if (!Crew::divides(n, least_shared)) return;
    try {
        for_each_item(n, least_shared, [&](int A) { bases_[A] = ConstraintBasis(); });
    } catch (...) {   // this thread is stopped: what is left goes with the rest
    }
}

void Nodes::open(const WindowLayout& layout)
{
    NodePositions::open(layout);
    const std::size_t n = layout.n_nodes();
    pivots_.assign(n, 1.0);
    first_rows_ = nullptr;
    if (known_.size() == n) {
        known_.front() = known_.back() = nullptr;
        return;
    }
    take_room(maps_, layout.n_nodes(), size_);
    scaled_.assign(n * tables_.rank, 0.0);
    phi_.assign(n * tables_.rank, 0.0);
    known_.assign(n, nullptr);
    bases_.clear();
    moves_.assign(n, 0.0);
}

void Nodes::fix(int A, const InstantState& state)
{
    NodePositions::fix(A, state.X, state.X_low);
    std::copy_n(state.maps.data(), size_, maps_.data() + place(A));
    known_[A] = &state.held.basis;
    if (A == 0) first_rows_ = &state.held.rows;
    pivots_[A] = state.held.smallest_pivot;
    has_start_ = false;
}

/// Bases take room that grows with the square of the bodies: only here.
void Nodes::begin_constraining()
{
    if (bases_.empty()) {
        std::vector<ConstraintBasis> bases(known_.size());
        for_each_item(static_cast<int>(bases.size()), least_shared, [&](int A) {
            Patience::ask();
            bases[A].resize(tables_, false);
        });
        bases_ = std::move(bases);
    }
    const auto n_threads = static_cast<std::size_t>(Crew::size());
    if (work_.size() < n_threads) work_.resize(n_threads, std::vector<double>(2 * size_, 0.0));
    if (!in_lanes_ || in_lanes_->rows() != rows()) {
        in_lanes_.emplace(tables_, rows(), static_cast<int>(known_.size()) - 1);
        lanes_.clear();
    }
    if (lanes_.size() < n_threads) lanes_.resize(n_threads, in_lanes_->workspace());
    if (has_start_ || known_[0] == nullptr) return;
    has_start_ = true;
    pivots_[0] = known_[0]->smallest_pivot;
    for (int c = 0; c < tables_.rank; ++c) phi_[c] = tables_.rows.value((*first_rows_)[c], at(0), X(0));
}

void Nodes::build_bases(int slot, int first, int behind, bool same_choices)
{
    RowsInLanes::Workspace& work = lanes_[slot];
    const int width = in_lanes_->width();
    for (int A = first; A < behind; A += width) {
        const int n = std::min(width, behind - A);
        for (int l = 0; l < n; ++l) in_lanes_->place(l, X(A + l), work);
        in_lanes_->evaluate(work);
        for (int l = 0; l < n; ++l) {
            Patience::ask();
            double* const map = maps_.data() + place(A + l);
            tables_.bodies.map_twists(X(A + l), map);
            pivots_[A + l] = bases_[A + l].build(tables_, at(A + l), X(A + l), map, rows(), same_choices,
                                                 in_lanes_->at(l, work));
        }
    }
}

/// By the bases at hand, which do not turn with it. The largest move, in lengths or radians.
double Nodes::correct(const WindowLayout& layout)
{
    const int k = tables_.rank, n = tables_.n_twists;
    std::ranges::fill(moves_, 0.0);
    const int last = layout.n_nodes() - 1;
    const int first = layout.is_unknown(0) ? 0 : 1, behind = layout.is_unknown(last) ? last + 1 : last;
    in_shares(layout.n_nodes(), least_shared, [&](int slot, int begin, int end) {
        double *y = work_[slot].data(), *twist = y + size_;
        for (int A = std::max(begin, first); A < std::min(end, behind); ++A) {
            Patience::ask();
            const double* phi = violations(A);
            if (std::all_of(phi, phi + k, [](double value) { return value == 0; })) continue;
            std::fill(y, y + n, 0.0);
            for (int c = 0; c < k; ++c) y[c] = -phi[c];
            const OrthogonalBasis& q = bases_[A].q;
            q.solve_R_transposed(y);
            q.apply(y);
            tables_.bodies.to_twist(maps(A), y, twist);
            moves_[A] = size_of(twist);
            place_from(A, A, twist);
        }
    });
    double correction = 0;
    for (const double move : moves_) correction = std::max(correction, move);
    if (correction > 0) for_each_item(layout.n_elements(), least_shared, [&](int e) { take_differences(e); });
    return correction;
}

}   // namespace livens
