// SPDX-License-Identifier: BSD-3-Clause
// Coordinates of joints along a motion: angles with their turns, displacements, and their rates.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "livens/multibody/motion.h"
#include "livens/multibody/unwrapped_angles.h"

namespace [[gnu::visibility("default")]] livens {

inline namespace diagnostics_internal {
class SparseCoordinate;
}   // namespace diagnostics_internal

class Accelerations;

/// X'' of all bodies at an instant, and X and X' that it belongs to: those of the motion as rigid bodies that
/// keep to the rates of their joints.
struct AcceleratedState {
    std::vector<Matrix34> X, V, A;
};

struct CoordinateValue {
    double value = 0;                                                 ///< rad or m
    double rate = 0;                                                  ///< its rate, per s
    double acceleration = std::numeric_limits<double>::quiet_NaN();   ///< per s^2, where they were given
};

/// Coordinates along a motion. An angle is followed from node to node, between
/// which no accepted motion turns by half a turn, from where the bodies are stated: there every coordinate is
/// what NamedCoordinate::at_stated says, and drives and loads count from there as well. At element ends
/// values and rates are of the method's full order, between them of the motion's dense orders.
class FollowedCoordinates {
public:
    FollowedCoordinates(const Model& model, const Motion& motion, std::vector<NamedCoordinate> coordinates);

    /// In a state of the motion: X and V at an instant of it; with what Accelerations say, accelerations too.
    std::vector<CoordinateValue> at(const State& state, const AcceleratedState* accelerated = nullptr) const;

private:
    void turn(const double* X, std::span<double> near) const;

    const Motion& motion_;
    std::vector<NamedCoordinate> coordinates_;
    std::shared_ptr<const std::vector<SparseCoordinate>> sparse_;   ///< the same
    std::vector<double> at_ends_;   ///< less the values there, end * coordinates + coordinate
};

/// All NamedCoordinates of a model's joints.
class JointCoordinates {
public:
    /// Where a coordinate stands: its joint, and its place in Joint::coordinates.
    struct Place {
        int joint = 0;
        int coordinate = 0;
    };

    JointCoordinates(const Model& model, const Motion& motion);

    const std::vector<Place>& places() const { return places_; }
    const NamedCoordinate& coordinate(int i) const;
    /// Of all places at t, after snap_to_element_end().
    std::vector<CoordinateValue> at(double t) const;
    /// In a state at an instant of the motion, as sample_exactly() has it; see FollowedCoordinates.
    std::vector<CoordinateValue> at(const State& state, const AcceleratedState* accelerated = nullptr) const;

private:
    const Model& model_;
    const Motion& motion_;
    std::vector<Place> places_;
    FollowedCoordinates followed_;
};

/// Angles of loads along a motion; see Turns.
class LoadTurns {
public:
    LoadTurns(const Model& model, const Motion& motion);

    const UnwrappedAngles& turns() const { return turns_; }
    /// A row at an end of an element, and in a state of the motion.
    std::vector<double> at_end(int end) const;
    std::vector<double> at(const State& state) const;

private:
    const Motion& motion_;
    UnwrappedAngles turns_;
    std::vector<double> at_ends_;
};

/// What all sensors of a model read along a motion.
class SensorReadings {
public:
    SensorReadings(const Model& model, const Motion& motion);

    /// Of all components of all sensors at t, one after the other, after snap_to_element_end(); between
    /// element ends in the nearest state that joints allow. Where a load jumps, what is there on that side.
    std::vector<double> at(double t, Side side = Side::right) const;
    /// The same in a state at an instant of the motion, as sample_exactly() has it.
    std::vector<double> at(const State& given, Side side = Side::right) const;

private:
    const Model& model_;
    const Motion& motion_;
    FollowedCoordinates followed_;   ///< of components that have a coordinate, in their order
    std::shared_ptr<const Accelerations> accelerations_;
    bool has_accelerations_ = false;   ///< a component is one
    LoadTurns turns_;
};

/// A load whose angle has left the half turn on either side in which it is known where nobody
/// counts turns (Load::angles).
struct LostTurn {
    int load = -1;   ///< -1: there is none
    double t = 0;    ///< s, of the first node beyond
};
LostTurn find_lost_turn(const Model& model, const Motion& motion);

}   // namespace livens
