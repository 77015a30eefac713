// SPDX-License-Identifier: BSD-3-Clause
// Constraint rows of a mechanism as plain arrays of lanes, for sources that are compiled for several sets of
// instructions. Nothing here may become an inline function that sources with other processor flags share.
#pragma once

#include <cstdint>

namespace livens::lanes {

/// A quantity is W doubles side by side, one of each node. Lane l stands for node l; lane 0 for node p where
/// nodes are unknown (columns), and for node 0, whose values are scalars, where rows are (docs/theory.md,
/// "Without a tangent").
///
/// The numbers of a configuration: 12 of each body (centre of mass, directors), then inner products.
struct Body {
    int first = 0;   ///< twist unknowns from here
    int dofs = 6;
    bool principal = false, loaded = false;
    double root_mass = 1, inverse_root_mass = 1;
    double weight[3] = {};      ///< by root_mass
    double euler[9] = {};       ///< E about the centre of mass, column by column
    double spin[9] = {};        ///< L^-T, column by column
    double root_spin[9] = {};   ///< L, column by column
};

struct Term {
    std::int64_t number;
    double factor;
};
/// Sum i is a constant and the terms begin[i] .. begin[i + 1] - 1.
struct Sums {
    const std::int32_t* begin;
    const Term* terms;
    const double* constants;
};
/// Inner product of two columns, by the places of their first numbers.
struct Columns {
    std::int32_t x, y;
};
/// Two factors of a product.
struct Pair {
    std::int32_t a, b;
};
/// An entry of the factor: products of gradients less products of entries, by the pivot of its column (-1:
/// on the diagonal).
struct Entry {
    std::int32_t gradients_end, entries_end, pivot;
};
/// A lower triangle row by row; the inverse pivots, on the diagonal, end the rows.
struct Triangle {
    const std::int32_t* begin;
    const std::int32_t* column;
    const Entry* entries;
    const Pair* gradients;   ///< pairs of the entries, one entry after the other
    const Pair* products;
};

/// What is known before the numbers: the mechanism and which rows it has, in the order of their elimination.
struct Pattern {
    int n_bodies, n_twists, n_products, n_rows, n_entries;
    const Body* bodies;
    const Columns* products;
    const std::int32_t* row_begin;   ///< of the entries of G, which is sparse, row by row
    const std::int32_t* twist;       ///< column of each
    Sums entries;                    ///< without terms: constant
    Sums violations;
    Triangle factor;
};

/// Arrays of W lanes each; with W = 1 an instant.
struct Values {
    double* numbers;      ///< 12 n_bodies + n_products
    double* increments;   ///< of the same since the start
    double* place;        ///< 7 a body: displacement of the centre, quaternion of the turn in body axes
    double* last_place;   ///< likewise, of the element before
    double* gradients;    ///< entries of G
    double* factor;
    double* violations;   ///< n_rows
    double* impulses;     ///< n_rows
    double* rows;         ///< n_twists: balances
    double* step;         ///< n_twists
    double* work;         ///< n_rows
    double* pivots;       ///< one: the smallest pivot over its row's own square
    double* loads;        ///< 12 a body, lane c: load point c; kernel columns
    double* load_X;       ///< likewise
    double* load_V;
};

}   // namespace livens::lanes
