// SPDX-License-Identifier: BSD-3-Clause
#include "livens/solvers/ranks.h"

namespace livens::inline solvers_internal {

std::unique_ptr<Ranks> make_mpi_ranks() { return nullptr; }
void abort_mpi(int) {}
bool has_mpi() { return false; }

}   // namespace livens::inline solvers_internal
