// SPDX-License-Identifier: BSD-3-Clause
#include "exact.h"

#include "exit_code.h"
#include "failure.h"
#include "finite_number.h"
#include "livens/base/error.h"
#include "livens/diagnostics/sample.h"

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

AcceleratedState accelerated_at(const Run& run, const Scenario& scenario, double t, bool is_exact)
{
    const Accelerations accelerations(scenario.model, run.motion);
    return accelerations.at(is_exact ? exact_sample(run, scenario, t).state : sample_state(run.motion, t));
}

double instant_inside(const std::string& text, const Motion& motion)
{
    const double t = finite_number(text, "--at", "a time in seconds");
    try {
        return snap_to_element_end(motion.mesh, t);
    } catch (const InputError& error) {
        throw failure(exit_usage, error.what());
    }
}

}   // namespace livens::program
