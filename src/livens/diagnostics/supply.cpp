// SPDX-License-Identifier: BSD-3-Clause
// Forces as they change momenta and energies, and what their rounding is relative to: theory.md, "What is
// diagnosed".
#include "livens/diagnostics/detail/supply.h"

#include <algorithm>
#include <cmath>

#include "livens/diagnostics/detail/point_kernels.h"
#include "livens/diagnostics/diagnostics.h"
#include "livens/dynamics/lanes/load_program.h"

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

namespace {

/// 12 numbers, `stride` apart.
/// Programs of loads see the centre of mass in place of the reference point, with the same directors.
void put_about_centre(const BodyTable& body, const double* from, double* to, int stride)
{
    for (int i = 0; i < 12; ++i) to[i * stride] = from[i];
    for (int a = 0; body.offset && a < 3; ++a)
        for (int i = 0; i < 3; ++i) to[i * stride] += body.center[a] * from[3 + 3 * a + i];
}

}   // namespace

SupplyInLanes::SupplyInLanes(const ModelTables& tables)
    : tables_(tables),
      lanes_(tables, point_kernels().loads, OfPoints::width, OfPoints::width, RecordedLoads::supplies),
      X_(static_cast<std::size_t>(12 * tables.n_bodies() * OfPoints::width), 0.0), V_(X_)
{
    for (const TapeArm& arm : lanes_.program().tape().arms())
        if (std::ranges::find(bodies_, arm.body) == bodies_.end()) bodies_.push_back(arm.body);
}

const std::vector<int>& SupplyInLanes::others() const { return lanes_.program().others(); }

void SupplyInLanes::put(const MotionPoints& set, int k, int lane)
{
    constexpr int W = OfPoints::width;
    for (const int b : bodies_) {
        put_about_centre(tables_.bodies[b], set.X(k) + 12 * b, X_.data() + 12 * b * W + lane, W);
        put_about_centre(tables_.bodies[b], set.V(k) + 12 * b, V_.data() + 12 * b * W + lane, W);
    }
}

Supply SupplyInLanes::taken(int lane) const
{
    const auto number = [&](int place) { return lanes_.number(place)[lane]; };
    const SupplyOnTape& at = lanes_.program().supply();
    Supply now;
    for (int i = 0; i < 3; ++i) {
        now.linear[i] = number(at.force + i);
        now.angular[i] = number(at.moment + i);
    }
    now.gross = number(at.gross);
    now.gross_moment = number(at.gross_moment);
    now.work = number(at.power);
    return now;
}

void SupplyInLanes::find(const MotionPoints& set, const std::vector<double>& turns,
                         std::vector<Supply>& points)
{
    constexpr int W = OfPoints::width;
    turns_ = turns;
    Instant instants[W];
    for (int first = 0; first < set.size(); first += W) {
        for (int lane = 0; lane < W; ++lane) {   // those behind the last point are as this one
            const int k = std::min(first + lane, set.size() - 1);
            instants[lane] = set.instant(k);
            put(set, k, lane);
        }
        lanes_.begin(instants);
        lanes_.go_on(turns_, X_.data(), V_.data());
        for (int lane = 0; lane < W && first + lane < set.size(); ++lane)
            points[static_cast<std::size_t>(first + lane)] = taken(lane);
    }
}

LoadSupply::LoadSupply(const ModelTables& tables, const Motion& motion)
    : model_(*tables.model), motion_(motion), turns_(model_, motion), recorded_(tables),
      X_(tables.bodies.size()), V_(X_)
{}

void LoadSupply::go_to(const MotionPoints& set, int element)
{
    points_.assign(static_cast<std::size_t>(set.size()), {});
    angles_ = turns_.at_end(element);
    const std::vector<int>& others = recorded_.others();
    if (others.size() < model_.loads().size()) recorded_.find(set, angles_, points_);
    for (int k = 0; k < set.size() && !others.empty(); ++k) {
        take_point(set, k);
        for (const int load : others) add_load(load, set.instant(k), points_[static_cast<std::size_t>(k)]);
    }
    find_stiffness(set, element);
}

/// Points of a set ascend in time, so that angles are followed from one to the next.
void LoadSupply::take_point(const MotionPoints& set, int k)
{
    std::copy_n(set.X(k), 12 * X_.size(), X_.data()->data());
    std::copy_n(set.V(k), 12 * V_.size(), V_.data()->data());
    turns_.turns().follow(X_, angles_);
}

/// Loads on states push no matter (theory.md, "States"), and so supply neither momentum nor energy.
void LoadSupply::add_load(int l, Instant at, Supply& now) const
{
    const Load& load = model_.loads()[l];
    if (acts_on_states(model_, load)) return;
    const LoadArguments now_at = arguments(l, at);
    LoadForces F(load.n_acted);
    load.forces(now_at, F);
    for (std::size_t b = 0; b < load.n_acted; ++b)
        if (load.bodies[b] != world) now.add_force(now_at.X[b], F[b], model_.length());
    now.work += power_without_potential(load, now_at);
}

/// Found anew where the element or its loads have changed by half, and in every eighth element.
void LoadSupply::find_stiffness(const MotionPoints& set, int element)
{
    constexpr int elements = 8;
    const double h = motion_.mesh.length(element);
    const double gross = points_[0].gross;
    const auto is_near = [](double a, double b) { return a <= 1.5 * b && b <= 1.5 * a; };
    const bool is_known = is_near(h, known_.h) && is_near(gross, known_.gross);
    if (is_known && ++known_.elements < elements) return;
    angles_ = turns_.at_end(element);
    take_point(set, 0);
    known_ = {all_stiffness(set.instant(0), h), h, gross, 0};
}

/// Entries count by their size and by that of the column of X that they are multiplied with, of the reference
/// point with the model's length in addition: near the origin its own size says nothing. V is rounded as X /
/// h.
Supply LoadSupply::all_stiffness(Instant at, double h) const
{
    Supply all;
    for (int l = 0; l < static_cast<int>(model_.loads().size()); ++l) {
        const Load& load = model_.loads()[l];
        if (acts_on_states(model_, load) || (!load.depends_on_X && !load.depends_on_V)) continue;
        const LoadArguments now = arguments(l, at);
        LoadTangent tangent(load.bodies.size(), load.n_acted);
        load.tangent(now, tangent);
        for (std::size_t b = 0; b < load.n_acted; ++b) {
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
