// SPDX-License-Identifier: BSD-3-Clause
// How reports of parts add up to the report of a whole: counts are sums, extremes stay extremes, and status
// and message are those of the part that came last, because a motion ends where its last part did.
#include "livens/solvers/report.h"

#include <algorithm>
#include <utility>

namespace livens {

const char* to_string(SolveStatus status)
{
    switch (status) {
    case SolveStatus::converged:
        return "converged";
    case SolveStatus::not_converged:
        return "not converged";
    case SolveStatus::singular:
        return "singular";
    case SolveStatus::not_finite:
        return "not finite";
    case SolveStatus::cancelled:
        return "cancelled";
    case SolveStatus::inaccurate:
        return "not accurate";
    case SolveStatus::suspect:
        return "suspect";
    }
    return "unknown";
}

namespace {

template <class T>
void keep_most(T& most, T next)
{
    most = std::max(most, next);
}

}   // namespace

SolveCounters& SolveCounters::operator+=(const SolveCounters& next)
{
    n_elements += next.n_elements;
    newton_iterations += next.newton_iterations;
    factorisations += next.factorisations;
    guess_factorisations += next.guess_factorisations;
    rescued += next.rescued;
    refused += next.refused;
    evaluations += next.evaluations;
    evaluations_in_all += next.evaluations_in_all;
    keep_most(unknowns, next.unknowns);
    keep_most(most_iterations, next.most_iterations);
    keep_most(tries, next.tries);
    return *this;
}

MeshChanges& MeshChanges::operator+=(const MeshChanges& next)
{
    // The first place stays: it is where a reader of the report begins to look.
    if (divided == 0) divided_at = next.divided_at;
    if (shifted == 0) shifted_at = next.shifted_at;
    if (!next.steep_load.empty()) steep_load = next.steep_load;
    divided += next.divided;
    shifted += next.shifted;
    return *this;
}

Conditioning& Conditioning::operator+=(const Conditioning& next)
{
    keep_most(residual_norm, next.residual_norm);
    smallest_pivot = std::min(smallest_pivot, next.smallest_pivot);
    keep_most(condition_1, next.condition_1);
    keep_most(condition_2, next.condition_2);
    keep_most(scaled_condition, next.scaled_condition);
    keep_most(factor_entries, next.factor_entries);
    if (next.guess_distance >= guess_distance) {
        guess_distance = next.guess_distance;
        guess_distance_time = next.guess_distance_time;
    }
    return *this;
}

SolveReport& SolveReport::operator+=(SolveReport next)
{
    static_cast<SolveCounters&>(*this) += next;
    static_cast<MeshChanges&>(*this) += next;
    static_cast<Conditioning&>(*this) += next;
    status = next.status;
    message = std::move(next.message);
    failed_at = next.failed_at;
    accuracy = next.accuracy;
    iterations.insert(iterations.end(), next.iterations.begin(), next.iterations.end());
    for (std::string& note : next.notes)
        // Parts of one motion say the same thing again and again; the report says it once.
        if (std::ranges::find(notes, note) == notes.end()) notes.push_back(std::move(note));
    if (!next.estimate_failed.empty()) estimate_failed = std::move(next.estimate_failed);
    return *this;
}

}   // namespace livens
