// SPDX-License-Identifier: BSD-3-Clause
// What coordinates count, and how far it is from one state to another: theory.md, "States in coordinates".
#include "livens/dynamics/coordinates/mechanism.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "livens/base/error.h"
#include "livens/base/text.h"
#include "livens/dynamics/rows/rank.h"
#include "livens/dynamics/rows/rows.h"
#include "livens/dynamics/rows/twist.h"
#include "livens/multibody/body.h"

namespace livens::inline dynamics_internal {

namespace {

using Of = GeneralisedCoordinate::Of;

/// What acts at an instant, and lets its drives go.
Model released(const Model& the_model, double t)
{
    const Model acting = acting_at(the_model, t).model;
    Model model(acting.gravity());
    for (const Body& body : acting.bodies()) model.add_body(body);
    for (const Joint& joint : acting.joints())
        if (std::ranges::all_of(joint.rows, [](const ConstraintRow& row) { return row.drives.empty(); }))
            model.add_joint(joint);
    for (const Load& load : acting.loads()) model.add_load(load);
    for (const NamedPoint& point : acting.points()) model.add_point(point);
    return model;
}

CountedRow counted_row(const NamedCoordinate& named, const Configuration& stated)
{
    CountedRow counted;
    counted.row = coupling_row({{1, named.coordinate}}, 0, 1, named.name);
    counted.is_angle = named.coordinate.is_angle();
    counted.is_of_rotation = named.coordinate.kind == CoordinateKind::rotation_component;
    counted.counts_turns = named.coordinate.counts_turns();
    counted.offset = named.at_stated - constraint_value(counted.row, stated);
    return counted;
}

const NamedCoordinate& coordinate_of(const Model& model, const GeneralisedCoordinate& c)
{
    return model.joints()[static_cast<std::size_t>(c.part)].coordinate(static_cast<std::size_t>(c.index));
}

Matrix3 directors_of(std::span<const double> q)
{
    return directors_from_quaternion({q[0], q[1], q[2], q[3]});
}

Vector3 turn(const Matrix3& from, const Matrix3& to)
{
    return twist::turn_between(configuration({}, from), configuration({}, to));
}

}   // namespace

/// Places are closed at rest, since rates are given later, along the coordinates. Numbers of joints count
/// from where bodies are stated, not from where they are placed.
Mechanism::Mechanism(const Model& the_model, const State& at, StartPolicy policy,
                     const std::vector<std::string>& wanted)
    : model(released(the_model, at.t)), bodies(model), loads(model), rotors(rotors_of(model)),
      length(model.length()), stated(model.start().X)
{
    for (const Joint& joint : model.joints())
        counted.insert(counted.end(), joint.coordinates.begin(), joint.coordinates.end());
    State rest = at;
    for (Matrix34& V : rest.V) V = {};
    const ConsistentStart closed = consistent_start(model, rest, policy);
    placed = closed.start;
    rank = static_cast<int>(closed.independent.size());
    coordinates = choose_coordinates(model, placed, closed.independent, wanted);
    for (const GeneralisedCoordinate& c : coordinates) {
        rows.emplace_back();
        if (c.of == Of::joint) rows.back() = counted_row(coordinate_of(model, c), stated);
        n_rates += c.n_rates();
    }
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const GeneralisedCoordinate& c = coordinates[i];
        if (c.of == Of::joint) {
            const NamedCoordinate& named = coordinate_of(model, c);
            numbers.push_back(named.at_stated + coordinate_change(named.coordinate, stated, placed.X));
        } else if (c.of == Of::place) {
            numbers.push_back(placed.X[c.part](c.index, 0));
        } else {
            const Vector4 q = quaternion_from_directors(directors(placed.X[c.part]));
            numbers.insert(numbers.end(), q.a, q.a + 4);
        }
    }
}

/// X does not tell turns: an angle that counts them goes the shorter way.
std::vector<double> Mechanism::way_to(const Configuration& X, std::span<const double> target) const
{
    std::vector<double> all;
    const double* to = target.data();
    for (std::size_t i = 0; i < coordinates.size(); to += coordinates[i].n_numbers(), ++i) {
        const GeneralisedCoordinate& c = coordinates[i];
        if (c.of == Of::joint) {
            const double left = *to - rows[i].offset - constraint_value(rows[i].row, X);
            all.push_back(rows[i].counts_turns ? std::remainder(left, 2 * std::numbers::pi) : left);
        } else if (c.of == Of::place) {
            all.push_back(*to - X[c.part](c.index, 0));
        } else {
            const Vector3 left = turn(directors(X[c.part]), directors_of({to, 4}));
            all.insert(all.end(), left.a, left.a + 3);
        }
    }
    return all;
}

