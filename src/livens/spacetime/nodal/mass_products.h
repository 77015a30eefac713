// SPDX-License-Identifier: BSD-3-Clause
// What the mass of bodies makes of two nodes' null spaces.
#pragma once

#include <cstddef>
#include <vector>

#include "livens/dynamics/rows/tables.h"

namespace livens::inline spacetime_internal {

/// Z_A^T D_A^T N_A^T m N_B D_B Z_B for all pairs of nodes of an element (docs/theory.md, "The tangent"): one
/// product of N D Z at all nodes with itself, mass between, whose rows are long. Bodies come in parts, which
/// add up: else many of them would take more room than the element's matrix.
class MassProducts {
public:
    MassProducts(const ModelTables& tables, int n_nodes);

    int n_parts() const { return (tables_.n_bodies() + most_bodies - 1) / most_bodies; }
    /// Of local node a, to which Z, n x f row by row, belongs: the bodies of a part, which all nodes then
    /// have.
    void place(int part, int a, const double* X, const double* maps, const double* Z);
    /// product() <- rows i < f of local node a, stride() apart, by columns (b, j) of nodes b >= a: number
    /// (b - a) f + j.
    void multiply(int a);
    const double* product() const { return product_.data(); }
    /// A matrix whose rows are so far apart: its first number of local nodes (first, a), or (a, first).
    struct Block {
        double* at;
        std::ptrdiff_t apart;
        int first, last;   ///< nodes
    };
    /// The rows of multiply(a), at nodes first..last from a on, times factors[b] of node b, put there, or
    /// added where the part is not the first.
    void put_rows(const Block& to, int a, const double* factors, bool adds);
    /// The same transposed, into the columns of node a.
    void put_columns(const Block& to, int a, const double* factors, bool adds);
    std::ptrdiff_t stride() const { return stride_; }

private:
    static constexpr int most_bodies = 8;

    void spread(const Block& to, const double* factors);
    /// `place`: of the body's first row, at a node.
    void place_body(int body, std::ptrdiff_t place, const double* X, const double* maps, const double* z);

    const ModelTables& tables_;
    int f_, n_nodes_, n_rows_ = 0;
    std::ptrdiff_t stride_;   // room for whole registers behind the last node
    /// Of a body the velocity of its centre, scaled by the root of its mass, and of rigid ones the rates of
    /// its three directors; nodes side by side. `weighed_`: director rates times E.
    std::vector<double> rates_, weighed_, product_;
    std::vector<double> factors_;   // one a column
};

}   // namespace livens::inline spacetime_internal
