// SPDX-License-Identifier: BSD-3-Clause
// Memory and threads for meshes of millions of elements.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace livens::inline geometry_internal {

/// Asks the system for large pages behind memory that is not touched yet: each page costs about a
/// microsecond, a thousand times what is in it.
void prefer_large_pages(void* memory, std::size_t bytes);

/// Also makes the whole memory at once.
template <class T>
void reserve(std::vector<T>& list, std::size_t n)
{
    if (n <= list.capacity()) return;
    list.reserve(n);
    prefer_large_pages(list.data() + list.size(), (n - list.size()) * sizeof(T));
}
/// n times `value`.
template <class T>
std::vector<T> filled(std::size_t n, const T& value)
{
    std::vector<T> list;
    reserve(list, n);
    list.resize(n, value);
    return list;
}

/// work(0) to work(n - 1), by as many threads as the machine has. Each must write what no other reads or
/// writes: then nothing depends on who did what. What is thrown (memory) is thrown on.
void in_parallel(int n, const std::function<void(int)>& work);

/// Likewise work(begin, end, part) for parts of 0 to n of `size` each, the last one being shorter.
template <class Work>
void in_parts(std::size_t n, std::size_t size, Work work)
{
    in_parallel(static_cast<int>((n + size - 1) / size), [&](int part) {
        const std::size_t begin = static_cast<std::size_t>(part) * size;
        work(begin, begin + size < n ? begin + size : n, part);
    });
}

}   // namespace livens::inline geometry_internal
