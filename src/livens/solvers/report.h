// How a solution went: returned, never thrown.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace livens {

enum class SolveStatus {
    converged,
    not_converged,   ///< Newton's iteration failed; the motion ends at the last good element end
    singular,        ///< a tangent lost rank or the constraints did; likewise
    not_finite,      ///< a load or a state became nan or inf; likewise
    cancelled        ///< stopped by the caller; likewise
};

const char* to_string(SolveStatus status);

struct SolveReport {
    SolveStatus status = SolveStatus::converged;
    std::string message;          ///< one line for a person: which joint or body, when, what to try
    int n_elements = 0;           ///< solved
    int unknowns = 0;             ///< of one block, after elimination
    long newton_iterations = 0;   ///< over all elements
    int most_iterations = 0;      ///< in one element
    long factorisations = 0;      ///< of the tangent of an element
    long guess_factorisations =
        0;                         ///< of the smaller tangents behind first guesses (half the degree or less)
    int rescued = 0;               ///< elements that converged only from a guess made by many small elements
    double residual_norm = 0;      ///< largest scaled residual at acceptance
    double smallest_pivot = 1;     ///< of the scaled constraint Jacobian; below 1e-6 deserves a look
    double failed_at = 0;          ///< start of the failed element, s; only if not converged
    std::vector<int> iterations;   ///< per element
    std::vector<std::string> notes;   ///< redundant rows, projections, ...

    bool converged() const { return status == SolveStatus::converged; }
};

/// Called after each element; return false to stop.
struct Progress {
    int element = 0;
    int n_elements = 0;
    double t = 0;
    int iterations = 0;
    double residual = 0;
};
using ProgressCallback = std::function<bool(const Progress&)>;

}   // namespace livens
