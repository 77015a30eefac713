// SPDX-License-Identifier: BSD-3-Clause
// What checked indices call where they fail is in libstdc++ from 12 on (GLIBCXX_3.4.30); a wheel that brings
// its own runs with that of 11, too.
#include <cstdio>
#include <cstdlib>

#if defined(__GLIBCXX__) && _GLIBCXX_RELEASE >= 12
namespace std {
[[noreturn]] void __glibcxx_assert_fail(const char* file, int line, const char* function,
                                        const char* condition) noexcept;
void __glibcxx_assert_fail(const char* file, int line, const char* function, const char* condition) noexcept
{
    std::fprintf(stderr, "%s:%d: %s: Assertion '%s' failed.\n", file, line, function, condition);
    std::abort();
}
}   // namespace std
#endif
