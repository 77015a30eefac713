// SPDX-License-Identifier: BSD-3-Clause
// Laws of loads that read reactions of joints: friction of bearings, brakes, scales, controllers of forces
// (docs/theory.md, "Laws of reactions").
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "livens/multibody/loads/load_laws.h"

namespace [[gnu::visibility("default")]] livens {

class Model;

/// A number of what a joint exerts on its second body, as joint_reaction() has it.
struct ReactionInput {
    int joint = 0;   ///< -1, or one that does not act: the number is 0
    bool is_torque = false;
    Vector3 along{};              ///< a direction in world axes; zero: the length
    bool is_multiplier = false;   ///< that of its first row instead
};

/// Of these coordinates, and of reactions.
using ReactionNumber = std::function<double(const LawArguments&, std::span<const double> reactions)>;

/// F = sum_k f_k(t, q, q', r) F_k with reactions r, as modulated() has it without them. All laws of a model
/// are one system, as each force changes what the others read: it takes the whole model to make loads of
/// them.
struct ReactionLaw {
    std::string name, type;
    /// Of size one, on the same two bodies. None: it says its numbers and does nothing.
    std::vector<Load> units{};
    std::vector<LawCoordinate> coordinates{};
    std::vector<ReactionInput> reactions{};
    std::function<void(const LawArguments&, std::span<const double> reactions, std::span<double> factors)>
        law = nullptr;
    /// Where f is not smooth, and numbers for these.
    std::vector<Guard> guards{};
    std::function<void(const LawArguments&, std::span<const double> reactions, std::span<double>)> guarded =
        nullptr;
    std::vector<double> breaks{};
    /// What it says of itself: a number, or, where there is none, the factor of the same place.
    struct Reading {
        std::string name, unit;
        ReactionNumber value = nullptr;
    };
    std::vector<Reading> readings{};
    ActingTimes times{};   ///< as bind_reaction_laws() found them
    /// Makes loads of all laws of a model that has all else.
    std::function<std::vector<Load>(const Model& rest, const std::vector<ReactionLaw>& laws)> make = nullptr;
};

/// A load that does nothing until bind_reaction_laws() has seen what else there is. `look_from`: a body, for
/// a law without units. Throws InputError `load-empty` for units that are none, or on different bodies.
Load waiting(ReactionLaw law, int look_from = world);

/// Makes the loads of a model that have such laws, anew after each change of what else it has.
void bind_reaction_laws(Model& model);
/// Whether it has some.
bool reads_reactions(const Model& model);

}   // namespace gnu::visibility("default")]]livens
