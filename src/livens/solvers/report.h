// SPDX-License-Identifier: BSD-3-Clause
// How a solution went: returned, never thrown.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace [[gnu::visibility("default")]] livens {

enum class SolveStatus {
    converged,
    not_converged,   ///< Newton's iteration failed; the motion ends at the last good element end
    singular,        ///< a tangent lost rank or the constraints did; likewise
    not_finite,      ///< a load or a state became nan or inf; likewise
    cancelled,       ///< stopped by the caller; likewise
    inaccurate,      ///< the accuracy that was asked for was not reached; the motion ends where it was lost
    suspect          ///< the iteration converged, but the motion fails the checks made of it
};

const char* to_string(SolveStatus status);

/// Work. It adds up, but for what is the most of one.
struct SolveCounters {
    int n_elements = 0;              ///< solved
    int unknowns = 0;                ///< of one window, after elimination: the most
    long newton_iterations = 0;      ///< over all windows, all guesses counted
    int most_iterations = 0;         ///< in one window
    long factorisations = 0;         ///< of the tangent of a window
    long guess_factorisations = 0;   ///< of the smaller tangents behind first guesses
    int rescued = 0;                 ///< windows that converged only from another guess than the first
    int rejected = 0;                ///< elements that were solved again, shorter, for the accuracy asked for
    int tries = 0;                   ///< motions until the accuracy was reached: the most
    long long evaluations = 0;       ///< of the equations at a node of an element, in the motion
    long long evaluations_in_all = 0;   ///< of all tries and their second solutions

    SolveCounters& operator+=(const SolveCounters& next)
    {
        n_elements += next.n_elements;
        newton_iterations += next.newton_iterations;
        factorisations += next.factorisations;
        guess_factorisations += next.guess_factorisations;
        rescued += next.rescued;
        rejected += next.rejected;
        evaluations += next.evaluations;
        evaluations_in_all += next.evaluations_in_all;
        unknowns = std::max(unknowns, next.unknowns);
        most_iterations = std::max(most_iterations, next.most_iterations);
        tries = std::max(tries, next.tries);
        return *this;
    }
};

/// How the mesh became another than the one that was given.
struct MeshChanges {
    int divided = 0;          ///< elements that were too long and were divided into two
    double divided_at = 0;    ///< near end of the first of them, s
    int shifted = 0;          ///< element ends put elsewhere, off singular positions of the joints
    double shifted_at = 0;    ///< where the first of them was to be, s
    std::string steep_load;   ///< whose law most elements were refused or divided for; empty: none

    MeshChanges& operator+=(const MeshChanges& next)
    {
        if (divided == 0) divided_at = next.divided_at;
        if (shifted == 0) shifted_at = next.shifted_at;
        if (!next.steep_load.empty()) steep_load = next.steep_load;
        divided += next.divided;
        shifted += next.shifted;
        return *this;
    }
};

/// How well the equations were solved, and could be: the worst of all windows.
struct Conditioning {
    double residual_norm = 0;         ///< largest scaled residual at acceptance
    double smallest_pivot = 1;        ///< of the scaled constraint Jacobian; below 1e-6 deserves a look
    double condition_1 = 0;           ///< of the whole matrix in the 1-norm, if asked for
    double condition_2 = 0;           ///< and in the 2-norm
    double scaled_condition = 0;      ///< in the 1-norm, as it is factorised: rows and columns scaled
    long long factor_entries = 0;     ///< stored numbers of a window's sparse factors; 0: dense
    double guess_distance = 0;        ///< largest distance of the motion from the march it was guessed by: of
                                      ///< points by the model's length, of directors; 0: not guessed so
    double guess_distance_time = 0;   ///< when it first exceeds 0.05, else when it is largest, s
    double arrival = 0;   ///< between both ends, s: by how many m a rate that is off by 1 m/s at the start
                          ///< moves the motion at its end, at most; 0: not asked

    Conditioning& operator+=(const Conditioning& next)
    {
        residual_norm = std::max(residual_norm, next.residual_norm);
        smallest_pivot = std::min(smallest_pivot, next.smallest_pivot);
        condition_1 = std::max(condition_1, next.condition_1);
        condition_2 = std::max(condition_2, next.condition_2);
        scaled_condition = std::max(scaled_condition, next.scaled_condition);
        factor_entries = std::max(factor_entries, next.factor_entries);
        if (next.guess_distance >= guess_distance) {
            guess_distance = next.guess_distance;
            guess_distance_time = next.guess_distance_time;
        }
        return *this;
    }
};

struct SolveReport : SolveCounters, MeshChanges, Conditioning {
    SolveStatus status = SolveStatus::converged;
    std::string message;   ///< one line for a person: which joint or body, when, what to try
    /// Of conditions at both ends: how far the rounding of rows may move the motion, in lengths and rad.
    double moved_by_rounding = 0;
    double failed_at = 0;             ///< near end of the failed window, s; only if not converged
    double accuracy = 0;              ///< that was asked for; 0: none
    std::vector<int> iterations;      ///< per window; stepping: per element
    std::vector<std::string> notes;   ///< redundant rows, projections, ...
    std::vector<int> fired;           ///< events of the model that ended the march, see Problem
    std::string estimate_failed;      ///< why nothing tells the error: "the second solution failed: ..."

    bool converged() const { return status == SolveStatus::converged; }
    bool reached_end() const { return converged() || status == SolveStatus::suspect; }
    /// Of a motion that goes on where this one ended, whose outcome is that of both.
    SolveReport& operator+=(SolveReport next);
};

/// Called after each window, and between Newton's iterations on one (`done` and `t` are then as before it);
/// return false to stop. What takes long inside a window or after the last one (factors, condition numbers,
/// checks of the motion) calls it again and again with what it was told last.
struct Progress {
    int done = 0;   ///< elements solved so far, 0..n_elements, in either direction of time
    int n_elements = 0;
    double t = 0;         ///< s, up to where the motion is solved
    int iterations = 0;   ///< of the window at hand
    double residual = 0;
};
using ProgressCallback = std::function<bool(const Progress&)>;

}   // namespace gnu::visibility("default")]]livens
