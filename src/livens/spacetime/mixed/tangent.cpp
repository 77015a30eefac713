// SPDX-License-Identifier: BSD-3-Clause
// The derivative of the rows (P23) by all unknowns: the whole matrix of a block, added element after element
// (docs/theory.md, "The elements of the paper"). Entries come in the same order at every point, so that a
// pattern is found once and holds until a load shows a new entry.
#include "livens/spacetime/mixed/tangent.h"

#include <algorithm>

namespace livens::mixed {

void MatrixEntries::collect()
{
    places_.clear();
    values_ = nullptr;
}

void MatrixEntries::take_down(int row, int column) { places_.emplace_back(row, column); }

void MatrixEntries::make_pattern(int size, SparseMatrix& J)
{
    std::vector<int> ends(static_cast<std::size_t>(size) + 1, 0), rows(places_.size());   // column by column
    for (const auto& [row, column] : places_) ++ends[column + 1];
    for (int c = 0; c < size; ++c) ends[c + 1] += ends[c];
    for (const auto& [row, column] : places_) rows[ends[column]++] = row;
    J.size = size;
    J.column_starts.assign(1, 0);
    J.rows.clear();
    for (int c = 0; c < size; ++c) {
        const auto from = rows.begin() + (c > 0 ? ends[c - 1] : 0), to = rows.begin() + ends[c];
        std::sort(from, to);
        J.rows.insert(J.rows.end(), from, std::unique(from, to));
        J.column_starts.push_back(static_cast<int>(J.rows.size()));
    }
    slots_.clear();
    slots_.reserve(places_.size());
    for (const auto& [row, column] : places_) {
        const auto from = J.rows.begin() + J.column_starts[column];
        const auto to = J.rows.begin() + J.column_starts[static_cast<std::size_t>(column) + 1];
        slots_.push_back(static_cast<int>(std::lower_bound(from, to, row) - J.rows.begin()));
    }
    places_ = {};   // as many as the entries of all elements: nobody needs them any more
}

void MatrixEntries::begin(SparseMatrix& J)
{
    J.values.assign(J.rows.size(), 0.0);
    values_ = J.values.data();
    next_ = 0;
}

Tangent::Tangent(const Equations& equations)
    : equations_(equations), space_(equations.space()), sums_(equations.space())
{}

bool Tangent::evaluate(const Fields& fields, SparseMatrix& J)
{
    bool is_new = J.size != space_.size();
    if (is_new) make_pattern(J);
    for (;;) {
        entries_.begin(J);
        add_all(&fields);
        // Loads show where their tangents differ from zero as they go: one more entry, one more pattern.
        if (!sums_.loads.has_grown()) return is_new;
        make_pattern(J);
        is_new = true;
    }
}

void Tangent::make_pattern(SparseMatrix& J)
{
    entries_.collect();
    add_all(nullptr);
    entries_.make_pattern(space_.size(), J);
}

/// All entries, always in the same order; without fields their places alone count.
void Tangent::add_all(const Fields* fields)
{
    for (int e = 0; e < space_.functions.n_elements(); ++e) {
        if (fields != nullptr) sums_.integrate(*fields, e);
        add_momenta(e);
        add_forces(e);
        add_constraints(e);
    }
    add_boundary(fields);
}

/// Rows dP: X' - P m^-1.
void Tangent::add_momenta(int e)
{
    const Coordinates& m = space_.coordinates;
    const int first = space_.functions.first(e), n = space_.functions.n_local();
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) {
            const int row = space_.numbering.row_dP(first + a);
            const int X = space_.numbering.X(first + b), P = space_.numbering.P(first + b);
            if (row < 0) continue;
            const double MM = sums_.MM[sums_.pair(a, b)], MD = sums_.MD[sums_.pair(a, b)];
            if (X >= 0)
                for (int i = 0; i < m.size; ++i) entries_.add(row + i, X + i, MD);
            if (P < 0) continue;
            for (int body = 0; body < m.n_bodies(); ++body) {
                const Matrix4& inverse = m.inverse_masses[body];
                for (int i = 0; i < m.n_numbers(body); ++i)
                    for (int k = i % 3; k < m.n_numbers(body); k += 3)
                        if (inverse(k / 3, i / 3) != 0)
                            entries_.add(row + m.first[body] + i, P + m.first[body] + k,
                                         -MM * inverse(k / 3, i / 3));
            }
        }
}

/// Rows dX by X and P: momentum, geometric terms, loads.
void Tangent::add_forces(int e)
{
    const Coordinates& m = space_.coordinates;
    const int first = space_.functions.first(e), n = space_.functions.n_local();
    for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) {
            const int row = space_.numbering.row_dX(first + a);
            const int X = space_.numbering.X(first + b), P = space_.numbering.P(first + b);
            if (row < 0) continue;
            const std::size_t pair = sums_.pair(a, b);
            const double inertia = space_.is_natural ? -sums_.MD[sums_.pair(b, a)] : sums_.MD[pair];
            if (P >= 0)
                for (int i = 0; i < m.size; ++i) entries_.add(row + i, P + i, inertia);
            if (X < 0) continue;
            const double* K = sums_.K.data() + pair * m.n_rows();
            for (const HessianEntry& entry : m.hessian_entries)
                entries_.add(row + entry.coordinate_i, X + entry.coordinate_j, K[entry.row] * entry.value);
            for (std::size_t l = 0; l < sums_.loads.blocks().size(); ++l) {
                const LoadSums::Block& block = sums_.loads.blocks()[l];
                const int by = m.first[block.body_by], of = m.first[block.body_of];
                const double* sums = sums_.loads.of(pair, l);
                for (int i = 0; i < 144; ++i)
                    if (block.entries[static_cast<std::size_t>(i)])
                        entries_.add(row + by + i % 12, X + of + i / 12, -sums[i]);
            }
        }
}

/// Multipliers in the rows dX, and the rows dlambda, which are their transposes.
void Tangent::add_constraints(int e)
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
            const double* G = sums_.G.data() + (static_cast<std::size_t>(a) * n_L + b) * gradient.size();
            for (std::size_t i = 0; i < gradient.size(); ++i) {
                const GradientEntry& entry = gradient[i];
                const int coordinate = entry.coordinate;
                if (row_dX >= 0 && lambda >= 0) entries_.add(row_dX + coordinate, lambda + entry.row, G[i]);
                if (row_dX >= 0 && tie != nullptr)
                    for (const auto& [C, factor] : tie->terms)
                        entries_.add(row_dX + coordinate, numbering.lambda(C) + entry.row, factor * G[i]);
                if (row_dlambda >= 0 && X >= 0) entries_.add(row_dlambda + entry.row, X + coordinate, G[i]);
            }
        }
}

/// Given momenta that turn with an unknown X.
void Tangent::add_boundary(const Fields* fields)
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
                    entries_.add(row + first + r, X + first + c, at_end ? tangent(r, c) : -tangent(r, c));
        }
    }
}

}   // namespace livens::mixed
