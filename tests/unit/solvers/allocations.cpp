// SPDX-License-Identifier: BSD-3-Clause
#include "allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<long long> calls{0};

void* take(std::size_t size) noexcept
{
    ++calls;
    return std::malloc(size > 0 ? size : 1);
}

void* take_or_throw(std::size_t size)
{
    if (void* memory = take(size)) return memory;
    throw std::bad_alloc();
}

}   // namespace

long long livens::n_allocations() { return calls; }

// All of them: sanitizers bring their own, which must not be mixed with these.
void* operator new(std::size_t size) { return take_or_throw(size); }
void* operator new[](std::size_t size) { return take_or_throw(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return take(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return take(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
