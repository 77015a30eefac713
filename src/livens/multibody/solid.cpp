// SPDX-License-Identifier: BSD-3-Clause
// From integrals over a shape to mass properties and back, with one density (P19): theory.md, "Bodies from
// meshes".
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
    // Eigenvectors have no sign; axes of a body must be right-handed.
    if (determinant(found.axes) < 0) found.axes.set_column(2, -found.axes.column(2));
    return found;
}

}   // namespace livens
