// SPDX-License-Identifier: BSD-3-Clause
// Loads whose laws read reactions of joints: friction of bearings, brakes, scales (docs/theory.md, "Laws of
// reactions").
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "livens/multibody/events.h"
#include "livens/multibody/model.h"

namespace [[gnu::visibility("default")]] livens {

/// F = sum_k f_k(t, q, q', r) F_k with reactions r, as modulated() has it without them.
struct ReactionLaw {
    std::string name, type;
    std::vector<Load> units;   ///< of size one, on the same bodies
    std::vector<LawCoordinate> coordinates;
    std::vector<ReactionInput> reactions;
    std::function<void(const LawArguments&, std::span<const double> reactions, std::span<double> factors)>
        law;
    /// Where f is not smooth, and numbers for these.
    std::vector<Guard> guards{};
    std::function<void(const LawArguments&, std::span<const double> reactions, std::span<double>)> guarded =
        nullptr;
    std::vector<double> breaks{};
    std::vector<LawReading> readings{};   ///< names and units of factors; their values are not asked
};

/// Loads by these laws for a model that has all else: all of them read the reactions of the whole, which
/// depend on each of their forces in turn. Joints must act always. Throws InputError: `event-reaction` for a
/// joint whose reactions are not unique, `event-method` for joints that begin or end, `load-empty` for units
/// that are none.
std::vector<Load> loads_by_reactions(const Model& model, const std::vector<ReactionLaw>& laws);

}   // namespace gnu::visibility("default")]]livens
