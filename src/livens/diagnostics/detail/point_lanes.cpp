// SPDX-License-Identifier: BSD-3-Clause
// Arrays of the kernels: number k of the point in lane l stands at 4 k + l.
#include "livens/diagnostics/detail/point_lanes.h"

#include <algorithm>
#include <cmath>

#include "livens/diagnostics/largest.h"

namespace livens::inline diagnostics_internal {

namespace {

constexpr int W = OfPoints::width;

bool is_finite(const LargestOfPoints& found)
{
    return std::ranges::all_of(found.spoilt.at, [](double x) { return x == 0; });
}

}   // namespace

PointLanes::PointLanes(const PointTables& tables)
    : tables_(tables), lists_(tables.view()), kernels_(point_kernels()), X_(lists_.n_numbers * W), V_(X_),
      multipliers_(lists_.n_rows * W), violations_(multipliers_), sizes_(lists_.n_numbers / 3 * W),
      forces_(X_)
{}

OfPoints PointLanes::potential()
{
    OfPoints energy;
    kernels_.potential(lists_, arrays(), energy);
    return energy;
}

OfPoints PointLanes::kinetic_energy()
{
    OfPoints energy;
    kernels_.kinetic(lists_, arrays(), energy);
    return energy;
}

/// Maxima in registers lose a nan. Where anything was not finite all is looked at again by raise_to().
OfPoints PointLanes::largest_violation()
{
    LargestOfPoints found;
    kernels_.largest_violation(lists_, arrays(), found);
    if (is_finite(found)) return found.largest;
    OfPoints largest{};
    for (int r = 0; r < n_rows(); ++r)
        for (int lane = 0; lane < W; ++lane) raise_to(largest[lane], std::abs(violation(r, lane)));
    return largest;
}

/// Of the rows (P4), 1/2 (d_a . d_b - delta_ab), whose scale is 1.
OfPoints PointLanes::largest_of_rigidity()
{
    LargestOfPoints found;
    kernels_.largest_of_rigidity(lists_, arrays(), found);
    if (is_finite(found)) return found.largest;
    OfPoints largest{};
    for (int k = 0; k < lists_.n_rigid; ++k)
        for (int a = lists_.rigid[k] + 3; a < lists_.rigid[k] + 12; a += 3)
            for (int b = a; b < lists_.rigid[k] + 12; b += 3)
                for (int lane = 0; lane < W; ++lane) {
                    double product = a == b ? -1 : 0;
                    for (int i = 0; i < 3; ++i) product += X_[(a + i) * W + lane] * X_[(b + i) * W + lane];
                    raise_to(largest[lane], std::abs(0.5 * product));
                }
    return largest;
}

}   // namespace livens::inline diagnostics_internal
