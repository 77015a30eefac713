// SPDX-License-Identifier: BSD-3-Clause
// Counts what the program takes from the heap.
#pragma once

namespace livens {

/// Calls of operator new so far.
long long n_allocations();

}   // namespace livens
