// SPDX-License-Identifier: BSD-3-Clause
// The derivative of the rows (P23) by all unknowns: the whole matrix of a block, added element after element
// (docs/theory.md, "The elements of the paper"). Entries come in the same order at every point, so that a
// pattern is found once and holds until a load shows a new entry.
#include "livens/spacetime/mixed/tangent.h"

#include <algorithm>

#include "livens/solvers/crew.h"
#include "livens/solvers/patience.h"

namespace livens::mixed {

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
        EntrySink all{&pattern_, J.values.data(), pattern_.of_ends(), 0, J.size};
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
    EntrySink entries{
        &pattern_, J.values.data(), {}, first_row(functions.first), first_row(functions.second)};
    ElementSums& sums = sums_[static_cast<std::size_t>(slot)];
    for (int e = first; e < last; ++e) {
        Patience::ask();
        sums.integrate(fields, e);
        entries.at = pattern_.of_element(e);
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

/// Numbers by which all rows and unknowns of element e come after those of the one before; 0: they are not
/// alike.
int Tangent::stride_before(int e) const
{
    const BlockFunctions& functions = space_.functions;
    const Numbering& n = space_.numbering;
    if (e == 0) return 0;
    const int A = functions.first(e), B = functions.first(e - 1);
    const int stride = n.X(A) - n.X(B);
    bool is_alike = stride > 0;
    const auto compare = [&](int here, int before) {
        is_alike = is_alike && before >= 0 && here - before == stride;
    };
    for (int a = 0; a < functions.n_local(); ++a) {
        compare(n.X(A + a), n.X(B + a));
        compare(n.P(A + a), n.P(B + a));
        compare(n.row_dX(A + a), n.row_dX(B + a));
        compare(n.row_dP(A + a), n.row_dP(B + a));
    }
    const int L = functions.first_multiplier(e), K = functions.first_multiplier(e - 1);
    const int test_L = functions.multipliers().first(e), test_K = functions.multipliers().first(e - 1);
    for (int a = 0; a < functions.n_local_multipliers(); ++a) {
        compare(n.lambda(L + a), n.lambda(K + a));
        compare(n.row_dlambda(test_L + a), n.row_dlambda(test_K + a));
    }
    return is_alike ? stride : 0;
}

/// Of elements that are alike those are taken down whose functions others see, too, and one more.
void Tangent::make_pattern(SparseMatrix& J)
{
    pattern_.collect();
    EntrySink entries;
    entries.pattern = &pattern_;
    const int n = space_.functions.n_elements(), kept = 2 * space_.functions.n_local() + 1;
    for (int first = 0, end = 0; first < n; first = end) {
        for (end = first + 1; end < n; ++end) {
            const int stride = stride_before(end);
            if (stride == 0 || (end > first + 1 && stride != stride_before(end - 1))) break;
        }
        for (int e = first; e < end; ++e) {
            add_element(e, sums_.front(), entries);
            pattern_.end_element();
            if (e != first + kept - 1 || end - first <= 2 * kept) continue;
            const int times = end - first - 2 * kept;
            pattern_.repeat(times, stride_before(e), space_.numbering.X(space_.functions.first(e + 1)));
            e += times;
        }
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
/// Of P: - int M_a' M_b with the natural start, by parts (P10), and int M_a M_b' with the strong one (P11).
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
        if (fields == nullptr) entries.pattern->stand_at(at_end);
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
