// SPDX-License-Identifier: BSD-3-Clause
// Conditions at the start and end of the motion.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string_view>

#include "livens/multibody/model.h"
#include "livens/multibody/motion.h"

namespace [[gnu::visibility("default")]] livens {

class Prepared;

/// Quantities prescribed at one end of the motion.
enum class Known {
    nothing,
    positions,   ///< X
    momenta,     ///< linear momentum and angular momentum about the reference point of each body, in world
                 ///< axes, computed from the given X and V
    state        ///< X and momenta
};

/// In scenarios, in this order.
constexpr std::array<std::string_view, 4> words_of(Known)
{
    return {"nothing", "positions", "momenta", "state"};
}

inline bool knows_positions(Known known) { return known == Known::positions || known == Known::state; }
inline bool knows_momenta(Known known) { return known == Known::momenta || known == Known::state; }

/// Conditions at both ends, the same for all bodies. Two halves must be prescribed: the state at one end, or
/// positions or momenta at each. Given values that are not prescribed serve as a first guess: V with
/// prescribed positions, X with prescribed momenta (zeros mean none).
struct Conditions {
    State start;
    Known at_start = Known::state;
    State end{};
    Known at_end = Known::nothing;
};

struct Problem {
    Conditions conditions;
    /// First guess of the motion for conditions at both ends; empty: constructed from the conditions.
    std::function<State(double t)> guess{};
    /// A nearby motion of the same bodies: lobatto(p) uses it as first guess where the elements are the same.
    /// Must outlive the solution. Null: none.
    const Motion* near = nullptr;
    /// Cached results from an earlier solution of this model; null: nothing is cached. For one thread at a
    /// time.
    std::shared_ptr<Prepared> prepared{};
};

}   // namespace livens
