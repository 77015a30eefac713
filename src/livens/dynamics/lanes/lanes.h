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
    double still[9] = {};       ///< - L^T E / det L, column by column: see docs/theory.md, "Still axes"
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
/// An entry of the gradient of one row that never changes.
struct Unit {
    double value;
    std::int32_t twist;
};
/// Entries of the gradients of a group by one twist: of its rows, one after the other.
struct Column {
    std::int32_t twist, entry;
};
/// Products of a block with one of another group, over the n rows of a group before both.
struct Product {
    std::int32_t a, b, n;
};
/// Of the factor, at the rows of its group and the columns of a group before: column by column from `entry`.
struct Block {
    std::int32_t first, n;   ///< rows of the group before
    std::int32_t diagonal;   ///< entry of that group
    std::int32_t entry;
    std::int32_t pairs,
        products;   ///< from here to those of the next block: columns of both that share a twist
};
/// Rows of a joint that are eliminated together.
struct Group {
    static constexpr int most = 5;   ///< of them; four are two and two
    std::int32_t first, n;
    std::int32_t columns, blocks;   ///< from here to those of the next group
    std::int32_t diagonal;          ///< lower triangle row by row; the inverse pivots end its rows
};

/// Gradients: entries that never change row by row, others by columns.
struct GradientPattern {
    const std::int32_t* unit_begin;   ///< of each row
    const Unit* units;
    const Column* columns;
    Sums entries;   ///< without terms: constant
};
/// Entries of gradients, row by row, and what they are multiplied by.
struct UnitRows {
    const std::int32_t* begin;   ///< of the entries of a row's first side, then of its second one
    double *entries, *scales;
};

/// The factor of G G^T.
struct FactorPattern {
    const Block* blocks;
    const Pair* pairs;
    const Product* products;
    const double* constants;   ///< of each entry: products of units
};

/// A part of an entry of the gradients: the weight of a form times a sum.
struct WeightedEntry {
    std::int32_t entry, form;
    bool is_first;   ///< of its entry
};
struct Values;
/// Forms that rows have times weights, which are functions of time or of all forms of the row.
struct FormPattern {
    int n_forms, n_rows, n_entries;   ///< rows that have some
    Sums values;                      ///< of each form
    const WeightedEntry* entries;
    Sums gradients;             ///< of each weighted entry, without its weight
    const std::int32_t* rows;   ///< the place of each of n_rows
    /// Weights of functions of forms, and how the rows change by forms, from how forms have changed.
    void (*weigh)(const void* caller, const Values& start, const Values& nodes, int width);
    const void* caller;
};

/// What is known before the numbers: the mechanism and which rows it has, in the order of their elimination.
/// Of groups and blocks there is one more, behind the last.
struct Pattern {
    int n_bodies, n_twists, n_products, n_rows, n_groups, n_entries;
    const Body* bodies;
    const Columns* products;
    const Group* groups;
    GradientPattern gradients;
    FactorPattern factor;
    Sums violations;
    FormPattern forms;
};

/// What a step of loads does; the kinds of multibody/loads/load_tape.h that are evaluated in lanes.
enum class LoadKind : std::int32_t {
    arm,   ///< sum of terms, of registers
    plus,
    minus,
    times,
    divided,
    scaled,
    shifted,
    root,
    absolute,
    inverse,
    least,
    greatest,
    chosen,
    function,
    turn,
    unwrapped,
    outer,
    sum,
    difference,
    stretched,
    cross,
    dot,
    pull,         ///< register `to` of an arm's force += a times b
    first_pull,   ///< likewise, =
    pull_one,     ///< of one of its numbers, += number times a
    // a and what nobody else takes
    plus_scaled,    ///< a + number b
    plus_product,   ///< a + b c, or a - b c with number -1
    plus_dot        ///< a + b . c
};
/// Registers of W lanes by their numbers; three in a row are a vector.
struct LoadStep {
    LoadKind kind;
    std::int32_t to, a, b;
    std::int32_t begin, end;   ///< terms of an arm; of a call its number, and how many results; c
    double number;
    double (*function)(double, double);
    void (*turn)(double, double, double*) = nullptr;   ///< one lane
};
/// Column of the forces on a body: a sum of arms' forces, of their first registers.
struct LoadColumn {
    std::int32_t number;   ///< its first
    std::int32_t begin, end;
};
/// Three numbers of X that loads look at, or of X', from those of a body's columns: a material vector, or
/// where there are more of these than columns a column itself.
struct LoadArm {
    std::int32_t begin, end;   ///< terms
    std::int32_t to, rate;     ///< registers; -1: nobody looks at it
};
/// Forces on a material vector, or on a column, and the columns that they belong to.
struct LoadForce {
    std::int32_t begin, end;    ///< terms, of registers
    std::int32_t first, last;   ///< terms, of numbers of F
};
/// Loads at their points: one lane a point, of which there are n; lanes behind them are as the last one.
struct LoadProgram {
    int n_lanes, n_steps, n_columns, n_arms, n_forces;
    const LoadStep* steps;
    const LoadColumn* columns;
    const LoadArm* arms;
    const LoadForce* forces;
    const Term* terms;
    double* registers;
    double* turns;   ///< of angles at the instant before; they go on
    /// What no step says, in one lane.
    void (*call)(void* caller, const LoadStep& step, int lane);
    void* caller;
};

/// Of weighted forms.
struct FormValues {
    double* values;    ///< with one lane; else how they have changed since the start
    double* weights;   ///< of each
    double* by_rows;   ///< of each row that has forms: the part of its violation
};

/// 12 numbers a body; kernel columns.
struct LoadValues {
    double* F;   ///< at the nodes of rows
    double* X;   ///< lane c: load point c
    double* V;
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
    FormValues forms;
    LoadValues at_loads;
};

}   // namespace livens::lanes
