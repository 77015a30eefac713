// SPDX-License-Identifier: BSD-3-Clause
// The whole matrix of a block: its pattern is found once, then element after element adds to it.
#include <algorithm>
#include <cassert>

#include "livens/spacetime/mixed/equations.h"

namespace livens::mixed {

bool Equations::tangent(const Fields& fields, SparseMatrix& J)
{
    bool is_new = false;
    if (J.size != size()) {
        make_pattern(J);
        is_new = true;
    }
    for (;;) {
        std::fill(J.values.begin(), J.values.end(), 0.0);
        std::size_t k = 0;
        visit_all(&fields, [&](int, int, double value) { J.values[slots_[k++]] += value; });
        assert(k == slots_.size());
        // Loads show where their tangents differ from zero as they go: one more entry, one more pattern.
        bool is_complete = true;
        for (LoadBlock& block : load_blocks_) {
            is_complete = is_complete && block.seen == block.emitted;
            block.emitted = block.seen;
        }
        if (is_complete) return is_new;
        make_pattern(J);
        is_new = true;
    }
}

void Equations::make_pattern(SparseMatrix& J)
{
    const std::size_t n = static_cast<std::size_t>(size());
    std::vector<std::size_t> starts(n + 1, 0);
    visit_all(nullptr, [&](int, int column, double) { ++starts[static_cast<std::size_t>(column) + 1]; });
    for (std::size_t c = 0; c < n; ++c) starts[c + 1] += starts[c];
    std::vector<int> all(starts.back());
    std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
    visit_all(nullptr, [&](int row, int column, double) { all[next[column]++] = row; });

    J.size = size();
    J.column_starts.assign(1, 0);
    J.rows.clear();
    for (std::size_t c = 0; c < n; ++c) {
        const auto from = all.begin() + static_cast<std::ptrdiff_t>(starts[c]);
        const auto to = all.begin() + static_cast<std::ptrdiff_t>(starts[c + 1]);
        std::sort(from, to);
        J.rows.insert(J.rows.end(), from, std::unique(from, to));
        J.column_starts.push_back(static_cast<int>(J.rows.size()));
    }
    J.values.assign(J.rows.size(), 0.0);
    slots_.clear();
    slots_.reserve(all.size());
    visit_all(nullptr, [&](int row, int column, double) {
        const auto from = J.rows.begin() + J.column_starts[column];
        const auto to = J.rows.begin() + J.column_starts[static_cast<std::size_t>(column) + 1];
        slots_.push_back(static_cast<int>(std::lower_bound(from, to, row) - J.rows.begin()));
    });
}

/// All entries, always in the same order; without fields their values are zero.
template <class Sink>
void Equations::visit_all(const Fields* fields, Sink&& sink)
{
    clear(local_);
    for (int e = 0; e < setup_.space.n_elements(); ++e) {
        if (fields != nullptr) sum_element(*fields, e);
        visit_momenta(e, sink);
        visit_forces(e, sink);
        visit_constraints(e, sink);
    }
    visit_boundary(fields, sink);
}

void Equations::clear(Local& local) const
{
    const Coordinates& m = *setup_.coordinates;
    const std::size_t pairs = static_cast<std::size_t>(n_local()) * n_local();
    const std::size_t with_multipliers = static_cast<std::size_t>(n_local()) * n_local_multipliers();
    local.MM.assign(pairs, 0.0);
    local.MD.assign(pairs, 0.0);
    local.G.assign(with_multipliers * m.gradient_entries.size(), 0.0);
    local.K.assign(pairs * m.n_rows(), 0.0);
    local.loads.assign(pairs * load_blocks_.size() * 144, 0.0);
}

void Equations::sum_element(const Fields& fields, int e)
{
    const Coordinates& m = *setup_.coordinates;
    clear(local_);
    gradients_.resize(m.gradient_entries.size());
    for (int g = 0; g < n_gauss(); ++g) {
        sample(fields, e, g);
        const double w = weight(e, g);
        double gradient[RowTables::gradient_size];
        for (std::size_t i = 0; i < gradients_.size(); ++i) {
            const GradientEntry& entry = m.gradient_entries[i];
            if (i == 0 || m.gradient_entries[i - 1].row != entry.row)
                m.tables.rows.gradient(m.rows[entry.row], {}, sample_.X.data(), gradient);
            gradients_[i] = gradient[12 * entry.side + entry.component];
        }
        for (int a = 0; a < n_local(); ++a) {
            const double value = w * M(e, g)[a];
            for (int b = 0; b < n_local(); ++b) {
                const std::size_t pair = static_cast<std::size_t>(a) * n_local() + b;
                const double MM = value * M(e, g)[b];
                local_.MM[pair] += MM;
                local_.MD[pair] += value * D(e, g)[b];
                double* K = local_.K.data() + pair * m.n_rows();
                for (int k = 0; k < m.n_rows(); ++k) K[k] += MM * sample_.lambda[k];
            }
            for (int b = 0; b < n_local_multipliers(); ++b) {
                const double ML = value * L(e, g)[b];
                double* G = local_.G.data() +
                            (static_cast<std::size_t>(a) * n_local_multipliers() + b) * gradients_.size();
                for (std::size_t i = 0; i < gradients_.size(); ++i) G[i] += ML * gradients_[i];
            }
        }
        if (!load_blocks_.empty()) sum_loads(e, g);
    }
}

void Equations::sum_loads(int e, int g)
{
    const Coordinates& m = *setup_.coordinates;
    LoadTangent tangent;
    int of_load = -1;
    for (std::size_t l = 0; l < load_blocks_.size(); ++l) {
        LoadBlock& block = load_blocks_[l];
        const Load& load = m.tables.model->loads()[block.load];
        if (block.load != of_load) {
            tangent = LoadTangent(load.bodies.size());
            load.tangent(m.tables.loads.arguments(block.load, {time(e, g), Side::middle}, sample_.X.data(),
                                                  sample_.V.data()),
                         tangent);
            of_load = block.load;
        }
        const Matrix<12, 12>& by_X = tangent.X[block.by][block.of];
        const Matrix<12, 12>& by_V = tangent.V[block.by][block.of];
        for (int i = 0; i < 144; ++i) {
            if (by_X.a[i] == 0 && by_V.a[i] == 0) continue;
            block.seen.set(static_cast<std::size_t>(i));
            for (int a = 0; a < n_local(); ++a)
                for (int b = 0; b < n_local(); ++b) {
                    const double value = weight(e, g) * M(e, g)[a];
                    const std::size_t pair = static_cast<std::size_t>(a) * n_local() + b;
                    local_.loads[(pair * load_blocks_.size() + l) * 144 + i] +=
                        value * (M(e, g)[b] * by_X.a[i] + D(e, g)[b] * by_V.a[i]);
                }
        }
    }
}

/// Rows dP: X' - P m^-1.
template <class Sink>
void Equations::visit_momenta(int e, Sink&& sink) const
{
    const Coordinates& m = *setup_.coordinates;
    for (int a = 0; a < n_local(); ++a)
        for (int b = 0; b < n_local(); ++b) {
            const int A = setup_.space.first(e) + a, B = setup_.space.first(e) + b;
            const int row = numbering_.row_dP(A), X = numbering_.X(B), P = numbering_.P(B);
            if (row < 0) continue;
            const std::size_t pair = static_cast<std::size_t>(a) * n_local() + b;
            if (X >= 0)
                for (int i = 0; i < m.size; ++i) sink(row + i, X + i, local_.MD[pair]);
            if (P < 0) continue;
            for (int body = 0; body < m.n_bodies(); ++body) {
                const Matrix4& inverse = m.inverse_masses[body];
                for (int i = 0; i < m.n_numbers(body); ++i)
                    for (int k = i % 3; k < m.n_numbers(body); k += 3)
                        if (inverse(k / 3, i / 3) != 0)
                            sink(row + m.first[body] + i, P + m.first[body] + k,
                                 -local_.MM[pair] * inverse(k / 3, i / 3));
            }
        }
}

/// Rows dX by X and P: momentum, geometric terms, loads.
template <class Sink>
void Equations::visit_forces(int e, Sink&& sink) const
{
    const Coordinates& m = *setup_.coordinates;
    const bool is_natural = setup_.start == Mixed::Start::natural;
    for (int a = 0; a < n_local(); ++a)
        for (int b = 0; b < n_local(); ++b) {
            const int A = setup_.space.first(e) + a, B = setup_.space.first(e) + b;
            const int row = numbering_.row_dX(A), X = numbering_.X(B), P = numbering_.P(B);
            if (row < 0) continue;
            const std::size_t pair = static_cast<std::size_t>(a) * n_local() + b;
            const double inertia =
                is_natural ? -local_.MD[static_cast<std::size_t>(b) * n_local() + a] : local_.MD[pair];
            if (P >= 0)
                for (int i = 0; i < m.size; ++i) sink(row + i, P + i, inertia);
            if (X < 0) continue;
            const double* K = local_.K.data() + pair * m.n_rows();
            for (const HessianEntry& entry : m.hessian_entries)
                sink(row + entry.coordinate_i, X + entry.coordinate_j, K[entry.row] * entry.value);
            for (std::size_t l = 0; l < load_blocks_.size(); ++l) {
                const LoadBlock& block = load_blocks_[l];
                const Load& load = m.tables.model->loads()[block.load];
                const int by = m.first[load.bodies[block.by]], of = m.first[load.bodies[block.of]];
                const double* sums = local_.loads.data() + (pair * load_blocks_.size() + l) * 144;
                for (int i = 0; i < 144; ++i)
                    if (block.emitted[static_cast<std::size_t>(i)])
                        sink(row + by + i % 12, X + of + i / 12, -sums[i]);
            }
        }
}

/// Multipliers in the rows dX, and the rows dlambda, which are their transposes.
template <class Sink>
void Equations::visit_constraints(int e, Sink&& sink) const
{
    const Coordinates& m = *setup_.coordinates;
    const std::size_t n = m.gradient_entries.size();
    for (int a = 0; a < n_local(); ++a)
        for (int b = 0; b < n_local_multipliers(); ++b) {
            const int A = setup_.space.first(e) + a, B = first_multiplier(e) + b;
            const int row_dX = numbering_.row_dX(A), X = numbering_.X(A);
            const int lambda = numbering_.lambda(B);
            const int row_dlambda = numbering_.row_dlambda(setup_.multipliers.first(e) + b);
            const Tie* tie = nullptr;
            for (std::size_t i = 0; lambda < 0 && i < ties_.size(); ++i)
                if (ties_[i].function == B) tie = &ties_[i];
            const double* G = local_.G.data() + (static_cast<std::size_t>(a) * n_local_multipliers() + b) * n;
            for (std::size_t i = 0; i < n; ++i) {
                const GradientEntry& entry = m.gradient_entries[i];
                const int coordinate = entry.coordinate;
                if (row_dX >= 0 && lambda >= 0) sink(row_dX + coordinate, lambda + entry.row, G[i]);
                if (row_dX >= 0 && tie != nullptr)
                    for (const auto& [C, factor] : tie->terms)
                        sink(row_dX + coordinate, numbering_.lambda(C) + entry.row, factor * G[i]);
                if (row_dlambda >= 0 && X >= 0) sink(row_dlambda + entry.row, X + coordinate, G[i]);
            }
        }
}

/// Given momenta that turn with an unknown X.
template <class Sink>
void Equations::visit_boundary(const Fields* fields, Sink&& sink) const
{
    if (setup_.start != Mixed::Start::natural) return;
    const Coordinates& m = *setup_.coordinates;
    for (const bool at_end : {false, true}) {
        const int A = at_end ? setup_.space.size() - 1 : 0;
        const int row = numbering_.row_dX(A), X = numbering_.X(A);
        if (row < 0 || X < 0) continue;
        const EndMomentum& given = at_end ? setup_.at_end : setup_.at_start;
        std::vector<Matrix34> places(given.turning.size(), Matrix34{});
        if (fields != nullptr && !places.empty()) places = end_position(*fields, at_end);
        for (std::size_t body = 0; body < places.size(); ++body) {
            Matrix<12, 12> tangent;
            given.turning[body].at(places[body], &tangent);
            const int first = m.first[body];
            for (int c = 3; c < m.n_numbers(static_cast<int>(body)); ++c)
                for (int r = 0; r < 12; ++r)
                    sink(row + first + r, X + first + c, at_end ? tangent(r, c) : -tangent(r, c));
        }
    }
}

}   // namespace livens::mixed
