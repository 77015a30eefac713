// SPDX-License-Identifier: BSD-3-Clause
// Doubles from a cache line's start on, where registers of every set of instructions load whole.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace livens::inline dynamics_internal {

template <typename T>
struct LineAllocator {
    using value_type = T;
    static constexpr std::align_val_t line{64};

    LineAllocator() = default;
    template <typename U>
    LineAllocator(const LineAllocator<U>&)
    {}   // as containers ask for

    T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), line)); }
    void deallocate(T* p, std::size_t) { ::operator delete(p, line); }

    friend bool operator==(const LineAllocator&, const LineAllocator&) { return true; }
};

using AlignedDoubles = std::vector<double, LineAllocator<double>>;

}   // namespace livens::inline dynamics_internal
