// SPDX-License-Identifier: BSD-3-Clause
// Masses of an element are products of all its nodes with each other (MassProducts). The rest comes body by
// body: it is gathered as J_AB Z_B, n x f, and multiplied by Z_A^T once the pair is closed (docs/theory.md,
// "The tangent").
#include "livens/spacetime/nodal/pair_blocks.h"

#include <algorithm>

#include "livens/solvers/patience.h"
#include "livens/solvers/short_rows.h"
#include "livens/spacetime/nodal/nodes.h"
#include "livens/spacetime/nodal/window_blocks.h"

namespace livens {

PairBlocks::PairBlocks(const ModelTables& tables, int degree, BlockMatrix& matrix)
    : tables_(tables), f_(tables.freedoms()), matrix_(matrix), masses_(tables, degree + 1),
      product_(static_cast<std::size_t>(tables.n_twists * f_ + register_room), 0.0),
      row_(static_cast<std::size_t>(f_ + register_room), 0.0)
{}

/// Sets the blocks of all pairs: the product of (A, B) is the transpose of that of (B, A). All nodes but the
/// ends of a window have rows and unknowns.
bool PairBlocks::take_masses(int e, const std::vector<double>& k, double h)
{
    const WindowLayout& layout = *layout_;
    const int f = f_, p = layout.degree, first = e * p;
    if (f == 0) return true;   // there is no matrix
    const int stride = matrix_.stride(e);
    const auto at = [&](int a, int b) {
        return matrix_.block(e, place_of_row(layout, first + a), first + b);
    };
    std::vector<double> by_row(static_cast<std::size_t>(p + 1)), by_column(by_row);
    for (int part = 0; part < masses_.n_parts(); ++part) {
        for (int a = 0; a <= p; ++a)
            masses_.place(part, a, nodes_->X(first + a), nodes_->maps(first + a), z_.at(first + a));
        for (int a = 0; a <= p; ++a) {
            if (f >= 64) Patience::ask();
            masses_.multiply(a);
            // with radau k is not symmetric
            for (int b = 0; b <= p; ++b) {
                by_row[b] = k[a * (p + 1) + b] / h;
                by_column[b] = k[b * (p + 1) + a] / h;
            }
            int begin = layout.is_unknown(first + a) ? a : a + 1,
                end = layout.is_unknown(first + p) ? p : p - 1;
            if (layout.is_active(first + a) && begin <= end)
                masses_.put_rows({at(a, begin), stride, begin, end}, a, by_row.data(), part > 0);
            begin = a + 1;
            end = layout.is_active(first + p) ? p : p - 1;
            if (layout.is_unknown(first + a) && begin <= end)
                masses_.put_columns({at(begin, a), stride, begin, end}, a, by_column.data(), part > 0);
        }
    }
    return true;
}

void PairBlocks::block(int body_i, int body_j, const double* values)
{
    const BodyTables& bodies = tables_.bodies;
    const double* z = z_.at(B_) + bodies[body_j].first * f_;
    const int f = f_;
    for (int i = 0; i < bodies[body_i].dofs; ++i) {
        double* __restrict v = product_.data() + (bodies[body_i].first + i) * f;
        for (int k = 0; k < bodies[body_j].dofs; ++k) {
            const double s = values[6 * i + k];
            if (s != 0) subtract_scaled(v, -s, z + k * f, f);
        }
    }
}

/// The block at (A, B) += Z_A^T product.
void PairBlocks::close()
{
    const int f = f_;
    if (f == 0) return;
    if (f >= 64) Patience::ask();
    const RowFunctions& rows = row_functions();
    const double* z = z_.at(A_);
    double* to = matrix_.block(e_, place_of_row(*layout_, A_), B_);
    const int stride = matrix_.stride(e_);
    for (int i = 0; i < f; ++i, to += stride) {
        rows.product(row_.data(), {z + i, f, product_.data(), f, tables_.n_twists}, f);
        subtract_scaled(to, -1, row_.data(), f);
    }
}

}   // namespace livens
