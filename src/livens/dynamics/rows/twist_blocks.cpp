// SPDX-License-Identifier: BSD-3-Clause
// N^T K N of loads and rows, and the maps of scaled twists on both sides (docs/theory.md, "The tangent").
#include "livens/dynamics/rows/twist_blocks.h"

#include <algorithm>
#include <cmath>

#include "livens/dynamics/rows/twist.h"

namespace livens::inline dynamics_internal {

namespace {

/// The map D of one body, column by column, 6 x 6.
void fill_map(const BodyTable& body, const double* maps, double* D)
{
    std::fill(D, D + 36, 0.0);
    for (int c = 0; c < 3; ++c) D[7 * c] = body.inverse_root_mass;
    if (body.dofs == 3) return;
    for (int c = 0; c < 3; ++c) {
        const double* w = maps + 3 * c;
        double* column = D + 18 + 6 * c;
        column[0] = maps[10] * w[2] - maps[11] * w[1];
        column[1] = maps[11] * w[0] - maps[9] * w[2];
        column[2] = maps[9] * w[1] - maps[10] * w[0];
        for (int r = 0; r < 3; ++r) column[3 + r] = w[r];
    }
}

}   // namespace

/// The map of a point mass has three columns: rows and columns behind them come out as zero.
void scale_block(const ModelTables& tables, const double* maps_A, int i, const double* maps_B, int j,
                 const double* block, double* out)
{
    double left[36], right[36], columns[36];
    fill_map(tables.bodies[i], maps_A + 12 * i, left);
    fill_map(tables.bodies[j], maps_B + 12 * j, right);
    for (int r = 0; r < 6; ++r) {   // the first columns of a map have one entry each
        for (int c = 0; c < 3; ++c) columns[6 * r + c] = block[6 * r + c] * right[7 * c];
        for (int c = 3; c < 6; ++c) {
            double sum = 0;
            for (int k = 0; k < 6; ++k) sum += block[6 * r + k] * right[6 * c + k];
            columns[6 * r + c] = sum;
        }
    }
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 6; ++c) out[6 * r + c] = left[7 * r] * columns[6 * r + c];
    for (int r = 3; r < 6; ++r) {
        for (int c = 0; c < 6; ++c) {
            double sum = 0;
            for (int k = 0; k < 6; ++k) sum += left[6 * r + k] * columns[6 * k + c];
            out[6 * r + c] = sum;
        }
    }
}

/// Column by column: dX = N(X_column) e_j, dF = K dX, and N(X_row)^T dF.
void add_reduced(const Matrix<12, 12>& K, const double* X_row, const double* X_column, int dofs,
                 double* block)
{
    for (int j = 0; j < dofs; ++j) {
        double unit[6] = {0, 0, 0, 0, 0, 0}, dX[12], dF[12], row[6] = {0, 0, 0, 0, 0, 0};
        unit[j] = 1;
        twist::columns(X_column, unit, dX);
        for (int r = 0; r < 12; ++r) {
            dF[r] = 0;
            for (int c = 0; c < 12; ++c) dF[r] += K(r, c) * dX[c];
        }
        twist::rows(X_row, dF, row);
        for (int r = 0; r < 6; ++r) block[6 * r + j] += row[r];
    }
}

/// A force on the place is scaled by 1 / sqrt(M) and, with its arm to the centre of mass, by L^-1; those on
/// directors, which have norm one, by L^-1 alone.
double load_terms(const ModelTables& tables, const Load& load, const LoadArguments& at,
                  const LoadTangent& tangent)
{
    double size = 0;
    for (std::size_t r = 0; r < load.n_acted; ++r) {
        if (load.bodies[r] == world) continue;
        const auto& body = tables.bodies[load.bodies[r]];
        double root = 0;
        for (const double l : body.spin) root = std::max(root, std::abs(l));
        for (int i = 0; i < 12; ++i) {
            double term = 0;
            for (std::size_t c = 0; c < load.bodies.size(); ++c)
                for (int k = 0; k < 12; ++k)
                    term += std::abs(tangent.X[r][c](i, k) * at.X[c].a[k]) +
                            std::abs(tangent.V[r][c](i, k) * at.V[c].a[k]);
            size = std::max(size, term * (i < 3 ? body.inverse_root_mass + body.reach * root : root));
        }
    }
    return size;
}

}   // namespace livens::inline dynamics_internal
