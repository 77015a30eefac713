// SPDX-License-Identifier: BSD-3-Clause
// What integrals over densities that are fields share.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "livens/geometry/moments.h"

namespace livens::inline geometry_internal {

/// Points of rules in each direction, one finer than the other: a piece of space takes the first whose
/// successor says the same. The first is exact for linear densities of elements, the others for polynomials
/// of growing degree.
inline constexpr std::array<int, 5> finer{6, 8, 11, 15, 20};
inline constexpr double same_sums = 1e-13, unsure_sums = 1e-9;   // of the whole

/// Mass, first and second moment about a point, and of the mass what its size is without signs.
struct Sums {
    double mass = 0, size = 0;
    Vector3 first{};
    Matrix3 second{};

    void add(const Vector3& x, double share)
    {
        mass += share;
        size += std::abs(share);
        first += share * x;
        second += share * outer(x, x);
    }
    void add(const Sums& other)
    {
        mass += other.mass;
        size += other.size;
        first += other.first;
        second += other.second;
    }
    /// In shares of the mass, for a solid that is so large.
    double gap(const Sums& other, double length) const
    {
        return std::max({std::abs(mass - other.mass), norm(first - other.first) / length,
                         norm(second - other.second) / (length * length)});
    }
};

/// Of a piece of space, and how much of the mass is not known.
struct Settled {
    Sums sums;
    double gap = HUGE_VAL;
};
/// `sums_at(level)`: by the rule of this level.
template <class SumsAt>
Settled settled(double length, const SumsAt& sums_at)
{
    Settled found{sums_at(0)};
    for (std::size_t level = 1; level < finer.size() && found.gap > same_sums * found.sums.size; ++level) {
        const Sums better = sums_at(level);
        found = {better, better.gap(found.sums, length)};
    }
    return found;
}

[[noreturn]] void refuse_density(const std::string& what, const std::string& value, const std::string& help);
/// Throws `density-field` for what is no number or less than `least`.
double checked_density(double density, const Vector3& at, double least);
/// Throws `density-field` where no mass is left.
Moments about_centroid(const Sums& sums, const Vector3& about);

}   // namespace livens::inline geometry_internal
