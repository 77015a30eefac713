// SPDX-License-Identifier: BSD-3-Clause
// What formulas of a scenario read: coordinates of the motion, states, and formulas of controllers.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "livens/multibody/events.h"
#include "livens/multibody/loads/load_laws.h"
#include "livens/time/expression.h"

namespace livens::inline io_internal {

/// What expressions of a section read: of symbol k the number reads[k].
struct Inputs {
    struct Read {
        std::size_t coordinate;
        bool is_rate;
        int reaction = -1;   ///< instead of both, one of `reactions`
    };
    std::vector<std::string> symbols{};
    std::vector<LawCoordinate> coordinates{};
    std::vector<Read> reads{};
    std::vector<ReactionInput> reactions{};
    bool may_read_reactions = false;
    /// Names that stand for formulas, which are of these symbols.
    std::vector<std::pair<std::string, Expression>> formulas{};

    const Expression* formula(std::string_view name) const
    {
        for (const auto& [own, expression] : formulas)
            if (own == name) return &expression;
        return nullptr;
    }
};

/// A controller as formulas of others see it.
struct ReadController {
    struct State {
        std::string name;
        JointCoordinate coordinate{};   ///< whose rate it is
    };
    struct Output {
        std::string name;
        Expression formula;
        Inputs inputs;
    };
    std::string name;
    std::vector<State> states{};     ///< and outputs that are held between instants
    std::vector<Output> outputs{};   ///< that follow from states and inputs at once
    int load = -1;                   ///< that tells its numbers
};

}   // namespace livens::inline io_internal
