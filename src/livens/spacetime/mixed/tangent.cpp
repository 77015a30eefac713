// SPDX-License-Identifier: BSD-3-Clause
// The derivative of the rows (P23) by all unknowns: the whole matrix of a block, added element after element
// (docs/theory.md, "The elements of the paper"). Entries come in the same order at every point, so that a
// pattern is found once and holds until a load shows a new entry.
#include "livens/spacetime/mixed/tangent.h"

#include <algorithm>
#include <cstdint>

#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"

namespace livens::mixed {

namespace {

constexpr int least_shared_functions = 16;   // that a thread takes, where there are several

}   // namespace

void MatrixPattern::collect()
{
    places_.clear();
    parts_.assign(1, 0);
}

/// Sorted by rows, then by columns, each by counting.
void MatrixPattern::make(int size, SparseMatrix& J)
{
    const std::size_t n = places_.size();
    std::vector<std::size_t> starts(static_cast<std::size_t>(size) + 1, 0);
    std::vector<std::uint32_t> by_row(n), by_column(n);
    for (const auto& [row, column] : places_) ++starts[row + 1];
    for (int i = 0; i < size; ++i) starts[i + 1] += starts[i];
    for (std::size_t i = 0; i < n; ++i) by_row[starts[places_[i].first]++] = static_cast<std::uint32_t>(i);
    std::ranges::fill(starts, 0);
    for (const auto& [row, column] : places_) ++starts[column + 1];
    for (int i = 0; i < size; ++i) starts[i + 1] += starts[i];
    for (const std::uint32_t i : by_row) by_column[starts[places_[i].second]++] = i;
    J.size = size;
    J.column_starts.assign(1, 0);
    J.rows.clear();
    slots_.resize(n);
    std::size_t k = 0;
    for (int c = 0; c < size; ++c) {
        for (int last = -1; k < n && places_[by_column[k]].second == c; ++k) {
            const int row = places_[by_column[k]].first;
            if (row != last) J.rows.push_back(row);
            last = row;
            slots_[by_column[k]] = static_cast<int>(J.rows.size()) - 1;
        }
        J.column_starts.push_back(static_cast<int>(J.rows.size()));
    }
    places_ = {};   // as many as the entries of all elements: nobody needs them any more
}

Tangent::Tangent(const Equations& equations)
    : equations_(equations), space_(equations.space()), sums_(1, ElementSums(equations.space()))
{}

bool Tangent::evaluate(const Fields& fields, SparseMatrix& J)
{
    while (static_cast<int>(sums_.size()) < Crew::size()) {
        sums_.emplace_back(space_);
        sums_.back().loads.expect(sums_.front().loads);
    }
    bool is_new = J.size != space_.size();
    if (is_new) make_pattern(J);
    for (;;) {
        J.values.assign(J.rows.size(), 0.0);
        in_shares(space_.functions.space().size(), least_shared_functions, [&](int slot, int begin, int end) {
            add_share(fields, J, slot, {begin, end});
        });
        EntrySink all{&pattern_, J.values.data(), pattern_.slots(space_.functions.n_elements()), 0, J.size};
        add_boundary(&fields, all);
        // Loads show where their tangents differ from zero as they go: one more entry, one more pattern.
        LoadSums& seen = sums_.front().loads;
        for (const ElementSums& sums : sums_) seen.see(sums.loads);
        if (!seen.has_grown()) return is_new;
        for (ElementSums& sums : sums_) sums.loads.expect(seen);
        make_pattern(J);
        is_new = true;
    }
}

/// A thread makes all elements of its functions, and of these the rows of its functions.
void Tangent::add_share(const Fields& fields, SparseMatrix& J, int slot, std::pair<int, int> functions)
{
    const auto [first, last] = space_.functions.elements_of(functions.first, functions.second);
    EntrySink entries{&pattern_, J.values.data(), nullptr, first_row(functions.first),
                      first_row(functions.second)};
    ElementSums& sums = sums_[static_cast<std::size_t>(slot)];
    for (int e = first; e < last; ++e) {
        Patience::ask();
        sums.integrate(fields, e);
        entries.slots = pattern_.slots(e);
        add_element(e, sums, entries);
    }
}

/// Of all that a function has; behind the last one their number.
int Tangent::first_row(int function) const
{
    const Numbering& numbering = space_.numbering;
    if (function == 0) return 0;
    return function < numbering.n_functions() - 1 ? numbering.row_dP(function) : numbering.size();
}

void Tangent::make_pattern(SparseMatrix& J)
{
    pattern_.collect();
    EntrySink entries;
    entries.pattern = &pattern_;
    for (int e = 0; e < space_.functions.n_elements(); ++e) {
        add_element(e, sums_.front(), entries);
        pattern_.end_part();
    }
    add_boundary(nullptr, entries);
    pattern_.make(space_.size(), J);
}

/// All entries, always in the same order.
void Tangent::add_element(int e, const ElementSums& sums, EntrySink& entries) const
{
    add_momenta(e, sums, entries);
    add_forces(e, sums, entries);
    add_constraints(e, sums, entries);
}

/// Rows dP: X' - P m^-1.
void Tangent::add_momenta(int e, const ElementSums& sums, EntrySink& entries) const
{
    const Coordinates& m = space_.coordinates;
    const int first = space_.functions.first(e), n = space_.functions.n_local();
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) {
            const int row = space_.numbering.row_dP(first + a);
            const int X = space_.numbering.X(first + b), P = space_.numbering.P(first + b);
            if (row < 0) continue;
            const double MM = sums.MM[sums.pair(a, b)], MD = sums.MD[sums.pair(a, b)];
            if (X >= 0)
                for (int i = 0; i < m.size; ++i) entries.add(row + i, X + i, MD);
            if (P < 0) continue;
            for (int body = 0; body < m.n_bodies(); ++body) {
                const Matrix4& inverse = m.inverse_masses[body];
                for (int i = 0; i < m.n_numbers(body); ++i)
                    for (int k = i % 3; k < m.n_numbers(body); k += 3)
                        if (inverse(k / 3, i / 3) != 0)
                            entries.add(row + m.first[body] + i, P + m.first[body] + k,
                                        -MM * inverse(k / 3, i / 3));
            }
        }
}

