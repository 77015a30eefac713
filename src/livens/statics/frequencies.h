// SPDX-License-Identifier: BSD-3-Clause
// How fast a mechanism can vibrate about a state, and how fast its dampers take motions away.
#pragma once

#include <string>
#include <vector>

#include "livens/multibody/model.h"

namespace [[gnu::visibility("default")]] livens {

/// A rate, and who makes it.
struct Frequency {
    double rate = 0;         ///< 0: there is none, or none above the rounding of what it is made of
    int body = -1;           ///< which has the largest part of its kinetic energy
    std::string name = "";   ///< the load or joint that does most of the work; empty: the body's own rigidity

    /// "body 'bob', load 'strut'"
    std::string where(const Model& model) const;
};

/// A way to vibrate, and how far it goes with an energy of 1/2 J at 1 rad/s: as the root of the energy, and
/// by the rate.
struct Vibration {
    double rate = 0;    ///< rad/s
    double shift = 0;   ///< of the body that moves most, m
    double turn = 0;    ///< of the body that turns most, rad
    double decay = 0;   ///< that dampers give to this form, 1/s
};

/// Of the motions that the joints leave free, in the mass metric: the largest eigenvalues of the symmetric
/// parts of Z^T N^T (..) N Z against Z^T Mr Z.  (docs/theory.md, "Highest frequencies")
///
/// unit     rad/s; dampers: 1/s
struct HighestFrequencies {
    Frequency springs;       ///< the root of that of - dF/dX
    Frequency dampers;       ///< that of - dF/dX'
    Frequency constraints;   ///< the root of that of sum lambda K of joints, and of what bears rigidity

    const Frequency& fastest_vibration() const
    {
        return springs.rate < constraints.rate ? constraints : springs;
    }
};

/// At a state of a model, closed as by StartPolicy::project; throws InputError, see consistent_start(). Work
/// grows with the bodies, but with their cube where rows are no quadratic forms, inertias singular or joints
/// badly held.
HighestFrequencies highest_frequencies(const Model& model, const State& state, Side side = Side::right);

/// Of springs and constraints together, ascending rates from `slowest` rad/s on; work grows with the cube of
/// the freedoms, but with the bodies where sizes of the terms tell that nothing is so fast. Throws likewise.
std::vector<Vibration> vibrations(const Model& model, const State& state, Side side = Side::right,
                                  double slowest = 0);

}   // namespace livens
