// SPDX-License-Identifier: BSD-3-Clause
// Every joint, drive, load and sensor, displaced: at places that are displaced as well it does what it did,
// turned. What is displaced passes the kits of joints and loads, too.
#include <gtest/gtest.h>

#include <cmath>

#include "livens/multibody/joints/drives.h"
#include "livens/multibody/relocation.h"
#include "livens/time/time_laws.h"
#include "properties/joint_kit.h"
#include "properties/load_kit.h"

namespace livens::relocated_test {
namespace {

constexpr double bound = 1e-13;

/// Bodies of the model that is added come behind two others.
constexpr int n_before = 2;

Relocation any_relocation(Random& random)
{
    return {"left ", {3. * random.vector(), random.rotation()}, n_before, 1};
}

std::vector<Matrix34> displaced(const std::vector<Matrix34>& X, const Relocation& to)
{
    std::vector<Matrix34> moved(n_before, world_configuration);
    for (const Matrix34& one : X) moved.push_back(to.by.of_configuration(one));
    return moved;
}

/// The largest difference of values, turned gradients, curvatures and coordinates.
double difference(const Joint& joint, const Joint& moved, const std::vector<Matrix34>& X,
                  const std::vector<Matrix34>& V, const Relocation& to)
{
    const std::vector<Matrix34> X_moved = displaced(X, to);
    std::vector<Matrix34> V_moved(n_before);
    for (const Matrix34& v : V) V_moved.push_back(to.by.rotation * v);
    double most = 0;
    const auto see = [&](double a, double b) { most = std::max(most, std::abs(a - b)); };
    for (std::size_t r = 0; r < joint.rows.size(); ++r) {
        const ConstraintRow &before = joint.rows[r], &after = moved.rows[r];
        see(constraint_value(before, kit_instant, X), constraint_value(after, kit_instant, X_moved));
        see(constraint_rate(before, kit_instant, X), constraint_rate(after, kit_instant, X_moved));
        see(constraint_curvature(before, kit_instant, X, V),
            constraint_curvature(after, kit_instant, X_moved, V_moved));
        const RowGradient g = constraint_gradient(before, kit_instant, X),
                          h = constraint_gradient(after, kit_instant, X_moved);
        for (int b = 0; b < static_cast<int>(X.size()); ++b)
            most = std::max(most, largest(to.by.rotation * g.of(b) - h.of(b + n_before)));
    }
    for (std::size_t k = 0; k < joint.coordinates.size(); ++k) {
        const JointCoordinate &q = joint.coordinates[k].coordinate, &p = moved.coordinates[k].coordinate;
        see(coordinate_value(q, X), coordinate_value(p, X_moved));
        see(coordinate_rate(q, X, V), coordinate_rate(p, X_moved, V_moved));
    }
    const auto place = [](int body, const std::vector<Matrix34>& all) {
        return body == world ? world_configuration : all[static_cast<std::size_t>(body)];
    };
    const auto compare_places = [&](int first, int second, const Vector3& a, const Vector3& b,
                                    const Vector3& axis, const std::vector<Matrix34>& all) {
        return std::array<Vector3, 3>{place(first, all) * point(a), place(second, all) * point(b),
                                      place(first, all) * direction(axis)};
    };
    const auto before = compare_places(joint.first, joint.second, joint.point_first, joint.point_second,
                                       joint.axis_first, X),
               after = compare_places(moved.first, moved.second, moved.point_first, moved.point_second,
                                      moved.axis_first, X_moved);
    for (std::size_t i = 0; i < 3; ++i)
        most = std::max(most,
                        largest((i < 2 ? to.by.of_point(before[i]) : to.by.rotation * before[i]) - after[i]));
    return most;
}

TEST(Relocated, JointsHoldWhatTheyHeld)
{
    Random random(1);
    for (const JointCase& kind : joint_cases())
        for (const bool on_world : {false, true})
            for (int n = 0; n < of_states(20); ++n) {
                const int first = on_world ? world : 0, second = on_world ? 0 : 1;
                std::vector<Matrix34> X, V;
                for (int b = 0; b <= second; ++b)
                    X.push_back(random.rigid()), V.push_back(random.matrix<3, 4>());
                const Matrix34 X_first = on_world ? world_configuration : X[0];
                const JointFrame frame = kind.place(random, X_first, X.back());
                const Joint joint = kind.make(first, second, frame, X_first, X.back());
                const Relocation to = any_relocation(random);
                const Joint moved = relocated(joint, to);
                EXPECT_LT(difference(joint, moved, X, V, to), 20 * bound) << kind.type;
                EXPECT_EQ(moved.name, "left " + joint.name);
                // also off the joint, where rows and their gradients are no zeros
                for (Matrix34& x : X) x += 0.3 * random.matrix<3, 4>();
                if (kind.type == "slot") continue;   // its nearest point is sought from where it was
                EXPECT_LT(difference(joint, moved, X, V, to), 20 * bound) << kind.type;
            }
}

TEST(Relocated, DrivesLeadAlongPathsThatTurn)
{
    Random random(2);
    const TimeFunction wave = harmonic(0.3, 0.7, 0.2);
    for (int n = 0; n < of_states(20); ++n) {
        const std::vector<Matrix34> X{random.rigid(), random.rigid()},
            V{random.matrix<3, 4>(), random.matrix<3, 4>()};
        const Joint pivot =
            revolute("j", world, 0, joint_frame(world_configuration, X[0], random.vector(), random.unit()));
        const std::vector<Joint> drives{
            driven_coordinate("d", pivot, pivot.coordinates[0], wave, X),
            driven_distance("d", 0, random.vector(), 1, random.vector(), TimeFunction(2.0), X),
            driven_distance("d", world, random.vector(), 1, random.vector(), TimeFunction(2.0), X),
            driven_point("d", 1, random.vector(), {wave, 0.0, wave}, X),
            driven_body("d", 0, random.vector(), {wave, wave, 0.1}, X)};
        for (const Joint& drive : drives) {
            const Relocation to = any_relocation(random);
            EXPECT_LT(difference(drive, relocated(drive, to), X, V, to), 20 * bound);
        }
    }
}

TEST(Relocated, WithoutTurningItIsAnother)
{
    Random random(3);
    const std::vector<Matrix34> X{random.rigid()}, V{random.matrix<3, 4>()};
    const TimeFunction wave = harmonic(0.3, 0.7, 0.2);
    const Joint drive = driven_point("d", 0, random.vector(), {wave, 0.0, wave}, X);
    const Relocation to = any_relocation(random);
    Relocation shifted = to;
    shifted.by.rotation = identity<3>();
    EXPECT_GT(difference(drive, relocated(drive, shifted), X, V, to), 0.01);
}

TEST(Relocated, SensorsReadWhatTheyRead)
{
    Random random(4);
    const std::vector<Matrix34> X{random.rigid(), random.rigid()};
    const Relocation to = any_relocation(random);
    for (const Sensor& sensor : {point_sensor("s", 1, random.vector(), X),
                                 relative_sensor("s", 0, random.vector(), 1, random.vector(), X),
                                 relative_sensor("s", world, random.vector(), 1, random.vector(), X)}) {
        const Sensor moved = relocated(sensor, to);
        for (std::size_t k = 0; k < sensor.components.size(); ++k)
            EXPECT_NEAR(coordinate_value(moved.components[k].coordinate.coordinate, displaced(X, to)),
                        coordinate_value(sensor.components[k].coordinate.coordinate, X), 20 * bound);
    }
    EXPECT_EQ(relocated(energy_sensor("s", 1), to).body, 1 + n_before);
    EXPECT_EQ(relocated(Sensor{"s", "load", {}, 2}, to).load, 3);
}

/// The load of a case, displaced: bodies keep their places in the list.
LoadCase moved_case(const LoadCase& of)
{
    Random random(5);
    Relocation to = any_relocation(random);
    to.first_body = 0;
    LoadCase moved = of;
    moved.make = [make = of.make, to](Random& r) {
        Load load = relocated(make(r), to);
        load.name = "l";
        return load;
    };
    if (of.place)
        moved.place = [place = of.place, to](Random& r) {
            std::array<Matrix34, 2> X = place(r);
            for (Matrix34& x : X)
                if (x != world_configuration) x = to.by.of_configuration(x);
            return X;
        };
    return moved;
}

/// R K R^T of every block of three rows and columns, against what the moved load says.
double difference_of_tangents(const Load& load, const LoadArguments& at, const Load& moved,
                              const LoadArguments& moved_at, const Relocation& to)
{
    const std::size_t n = load.bodies.size();
    LoadTangent T(n, load.n_acted), U(n, load.n_acted);
    load.tangent(at, T);
    moved.tangent(moved_at, U);
    Matrix<12, 12> R{};
    for (int block = 0; block < 4; ++block)
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) R(3 * block + i, 3 * block + j) = to.by.rotation(i, j);
    double most = 0;
    for (std::size_t b = 0; b < T.X.size(); ++b)
        for (std::size_t c = 0; c < n; ++c) {
            most = std::max(most, largest(R * T.X[b][c] * transpose(R) - U.X[b][c]));
            most = std::max(most, largest(R * T.V[b][c] * transpose(R) - U.V[b][c]));
        }
    return most;
}

class EveryMovedLoad : public testing::TestWithParam<LoadCase> {};

TEST_P(EveryMovedLoad, RunsInLanesAndPullsWhatItPulled)
{
    const LoadCase moved = moved_case(GetParam());
    for (const auto& check : {check_load_lanes, check_load_products, check_load_directors})
        EXPECT_EQ(joined(check(moved)), "");
    // Tape and function move places back in sums of another order: what laws read is a difference of places
    // up to ten times as large.
    EXPECT_EQ(joined(check_load_supply(moved, 1e-12)), "");
    Random random(6);
    for (int n = 0; n < of_states(50); ++n) {
        const Load load = GetParam().make(random);
        Relocation to = any_relocation(random);
        to.first_body = 0;
        const Load there = relocated(load, to);
        const LoadArguments at = random_arguments(random, load, GetParam());
        LoadArguments moved_at = at;
        for (std::size_t b = 0; b < load.bodies.size(); ++b) {
            if (load.bodies[b] == world) continue;
            moved_at.X[b] = to.by.of_configuration(at.X[b]);
            moved_at.V[b] = to.by.rotation * at.V[b];
        }
        LoadForces F(load.n_acted), G(load.n_acted);
        load.forces(at, F);
        there.forces(moved_at, G);
        double size = 1;
        for (const Matrix34& of_body : F) size = std::max(size, largest(of_body));
        for (std::size_t b = 0; b < load.n_acted; ++b)
            EXPECT_LT(largest(to.by.rotation * F[b] - G[b]), 1e3 * bound * size) << b;
        for (std::size_t k = 0; k < load.readings.size(); ++k)
            EXPECT_NEAR(load.readings[k].value(at), there.readings[k].value(moved_at), 1e3 * bound * size);
        EXPECT_NEAR(load_power(load, at), load_power(there, moved_at), 1e3 * bound * size);
        if (load.potential) {
            EXPECT_NEAR(load.potential(at), there.potential(moved_at), 1e3 * bound * size);
        }
        if (load.tangent) {
            EXPECT_LT(difference_of_tangents(load, at, there, moved_at, to), 1e3 * bound * size);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Relocated, EveryMovedLoad, testing::ValuesIn(load_cases()),
                         [](const auto& of) { return test_name(of.param.type + " " + of.param.what); });

TEST(Relocated, AForceThatDoesNotTurnIsAnother)
{
    Random random(7);
    const Load load = point_force("l", 0, {}, {1.0, 2.0, 3.0}, Frame::inertial);
    Relocation to = any_relocation(random);
    LoadForces F{}, G{};
    load.forces(LoadArguments(), F);
    to.first_body = 0;
    relocated(load, to).forces(LoadArguments(), G);
    EXPECT_GT(norm(F[0] - G[0]), 0.1);
    EXPECT_LT(norm(to.by.rotation * F[0] - G[0]), bound * 10);
}

}   // namespace
}   // namespace livens::relocated_test
