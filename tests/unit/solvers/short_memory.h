// SPDX-License-Identifier: BSD-3-Clause
// What a task does where memory ends. Where address space can be bounded, and not under a sanitizer, which
// needs it for itself.
#pragma once

#include "sanitized.h"

#if defined(__linux__) && !defined(LIVENS_SANITIZED)
#define LIVENS_SHORT_MEMORY 1

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <new>

namespace livens {

/// Ends the process: 0 if `n_bytes` more than it has now were enough, 1 if std::bad_alloc said that they were
/// not and the task goes well with more; 2 if it says false.
[[noreturn]] inline void end_with(const std::function<bool()>& task, rlim_t n_bytes)
{
    long n_pages = 0;
    std::ifstream("/proc/self/statm") >> n_pages;
    rlimit unlimited{};
    getrlimit(RLIMIT_AS, &unlimited);
    const rlimit limit{.rlim_cur = static_cast<rlim_t>(n_pages * sysconf(_SC_PAGESIZE)) + n_bytes,
                       .rlim_max = unlimited.rlim_max};
    setrlimit(RLIMIT_AS, &limit);
    try {
        std::_Exit(task() ? 0 : 2);
    } catch (const std::bad_alloc&) {
        setrlimit(RLIMIT_AS, &unlimited);
        std::_Exit(task() ? 1 : 2);
    }
}

/// With some of these bounds it ends by std::bad_alloc, with some it does not, and with none in another way.
inline void expect_bad_alloc_alone(const std::function<bool()>& task, std::initializer_list<int> kibibytes)
{
    bool enough = false, too_little = false;
    for (const int bound : kibibytes) {
        const auto by_exit = [&](int status) {
            enough |= WIFEXITED(status) && WEXITSTATUS(status) == 0;
            too_little |= WIFEXITED(status) && WEXITSTATUS(status) == 1;
            return WIFEXITED(status) && WEXITSTATUS(status) < 2;
        };
        EXPECT_EXIT(end_with(task, static_cast<rlim_t>(bound) << 10), by_exit, "") << bound << " KiB";
    }
    EXPECT_TRUE(enough);
    EXPECT_TRUE(too_little);
}

}   // namespace livens
#endif
