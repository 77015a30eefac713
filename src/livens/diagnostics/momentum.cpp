// SPDX-License-Identifier: BSD-3-Clause
// Linear momentum, and angular momentum about the origin as sum X_c x P_c over all columns: theory.md, "The
// element", Momenta.
#include <cassert>

#include "livens/diagnostics/diagnostics.h"

namespace livens {

Vector3 linear_momentum(std::span<const Matrix34> P)
{
    Vector3 sum{};
    for (const Matrix34& p : P) sum += p.column(0);   // X' m e_0: the mass times the centre's velocity
    return sum;
}

Vector3 angular_momentum(std::span<const Matrix34> X, std::span<const Matrix34> P)
{
    assert(X.size() == P.size());
    Vector3 sum{};
    for (std::size_t b = 0; b < X.size(); ++b) {
        for (int c = 0; c < 4; ++c) sum += cross(X[b].column(c), P[b].column(c));
    }
    return sum;
}

}   // namespace livens
