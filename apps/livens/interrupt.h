// SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C and SIGTERM: the first asks for a stop at the next element, the second ends the program at once.
#pragma once

#include <csignal>
#include <initializer_list>

namespace livens::program {

/// While it lives, SIGINT and SIGTERM are noted instead of ending the program.
class InterruptWatch {
public:
    InterruptWatch();
    ~InterruptWatch();
    InterruptWatch(const InterruptWatch&) = delete;
    InterruptWatch& operator=(const InterruptWatch&) = delete;

    /// The signal that arrived, 0 if none did.
    static int signal();

private:
    struct sigaction old_interrupt_ {};
    struct sigaction old_terminate_ {};
};

/// While it lives, signals wait: nothing may end the program between a temporary file and its final name.
class SignalPause {
public:
    SignalPause();
    ~SignalPause();
    SignalPause(const SignalPause&) = delete;
    SignalPause& operator=(const SignalPause&) = delete;

private:
    sigset_t old_{};
};

/// A broken pipe or a file-size limit becomes an error of the call that met it.
void ignore_write_signals();

}   // namespace livens::program
