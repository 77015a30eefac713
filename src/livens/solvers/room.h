// SPDX-License-Identifier: BSD-3-Clause
// Doubles that nobody has set: threads that share a loop set, and so touch first, each what is its own.
#pragma once

#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace livens::inline solvers_internal {

template <typename T>
struct RoomAllocator : std::allocator<T> {
    template <typename U>
    struct rebind {
        using other = RoomAllocator<U>;
    };

    RoomAllocator() = default;
    template <typename U>
    RoomAllocator(const RoomAllocator<U>&)
    {}   // as containers ask for

    template <typename U>
    void construct(U* p)
    {
        ::new (static_cast<void*>(p)) U;   // sets nothing
    }
    template <typename U, typename... Arguments>
    void construct(U* p, Arguments&&... arguments)
    {
        std::construct_at(p, std::forward<Arguments>(arguments)...);
    }
};

/// resize() leaves what is new as it is found.
using Room = std::vector<double, RoomAllocator<double>>;

}   // namespace livens::inline solvers_internal
