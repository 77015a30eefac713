// SPDX-License-Identifier: BSD-3-Clause
#include "interrupt.h"

#include <atomic>

#include <unistd.h>

namespace livens::program {

namespace {

std::atomic<int> caught{0}, pauses{0};   // without locks, so that a handler may use them
std::atomic<bool> ends_now{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

/// A second signal ends the program; where another thread writes a file, as soon as that is done.
void note(int number)
{
    if (caught.exchange(number) == 0) return;
    ends_now = true;
    if (pauses == 0) ::_exit(128 + number);
}

/// What the caller has the program ignore (nohup, a script's background jobs) stays ignored.
void watch(int number, struct sigaction& old)
{
    ::sigaction(number, nullptr, &old);
    if (old.sa_handler == SIG_IGN) return;
    struct sigaction action {};
    action.sa_handler = note;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    ::sigaction(number, &action, nullptr);
}

}   // namespace

InterruptWatch::InterruptWatch()
{
    caught = 0;
    watch(SIGINT, old_interrupt_);
    watch(SIGTERM, old_terminate_);
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
    ++pauses;
}

SignalPause::~SignalPause()
{
    if (--pauses == 0 && ends_now) ::_exit(128 + caught);
    ::pthread_sigmask(SIG_SETMASK, &old_, nullptr);
}

void ignore_write_signals()
{
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

}   // namespace livens::program
