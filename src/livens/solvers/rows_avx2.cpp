// SPDX-License-Identifier: BSD-3-Clause
// Compiled for AVX2 alone, see CMakeLists.txt.
#ifdef LIVENS_X86_SETS
#define LIVENS_ROW_REGISTER 4
#include "livens/solvers/detail/rows_in_registers.h"

namespace livens::inline solvers_internal {

const RowFunctions& rows_avx2() { return in_registers; }

}   // namespace livens::inline solvers_internal
#else
#include "livens/solvers/row_functions.h"

namespace livens::inline solvers_internal {

const RowFunctions& rows_avx2() { return rows_sse2(); }

}   // namespace livens::inline solvers_internal
#endif
