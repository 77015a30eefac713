// The whole matrix of lobatto(p): all elements at once, reduced to what the joints leave free.
#pragma once

#include <span>
#include <vector>

#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"
#include "livens/solvers/report.h"
#include "livens/solvers/sparse.h"

namespace livens {

/// d(rows of nodes 0..n-1)/d(unknowns of nodes 1..n) along a motion that solves the rows; X and the momenta
/// are given at node 0.   (docs/theory.md, "The whole matrix of lobatto")
///
/// shape    n f square, f = twists less rank of the joints; row A f + i, column (B - 1) f + j
/// unit     1/s: rows and unknowns are in mass-orthonormal coordinates
struct WholeMatrix {
    int n_nodes = 0;    ///< n + 1
    int n_twists = 0;   ///< numbers a twist: six a body, three a point mass
    int freedoms = 0;   ///< f
    SparseMatrix matrix;
    /// Directions D_A Z_A of the free motions at node A, one after the other: plain twists [dphi, w] in world
    /// axes, orthonormal in the metric of definite masses.
    std::vector<double> directions;

    std::span<const double> direction(int A, int i) const
    {
        return std::span(directions)
            .subspan(static_cast<std::size_t>(A * freedoms + i) * static_cast<std::size_t>(n_twists),
                     static_cast<std::size_t>(n_twists));
    }
};

/// `motion` was solved with lobatto(p) and is complete. The work grows linearly with the number of elements.
WholeMatrix whole_matrix(const Model& model, const Motion& motion);

/// Condition numbers of the whole matrix and the size of its sparse factors into the report; a note where it
/// can not be factorised. Nothing is scaled, so scaled_condition is condition_1. The 2-norm knows no choice
/// of units, axes and bases; the 1-norm feels the bases of the free motions (a factor of f^2 at the very
/// most).
void measure_condition(const Model& model, const Motion& motion, SolveReport& report);

}   // namespace livens
