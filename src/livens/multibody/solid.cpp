// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/solid.h"

#include "livens/solvers/spectral.h"

namespace livens {

MassProperties solid(double density, const Moments& m)
{
    return {density * m.volume, m.centroid, density * (trace(m.second) * identity<3>() - m.second)};
}

Moments moments(const MassProperties& p)
{
    return {p.mass, p.center_of_mass, 0.5 * trace(p.inertia) * identity<3>() - p.inertia};
}

PrincipalAxes principal_axes(const Matrix3& inertia)
{
    const PrincipalValues principal = symmetric_spectrum(inertia);
    PrincipalAxes found{principal.values, principal.vectors};
    if (determinant(found.axes) < 0) found.axes.set_column(2, -found.axes.column(2));
    return found;
}

}   // namespace livens
