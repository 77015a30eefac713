// SPDX-License-Identifier: BSD-3-Clause
// In which order a sparse symmetric matrix is eliminated.
#pragma once

#include <vector>

namespace livens::inline dynamics_internal {

/// An order of least degree of nodes, of which two are coupled that share a thing (0 .. n_things - 1): that
/// with the smallest sum of the sizes of those that are coupled to it, as they then are; the earlier node
/// where these are equal. On trees it has no fill.
std::vector<int> order_of_least_degree(const std::vector<std::vector<int>>& things_of, int n_things,
                                       const std::vector<int>& sizes);

}   // namespace livens::inline dynamics_internal
