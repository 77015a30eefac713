// SPDX-License-Identifier: BSD-3-Clause
#include "livens/diagnostics/detail/supply.h"

#include <cmath>

#include "livens/diagnostics/diagnostics.h"
#include "livens/diagnostics/largest.h"
#include "livens/dynamics/rows/rows.h"

namespace livens {

namespace {

Quadrature nodal_rule(const Field& field)
{
    return field.points == Points::lobatto ? gauss_lobatto(field.degree + 1) : radau(field.degree);
}

/// Where loads are taken, as by the method: at its Gauss points, where alone its momentum balances are exact.
/// Without such points one multiplier an element marks a stepping rule with one stage: endpoint (order 1)
/// takes forces at the end of the step, midpoint, in old files, in its middle.
Quadrature load_rule(const Motion& motion)
{
    if (motion.gauss_points > 0) return gauss(motion.gauss_points);
    const bool one_stage = motion.X.degree == 1 && motion.multipliers.degree == 0;
    if (!one_stage) return nodal_rule(motion.X);
    return {{motion.order_at_ends == 1 ? 1.0 : 0.5}, {1.0}};
}

/// Where joints are taken: where the method holds them, at its nodes or at the points of its loads.
Quadrature joint_rule(const Motion& motion)
{
    if (motion.constraints_hold == ConstraintsHold::at_nodes) return nodal_rule(motion.X);
    return load_rule(motion);
}

}   // namespace

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

LoadSupply::LoadSupply(const Model& model, const Motion& motion)
    : model_(model), turns_(model, motion), rule_(load_rule(motion)), points_(motion, rule_.points),
      X_(static_cast<std::size_t>(motion.n_bodies)), V_(X_)
{
    for (const Body& body : model.bodies()) weights_of_bodies_.push_back(weight(body, model.gravity()));
}

void LoadSupply::go_to(int element, int k)
{
    points_.positions(element, k, X_);
    points_.velocities(element, k, V_);
    if (k == 0) angles_ = turns_.at_end(element);
}

LoadArguments LoadSupply::arguments(int load, Instant at) const
{
    return load_arguments(model_.loads()[load], at, X_, V_, turns_.turns().of(load, angles_));
}

Supply LoadSupply::at(int element, int k)
{
    Supply now;
    go_to(element, k);
    for (std::size_t b = 0; b < X_.size(); ++b) now.add_force(X_[b], weights_of_bodies_[b], model_.length());
    raise_to(largest_kinetic_, kinetic_energy(model_, X_, V_));
    turns_.turns().follow(X_, angles_);
    for (int l = 0; l < static_cast<int>(model_.loads().size()); ++l) {
        const Load& load = model_.loads()[l];
        const LoadArguments now_at = arguments(l, points_.instant(element, k));
        LoadForces F{};
        load.forces(now_at, F);
        for (int b = 0; b < 2; ++b)
            if (load.bodies[b] != world) now.add_force(now_at.X[b], F[b], model_.length());
        now.work += power_without_potential(load, now_at);
    }
    return now;
}

Supply LoadSupply::stiffness(int element, double h)
{
    Supply all;
    go_to(element, 0);
    for (int l = 0; l < static_cast<int>(model_.loads().size()); ++l) {
        const Load& load = model_.loads()[l];
        if (!load.depends_on_X && !load.depends_on_V) continue;
        const LoadArguments at = arguments(l, points_.instant(element, 0));
        LoadTangent tangent(load.bodies.size());
        load.tangent(at, tangent);
        for (int b = 0; b < 2; ++b) {
            Matrix34 dF{};
            for (std::size_t c = 0; c < load.bodies.size(); ++c)
                for (int j = 0; j < 12; ++j) {
                    const double size = norm(at.X[c].column(j / 3)) + (j < 3 ? model_.length() : 0);
                    for (int i = 0; i < 12; ++i)
                        dF.a[i] +=
                            size * (std::abs(tangent.X[b][c](i, j)) + std::abs(tangent.V[b][c](i, j)) / h);
                }
            if (load.bodies[b] != world) all.add_size(at.X[b], dF, model_.length());
        }
    }
    return all;
}

JointSupply::JointSupply(const Model& model, const Motion& motion)
    : tables_(model, all_rows(model)), rule_(joint_rule(motion)), points_(motion, rule_.points),
      X_(static_cast<std::size_t>(motion.n_bodies))
{
    if (motion.multipliers.empty()) return;
    multipliers_.emplace(motion.multipliers, points_.points());
    lambda_.resize(static_cast<std::size_t>(motion.n_rows));
}

Supply JointSupply::at(int element, int k)
{
    Supply now;
    points_.positions(element, k, X_);
    multipliers_->values(element, k, lambda_);
    const Instant at = points_.instant(element, k);
    for (int r = 0; r < tables_.n_rows(); ++r) {
        if (lambda_[r] == 0) continue;
        const RowTable& table = tables_.rows[r];
        double g[RowTables::gradient_size];
        tables_.rows.gradient(r, at, X_.data()->data(), g);
        for (int side = 0; side < table.n_sides; ++side) {
            Matrix34 force{};
            for (const int column : table.columns[side])
                for (int i = column; i < column + 3; ++i) force.a[i] = -lambda_[r] * g[12 * side + i];
            now.add_force(X_[table.bodies[side]], force, tables_.length);
        }
        if (!table.is_quadratic) now.work += lambda_[r] * constraint_rate(*table.row, at, X_);
    }
    return now;
}

}   // namespace livens
