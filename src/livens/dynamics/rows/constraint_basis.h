// SPDX-License-Identifier: BSD-3-Clause
// The directions that joints hold and those they leave free, at one configuration.
#pragma once

#include <vector>

#include "livens/solvers/dense.h"
#include "livens/time/time_function.h"

namespace livens::inline dynamics_internal {

struct ModelTables;

/// Columns D^T Ghat^T / s that somebody else has evaluated: of each row its entries, that far apart.
struct KnownColumns {
    const int* begin = nullptr;   ///< of its first side's entries, then of its second one's
    const int* twist = nullptr;   ///< of each entry
    const double *values = nullptr, *scales = nullptr;   ///< entries, and 1 / s of the rows
    int apart = 0;

    /// A row without entries is not known.
    bool knows(int row) const { return begin != nullptr && begin[2 * row] < begin[2 * row + 2]; }
    /// Returns the scale.
    double take(int row, double* column, int n_twists) const;
};

/// An orthogonal basis of the constraint directions at one configuration, with the scaling of its rows.
struct ConstraintBasis {
    OrthogonalBasis q;       ///< of the columns D^T Ghat^T / s
    std::vector<int> rows;   ///< rank rows of the tables, in the order of the columns
    int longest_gradient = 0;
    std::vector<double> gradients;   ///< so many numbers a row, and its 1 / s, in the same order

    double smallest_pivot = 1;   ///< of the last build() or choose()

    const double* gradient(int column) const { return gradients.data() + (longest_gradient + 1) * column; }
    double row_scale(int column) const { return gradient(column)[longest_gradient]; }
    void resize(const ModelTables& tables, bool all_rows);
    /// The basis for given rows, of which some may be known. Returns the smallest scaled pivot.
    double build(const ModelTables& tables, Instant at, const double* X, const double* maps,
                 const std::vector<int>& which, bool keep_choices, const KnownColumns& known = {});
    /// Chooses the rows by column pivoting among all.
    double choose(const ModelTables& tables, Instant at, const double* X, const double* maps);

private:
    void fill(const ModelTables& tables, int column, int row, Instant at, const double* X, const double* maps,
              const KnownColumns& known);
};

}   // namespace livens::inline dynamics_internal
