// SPDX-License-Identifier: BSD-3-Clause
#include "exact.h"

#include "exit_code.h"
#include "failure.h"

namespace livens::program {

ExactSample exact_sample(const Run& run, const Scenario& scenario, double t)
{
    if (std::holds_alternative<Mixed>(scenario.method))
        throw failure(exit_usage, "--exact cannot be had of the family mixed: each element depends on all "
                                  "others of its block; make the instant an output time");
    ExactSample exact = sample_exactly(scenario.model, run.motion, scenario.method, t, scenario.options);
    if (!exact.report.converged()) throw failure(exit_not_converged, exact.report.message);
    return exact;
}

}   // namespace livens::program
