// SPDX-License-Identifier: BSD-3-Clause
#include "livens/multibody/solid.h"

#include <Eigen/Dense>

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
    using Map = Eigen::Map<const Eigen::Matrix3d>;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(Map(inertia.data()));
    PrincipalAxes found;
    for (int i = 0; i < 3; ++i) {
        found.moments[i] = solver.eigenvalues()[i];
        for (int j = 0; j < 3; ++j) found.axes(j, i) = solver.eigenvectors()(j, i);
    }
    if (determinant(found.axes) < 0) found.axes.set_column(2, -found.axes.column(2));
    return found;
}

}   // namespace livens
