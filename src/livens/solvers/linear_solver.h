// SPDX-License-Identifier: BSD-3-Clause
// Direct solvers of systems in blocks.
#pragma once

#include <memory>
#include <span>

#include "livens/solvers/blocks.h"

namespace livens::inline solvers_internal {

enum class Outcome { regular, singular, not_finite };

struct LinearReport {
    long long factor_entries = 0;   ///< numbers that the solver keeps of a factorisation
    long long flops = 0;            ///< of products with pivot rows, if all are eliminated; 0: not known
    double smallest_pivot = 0;      ///< smallest |u_kk| of the factors; 0: not known
    double largest_entry = 0;       ///< largest |u_ij|; 0: not known. Far above the entries of the matrix it
                                    ///< tells of lost digits
    int singular_node = -1;         ///< of the unknown that the matrix does not determine; -1: none, or not
                                    ///< known
};

/// Factors of a matrix in blocks, made again and again for one structure. One thread at a time.
class LinearSolver {
public:
    LinearSolver() = default;
    LinearSolver(const LinearSolver&) = delete;
    LinearSolver& operator=(const LinearSolver&) = delete;
    virtual ~LinearSolver() = default;

    /// To be repeated when the structure changes; for an equal one it costs a comparison. Throws
    /// std::invalid_argument, naming why, where the solver is not made for the structure; it must then be
    /// called again before anything else.
    virtual void analyse(const BlockStructure& structure) = 0;
    /// May use the matrix up: its values are undefined afterwards, its shape stays; clear() before refilling.
    /// Not finite: an entry, or the sum of an element's entries. Throws Stopped where Patience ends.
    virtual Outcome factorise(BlockMatrix& matrix) = 0;
    /// In: right-hand side by rows; out: unknowns. Only after a regular factorisation.
    virtual void solve(std::span<double> x) const = 0;
    /// In: right-hand side by unknowns; out: by rows.
    virtual void solve_transposed(std::span<double> x) const = 0;
    /// Of closing rows alone, all others zero: unknowns of the first node, where these rows see them, of the
    /// last, of the border. The chain's are not refined.
    virtual void solve_closing(std::span<const double> rows, std::span<double> ends) const = 0;
    /// Of the last factorisation. Looks through the factors: not for every solution.
    virtual LinearReport report() const = 0;
};

/// What completes the matrices of chains that are parts of a longer one, in every part.
class ChainEnds {
public:
    ChainEnds() = default;
    ChainEnds(const ChainEnds&) = delete;
    ChainEnds& operator=(const ChainEnds&) = delete;
    virtual ~ChainEnds() = default;

    /// Rows of a part, row by row: what is left of its elements, then its closing rows; by unknowns of the
    /// first node, of the last, of the border. None: it is singular. False, for all parts: they are.
    virtual bool factorise(std::span<const double> rows) = 0;
    /// Of the right side of these rows the unknowns.
    virtual void solve(std::span<const double> rows, std::span<double> ends) = 0;
};

/// For motions known at one end: rows of nodes 0..n-1 for unknowns of nodes 1..n, or, mirrored, rows of nodes
/// 1..n for unknowns of nodes 0..n-1. The matrix is block triangular over elements, which share one node
/// each: element by element, dense LU with row exchanges of the rows first..last-1 and the unknowns
/// first+1..last (mirrored: the other way round), which must be as many. The factors do not depend on each
/// other. A single element is factorised in the matrix' own storage. Allocates nothing after analyse().
std::unique_ptr<LinearSolver> forward_solver();

/// For any conditions, elements that share one node each, and a border: each element is condensed to its two
/// ends, and these are merged one after the other, with row exchanges between neighbours and reflections
/// where entries would grow; closing rows and what is left then make one dense matrix. One step of iterative
/// refinement. Takes the values of the matrix away. Time and memory grow with the number of elements; factors
/// of one element with n unknowns inside and f at each end take about n (n + 5 f) + 24 f f numbers.
std::unique_ptr<LinearSolver> chain_solver();
/// The same for a part of a longer chain, closed by `ends`, which must outlive the solver. Right-hand sides
/// have the part's rows, solutions its unknowns, in vectors of the larger number; none is transposed.
std::unique_ptr<LinearSolver> solver_of_part(ChainEnds& ends);

/// For any structure: one sparse matrix, and one step of iterative refinement. The pattern are the entries
/// that were not zero in some factorisation since analyse(); it is analysed anew where it has grown. Pivots,
/// largest entry and singular node are not known. Throws InputError where the build lacks the backend.
std::unique_ptr<LinearSolver> whole_solver(SparseBackend backend);

}   // namespace livens::inline solvers_internal
