// SPDX-License-Identifier: BSD-3-Clause
// Dense blocks of a tangent on the null spaces of nodes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "livens/solvers/blocks.h"
#include "livens/spacetime/nodal/mass_products.h"
#include "livens/spacetime/nodal/tangent.h"

namespace livens::inline spacetime_internal {

/// The null spaces of nodes, n x f row by row each, one after the other.
struct NullSpacesOfNodes {
    const double* z = nullptr;
    int n = 0, f = 0;

    const double* at(int A) const { return z + static_cast<std::ptrdiff_t>(A) * n * f; }
};

/// Puts the blocks Z_A^T J_AB Z_B of all pairs of nodes into a matrix.
class PairBlocks final : public TangentSink {
public:
    /// References must outlive it.
    PairBlocks(const ModelTables& tables, int degree, BlockMatrix& matrix);

    /// What outlives the tangent that is formed then.
    void begin(const WindowLayout& layout, const Nodes& nodes, const NullSpacesOfNodes& z)
    {
        layout_ = &layout;
        nodes_ = &nodes;
        z_ = z;
    }
    void open(int e, int A, int B) override
    {
        e_ = e;
        A_ = A;
        B_ = B;
        std::ranges::fill(product_, 0.0);
    }
    void mass(int, double, const double*) override {}   // all are taken together
    bool take_masses(int e, const std::vector<double>& k, double h) override;
    void block(int body_i, int body_j, const double* values) override;
    void close() override;

private:
    const ModelTables& tables_;
    int f_;
    BlockMatrix& matrix_;
    MassProducts masses_;
    const WindowLayout* layout_ = nullptr;
    const Nodes* nodes_ = nullptr;
    NullSpacesOfNodes z_;
    int e_ = 0, A_ = 0, B_ = 1;     // the open pair
    std::vector<double> product_;   // block of the tangent times the null space at B, n x f
    std::vector<double> row_;       // of Z_A^T times it
};

}   // namespace livens::inline spacetime_internal
