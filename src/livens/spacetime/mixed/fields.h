// SPDX-License-Identifier: BSD-3-Clause
// The fields X, P and multipliers of one block: their coefficients, which of them are unknown, and their
// values.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "livens/spacetime/mixed/coordinates.h"
#include "livens/spacetime/mixed/functions.h"
#include "livens/spacetime/mixed/numbering.h"

namespace livens::mixed {

/// Coefficients of the fields, function after function.
struct Fields {
    std::vector<double> X0;       ///< n_coordinates: X is X0 + sum_A M_A x_A
    std::vector<double> x;        ///< n_functions x n_coordinates
    std::vector<double> P;        ///< likewise
    std::vector<double> lambda;   ///< n_multiplier_functions x n_rows
};

/// A coefficient of the multipliers that is no unknown but a sum of others.
struct Tie {
    int function;                                ///< of the multipliers
    std::vector<std::pair<int, double>> terms;   ///< functions that are unknown, and their factors
};

/// What fields of a block can be: constant while it is solved.
struct FieldSpace {
    FieldSpace(const Coordinates& coordinates, BlockFunctions functions, const Numbering& numbering,
               Mixed::Start start, Mixed::EndMultiplier end_multiplier);

    const Coordinates& coordinates;
    BlockFunctions functions;
    Numbering numbering;
    bool is_natural;
    std::vector<Tie> ties;

    int size() const { return numbering.size(); }
    Fields zero() const;
    /// fields + factor * increment of the unknowns.
    void add(Fields& fields, std::span<const double> increment, double factor) const;
    /// Makes the tied multipliers of `fields` what their terms say.
    void tie(Fields& fields) const;
    /// The tie of a function of the multipliers; null where it has none.
    const Tie* tie_of(int function) const;

    /// X at an end of the block.
    std::vector<Matrix34> end_position(const Fields& fields, bool at_end) const;
    /// Values at the place s of an element: n_coordinates numbers, multipliers n_rows.
    void evaluate_X(const Fields& fields, int element, double s, double* X) const;
    void evaluate_P(const Fields& fields, int element, double s, double* P) const;
    void evaluate_multipliers(const Fields& fields, int element, double s, double* lambda) const;
};

/// The fields at one Gauss point of an element; a workspace.
struct FieldSample {
    std::vector<double> x, v, p, p_rate;   ///< p_rate where the start is strong
    std::vector<double> X, V;              ///< x and v, 12 numbers a body
    std::vector<double> lambda;

    void take(const FieldSpace& space, const Fields& fields, int e, int g);
};

}   // namespace livens::mixed
