// What the program tells its caller; docs/program.md lists the same.
#pragma once

namespace livens::program {

enum ExitCode : int {
    exit_ok = 0,
    exit_usage = 2,
    exit_scenario = 3,        ///< the scenario is wrong
    exit_not_converged = 4,   ///< a result was written, with converged = 0
    exit_resources = 5,       ///< memory or another limit
    exit_input_output = 6,
    exit_suspect = 7,   ///< solved, but the figures fail the acceptance checks; a result was written
    exit_internal = 70,
    exit_signal = 128   ///< plus the signal's number; a result was written if solving had begun
};

}   // namespace livens::program
