// SPDX-License-Identifier: BSD-3-Clause
// Euler's tensor E is an integral of the density times x x^T, so that no eigenvalue of it is negative, and
// any E without negative ones belongs to some body.
#include "livens/multibody/nearest_inertia.h"

#include <algorithm>

#include "livens/solvers/spectral.h"

namespace livens {

Matrix3 nearest_inertia(const Matrix3& inertia)
{
    const auto [values, vectors] = symmetric_spectrum(0.5 * trace(inertia) * identity<3>() - inertia);
    constexpr double rounding = 2.5e-13;   // J1 + J2 - J3 = 2 values[0]
    if (!(values[0] < -rounding * values[2])) return inertia;
    Matrix3 E{};
    for (int k = 0; k < 3; ++k) E += std::max(values[k], 0.0) * outer(vectors.column(k), vectors.column(k));
    return trace(E) * identity<3>() - E;
}

}   // namespace livens
