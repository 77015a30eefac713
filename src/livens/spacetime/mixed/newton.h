// Newton's iteration on a whole block.
#pragma once

#include <functional>
#include <string>

#include "livens/solvers/report.h"
#include "livens/spacetime/mixed/equations.h"

namespace livens::mixed {

struct NewtonOptions {
    double tolerance = 1e-12;
    int max_iterations = 30;
    SparseBackend backend = SparseBackend::eigen;
    bool condition = false;
    std::function<bool(int iterations)> goes_on;   ///< asked before each factorisation; false: cancelled
};

struct NewtonReport {
    SolveStatus status = SolveStatus::converged;
    int iterations = 0;
    int factorisations = 0;
    bool reached_limit = false;   ///< of iterations; else no step, however short, made the increment smaller
    double residual = 0;          ///< largest scaled row over the largest scaled unknown
    Worst worst;                  ///< where the residual is largest, after a failure
    std::string load;             ///< that is not finite
    long long factor_entries = 0;
    ConditionNumbers condition;    ///< of the matrix as published, at the solution; if asked for
    double scaled_condition = 0;   ///< 1-norm, of the matrix that is factorised
};

/// Solves the equations from the guess in `fields`.
///
/// Damped by the natural level function [Deuflhard2011, section 3.3]: a step is as long as the increment that
/// the same factors foretell after it is the smaller one. Factors stay in use while they contract by 4. Ends
/// when the next increment (Equations::size_of) is at most the tolerance, or no longer shrinks below 1e-9.
NewtonReport solve_block(Equations& equations, Fields& fields, const NewtonOptions& options);

}   // namespace livens::mixed
