// SPDX-License-Identifier: BSD-3-Clause
// The linear algebra of a window behind a small interface: blocks of the tangent go in, increments of the
// null-space unknowns come out.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "livens/solvers/dense_matrix.h"
#include "livens/solvers/linear_solver.h"
#include "livens/solvers/report.h"
#include "livens/spacetime/nodal/tangent.h"

namespace livens::inline spacetime_internal {

/// Reduced systems: rows Z_A^T at active nodes, columns Z_B at unknown ones.
class Elimination : public TangentSink {
public:
    /// Takes the null spaces of all nodes, before a tangent is formed.
    virtual void begin(const WindowLayout& layout, const Nodes& nodes) = 0;
    /// Conditions by component, after a tangent was formed: their rows by the free motions at the first node,
    /// at the last, and by momenta along these, which are in the balances there, and by what joins them to
    /// those of other ranks; and all rows (balances, then conditions) by unknown numbers.
    virtual void close_with(std::span<const double> /*closing*/, const DenseMatrix& /*by_numbers*/) {}
    /// Rows and increments belong to these nodes, of a model with these tables, from now on: by default to
    /// those of begin().
    virtual void stand_at(const ModelTables&, const Nodes&) {}
    /// Reduced rows where it stands, as those of the nodes of begin(): what is zero stays so.
    virtual void carry(double* /*rows*/) const {}
    virtual bool factorise() = 0;
    /// Whether the matrix is there as a whole: else factorise() may fail where that would not, and there is
    /// no condition number.
    virtual bool is_whole() const { return true; }
    /// y <- the scaled twists of unknown nodes, node after node, that the reduced rows of active nodes ask
    /// for; with conditions by component their rows follow, and in y momenta along free motions, then
    /// numbers.
    virtual void solve(std::span<const double> rows, const double* range, double* y) = 0;
    /// y <- the scaled twist of the last node, which is unknown, that conditions by component alone ask for.
    virtual void last_twist(std::span<const double> /*conditions*/, double* /*y*/) {}
    /// Whether solve() can take violations of the constraints in; else they are taken off before. `range`
    /// then holds the part of y across the null space at node 1 (in the basis), or null.
    virtual bool takes_constraints() const { return false; }
    /// Of the last factors: how far rows of these sizes (of all nodes, and of closing rows) may move the
    /// unknowns, by the sum of their squares, an estimate; and the scaled twists of unknown nodes that move
    /// most, then unknown numbers. 0: they are not kept.
    virtual double least_resisted(std::span<const double> /*rows*/, std::vector<double>& /*y*/) { return 0; }
    virtual void describe(SolveReport& report) const = 0;
    virtual long long flops() const { return 0; }   ///< of a factorisation; 0: not known
    /// Of the tangent that was formed; uses it up.
    virtual void measure_condition(SolveReport& report, const std::function<bool()>& goes_on) = 0;
};

/// How nodes inside of elements are eliminated.
enum class Inside {
    as_a_whole,     ///< dense, with all others, by the solver
    along_joints,   ///< before, where bodies are held as branches of trees, see AlongJoints
    as_it_pays,
};

/// Blocks on null spaces, for a LinearSolver.
std::unique_ptr<Elimination> null_space_elimination(const ModelTables& tables, const WindowLayout& layout,
                                                    std::unique_ptr<LinearSolver> solver,
                                                    Inside inside = Inside::as_a_whole);

/// One element of degree 1 with a known start and without loads that have a tangent: the tangent couples no
/// bodies. They are inverted one by one, and the constraints added by their Schur complement, which is small.
std::unique_ptr<Elimination> body_elimination(const ModelTables& tables);

}   // namespace livens::inline spacetime_internal
