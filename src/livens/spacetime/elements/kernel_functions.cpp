// SPDX-License-Identifier: BSD-3-Clause
#include "livens/spacetime/elements/kernel_functions.h"

#include "livens/solvers/instructions.h"

namespace livens::lanes {

const Functions* functions(int n)
{
    if (n == 1) return sse2(1);   // there is nothing beside it
    switch (instructions()) {
    case Instructions::avx512:
        return avx512(n);
    case Instructions::avx2:
        return avx2(n);
    case Instructions::sse2:
        break;
    }
    return sse2(n);
}

}   // namespace livens::lanes
