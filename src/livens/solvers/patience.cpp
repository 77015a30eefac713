// SPDX-License-Identifier: BSD-3-Clause
// Cancellation for loops that know nothing of who waits: a question to the caller, asked seldom enough to
// cost nothing. It never changes a result; it only ends work, by the exception `Stopped`.
#include "livens/solvers/patience.h"

#include <chrono>
#include <ctime>

namespace livens {

namespace {

constexpr unsigned calls_between_looks = 16;
constexpr double seconds_between_questions = 0.01;   // a question may wait for an interpreter's lock

// One chain of questions for each thread: threads of an ensemble do not stop each other.
thread_local Patience* asked = nullptr;
thread_local unsigned calls = 0;

double now()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double cpu_time()
{
#ifdef CLOCK_THREAD_CPUTIME_ID
    timespec t{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
#else
    return now();
#endif
}

}   // namespace

Patience::Patience(const std::function<bool()>& goes_on, double grace)
    : goes_on_(goes_on), outer_(asked), grace_(grace), last_(now())
{
    if (goes_on_) asked = this;
}

Patience::~Patience() { asked = outer_; }

void Patience::ask()
{
    if (asked != nullptr && ++calls % calls_between_looks == 0) asked->look();
}

void Patience::ask_now()
{
    if (asked != nullptr) asked->look();
}

void Patience::look()
{
    const double t = now();
    if (t - last_ < seconds_between_questions) return;
    last_ = t;
    // Grace counts CPU time of this thread and not the clock: on a busy machine it may wait longer than it
    // works.
    if (stopped_at_ < 0) {
        if (goes_on_()) return;
        stopped_at_ = cpu_time();
    }
    if (cpu_time() - stopped_at_ >= grace_) throw Stopped();
}

}   // namespace livens
