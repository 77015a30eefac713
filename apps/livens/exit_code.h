// SPDX-License-Identifier: BSD-3-Clause
// What the program tells its caller; docs/program.md lists the same.
#pragma once

#include <array>

namespace livens::program {

enum ExitCode : int {
    exit_ok = 0,
    exit_different = 1,   ///< of diff alone
    exit_usage = 2,
    exit_scenario = 3,        ///< the scenario is wrong
    exit_not_converged = 4,   ///< a result was written, with converged = 0
    exit_resources = 5,       ///< memory or another limit
    exit_input_output = 6,
    exit_suspect = 7,   ///< solved, but the figures fail the acceptance checks; a result was written
    exit_internal = 70,
    exit_signal = 128   ///< plus the signal's number; a result was written if solving had begun
};

/// The same for people: --help and the man page.
struct ExitMeaning {
    const char* code;
    const char* meaning;
};
inline constexpr std::array exit_meanings{
    ExitMeaning{"0", "converged; other commands: success"},
    ExitMeaning{"1", "diff: the runs differ"},
    ExitMeaning{"2", "usage error"},
    ExitMeaning{"3", "error in the scenario"},
    ExitMeaning{"4", "not converged (the motion so far is written); no equilibrium"},
    ExitMeaning{"5", "resource limit"},
    ExitMeaning{"6", "input/output error"},
    ExitMeaning{"7", "suspect: solved, but the motion fails the acceptance checks"},
    ExitMeaning{"70", "internal error"},
    ExitMeaning{"130, 143", "stopped by Ctrl-C or SIGTERM; the motion so far is written"},
};

}   // namespace livens::program
