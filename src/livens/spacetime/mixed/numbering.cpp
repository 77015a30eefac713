// SPDX-License-Identifier: BSD-3-Clause
// Which coefficients of (P23) are unknown and which rows are solved for them, by what is given at both ends
// (docs/theory.md, "The elements of the paper": the table in Natural and strong). Numbers go up with time,
// function after function, so that what couples stands together in the matrix.
#include "livens/spacetime/mixed/numbering.h"

#include <algorithm>

namespace livens::mixed {

Numbering::Numbering(const Given& given, Mixed::Start start, Mixed::Multipliers multipliers, int n,
                     int n_coordinates, int n_rows, const std::vector<int>& torn)
{
    const bool is_natural = start == Mixed::Start::natural;
    const bool is_equal = multipliers == Mixed::Multipliers::equal;
    const auto at_ends = [&](int A, bool first, bool last) {
        return !((A == 0 && !first) || (A == n - 1 && !last));
    };
    const bool opens_left = is_natural && !given.P_at_last;
    const auto number = [](std::vector<int>& places, bool is_there, int& count, int how_many) {
        places.push_back(is_there ? count : -1);
        if (is_there) count += how_many;
    };
    for (int A = 0; A < n; ++A) {
        const bool X = at_ends(A, !given.X_at_start, !given.X_at_end);
        const bool P = is_natural || at_ends(A, !given.P_at_start, !given.P_at_end);
        const bool dX = is_natural ? at_ends(A, given.P_at_start, given.P_at_end) : X;
        number(X_, X, n_unknowns_, n_coordinates);
        number(P_, P, n_unknowns_, n_coordinates);
        number(row_dP_, P, n_equations_, n_coordinates);
        number(row_dX_, dX, n_equations_, n_coordinates);
        if (!is_equal && A == n - 1) break;
        const bool is_torn = is_equal && std::binary_search(torn.begin(), torn.end(), A);
        if (is_torn && opens_left) number(lambda_, false, n_unknowns_, n_rows);
        number(lambda_, is_equal ? dX : true, n_unknowns_, n_rows);
        if (is_torn && !opens_left) number(lambda_, false, n_unknowns_, n_rows);
        number(row_dlambda_, is_equal ? X : true, n_equations_, n_rows);
    }
}

}   // namespace livens::mixed
