// SPDX-License-Identifier: BSD-3-Clause
// Two doubles in one register; compilers do not always find them by themselves.
#pragma once

#include <cstring>

namespace livens::inline diagnostics_internal {

typedef double Pair __attribute__((vector_size(16)));

inline Pair pair_at(const double* x)   // which is aligned as doubles are
{
    Pair pair;
    std::memcpy(&pair, x, sizeof pair);
    return pair;
}

}   // namespace livens::inline diagnostics_internal
