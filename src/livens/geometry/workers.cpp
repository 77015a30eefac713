// SPDX-License-Identifier: BSD-3-Clause
// Threads for the tests of large meshes. Work is divided into parts of fixed size, whose order of summation
// does not depend on who did them: results have the same bits on every machine.
#include "livens/geometry/detail/workers.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace livens::inline geometry_internal {

namespace {

constexpr int most_threads = 8;   // what follows waits for memory

}   // namespace

void prefer_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes)
{
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    constexpr std::uintptr_t page = std::uintptr_t{1} << 21;
    const auto begin = reinterpret_cast<std::uintptr_t>(memory), first = (begin + page - 1) / page * page,
               end = (begin + bytes) / page * page;
    if (first < end)   // a wish: without it all is the same, but slower
        static_cast<void>(madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE));
#endif
}

void in_parallel(int n, const std::function<void(int)>& work)
{
    std::atomic<int> next{0};
    std::exception_ptr thrown;
    std::mutex of_thrown;
    const auto work_off = [&] {
        try {
            // One counter for all: whoever is done takes the next part, so uneven parts cost nothing.
            for (int i = next++; i < n; i = next++) work(i);
        } catch (...) {
            next = n;
            const std::lock_guard lock(of_thrown);
            thrown = std::current_exception();
        }
    };
    const int wanted =
        std::min({n, most_threads, std::max(1, static_cast<int>(std::thread::hardware_concurrency()))});
    {
        std::vector<std::jthread> threads;
        try {
            for (int k = 1; k < wanted; ++k) threads.emplace_back(work_off);
        } catch (const std::system_error&) {   // fewer do it, too
        }
        work_off();
    }
    if (thrown) std::rethrow_exception(thrown);
}

}   // namespace livens::inline geometry_internal
