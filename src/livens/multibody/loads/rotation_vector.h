// SPDX-License-Identifier: BSD-3-Clause
// The rotation vector of one triad against another, and its derivatives: theory.md, "Coordinates of joints",
// Bushing.
#pragma once

#include <array>

#include "livens/base/linear.h"

namespace livens::inline multibody_internal {

/// A number and its derivatives by s1, s2, s3 and c.
struct Dual {
    double value = 0;
    std::array<double, 4> by{};

    friend Dual operator+(Dual a, const Dual& b)
    {
        a.value += b.value;
        for (std::size_t i = 0; i < 4; ++i) a.by[i] += b.by[i];
        return a;
    }
    friend Dual operator*(const Dual& a, const Dual& b)
    {
        Dual product{a.value * b.value, {}};
        for (std::size_t i = 0; i < 4; ++i) product.by[i] = a.value * b.by[i] + a.by[i] * b.value;
        return product;
    }
};

/// r, and the matrix of its derivatives by s and c.
struct Turn {
    std::array<Dual, 3> r;
    std::array<std::array<Dual, 4>, 3> J;
};
/// Of s1, s2, s3 and c.
Turn turn_of(const double* q);

/// The couple with the power f . r' for whatever angular velocity w turns r: r' = (I - r^/2 + k r^ r^) w
/// along the axes of the first triad, with k = (1 - x cot x) / (4 x^2), x = |r|/2.
Vector3 couple_of(const Vector3& f, const Vector3& r);

}   // namespace livens::inline multibody_internal