/// Rows dX by X and P: momentum, geometric terms, loads.
void Tangent::add_forces(int e, const ElementSums& sums, EntrySink& entries) const
{
    const Coordinates& m = space_.coordinates;
    const int first = space_.functions.first(e), n = space_.functions.n_local();
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) {
            const int row = space_.numbering.row_dX(first + a);
            const int X = space_.numbering.X(first + b), P = space_.numbering.P(first + b);
            if (row < 0) continue;
            const std::size_t pair = sums.pair(a, b);
            const double inertia = space_.is_natural ? -sums.MD[sums.pair(b, a)] : sums.MD[pair];
            if (P >= 0)
                for (int i = 0; i < m.size; ++i) entries.add(row + i, P + i, inertia);
            if (X < 0) continue;
            const double* K = sums.K.data() + pair * m.n_rows();
            for (const HessianEntry& entry : m.hessian_entries)
                entries.add(row + entry.coordinate_i, X + entry.coordinate_j, K[entry.row] * entry.value);
            for (std::size_t l = 0; l < sums.loads.blocks().size(); ++l) {
                const LoadSums::Block& block = sums.loads.blocks()[l];
                const int by = m.first[block.body_by], of = m.first[block.body_of];
                const double* of_load = sums.loads.of(pair, l);
                for (int i = 0; i < 144; ++i)
                    if (block.entries[static_cast<std::size_t>(i)])
                        entries.add(row + by + i % 12, X + of + i / 12, -of_load[i]);
            }
        }
}

/// Multipliers in the rows dX, and the rows dlambda, which are their transposes.
void Tangent::add_constraints(int e, const ElementSums& sums, EntrySink& entries) const
{
    const BlockFunctions& functions = space_.functions;
    const Numbering& numbering = space_.numbering;
    const std::vector<GradientEntry>& gradient = space_.coordinates.gradient_entries;
    const int n_L = functions.n_local_multipliers();
    for (int a = 0; a < functions.n_local(); ++a)
        for (int b = 0; b < n_L; ++b) {
            const int A = functions.first(e) + a, B = functions.first_multiplier(e) + b;
            const int row_dX = numbering.row_dX(A), X = numbering.X(A), lambda = numbering.lambda(B);
            const int row_dlambda = numbering.row_dlambda(functions.multipliers().first(e) + b);
            const Tie* tie = lambda < 0 ? space_.tie_of(B) : nullptr;
            const double* G = sums.G.data() + (static_cast<std::size_t>(a) * n_L + b) * gradient.size();
            for (std::size_t i = 0; i < gradient.size(); ++i) {
                const GradientEntry& entry = gradient[i];
                const int coordinate = entry.coordinate;
                if (row_dX >= 0 && lambda >= 0) entries.add(row_dX + coordinate, lambda + entry.row, G[i]);
                if (row_dX >= 0 && tie != nullptr)
                    for (const auto& [C, factor] : tie->terms)
                        entries.add(row_dX + coordinate, numbering.lambda(C) + entry.row, factor * G[i]);
                if (row_dlambda >= 0 && X >= 0) entries.add(row_dlambda + entry.row, X + coordinate, G[i]);
            }
        }
}

/// Given momenta that turn with an unknown X.
void Tangent::add_boundary(const Fields* fields, EntrySink& entries) const
{
    if (!space_.is_natural) return;
    const Coordinates& m = space_.coordinates;
    for (const bool at_end : {false, true}) {
        const int A = at_end ? space_.numbering.n_functions() - 1 : 0;
        const int row = space_.numbering.row_dX(A), X = space_.numbering.X(A);
        const std::vector<TurningMomentum>& turning = equations_.given(at_end).turning;
        if (row < 0 || X < 0 || turning.empty()) continue;
        std::vector<Matrix34> places;
        if (fields != nullptr) places = space_.end_position(*fields, at_end);
        for (int body = 0; body < m.n_bodies(); ++body) {
            Matrix<12, 12> tangent{};
            if (fields != nullptr) turning[body].at(places[body], &tangent);
            const int first = m.first[body];
            for (int c = 3; c < m.n_numbers(body); ++c)   // p and L do not depend on where the body is
                for (int r = 0; r < 12; ++r)
                    entries.add(row + first + r, X + first + c, at_end ? tangent(r, c) : -tangent(r, c));
        }
    }
}

}   // namespace livens::mixed
