// SPDX-License-Identifier: BSD-3-Clause
// The bases of the elements `mixed`: one table, from which equations, scenarios and pages know them.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "livens/spacetime/method.h"
#include "livens/time/time_space.h"

namespace livens::mixed {

struct Basis {
    std::string_view word;   ///< in scenarios and names of methods
    std::string_view doc;    ///< "continuous polynomials with equidistant nodes"
    /// Functions as smooth as their knots allow, no more of them than elements plus degree. A block has at
    /// least as many elements as the degree.
    bool has_knots;
    bool has_weights;   ///< its functions are quotients
    /// Functions on the elements between `ends`, with kinks at those of the instants `kinks` that are ends.
    TimeSpace (*space)(const Mixed& method, const std::vector<double>& ends,
                       const std::vector<double>& kinks);
};

/// In the order of Mixed::Basis. Exported, as scenarios make their keys of it.
[[gnu::visibility("default")]] std::span<const Basis> bases();

inline const Basis& basis_of(const Mixed& method) { return bases()[static_cast<std::size_t>(method.basis)]; }

}   // namespace livens::mixed
