// SPDX-License-Identifier: BSD-3-Clause
// Which every processor has; and what is in use.
#define LIVENS_ROW_REGISTER 2
#include "livens/solvers/detail/rows_in_registers.h"

#include "livens/solvers/instructions.h"

namespace livens::inline solvers_internal {

const RowFunctions& rows_sse2() { return in_registers; }

const RowFunctions& row_functions()
{
    return instructions() == Instructions::sse2 ? rows_sse2() : rows_avx2();
}

}   // namespace livens::inline solvers_internal
