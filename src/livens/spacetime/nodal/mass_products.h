// SPDX-License-Identifier: BSD-3-Clause
// What the mass of bodies makes of two nodes' null spaces.
#pragma once

#include <cstddef>
#include <vector>

#include "livens/dynamics/rows/tables.h"

namespace livens::inline spacetime_internal {

/// Z_A^T D_A^T N_A^T m N_B D_B Z_B for all pairs of nodes of an element (docs/theory.md, "The tangent"): one
/// product of N D Z at all nodes with itself, mass between, whose rows are long.
class MassProducts {
public:
    MassProducts(const ModelTables& tables, int n_nodes);

    /// Of local node a: its null space Z, n x f row by row.
    void place(int a, const double* X, const double* maps, const double* Z);
    /// product() <- rows i < f of local node a, stride() apart, by columns (b, j) of nodes b >= a: number
    /// (b - a) f + j.
    void multiply(int a);
    const double* product() const { return product_.data(); }
    std::ptrdiff_t stride() const { return stride_; }

private:
    /// `first`: of the body's rows among all.
    void place_body(int body, int first, std::ptrdiff_t column, const double* maps, const double* X,
                    const double* z);

    const ModelTables& tables_;
    int f_, n_nodes_, n_rows_ = 0;
    std::ptrdiff_t stride_;   // room for whole registers behind the last node
    /// Of a body the velocity of its centre, scaled by the root of its mass, and of rigid ones the rates of its
    /// three directors; nodes side by side. `weighed_`: director rates times E.
    std::vector<double> rates_, weighed_, product_;
};

}   // namespace livens::inline spacetime_internal
