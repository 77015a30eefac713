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
