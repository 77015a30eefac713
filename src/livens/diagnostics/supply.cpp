// SPDX-License-Identifier: BSD-3-Clause
// Forces as they change momenta and energies, and what their rounding is relative to: theory.md, "What is
// diagnosed".
#include "livens/diagnostics/detail/supply.h"

#include <cmath>

#include "livens/diagnostics/diagnostics.h"

namespace livens {

void Supply::add_force(const Matrix34& X, const Matrix34& F, double length)
{
    linear += F.column(0);
    for (int c = 0; c < 4; ++c)   // most forces have one column or two
        if (const Vector3 f = F.column(c); f != Vector3{}) angular += cross(X.column(c), f);
    add_size(X, F, length);
}

void Supply::add_size(const Matrix34& X, const Matrix34& F, double length)
{
    gross += norm(F.column(0));
    gross_moment += norm(F.column(0)) * length;
    for (int c = 0; c < 4; ++c)
        if (const double size = norm(F.column(c)); size != 0) gross_moment += norm(X.column(c)) * size;
}

void Supply::add(double weight, const Supply& other)
{
    work += weight * other.work;
    linear += weight * other.linear;
    angular += weight * other.angular;
    gross += weight * other.gross;
    gross_moment += weight * other.gross_moment;
}

Supply LoadSupply::at(Instant at, std::span<const Matrix34> X, std::span<const Matrix34> V)
{
    Supply now;
    turns_.turns().follow(X, angles_);
    for (int l = 0; l < static_cast<int>(model_.loads().size()); ++l) {
        const Load& load = model_.loads()[l];
        const LoadArguments now_at = arguments(l, at, X, V);
        LoadForces F{};
        load.forces(now_at, F);
        for (int b = 0; b < 2; ++b)
            if (load.bodies[b] != world) now.add_force(now_at.X[b], F[b], model_.length());
        now.work += power_without_potential(load, now_at);
    }
    return now;
}

Supply LoadSupply::stiffness(Instant at, std::span<const Matrix34> X, std::span<const Matrix34> V,
                             double h) const
{
    Supply all;
    for (int l = 0; l < static_cast<int>(model_.loads().size()); ++l) {
        const Load& load = model_.loads()[l];
        if (!load.depends_on_X && !load.depends_on_V) continue;
        const LoadArguments now = arguments(l, at, X, V);
        LoadTangent tangent(load.bodies.size());
        load.tangent(now, tangent);
        for (int b = 0; b < 2; ++b) {
            Matrix34 dF{};
            for (std::size_t c = 0; c < load.bodies.size(); ++c)
                for (int j = 0; j < 12; ++j) {
                    const double size = norm(now.X[c].column(j / 3)) + (j < 3 ? model_.length() : 0);
                    for (int i = 0; i < 12; ++i)
                        dF.a[i] +=
                            size * (std::abs(tangent.X[b][c](i, j)) + std::abs(tangent.V[b][c](i, j)) / h);
                }
            if (load.bodies[b] != world) all.add_size(now.X[b], dF, model_.length());
        }
    }
    return all;
}

}   // namespace livens
