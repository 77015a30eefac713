// SPDX-License-Identifier: BSD-3-Clause
#include "livens/solvers/report.h"

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

}   // namespace livens
