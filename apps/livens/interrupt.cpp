// SPDX-License-Identifier: BSD-3-Clause
#include "interrupt.h"

#include <unistd.h>

namespace livens::program {

namespace {

volatile std::sig_atomic_t caught = 0;

void note(int number)
{
    if (caught != 0) ::_exit(128 + number);
    caught = number;
}

}   // namespace

InterruptWatch::InterruptWatch()
{
    caught = 0;
    struct sigaction action {};
    action.sa_handler = note;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    ::sigaction(SIGINT, &action, &old_interrupt_);
    ::sigaction(SIGTERM, &action, &old_terminate_);
}

InterruptWatch::~InterruptWatch()
{
    ::sigaction(SIGINT, &old_interrupt_, nullptr);
    ::sigaction(SIGTERM, &old_terminate_, nullptr);
}

int InterruptWatch::signal() { return caught; }

SignalPause::SignalPause()
{
    sigset_t set;
    sigemptyset(&set);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, number);
    ::pthread_sigmask(SIG_BLOCK, &set, &old_);
}

SignalPause::~SignalPause() { ::pthread_sigmask(SIG_SETMASK, &old_, nullptr); }

void ignore_write_signals()
{
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

}   // namespace livens::program
