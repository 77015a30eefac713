// SPDX-License-Identifier: BSD-3-Clause
// The functions of the march kernel, which each set of instructions has of its own.
#pragma once

#include "livens/dynamics/lanes/lanes.h"

namespace livens::lanes {

/// The numbers of one element; lanes over rows, one for each node of a column, or as said.
struct Rule {
    const double* k;              ///< k_AB / h
    const double* inverse;        ///< - h K^-1, lanes over columns
    const double* weights;        ///< h w_A; one
    const double* M;              ///< M_B(s_c), lanes over load points
    const double* dM;             ///< M_B'(s_c) / h
    const double* M_rows;         ///< M_A(s_c), one for each load point
    const double* load_weights;   ///< h times those of load points; 0 in lanes behind them
    const double* momentum;       ///< at the start, n_twists scalars: of row 0
    const double* share;          ///< c_A of all rows in start_rates, lanes; null: none has one
    const double* start_rates;    ///< 12 a body, about its centre of mass
    double length;
    bool in_still_axes = false;   ///< turns, on the way from rows to a step
};

struct Sizes {
    double rows = 0;     ///< largest row once multipliers have taken their part
    double terms = 0;    ///< before
    double step = 0;     ///< in lengths and radians
    double motion = 0;   ///< inside the element
    double finite = 0;   ///< not finite if something is not
};

/// M (i, k; A): n rows, f columns, at p nodes of their own.
struct BlockSize {
    int n, f, p;
};

/// Rows of a joint, freedoms of the body that it holds and of that one's parent, and nodes.
struct JointSize {
    int m, d, n, p;
};

/// Of dense blocks, row by row, whose rows and columns are numbers at p nodes: (i, A) is row i p + A.
struct BlockFunctions {
    /// out (k, A; .) += sum_i M (i, k; A) J (i, A; .), rows of `out` that far apart.
    void (*add_from_left)(const double* M, const BlockSize&, const double* J, int columns, double* out,
                          int apart);
    /// out (.; k, B) += sum_j J (.; j, B) M (j, k; B); transposed: M (k, j; B).
    void (*add_from_right)(const double* J, int rows, const double* M, const BlockSize&, bool transposed,
                           double* out);
    /// to -= a b
    void (*subtract_product)(double* to, const double* a, const double* b, int rows, int inner, int columns);
    /// y -= A x
    void (*subtract_times)(double* y, const double* A, int rows, int columns, const double* x);
    /// A square A as its factor with exchanged rows. False: singular, or no number.
    bool (*factorise_square)(double* A, int* exchanged, int n);
    /// x <- A^-1 x for all columns.
    void (*solve_square)(const double* A, const int* exchanged, int n, double* x, int columns);
    /// From rows own (m, d; A) and above (m, n; A): z (d, d - m; A) spans what they leave free, and
    /// y = T y_parent with T (d, n; A) fulfils them. False: with the same order of twists at all nodes what
    /// is left of a row or twist across those before is less than `least` of it, or there are too few nodes.
    bool (*move_joint)(const double* own, const double* above, const JointSize&, double least, double* z,
                       double* T);
};

/// Of a program of loads, in W lanes.
struct LoadFunctions {
    /// Of X and X' at the load points only what it looks at, into its registers.
    void (*interpolate_arms)(const LoadProgram&, const double* start, const double* increments,
                             const double* M, const double* dM);
    /// Loads there, and what they are at the nodes of rows.
    void (*run)(const LoadProgram&, const double* X, const double* V, const double* factors, double* F);
    void (*share_out)(const LoadProgram&, const double* factors, const double* M_rows, double* loads);
    void (*share_columns)(const LoadProgram&, const double* at_points, const double* M_rows, double* loads);
};

/// The functions of one set of instructions for W lanes.
struct Functions {
    int width;
    /// Places of n nodes from those of the element before: weights, for each of its lanes and last for its
    /// start a row of lanes. Lanes that stand for no node stay at the start.
    void (*extrapolate)(int n_bodies, int n, const double* before, const double* weights, double* place);
    /// Numbers and increments from places; then gradients and violations.
    void (*configure)(const Pattern&, const Values& start, const Values& nodes);
    /// Products and gradients of quadratic forms, from the other numbers, scaled to norm one.
    void (*unit_rows)(const Pattern&, const Values& nodes, const UnitRows&);
    /// The factor, from gradients.
    void (*factorise)(const Pattern&, const Values& nodes);
    /// X and X' at the load points.
    void (*interpolate)(const Pattern&, const Values& start, const Values& nodes, const Rule&);
    /// Balances, less what multipliers take.
    void (*balance)(const Pattern&, const Values& start, const Values& nodes, const Rule&, bool first,
                    Sizes&);
    /// A step towards the solution, of free bodies.
    void (*propose)(const Pattern&, const Values& nodes, const Rule&);
    /// The part of a step that constraints leave free, and what mends their violations.
    void (*project)(const Pattern&, const Values& nodes);
    /// Places moved by the step.
    void (*move)(const Pattern&, const Values& nodes, const Rule&, Sizes&);
    /// Twist rows, about the centres, of what multipliers take at all nodes: 6 scalars a body.
    void (*sum_impulses)(const Pattern&, const Values& start, const Values& nodes, double* sum);
    const LoadFunctions* loads;
    const BlockFunctions* blocks;
};

/// For at least so many lanes, on the registers that are in use; null: there are none.
const Functions* functions(int n);
const Functions* sse2(int n);
const Functions* avx2(int n);
const Functions* avx512(int n);

}   // namespace livens::lanes
