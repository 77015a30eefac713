// SPDX-License-Identifier: BSD-3-Clause
// Reactions where joints are redundant: of all that move the bodies alike, the least.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "livens/multibody/state.h"

namespace [[gnu::visibility("default")]] livens {

/// Which components of force (x, y, z) and torque (likewise) in world axes other joints of a closed loop
/// could carry part of.
using SharedComponents = std::array<bool, 6>;

/// "force z, torque x"; empty if none is shared.
std::string in_words(const SharedComponents& shared);

struct UniqueReactions {
    std::vector<double> multipliers;        ///< of all rows of the model, as many sets as were given
    std::vector<bool> joint_is_unique;      ///< the part of null vectors in it is at most 1e-9
    std::vector<SharedComponents> shared;   ///< of each joint: in which of them null vectors have such a part
    double largest_null = 0;                ///< largest of these parts in any joint; 0 if no row is redundant
};

/// Of all multipliers with the same G^T lambda in twists those with the least sum over joints of
/// |f|^2 + |t|^2 / L^2, where f and t are joint_reaction() and L is Model::length().
///
/// `multipliers`: one set or several, one after the other. A model with drives wants to be frozen() first.
/// Which rows were chosen as `independent` does not matter, only how many they are. Turning the model in
/// space turns the reactions and does nothing else; masses do not enter. Null vectors of G^T and their parts
/// are measured by the root of the same sum, which is one for all joints together; of several, orthonormal in
/// it, the squares are added. Multipliers of unique
/// joints, and all if no row is redundant, are returned to the bit.
UniqueReactions least_reactions(const Model& model, std::span<const Matrix34> X,
                                std::span<const double> multipliers, std::span<const int> independent);

}   // namespace livens