/// Numbers tell turns, so that this way may be many turns long.
std::vector<double> Mechanism::way(std::span<const double> from, std::span<const double> to) const
{
    std::vector<double> all;
    std::size_t k = 0;
    for (const GeneralisedCoordinate& c : coordinates) {
        if (c.of == Of::turn) {
            const Vector3 left = turn(directors_of(from.subspan(k, 4)), directors_of(to.subspan(k, 4)));
            all.insert(all.end(), left.a, left.a + 3);
        } else {
            all.push_back(to[k] - from[k]);
        }
        k += static_cast<std::size_t>(c.n_numbers());
    }
    return all;
}

std::vector<double> Mechanism::gone(std::span<const double> from, std::span<const double> way,
                                    double part) const
{
    std::vector<double> all;
    std::size_t k = 0, r = 0;
    for (const GeneralisedCoordinate& c : coordinates) {
        if (c.of == Of::turn) {
            const Matrix3 turned =
                directors_from_rotation_vector({part * way[r], part * way[r + 1], part * way[r + 2]}) *
                directors_of(from.subspan(k, 4));
            const Vector4 q = quaternion_from_directors(turned);
            all.insert(all.end(), q.a, q.a + 4);
        } else {
            all.push_back(from[k] + part * way[r]);
        }
        k += static_cast<std::size_t>(c.n_numbers());
        r += static_cast<std::size_t>(c.n_rates());
    }
    return all;
}

/// Components of one joint count together, by the length of their vector.
void Mechanism::refuse_half_turns(std::span<const double> target) const
{
    std::vector<double> squares(model.joints().size(), 0.0);
    std::size_t number = 0;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const GeneralisedCoordinate& c = coordinates[i];
        if (rows[i].is_of_rotation) {
            double& square = squares[static_cast<std::size_t>(c.part)];
            square += target[number] * target[number];
            if (!(square <= widest_rotation * widest_rotation))
                throw InputError({"coordinate-value", "q[" + c.name + "]",
                                  "the rotation vector of joint '" +
                                      model.joints()[static_cast<std::size_t>(c.part)].name +
                                      "' is longer than it is known",
                                  to_text(std::sqrt(square), 4) + " rad", to_text(widest_rotation, 3),
                                  "it begins again on the other side at half a turn",
                                  "give the rotation the other way round, or the joint 'angles'"});
        }
        number += static_cast<std::size_t>(c.n_numbers());
    }
}

bool Mechanism::is_length(int coordinate) const
{
    const GeneralisedCoordinate& c = coordinates[coordinate];
    return c.of == Of::place || (c.of == Of::joint && !rows[coordinate].is_angle);
}

double Mechanism::unit_of(int coordinate) const { return is_length(coordinate) ? length : 1; }

double Mechanism::size_of(std::span<const double> way) const
{
    double largest = 0;
    std::size_t r = 0;
    for (int i = 0; i < static_cast<int>(coordinates.size()); ++i)
        for (int k = 0; k < coordinates[i].n_rates(); ++k, ++r)
            largest = std::max(largest, std::abs(way[r]) / unit_of(i));
    return largest;
}

double Mechanism::size_of_twists(std::span<const double> twists) const
{
    double largest = 0;
    for (const BodyTable& body : bodies)
        for (int i = 0; i < body.dofs; ++i) {
            const double size = std::abs(twists[body.first + i]) / (i < 3 ? length : 1);
            if (!(size <= largest) && !std::isnan(largest)) largest = size;   // keeps what is no number
        }
    return largest;
}

double Mechanism::farthest_turn(const DenseMatrix& by_rates, std::span<const double> way) const
{
    double farthest = 0;
    for (const BodyTable& body : bodies) {
        double sum = 0;
        for (int k = 0; k < n_rates; ++k)
            for (int i = 3; i < body.dofs; ++i) sum += std::abs(by_rates(body.first + i, k) * way[k]);
        farthest = std::max(farthest, sum);
    }
    return 2 * farthest;   // of two bodies against each other
}

double Mechanism::open(const Configuration& X, int* row) const
{
    const std::vector<double> values = joint_values(model, X);
    double largest = 0;
    for (int r = 0; r < model.n_rows(); ++r) {
        const double size = std::abs(values[r]) / model.row(r).scale;
        if (size <= largest || std::isnan(largest)) continue;   // keeps what is no number
        largest = size;
        if (row != nullptr) *row = r;
    }
    return largest;
}

}   // namespace livens::inline dynamics_internal
