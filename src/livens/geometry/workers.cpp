// SPDX-License-Identifier: BSD-3-Clause
// Threads for the tests of large meshes. Work is divided into parts of fixed size, whose order of summation
// does not depend on who did them: results have the same bits on every machine.
#include "livens/geometry/detail/workers.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>

#include "livens/solvers/crew.h"

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
    const Crew crew(
        std::min({n, most_threads, std::max(1, static_cast<int>(std::thread::hardware_concurrency()))}));
    std::atomic<int> next{0};
    in_shares(Crew::size(), 1, [&](int, int, int) {
        // One counter for all: whoever is done takes the next part, so uneven parts cost nothing.
        try {
            for (int i = next++; i < n; i = next++) work(i);
        } catch (...) {
            next = n;
            throw;
        }
    });
}

}   // namespace livens::inline geometry_internal
