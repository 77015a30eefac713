// SPDX-License-Identifier: BSD-3-Clause
// States of controllers, z' = f(t, q, q', z): each is the velocity of a point mass along an axis, on which f
// acts as a force. Elements solve it as they solve free motion, by Gauss's collocation, and so to the order
// of all else (docs/theory.md, "States").
#pragma once

#include <span>
#include <string>
#include <vector>

#include "livens/multibody/model.h"

namespace [[gnu::visibility("default")]] livens {

struct ControllerState {
    std::string name;
    double start = 0;
    double size = 1;   ///< that is typical of it: errors are relative to it
};

/// How states are scaled: one of its size moves its body at this speed. Neither is seen in what is solved,
/// but for rounding and what errors are compared with.
struct StateScale {
    double mass = 1;    ///< kg
    double speed = 1;   ///< m/s
};

/// States that one body holds.
inline constexpr std::size_t states_of_body = 3;

/// Holds up to three of them, at rest but for these; `owner` is what they are of.
Body body_of_states(const std::string& name, const std::string& owner,
                    std::span<const ControllerState> states, const StateScale& scale);
/// State k of such a body of a model: its rate is z.
JointCoordinate coordinate_of_state(int body, int k, const ControllerState& state, const StateScale& scale);
/// What makes z' = 1: a unit of modulated(). X: of all bodies at the start.
Load unit_of_state(const std::string& name, int body, int k, const ControllerState& state,
                   const StateScale& scale, const Configurations& X);

/// A load that does nothing but say these numbers, of what it looks at; on the bodies of a model, or some.
/// X: of all bodies at the start. Throws InputError (`load-empty`) where it looks at no body.
Load observer(const std::string& name, const std::vector<LawCoordinate>& coordinates,
              const std::vector<LawReading>& readings, const Configurations& X);

struct NamedState {
    std::string name;   ///< "pid.i"
    double value = 0;
    double size = 1;   ///< that is typical of it
};
/// All states, by the velocities of all bodies of the model.
std::vector<NamedState> states_in(const Model& model, std::span<const Matrix34> V);

/// Throws InputError (`controller-state`) at path: no such load, or not a reading for each state, or what is
/// no state of a body that holds some.
void check_change(const StateChange& change, const std::vector<Body>& bodies, const std::vector<Load>& loads,
                  const std::string& path);

/// The same of a controller that is asked at instants; also `controller-every` for a period that is none.
void check_sampling(const Sampling& sampling, const std::vector<Body>& bodies,
                    const std::vector<Load>& loads);

}   // namespace gnu::visibility("default")]]livens
