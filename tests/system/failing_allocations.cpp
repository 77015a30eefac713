// SPDX-License-Identifier: BSD-3-Clause
// For LD_PRELOAD: allocations that fail. Counted from where the program's own code begins, its tables
// included.
//
//   LIVENS_FAIL_AT=N      the N-th fails (from 1)
//   LIVENS_FAIL_ON=1      and all behind it
//   LIVENS_FAIL_COUNT=F   the number of all goes to the file F when the program exits
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>

extern "C" {
void* __libc_malloc(size_t bytes);
void* __libc_calloc(size_t n, size_t bytes);
void* __libc_realloc(void* old, size_t bytes);
void* __libc_memalign(size_t alignment, size_t bytes);
}

namespace {

std::atomic<bool> counts{false};
std::atomic<long> n_asked{0};
long fails_at = 0;
bool fails_on = false;

bool fails()
{
    if (!counts) return false;
    const long n = ++n_asked;
    if (fails_at == 0 || n < fails_at || (n > fails_at && !fails_on)) return false;
    errno = ENOMEM;
    return true;
}

long number(const char* name)
{
    const char* const text = std::getenv(name);
    return text == nullptr ? 0 : std::atol(text);
}

[[gnu::constructor]] void begin()
{
    fails_at = number("LIVENS_FAIL_AT");
    fails_on = number("LIVENS_FAIL_ON") != 0;
    counts = true;
}

[[gnu::destructor]] void end()
{
    counts = false;
    const char* const file = std::getenv("LIVENS_FAIL_COUNT");
    if (file == nullptr) return;
    if (std::FILE* const out = std::fopen(file, "w")) {
        std::fprintf(out, "%ld\n", n_asked.load());
        std::fclose(out);
    }
}

}   // namespace

extern "C" {

void* malloc(size_t bytes) { return fails() ? nullptr : __libc_malloc(bytes); }
void* calloc(size_t n, size_t bytes) { return fails() ? nullptr : __libc_calloc(n, bytes); }
void* realloc(void* old, size_t bytes) { return fails() ? nullptr : __libc_realloc(old, bytes); }
void* memalign(size_t alignment, size_t bytes)
{
    return fails() ? nullptr : __libc_memalign(alignment, bytes);
}
void* aligned_alloc(size_t alignment, size_t bytes) { return memalign(alignment, bytes); }
int posix_memalign(void** out, size_t alignment, size_t bytes)
{
    void* const made = memalign(alignment, bytes);
    if (made == nullptr) return ENOMEM;
    *out = made;
    return 0;
}
}
